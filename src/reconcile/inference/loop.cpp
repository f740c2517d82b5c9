#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/effects/catalogue.hpp"
#include "model/core/parallel.hpp"
#include "model/core/random.hpp"
#include "pirsim/io.hpp"
#include "reconcile/data/data_check.hpp"
#include "reconcile/data/measured.hpp"
#include "reconcile/inference/analyst.hpp"
#include "reconcile/inference/locate.hpp"
#include "reconcile/inference/model_check.hpp"
#include "reconcile/inference/residuals.hpp"
#include "reconcile/inference/verify.hpp"
#include "stats/classes.hpp"
#include "stats/conformal.hpp"

// Effect after effect, until the model with them can have made the data.

namespace pirsim::reconcile {

/// One reconciliation in the making.
class Loop {
 public:
  Loop(const SceneSpec& scene, const ScriptSpec& script, const Measured& measured, const Settings& settings,
       const Context& context)
      : scene_(scene), script_(script), measured_(measured), settings_(settings), context_(context) {}
  [[nodiscard]] Outcome run();

 private:
  /// A look at the data with the table of one model.
  struct Step {
    ReferenceStudy reference;
    std::shared_ptr<const TableView> view;  ///< of the reference's table, in the trials that are looked at
    std::vector<DataNote> notes;            ///< what was done with which measured rows
    std::vector<DataFinding> findings;      ///< what is wrong with them; of the first look
    std::vector<float> observed;            ///< statistics of the measured data
    Outcome outcome;
    SeenRows seen;
    std::size_t likeliest = 0;            ///< hypothesis
    FittedEffect best;                    ///< of that hypothesis
    std::vector<FittedEffect> relatives;  ///< of the effect named: what it may be taken for
  };
  const Step& look(const Settings& settings, double level);
  bool look_beyond(RangeEnd& end);  ///< true if a strength there passes: it is applied
  void apply_first();               ///< stronger than was looked for if only that does
  /// A name that a relative would do twice as well without is one of the two.
  void compare_relatives();
  void take_look();  ///< with all that has been applied
  void apply_more();
  /// With all that was applied; none if no effect may explain the rest, or people can hardly get about in that model.
  const Step* look_for_more(double level);
  /// Effects that are worth a table beside those that were applied: beside one, those that the first table doesn't rule
  /// out as its partner; beside more, all that were asked for.
  [[nodiscard]] std::optional<std::vector<std::string>> worth_a_table(double level) const;
  void tell_first(const Step& first);
  void tell(TrailEvent event) { outcome_.trail.push_back(std::move(event)); }
  void conclude();
  [[nodiscard]] bool is_nearest() const;  ///< the one effect applied comes near enough to be told as such
  void take_back();                       ///< the one name that was given
  void explain();
  void explain_rest();
  void verify_effects();
  /// p of the global test of the model with all that has been applied, its data simulated anew.
  [[nodiscard]] GlobalP p_with_all(double level) const;
  [[nodiscard]] Settings with_all(double level, std::vector<std::string> effects) const;
  [[nodiscard]] std::vector<std::string> names() const;
  [[nodiscard]] std::vector<EffectSpec> patch() const;
  [[nodiscard]] std::vector<std::size_t> training_trials() const;

