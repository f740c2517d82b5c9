#include "engine/rt/tracer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <span>

namespace pirsim::rt {
namespace {

/// Widens cones (radians) and spheres (metres, and as a share of the distance) far beyond single precision's rounding.
constexpr double angle_margin = 1e-4;
constexpr float distance_margin = 1e-3F;
constexpr float distance_share = 1e-5F;

ViewCone touches_everything() noexcept {
  ViewCone cone;
  cone.length = std::numeric_limits<float>::infinity();
  cone.sine = 1.0F;
  cone.cosine = 0.0F;
  cone.axis = Vec3f(0.0F);
  return cone;
}

ViewCone cone_of(const RayBundle& bundle, std::size_t first_zone, std::size_t end_zone) {
  const std::size_t begin = bundle.zone_rays_begin[first_zone], end = bundle.zone_rays_begin[end_zone];
  return cone_around(std::span(bundle.rays).subspan(begin, end - begin),
                     std::span(bundle.range).subspan(begin, end - begin));
}

constexpr Column ConeBlock::*columns[] = {&ConeBlock::apex_x, &ConeBlock::apex_y, &ConeBlock::apex_z,
                                          &ConeBlock::axis_x, &ConeBlock::axis_y, &ConeBlock::axis_z,
                                          &ConeBlock::cosine, &ConeBlock::sine,   &ConeBlock::length};

ConeBlock untouchable() noexcept {
  ConeBlock block{};
  std::ranges::fill(block.length, -1e30F);
  return block;
}

/// The axis along which the directions differ most.
int widest_axis(std::span<const std::uint32_t> order, const std::vector<Ray>& rays) {
  Vec3f lower = rays[order.front()].direction, upper = lower;
  for (const std::uint32_t i : order) {
    lower = glm::min(lower, rays[i].direction);
    upper = glm::max(upper, rays[i].direction);
  }
  const Vec3f width = upper - lower;
  const int wider = width.x < width.y ? 1 : 0;
  return width[wider] < width.z ? 2 : wider;
}

/// Halves, quarters and so on by direction, down to packets.
void sort_into_packets(std::span<std::uint32_t> order, const std::vector<Ray>& rays) {
  if (order.size() <= packet_size) return;
  const std::size_t n_packets = (order.size() + packet_size - 1) / packet_size;
  const std::size_t middle = n_packets / 2 * packet_size;
  const int axis = widest_axis(order, rays);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const float x = rays[a].direction[axis], y = rays[b].direction[axis];
    return x < y || (x == y && a < b);
  });
  sort_into_packets(order.first(middle), rays);
  sort_into_packets(order.subspan(middle), rays);
}

void set(RayPacket& packet, std::size_t i, const Ray& ray, float range, std::uint32_t zone) noexcept {
  packet.origin_x[i] = ray.origin.x;
  packet.origin_y[i] = ray.origin.y;
  packet.origin_z[i] = ray.origin.z;
  packet.direction_x[i] = ray.direction.x;
  packet.direction_y[i] = ray.direction.y;
  packet.direction_z[i] = ray.direction.z;
  packet.range[i] = range;
  packet.zone[i] = zone;
}

std::vector<std::uint32_t> zone_of_each_ray(const RayBundle& bundle) {
  std::vector<std::uint32_t> zones;
  for (std::uint32_t zone = 0; zone < bundle.n_zones(); ++zone) zones.resize(bundle.zone_rays_begin[zone + 1], zone);
  return zones;
}

}  // namespace

