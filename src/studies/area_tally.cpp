#include "studies/area_tally.hpp"

#include <algorithm>

#include "core/text.hpp"
#include "sim/compiled_study.hpp"

namespace pirsim::studies {
namespace {

std::string names_of(const SceneSpec& scene, const std::vector<std::size_t>& sensors) {
  std::vector<std::string> names;
  for (const std::size_t sensor : sensors) names.push_back(scene.sensors[sensor].id);
  return joined(names, ", ");
}

std::string percent(std::int64_t part, std::int64_t whole) {
  return fixed(whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole), 1) + " %";
}

}  // namespace

AreaTally::AreaTally(const Model& model)
    : model_(&model),
      areas_(model.scene()),
      window_s_(model.tick_s() * model.compiled().sensing().ticks_per_window),
      with_motion_(model.areas().size(), 0) {
  for (std::size_t area = 0; area < model.areas().size(); ++area) {
    sums_.push_back({.area = model.areas()[area]});
    sensors_.push_back(areas_.sensors_of(area));
  }
}

void AreaTally::add_run(const RunResult& result) {
  ++runs_;
  for (const Sample& row : result.samples) {
    for (std::size_t area = 0; area < sums_.size(); ++area) {
      sums_[area].add(row.people_of_areas[area]);
      const auto saw_motion = [&](std::size_t sensor) { return row.bits[sensor] != 0; };
      with_motion_[area] += std::ranges::any_of(sensors_[area], saw_motion) ? 1 : 0;
    }
  }
}

io::Table AreaTally::table() const {
  io::Table table{{"area", "floor, m²", "minutes a run, of all people", "rows with people", "most people", "sensors",
                   "rows with motion"},
                  {}};
  for (std::size_t area = 0; area < sums_.size(); ++area) {
    const AreaSums& sums = sums_[area];
    const double minutes = static_cast<double>(sums.person_rows) * window_s_ / 60.0 / std::max(1, runs_);
    const bool is_watched = !sensors_[area].empty();
    table.rows.push_back({sums.area, fixed(areas_.areas_m2()[area], 2), fixed(minutes, 1),
                          percent(sums.occupied, sums.rows), std::to_string(sums.most),
                          is_watched ? names_of(model_->scene(), sensors_[area]) : "none",
                          is_watched ? percent(with_motion_[area], sums.rows) : ""});
  }
  return table;
}

std::string with_sensors(const SceneSpec& scene, const Areas& areas, std::size_t area) {
  const std::string sensors = names_of(scene, areas.sensors_of(area));
  return areas.names()[area] + (sensors.empty() ? "" : " (" + sensors + ")");
}

}  // namespace pirsim::studies
