#include "reconcile/ensemble/realization.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <map>
#include <utility>
#include <vector>

#include "engine/effects/catalogue.hpp"
#include "engine/sim/recording_family.hpp"
#include "model/schema/actions.hpp"
#include "model/schema/check_script.hpp"
#include "model/schema/fields.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/random.hpp"
#include "pirsim/response.hpp"

namespace pirsim::reconcile {
namespace {

constexpr double least_apart_s = 0.1;  ///< readings stay in order

/// How much later the reading of a place is.
struct Knot {
  std::size_t place = 0;
  double later_s = 0.0;
};

double later_at(const std::vector<Knot>& knots, std::size_t place) {
  const auto after = std::ranges::lower_bound(knots, place, {}, &Knot::place);
  if (after->place == place) return after->later_s;
  const Knot& before = *(after - 1);
  const double share = static_cast<double>(place - before.place) / static_cast<double>(after->place - before.place);
  return before.later_s + share * (after->later_s - before.later_s);
}

void draw_seats(const SceneSpec& scene, const NuisanceSpec& nuisance, Stream& stream, OccupancySpec& occupancy) {
  std::vector<std::string> seats = seats_of(occupancy, scene);
  const std::vector<int>& people = occupancy.counts->people;
  const auto most = static_cast<std::size_t>(people.empty() ? 0 : std::max(1, *std::ranges::max_element(people)));
  const double share = nuisance.own_seats * stream.uniform();
  if (!occupancy.counts->areas.empty()) return;  // which seats are spare differs from area to area
  if (seats.size() <= most || most == 0) return;
  const double spare = static_cast<double>(seats.size() - most);
  const auto unused = std::min(seats.size() - most, static_cast<std::size_t>(share * (spare + 1.0)));
  for (std::size_t i = 0; i < unused; ++i)
    seats.erase(seats.begin() + stream.index(static_cast<std::uint32_t>(seats.size())));
  if (unused > 0) occupancy.seats = std::move(seats);
}

constexpr double most_arm_amplitude_m = 0.15;  // what a script may ask for

double between(Stream& stream, double half_width) { return half_width * (2.0 * stream.uniform() - 1.0); }

/// Entities of the nuisance streams: sensors, seats and people don't share numbers, nor do attempts.
enum Entity : std::uint32_t {
  sensors = 0,
  seats = 1U << 16U,
  people = 1U << 17U,
  motion = 1U << 18U,
  gains = 1U << 19U,
  room = (1U << 19U) + (1U << 18U),
  presence = (1U << 19U) + (1U << 18U) + (1U << 17U),
  attempts = 1U << 20U
};

struct Draw {
  const NuisanceSpec& nuisance;
  std::uint64_t seed;
  std::uint32_t index, attempt;

