// What counts of people don't tell: when exactly somebody comes or goes, and which seats they are used to. Private to
// reconcile.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "model/core/parallel.hpp"
#include "pirsim/model.hpp"
#include "pirsim/occupancy.hpp"
#include "pirsim/random.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"
#include "reconcile/data/measured.hpp"

namespace pirsim::reconcile {

/// Counts whose changes come up to within_s earlier or later, each by itself; what is between two of them is moved in
/// proportion. The first and the last reading stay, and so does the order.
[[nodiscard]] CountsSpec with_other_times(const CountsSpec& counts, double within_s, Stream& stream);

/// Draws both into an occupancy, if it has counts. Seats: people who share a room for long have their own, so that some
/// of those that aren't needed are nobody's.
void draw_presence(const SceneSpec& scene, const NuisanceSpec& nuisance, Stream& stream, OccupancySpec& occupancy);

// Realizations: what is uncertain about a room is drawn.

/// What realizations are drawn from.
struct RealizationSource {
  SceneSpec scene;
  ScriptSpec script;  ///< with the effects that the model already has
  NuisanceSpec nuisance;
  std::uint64_t seed = 0;
  /// The plain model, of which realizations share what is the same in them: lenses, calibrations, the room. It changes
  /// nothing but the time they take; may be null.
  std::shared_ptr<const Model> like{};
};
/// Compiles the plain model for a source; null if people can't get about in it as it is drawn.
[[nodiscard]] std::shared_ptr<const Model> model_to_share(const SceneSpec& scene, const ScriptSpec& script);

/// Scene and script of one dataset: one room, one set of people, one sequence of random choices.
struct Realization {
  SceneSpec scene;
  ScriptSpec script;
};

/// Draws realization `index` of the stream `seed`: seats, sensors, bodies and arms moved as the nuisance says, and a
/// seed of its own for everything random in the simulation. A realization is a pure function of the arguments, so that
/// two effects can be compared in the same realization. A realization that people can't get about in is no room that
/// the data may come from: take the next attempt.
[[nodiscard]] Realization draw_realization(const SceneSpec& scene, const ScriptSpec& script,
                                           const NuisanceSpec& nuisance, std::uint64_t seed, std::uint32_t index,
                                           std::uint32_t attempt = 0);

// Datasets of one realization: people and rays are followed once, effects are put on top.

inline constexpr std::uint32_t most_attempts = 12;  ///< at an effect with which people can get about
/// At a room that people can get about in: if 93 of 100 aren't, one analysis of 1,000 lacks one of 1,500 and fails.
inline constexpr std::uint32_t most_rooms = 200;

/// Belongs to one thread at a time.
class SimulatedRealization {
 public:
  /// Traces n_runs runs of every trial. Throws Error(infeasible) if no attempt gives a realization to get about in.
  SimulatedRealization(const RealizationSource& source, const StudyFrame& frame, std::uint32_t index, int n_runs);
  ~SimulatedRealization();

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

/// Results of make(i) for i in [0, n), in order.
template <typename Result, typename Make>
[[nodiscard]] std::vector<Result> in_parallel(std::size_t n, unsigned threads, const Make& make) {
  std::vector<Result> all;
  ordered_parallel<Result>(n, threads, make, [&](Result& one) { all.push_back(std::move(one)); });
  return all;
}

}  // namespace pirsim::reconcile
