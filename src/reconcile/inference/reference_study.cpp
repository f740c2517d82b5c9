#include "reconcile/inference/reference_study.hpp"

#include <utility>

#include "core/parallel.hpp"
#include "effects/catalogue.hpp"
#include "reconcile/inference/locate.hpp"

namespace pirsim::reconcile {

TableView::TableView(const SceneSpec& scene, const StudyFrame& frame, const std::vector<CellKnowledge>& knowledge,
                     const ReferenceTable& table, std::vector<std::size_t> trials, unsigned threads)
    : scene_(scene),
      frame_(frame),
      table_(table),
      map_(frame, knowledge, table.statistics.select_rows(rows_of(table, 0, Part::training)), std::move(trials)),
      threads_(threads),
      plain_(table.statistics.select_rows(rows_of(table, 0, Part::all))),
      plain_reference_(tested_features(map_, map_.features(plain_, threads))) {}

const TableView::Rows& TableView::rows() const {
  std::call_once(rows_known_, [this] {
    rows_.features = map_.features(table_.statistics, threads_);
    rows_.p.assign(table_.rows.size(), 1.0);
    std::vector<std::size_t> seen;
    for (std::size_t hypothesis = 1; hypothesis < table_.n_hypotheses(); ++hypothesis) {
      const std::vector<std::size_t> own = rows_of(table_, hypothesis, Part::calibration);
      seen.insert(seen.end(), own.begin(), own.end());
    }
    std::size_t next = 0;
    ordered_parallel<double>(
        seen.size(), threads_,
        [&](std::size_t i) { return plain_reference_.p(tested_features(map_, rows_.features.row(seen[i]))); },
        [&](double& p) { rows_.p[seen[next++]] = p; });
  });
  return rows_;
}

double TableView::p(std::span<const float> statistics) const {
  return plain_reference_.p(tested_statistics(map_, statistics));
}

namespace {

constexpr std::uint32_t n_pilot_realizations = 40;

/// Of those that were asked for by name.
void require_meaning(const SceneSpec& scene, const ScriptSpec& script, const std::vector<std::string>& asked) {
  for (const std::string& name : asked) {
    const effects::EffectInfo& info = effects::find(name).info;
    if (effects::means_anything(info, scene, script.sensing)) continue;
    throw Error(ErrorCode::usage, "effects: " + name +
                                      " can't be looked for: it acts on sensors with response: zones, "
                                      "and every sensor's response is analog");
  }
}

}  // namespace

ReferenceStudy make_reference_study(
    const SceneSpec& scene, const ScriptSpec& script, const Settings& settings,
    const std::function<DataShape(const StudyFrame&, std::span<const Series>)>& shape_of_data, const Context& context) {
  require_meaning(scene, script, settings.table.effects);
  ReferenceStudy reference{{scene, script, settings.nuisance, context.seed, model_to_share(scene, script)},
                           frame_of(scene, script),
                           cell_knowledge(scene, script),
                           {},
                           {},
                           {}};
  context.begin({Stage::What::pilot_runs});
  const std::vector<Series> pilot = pilot_runs(reference.source, reference.frame, n_pilot_realizations, context);
  reference.shape = shape_of_data(reference.frame, pilot);
  context.begin({Stage::What::reference_table});
  reference.table =
      make_reference_table(reference.source, reference.frame, reference.shape,
                           profile_of(reference.frame, script, pilot), settings.table, settings.table_folder, context);
  reference.key = reference.table.key;
  return reference;
}

FeatureMap ReferenceStudy::map(std::vector<std::size_t> trials) const {
  return {frame, knowledge, table.statistics.select_rows(rows_of(table, 0, Part::training)), std::move(trials)};
}

std::vector<std::string> idle_effects(const SceneSpec& scene, const ScriptSpec& script) {
  std::vector<std::string> names;
  for (const effects::Effect* effect : effects::catalogue()) {
    if (!effects::means_anything(effect->info, scene, script.sensing)) names.push_back(effect->info.name);
  }
  return names;
}

std::shared_ptr<const TableView> ReferenceStudy::view(std::vector<std::size_t> trials, unsigned threads) const {
  return std::make_shared<const TableView>(source.scene, frame, knowledge, table, std::move(trials), threads);
}

}  // namespace pirsim::reconcile
