#include <algorithm>
#include <limits>

#include "engine/effects/kit.hpp"
#include "model/schema/actions.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/shapes.hpp"

// Triggers that nobody's motion makes.
// Assumed: they come at random, independent of what people do but for the seats that they leave.
// Method: stages that set triggers tick by tick, from Poisson processes with streams of their own.
// Sources: no measurement; rates are assumed, with their reasons.

namespace pirsim::effects {
namespace {

// warm_chair: a seat stays warm after somebody has left it.

constexpr float seat_radius_m = 0.25F;  // assumed (0.2-0.3): of what is warm

/// (n_seats) 1 where a ray of the sensor hits the seat.
std::vector<std::uint8_t> seats_seen(const StageContext& context, std::uint32_t sensor) {
  const RayBundle& rays = context.clipped_rays;
  std::vector<std::uint8_t> seen;
  for (const SeatSpec& seat : context.scene.seats) {
    const PosedSphere warm{Vec3f(seat.world_from_seat.origin), seat_radius_m};
    std::uint8_t is_hit = 0;
    for (auto i = rays.first_ray(sensor); i < rays.first_ray(sensor + 1); ++i) {
      if (entry_distance(rays.rays[i], warm, rays.range[i])) is_hit = 1;
    }
    seen.push_back(is_hit);
  }
  return seen;
}

/// Every seat that was left adds a rate that decays; sensors that see several add them up.
class WarmChair final : public CloneableTriggerStage<WarmChair> {
 public:
  WarmChair(std::vector<std::uint32_t> sensors, std::vector<std::vector<std::uint8_t>> seen, double mean_per_tick,
            double decay_ticks)
      : sensors_(std::move(sensors)),
        seen_(std::move(seen)),
        mean_per_tick_(mean_per_tick),
        kept_per_tick_(std::exp(-1.0 / decay_ticks)) {}

  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    streams_ = streams_of(sensors_, seed, run, Purpose::warm_chair);
    warmth_.assign(sensors_.size(), 0.0);
  }

  void seat_left(std::size_t seat) override {
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      if (seen_[i][seat] != 0) warmth_[i] += 1.0;
    }
  }

  void tick(std::int64_t, std::span<std::uint8_t> triggers) noexcept override {
    constexpr double cold = 1e-6;
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      if (warmth_[i] < cold) continue;
      if (streams_[i].uniform() < -std::expm1(-mean_per_tick_ * warmth_[i])) triggers[sensors_[i]] = 1;
      warmth_[i] *= kept_per_tick_;
    }
  }

 private:
  std::vector<std::uint32_t> sensors_;
  std::vector<std::vector<std::uint8_t>> seen_;  ///< (n_sensors x n_seats)
  double mean_per_tick_;
  double kept_per_tick_;
  std::vector<Stream> streams_;
  std::vector<double> warmth_;  ///< (n_sensors) 1 just after one seat was left
};

std::unique_ptr<TriggerStage> make_warm_chair(const EffectSpec& effect, const StageContext& context) {
  const std::vector<std::uint32_t> sensors = sensors_of(effect, context.scene);
  std::vector<std::vector<std::uint8_t>> seen;
  for (const std::uint32_t sensor : sensors) seen.push_back(seats_seen(context, sensor));
  const double rate = context.sensing.tick_rate_hz;
  return std::make_unique<WarmChair>(sensors, std::move(seen), effect.parameters.at("rate_per_s") / rate,
                                     effect.parameters.at("decay_s") * rate);
}

Effect warm_chair() {
  return {
      .info = {.name = "warm_chair",
               .family = Family::environment,
               .stage = "environment",
               .summary = "A seat that somebody left triggers the sensors that see it, at a rate that decays.",
               .fingerprint = "activity after leaving, where a sensor sees the seat",
               .confused_with = {"false_triggers", "fidgeting"},
               .parameters = {logarithmic(
                                  strength("rate_per_s", "1/s", 0.05, 0.01, 0.3, 10.0, "assumed: just after leaving")),
                              logarithmic(detail("decay_s", "s", 120.0, 60.0, 300.0, 1.0, 3600.0, "assumed: to 1/e"))},
               .choices = {sensor_choice()},
               .reach = Reach::triggers,
               .in_analog = "triggers come in behind the comparator; the seat's own heat isn't traced",
               .idle_in = {Survey::coverage, Survey::walk_test}},
      .make_stage = make_warm_chair};
}

