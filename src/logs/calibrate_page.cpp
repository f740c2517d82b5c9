#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>

#include "files/disk/file.hpp"
#include "files/read/yaml.hpp"
#include "logs/calibrate.hpp"
#include "model/core/text.hpp"
#include "model/schema/clock.hpp"
#include "pirsim/calibrate.hpp"
#include "pirsim/csv.hpp"
#include "show/report.hpp"

// A calibration, and a log counted, as pages and files.

namespace pirsim::calibrate {
namespace {

std::string range(const Interval& interval, int digits = 2) {
  return fixed(interval.low, digits) + " to " + fixed(interval.high, digits);
}

/// With three digits that count.
std::string plain(double value) {
  if (value == 0.0) return "0";
  const int before = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  return fixed(value, std::clamp(3 - before, 0, 6));
}
std::string plain(const Interval& interval) { return plain(interval.low) + " to " + plain(interval.high); }

/// Where a value lies if the rooms' range is from -1 to 1.
double place_in(const Interval& interval, double value) {
  const double half = 0.5 * (interval.high - interval.low), middle = 0.5 * (interval.low + interval.high);
  constexpr double least = 1e-9;
  return (value - middle) / std::max(half, least);
}

/// "mean run without (min): 1.2, rooms 2.1 to 4; a sign of a fan, a pet, or livelier people"
std::string what_is_unlike(const Statistic& one) {
  const std::string values =
      one.name + " (" + one.unit + "): " + plain(one.of_log) + ", rooms " + plain(one.of_rooms) + "; ";
  if (one.about == Statistic::About::schedule) return values + one.sign;
  return values + (one.advice.empty() ? "" : one.advice + " brings the rooms nearer, or it is ") + "a sign of " +
         one.sign;
}

/// Of the statistics that are unlike: those that weigh most.
std::string what_is_unlike(const Calibration& calibration, Statistic::About about) {
  std::vector<Statistic> unlike;
  for (const Statistic& one : calibration.statistics) {
    if (!one.sign.empty() && one.about == about) unlike.push_back(one);
  }
  std::ranges::stable_sort(unlike, std::greater{}, &Statistic::share);
  constexpr std::size_t most = 3;
  std::string told;
  for (std::size_t i = 0; i < std::min(most, unlike.size()); ++i)
    told += (i == 0 ? "" : ". ") + what_is_unlike(unlike[i]);
  return told;
}

io::BandChart statistics_chart(const Calibration& calibration) {
  io::BandChart chart;
  chart.title = "What the log tells by itself, beside the recipe's rooms";
  chart.note = "The band holds the middle 90 % of the rooms.";
  chart.label = "place in the rooms' range";
  chart.low = "less than the rooms";
  chart.high = "more than the rooms";
  for (const Statistic& one : calibration.statistics) {
    using Mark = io::BandChart::Point::Mark;
    const double place = place_in(one.of_rooms, one.of_log);
    chart.rows.push_back({one.name,
                          {{place, plain(one.of_log) + " " + one.unit + "; rooms " + plain(one.of_rooms),
                            one.p <= verdict_level ? Mark::outside : Mark::inside}}});
  }
  return chart;
}

io::ReportSection statistics_section(const Calibration& calibration) {
  io::ReportSection section;
  section.heading = "Is your room like these?";
  section.paragraphs = {
      calibration.verdict == Verdict::none_like_it
          ? "No: only " + percent(calibration.p) +
                " of the rooms differ as much from the others as your log does. Widen the range of what is outside, "
                "or ask what is in the room that the recipe hasn't got."
          : "Nothing speaks against it: " + percent(calibration.p) +
                " of the rooms differ as much from the others as your log does. That doesn't prove that the room is "
                "among them."};
  io::Table table{{"of a day", "your log", "90 % of rooms", "by weight", "as far out", "share"}, {}};
  for (const Statistic& one : calibration.statistics) {
    table.rows.push_back({one.name + ", " + one.unit, plain(one.of_log), plain(one.of_rooms), plain(one.of_weighty),
                          percent(one.p), one.about == Statistic::About::schedule ? "" : percent(one.share)});
    if (!one.sign.empty()) section.paragraphs.push_back("Unlike: " + what_is_unlike(one) + '.');
  }
  section.paragraphs.emplace_back(
      "As far out: the share of rooms that are at least as far from the middle as your log. Share: of what makes your "
      "log unlike the rooms, that goes without this number; those of the schedule have no part in it.");
  section.tables.push_back(std::move(table));
  section.charts.push_back(statistics_chart(calibration));
  return section;
}

io::ReportSection parameters_section(const Calibration& calibration) {
  io::ReportSection section;
  section.heading = "What the log determined, and what it left open";
  section.paragraphs = {
      "Each parameter's range over the rooms, before and by weight. Narrowed: 0 % is left open, 100 % is determined. "
      "Averages over a room's sensors."};
  io::Table table{{"parameter", "90 % of rooms", "by weight", "mean", "by weight", "narrowed"}, {}};
  for (const ParameterRange& one : calibration.parameters) {
    table.rows.push_back({one.name, plain(one.before), plain(one.after), plain(one.mean_before), plain(one.mean_after),
                          percent(one.narrowed)});
  }
  section.tables.push_back(std::move(table));
  return section;
}

io::ReportSection rooms_section(const Calibration& calibration) {
  io::ReportSection section;
  section.heading = "Which rooms carry the weight";
  section.paragraphs = {how_much_it_told(calibration) +
                        " A room's error is that of a counter made from the others, if that room were yours."};
  std::vector<WeighedRoom> rooms = calibration.rooms;
  std::ranges::stable_sort(rooms, std::greater{}, &WeighedRoom::weight);
  constexpr std::size_t most = 15;
  io::BarChart chart;
  chart.title = "The weightiest rooms";
  chart.label = "weight";
  for (std::size_t i = 0; i < std::min(most, rooms.size()); ++i) {
    io::BarChart::Bar& bar = chart.bars.emplace_back();
    bar.name = "room " + std::to_string(rooms[i].number);
    bar.value = rooms[i].weight;
    bar.text = rooms[i].error ? "error " + fixed(*rooms[i].error, 2) : "nobody was there";
  }
  section.charts.push_back(std::move(chart));
  return section;
}

io::ReportSection error_section(const Calibration& calibration) {
  io::ReportSection section;
  section.heading = "How well will it count?";
  if (calibration.verdict == Verdict::none_like_it) {
    section.paragraphs = {"Nobody knows: your room isn't like those in which the error is known."};
    return section;
  }
  const std::optional<Interval>& expected = calibration.counter.expected_error;
  section.paragraphs = {
      expected ? "In rooms like the weighty ones the counter is wrong by " + fixed(calibration.mean_error, 2) +
                     " people on average, in nine of ten by " + range(*expected) +
                     "; with all rooms weighed alike by " + fixed(calibration.error_alike, 2) + "."
               : std::string("Nobody was in any of the rooms, so that no error can be told."),
      "Mean absolute error, of readings from half an hour before the first person to half an hour after the last. It "
      "holds if your room is like the recipe's. To be sure, count by hand for some hours, and compare."};
  return section;
}

// What a calibration leaves behind for programs: weights, the counter, the numbers of the page, the recipe.

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json pair(const Interval& interval) { return {interval.low, interval.high}; }

constexpr Column<WeighedRoom> weights[]{
    {{"room", Holds::whole, "its number in the pool"}, [](const WeighedRoom& room) -> Cell { return room.number; }},
    {{"weight", Holds::number, "they add up to 1"}, [](const WeighedRoom& room) -> Cell { return room.weight; }},
    {{"log_likelihood", Holds::number, "of the log in this room"},
     [](const WeighedRoom& room) -> Cell { return room.log_likelihood; }},
    {{"error", Holds::number, "in people, of counts in this room by the others; empty: nobody was there", "1"},
     [](const WeighedRoom& room) -> Cell { return room.error ? Cell(*room.error) : Cell(); }},
};

std::string weights_table(const Calibration& calibration) {
  std::ostringstream text;
  io::TableWriter<WeighedRoom> csv(text, std::span<const Column<WeighedRoom>>(weights));
  for (const WeighedRoom& room : calibration.rooms) csv.write(room);
  return text.str();
}

std::string numbers(const Calibration& calibration, const About& about) {
  Json statistics = Json::array(), parameters = Json::array();
  for (const Statistic& one : calibration.statistics) {
    statistics.push_back({{"name", one.name},
                          {"unit", one.unit},
                          {"log", one.of_log},
                          {"rooms", pair(one.of_rooms)},
                          {"weighted", pair(one.of_weighty)},
                          {"p", one.p},
                          {"about", word_of(one.about)},
                          {"share", one.share},
                          {"sign", one.sign},
                          {"advice", one.advice}});
  }
  for (const ParameterRange& one : calibration.parameters) {
    parameters.push_back({{"name", one.name},
                          {"before", pair(one.before)},
                          {"after", pair(one.after)},
                          {"mean_before", one.mean_before},
                          {"mean_after", one.mean_after},
                          {"narrowed", one.narrowed}});
  }
  Json json{{"verdict", word_of(calibration.verdict)},
            {"p", calibration.p},
            {"finding", finding(calibration)},
            {"recipe", about.recipe},
            {"log", about.log},
            {"days", about.n_days},
            {"partial_days", about.partial},
            {"rooms", calibration.rooms.size()},
            {"effective_rooms", calibration.effective_rooms},
            {"mean_error", calibration.mean_error},
            {"mean_error_alike", calibration.error_alike},
            {"expected_error", calibration.counter.expected_error ? pair(*calibration.counter.expected_error) : Json()},
            {"statistics", std::move(statistics)},
            {"parameters", std::move(parameters)}};
  return json.dump(1) + '\n';
}

/// Paths of the user's own scenes, as they are found from the folder.
std::vector<std::string> scene_overrides(const dataset::RecipeSpec& recipe, const fs::path& folder) {
  std::vector<std::string> overrides;
  for (std::size_t g = 0; g < recipe.rooms.size(); ++g) {
    if (recipe.rooms[g].scenes.empty()) continue;
    const auto from_folder = [&](const fs::path& file) {
      return fs::absolute(file).lexically_relative(fs::absolute(folder).lexically_normal()).string();
    };
    Json scenes = Json::array();
    for (const auto& [file, marks] : recipe.rooms[g].scenes) {
      if (marks.empty()) {
        scenes.push_back(from_folder(file));
      } else {
        scenes.push_back({{"scene", from_folder(file)}, {"marks", from_folder(marks)}});
      }
    }
    overrides.push_back("rooms." + std::to_string(g) + ".scenes=" + scenes.dump());
  }
  return overrides;
}

io::Report page(const Calibration& calibration, const About& about) {
  io::Report report;
  report.title = "Calibration";
  report.finding = finding(calibration);
  report.paragraphs = {
      "Log: " + about.log + ", " + days_compared(about) + ". Recipe: " + about.recipe + ", " +
      counted(calibration.rooms.size(), "room") + ". Each room is weighed by how well its model explains the log" +
      (about.n_counted == 0 ? std::string(".")
                            : ", and the counts of " + counted(about.n_counted, "reading") + " in it.")};
  report.sections = {error_section(calibration)};
  if (!calibration.statistics.empty()) report.sections.push_back(statistics_section(calibration));
  report.sections.push_back(parameters_section(calibration));
  report.sections.push_back(rooms_section(calibration));
  report.footer = about.made_by;
  return report;
}

// A log counted.

std::size_t n_counts(const LogCounts& counts) { return static_cast<std::size_t>(counts.estimates.n_counts); }

std::span<const double> probabilities(const LogCounts& counts, std::size_t reading) {
  return std::span(counts.estimates.probabilities).subspan(reading * n_counts(counts), n_counts(counts));
}

/// Of a reading's probabilities.
double mean_count(std::span<const double> probabilities) {
  double mean = 0.0;
  for (std::size_t n = 0; n < probabilities.size(); ++n) mean += static_cast<double>(n) * probabilities[n];
  return mean;
}

/// Stretches in which nobody knows the number.
std::vector<io::SeriesChart::Phase> unknown_phases(const LogCounts& counts, const CountedDay& day) {
  std::vector<io::SeriesChart::Phase> phases;
  for (std::size_t i = day.begin; i < day.end;) {
    std::size_t end = i;
    while (end < day.end && !counts.estimates.is_told(end)) ++end;
    if (end > i) {
      phases.push_back({"unknown", static_cast<double>(i - day.begin) * counts.rows.window_s,
                        static_cast<double>(end - day.begin) * counts.rows.window_s});
    }
    i = std::max(end, i + 1);
  }
  return phases;
}

/// The fewest counts that have nine tenths of a reading's odds.
Interval likely(const LogCounts& counts, std::size_t reading) {
  const auto [least, most] = counts.estimates.band(reading, band_share);
  return {static_cast<double>(least), static_cast<double>(most)};
}

io::SeriesChart chart_of(const LogCounts& counts, const CountedDay& day) {
  const LogRows& rows = counts.rows;
  io::SeriesChart chart;
  chart.title = day.date.empty() ? "The log" : day.date;
  chart.window_s = rows.window_s;
  chart.end_s = static_cast<double>(day.end - day.begin) * rows.window_s;
  for (std::size_t k = 0; k < rows.sensors.size(); ++k) {
    io::SeriesChart::Row row{rows.sensors[k], {}};
    for (std::size_t i = day.begin; i < day.end; ++i) {
      if (rows.at(i, k) == 1) row.times_s.push_back(static_cast<double>(i + 1 - day.begin) * rows.window_s);
    }
    chart.rows.push_back(std::move(row));
  }
  chart.phases = unknown_phases(counts, day);
  for (std::size_t i = day.begin; i < day.end; ++i) {
    io::SeriesChart::Count now{static_cast<double>(i - day.begin) * rows.window_s};
    if (counts.estimates.is_told(i)) now.people = counts.estimates.count(i), now.likely = likely(counts, i);
    const bool is_same =
        !chart.people.empty() && chart.people.back().people == now.people && chart.people.back().likely == now.likely;
    if (!is_same) chart.people.push_back(now);
  }
  if (rows.clock != LogClock::elapsed && day.begin + 1 < rows.n_windows())
    chart.first_clock = to_text(rows.begin[day.begin + 1], rows.clock).substr(0, 19);
  return chart;
}

/// Hours with each count.
io::Table hours_table(const LogCounts& counts, const std::vector<CountedDay>& days) {
  io::Table table{{"day"}, {}};
  for (std::size_t n = 0; n < n_counts(counts); ++n) table.headings.push_back(counted(n, "person", "people") + ", h");
  table.headings.emplace_back("unknown, h");
  for (const CountedDay& day : days) {
    std::vector<double> hours(n_counts(counts) + 1, 0.0);
    for (std::size_t i = day.begin; i < day.end; ++i) {
      const std::size_t column =
          counts.estimates.is_told(i) ? static_cast<std::size_t>(counts.estimates.count(i)) : n_counts(counts);
      hours[column] += counts.rows.window_s / 3600.0;
    }
    std::vector<std::string>& row = table.rows.emplace_back(std::vector<std::string>{day.date});
    for (const double one : hours) row.push_back(fixed(one, 1));
  }
  return table;
}

/// A figure, and how far off it may be.
std::string with_error(const std::string& figure, const std::optional<counting::FiguresOff>& off,
                       counting::Off counting::FiguresOff::*of, int digits, const std::string& unit = "") {
  return figure.empty() || !off ? figure : figure + " +- " + fixed(((*off).*of).most, digits) + unit;
}

constexpr const char* what_errors_are =
    "After +- stands how far off it is at most in nine of ten cases, in the simulated rooms, each left out and counted "
    "as if it were yours.";

io::ReportSection days_section(const LogCounts& counts, const std::vector<CountedDay>& days) {
  using Off = counting::FiguresOff;
  io::ReportSection section{"Each day", {}, {}, {}};
  if (counts.figures_off) section.paragraphs.emplace_back(what_errors_are);
  io::Table table{{"day", "known, h", "with somebody, h", "arrival", "departure", "most people"}, {}};
  for (const CountedDay& day : days) {
    const Figures& figures = day.figures;
    table.rows.push_back({day.date, fixed(figures.told_h, 1),
                          with_error(fixed(figures.occupied_h, 1), day.off, &Off::occupied_h, 1),
                          with_error(day.arrival, day.off, &Off::arrival_min, 1, " min"),
                          with_error(day.departure, day.off, &Off::departure_min, 1, " min"),
                          with_error(std::to_string(figures.most), day.off, &Off::most, 0)});
  }
  section.tables.push_back(std::move(table));
  return section;
}

io::ReportSection hours_section(const LogCounts& counts) {
  using Off = counting::FiguresOff;
  io::ReportSection section{"Each hour of the day", {}, {}, {}};
  section.paragraphs = {
      "On average over the days. The band is as wide as the error that nine of ten hours don't exceed."};
  io::Table table{{"hour", "days", "nobody there", "people", "most people"}, {}};
  io::LineChart chart;
  chart.title = "People by hour";
  chart.x_label = counts.rows.clock == LogClock::elapsed ? "hour of the log" : "hour of the day";
  chart.y_label = "people";
  io::LineChart::Line mean{"on average", {}};
  const std::vector<CountedHour> hours = counted_hours(counts);
  for (const CountedHour& hour : hours) {
    if (hour.days == 0) continue;
    table.rows.push_back(
        {std::to_string(hour.hour), std::to_string(hour.days),
         hour.off ? fixed(100.0 * hour.nobody, 0) + " +- " + percent(hour.off->hour_nobody.most) : percent(hour.nobody),
         with_error(fixed(hour.mean, 2), hour.off, &Off::hour_mean, 2),
         with_error(fixed(hour.most, 1), hour.off, &Off::hour_most, 1)});
    io::LineChart::Point point{hour.hour + 0.5, hour.mean, {}, {}};
    if (hour.off) point.low = std::max(0.0, hour.mean - hour.off->hour_mean.most);
    if (hour.off) point.high = hour.mean + hour.off->hour_mean.most;
    chart.y_high = std::max({chart.y_high, 1.05 * point.y, 1.05 * point.high.value_or(0.0)});
    mean.points.push_back(std::move(point));
  }
  if (!hours.empty()) chart.x_low = hours.front().hour, chart.x_high = hours.back().hour + 1.0;
  chart.lines.push_back(std::move(mean));
  section.tables.push_back(std::move(table));
  section.charts.emplace_back(std::move(chart));
  return section;
}

}  // namespace

std::string word_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::like_these:
      return "like-these";
    case Verdict::none_like_it:
      return "none-like-it";
    case Verdict::too_little_told:
      break;
  }
  return "too-little-told";
}

