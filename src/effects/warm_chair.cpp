// A seat stays warm after somebody has left it.
#include "pirsim/shapes.hpp"

#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

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

std::unique_ptr<TriggerStage> make(const EffectSpec& effect, const StageContext& context) {
  const std::vector<std::uint32_t> sensors = sensors_of(effect, context.scene);
  std::vector<std::vector<std::uint8_t>> seen;
  for (const std::uint32_t sensor : sensors) seen.push_back(seats_seen(context, sensor));
  const double rate = context.sensing.tick_rate_hz;
  return std::make_unique<WarmChair>(sensors, std::move(seen), effect.parameters.at("rate_per_s") / rate,
                                     effect.parameters.at("decay_s") * rate);
}

}  // namespace

const Effect& warm_chair() {
  static const Effect effect{
      .info = {.name = "warm_chair",
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
               .idle_in = {Survey::coverage, Survey::walk_test}},
      .make_stage = make};
  return effect;
}

}  // namespace pirsim::effects