  const SceneSpec& scene_;
  const ScriptSpec& script_;
  const Measured& measured_;
  const Settings& settings_;
  const Context& context_;
  std::deque<Step> steps_;             ///< addresses stay
  std::vector<FittedEffect> applied_;  ///< one of each step
  bool passes_ = false;                ///< the model with all of them can have made the data
  std::optional<Verdict> rest_;        ///< of the last look for more, where one was needed
  Outcome outcome_;
};

// Which second effect may explain, beside a first one, what no effect explains alone?

struct Partner {
  std::string effect;
  double p = 0.0;  ///< of "the two together made the data"
};
/// Effects with which the first one may have made the data, the likeliest first. No pair is simulated: in a realization
/// that has a dataset of either effect, what each changes in the features is added up. A partner is told if these
/// superposed datasets are often enough as strange among themselves as the data are (p above the level, as in the
/// absolute test of the classifier). A superposition is no simulation (docs/validation.md tells how often it
/// finds the true partner). first: hypothesis, 1 or more. measured: statistics.
[[nodiscard]] std::vector<Partner> partners_of(const TableView& view, std::size_t first,
                                               std::span<const float> measured, double level, const Context& context);

namespace {

/// Beside one effect: more of them would take more than a minute to simulate (assumed).
constexpr std::size_t most_partners = 8;

/// The likeliest other effect of the same family, and, beside optics and the environment, of people's motion: a
/// swinging sitter passes for blurred zones, a fan for a draught.
std::vector<FittedEffect> fit_relatives(const Analyst& analyst, const ReferenceTable& table, std::string_view named,
                                        std::span<const float> observed) {
  using effects::Family;
  const auto family_of = [&](std::size_t h) { return effects::find(table.hypothesis_name(h)).info.family; };
  const Family own = effects::find(named).info.family;
  std::vector<Family> families{own};
  if (own == Family::optics || own == Family::environment) families.push_back(Family::motion);
  std::vector<FittedEffect> relatives;
  for (const Family family : families) {
    const std::size_t likeliest = analyst.likeliest(
        observed, [&](std::size_t h) { return family_of(h) == family && table.hypothesis_name(h) != named; });
    if (likeliest > 0) relatives.push_back(analyst.fit(likeliest, observed));
  }
  return relatives;
}

}  // namespace

Outcome Loop::run() {
  const Step& first = look(settings_, settings_.alpha);
  outcome_ = first.outcome;
  tell_first(first);
  const bool named = outcome_.verdict == Verdict::named;
  const bool worth_a_try = outcome_.verdict == Verdict::none_in_catalogue && settings_.max_effects > 1 &&
                           !counts_in_doubt(outcome_.candidates, settings_.alpha);
  if (named || worth_a_try) {
    applied_.push_back(named ? outcome_.fits.front() : first.best);
    apply_first();
    compare_relatives();
    if (outcome_.verdict != Verdict::one_of) {
      apply_more();
      conclude();
    }
  }
  if (outcome_.verdict == Verdict::none_in_catalogue) explain();
  explain_rest();
  outcome_.looked_for = settings_.table.effects;
  verify_effects();
  outcome_.alpha = settings_.alpha;
  outcome_.verdict_of_rows = outcome_.verdict;
  if (any_impossible(outcome_.data_findings)) outcome_.verdict = Verdict::faulty_data;
  return std::move(outcome_);
}

void Loop::explain() {
  if (measured_.kind != Measured::Kind::series) {
    tell(trail::Remark::sums_without_residuals);
    return;
  }
  context_.begin({Stage::What::explaining_residuals});
  outcome_.residuals = explain_residuals(steps_.front().reference, measured_, settings_.alpha, context_);
  tell(trail::Explained{*outcome_.residuals, outcome_.family});
}

/// Whatever is named: something may change from trial to trial or strike all sensors at once. Days by their counts have
/// no trials.
void Loop::explain_rest() {
  if (outcome_.verdict == Verdict::no_disagreement || measured_.kind != Measured::Kind::series) return;
  if (!units_of(script_).empty()) return;
  context_.begin({Stage::What::explaining_residuals});
  try {
    outcome_.left_over =
        reconcile::explain_rest(steps_.front().reference, applied_, measured_, settings_.alpha, context_);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::infeasible) throw;
  }
  if (outcome_.left_over) tell(trail::LeftOver{*outcome_.left_over});
}

const Loop::Step& Loop::look(const Settings& settings, double level) {
  ScriptSpec script = script_;
  for (const FittedEffect& effect : applied_) script.effects.push_back(effect.effect);
  Step& step = steps_.emplace_back();
  step.reference = make_reference_study(
      scene_, script, settings,
      [&](const StudyFrame& frame, std::span<const Series> pilot) {
        DataShape shape = shape_of(frame, measured_, pilot);
        step.notes = notes_on(frame, shape, measured_, pilot);
        if (applied_.empty()) step.findings = check_data(frame, measured_, pilot);
        return shape;
      },
      context_);
  step.observed = statistics_of(step.reference.frame, step.reference.shape, step.reference.table.profile, measured_);
  context_.begin({Stage::What::comparing});
  step.view = step.reference.view(training_trials(), context_.threads);
  if (step.view->p(step.observed) > level) {
    step.outcome = agreement(*step.view, step.observed, level, context_);
    return step;
  }
  const Analyst analyst(step.view, {level, settings_.trees}, context_);
  step.outcome = analyst.analyse(step.observed);
  step.seen = analyst.classifier().seen_rows();
  step.likeliest = analyst.likeliest(step.observed, [](std::size_t) { return true; });
  if (step.likeliest > 0) step.best = analyst.fit(step.likeliest, step.observed);
  if (step.outcome.verdict == Verdict::named && applied_.empty())
    step.relatives = fit_relatives(analyst, step.reference.table, step.outcome.named.front(), step.observed);
  return step;
}