std::string word_of(Statistic::About about) { return about == Statistic::About::schedule ? "schedule" : "motion"; }

std::string warning_of(Verdict verdict) {
  return verdict == Verdict::none_like_it
             ? "Hardly a room that this counter comes from makes such a log: don't rely on its counts."
             : "";
}

std::string how_much_it_told(const Calibration& calibration) {
  constexpr double hardly = 0.8;  // of the rooms
  const std::string all = counted(calibration.rooms.size(), "room");
  return "The weight is that of " + fixed(calibration.effective_rooms, 1) + " of " + all +
         (calibration.effective_rooms > hardly * static_cast<double>(calibration.rooms.size())
              ? ": the log hardly tells them apart."
              : ".") +
         (calibration.counter.expected_error && calibration.verdict != Verdict::none_like_it
              ? " With all rooms alike the error would be " + fixed(calibration.error_alike, 2) + "."
              : "");
}

std::string finding(const Calibration& calibration) {
  const std::optional<Interval>& expected = calibration.counter.expected_error;
  const std::string error = expected ? " If it is one, expect an error of " + fixed(calibration.mean_error, 2) +
                                           " people (" + range(*expected) + ")."
                                     : "";
  const std::string hours = what_is_unlike(calibration, Statistic::About::schedule);
  const std::string moved = hours.empty() ? "" : " Its hours differ: " + hours + '.';
  switch (calibration.verdict) {
    case Verdict::like_these:
      return "Rooms of this recipe make such logs, so yours may be one of them." + error + moved;
    case Verdict::none_like_it:
      return "Hardly a room of this recipe makes such a log, so that neither counts nor errors can be relied on. Most "
             "unlike: " +
             what_is_unlike(calibration, Statistic::About::motion) + '.' + moved;
    case Verdict::too_little_told:
      break;
  }
  return "Too little is told in the hours that the recipe simulates to say whether yours is one of its rooms: a day "
         "counts if nine tenths of them are known, with some motion." +
         error;
}

