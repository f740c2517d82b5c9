#include "pirsim/sim/state.hpp"

#include <algorithm>

#include "sim/lookout.hpp"

namespace pirsim {

void append_solids(const body::Humanoid& humanoid, const body::Posture& posture, std::vector<PosedShape>& solids) {
  for (std::size_t i = 0; i < body::n_parts; ++i) solids.push_back(place(humanoid.solids()[i], posture[i]));
}

void append_solids(const Actor& actor, std::vector<PosedShape>& solids) {
  if (actor.present()) append_solids(actor.person().humanoid, actor.motion().posture(), solids);
}

namespace {

int people_on_floor(const Model& model, const std::vector<Actor>& actors) {
  return static_cast<int>(std::ranges::count_if(actors, [&](const Actor& actor) {
    return actor.present() && model.scene().floor.contains(actor.motion().position());
  }));
}

}  // namespace

State::State(const Model& model, std::uint32_t run)
    : model_(&model),
      run_(run),
      zones_(model.detector().n_zones()),
      channels_(model.detector().n_channels()),
      previous_channels_(channels_),
      bits_(model.scene().sensors.size(), 0),
      lookout_(model.borrow_lookout()) {
  const TrialModel& trial = model.trial_of(run);
  for (std::uint32_t person = 0; person < trial.people.size(); ++person) actors_.emplace_back(model, run, person);
  sample_.replicate = model.replicate_of(run);
  sample_.trial = trial.id;
}

State::State(const State& other)
    : model_(other.model_),
      run_(other.run_),
      tick_(other.tick_),
      finished_(other.finished_),
      actors_(other.actors_),
      zones_(other.zones_),
      channels_(other.channels_),
      previous_channels_(other.previous_channels_),
      bits_(other.bits_),
      sample_(other.sample_),
      lookout_(other.model_->borrow_lookout()) {}

State& State::operator=(const State& other) {
  State copy(other);
  return *this = std::move(copy);
}

void State::move_people(const Model& model) {
  for (Actor& actor : actors_) {
    others_.clear();
    std::size_t n_before = 0;
    for (const Actor& other : actors_) {
      if (&other == &actor) n_before = others_.size();
      if (&other != &actor && other.present()) others_.push_back(other.presence());
    }
    actor.advance(model, tick_, others_, n_before);
  }
}

void State::look(const Model& model) {
  std::swap(channels_, previous_channels_);
  lookout_->look(actors_, zones_, channels_);
  model.detector().mark(previous_channels_.words(), channels_.words(), bits_);
}

bool step_tick(const Model& model, State& state) {
  ++state.tick_;
  state.move_people(model);
  state.look(model);
  const int window = model.script().sensing.ticks_per_window;
  if (state.tick_ % window != 0) return false;

  Sample& sample = state.sample_;
  sample.time_s = static_cast<double>(state.tick_) / model.script().sensing.tick_rate_hz;
  sample.phase = state.actors_.empty() ? "outside" : state.actors_.front().phase();
  sample.people = people_on_floor(model, state.actors_);
  sample.bits = state.bits_;
  std::ranges::fill(state.bits_, std::uint8_t{0});
  state.finished_ = std::ranges::all_of(state.actors_, &Actor::done);
  return true;
}

bool step(const Model& model, State& state) {
  if (state.finished()) return false;
  while (!step_tick(model, state)) {
  }
  return true;
}

}  // namespace pirsim
