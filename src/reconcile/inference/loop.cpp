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
#include "model/core/text.hpp"
#include "model/schema/fields.hpp"
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
namespace {

/// Beside one effect: more of them would take more than a minute to simulate (assumed).
constexpr std::size_t most_partners = 8;
constexpr std::uint32_t n_periodic = 40;  ///< datasets of each, by which repeated rows are judged (assumed)
constexpr const char* explaining = "what the residuals follow";

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

// Which second effect may explain, beside a first one, what no effect explains alone?

struct Partner {
  std::string effect;
  double p = 0.0;  ///< of "the two together made the data"
};
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
    sums.append_row(sum);
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

/// Effects with which the first one may have made the data, the likeliest first. No pair is simulated: in a realization
/// that has a dataset of either effect, what each changes in the features is added up. A partner is told if these
/// superposed datasets are often enough as strange among themselves as the data are (p above the level, as in the
/// absolute test of the classifier). A superposition is no simulation (docs/validation.md tells how often it
/// finds the true partner). first: hypothesis, 1 or more. measured: statistics.
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

/// One reconciliation in the making.
class Loop {
 public:
  Loop(const SceneSpec& scene, const ScriptSpec& script, const Measured& measured, const Settings& settings,
       const Context& context)
      : scene_(scene), script_(script), measured_(measured), settings_(settings), context_(context) {}