std::string days_compared(const About& about) {
  const std::string hours = "from " + hours_text(about.hours.low) + " to " + hours_text(about.hours.high);
  const std::size_t n_partial = about.partial.size();
  if (n_partial == 0) return counted(about.n_days, "day") + ", " + hours;
  constexpr std::size_t most_told = 7;
  std::string dates = joined({about.partial.begin(), about.partial.begin() + std::min(most_told, n_partial)}, ", ");
  if (n_partial > most_told) dates += " and " + counted(n_partial - most_told, "other");
  return (about.n_days == 0 ? "none" : std::to_string(about.n_days)) + " of " +
         counted(about.n_days + n_partial, "day") + ", " + hours + ": on " + dates +
         " a sensor is known for less than nine tenths of these hours" +
         (about.n_days == 0 ? "; so there will be no verdict: let the recipe's schedule have hours that the log has"
                            : "");
}

std::string weighted_recipe(const dataset::RecipeSpec& recipe, const Calibration& calibration, const fs::path& folder) {
  std::vector<double> weights(static_cast<std::size_t>(recipe.n_rooms()), 0.0);
  for (const WeighedRoom& room : calibration.rooms) weights[static_cast<std::size_t>(room.number - 1)] = room.weight;
  std::string listed;
  for (const double weight : weights) listed += (listed.empty() ? "" : ", ") + io::csv_number(weight);
  std::vector<std::string> overrides;
  for (const std::string& change : recipe.overrides) {
    // What makes a pool of it, but for the hold that the log told, isn't for the dataset.
    const bool is_of_pool =
        change.starts_with("sensing.window_s=") || change == "exports=[]" || change == "occupants=false";
    if (!is_of_pool) overrides.push_back(change);
  }
  std::ranges::move(scene_overrides(recipe, folder), std::back_inserter(overrides));
  overrides.push_back("draw_by={count: " + std::to_string(recipe.n_rooms()) + ", weights: [" + listed + "]}");
  overrides.emplace_back("split={validation_rooms: 0, test_rooms: 0, test_days: 0}");
  return "# Rooms drawn as a log weighs them, by pirsim calibrate; of the recipe " + recipe.file.filename().string() +
         ".\n" + io::YamlNode::parse(recipe.given, recipe.file.string(), overrides).to_yaml();
}

