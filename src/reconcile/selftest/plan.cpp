#include "reconcile/selftest/plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>

#include "engine/effects/kit.hpp"
#include "model/core/parallel.hpp"
#include "pirsim/model.hpp"
#include "pirsim/study.hpp"
#include "reconcile/inference/analyst.hpp"

namespace pirsim::reconcile {
namespace {

/// Up to four places as far from each other as can be, one after the other.
std::vector<Vec2> places_to_walk(const SceneSpec& scene) {
  constexpr double clear_m = 0.4;  // half a person's width and some
  constexpr std::size_t most_places = 4;
  const std::vector<Vec2> free = effects::free_places(scene, clear_m);
  std::vector<Vec2> chosen;
  if (!free.empty()) chosen.push_back(free.front());
  while (!chosen.empty() && chosen.size() < most_places) {
    const auto from_chosen = [&](const Vec2& p) {
      double nearest = glm::distance(p, chosen.front());
      for (const Vec2& c : chosen) nearest = std::min(nearest, glm::distance(p, c));
      return nearest;
    };
    const Vec2 next = *std::ranges::max_element(free, {}, from_chosen);
    if (from_chosen(next) < clear_m) break;
    chosen.push_back(next);
  }
  return chosen;
}

ScriptedAction labelled(Action what, const ScriptSpec& script) {
  return {std::move(what), {}, script.summary.phases.empty() ? std::string() : script.summary.phases.front(), {}};
}

/// A trial of the script's first person alone, without actions.
TrialSpec alone(const ScriptSpec& script, std::string id) {
  const auto peopled = std::ranges::find_if(script.trials, [](const TrialSpec& t) { return !t.people.empty(); });
  if (peopled == script.trials.end()) throw Error(ErrorCode::infeasible, "nobody is in any trial");
  PersonSpec person = peopled->people.front();
  person.actions.clear();
  return {std::move(id), {std::move(person)}};
}

TrialSpec slow_walk(const SceneSpec& scene, const ScriptSpec& script) {
  TrialSpec trial = alone(script, "slow walk");
  const std::vector<Vec2> places = places_to_walk(scene);
  if (scene.entrances.empty() || places.empty()) {
    throw Error(ErrorCode::infeasible, "no entrance, or no free place to walk to");
  }
  PersonSpec& walker = trial.people.front();
  walker.walking_speed_m_s = slow_walk_m_s;
  const std::string& door = scene.entrances.front().id;
  walker.actions = {labelled(action::Enter{door}, script), labelled(action::Walk{places}, script),
                    labelled(action::Leave{door}, script)};
  return trial;
}

std::string unused_id(const ScriptSpec& script, std::string id, const std::string& more) {
  while (std::ranges::find(script.trials, id, &TrialSpec::id) != script.trials.end()) id += more;
  return id;
}

/// Adds a trial if a person can carry it out in the room as it is drawn.
template <typename Make>
void add(LongerStudy& study, const SceneSpec& scene, std::vector<std::size_t>& index, const std::string& what,
         Make make) {
  try {
    TrialSpec trial = make();
    trial.id = unused_id(study.script, std::move(trial.id), " again");
    ScriptSpec only = study.script;
    only.trials = {trial};
    only.replicates = 1;
    static_cast<void>(run_once(compile(scene, std::move(only)), 0));
    index = {study.script.trials.size()};
    study.script.trials.push_back(std::move(trial));
  } catch (const Error& error) {
    study.left_out.push_back(what + " is left out: " + error.what());
  }
}

/// What became of the datasets that took no part in training.
struct Judged {
  std::vector<std::size_t> rows;  ///< of the table
  std::vector<double> bits;       ///< told about the truth
  std::vector<std::size_t> likeliest;
  std::vector<double> p;  ///< of the global test
};

Judged judge_held_back(const ReferenceStudy& reference, std::vector<std::size_t> trials, const Settings& settings,
                       const Context& context) {
  std::ranges::sort(trials);
  const Analyst analyst(reference.view(std::move(trials), context.threads), {settings.alpha, settings.trees}, context);
  Judged judged;
  for (std::size_t row = 0; row < reference.table.rows.size(); ++row) {
    if (is_for_calibration(reference.table.rows[row].realization)) judged.rows.push_back(row);
  }
  const double prior = 1.0 / static_cast<double>(reference.table.n_hypotheses());
  constexpr double least_probability = 1e-4;
  const auto judge = [&](std::size_t i) { return analyst.judge(reference.table.statistics.row(judged.rows[i])); };
  for (const Judgement& one : in_parallel<Judgement>(judged.rows.size(), context.threads, judge)) {
    const std::size_t truth = reference.table.rows[judged.rows[judged.p.size()]].hypothesis;
    judged.bits.push_back(std::log2(std::max(least_probability, one.scores[truth].probability) / prior));
    const auto best = std::ranges::max_element(one.scores, {}, &HypothesisScore::probability);
    judged.likeliest.push_back(static_cast<std::size_t>(best - one.scores.begin()));
    judged.p.push_back(one.p);
  }
  return judged;
}

/// Bits by realization, each the mean over its datasets: realizations are independent, datasets of one realization
/// aren't.
std::map<std::uint32_t, double> by_realization(const ReferenceStudy& reference, const Judged& judged) {
  std::map<std::uint32_t, std::pair<double, double>> sums;
  for (std::size_t i = 0; i < judged.rows.size(); ++i) {
    auto& [sum, n] = sums[reference.table.rows[judged.rows[i]].realization];
    sum += judged.bits[i];
    n += 1.0;
  }
  std::map<std::uint32_t, double> means;
  for (const auto& [realization, sum] : sums) means[realization] = sum.first / sum.second;
  return means;
}

/// Mean difference, and its 95 % interval from the scatter between realizations.
void compare(const std::map<std::uint32_t, double>& with, const std::map<std::uint32_t, double>& without,
             Design& design) {
  double n = 0.0, sum = 0.0, squares = 0.0;
  for (const auto& [realization, bits] : with) {
    const double d = bits - without.at(realization);
    n += 1.0;
    sum += d;
    squares += d * d;
  }
  design.more_bits = sum / n;
  const double variance = std::max(0.0, squares / n - design.more_bits * design.more_bits);
  const double half = 1.96 * std::sqrt(variance / std::max(1.0, n - 1.0));
  design.more_bits_95 = {design.more_bits - half, design.more_bits + half};
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) /
         static_cast<double>(std::max<std::size_t>(1, values.size()));
}

double share_right(const ReferenceStudy& reference, const Judged& judged) {
  double hits = 0.0;
  for (std::size_t i = 0; i < judged.rows.size(); ++i) {
    hits += reference.table.rows[judged.rows[i]].hypothesis == judged.likeliest[i] ? 1.0 : 0.0;
  }
  return hits / static_cast<double>(std::max<std::size_t>(1, judged.rows.size()));
}

/// The planned trial whose cells differ most between effects, compared with how they differ within: worth repeating.
std::size_t most_telling_trial(const ReferenceStudy& reference, std::size_t n_planned) {
  const std::size_t n_hypotheses = reference.table.n_hypotheses();
  const auto cells_of = [&](std::size_t row, std::size_t trial) {
    return DatasetStatistics(reference.frame, reference.table.statistics.row(row)).cells(trial);
  };
  std::vector<double> ratio(n_planned, 0.0);
  const auto add = [&](std::size_t trial, std::size_t column) {
    std::vector<double> n(n_hypotheses, 0.0), sum(n_hypotheses, 0.0);
    double all = 0.0, squares = 0.0, count = 0.0;
    for (std::size_t row = 0; row < reference.table.rows.size(); ++row) {
      const auto value = static_cast<double>(cells_of(row, trial)[column]);
      if (std::isnan(value)) continue;
      n[reference.table.rows[row].hypothesis] += 1.0;
      sum[reference.table.rows[row].hypothesis] += value;
      all += value;
      squares += value * value;
      count += 1.0;
    }
    if (count == 0.0) return;
    double between = 0.0;
    for (std::size_t e = 0; e < n_hypotheses; ++e) between += n[e] > 0.0 ? sum[e] * sum[e] / n[e] : 0.0;
    between -= all * all / count;
    const double total = squares - all * all / count;
    if (total > 1e-9 * count) ratio[trial] += between / total;
  };
  for (std::size_t trial = 0; trial < n_planned; ++trial) {
    for (std::size_t column = 0; column < cells_of(0, trial).size(); ++column) add(trial, column);
  }
  return static_cast<std::size_t>(std::ranges::max_element(ratio) - ratio.begin());
}

std::vector<PlannedPower> power_of(const ReferenceStudy& reference, const Judged& judged, double alpha) {
  std::vector<PlannedPower> power;
  for (std::size_t hypothesis = 1; hypothesis < reference.table.n_hypotheses(); ++hypothesis) {
    for (const Strength strength : {Strength::weak, Strength::medium, Strength::strong}) {
      PlannedPower one{reference.table.hypothesis_name(hypothesis), strength, {disagreement_seen}};
      for (std::size_t i = 0; i < judged.rows.size(); ++i) {
        const TableRow& row = reference.table.rows[judged.rows[i]];
        if (row.hypothesis != hypothesis || strength_of(row.effects.front()) != strength) continue;
        one.seen.count(judged.p[i] <= alpha);
      }
      power.push_back(std::move(one));
    }
  }
  return power;
}

std::vector<std::vector<double>> confusion_of(const ReferenceStudy& reference, const Judged& judged) {
  const std::size_t n = reference.table.n_hypotheses();
  std::vector<std::vector<double>> shares(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < judged.rows.size(); ++i) {
    shares[reference.table.rows[judged.rows[i]].hypothesis][judged.likeliest[i]] += 1.0;
  }
  return shares_of_rows(std::move(shares));
}

/// A tenth of what naming takes: designs are compared on the same realizations, so that few suffice.
Settings with_fewer_realizations(Settings settings) {
  for (std::uint32_t* n : {&settings.table.n_realizations, &settings.table.n_remembered, &settings.table.n_traced}) {
    *n = std::max(fewest_datasets_to_refuse(settings.alpha), *n / 10);
  }
  return settings;
}

/// A design before it is judged.
struct Idea {
  std::string name, what;         ///< of the design
  std::vector<std::size_t> more;  ///< trials beside those planned
};

std::vector<Idea> ideas_of(const LongerStudy& study, const ReferenceStudy& reference) {
  const std::size_t n = study.n_planned;
  std::vector<Idea> ideas;
  const std::size_t best = most_telling_trial(reference, n);
  if (n > 1) {
    const std::string trial = "trial " + study.script.trials[best].id;
    ideas.push_back({trial + " again", trial + " once more", {n + best}});
  }
  Idea again{"all again", "every trial once more", {}};
  for (std::size_t trial = n; trial < 2 * n; ++trial) again.more.push_back(trial);
  ideas.push_back(std::move(again));
  if (!study.walk.empty()) ideas.push_back({"slow walk", "one person walking slowly through the room", study.walk});
  if (!study.empty.empty()) ideas.push_back({"empty room", "the empty room", study.empty});
  return ideas;
}

double minutes_of(const ReferenceStudy& reference, const std::vector<std::size_t>& trials) {
  double rows = 0.0;
  for (const DataShape::Run& run : reference.shape.runs) {
    if (std::ranges::find(trials, run.trial) != trials.end()) rows += static_cast<double>(run.n_main);
  }
  return rows * reference.frame.window_s / 60.0;
}

}  // namespace

