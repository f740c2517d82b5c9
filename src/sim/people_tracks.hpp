// What people do, apart from what any sensor sees of it.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "sim/actor.hpp"
#include "sim/posture_memory.hpp"
#include "sim/replay.hpp"

namespace pirsim::sim {

/// One run.
struct PeopleTrack {
  RecordedRun rows;  ///< all but what was shown
  std::size_t n_ticks = 0, n_people = 0;
  std::vector<PostureIndex::Number> postures;  ///< (1 + n_ticks x n_people) from before tick 1 on; 0: not there
};

/// All postures of some studies, each once, in the order in which they came.
class Postures {
 public:
  /// As far as the study's stages look ahead of the last row.
  [[nodiscard]] PeopleTrack follow(const CompiledStudy& study, std::uint32_t run);
  [[nodiscard]] std::size_t size() const noexcept { return index_.size(); }
  /// Forgets all but the first n.
  void shrink(std::size_t n) noexcept;
  /// Who stood so first, counted from 0: postures of one person follow upon one another.
  [[nodiscard]] std::uint32_t person(PostureIndex::Number number) const noexcept { return people_[number - 1]; }
  /// Lives as long as this.
  [[nodiscard]] const body::Humanoid& humanoid(PostureIndex::Number number) const {
    return figures_[figure(number)].humanoid;
  }
  /// Whose measures and warmth: a number.
  [[nodiscard]] std::uint64_t figure(PostureIndex::Number number) const noexcept { return index_.body(number); }
  [[nodiscard]] const BodyRadiance& radiance(PostureIndex::Number number) const {
    return figures_[figure(number)].radiance;
  }
  [[nodiscard]] body::Outline outline(PostureIndex::Number number) const noexcept { return index_.outline(number); }

 private:
  struct Figure {
    body::Humanoid humanoid;
    BodyRadiance radiance;
  };
  [[nodiscard]] std::uint64_t number_of(const PersonModel& person);
  [[nodiscard]] PostureIndex::Number number_of(std::uint32_t person, std::uint64_t figure, const Actor& actor);

  PostureIndex index_;
  std::vector<std::uint32_t> people_;  ///< (n_postures)
  std::deque<Figure> figures_;
};

}  // namespace pirsim::sim