void Loop::tell_first(const Step& first) {
  const ReferenceStudy& reference = first.reference;
  std::vector<TrailEvent> trail{trail::Begun{measured_.digest, context_.seed}};
  outcome_.notes = first.notes;
  outcome_.data_findings = first.findings;
  const std::vector<std::string> idle = idle_effects(scene_, script_);
  if (!idle.empty()) outcome_.notes.push_back({DataNote::What::effects_idle, idle.size(), idle});
  trail.insert(trail.end(), measured_.notes.begin(), measured_.notes.end());
  trail.insert(trail.end(), outcome_.notes.begin(), outcome_.notes.end());
  trail.insert(trail.end(), outcome_.data_findings.begin(), outcome_.data_findings.end());
  trail::HeldOut held_out;
  for (const std::size_t trial : settings_.holdout) held_out.trials.push_back(reference.frame.trials[trial]);
  if (!held_out.trials.empty()) trail.emplace_back(std::move(held_out));
  trail.emplace_back(trail::Table{reference.key, reference.table.rows.size(), reference.table.n_left_out});
  outcome_.trail.insert(outcome_.trail.begin(), trail.begin(), trail.end());
  outcome_.table_key = reference.key;
}

/// Fewer datasets: what is left to be found is found in a third of them, if these can rule anything out at the lower
/// level. Kept beside the first table.
Settings Loop::with_all(double level, std::vector<std::string> effects) const {
  Settings settings = settings_;
  settings.table.effects = std::move(effects);
  const auto third = [level](std::uint32_t n) { return std::max(fewest_datasets_to_refuse(level), n / 3); };
  settings.alpha = level;
  settings.table.n_realizations = third(settings.table.n_realizations);
  settings.table.n_remembered = third(settings.table.n_remembered);
  settings.table.n_traced = third(settings.table.n_traced);
  if (settings.table_folder.empty()) return settings;
  ScriptSpec only;  // other data give another strength, and so another table
  only.effects = patch();
  settings.table_folder += "_with";
  for (const FittedEffect& effect : applied_) settings.table_folder += "_" + effect.effect.name;
  std::string text = io::to_yaml(only);
  for (const std::string& effect : settings.table.effects) text += ' ' + effect;
  settings.table_folder += "_" + sha256(text).substr(0, 8);
  return settings;
}

std::optional<std::vector<std::string>> Loop::worth_a_table(double level) const {
  if (applied_.size() > 1) return settings_.table.effects;
  const Step& first = steps_.front();
  const std::size_t hypothesis = hypothesis_of(first.reference.table, applied_.front().effect.name);
  const std::vector<Partner> partners = partners_of(*first.view, hypothesis, first.observed, level, context_);
  if (partners.empty()) return std::nullopt;
  std::vector<std::string> likeliest;
  for (std::size_t i = 0; i < std::min(partners.size(), most_partners); ++i) likeliest.push_back(partners[i].effect);
  return likeliest;
}

void Loop::apply_first() {
  take_look();
  auto end = range_end_of(applied_.front());
  if (passes_ && !end) return;
  if (!passes_) {
    auto tried = end ? end : strong_end_of(applied_.front());
    if (tried && (look_beyond(*tried) || end)) end = tried;
  }
  if (!end) return;
  tell(trail::AtRangeEnd{*end});
  outcome_.range_end = std::move(end);
  if (outcome_.range_end->found) take_look();
}