// false_triggers: triggers without a person: noise of element and amplifier, draughts.

/// A Poisson process a sensor, or one for all of them, alike at all times of a run.
class FalseTriggers final : public CloneableTriggerStage<FalseTriggers> {
 public:
  /// groups: sensors that trigger together.
  FalseTriggers(std::vector<std::vector<std::uint32_t>> groups, double mean_per_tick, const Trend& trend)
      : groups_(std::move(groups)), mean_per_tick_(mean_per_tick), trend_(trend) {
    for (const auto& group : groups_) first_.push_back(group.front());
  }

  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    streams_ = streams_of(first_, seed, run, Purpose::false_trigger);
    per_tick_ = trend_.in_run(mean_per_tick_, run);
    next_.clear();
    for (Stream& stream : streams_) next_.push_back(ticks_to_event(stream, per_tick_));
  }

  void tick(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept override {
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      if (tick != next_[i]) continue;
      for (const std::uint32_t sensor : groups_[i]) triggers[sensor] = 1;
      next_[i] += ticks_to_event(streams_[i], per_tick_);
    }
  }

 private:
  std::vector<std::vector<std::uint32_t>> groups_;
  double mean_per_tick_;  ///< over the runs
  Trend trend_;
  double per_tick_ = 0.0;             ///< in this run
  std::vector<std::uint32_t> first_;  ///< (n_groups) sensor
  std::vector<Stream> streams_;       ///< (n_groups)
  std::vector<std::int64_t> next_;    ///< (n_groups) tick
};

std::unique_ptr<TriggerStage> make_false_triggers(const EffectSpec& effect, const StageContext& context) {
  const std::vector<std::uint32_t> sensors = sensors_of(effect, context.scene);
  std::vector<std::vector<std::uint32_t>> groups;
  if (word(effect, "timing") == "simultaneous") {
    groups = {sensors};
  } else {
    for (const std::uint32_t sensor : sensors) groups.push_back({sensor});
  }
  return std::make_unique<FalseTriggers>(
      std::move(groups), effect.parameters.at("rate_per_s") / context.sensing.tick_rate_hz, Trend(effect, context));
}

/// One sensor alone triggers by itself whichever word says so.
void draw_false_triggers(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec& script, Stream& stream) {
  draw_trend(effect, scene, script, stream);
  if (effect.choices.contains("sensor")) effect.choices["timing"] = "independent";
}

Effect false_triggers() {
  return {
      .info = {.name = "false_triggers",
               .family = Family::environment,
               .stage = "environment",
               .summary = "Sensors trigger at random moments though nobody moves: each by itself, or all at once, as a "
                          "disturbed supply makes them. The rate stays, or grows about this mean from run to run.",
               .fingerprint =
                   "silent cells gain motion, all by the same amount, or later ones more; single seconds at any moment",
               .confused_with = {"trigger_bursts", "fidgeting", "soft_zone_edges"},
               .parameters = {logarithmic(strength("rate_per_s", "1/s", 0.01, 0.0005, 0.06, 10.0,
                                                   "assumed: from one in half an hour to one in 17 s"))},
               .choices = {{"timing", ChoiceKind::variant, {"independent", "simultaneous"}, "independent"},
                           trend_choice(),
                           sensor_choice()},
               .reach = Reach::triggers},
      .make_stage = make_false_triggers,
      .draw = draw_false_triggers};
}

// trigger_bursts: triggers that come back: a ventilation that switches on, sun through a blind.

struct Burst {
  double period_ticks = 1.0;
  double length_ticks = 0.0;
  double mean_per_tick = 0.0;  ///< triggers within a burst
};

