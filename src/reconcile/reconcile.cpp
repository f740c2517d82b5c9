#include "pirsim/reconcile/reconcile.hpp"

#include "pirsim/reconcile/analyst.hpp"
#include "reconcile/sentences.hpp"

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
  lab.key = table_key(lab.source, lab.frame, lab.shape, settings.table);
  return lab;
}

Outcome reconcile(const SceneSpec& scene, const ScriptSpec& script, const Measured& measured, const Settings& settings,
                  const Observer& observer) {
  const Laboratory lab = make_laboratory(
      scene, script, settings,
      [&](const StudyFrame& frame, std::span<const Series> pilot) { return shape_of(frame, measured, pilot); },
      observer);
  const std::vector<float> observed = statistics_of(lab.frame, lab.shape, lab.table.profile, measured);
  if (observer.stage) observer.stage("where they differ, and which effects can have made the data");
  const Analyst analyst(lab.frame, lab.knowledge, lab.table, all_trials(lab.frame),
                        {settings.alpha, settings.seed, settings.threads, settings.trees});
  Outcome outcome = analyst.analyse(observed);
  std::vector<std::string> trail{"data " + measured.digest + ", analysis seed " + std::to_string(settings.seed)};
  for (const std::string& note : measured.notes) trail.push_back("data: " + note);
  trail.push_back("table " + lab.key + ": " + std::to_string(lab.table.rows.size()) + " datasets, " +
                  std::to_string(lab.table.n_left_out) + " left out because people couldn't get about");
  outcome.trail.insert(outcome.trail.begin(), trail.begin(), trail.end());
  outcome.table_key = lab.key;
  if (outcome.verdict == Verdict::named) {
    if (observer.stage) observer.stage("does it help on held-out trials");
    outcome.verification =
        verify(lab.source, lab.frame, lab.knowledge, lab.shape, lab.table, observed, outcome,
               {measured.digest, settings.alpha, settings.seed, settings.threads, settings.verify_worlds});
    outcome.sentence = verdict_sentence(outcome, settings.alpha);
  }
  return outcome;
}

}  // namespace pirsim::reconcile
