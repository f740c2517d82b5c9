// Datasets of one realization: people and rays are followed once, effects are put on top.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "reconcile/data/measured.hpp"
#include "reconcile/ensemble/realization.hpp"

namespace pirsim::reconcile {

inline constexpr std::uint32_t most_attempts = 12;  ///< at an effect with which people can get about
/// At a room that people can get about in: if 93 of 100 aren't, one analysis of 1,000 lacks one of 1,500 and fails.
inline constexpr std::uint32_t most_rooms = 200;

/// Belongs to one thread at a time.
class SimulatedRealization {
 public:
  /// Traces n_runs runs of every trial. Throws Error(infeasible) if no attempt gives a realization to get about in.
  SimulatedRealization(const RealizationSource& source, const StudyFrame& frame, std::uint32_t index, int n_runs);
  ~SimulatedRealization();
  SimulatedRealization(SimulatedRealization&&) noexcept;
  SimulatedRealization& operator=(SimulatedRealization&&) noexcept;
  SimulatedRealization(const SimulatedRealization&) = delete;
  SimulatedRealization& operator=(const SimulatedRealization&) = delete;

  [[nodiscard]] const Realization& drawn() const noexcept { return realization_; }
  /// The model as it is: runs first + 1 to first + n of every trial, numbered from 1.
  [[nodiscard]] std::vector<Series> plain(int first, int n) const { return *with({}, first, n); }
  /// With more effects, in the same realization: bit for bit what a study with all of them gives, of these trials (none
  /// given: all). None if people can't get about in it.
  [[nodiscard]] std::optional<std::vector<Series>> with_effects(std::span<const EffectSpec> more, int first, int n,
                                                                std::span<const std::size_t> trials = {}) const;

 private:
  struct Traced;
  /// From what is remembered; none if that isn't enough.
  [[nodiscard]] std::optional<std::vector<Series>> with(std::span<const EffectSpec> more, int first, int n) const;
  [[nodiscard]] std::vector<Series> anew(std::span<const EffectSpec> more, int n,
                                         std::span<const std::size_t> trials) const;

  const StudyFrame* frame_;
  Realization realization_;
  std::unique_ptr<Traced> traced_;
};

/// True if all these effects act on what remembered zones trigger, so that with_effects() is cheap.
[[nodiscard]] bool acts_on_remembered_zones(std::span<const EffectSpec> effects);

}  // namespace pirsim::reconcile
