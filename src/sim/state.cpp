#include "pirsim/state.hpp"

#include "sim/run_state.hpp"

namespace pirsim {

State::State(const Model& model, std::uint32_t run)
    : study_(model.compiled_), run_state_(std::make_unique<sim::RunState>(model.compiled(), run)) {
  sim::settle(*study_, *run_state_);
}
State::State(const State& other)
    : study_(other.study_), run_state_(std::make_unique<sim::RunState>(*other.run_state_)) {}
State& State::operator=(const State& other) { return *this = State(other); }
State::State(State&&) noexcept = default;
State& State::operator=(State&&) noexcept = default;
State::~State() = default;

std::uint32_t State::run() const noexcept { return run_state_->run; }
std::int64_t State::tick() const noexcept { return run_state_->tick; }
const ZoneSet& State::zones() const { return sim::zones_of_all(*study_, *run_state_); }
const Sample& State::sample() const noexcept { return run_state_->sample; }
bool State::finished() const noexcept { return run_state_->finished; }

bool step_tick(const Model& model, State& state) { return sim::step_tick(model.compiled(), state.run_state()); }

bool step(const Model& model, State& state) {
  if (state.finished()) return false;
  if (sim::pass_empty_window(model.compiled(), state.run_state())) return true;
  while (!step_tick(model, state)) {
  }
  return true;
}

}  // namespace pirsim