ViewCone cone_around(std::span<const Ray> rays, std::span<const float> range) {
  if (rays.empty()) return ViewCone{};
  const bool one_origin =
      std::all_of(rays.begin(), rays.end(), [&](const Ray& ray) { return ray.origin == rays.front().origin; });
  Vec3 sum(0.0);
  for (const Ray& ray : rays) sum += Vec3(ray.direction);
  if (!one_origin || !(glm::length(sum) > 1e-6)) return touches_everything();

  const Vec3 axis = glm::normalize(sum);
  double widest = 0.0;
  for (const Ray& ray : rays) {
    const Vec3 direction(ray.direction);
    widest = std::max(widest, std::atan2(glm::length(glm::cross(axis, direction)), glm::dot(axis, direction)));
  }
  const double half_angle = widest + angle_margin;
  // The test below holds for cones up to a half-space.
  if (half_angle > 1.5) return touches_everything();

  ViewCone cone;
  cone.apex = rays.front().origin;
  cone.axis = Vec3f(axis);
  cone.cosine = static_cast<float>(std::cos(half_angle));
  cone.sine = static_cast<float>(std::sin(half_angle));
  cone.length = *std::max_element(range.begin(), range.end());
  return cone;
}

bool may_touch(const ViewCone& cone, const BoundingSphere& sphere) noexcept {
  const Vec3f offset = sphere.centre - cone.apex;
  const float along = glm::dot(offset, cone.axis);
  const float across = glm::length(offset - cone.axis * along);
  const float reach = sphere.radius + distance_margin + distance_share * (std::abs(along) + across);
  // Projection of the offset on the cone's outward normal: at most the distance to the cone, equal beside it.
  const bool is_beside = across * cone.cosine - along * cone.sine > reach;
  return !is_beside && along - reach <= cone.length;
}

BoundingSphere bounding_sphere(const PosedShape& shape) noexcept {
  if (const auto* sphere = std::get_if<PosedSphere>(&shape)) return {sphere->centre, sphere->radius};
  if (const auto* capsule = std::get_if<PosedCapsule>(&shape)) {
    return {(capsule->a + capsule->b) * 0.5F, glm::length(capsule->b - capsule->a) * 0.5F + capsule->radius};
  }
  const auto* mesh = std::get_if<PosedMesh>(&shape);
  const PosedBox box = mesh != nullptr ? box_around(*mesh) : std::get<PosedBox>(shape);
  return {box.centre, glm::length(box.half_extents)};
}

BoundingSphere bounding_sphere(std::span<const BoundingSphere> spheres) noexcept {
  Vec3f lower = spheres.front().centre, upper = lower;
  for (const BoundingSphere& sphere : spheres) {
    lower = glm::min(lower, sphere.centre - sphere.radius);
    upper = glm::max(upper, sphere.centre + sphere.radius);
  }
  BoundingSphere all{(lower + upper) * 0.5F, 0.0F};
  for (const BoundingSphere& sphere : spheres) {
    all.radius = std::max(all.radius, glm::length(sphere.centre - all.centre) + sphere.radius);
  }
  return all;
}

std::vector<ViewCone> cluster_cones(const RayBundle& bundle) {
  std::vector<ViewCone> cones;
  for (std::size_t cluster = 0; cluster < bundle.n_clusters(); ++cluster) {
    cones.push_back(cone_of(bundle, bundle.cluster_zones_begin[cluster], bundle.cluster_zones_begin[cluster + 1]));
  }
  return cones;
}

std::vector<ViewCone> zone_cones(const RayBundle& bundle) {
  std::vector<ViewCone> cones;
  for (std::size_t zone = 0; zone < bundle.n_zones(); ++zone) cones.push_back(cone_of(bundle, zone, zone + 1));
  return cones;
}

bool may_touch_any(const ViewCone& cone, std::span<const BoundingSphere> spheres) noexcept {
  return std::any_of(spheres.begin(), spheres.end(),
                     [&](const BoundingSphere& sphere) { return may_touch(cone, sphere); });
}

std::vector<RayPacket> packet_of_rays(const RayBundle& bundle) {
  const std::vector<std::uint32_t> zones = zone_of_each_ray(bundle);
  std::vector<RayPacket> packets;
  for (std::size_t sensor = 0; sensor < bundle.n_sensors(); ++sensor) {
    const auto begin = bundle.first_ray(sensor);
    const auto end = bundle.first_ray(sensor + 1);
    std::vector<std::uint32_t> order(end - begin);
    std::iota(order.begin(), order.end(), begin);
    sort_into_packets(order, bundle.rays);
    for (std::size_t k = 0; k < order.size(); k += packet_size) {
      RayPacket& packet = packets.emplace_back();
      for (std::size_t i = 0; i < packet_size; ++i) {
        const bool is_missing = k + i >= order.size();
        const std::uint32_t ray = is_missing ? order.back() : order[k + i];
        set(packet, i, bundle.rays[ray], is_missing ? -1.0F : bundle.range[ray], zones[ray]);
        packet.ray[i] = ray;
      }
    }
  }
  return packets;
}