void write_calibration(const fs::path& folder, const Calibration& calibration, const About& about) {
  io::write_text_file(folder / "weights.csv", weights_table(calibration));
  counting::write_counter(folder / "counter.json", calibration.counter);
  io::write_text_file(folder / "calibration.json", numbers(calibration, about));
  io::write_report(folder / "calibration.html", page(calibration, about));
}

std::string in_words(const CountError& error) {
  return "wrong by " + fixed(error.mean, 2) + " people on average, over " + counted(error.readings, "reading") +
         (error.occupied == 0 || error.occupied == error.readings
              ? ""
              : "; by " + fixed(error.while_occupied, 2) + " over the " + std::to_string(error.occupied) +
                    " with somebody");
}

std::string how_sure(const LogCounts& counts) {
  std::size_t n = 0, n_sure = 0, n_unknown = 0;
  for (std::size_t i = 0; i < counts.rows.n_windows(); ++i) {
    const int people = counts.estimates.count(i);
    n_unknown += people == counting::unknown_count ? 1U : 0U;
    if (people <= 0) continue;
    ++n;
    n_sure += probabilities(counts, i)[static_cast<std::size_t>(people)] >= sure ? 1U : 0U;
  }
  const auto hours = [&](std::size_t readings) {
    return fixed(static_cast<double>(readings) * counts.rows.window_s / 3600.0, 1);
  };
  std::string told = n == 0 ? ""
                            : "Somebody is there for " + hours(n) + " h; the number is told with 80 % or more for " +
                                  hours(n_sure) + " h of them.";
  if (n_unknown > 0)
    told += (n == 0 ? "" : " ") + ("For " + hours(n_unknown)) + " h nothing is known, and no number is told.";
  return told;
}