/// Bursts begin a period apart, at a phase that is the same for all sensors of a run and drawn for each run: one may be
/// under way when it begins.
class TriggerBursts final : public CloneableTriggerStage<TriggerBursts> {
 public:
  TriggerBursts(std::vector<std::uint32_t> sensors, const Burst& burst) : sensors_(std::move(sensors)), burst_(burst) {}

  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    constexpr std::uint32_t everybody = 0xFFFFFFFF;
    begin_ = Stream({seed, run, everybody, Purpose::burst}).uniform() * burst_.period_ticks - burst_.period_ticks;
    streams_ = streams_of(sensors_, seed, run, Purpose::burst);
    next_.assign(sensors_.size(), std::numeric_limits<std::int64_t>::min());
  }

  void tick(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept override {
    const auto now = static_cast<double>(tick);
    if (now >= begin_ + burst_.length_ticks) begin_ += burst_.period_ticks;
    if (now < begin_) return;
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      const auto began = static_cast<std::int64_t>(begin_);
      if (next_[i] <= began) next_[i] = tick - 1 + ticks_to_event(streams_[i], burst_.mean_per_tick);
      if (tick != next_[i]) continue;
      triggers[sensors_[i]] = 1;
      next_[i] += ticks_to_event(streams_[i], burst_.mean_per_tick);
    }
  }

 private:
  std::vector<std::uint32_t> sensors_;
  Burst burst_;
  double begin_ = 0.0;  ///< tick at which the burst that goes on, or the next one, begins
  std::vector<Stream> streams_;
  std::vector<std::int64_t> next_;  ///< (n_sensors) tick of the next trigger, if the burst lasts
};

std::unique_ptr<TriggerStage> make_trigger_bursts(const EffectSpec& effect, const StageContext& context) {
  const double rate = context.sensing.tick_rate_hz;
  const double period_s = effect.parameters.at("period_s");
  const double length_s = std::min(effect.parameters.at("length_s"), period_s);
  const double per_s = effect.parameters.at("rate_per_s");
  return std::make_unique<TriggerBursts>(sensors_of(effect, context.scene),
                                         Burst{period_s * rate, length_s * rate, per_s / rate});
}

Effect trigger_bursts() {
  return {.info = {.name = "trigger_bursts",
                   .family = Family::environment,
                   .stage = "environment",
                   .summary = "Bursts of triggers come back periodically, from ventilation or sun through a blind.",
                   .fingerprint = "groups of ones a period apart, whoever sits where",
                   .confused_with = {"false_triggers"},
                   .parameters = {logarithmic(strength("length_s", "s", 3.0, 1.0, 10.0, 600.0, "assumed")),
                                  logarithmic(detail("period_s", "s", 60.0, 10.0, 600.0, 1.0, 86400.0,
                                                     "assumed: a fan's cycle to a heating's")),
                                  logarithmic(detail("rate_per_s", "1/s", 2.0, 0.5, 5.0, 0.01, 50.0,
                                                     "assumed: of triggers within a burst"))},
                   .choices = {sensor_choice()},
                   .reach = Reach::triggers},
          .make_stage = make_trigger_bursts};
}

}  // namespace

std::vector<Effect> environment_effects() { return {warm_chair(), false_triggers(), trigger_bursts()}; }

// What the plan of a room has wrong, or leaves out.
// Assumed: sensors hang where they are drawn; what is missing hides people, but nobody walks round it.
// Method: seats, meshes and actions of the study in force are edited before it is compiled.
// Sources: no measurement; sizes of furniture, each with its parameter.