std::vector<ConeBlock> cones_around(const std::vector<RayPacket>& packets) {
  std::vector<ConeBlock> cones((packets.size() + packet_size - 1) / packet_size, untouchable());
  std::array<Ray, packet_size> rays;
  for (std::size_t p = 0; p < packets.size(); ++p) {
    const RayPacket& packet = packets[p];
    for (std::size_t i = 0; i < packet_size; ++i) {
      rays[i] = {Vec3f(packet.origin_x[i], packet.origin_y[i], packet.origin_z[i]),
                 Vec3f(packet.direction_x[i], packet.direction_y[i], packet.direction_z[i])};
    }
    const ViewCone cone = cone_around(rays, packet.range);
    const float values[] = {cone.apex.x, cone.apex.y, cone.apex.z, cone.axis.x, cone.axis.y,
                            cone.axis.z, cone.cosine, cone.sine,   cone.length};
    for (std::size_t c = 0; c < std::size(columns); ++c)
      (cones[p / packet_size].*columns[c])[p % packet_size] = values[c];
  }
  return cones;
}

void pick(const std::vector<ConeBlock>& cones, const std::uint32_t* indices, std::size_t n,
          std::vector<ConeBlock>& picked) {
  static const ConeBlock empty = untouchable();
  picked.assign((n + packet_size - 1) / packet_size, empty);
  for (std::size_t k = 0; k < n; ++k) {
    const ConeBlock& from = cones[indices[k] / packet_size];
    for (const auto column : columns)
      (picked[k / packet_size].*column)[k % packet_size] = (from.*column)[indices[k] % packet_size];
  }
}

LeafCuts::LeafCuts(const RayBundle& clipped, const std::vector<DoorLeaf>& leaves)
    : clipped_(&clipped), leaves_(&leaves) {
  for (const DoorLeaf& leaf : leaves) {
    Door& door = doors_.emplace_back();
    PosedBox swept = leaf.swept();
    swept.half_extents += 1e-3F;  // metres; far more than the ray tests' rounding
    for (std::uint32_t ray = 0; ray < clipped.rays.size(); ++ray) {
      if (entry_distance(clipped.rays[ray], swept, clipped.range[ray])) door.near.push_back(ray);
    }
    door.shut = cuts_by(leaf.at(0), door.near);
    door.open = cuts_by(leaf.at(leaf.open_step()), door.near);
  }
}

std::vector<LeafCuts::Cut> LeafCuts::cuts_by(const PosedBox& leaf, const std::vector<std::uint32_t>& near) const {
  std::vector<Cut> cuts;
  for (const std::uint32_t ray : near) {
    if (const auto distance = entry_distance(clipped_->rays[ray], leaf, clipped_->range[ray]))
      cuts.emplace_back(ray, *distance);
  }
  return cuts;
}

void LeafCuts::cut(std::span<const LeafStep> steps, std::vector<float>& range) const {
  range = clipped_->range;
  const auto shorten = [&](const std::vector<Cut>& cuts) {
    for (const auto& [ray, distance] : cuts) range[ray] = std::min(range[ray], distance);
  };
  for (std::size_t i = 0; i < doors_.size(); ++i) {
    const DoorLeaf& leaf = (*leaves_)[i];
    if (leaf.rests(steps[i])) {
      shorten(steps[i] == 0 ? doors_[i].shut : doors_[i].open);
    } else {
      shorten(cuts_by(leaf.at(steps[i]), doors_[i].near));
    }
  }
}

}  // namespace pirsim::rt
