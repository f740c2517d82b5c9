#include "reconcile/ensemble/realization.hpp"

#include <algorithm>
#include <concepts>
#include <map>

#include "effects/catalogue.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/random.hpp"
#include "pirsim/response.hpp"
#include "reconcile/ensemble/presence_draw.hpp"
#include "schema/action_facts.hpp"
#include "schema/fields.hpp"

namespace pirsim::reconcile {
namespace {

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

/// Who is there is known, when exactly they come and where they sit is not.
void change_presence(const SceneSpec& scene, ScriptSpec& script, const Draw& draw) {
  for (std::uint32_t i = 0; i < script.trials.size(); ++i) {
    if (!script.trials[i].occupancy) continue;
    Stream stream = draw.stream(Entity::presence + i, Purpose::nuisance);
    draw_presence(scene, draw.nuisance, stream, *script.trials[i].occupancy);
  }
}

}  // namespace

Realization draw_realization(const SceneSpec& scene, const ScriptSpec& script, const NuisanceSpec& nuisance,
                             std::uint64_t seed, std::uint32_t index, std::uint32_t attempt) {
  Realization realization{scene, script};
  const Draw draw{nuisance, seed, index, attempt};
  move_sensors(realization.scene, draw);
  move_seats(realization.scene, draw);
  change_people(realization.script, draw);
  move_otherwise(realization.script, draw);
  change_electronics(realization, draw);
  change_presence(scene, realization.script, draw);
  realization.script.seed = seed_of(draw);
  return realization;
}

}  // namespace pirsim::reconcile