bool Loop::look_beyond(RangeEnd& end) {
  const Step& plain = steps_.front();
  auto beyond = fitted_beyond(applied_.front(), end, plain.reference, plain.reference.map(training_trials()),
                              plain.observed, outcome_.looks.back().level, context_);
  if (!beyond) return false;
  applied_.front() = std::move(*beyond);
  if (!outcome_.fits.empty()) outcome_.fits.front() = applied_.front();
  return true;
}

void Loop::compare_relatives() {
  if (outcome_.verdict != Verdict::named) return;
  const Step& plain = steps_.front();
  if (plain.relatives.empty()) return;
  std::vector<PatchedModel> models;
  for (const FittedEffect& relative : plain.relatives) models.push_back({std::span(&relative, 1), plain.observed});
  const Look named = outcome_.looks.back();
  const std::vector<GlobalP> p =
      p_with(models, plain.reference, plain.reference.map(training_trials()), named.level, context_);
  for (std::size_t i = 0; i < p.size(); ++i) {
    outcome_.relatives.push_back({{plain.relatives[i].effect.name}, named.level, p[i].p, {}, p[i].least});
    tell(outcome_.relatives.back());
  }
  const Look* better = better_relative(outcome_.relatives, named);
  if (better == nullptr) return;
  const std::string& relative = better->applied.front();
  outcome_.verdict = Verdict::one_of;
  outcome_.named = {applied_.front().effect.name, relative};
  outcome_.fits.clear();
  for (Candidate& candidate : outcome_.candidates) {
    if (candidate.score.hypothesis != relative) continue;
    candidate.kept = true;
    candidate.reason = reason::DoesBetter{better->p, outcome_.named.front(), named.p};
  }
  tell(trail::Remark::relative_does_better);
}

void Loop::take_look() {
  const double level = level_with(applied_.size(), settings_.alpha);
  const GlobalP p = p_with_all(level);
  outcome_.looks.push_back({names(), level, p.p, {}, p.least});
  passes_ = outcome_.looks.back().passes();
  tell(outcome_.looks.back());
}

void Loop::apply_more() {
  for (;;) {
    if (passes_ || static_cast<int>(applied_.size()) >= settings_.max_effects) return;
    const std::size_t n_asked = settings_.table.effects.size();  // 0: the whole catalogue
    if (n_asked != 0 && applied_.size() >= n_asked) return;
    context_.begin({Stage::What::looking_for_more, names()});
    const Step* more = look_for_more(outcome_.looks.back().level);
    if (more == nullptr) return;
    rest_ = more->outcome.verdict;
    tell(trail::LookedForMore{*rest_});
    if (more->outcome.verdict == Verdict::one_of) outcome_.looks.back().one_of = more->outcome.named;
    if (more->outcome.verdict != Verdict::named) return;
    applied_.push_back(more->outcome.fits.front());
    take_look();
  }
}

const Loop::Step* Loop::look_for_more(double level) {
  auto effects = worth_a_table(level);
  if (!effects) {
    rest_ = Verdict::none_in_catalogue;
    tell(trail::Remark::no_partner);
    return nullptr;
  }
  try {
    return &look(with_all(level, std::move(*effects)), level);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::infeasible) throw;
    steps_.pop_back();
    tell(trail::Remark::nothing_more_simulated);
    return nullptr;
  }
}

/// One effect that was named stands, unless it is the only one that isn't ruled out, the model with it can't have made
/// the data, and nothing known explains the rest; that two or more together made the data is said if the first of them
/// was named by itself, or if the model with all of them passes.
void Loop::conclude() {
  const bool only_one = std::ranges::count(outcome_.candidates, true, &Candidate::kept) == 1;
  if (outcome_.verdict == Verdict::named && applied_.size() == 1 && only_one && !passes_ &&
      rest_ == Verdict::none_in_catalogue) {
    take_back();
    return;
  }
  if (applied_.size() > 1 && (passes_ || outcome_.verdict == Verdict::named)) {
    outcome_.verdict = Verdict::several;
    outcome_.named = names();
    outcome_.fits = applied_;
    for (Candidate& candidate : outcome_.candidates) {
      if (std::ranges::find(outcome_.named, candidate.score.hypothesis) == outcome_.named.end()) continue;
      candidate.kept = true;
      candidate.named_together = true;
    }
  } else if (outcome_.verdict == Verdict::none_in_catalogue && is_nearest()) {
    outcome_.verdict = Verdict::nearest;
    outcome_.named = names();
    outcome_.fits = applied_;
  } else if (outcome_.verdict == Verdict::none_in_catalogue) {
    applied_.clear();
  }
}