  [[nodiscard]] Stream stream(std::uint32_t entity, Purpose purpose) const {
    return Stream({seed, index, entity + attempt * Entity::attempts, purpose});
  }
};

std::uint64_t seed_of(const Draw& draw) {
  Stream stream = draw.stream(0, Purpose::simulated_seed);
  const std::uint64_t high = stream.next_u32() >> 1U;  // scripts hold seeds up to 2^63 - 1
  return (high << 32U) | stream.next_u32();
}

void move_sensors(SceneSpec& scene, const Draw& draw) {
  for (std::uint32_t i = 0; i < scene.sensors.size(); ++i) {
    Stream stream = draw.stream(Entity::sensors + i, Purpose::nuisance);
    const double yaw = radians(between(stream, draw.nuisance.sensor_yaw_deg));
    const double tilt = radians(between(stream, draw.nuisance.sensor_tilt_deg));
    Quat& rotation = scene.sensors[i].world_from_sensor.rotation;
    rotation = glm::normalize(rotation_from_heading(yaw) * rotation * glm::angleAxis(tilt, Vec3(1, 0, 0)));
  }
}

void move_seats(SceneSpec& scene, const Draw& draw) {
  for (std::uint32_t i = 0; i < scene.seats.size(); ++i) {
    Stream stream = draw.stream(Entity::seats + i, Purpose::nuisance);
    scene.seats[i].world_from_seat.origin.x += between(stream, draw.nuisance.seat_position_m);
    scene.seats[i].world_from_seat.origin.z += between(stream, draw.nuisance.seat_position_m);
  }
}

/// A person is the same in every trial, known by their id.
struct Body {
  double size = 1.0, arms = 1.0;
};

void change(PersonSpec& person, const Body& body) {
  person.stature_m *= body.size;
  person.mass_kg *= body.size * body.size * body.size;
  each_number(person, [](const char*, double& value, const NumberRange& accepted) {
    value = std::clamp(value, accepted.min, accepted.max);
  });
  for_each<action::Work>(person, [&](action::Work& work) {
    work.arm_amplitude_m =
        std::min(work.arm_amplitude_m * body.arms, std::max(work.arm_amplitude_m, most_arm_amplitude_m));
  });
}

void change_people(ScriptSpec& script, const Draw& draw) {
  std::map<std::string, Body> bodies;
  for (TrialSpec& trial : script.trials) {
    for (PersonSpec& person : trial.people) {
      const auto [body, is_new] = bodies.try_emplace(person.id);
      if (is_new) {
        const auto number = static_cast<std::uint32_t>(bodies.size() - 1);
        Stream stream = draw.stream(Entity::people + number, Purpose::nuisance);
        body->second.size = 1.0 + between(stream, draw.nuisance.body_size);
        body->second.arms = 1.0 + between(stream, draw.nuisance.arm_amplitude);
      }
      change(person, body->second);
    }
  }
}

/// With amplitude and period within what the effects' priors hold.
void move_otherwise(ScriptSpec& script, const Draw& draw) {
  Stream stream = draw.stream(Entity::motion, Purpose::nuisance);
  const auto add = [&](const char* effect, const char* strength, double most) {
    const double value = most * stream.uniform();
    if (most <= 0.0 || std::ranges::find(script.effects, effect, &EffectSpec::name) != script.effects.end()) return;
    EffectSpec drawn = effects::off(effects::find(effect));
    drawn.parameters[strength] = value;
    script.effects.push_back(std::move(drawn));
  };
  add("uneven_arms", "spread", draw.nuisance.uneven_arms);
  add("trunk_sway", "amplitude_deg", draw.nuisance.trunk_sway_deg);
}

/// Draws nothing where no sensor is analog.
void change_electronics(Realization& realization, const Draw& draw) {
  bool any = false;
  for (std::uint32_t i = 0; i < realization.scene.sensors.size(); ++i) {
    SensorSpec& sensor = realization.scene.sensors[i];
    if (response_of(realization.scene, realization.script.sensing, sensor) != Response::analog) continue;
    any = true;
    Stream stream = draw.stream(Entity::gains + i, Purpose::nuisance);
    sensor.gain *= 1.0 + between(stream, draw.nuisance.sensor_gain);
  }
  if (!any) return;
  Stream stream = draw.stream(Entity::room, Purpose::nuisance);
  realization.script.sensing.ambient_c += between(stream, draw.nuisance.ambient_c);
  each_number(realization.script.sensing, [](const char*, auto& value, const auto& accepted) {
    if constexpr (std::same_as<decltype(value), double&>) value = std::clamp(value, accepted.min, accepted.max);
  });
}

/// Runs of these trials; of all if none are given.
std::vector<std::uint32_t> runs_of(const Model& model, std::span<const std::size_t> trials) {
  std::vector<std::uint32_t> runs;
  const std::size_t n_trials = model.script().trials.size();
  for (std::uint32_t run = 0; run < model.n_runs(); ++run) {
    if (trials.empty() || std::ranges::find(trials, run % n_trials) != trials.end()) runs.push_back(run);
  }
  return runs;
}

/// All effects. What the script has is never looked for again, so one of the same name is the nuisance's, and gives
/// way.
std::vector<EffectSpec> together(std::vector<EffectSpec> own, std::span<const EffectSpec> more) {
  std::erase_if(own, [&](const EffectSpec& effect) {
    return std::ranges::find(more, effect.name, &EffectSpec::name) != more.end();
  });
  own.insert(own.end(), more.begin(), more.end());
  return own;
}

}  // namespace

CountsSpec with_other_times(const CountsSpec& counts, double within_s, Stream& stream) {
  CountsSpec moved = counts;
  const std::size_t n = counts.people.size();
  if (n < 3 || within_s <= 0.0) return moved;
  std::vector<Knot> knots{{0, 0.0}};
  for (std::size_t k = 1; k < n; ++k) {
    if (are_as_many(counts, k)) continue;
    const double later_s = within_s * (2.0 * stream.uniform() - 1.0);
    if (knots.back().place < k - 1) knots.push_back({k - 1, later_s});
    if (k + 1 < n) knots.push_back({k, later_s});
  }
  knots.push_back({n - 1, 0.0});
  for (std::size_t k = 1; k + 1 < n; ++k) {
    moved.times_s[k] = std::max(counts.times_s[k] + later_at(knots, k), moved.times_s[k - 1] + least_apart_s);
  }
  for (std::size_t k = n - 1; k-- > 1;)
    moved.times_s[k] = std::min(moved.times_s[k], moved.times_s[k + 1] - least_apart_s);
  return moved;
}

void draw_presence(const SceneSpec& scene, const NuisanceSpec& nuisance, Stream& stream, OccupancySpec& occupancy) {
  if (!occupancy.counts) return;
  draw_seats(scene, nuisance, stream, occupancy);
  occupancy.counts = with_other_times(*occupancy.counts, nuisance.time_s, stream);
}

Realization draw_realization(const SceneSpec& scene, const ScriptSpec& script, const NuisanceSpec& nuisance,
                             std::uint64_t seed, std::uint32_t index, std::uint32_t attempt) {
  Realization realization{scene, script};
  const Draw draw{nuisance, seed, index, attempt};
  move_sensors(realization.scene, draw);
  move_seats(realization.scene, draw);
  change_people(realization.script, draw);
  move_otherwise(realization.script, draw);
  change_electronics(realization, draw);
  for (std::uint32_t i = 0; i < script.trials.size(); ++i) {  // who is there is known, when and where exactly is not
    if (!script.trials[i].occupancy) continue;
    Stream stream = draw.stream(Entity::presence + i, Purpose::nuisance);
    draw_presence(scene, nuisance, stream, *realization.script.trials[i].occupancy);
  }
  realization.script.seed = seed_of(draw);
  return realization;
}

std::shared_ptr<const Model> model_to_share(const SceneSpec& scene, const ScriptSpec& script) {
  try {
    return std::make_shared<const Model>(compile(scene, script));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::infeasible) throw;
    return nullptr;
  }
}