void write_counts(std::ostream& out, const LogCounts& counts) {
  const LogRows& rows = counts.rows;
  const bool has_clock = rows.clock != LogClock::elapsed;
  out << (has_clock ? "time" : "time_s") << ",people,mean,least,most";
  for (std::size_t n = 0; n < n_counts(counts); ++n) out << ",p" << n;
  out << '\n';
  for (std::size_t i = 0; i < rows.n_windows(); ++i) {
    LogMoment end = rows.begin[i];
    end.us += std::llround(rows.window_s * 1e6);
    if (i + 1 < rows.n_windows()) end.offset_s = rows.begin[i + 1].offset_s;
    std::string line = has_clock ? to_text(end, rows.clock) : io::csv_number(end.seconds());
    const auto of_reading = probabilities(counts, i);
    const bool is_told = counts.estimates.is_told(i);
    line += ',';
    if (is_told) {
      const auto [least, most] = counts.estimates.band(i, band_share);
      line += std::to_string(counts.estimates.count(i)) + ',' + fixed(mean_count(of_reading), 2) + ',' +
              std::to_string(least) + ',' + std::to_string(most);
    } else {
      line += ",,,";
    }
    for (const double p : of_reading) line += ',' + (is_told ? fixed(p, 3) : "");
    out << line << '\n';
  }
}

