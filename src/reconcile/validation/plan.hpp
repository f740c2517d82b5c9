// Before any measuring: which effects could this experiment tell apart, and what would be worth measuring next?
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "io/report.hpp"
#include "reconcile/validation/selftest.hpp"
#include "stats/intervals.hpp"

namespace pirsim::reconcile {

struct PlanSettings {
  Settings analysis;  ///< its table's effects are the ones to be told apart
  Measured::Kind kind = Measured::Kind::series;
  int n_replicates = 1;  ///< planned runs of every trial
};

/// One way to go on measuring, judged on simulated datasets that took no part in training.
struct Design {
  std::string name;
  std::string what;        ///< is measured, as part of a sentence
  double minutes = 0.0;    ///< more than what is planned; of the plan itself, all of it
  double bits = 0.0;       ///< told about which effect it is, mean over datasets; 0: no better than chance
  double right = 0.0;      ///< share of datasets whose effect is the likeliest
  double more_bits = 0.0;  ///< than what is planned
  stats::Interval more_bits_95;
  /// Bits more a minute that the interval's lower end promises; infinite for a gain that takes no time.
  [[nodiscard]] double surely_per_minute() const noexcept {
    return minutes > 0.0 ? more_bits_95.low / minutes : std::numeric_limits<double>::infinity();
  }
};

/// How often an effect of one strength would be seen (global test) with what is planned.
struct PlannedPower {
  std::string effect;
  Strength strength = Strength::none;
  Rate seen;
};

struct PlanResult {
  std::string sentence;                        ///< the best next measurement
  std::vector<Design> designs;                 ///< first what is planned
  std::vector<std::string> hypotheses;         ///< nothing first
  std::vector<std::vector<double>> confusion;  ///< (n_hypotheses x n_hypotheses) as confusion_of(), of what is planned
  std::vector<PlannedPower> power;
  std::size_t n_datasets = 0;  ///< judged, for each design
  std::vector<std::string> notes;
};

/// One reference table of the planned trials, of each of them once more, of a slow walk through the room and of the
/// empty room serves all designs: each looks at its own trials. Choreographies that this room doesn't allow are left
/// out, and noted.
[[nodiscard]] PlanResult plan(const SceneSpec& scene, const ScriptSpec& script, const PlanSettings& settings,
                              const Observer& observer = {});

[[nodiscard]] std::string to_json(const PlanResult& result);
[[nodiscard]] std::string to_csv(const PlanResult& result);  ///< a row a design
[[nodiscard]] io::Report plan_page(const PlanResult& result);
/// plan.html, plan.json, plan.csv; the folder is made. Throws Error(io).
void write_plan(const std::filesystem::path& folder, const PlanResult& result, const std::string& made_by);

}  // namespace pirsim::reconcile
