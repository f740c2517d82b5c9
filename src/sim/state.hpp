// Everything that changes during one run.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "pir/window_reader.hpp"
#include "pirsim/effects.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/sample.hpp"
#include "sim/actor.hpp"
#include "sim/analog_state.hpp"
#include "sim/model.hpp"

namespace pirsim {

/// A value: a copy goes on by itself from the same moment. Belongs to one thread at a time and to the Model it was
/// made for, which must outlive it.
class State {
 public:
  /// The moment before the first tick of a run, run in [0, model.n_runs()).
  State(const Model& model, std::uint32_t run);
  State(const State& other);
  State& operator=(const State& other);
  State(State&&) noexcept = default;
  State& operator=(State&&) noexcept = default;
  ~State() = default;

  [[nodiscard]] std::uint32_t run() const noexcept { return run_; }
  [[nodiscard]] std::int64_t tick() const noexcept { return tick_; }
  [[nodiscard]] const std::vector<Actor>& actors() const noexcept { return actors_; }
  /// (n_zones) at the current tick.
  [[nodiscard]] const ZoneSet& zones() const noexcept { return zones_; }
  /// Indices (into scene().seats) of the seats from which somebody rose in the step to this tick.
  [[nodiscard]] const std::vector<std::size_t>& seats_left() const noexcept { return seats_left_; }
  /// Powers and signals of the analog sensors at the current tick; empty where there are none.
  [[nodiscard]] const sim::AnalogState& analog() const noexcept { return analog_; }
  /// The reading at the end of the last whole window.
  [[nodiscard]] const Sample& sample() const noexcept { return sample_; }
  /// Every person has carried out all actions and the last window is complete.
  [[nodiscard]] bool finished() const noexcept { return finished_; }

 private:
  friend bool step_tick(const Model& model, State& state);
  friend bool move_tick(const Model& model, State& state);
  /// Fills others_ with everyone in the scene but the i-th person; how many of them come before in the script.
  std::size_t gather_others(std::size_t i);
  void move_people(const Model& model);
  void note_seats_left(const Model& model);
  void look(const Model& model);

  const Model* model_;
  std::uint32_t run_ = 0;
  std::int64_t tick_ = 0;
  bool finished_ = false;
  std::vector<Actor> actors_;
  std::vector<std::optional<Presence>> presences_;  ///< of the actors as they are now; of those in the scene
  ZoneSet zones_;
  ZoneSet channels_, previous_channels_;  ///< of the Model's detector
  std::vector<std::uint8_t> seated_;      ///< (n_actors) 1 while seated
  std::vector<std::size_t> seats_left_;
  pir::EdgeDraw edge_draw_;
  std::optional<pir::PolarityDetector> polarity_;
  effects::Pipeline pipeline_;
  sim::AnalogState analog_;
  std::vector<std::uint8_t> triggers_;  ///< (n_sensors) at this tick
  pir::WindowReader reader_;
  Sample sample_;
  std::vector<Presence> others_;           ///< scratch
  std::shared_ptr<sim::Lookout> lookout_;  ///< scratch, borrowed when first needed; a copy borrows its own
};

/// Appends the thirteen posed solids of a posture, or of a person if present, in the order of body::Part.
void append_solids(const body::Humanoid& humanoid, const body::Posture& posture, std::vector<PosedShape>& solids);
void append_solids(const Actor& actor, std::vector<PosedShape>& solids);

/// Advances to the end of the next window, whose reading is then state.sample(). False if the run had ended.
bool step(const Model& model, State& state);
/// Advances one tick; true if a window ended with it.
bool step_tick(const Model& model, State& state);
/// Advances people alone by a tick: nobody looks, so that zones and readings (the sample's bits) stay as they are. For
/// a State of its own: once moved so it is of no use for stepping. True if a window ended with it.
bool move_tick(const Model& model, State& state);

}  // namespace pirsim
