#include "pirsim/sim/state.hpp"

#include <algorithm>

#include "pirsim/pir/optics.hpp"

namespace pirsim {

void append_solids(const Actor& actor, std::vector<PosedShape>& solids) {
  if (!actor.present()) return;
  const body::Posture posture = actor.motion().posture();
  const body::Solids& shapes = actor.person().humanoid.solids();
  for (std::size_t i = 0; i < body::n_parts; ++i) solids.push_back(place(shapes[i], posture[i]));
}

namespace {

int people_on_floor(const Model& model, const std::vector<Actor>& actors) {
  return static_cast<int>(std::ranges::count_if(actors, [&](const Actor& actor) {
    return actor.present() && model.scene().floor.contains(actor.motion().position());
  }));
}

void move_people(const Model& model, std::int64_t tick, std::vector<Actor>& actors) {
  std::vector<Presence> others;
  for (Actor& actor : actors) {
    others.clear();
    std::size_t n_before = 0;
    for (const Actor& other : actors) {
      if (&other == &actor) n_before = others.size();
      if (&other != &actor && other.present()) others.push_back(other.presence());
    }
    actor.advance(model, tick, others, n_before);
  }
}

}  // namespace

State::State(const Model& model, std::uint32_t run)
    : model_(&model), run_(run), bits_(model.scene().sensors.size(), 0), tracer_(model.borrow_tracer()) {
  const TrialModel& trial = model.trial_of(run);
  for (std::uint32_t person = 0; person < trial.people.size(); ++person) actors_.emplace_back(model, run, person);
  zones_.assign(model.rated_rays().n_zones(), 0);
  previous_zones_ = zones_;
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
      previous_zones_(other.previous_zones_),
      bits_(other.bits_),
      sample_(other.sample_),
      tracer_(other.model_->borrow_tracer()) {}

State& State::operator=(const State& other) {
  State copy(other);
  return *this = std::move(copy);
}

void State::look(const Model& model) {
  solids_.clear();
  for (const Actor& actor : actors_) append_solids(actor, solids_);
  std::swap(zones_, previous_zones_);
  tracer_->trace(solids_, zones_);
  pir::mark_motion(model.rated_rays(), model.script().sensing.change_per, previous_zones_, zones_, bits_);
}

bool step_tick(const Model& model, State& state) {
  ++state.tick_;
  move_people(model, state.tick_, state.actors_);
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