  [[nodiscard]] Outcome run() {
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

 private:
  /// A look at the data with the table of one model.
  struct Step {
    ReferenceStudy reference;
    std::shared_ptr<const TableView> view;  ///< of the reference's table, in the trials that are looked at
    std::vector<std::string> notes;         ///< what was done with which measured rows
    std::vector<DataFinding> findings;      ///< what is wrong with them; of the first look
    std::vector<float> observed;            ///< statistics of the measured data
    Outcome outcome;
    SeenRows seen;
    FittedEffect best;                    ///< of the likeliest hypothesis
    std::vector<FittedEffect> relatives;  ///< of the effect named: what it may be taken for
  };
  const Step& look(const Settings& settings, double level) {
    ScriptSpec script = script_;
    for (const FittedEffect& effect : applied_) script.effects.push_back(effect.effect);
    Step& step = steps_.emplace_back();
    step.reference = make_reference_study(
        scene_, script, settings,
        [&](const StudyFrame& frame, std::span<const Series> pilot) {
          DataShape shape = shape_of(frame, measured_, pilot);
          step.notes = notes_on(frame, shape, measured_, pilot);
          const auto periodic = [&] {
            const RealizationSource source{scene_, script, settings.nuisance, context_.seed};
            return surroundings_pilot(source, frame, shape.n_replicates, n_periodic, context_);
          };
          if (applied_.empty()) step.findings = check_data(frame, measured_, pilot, periodic);
          return shape;
        },
        context_);
    step.observed = statistics_of(step.reference.frame, step.reference.shape, step.reference.table.profile, measured_);
    context_.begin("where they differ, and which effects can have made the data");
    step.view = step.reference.view(training_trials(), context_.threads);
    if (step.view->p(step.observed) > level) {
      step.outcome = agreement(*step.view, step.observed, level, context_);
      return step;
    }
    const Analyst analyst(step.view, {level, settings_.trees}, context_);
    step.outcome = analyst.analyse(step.observed);
    step.seen = analyst.classifier().seen_rows();
    const std::size_t likeliest = analyst.likeliest(step.observed, [](std::size_t) { return true; });
    if (likeliest > 0) step.best = analyst.fit(likeliest, step.observed);
    if (step.outcome.verdict == Verdict::named && applied_.empty())
      step.relatives = fit_relatives(analyst, step.reference.table, step.outcome.named.front(), step.observed);
    return step;
  }

  /// True if a strength there passes: it is applied.
  bool look_beyond(RangeEnd& end) {
    const Step& plain = steps_.front();
    auto beyond = fitted_beyond(applied_.front(), end, plain.reference, plain.view->map(), plain.observed,
                                outcome_.looks.back().level, context_);
    if (!beyond) return false;
    applied_.front() = std::move(*beyond);
    if (!outcome_.fits.empty()) outcome_.fits.front() = applied_.front();
    return true;
  }

  /// Stronger than was looked for if only that does.
  void apply_first() {
    take_look();
    auto end = range_end_of(applied_.front());
    if (passes_ && !end) return;
    if (!passes_) {
      auto tried = end ? end : strong_end_of(applied_.front());
      if (tried && (look_beyond(*tried) || end)) end = tried;
    }
    if (!end) return;
    tell_end(*end);
    outcome_.range_end = std::move(end);
    if (outcome_.range_end->found) take_look();
  }

  /// A name that a relative would do twice as well without is one of the two.
  void compare_relatives() {
    if (outcome_.verdict != Verdict::named) return;
    const Step& plain = steps_.front();
    if (plain.relatives.empty()) return;
    std::vector<PatchedModel> models;
    for (const FittedEffect& relative : plain.relatives) models.push_back({std::span(&relative, 1), plain.observed});
    const Look named = outcome_.looks.back();
    const std::vector<GlobalP> p = p_with(models, plain.reference, plain.view->map(), named.level, context_);
    for (std::size_t i = 0; i < p.size(); ++i) {
      outcome_.relatives.push_back({{plain.relatives[i].effect.name}, named.level, p[i].p, {}, p[i].least});
      tell_look(outcome_.relatives.back());
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
      candidate.reason = {"Kept", "applied to the model, it makes such data oftener than " + outcome_.named.front() +
                                      " does (" + p_in_words(better->p) + "), against " + short_number(named.p) + "."};
    }
    tell("the name is taken back: a relative applied in its place does better");
  }

  /// Tests the model with all that has been applied.
  void take_look() {
    const double level = level_with(applied_.size(), settings_.alpha);
    context_.begin("does the model with " + joined(names(), " + ") + " applied pass");
    const Step& plain = steps_.front();
    const PatchedModel model{applied_, plain.observed};
    const GlobalP p = p_with(std::span(&model, 1), plain.reference, plain.view->map(), level, context_).front();
    outcome_.looks.push_back({names(), level, p.p, {}, p.least});
    passes_ = outcome_.looks.back().passes();
    tell_look(outcome_.looks.back());
  }

  void apply_more() {
    for (;;) {
      if (passes_ || static_cast<int>(applied_.size()) >= settings_.max_effects) return;
      const std::size_t n_asked = settings_.table.effects.size();  // 0: the whole catalogue
      if (n_asked != 0 && applied_.size() >= n_asked) return;
      context_.begin("what is missing beside " + joined(names(), " + "));
      const Step* more = look_for_more(outcome_.looks.back().level);
      if (more == nullptr) return;
      rest_ = more->outcome.verdict;
      tell("looked for more: " + std::string(name(*rest_)));
      if (more->outcome.verdict == Verdict::one_of) outcome_.looks.back().one_of = more->outcome.named;
      if (more->outcome.verdict != Verdict::named) return;
      applied_.push_back(more->outcome.fits.front());
      take_look();
    }
  }

  /// With all that was applied; none if no effect may explain the rest, or people can hardly get about in that model.
  const Step* look_for_more(double level) {
    auto effects = worth_a_table(level);
    if (!effects) {
      rest_ = Verdict::none_in_catalogue;
      tell("added to it, no other effect comes near these data: nothing more is looked for");
      return nullptr;
    }
    try {
      return &look(with_all(level, std::move(*effects)), level);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::infeasible) throw;
      steps_.pop_back();
      tell("people can hardly get about in that model: nothing more is looked for in it");
      return nullptr;
    }
  }

  /// Effects that are worth a table beside those that were applied: beside one, those that the first table doesn't rule
  /// out as its partner; beside more, all that were asked for.
  [[nodiscard]] std::optional<std::vector<std::string>> worth_a_table(double level) const {
    if (applied_.size() > 1) return settings_.table.effects;
    const Step& first = steps_.front();
    const std::size_t hypothesis = hypothesis_of(first.reference.table, applied_.front().effect.name);
    const std::vector<Partner> partners = partners_of(*first.view, hypothesis, first.observed, level, context_);
    if (partners.empty()) return std::nullopt;
    std::vector<std::string> likeliest;
    for (std::size_t i = 0; i < std::min(partners.size(), most_partners); ++i) likeliest.push_back(partners[i].effect);
    return likeliest;
  }

