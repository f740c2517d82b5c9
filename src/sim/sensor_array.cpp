#include "sim/sensor_array.hpp"

#include "pir/optics.hpp"
#include "sim/reflections.hpp"

namespace pirsim::sim {
namespace {

RayBundle rated_rays(const SceneSpec& scene, const SensingInForce& sensing, const rt::Room& room) {
  RayBundle rays;
  const std::vector<double> levels = pir::edge_levels(sensing.edge_sigma_deg);
  for (const SensorSpec& sensor : scene.sensors) {
    pir::append(rays, sensor, scene.sensor_models.at(sensor.model), sensing.rays_per_zone, levels);
  }
  add_reflections(rays, room, scene.meshes, sensing.reflections);
  return rays;
}

}  // namespace

SensorArray::SensorArray(const SceneSpec& scene, const SensingInForce& sensing, std::shared_ptr<const rt::Room> room)
    : room_(std::move(room)),
      n_levels_(pir::edge_levels(sensing.edge_sigma_deg).size()),
      ticks_per_window_(sensing.ticks_per_window),
      rated_(rated_rays(scene, sensing, *room_)),
      clipped_(rated_),
      channels_(rated_, sensing.change_per) {
  room_->clip(clipped_);
  if (sensing.dual_polarity) {
    polarity_.emplace(scene, *sensing.dual_polarity, n_levels_, 1.0 / sensing.tick_rate_hz);
  }
  if (AnalogModel::is_needed(scene, sensing)) analog_.emplace(scene, sensing, *room_);
}

std::unique_ptr<rt::Tracer> SensorArray::make_tracer(TracerKind kind) const {
  return rt::make_tracer(kind, {room_.get(), &rated_, &clipped_});
}

std::unique_ptr<rt::Tracer> SensorArray::make_power_tracer(TracerKind kind) const {
  return rt::make_tracer(kind, {room_.get(), &analog_->power().rays().bundle, &analog_->power().clipped()});
}

Exposure SensorArray::unexposed() const {
  return {ZoneSet(channels_.n_zones()), ZoneSet(channels_.n_channels()),
          std::vector<double>(polarity_ ? n_sensors() : 0, 0.0),
          std::vector<PowerSteps>(analog_ ? n_sensors() : 0, PowerSteps{0})};
}

void SensorArray::expose(Exposure& exposure) const noexcept {
  exposure.channels.clear();
  channels_.add_channels(exposure.zones, exposure.channels);
  if (polarity_) polarity_->add_up(exposure.zones, exposure.sums);
}

}  // namespace pirsim::sim
