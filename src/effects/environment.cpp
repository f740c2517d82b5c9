// Triggers that nobody's motion makes.
// Assumed: they come at random, independent of what people do but for the seats that they leave.
// Method: stages that set triggers tick by tick, from Poisson processes with streams of their own.
// Sources: no measurement; rates are assumed, with their reasons.
#include <algorithm>
#include <limits>

#include "effects/kit.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim::effects {
namespace {

// warm_chair: a seat stays warm after somebody has left it.

constexpr float seat_radius_m = 0.25F;  // assumed (0.2-0.3): of what is warm

/// (n_seats) 1 where a ray of the sensor hits the seat.
std::vector<std::uint8_t> seats_seen(const StageContext& context, std::uint32_t sensor) {
  const RayBundle& rays = context.clipped_rays;
  const auto first_ray = [&](std::uint32_t cluster) { return rays.zone_rays_begin[rays.cluster_zones_begin[cluster]]; };
  std::vector<std::uint8_t> seen;
  for (const SeatSpec& seat : context.scene.seats) {
    const PosedSphere warm{Vec3f(seat.world_from_seat.origin), seat_radius_m};
    std::uint8_t is_hit = 0;
    for (auto i = first_ray(rays.sensor_clusters_begin[sensor]); i < first_ray(rays.sensor_clusters_begin[sensor + 1]);
         ++i) {
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
  return {.info = {.name = "warm_chair",
                   .family = Family::environment,
                   .stage = "environment",
                   .summary = "A seat that was left triggers the sensors that see it, at a rate that decays.",
                   .fingerprint = "activity after leaving, where a sensor sees the seat",
                   .confused_with = {"false_triggers", "fidgeting"},
                   .parameters = {{.name = "rate_per_s",
                                   .unit = "1/s",
                                   .off = 0.0,
                                   .typical = 0.05,
                                   .low = 0.01,
                                   .high = 0.3,
                                   .least = 0.0,
                                   .most = 10.0,
                                   .scale = Scale::logarithmic,
                                   .source = "assumed: just after leaving"},
                                  {.name = "decay_s",
                                   .unit = "s",
                                   .role = Role::detail,
                                   .off = 120.0,
                                   .typical = 120.0,
                                   .low = 60.0,
                                   .high = 300.0,
                                   .least = 1.0,
                                   .most = 3600.0,
                                   .scale = Scale::logarithmic,
                                   .source = "assumed: to 1/e"}},
                   .choices = {sensor_choice()},
                   .reach = Reach::triggers,
                   .in_analog = "the same, behind the comparator: the seat's own heat isn't traced",
                   .idle_in = {Survey::coverage, Survey::walk_test}},
          .make_stage = make_warm_chair};
}

// false_triggers: triggers without a person: noise of element and amplifier, draughts.

/// A Poisson process a sensor, or one for all of them, alike at all times.
class FalseTriggers final : public CloneableTriggerStage<FalseTriggers> {
 public:
  /// groups: sensors that trigger together.
  FalseTriggers(std::vector<std::vector<std::uint32_t>> groups, double mean_per_tick)
      : groups_(std::move(groups)), mean_per_tick_(mean_per_tick) {
    for (const auto& group : groups_) first_.push_back(group.front());
  }

  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    streams_ = streams_of(first_, seed, run, Purpose::false_trigger);
    next_.clear();
    for (Stream& stream : streams_) next_.push_back(ticks_to_event(stream, mean_per_tick_));
  }

  void tick(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept override {
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      if (tick != next_[i]) continue;
      for (const std::uint32_t sensor : groups_[i]) triggers[sensor] = 1;
      next_[i] += ticks_to_event(streams_[i], mean_per_tick_);
    }
  }

 private:
  std::vector<std::vector<std::uint32_t>> groups_;
  double mean_per_tick_;
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
  return std::make_unique<FalseTriggers>(std::move(groups),
                                         effect.parameters.at("rate_per_s") / context.sensing.tick_rate_hz);
}

/// One sensor alone triggers by itself whichever word says so.
void draw_false_triggers(EffectSpec& effect, const SceneSpec&, const ScriptSpec&, Stream&) {
  if (effect.choices.contains("sensor")) effect.choices["timing"] = "independent";
}

Effect false_triggers() {
  return {
      .info = {.name = "false_triggers",
               .family = Family::environment,
               .stage = "environment",
               .summary =
                   "Sensors trigger at random moments without anybody's doing, at one rate: each by itself, or all at "
                   "the same moments, as a disturbed supply makes them.",
               .fingerprint = "silent cells come alive, all by the same amount; single ones, at any moment",
               .confused_with = {"trigger_bursts", "fidgeting", "soft_zone_edges"},
               .parameters = {{.name = "rate_per_s",
                               .unit = "1/s",
                               .off = 0.0,
                               .typical = 0.01,
                               .low = 0.0005,
                               .high = 0.06,
                               .least = 0.0,
                               .most = 10.0,
                               .scale = Scale::logarithmic,
                               .source = "assumed: from one in half an hour to one in 17 s"}},
               .choices = {{"timing", ChoiceKind::variant, {"independent", "simultaneous"}, "independent"},
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
                   .summary = "Bursts of triggers come back periodically: ventilation, sun through a blind.",
                   .fingerprint = "groups of ones a period apart, whoever sits where",
                   .confused_with = {"false_triggers"},
                   .parameters = {{.name = "length_s",
                                   .unit = "s",
                                   .off = 0.0,
                                   .typical = 3.0,
                                   .low = 1.0,
                                   .high = 10.0,
                                   .least = 0.0,
                                   .most = 600.0,
                                   .scale = Scale::logarithmic,
                                   .source = "assumed"},
                                  {.name = "period_s",
                                   .unit = "s",
                                   .role = Role::detail,
                                   .off = 60.0,
                                   .typical = 60.0,
                                   .low = 10.0,
                                   .high = 600.0,
                                   .least = 1.0,
                                   .most = 86400.0,
                                   .scale = Scale::logarithmic,
                                   .source = "assumed: a fan's cycle to a heating's"},
                                  {.name = "rate_per_s",
                                   .unit = "1/s",
                                   .role = Role::detail,
                                   .off = 2.0,
                                   .typical = 2.0,
                                   .low = 0.5,
                                   .high = 5.0,
                                   .least = 0.01,
                                   .most = 50.0,
                                   .scale = Scale::logarithmic,
                                   .source = "assumed: of triggers within a burst"}},
                   .choices = {sensor_choice()},
                   .reach = Reach::triggers},
          .make_stage = make_trigger_bursts};
}

}  // namespace

std::vector<Effect> environment_effects() { return {warm_chair(), false_triggers(), trigger_bursts()}; }

}  // namespace pirsim::effects