  void tell_first(const Step& first) {
    const ReferenceStudy& reference = first.reference;
    std::vector<std::string> trail{"data " + measured_.digest + ", analysis seed " + std::to_string(context_.seed)};
    outcome_.notes = first.notes;
    outcome_.data_findings = first.findings;
    std::vector<std::string> idle;
    for (const effects::Effect* effect : effects::catalogue()) {
      if (!effects::means_anything(effect->info, scene_, script_.sensing)) idle.push_back(effect->info.name);
    }
    if (!idle.empty())
      outcome_.notes.push_back(joined(idle, ", ") + (idle.size() == 1 ? " isn't" : " aren't") +
                               " looked for: to an analog sensor " + (idle.size() == 1 ? "it means" : "they mean") +
                               " nothing.");
    for (const auto* notes : {&measured_.notes, &std::as_const(outcome_.notes)}) {
      for (const std::string& note : *notes) trail.push_back("data: " + note);
    }
    for (const DataFinding& finding : outcome_.data_findings) trail.push_back("file: " + in_words(finding));
    std::vector<std::string> held_out;
    for (const std::size_t trial : settings_.holdout) held_out.push_back(reference.frame.trials[trial]);
    if (!held_out.empty()) trail.push_back("held out from naming and fitting: " + joined(held_out, " "));
    trail.push_back("table " + reference.table.key + ": " + std::to_string(reference.table.rows.size()) +
                    " datasets, " + std::to_string(reference.table.n_left_out) +
                    " left out because people couldn't get about");
    outcome_.trail.insert(outcome_.trail.begin(), trail.begin(), trail.end());
    outcome_.table_key = reference.table.key;
  }

  void tell(std::string line) { outcome_.trail.push_back(std::move(line)); }
  void tell_look(const Look& look) {
    tell("with " + joined(look.applied, " + ") + " applied, at level " + short_number(look.level) + ": " +
         p_in_words(look.p, look.least_p));
  }

  void tell_end(const RangeEnd& end) {
    const std::string found = end.found ? short_number(*end.found) : "none";
    tell(end.effect + "'s " + end.parameter + " at the end of its range, " + short_number(end.end) +
         (end.tried_to == end.end ? "" : ", tried to " + short_number(end.tried_to) + ": " + found + " passes"));
  }

  /// One effect that was named stands, unless it is the only one that isn't ruled out, the model with it can't have
  /// made the data, and nothing known explains the rest; that two or more together made the data is said if the first
  /// of them was named by itself, or if the model with all of them passes.
  void conclude() {
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

  /// The one effect applied comes near enough to be told as such.
  [[nodiscard]] bool is_nearest() const {
    if (applied_.size() != 1) return false;
    const auto candidate = std::ranges::find(outcome_.candidates, applied_.front().effect.name,
                                             [](const Candidate& c) { return c.score.hypothesis; });
    return candidate != outcome_.candidates.end() && comes_nearest(candidate->score, outcome_.looks.back());
  }

  /// Takes back the one name that was given.
  void take_back() {
    const auto refused = std::ranges::find(outcome_.candidates, true, &Candidate::kept);
    refused->kept = false;
    const Look& look = outcome_.looks.back();
    refused->reason = {"Dropped",
                       "with it applied, the model still differs from the data (" + p_in_words(look.p, look.least_p) +
                           "), and none of the others that were tried explains what is left.",
                       Reason::What::refused_when_applied};
    outcome_.verdict = Verdict::none_in_catalogue;
    outcome_.named.clear();
    outcome_.fits.clear();
    applied_.clear();
    tell("the name is taken back: the model with it can't have made the data");
  }

  void explain() {
    if (measured_.kind != Measured::Kind::series) {
      tell("sums don't tell when motion was seen: the residuals are not looked into");
      return;
    }
    context_.begin(explaining);
    outcome_.residuals = explain_residuals(steps_.front().reference, measured_, settings_.alpha, context_);
    tell("residuals: " + sentence(*outcome_.residuals));
  }

  /// Whatever is named: something may change from trial to trial or strike all sensors at once. Days by their counts
  /// have no trials.
  void explain_rest() {
    if (outcome_.verdict == Verdict::no_disagreement || measured_.kind != Measured::Kind::series) return;
    if (!day_parts_of(script_).empty()) return;
    context_.begin(explaining);
    try {
      outcome_.left_over =
          reconcile::explain_rest(steps_.front().reference, applied_, measured_, settings_.alpha, context_);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::infeasible) throw;
    }
    if (!outcome_.left_over) return;
    const std::string rest = sentence_of_rest(*outcome_.left_over);
    tell(rest.empty() ? "nothing more changes from trial to trial or strikes all sensors at once" : rest);
  }

