#include "reconcile/inference/reconcile.hpp"

#include <utility>

#include "reconcile/inference/loop.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::uint32_t n_pilot_worlds = 40;

}  // namespace

Laboratory make_laboratory(const SceneSpec& scene, const ScriptSpec& script, const Settings& settings,
                           const std::function<DataShape(const StudyFrame&, std::span<const Series>)>& shape_of_data,
                           const Observer& observer) {
  const auto begin = [&](const std::string& stage) {
    if (observer.stage) observer.stage(stage);
  };
  Laboratory lab{{scene, script, settings.nuisance, settings.seed},
                 frame_of(scene, script),
                 cell_knowledge(scene, script),
                 {},
                 {},
                 {}};
  begin("pilot runs");
  const std::vector<Series> pilot = pilot_runs(lab.source, lab.frame, n_pilot_worlds, settings.threads);
  lab.shape = shape_of_data(lab.frame, pilot);
  begin("reference table");
  lab.table = make_reference_table(lab.source, lab.frame, lab.shape, profile_of(lab.frame, script, pilot),
                                   settings.table, settings.table_folder, {observer.progress});
  lab.key = lab.table.key;
  return lab;
}

FeatureMap Laboratory::map(std::vector<std::size_t> trials) const {
  return {frame, knowledge, table.statistics.select_rows(rows_of(table, 0, Part::training)), std::move(trials)};
}

std::shared_ptr<const TableView> Laboratory::view(std::vector<std::size_t> trials, unsigned threads) const {
  return std::make_shared<const TableView>(source.scene, frame, knowledge, table, std::move(trials), threads);
}

Outcome reconcile(const SceneSpec& scene, const ScriptSpec& script, const Measured& measured, const Settings& settings,
                  const Observer& observer) {
  return Loop(scene, script, measured, settings, observer).run();
}

}  // namespace pirsim::reconcile
