#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>

#include "files/disk/file.hpp"
#include "files/read/yaml.hpp"
#include "model/core/text.hpp"
#include "model/schema/clock.hpp"
#include "pirsim/calibrate.hpp"
#include "pirsim/csv.hpp"
#include "show/report.hpp"

// A calibration as a page for a reader.

namespace pirsim::calibrate {

[[nodiscard]] io::Report page(const Calibration& calibration, const About& about);
[[nodiscard]] std::string word_of(Verdict verdict);  ///< "like-these"

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
                "or ask what is in the room that the recipe hasn't got: a pet, a fan, another kind of sensor, a sensor "
                "that died."
          : "Nothing speaks against it: " + percent(calibration.p) +
                " of the rooms differ as much from the others as your log does. That doesn't prove that the room is "
                "among them."};
  io::Table table{{"of a day", "your log", "90 % of rooms", "by weight", "as far out"}, {}};
  for (const Statistic& one : calibration.statistics) {
    table.rows.push_back(
        {one.name + ", " + one.unit, plain(one.of_log), plain(one.of_rooms), plain(one.of_weighty), percent(one.p)});
    if (!one.advice.empty())
      section.paragraphs.push_back("In these rooms, " + one.advice + " brings \"" + one.name +
                                   "\" nearer to your log.");
  }
  section.paragraphs.emplace_back(
      "As far out: the share of rooms that are at least as far from the middle as your log.");
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
  switch (calibration.verdict) {
    case Verdict::like_these:
      return "Rooms of this recipe make such logs, so yours may be one of them." + error;
    case Verdict::none_like_it: {
      std::string outside;
      for (const Statistic& one : calibration.statistics) {
        if (one.p <= verdict_level) outside += (outside.empty() ? "" : "; ") + one.name;
      }
      return "Hardly a room of this recipe makes such a log" +
             (outside.empty() ? " (by its numbers together)" : ": " + outside) +
             ". Neither counts nor errors can be relied on.";
    }
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

// What a calibration leaves behind for programs: weights, the counter, the numbers of the page, the recipe.

namespace {

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

}  // namespace

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

}  // namespace pirsim::calibrate