struct SimulatedRealization::Traced {
  /// A recording as its Model's detectors take it.
  struct Emitter {
    /// like: of a Model with the same seed, or null.
    Emitter(const Model& of, const Recording& from, sim::NoiseMemory& noise, const Emitter* like)
        : model(of),
          tracks(from),
          logic(std::make_unique<sim::RememberedTriggers>(of.compiled(), from, noise,
                                                          like != nullptr ? like->logic.get() : nullptr)) {}
    [[nodiscard]] std::vector<Series> emit(const StudyFrame& frame, const effects::Pipeline& pipeline, int first,
                                           int n) const {
      first *= frame.n_days();
      n *= frame.n_days();
      std::vector<Series> data;
      for (std::size_t i = 0; i < tracks.runs.size(); ++i) {
        const int replicate = tracks.runs[i].rows.replicate;
        if (replicate <= first || replicate > first + n) continue;
        const RunResult result = sim::replay(tracks, i, *logic, model.script().seed, pipeline);
        if (result.samples.empty()) continue;
        auto series = series_of(frame, result.replicate - first, result.samples.front().trial, result.samples);
        if (series) data.push_back(std::move(*series));
      }
      return in_day_parts(frame, std::move(data));
    }

    const Model& model;
    const Recording& tracks;
    std::unique_ptr<sim::RememberedTriggers> logic;
  };

  Traced(const Realization& realization, const Model* like)
      : model(compile(realization.scene, realization.script, {.like = like})),
        family(model, runs_of(model, {})),
        emitter(model, family.first(), noise, nullptr) {}

  Model model;
  sim::RecordingFamily family;
  sim::NoiseMemory noise;
  Emitter emitter;
};

SimulatedRealization::SimulatedRealization(const RealizationSource& source, const StudyFrame& frame,
                                           std::uint32_t index, int n_runs)
    : frame_(&frame) {
  for (std::uint32_t attempt = 0;; ++attempt) {
    realization_ = draw_realization(source.scene, source.script, source.nuisance, source.seed, index, attempt);
    realization_.script.replicates = n_runs * frame.n_days();
    try {
      traced_ = std::make_unique<Traced>(realization_, source.like.get());
      return;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::infeasible || attempt + 1 == most_rooms) throw;
    }
  }
}

SimulatedRealization::~SimulatedRealization() = default;

std::optional<std::vector<Series>> SimulatedRealization::with(std::span<const EffectSpec> more, int first,
                                                              int n) const {
  const auto moves_rays = [](const EffectSpec& effect) {
    return effects::find(effect.name).info.reach == effects::Reach::geometry;
  };
  if (std::ranges::any_of(more, moves_rays)) return std::nullopt;
  const effects::Pipeline stages = sim::make_stages(traced_->model, together(realization_.script.effects, more));
  const Recording& tracks = traced_->family.first();
  const bool far_enough = std::ranges::all_of(
      tracks.runs, [&](const RecordedRun& track) { return sim::goes_as_far_as(track, tracks.sensing, stages); });
  if (!far_enough) return std::nullopt;
  return traced_->emitter.emit(*frame_, stages, first, n);
}

std::vector<Series> SimulatedRealization::anew(std::span<const EffectSpec> more, int n,
                                               std::span<const std::size_t> trials) const {
  Realization altered = realization_;
  altered.script.effects = together(std::move(altered.script.effects), more);
  altered.script.replicates = n * frame_->n_days();
  const Model model = compile(altered.scene, altered.script, {.like = &traced_->model});
  const Recording tracks = traced_->family.record(
      model, runs_of(model, frame_->day_parts.empty() ? trials : std::span<const std::size_t>{}));
  return Traced::Emitter(model, tracks, traced_->noise, &traced_->emitter)
      .emit(*frame_, model.compiled().stages(), 0, n);
}

std::optional<std::vector<Series>> SimulatedRealization::with_effects(std::span<const EffectSpec> more, int first,
                                                                      int n,
                                                                      std::span<const std::size_t> trials) const {
  try {
    auto remembered = with(more, first, n);
    auto data = remembered ? std::move(*remembered) : anew(more, n, trials);
    std::erase_if(data, [&](const Series& run) {
      return !trials.empty() && std::ranges::find(trials, run.trial) == trials.end();
    });
    return data;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::infeasible) throw;
    return std::nullopt;
  }
}

}  // namespace pirsim::reconcile
