// What a calibration leaves behind for programs: weights, the counter, the numbers of the page, the recipe.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>

#include "calibrate/page.hpp"
#include "io/files/atomic_file.hpp"
#include "io/read/yaml_node.hpp"
#include "pirsim/calibrate.hpp"
#include "pirsim/csv.hpp"

namespace pirsim::calibrate {
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