void write_counts_page(const std::filesystem::path& file, const LogCounts& counts, const std::string& log,
                       const std::string& made_by) {
  const std::vector<CountedDay> days = counted_days(counts);
  constexpr std::size_t most_days = 31;
  io::Report report;
  report.title = "How many people were there?";
  report.footer = made_by;
  std::string error;
  if (const auto known = error_of(counts))
    error = "Compared with the log's own counts it is " + in_words(*known) + ".";
  else if (counts.expected_error && counts.warning.empty())
    error = "In rooms like those that the counter comes from such counts are wrong by " +
            fixed(counts.expected_error->low, 2) + " to " + fixed(counts.expected_error->high, 2) +
            " people on average, from half an hour before the first person to half an hour after the last.";
  report.finding = counts.warning + (counts.warning.empty() || error.empty() ? "" : " ") + error;
  report.paragraphs = {
      "Log: " + log +
      ". Each day shows the estimated number of people, a line, above the readings with motion of each sensor; nine "
      "times of ten the number is within what is pale."};
  if (const std::string sure = how_sure(counts); !sure.empty()) report.paragraphs.push_back(sure);
  if (days.size() > most_days)
    report.paragraphs.push_back("The first " + std::to_string(most_days) + " days are drawn.");
  report.sections.push_back(days_section(counts, days));
  report.sections.push_back(hours_section(counts));
  report.sections.push_back({"Hours with so many people", {}, {hours_table(counts, days)}, {}});
  io::ReportSection lines{"Day by day", {}, {}, {}};
  for (std::size_t d = 0; d < std::min(days.size(), most_days); ++d)
    lines.charts.emplace_back(chart_of(counts, days[d]));
  report.sections.push_back(std::move(lines));
  io::write_report(file, report);
}

}  // namespace pirsim::calibrate