namespace {

// seats_shifted: the plan's seat numbers are off by one.

/// Who is said to sit on a seat sits on the one so many further in the scene's order, round its end.
void alter_seats_shifted(StudyInForce& study, const EffectSpec& effect) {
  SceneSpec& scene = study.scene;
  const auto n = static_cast<std::int64_t>(scene.seats.size());
  const std::vector<SeatSpec> drawn = scene.seats;
  const std::int64_t places = std::llround(effect.parameters.at("places"));
  for (std::int64_t i = 0; i < n; ++i) {
    const std::int64_t from = ((i + places) % n + n) % n;
    scene.seats[static_cast<std::size_t>(i)].world_from_seat = drawn[static_cast<std::size_t>(from)].world_from_seat;
  }
}

void draw_seats_shifted(EffectSpec& effect, const SceneSpec&, const ScriptSpec&, Stream& stream) {
  if (stream.index(2) == 1) effect.parameters["places"] *= -1.0;
}

Effect seats_shifted() {
  return {.info = {.name = "seats_shifted",
                   .family = Family::data,
                   .stage = "books",
                   .summary = "Each seat's name means the seat that is `places` further on.",
                   .fingerprint = "rows of the table of sums are permuted",
                   .as_if = "trials were noted under the names of other seats",
                   .confused_with = {"mirrored_room"},
                   .parameters = {{.name = "places",
                                   .unit = "",
                                   .off = 0.0,
                                   .typical = 1.0,
                                   .low = 1.0,
                                   .high = 1.0,
                                   .least = -1000.0,
                                   .most = 1000.0,
                                   .scale = Scale::whole,
                                   .source = "assumed: one, either way"}},
                   .reach = Reach::geometry,
                   .idle_in = {Survey::coverage}},
          .alter = alter_seats_shifted,
          .draw = draw_seats_shifted};
}

// mirrored_room: the plan was read from its back.

enum class Across { x, z };

/// Reflection in the vertical plane through the middle of the floor.
class Mirror {
 public:
  Mirror(const SceneSpec& scene, Across across)
      : axis_(across == Across::z ? 2 : 0),
        twice_middle_(across == Across::z ? scene.floor.lower().y + scene.floor.upper().y
                                          : scene.floor.lower().x + scene.floor.upper().x) {}

  [[nodiscard]] Vec3 point(Vec3 p) const {
    p[axis_] = twice_middle_ - p[axis_];
    return p;
  }
  [[nodiscard]] Vec2 point(const Vec2& p) const { return floor_point(point(Vec3(p.x, 0, p.y))); }
  /// The frame at the mirrored place that faces the mirrored way; right stays right, since frames can't be mirrored.
  [[nodiscard]] Frame frame(const Frame& frame) const {
    return {rotation_from_heading(heading(heading_of(frame))), point(frame.origin)};
  }
  [[nodiscard]] double heading(double heading) const { return axis_ == 2 ? pi - heading : -heading; }
  [[nodiscard]] double heading_deg(double heading_deg) const {
    return std::remainder(degrees(heading(radians(heading_deg))), 360.0);
  }

