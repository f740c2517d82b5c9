#include "io/pages/log_text.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/text.hpp"

namespace pirsim::io {
namespace {

/// To a millisecond, at which the last event ends.
std::string moment_in_words(const Log& log, std::int64_t us) {
  constexpr std::int64_t ms = 1'000;
  return pirsim::to_text(log.moment((us + ms / 2) / ms * ms), log.clock);
}

/// "1.1 s", "45 min", "7.5 h", "12 d"
std::string time_in_words(double s) {
  constexpr double a_minute = 60.0, an_hour = 3600.0, a_day = 86'400.0;
  const auto short_number = [](double value) { return shortest_number(std::round(10.0 * value) / 10.0); };
  if (s < 10.0) return shortest_number(std::round(100.0 * s) / 100.0) + " s";
  if (s < 3.0 * a_minute) return short_number(s) + " s";
  if (s < 3.0 * an_hour) return short_number(s / a_minute) + " min";
  if (s < 3.0 * a_day) return short_number(s / an_hour) + " h";
  return short_number(s / a_day) + " d";
}

std::string rare_or_not(double share) { return percent(share, share < 0.1 ? 2 : 1); }

/// "1.1 s (38 %)"
std::string floor_in_words(const LogLengths& lengths) {
  if (lengths.n == 0) return {};
  return time_in_words(lengths.floor_s) + " (" + percent(lengths.floor_share) + ")";
}

std::string quantile_in_words(const LogLengths& lengths, double value) {
  return lengths.n == 0 ? std::string() : time_in_words(value);
}

std::string rate_in_words(const std::optional<LogFalseTriggers>& found) {
  if (!found) return {};
  return std::to_string(found->n) + " in " + fixed(found->hours, found->hours < 10.0 ? 1 : 0) + " h";
}

std::string people_in_words(const Log& log) {
  if (!log.people) return ", no counts";
  std::int32_t most = 0;
  for (const LogChange& change : log.people->changes) most = std::max(most, change.value);
  const bool is_count = log.map.people_mean == LogMap::People::count;
  return ", people: " + log.people->in_log + (is_count ? ", up to " + std::to_string(most) : ", present or not");
}

std::string names_in_words(const Log& log, const std::vector<std::size_t>& sensors) {
  if (sensors.size() == log.sensors.size() && sensors.size() > 1) return "all";
  std::vector<std::string> names;
  constexpr std::size_t most = 4;
  for (std::size_t i = 0; i < std::min(most, sensors.size()); ++i) names.push_back(log.sensors[sensors[i]].name);
  if (sensors.size() > most) names.push_back("and " + std::to_string(sensors.size() - most) + " more");
  return joined(names, ", ");
}

}  // namespace

std::string form_in_words(const Log& log) {
  const double interval_s = static_cast<double>(log.interval_us) / 1e6;
  const std::string form = log.map.form == LogMap::Form::events      ? "events"
                           : log.map.form == LogMap::Form::intervals ? "intervals"
                           : log.has_readings() ? "readings every " + shortest_number(interval_s) + " s"
                                                : "rows of changes";
  const std::string empty = log.map.empty == LogMap::Empty::unchanged ? " (an empty cell: unchanged)" : "";
  return form + empty + (log.source.empty() ? "" : " of " + log.source) + ", " + counted(log.sensors.size(), "sensor") +
         people_in_words(log);
}

std::string log_in_words(const Log& log) {
  return form_in_words(log) + "; " + moment_in_words(log, log.begin_us) + " to " + moment_in_words(log, log.end_us) +
         " (" + time_in_words(static_cast<double>(log.end_us - log.begin_us) / 1e6) + "), " +
         counted(log.n_rows, "row");
}

Table sensor_table(const Log& log, const LogFacts& facts) {
  Table table{{"sensor", "motion", "unknown", "pulses", "shortest", "hold", "median", "95 %", "shortest pause",
               "median pause", "false triggers"},
              {}};
  const double whole_s = static_cast<double>(log.end_us - log.begin_us) / 1e6;
  for (const LogSensorFacts& sensor : facts.sensors) {
    const auto share = sensor.motion_share();
    table.rows.push_back({sensor.name, share ? rare_or_not(*share) : "",
                          rare_or_not(std::max(0.0, sensor.unknown_s) / whole_s), std::to_string(sensor.pulses.n),
                          floor_in_words(sensor.pulses), sensor.hold_s ? time_in_words(*sensor.hold_s) : "not told",
                          quantile_in_words(sensor.pulses, sensor.pulses.median_s),
                          quantile_in_words(sensor.pulses, sensor.pulses.q95_s), floor_in_words(sensor.pauses),
                          quantile_in_words(sensor.pauses, sensor.pauses.median_s),
                          rate_in_words(sensor.false_triggers)});
  }
  return table;
}

Table pair_table(const LogFacts& facts, std::size_t most) {
  Table table{{"sensors", "alike (phi)", "who leads", "begin together"}, {}};
  for (std::size_t i = 0; i < std::min(most, facts.pairs.size()); ++i) {
    const LogPair& pair = facts.pairs[i];
    const std::string &a = facts.sensors[pair.a].name, &b = facts.sensors[pair.b].name;
    std::string lead;
    if (pair.b_after_a_s) {
      const double after = *pair.b_after_a_s;
      lead = pair.has_leader() ? (after > 0.0 ? a : b) + " by " + time_in_words(std::abs(after)) : "neither";
    }
    table.rows.push_back({a + ", " + b, pair.phi ? fixed(*pair.phi, 2) : "", lead,
                          pair.n_together > 0 ? std::to_string(pair.n_together) : ""});
  }
  return table;
}

Table gap_table(const Log& log, const LogFacts& facts) {
  Table table{{"unknown from", "to", "for", "sensors"}, {}};
  for (const LogGap& gap : facts.gaps) {
    table.rows.push_back({moment_in_words(log, gap.from.us), moment_in_words(log, gap.to.us),
                          time_in_words(static_cast<double>(gap.to.us - gap.from.us) / 1e6),
                          names_in_words(log, gap.sensors)});
  }
  return table;
}

std::vector<std::string> log_notes(const Log& log, const LogFacts& facts) {
  std::vector<std::string> notes;
  notes.push_back(
      "Shortest: what one in a hundred doesn't reach, and how many of all are at most a tenth longer. If that are "
      "three "
      "in ten of twenty pulses of events, it is the sensor's hold; if they are many of the pauses, its dead time" +
      std::string(log.has_readings() ? "; readings can't tell what is shorter than their interval." : "."));
  const auto told =
      std::ranges::find_if(facts.sensors, [](const auto& sensor) { return sensor.false_triggers.has_value(); });
  if (told != facts.sensors.end()) {
    notes.push_back(
        told->false_triggers->from == LogFalseTriggers::From::nobody
            ? "False triggers: motion that begins while the count is 0, five minutes from any other count."
            : "False triggers: motion that begins from midnight to five in the quietest third of the nights; "
              "the others have more.");
  }
  if (!log.others.empty()) {
    constexpr std::size_t most = 12;
    const std::vector<std::string> first(
        log.others.begin(), log.others.begin() + static_cast<std::ptrdiff_t>(std::min(most, log.others.size())));
    notes.push_back("Not read, since no motion sensor: " + joined(first, ", ") +
                    (log.others.size() > most ? " and " + std::to_string(log.others.size() - most) + " more" : "") +
                    (log.n_other_rows > 0 ? " (" + counted(log.n_other_rows, "row") + ")" : "") + ".");
  }
  if (log.n_other_lines > 0)
    notes.push_back(counted(log.n_other_lines, "line") + " of " + log.source + " tell of something else.");
  if (!log.has_readings() && log.map.form != LogMap::Form::intervals && !log.map.longest_gap_s) {
    notes.push_back("The longest time without any change is " + time_in_words(facts.longest_silence_s) +
                    ": it counts as known, unless a map says longest_gap_s.");
  }
  if (facts.n_gaps > facts.gaps.size())
    notes.push_back("There are " + std::to_string(facts.n_gaps) + " gaps; the longest are listed.");
  return notes;
}

namespace {

/// Columns one below the other; the first one's texts begin, those of the others end at the same place.
std::string aligned(const Table& table) {
  std::vector<std::vector<std::string>> rows{table.headings};
  rows.insert(rows.end(), table.rows.begin(), table.rows.end());
  std::vector<std::size_t> widths(table.headings.size());
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string space(widths[i] - row[i].size(), ' ');
      line += i == 0 ? row[i] + space : "  " + space + row[i];
    }
    while (line.ends_with(' ')) line.pop_back();
    text += line + '\n';
  }
  return text;
}

}  // namespace

std::string to_text(const Log& log, const LogFacts& facts) {
  constexpr std::size_t most_pairs = 5, most_gaps = 5;
  std::string text = log_in_words(log) + "\n\n" + aligned(sensor_table(log, facts));
  if (!facts.pairs.empty()) text += '\n' + aligned(pair_table(facts, most_pairs));
  if (Table gaps = gap_table(log, facts); !gaps.rows.empty()) {
    if (gaps.rows.size() > most_gaps) gaps.rows.resize(most_gaps);
    text += '\n' + aligned(gaps);
  }
  text += '\n';
  for (const std::string& note : log_notes(log, facts)) text += note + '\n';
  return text;
}

}  // namespace pirsim::io