LongerStudy longer_study(const SceneSpec& scene, const ScriptSpec& script) {
  LongerStudy study{script, script.trials.size(), {}, {}, {}};
  for (const TrialSpec& trial : script.trials) {
    TrialSpec again = trial;
    again.id = unused_id(study.script, trial.id + " again", " again");
    study.script.trials.push_back(std::move(again));
  }
  add(study, scene, study.walk, "a slow walk", [&] { return slow_walk(scene, script); });
  add(study, scene, study.empty, "the empty room", [&] {
    TrialSpec trial = alone(script, "empty room");
    trial.people.front().actions = {labelled(action::Wait{60.0 * empty_room_min}, script)};
    return trial;
  });
  return study;
}

const Design* PlanResult::best() const {
  const Design* best = nullptr;
  for (const Design& design : designs) {
    if (&design == &designs.front() || design.more_bits_95.low <= 0.0) continue;
    if (best == nullptr || design.surely_per_minute() > best->surely_per_minute()) best = &design;
  }
  return best;
}

PlanResult plan(const SceneSpec& scene, const ScriptSpec& script, const PlanSettings& asked, const Context& context) {
  const PlanSettings settings{with_fewer_realizations(asked.analysis), asked.kind, asked.n_replicates};
  LongerStudy study = longer_study(scene, script);
  const auto reference_study = [&](Measured::Kind kind) {
    return make_full_study(scene, study.script, settings.analysis, kind, settings.n_replicates, context);
  };
  const ReferenceStudy reference = reference_study(settings.kind);
  std::vector<std::size_t> planned = stats::numbers_to(study.n_planned);
  const auto judged = [&](const ReferenceStudy& in, const Idea& idea) {
    context.begin("judging " + idea.what);
    std::vector<std::size_t> trials = planned;
    trials.insert(trials.end(), idea.more.begin(), idea.more.end());
    return judge_held_back(in, std::move(trials), settings.analysis, context);
  };
  const Idea as_planned{"as planned", "what is planned", {}};
  const Judged base = judged(reference, as_planned);
  const auto base_bits = by_realization(reference, base);
  PlanResult result;
  result.left_out = std::move(study.left_out);
  result.n_datasets = base.rows.size();
  result.hypotheses = reference.table.hypotheses();
  const auto design_of = [](const ReferenceStudy& in, const Idea& idea, const Judged& with) {
    return Design{idea.name, idea.what, minutes_of(in, idea.more), mean(with.bits), share_right(in, with), 0.0, {}};
  };
  result.designs.push_back(design_of(reference, {as_planned.name, as_planned.what, planned}, base));
  const auto add = [&](const ReferenceStudy& in, const Idea& idea) {
    const Judged with = judged(in, idea);
    result.designs.push_back(design_of(in, idea, with));
    compare(by_realization(in, with), base_bits, result.designs.back());
  };
  for (const Idea& idea : ideas_of(study, reference)) add(reference, idea);
  if (settings.kind == Measured::Kind::sums) {
    add(reference_study(Measured::Kind::series),
        {"second by second", "the same, second by second instead of sums", {}});
  }
  result.power = power_of(reference, base, settings.analysis.alpha);
  result.confusion = confusion_of(reference, base);
  return result;
}

}  // namespace pirsim::reconcile
