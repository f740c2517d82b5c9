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
  lab.key = table_key(lab.source, lab.frame, lab.shape.n_replicates, settings.table);
  return lab;
}

namespace {

Analyst analyst_of(const Laboratory& lab, const Settings& settings, double alpha) {
  return {lab.frame,
          lab.knowledge,
          lab.table,
          all_trials(lab.frame),
          {alpha, settings.seed, settings.threads, settings.trees}};
}

void begin(const Observer& observer, const std::string& stage) {
  if (observer.stage) observer.stage(stage);
}

Verification verified(const Laboratory& lab, std::span<const float> observed, const Outcome& outcome,
                      const Measured& measured, const Settings& settings) {
  return verify(lab.source, lab.frame, lab.knowledge, lab.shape, lab.table, observed, outcome,
                {measured.digest, settings.alpha, settings.seed, settings.threads, settings.verify_worlds});
}

/// A table for the second look: what is left to be found is found in a third of the datasets.
Settings smaller(Settings settings, const std::string& effect) {
  const auto third = [](std::uint32_t n) { return std::max(fewest_datasets_to_refuse, n / 3); };
  settings.table.n_worlds = third(settings.table.n_worlds);
  settings.table.n_remembered = third(settings.table.n_remembered);
  settings.table.n_traced = third(settings.table.n_traced);
  if (!settings.table_folder.empty()) settings.table_folder += "_with_" + effect;
  return settings;
}

/// Looks again with one effect put in, at a stricter level: each look spends its part of alpha.
void look_again(const SceneSpec& scene, const ScriptSpec& script, const Measured& measured, const Settings& settings,
                const Observer& observer, const FittedEffect& first, Outcome& outcome) {
  ScriptSpec with_first = script;
  with_first.effects.push_back(first.effect);
  const double alpha = settings.alpha / 2.0;
  begin(observer, "what is missing beside " + first.effect.name);
  const Settings second = smaller(settings, first.effect.name);
  const Laboratory lab = make_laboratory(
      scene, with_first, second,
      [&](const StudyFrame& frame, std::span<const Series> pilot) { return shape_of(frame, measured, pilot); },
      observer);
  const std::vector<float> observed = statistics_of(lab.frame, lab.shape, lab.table.profile, measured);
  const Outcome more = analyst_of(lab, second, alpha).analyse(observed);
  outcome.trail.push_back("with " + first.effect.name + " put in, at level " + short_number(alpha) + ": " +
                          std::string(name(more.verdict)) + ", p " + short_number(more.location.p));
  if (more.verdict != Verdict::named || more.named.front() == first.effect.name) return;
  outcome.verdict = Verdict::several;
  outcome.named = {first.effect.name, more.named.front()};
  outcome.fits = {first, more.fits.front()};
  if (!outcome.verification) outcome.verification = verified(lab, observed, more, measured, second);
}

}  // namespace

Outcome reconcile(const SceneSpec& scene, const ScriptSpec& script, const Measured& measured, const Settings& settings,
                  const Observer& observer) {
  const Laboratory lab = make_laboratory(
      scene, script, settings,
      [&](const StudyFrame& frame, std::span<const Series> pilot) { return shape_of(frame, measured, pilot); },
      observer);
  const std::vector<float> observed = statistics_of(lab.frame, lab.shape, lab.table.profile, measured);
  begin(observer, "where they differ, and which effects can have made the data");
  const Analyst analyst = analyst_of(lab, settings, settings.alpha);
  Outcome outcome = analyst.analyse(observed);
  std::vector<std::string> trail{"data " + measured.digest + ", analysis seed " + std::to_string(settings.seed)};
  for (const std::string& note : measured.notes) trail.push_back("data: " + note);
  trail.push_back("table " + lab.key + ": " + std::to_string(lab.table.rows.size()) + " datasets, " +
                  std::to_string(lab.table.n_left_out) + " left out because people couldn't get about");
  outcome.trail.insert(outcome.trail.begin(), trail.begin(), trail.end());
  outcome.table_key = lab.key;
  if (outcome.verdict == Verdict::named) {
    begin(observer, "does it help on held-out trials");
    outcome.verification = verified(lab, observed, outcome, measured, settings);
    const bool all_told = outcome.verification->after.p > settings.alpha;
    if (!all_told && settings.max_effects > 1) {
      look_again(scene, script, measured, settings, observer, FittedEffect(outcome.fits.front()), outcome);
    }
  } else if (outcome.verdict == Verdict::none_in_catalogue && settings.max_effects > 1) {
    const std::size_t likeliest = analyst.likeliest(observed, [](std::size_t) { return true; });
    look_again(scene, script, measured, settings, observer, analyst.fit(likeliest, observed), outcome);
  }
  outcome.sentence = verdict_sentence(outcome, settings.alpha);
  return outcome;
}

}  // namespace pirsim::reconcile
