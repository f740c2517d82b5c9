// Everything that changes during one run.
#pragma once

#include <cstdint>
#include <memory>

#include "pirsim/model.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/sample.hpp"

namespace pirsim {
namespace sim {
struct RunState;
}

/// A value: a copy goes on by itself from the same moment. Belongs to one thread at a time and keeps its Model alive.
class State {
 public:
  /// The moment before the first tick of a run, run in [0, model.n_runs()).
  State(const Model& model, std::uint32_t run);
  State(const State& other);
  State& operator=(const State& other);
  State(State&& other) noexcept;
  State& operator=(State&& other) noexcept;
  ~State();

  [[nodiscard]] std::uint32_t run() const noexcept;
  [[nodiscard]] std::int64_t tick() const noexcept;
  /// (n_zones) active at the current tick, also of sensors that don't answer by them; zones are those of Model::rays().
  /// Valid until the next call or tick. It looks, so two threads may not ask one State.
  [[nodiscard]] const ZoneSet& zones() const;
  /// The reading at the end of the last whole window.
  [[nodiscard]] const Sample& sample() const noexcept;
  /// Every person has carried out all actions and the last window is complete.
  [[nodiscard]] bool finished() const noexcept;

  /// What is behind it, for pirsim's own sources: its header isn't installed.
  [[nodiscard]] sim::RunState& run_state() noexcept { return *run_state_; }
  [[nodiscard]] const sim::RunState& run_state() const noexcept { return *run_state_; }

 private:
  std::shared_ptr<const sim::CompiledStudy> study_;
  std::unique_ptr<sim::RunState> run_state_;
};

/// Advances to the end of the next window, whose reading is then state.sample(). False if the run had ended.
bool step(const Model& model, State& state);
/// Advances one tick; true if a window ended with it.
bool step_tick(const Model& model, State& state);

}  // namespace pirsim
