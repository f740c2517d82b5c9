#include "schema/fingerprint.hpp"

namespace pirsim {

void Fingerprint::add(std::string_view text) {
  add(text.size());
  digest_.add(text);
}

void Fingerprint::add(const Frame& frame) {
  const auto& [rotation, origin] = frame;
  for (int i = 0; i < 4; ++i) add(rotation[i]);
  add(origin);
}

// Structured bindings name every field, so that a new one doesn't compile until it stands here.

void Fingerprint::add(const DetectorSpec& detector) {
  const auto& [element, amplifier, comparator] = detector;
  const auto& [thermal_s, electrical_s] = element;
  const auto& [low_hz, high_hz, order, volts_per_watt, noise_v_pp, offset_v, lowest_v, highest_v] = amplifier;
  const auto& [positive_v, negative_v, pulse_count, pulse_window_s, pulse_signs, hold_s, blind_s] = comparator;
  add_each(thermal_s, electrical_s, low_hz, high_hz, order, volts_per_watt, noise_v_pp, offset_v, lowest_v, highest_v,
           positive_v, negative_v, pulse_count, pulse_window_s, pulse_signs, hold_s, blind_s);
}

void Fingerprint::add(const ZoneSpec& zone) {
  const auto& [corners, polarity] = zone;
  for (const Vec2& corner : corners) add(corner);
  add(polarity);
}

void Fingerprint::add(const ClusterSpec& cluster) {
  const auto& [centre, range_m, lens_step, zones] = cluster;
  add_each(centre, range_m, lens_step, zones);
}

void Fingerprint::add(const SensorModelSpec& model) {
  const auto& [id, description, plane_m, clusters, response, optics, detector] = model;
  const auto& [blur_deg, aperture_mm2] = optics;
  add_each(id, plane_m, clusters, response, blur_deg, aperture_mm2, detector);
}

void Fingerprint::add(const TriMesh& mesh) {
  const auto& [name, positions, triangles, solidity, temperature_c] = mesh;
  add_each(name, positions);  // effects name meshes
  add(triangles.size());
  for (const auto& corners : triangles) {
    for (const std::uint32_t corner : corners) add(corner);
  }
  add_each(solidity, temperature_c);
}

void Fingerprint::add(const SensorSpec& sensor) {
  const auto& [id, model, world_from_sensor] = sensor;
  add_each(id, model, world_from_sensor);
}

void Fingerprint::add(const SeatSpec& seat) {
  const auto& [id, world_from_seat] = seat;
  add_each(id, world_from_seat);
}

void Fingerprint::add(const EntranceSpec& entrance) {
  const auto& [id, world_from_entrance, width_m, outside_m] = entrance;
  add_each(id, world_from_entrance, width_m, outside_m);
}

void Fingerprint::add(const FloorArea& floor) { add_each(floor.height_m(), floor.loops()); }

void Fingerprint::add(const SceneSpec& scene) {
  const auto& [name, meshes, sensors, seats, entrances, floor, sensor_models, files, warnings] = scene;
  add_each(meshes, sensors, seats, entrances, floor, sensor_models);
}

void Fingerprint::add(const SensingSpec& sensing) {
  const auto& [tick_rate_hz, ticks_per_window, rays_per_zone, change_per, reader, response, ambient_c,
               analog_rays_per_zone] = sensing;
  add_each(tick_rate_hz, ticks_per_window, rays_per_zone, change_per, reader, response, ambient_c,
           analog_rays_per_zone);
}

void Fingerprint::add(const EffectSpec& effect) {
  const auto& [name, parameters, choices, where] = effect;
  add_each(name, parameters, choices);
}

}  // namespace pirsim