  void verify_effects() {
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
      tell("one trial only: nothing can be held out");
      return;
    }
    context_.begin("does it help on held-out trials");
    const Folds folds = settings_.holdout.empty() ? usual_folds(measured_.digest, trials, reference.shape.kind)
                                                  : Folds{settings_.holdout};
    // Days are simulated as a whole for every fold, whatever it holds out.
    const std::uint32_t n_realizations = settings_.verify_realizations / (reference.frame.day_parts.empty() ? 1 : 3);
    Verification v = verify(std::span(&claim, 1), folds, {settings_.alpha, n_realizations}, context_).front();
    if (v.n_trials == 0) {
      tell("people can hardly get about in the patched model: it can't be judged on held-out trials");
      return;
    }
    tell("held-out trials: energy score " + short_number(v.before.energy_score) + " before, " +
         short_number(v.after.energy_score) + " after, " + std::to_string(v.n_better) + " of " +
         std::to_string(v.n_trials) + " trials better; global test " + p_in_words(v.before.p, v.before.least_p) +
         " before, " + p_in_words(v.after.p, v.after.least_p) + " after");
    if (!v.refused) tell("the held-out trials alone don't refuse the plain model: too weak to call the gap closed");
    outcome_.verification = std::move(v);
    if (take_back_several(outcome_))
      tell("several together are taken back: they explain too little of held-out trials");
  }

  [[nodiscard]] Settings with_all(double level, std::vector<std::string> effects) const {
    Settings settings = settings_;
    settings.table.effects = std::move(effects);
    const auto third = [level](std::uint32_t n) { return std::max(fewest_datasets_to_refuse(level), n / 3); };
    settings.alpha = level;
    settings.table.n_realizations = third(settings.table.n_realizations);
    settings.table.n_remembered = third(settings.table.n_remembered);
    settings.table.n_traced = third(settings.table.n_traced);
    if (settings.table_folder.empty()) return settings;
    ScriptSpec only;  // other data give another strength, and so another table
    settings.table_folder += "_with";
    for (const FittedEffect& effect : applied_) {
      only.effects.push_back(effect.effect);
      settings.table_folder += "_" + effect.effect.name;
    }
    std::string text = io::to_yaml(only);
    for (const std::string& effect : settings.table.effects) text += ' ' + effect;
    settings.table_folder += "_" + sha256(text).substr(0, 8);
    return settings;
  }

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const FittedEffect& effect : applied_) all.push_back(effect.effect.name);
    return all;
  }

  [[nodiscard]] std::vector<std::size_t> training_trials() const {
    std::vector<std::size_t> trials;
    std::ranges::set_difference(all_trials(steps_.front().reference.frame), settings_.holdout,
                                std::back_inserter(trials));
    return trials;
  }

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

}  // namespace

NuisanceSpec nuisance_of(const std::filesystem::path& asked) {
  if (asked.empty()) return {};
  if (asked != "none") return io::read_nuisance(asked);
  NuisanceSpec none;
  each_field<NuisanceSpec>([&none](const auto& field) { none.*field.member = 0.0; });
  return none;
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

}  // namespace pirsim::reconcile
