// A whole comparison of placements.
#include <utility>

#include "pirsim/look.hpp"
#include "pirsim/sensor_keys.hpp"
#include "studies/placement.hpp"

namespace pirsim {
namespace {

/// Models that the study names and the scene doesn't.
void add_models(SceneSpec& scene, const PlacementSpec& spec, const PlacementOptions& options) {
  for (const auto& [name, where] : spec.models) {
    if (!scene.sensor_models.contains(name))
      scene.sensor_models[name] = io::find_sensor_model(name, options.scene_file, options.scenes, where);
  }
}

/// Of the sensors of any set.
std::vector<Issue> idle_keys(const SceneSpec& scene, const PlacementSpec& spec) {
  SceneSpec hung;
  hung.sensors = scene.sensors;
  for (const SensorSetSpec& set : spec.sets) {
    hung.sensors.insert(hung.sensors.end(), set.sensors.begin(), set.sensors.end());
  }
  hung.sensor_models = scene.sensor_models;
  hung.files = scene.files;
  return idle_sensor_keys(hung, spec.coverage.sensing);
}

}  // namespace

PlacementReport run_placements(SceneSpec scene, const PlacementSpec& spec, const PlacementOptions& options) {
  add_models(scene, spec, options);
  PlacementReport report;
  const auto set_done = options.set_done ? options.set_done : [] {};
  for (const SensorSetSpec& set : spec.sets) {
    report.ranked.push_back(studies::score(scene, spec.coverage, set, options.threads));
    set_done();
  }
  report.warnings = studies::warnings(report.ranked, scene.floor);
  const std::vector<Issue> idle = idle_keys(scene, spec);
  report.warnings.insert(report.warnings.end(), idle.begin(), idle.end());
  if (spec.search) {
    report.search = studies::search_placement(scene, spec.coverage, *spec.search, options.threads, set_done);
    report.ranked.push_back(report.search->even);
    report.ranked.push_back(report.search->found);
  }
  report.ranked = studies::ranked(std::move(report.ranked));
  report.text = studies::to_text(report.ranked) + (report.search ? studies::to_text(*report.search) : "");
  return report;
}

}  // namespace pirsim