 private:
  int axis_;
  double twice_middle_;
};

FloorArea mirrored(const FloorArea& floor, const Mirror& mirror) {
  std::vector<std::vector<Vec2>> loops = floor.loops();
  for (auto& loop : loops) {
    for (Vec2& p : loop) p = mirror.point(p);
    std::ranges::reverse(loop);
  }
  return {loops, floor.height_m()};
}

void mirror_meshes(std::vector<TriMesh>& meshes, const Mirror& mirror) {
  for (TriMesh& mesh : meshes) {
    for (Vec3& p : mesh.positions) p = mirror.point(p);
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
}

void mirror_actions(std::vector<ScriptedAction>& actions, const Mirror& mirror) {
  for (ScriptedAction& action : actions) {
    for_each_place(
        action.what, [&](Vec2& point) { point = mirror.point(point); },
        [&](double& heading_deg) { heading_deg = mirror.heading_deg(heading_deg); });
  }
}

void alter_mirrored_room(StudyInForce& study, const EffectSpec& effect) {
  SceneSpec& scene = study.scene;
  const auto across = effect.choices.find("across");
  const Mirror mirror(scene, across != effect.choices.end() && across->second == "z" ? Across::z : Across::x);
  mirror_meshes(scene.meshes, mirror);
  for (SeatSpec& seat : scene.seats) seat.world_from_seat = mirror.frame(seat.world_from_seat);
  for (PlaceSpec& place : scene.places) place.world_from_place = mirror.frame(place.world_from_place);
  for (EntranceSpec& door : scene.entrances) door.world_from_entrance = mirror.frame(door.world_from_entrance);
  for (DoorSpec& door : scene.doors) {
    door.world_from_door = mirror.frame(door.world_from_door);
    door.hinge = door.hinge == DoorHinge::left ? DoorHinge::right : DoorHinge::left;
  }
  scene.floor = mirrored(scene.floor, mirror);
  for (AreaSpec& area : scene.areas) area.outline = mirrored(area.outline, mirror);
  for (TrialInForce& trial : study.trials) {
    for (PersonInForce& person : trial.people) mirror_actions(person.actions, mirror);
  }
}

Effect mirrored_room() {
  return {
      .info = {.name = "mirrored_room",
               .family = Family::data,
               .stage = "books",
               .summary = "Seats, doors and furniture were drawn mirrored; sensors hang where they are drawn.",
               .fingerprint = "seats have changed places with those on the other side",
               .as_if = "left and right of the room were mixed up",
               .confused_with = {"seats_shifted", "labels_swapped"},
               .parameters = {whether("mirrored", "assumed")},
               .choices = {{"across", ChoiceKind::word, {"x", "z"}, "x runs backwards, about the middle of the floor"}},
               .reach = Reach::geometry},
      .alter = alter_mirrored_room};
}

// missing_occluder: something hides people that the plan leaves out.

constexpr double behind_m = 0.17;  // assumed (0.15-0.25): a chair's back behind the middle of the pelvis
constexpr double thick_m = 0.03;   // assumed

/// A closed box; people walk through it, rays don't.
TriMesh screen(const std::string& name, const Frame& world_from_box, const Vec3& half_extents) {
  TriMesh mesh;
  mesh.name = name;
  mesh.solidity = Solidity::screen;
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    const Vec3 sign((corner & 1U) != 0 ? 1 : -1, (corner & 2U) != 0 ? 1 : -1, (corner & 4U) != 0 ? 1 : -1);
    mesh.positions.push_back(world_from_box * (sign * half_extents));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

bool is_box(const EffectSpec& effect) { return word(effect, "what") == "box"; }

void alter_missing_occluder(StudyInForce& study, const EffectSpec& effect) {
  SceneSpec& scene = study.scene;
  const double half_height = 0.5 * effect.parameters.at(is_box(effect) ? "box_height_m" : "height_m");
  const double half_width = 0.5 * effect.parameters.at("width_m");
  if (is_box(effect)) {
    const Frame middle{Quat(1, 0, 0, 0), Vec3(effect.parameters.at("x_m"), scene.floor.height_m() + half_height,
                                              effect.parameters.at("z_m"))};
    scene.meshes.push_back(screen("missing box", middle, {half_width, half_height, half_width}));
    return;
  }
  for (const SeatSpec& seat : scene.seats) {
    const Frame middle = seat.world_from_seat * Frame{Quat(1, 0, 0, 0), Vec3(0, half_height, behind_m)};
    scene.meshes.push_back(screen("back of " + seat.id, middle, {half_width, half_height, 0.5 * thick_m}));
  }
}

void draw_missing_occluder(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream& stream) {
  const double clear_m = 0.5 * effect.parameters.at("width_m");
  if (!is_box(effect) || !draw_free_place(effect, scene, clear_m, stream)) effect.choices["what"] = "chair_backs";
}

void settle_missing_occluder(EffectSpec& effect, const SceneSpec& scene) {
  if (is_box(effect)) settle_free_place(effect, scene, 0.5 * effect.parameters.at("width_m"));
}

Effect missing_occluder() {
  return {
      .info = {.name = "missing_occluder",
               .family = Family::occlusion,
               .stage = "placement",
               .summary = "Chair backs at all seats, or a box somewhere, hide people. Nobody has to walk round them.",
               .fingerprint = "some pairs of seat and sensor fall silent, the others stay",
               .confused_with = {"thermal_contrast", "range_scale"},
               .parameters = {strength("height_m", "m", 0.45, 0.2, 0.7, 5.0,
                                       "assumed: of a chair's back above the seat", {"what", "chair_backs"}),
                              strength(
                                  "box_height_m", "m", 1.5, 1.0, 2.0, 5.0,
                                  "assumed: above the floor: a plant, a screen on a stand, the lower part of a pillar",
                                  {"what", "box"}),
                              detail("width_m", "m", 0.45, 0.35, 0.6, 0.01, 20.0, "assumed: a box is as deep as wide"),
                              floor_coordinate("x_m", {"what", "box"}), floor_coordinate("z_m", {"what", "box"})},
               .choices = {{"what", ChoiceKind::word, {"chair_backs", "box"}, "chair backs"}},
               .reach = Reach::geometry},
      .alter = alter_missing_occluder,
      .draw = draw_missing_occluder,
      .settle = settle_missing_occluder};
}

}  // namespace

std::vector<Effect> room_effects() { return {seats_shifted(), mirrored_room(), missing_occluder()}; }

}  // namespace pirsim::effects
