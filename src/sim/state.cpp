#include "sim/state.hpp"

#include <algorithm>

#include "sim/add_triggers.hpp"
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
      edge_draw_(model.edge_draw()),
      polarity_(model.polarity()),
      pipeline_(model.pipeline()),
      analog_(model, run),
      triggers_(model.scene().sensors.size(), 0),
      reader_(sim::make_reader(model.script().sensing.reader, triggers_.size(), model.script().sensing.ticks_per_window,
                               model.script().seed, run)) {
  const TrialModel& trial = model.trial_of(run);
  for (std::uint32_t person = 0; person < trial.people.size(); ++person) actors_.emplace_back(model, run, person);
  presences_.resize(actors_.size());
  seated_.resize(actors_.size(), 0);
  edge_draw_.begin_run(model.script().seed, run);
  pipeline_.begin_run(model.script().seed, run);
  sample_.replicate = model.replicate_of(run);
  sample_.trial = trial.id;
}

State::State(const State& other)
    : model_(other.model_),
      run_(other.run_),
      tick_(other.tick_),
      finished_(other.finished_),
      actors_(other.actors_),
      presences_(other.presences_),
      zones_(other.zones_),
      channels_(other.channels_),
      previous_channels_(other.previous_channels_),
      seated_(other.seated_),
      seats_left_(other.seats_left_),
      edge_draw_(other.edge_draw_),
      polarity_(other.polarity_),
      pipeline_(other.pipeline_),
      analog_(other.analog_),
      triggers_(other.triggers_),
      reader_(other.reader_),
      sample_(other.sample_) {}

State& State::operator=(const State& other) {
  State copy(other);
  return *this = std::move(copy);
}

std::size_t State::gather_others(std::size_t i) {
  others_.clear();
  std::size_t n_before = 0;
  for (std::size_t other = 0; other < actors_.size(); ++other) {
    if (other == i) n_before = others_.size();
    if (other != i && presences_[other]) others_.push_back(*presences_[other]);
  }
  return n_before;
}

void State::move_people(const Model& model) {
  std::size_t n_before = 0;
  bool gathered = false;
  for (std::size_t i = 0; i < actors_.size(); ++i) {
    if (!gathered) n_before = gather_others(i);
    actors_[i].advance(model, tick_, others_, n_before);
    if (actors_.size() == 1) continue;  // nobody asks
    presences_[i].reset();
    if (actors_[i].present()) presences_[i] = actors_[i].presence();
    // The next person's others are the same but for one: this person is where the next one was.
    gathered = presences_[i] && i + 1 < actors_.size() && presences_[i + 1];
    if (gathered) others_[n_before++] = *presences_[i];
  }
}

void State::note_seats_left(const Model& model) {
  seats_left_.clear();
  for (std::size_t i = 0; i < actors_.size(); ++i) {
    const Actor& actor = actors_[i];
    const bool seated = actor.present() && actor.motion().stage() == body::Stage::seated;
    if (seated_[i] != 0 && !seated) {
      const auto& seats = model.scene().seats;
      const auto seat = std::ranges::find(seats, actor.seat(), &SeatSpec::id);
      if (seat != seats.end()) seats_left_.push_back(static_cast<std::size_t>(seat - seats.begin()));
    }
    seated_[i] = seated ? 1 : 0;
  }
}

/// From people to this tick's triggers, before any effect of environment or electronics.
void State::look(const Model& model) {
  if (!lookout_) lookout_ = model.borrow_lookout();
  std::swap(channels_, previous_channels_);
  lookout_->look(actors_, zones_, channels_);
  std::ranges::fill(triggers_, std::uint8_t{0});
  if (polarity_) {
    polarity_->tick(zones_, triggers_);
  } else {
    edge_draw_.tick();
    model.detector().mark(previous_channels_.words(), channels_.words(), edge_draw_.watched(), triggers_);
  }
  if (model.analog() != nullptr) {
    lookout_->measure(actors_, analog_.powers());
    analog_.tick(*model.analog(), triggers_);
  }
}

bool move_tick(const Model& model, State& state) {
  ++state.tick_;
  state.move_people(model);
  state.note_seats_left(model);
  const int window = model.script().sensing.ticks_per_window;
  if (state.tick_ % window != 0) return false;

  Sample& sample = state.sample_;
  sample.time_s = static_cast<double>(state.tick_) / model.script().sensing.tick_rate_hz;
  sample.phase = state.actors_.empty() ? "outside" : state.actors_.front().phase();
  sample.people = people_on_floor(model, state.actors_);
  state.finished_ = std::ranges::all_of(state.actors_, [](const Actor& actor) {
    return actor.done() || actor.person().spec.role == PersonRole::bystander;
  });
  return true;
}

bool step_tick(const Model& model, State& state) {
  const bool window_ended = move_tick(model, state);
  state.look(model);
  for (const std::size_t seat : state.seats_left_) state.pipeline_.seat_left(seat);
  sim::add_triggers(state.pipeline_, state.tick_, state.triggers_, state.reader_);
  if (!window_ended) return false;
  Sample& sample = state.sample_;
  sample.bits.assign(state.reader_.readings().begin(), state.reader_.readings().end());
  state.pipeline_.apply(sample);
  return true;
}

bool step(const Model& model, State& state) {
  if (state.finished()) return false;
  while (!step_tick(model, state)) {
  }
  return true;
}

}  // namespace pirsim