bool Loop::is_nearest() const {
  if (applied_.size() != 1) return false;
  const auto candidate = std::ranges::find(outcome_.candidates, applied_.front().effect.name,
                                           [](const Candidate& c) { return c.score.hypothesis; });
  return candidate != outcome_.candidates.end() && comes_nearest(candidate->score, outcome_.looks.back());
}

void Loop::take_back() {
  const auto refused = std::ranges::find(outcome_.candidates, true, &Candidate::kept);
  refused->kept = false;
  refused->reason = reason::RefusedWhenApplied{outcome_.looks.back().p, outcome_.looks.back().least_p};
  outcome_.verdict = Verdict::none_in_catalogue;
  outcome_.named.clear();
  outcome_.fits.clear();
  applied_.clear();
  tell(trail::Remark::refused_when_applied);
}

void Loop::verify_effects() {
  if (outcome_.named.empty()) return;
  const bool one_of = outcome_.verdict == Verdict::one_of;
  Claim claim{{}, outcome_.named};
  const std::size_t n = one_of ? 1 : applied_.size();
  for (std::size_t i = 0; i < n; ++i)
    claim.steps.push_back({&steps_[i].reference, steps_[i].observed,
                           one_of ? outcome_.named.front() : applied_[i].effect.name, steps_[i].seen});
  const ReferenceStudy& reference = steps_.front().reference;
  const std::vector<std::size_t> trials = measured_.trials();
  if (trials.size() < 2) {
    tell(trail::Remark::one_trial_only);
    return;
  }
  context_.begin({Stage::What::verifying});
  const Folds folds = settings_.holdout.empty() ? usual_folds(measured_.digest, trials, reference.shape.kind)
                                                : Folds{settings_.holdout};
  // Days are simulated as a whole for every fold, whatever it holds out.
  const std::uint32_t n_realizations = settings_.verify_realizations / (reference.frame.units.empty() ? 1 : 3);
  Verification v = verify(std::span(&claim, 1), folds, {settings_.alpha, n_realizations}, context_).front();
  if (v.n_trials == 0) {
    tell(trail::Remark::patched_impassable);
    return;
  }
  tell(trail::JudgedOnHeldOut{v});
  if (!v.refused) tell(trail::Remark::held_out_too_weak);
  outcome_.verification = std::move(v);
}

GlobalP Loop::p_with_all(double level) const {
  context_.begin({Stage::What::checking_model, names()});
  const Step& plain = steps_.front();
  const PatchedModel model{applied_, plain.observed};
  return p_with(std::span(&model, 1), plain.reference, plain.reference.map(training_trials()), level, context_).front();
}

std::vector<std::string> Loop::names() const {
  std::vector<std::string> all;
  for (const FittedEffect& effect : applied_) all.push_back(effect.effect.name);
  return all;
}

std::vector<EffectSpec> Loop::patch() const {
  std::vector<EffectSpec> all;
  for (const FittedEffect& effect : applied_) all.push_back(effect.effect);
  return all;
}

std::vector<std::size_t> Loop::training_trials() const {
  std::vector<std::size_t> trials;
  std::ranges::set_difference(all_trials(steps_.front().reference.frame), settings_.holdout,
                              std::back_inserter(trials));
  return trials;
}

Settings settings_of(const ScriptSpec& script, double alpha, double budget, const std::vector<std::string>& effects) {
  if (!(alpha >= 0.001 && alpha <= 0.5)) throw Error(ErrorCode::usage, "alpha: expected 0.001 to 0.5");
  if (!(budget >= 0.05 && budget <= 20.0)) throw Error(ErrorCode::usage, "budget: expected 0.05 to 20");
  Settings settings;
  settings.alpha = alpha;
  for (const std::string& effect : effects) {
    const std::string& name = effects::find(effect).info.name;
    if (std::ranges::find(settings.table.effects, name) != settings.table.effects.end())
      throw Error(ErrorCode::usage, "effects: " + name + " twice");
    if (std::ranges::find(script.effects, name, &EffectSpec::name) != script.effects.end())
      throw Error(ErrorCode::usage, "effects: the script already has " + name + "; it isn't looked for again");
    settings.table.effects.push_back(name);
  }
  for (std::uint32_t* n : {&settings.table.n_realizations, &settings.table.n_remembered, &settings.table.n_traced})
    *n = std::max(fewest_datasets_to_refuse(alpha), static_cast<std::uint32_t>(*n * budget));
  return settings;
}

