// A study with more trials than are planned, of which each design looks at some. Private to reconcile.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"
#include "reconcile/selftest/selftest.hpp"
#include "stats/intervals.hpp"

namespace pirsim::reconcile {

struct LongerStudy {
  ScriptSpec script;                  ///< planned trials, each of them again, then what this room allows of the others
  std::size_t n_planned = 0;          ///< trials
  std::vector<std::size_t> walk;      ///< index of the slow walk, or none
  std::vector<std::size_t> empty;     ///< index of the empty room, or none
  std::vector<std::string> left_out;  ///< trials that this room doesn't allow, and why, in words
};

inline constexpr double slow_walk_m_s = 0.4;  ///< assumed; a stroll is 1 m/s
inline constexpr double empty_room_min = 10.0;

[[nodiscard]] LongerStudy longer_study(const SceneSpec& scene, const ScriptSpec& script);

// Before any measuring: which effects could this experiment tell apart, and what would be worth measuring next?

struct PlanSettings {
  Settings analysis;  ///< its table's effects are the ones to be told apart
  Measured::Kind kind = Measured::Kind::series;
  int n_replicates = 1;  ///< planned runs of every trial
};

/// One way to go on measuring, judged on simulated datasets that took no part in training.
struct Design {
  std::string name;        ///< in a table
  std::string what;        ///< is measured, as part of a sentence
  double minutes = 0.0;    ///< more than what is planned; of the plan itself, all of it
  double bits = 0.0;       ///< told about which effect it is, mean over datasets; 0: no better than chance
  double right = 0.0;      ///< share of datasets whose effect is the likeliest
  double more_bits = 0.0;  ///< than what is planned
  Interval more_bits_95;
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
  std::vector<Design> designs;                 ///< first what is planned
  std::vector<std::string> hypotheses;         ///< nothing first
  std::vector<std::vector<double>> confusion;  ///< (n_hypotheses x n_hypotheses) as confusion_of(), of what is planned
  std::vector<PlannedPower> power;
  std::size_t n_datasets = 0;         ///< judged, for each design
  std::vector<std::string> left_out;  ///< of the longer study

  /// The best next measurement, if one is shown to help.
  [[nodiscard]] const Design* best() const;
};

/// One reference table of the planned trials, of each of them once more, of a slow walk through the room and of the
/// empty room serves all designs: each looks at its own trials. Choreographies that this room doesn't allow are left
/// out.
[[nodiscard]] PlanResult plan(const SceneSpec& scene, const ScriptSpec& script, const PlanSettings& settings,
                              const Context& context = {});

}  // namespace pirsim::reconcile
