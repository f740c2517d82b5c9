#include "sim/posture_powers.hpp"

#include <algorithm>

#include "sim/power_meter.hpp"

namespace pirsim::sim {
namespace {

/// The zones of these sensors. sensors: (n_sensors) 1 for those that are meant.
ZoneSet zones_of(const RayBundle& bundle, std::span<const std::uint8_t> sensors) {
  ZoneSet zones(bundle.n_zones());
  for (std::size_t sensor = 0; sensor < bundle.n_sensors(); ++sensor) {
    const std::uint32_t end = bundle.cluster_zones_begin[bundle.sensor_clusters_begin[sensor + 1]];
    auto zone = bundle.cluster_zones_begin[bundle.sensor_clusters_begin[sensor]];
    for (; zone < end && sensors[sensor] != 0; ++zone) zones.insert(zone);
  }
  return zones;
}

}  // namespace

PosturePowers::PosturePowers(const CompiledStudy& study, std::span<const std::uint8_t> left_out)
    : power_(study.array().analog()->power()),
      powers_(power_.n_receivers(), 0),
      n_hit_(power_.clipped().n_zones(), 0),
      touched_(power_.clipped().n_zones()) {
  const ZoneSet unasked = zones_of(power_.clipped(), left_out);
  rated_ = without(power_.rays().bundle, unasked);
  clipped_ = without(power_.clipped(), unasked);
  const std::vector<std::uint32_t>& begin = power_.clipped().zone_rays_begin;
  for (std::size_t zone = 0; zone < power_.clipped().n_zones(); ++zone) {
    for (std::uint32_t ray = begin[zone]; ray < begin[zone + 1] && !unasked.test(zone); ++ray) {
      rays_.push_back(ray);
      zone_of_.push_back(static_cast<std::uint32_t>(zone));
    }
  }
  tracer_ = rt::make_tracer(study.tracer(), {&study.array().room(), &rated_, &clipped_});
}

void PosturePowers::measure(const Postures& postures, std::span<const PostureIndex::Number> people,
                            std::span<PowerSteps> powers) {
  moved_.clear();
  for (std::size_t i = 0; i < figures_.size(); ++i) {
    const bool stays = i < people.size() && people[i] != 0 && figures_[i].figure == postures.figure(people[i]);
    if (figures_[i].posture != 0 && !stays) moved_.push_back({i, {}, {}});
  }
  follow();
  for (const rt::Moved& gone : moved_) figures_[gone.person].posture = 0;
  moved_.clear();
  if (figures_.size() < people.size()) figures_.resize(people.size());
  for (std::size_t i = 0; i < people.size(); ++i) {
    Figure& figure = figures_[i];
    if (people[i] == figure.posture) continue;
    if (figure.posture == 0) {
      figure.figure = postures.figure(people[i]);
      figure.radiance = postures.radiance(people[i]);
      figure.surfaces = surfaces_of(figure.radiance);
    }
    figure.posture = people[i];
    moved_.push_back(
        {i, figure.mannequin.pose(postures.humanoid(people[i]), postures.outline(people[i])), figure.surfaces});
  }
  follow();
  std::ranges::copy(powers_, powers.begin());
}

void PosturePowers::shrink(std::size_t n) noexcept {
  for (Figure& figure : figures_) {
    if (figure.posture > n) figure.posture = forgotten;
  }
}

void PosturePowers::follow() {
  if (moved_.empty() || rays_.empty()) return;
  tracer_->follow(moved_, changes_);
  for (const auto& [ray, before, after] : changes_) {
    const std::uint32_t of_study = rays_[ray];
    powers_[power_.receiver_of(of_study)] += power(of_study, after) - power(of_study, before);
    std::uint32_t& n = n_hit_[zone_of_[ray]];
    if (before == rt::no_solid && n++ == 0) touched_.insert(zone_of_[ray]);
    if (after == rt::no_solid && --n == 0) touched_.erase(zone_of_[ray]);
  }
}

}  // namespace pirsim::sim