Outcome reconcile(const SceneSpec& scene, const ScriptSpec& script, const Measured& measured, const Settings& settings,
                  const Context& context) {
  require_known_presence(script);
  const ScriptSpec held = with_holds(scene, script, measured);
  return Loop(scene, held, measured, settings, context).run();
}

namespace {

constexpr std::size_t fewest_pairs = 60;  ///< superposed datasets: two thirds of fewer have no shape (assumed)

using RowIn = std::map<std::uint32_t, std::size_t>;  ///< realization -> row of the table

std::vector<RowIn> rows_by_realization(const ReferenceTable& table) {
  std::vector<RowIn> rows(table.n_hypotheses());
  for (std::size_t i = 0; i < table.rows.size(); ++i) rows[table.rows[i].hypothesis][table.rows[i].realization] = i;
  return rows;
}

stats::Matrix<float> superposed(const stats::Matrix<float>& features, const RowIn& plain, const RowIn& first,
                                const RowIn& second) {
  stats::Matrix<float> sums;
  for (const auto& [realization, row] : first) {
    const auto other = second.find(realization), none = plain.find(realization);
    if (other == second.end() || none == plain.end()) continue;
    std::vector<float> sum(features.columns());
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] = features(row, i) + features(other->second, i) - features(none->second, i);
    sums.append_row(std::span<const float>(sum));
  }
  return sums;
}

/// How strange the data are among the rows, by the strangest block: p of two thirds of them against the others.
double p_among(const stats::Matrix<float>& rows, std::span<const float> data,
               const std::vector<std::vector<std::size_t>>& blocks, std::uint64_t seed) {
  std::vector<std::size_t> fitting, calibration;
  for (std::size_t i = 0; i < rows.rows(); ++i) (i % 3 == 0 ? calibration : fitting).push_back(i);
  stats::Matrix<double> known(calibration.size(), blocks.size());
  std::vector<double> own;
  const std::vector<int> one_class(fitting.size(), 0);
  stats::Matrix<float> wanted;
  wanted.append_row(data);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const stats::Matrix<float> block = rows.select_columns(blocks[b]);
    const auto shape = stats::ClassShapes::fit(block.select_rows(fitting), one_class, 1, {.seed = seed, .threads = 1});
    for (std::size_t i = 0; i < calibration.size(); ++i)
      known(i, b) = std::cbrt(shape.strangeness(block.row(calibration[i]), 0));
    own.push_back(std::cbrt(shape.strangeness(wanted.select_columns(blocks[b]).row(0), 0)));
  }
  return stats::StrangestMeasure(known).p(own);
}

}  // namespace

std::vector<Partner> partners_of(const TableView& view, std::size_t first, std::span<const float> measured,
                                 double level, const Context& context) {
  const ReferenceTable& table = view.table();
  const std::vector<RowIn> rows = rows_by_realization(table);
  const std::vector<float> data = view.map().features(measured);
  std::vector<Partner> partners;
  std::size_t second = 0;
  ordered_parallel<double>(
      table.n_hypotheses() - 1, context.threads,
      [&](std::size_t i) {
        if (i + 1 == first) return 0.0;
        const stats::Matrix<float> pairs = superposed(view.features(), rows[0], rows[first], rows[i + 1]);
        // Too few to tell: not ruled out, but after all that are compared.
        if (pairs.rows() < fewest_pairs) return std::nextafter(level, 1.0);
        return p_among(pairs, data, view.map().blocks(), context.seed);
      },
      [&](double& p) {
        ++second;
        if (p > level) partners.push_back({table.hypothesis_name(second), p});
      });
  std::ranges::stable_sort(partners, std::ranges::greater{}, &Partner::p);
  return partners;
}

}  // namespace pirsim::reconcile
