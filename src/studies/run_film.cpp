#include "studies/run_film.hpp"

#include <algorithm>
#include <cmath>

#include "sim/run_state.hpp"
#include "sim/solids.hpp"

namespace pirsim::studies {
namespace {

io::ExportedPerson without_keys(const sim::Actor& actor) {
  io::ExportedPerson person{actor.person().spec.id, {}, {}};
  for (std::size_t i = 0; i < body::n_parts; ++i) {
    const auto part = static_cast<body::Part>(i);
    person.parts.push_back({person.id, std::string(body::name(part)), actor.person().humanoid.solids()[i], {}});
  }
  return person;
}

/// While away, a person's parts keep their last place (they are drawn at scale 0).
void add_key(const sim::Actor& actor, io::ExportedPerson& person) {
  person.present.push_back(actor.present() ? 1 : 0);
  const body::Posture posture = actor.present() ? actor.motion().posture() : body::Posture{};
  for (std::size_t i = 0; i < body::n_parts; ++i) {
    auto& keys = person.parts[i].world_from_part;
    keys.push_back(actor.present() || keys.empty() ? posture[i] : keys.back());
  }
}

io::ExportedBeams beams(const Model& model, const State& state, std::size_t sensor) {
  io::ExportedBeams result;
  result.sensor = model.scene().sensors[sensor].id;
  for (const sim::BeamSegment& beam : sim::beams_of(model, state, sensor))
    result.segments.emplace_back(beam.from, beam.to);
  return result;
}

std::vector<std::uint32_t> members(const ZoneSet& zones) {
  std::vector<std::uint32_t> result;
  for (std::size_t zone = 0; zone < zones.size(); ++zone) {
    if (zones.test(zone)) result.push_back(static_cast<std::uint32_t>(zone));
  }
  return result;
}

/// Between two keys: of each sensor's signal, what is farthest from its rest.
class Peaks {
 public:
  explicit Peaks(std::size_t n_sensors) : peaks_(n_sensors, 0.0) {}

  void look(const State& state) {
    const auto& signals = state.run_state().detector.analog();
    for (std::size_t i = 0; i < signals.size(); ++i) {
      if (signals[i] && std::abs(signals[i]->volts) >= std::abs(peaks_[i])) peaks_[i] = signals[i]->volts;
    }
  }
  void take(const State& state, std::vector<std::vector<double>>& signals_v) {
    const auto& signals = state.run_state().detector.analog();
    for (std::size_t i = 0; i < signals.size(); ++i) {
      if (signals[i]) signals_v[i].push_back(peaks_[i]);
      peaks_[i] = 0.0;
    }
  }

 private:
  std::vector<double> peaks_;
};

}  // namespace

double expected_bytes(std::size_t n_people, double seconds, double keys_per_s) {
  // As the glTF has them: a time; of each person a scale, of each part a place and a rotation, in single precision.
  constexpr double time_bytes = 4.0, person_bytes = 12.0, part_bytes = 12.0 + 16.0;
  return seconds * keys_per_s *
         (time_bytes + static_cast<double>(n_people) * (person_bytes + body::n_parts * part_bytes));
}

Film film(const Model& model, std::uint32_t run, const FilmSpec& spec) {
  const SensingInForce& sensing = model.compiled().sensing();
  const int rate = sensing.tick_rate_hz;
  const auto ticks_per_key = std::max<std::int64_t>(1, std::llround(rate / spec.keys_per_s));
  const double window_s = model.tick_s() * sensing.ticks_per_window;
  const auto time_s = [&](const State& state) { return static_cast<double>(state.tick()) / rate; };

  State state(model, run);
  Film result;
  result.run.title = model.script().name + ", trial " + model.trial_of(run);
  result.run.meshes = model.compiled().scene().meshes;
  for (const std::size_t sensor : spec.beams_of) result.run.beams.push_back(beams(model, state, sensor));
  const auto end_window = [&] {
    if (spec.simulated) spec.simulated(window_s);
  };
  while (!state.finished() && time_s(state) + window_s <= spec.from_s) {
    // As in a run without a film, what nobody is in is passed over.
    if (!sim::pass_empty_window(model.compiled(), state.run_state())) step(model, state);
    end_window();
  }

  const std::vector<sim::Actor>& actors = state.run_state().crowd.actors();
  for (const sim::Actor& actor : actors) {
    result.run.people.push_back(without_keys(actor));
    result.run.people.back().number = result.run.people.size() - 1;
  }
  const std::vector<DoorLeaf>& leaves = model.compiled().array().leaves();
  for (std::size_t i = 0; i < leaves.size(); ++i)
    result.run.leaves.push_back({model.scene().doors[i].id, leaves[i].box(), {}});
  result.signals_v.resize(model.scene().sensors.size());
  Peaks peaks(result.signals_v.size());
  const std::int64_t first_tick = state.tick();
  while (true) {
    peaks.look(state);
    const bool ends = state.finished() || time_s(state) >= spec.to_s;
    if ((state.tick() - first_tick) % ticks_per_key == 0 || ends) {
      result.run.key_times_s.push_back(time_s(state));
      for (std::size_t i = 0; i < actors.size(); ++i) add_key(actors[i], result.run.people[i]);
      for (std::size_t i = 0; i < leaves.size(); ++i)
        result.run.leaves[i].world_from_leaf.push_back(leaves[i].frame_at(state.run_state().crowd.doors().steps()[i]));
      result.active_zones.push_back(members(state.zones()));
      peaks.take(state, result.signals_v);
    }
    if (ends) return result;
    if (!step_tick(model, state)) continue;
    result.rows.push_back(state.sample());
    end_window();
  }
}

}  // namespace pirsim::studies
