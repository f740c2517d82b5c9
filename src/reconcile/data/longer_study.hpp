// A study with more trials than are planned, of which each design looks at some. Private to reconcile.
#pragma once

#include <string>
#include <vector>

#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim::reconcile {

/// A trial that this room doesn't allow.
struct LeftOut {
  enum class Trial { slow_walk, empty_room };
  Trial trial = Trial::slow_walk;
  std::string error;  ///< of the attempt
};

struct LongerStudy {
  ScriptSpec script;               ///< planned trials, each of them again, then what this room allows of the others
  std::size_t n_planned = 0;       ///< trials
  std::vector<std::size_t> walk;   ///< index of the slow walk, or none
  std::vector<std::size_t> empty;  ///< index of the empty room, or none
  std::vector<LeftOut> left_out;
};

inline constexpr double slow_walk_m_s = 0.4;  ///< assumed; a stroll is 1 m/s
inline constexpr double empty_room_min = 10.0;

[[nodiscard]] LongerStudy longer_study(const SceneSpec& scene, const ScriptSpec& script);

}  // namespace pirsim::reconcile
