#include "rt/ray_packs.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

#include "rt/view_cones.hpp"

namespace pirsim::rt {
namespace {

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

/// Halves, quarters and so on by direction, down to packs.
void sort_into_packs(std::span<std::uint32_t> order, const std::vector<Ray>& rays) {
  if (order.size() <= pack_size) return;
  const std::size_t n_packs = (order.size() + pack_size - 1) / pack_size;
  const std::size_t middle = n_packs / 2 * pack_size;
  const int axis = widest_axis(order, rays);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const float x = rays[a].direction[axis], y = rays[b].direction[axis];
    return x < y || (x == y && a < b);
  });
  sort_into_packs(order.first(middle), rays);
  sort_into_packs(order.subspan(middle), rays);
}

void set(RayPack& pack, std::size_t i, const Ray& ray, float range, std::uint32_t zone) noexcept {
  pack.origin_x[i] = ray.origin.x;
  pack.origin_y[i] = ray.origin.y;
  pack.origin_z[i] = ray.origin.z;
  pack.direction_x[i] = ray.direction.x;
  pack.direction_y[i] = ray.direction.y;
  pack.direction_z[i] = ray.direction.z;
  pack.range[i] = range;
  pack.zone[i] = zone;
}

std::vector<std::uint32_t> zone_of_each_ray(const RayBundle& bundle) {
  std::vector<std::uint32_t> zones;
  for (std::uint32_t zone = 0; zone < bundle.n_zones(); ++zone) zones.resize(bundle.zone_rays_begin[zone + 1], zone);
  return zones;
}

}  // namespace

std::vector<RayPack> pack_rays(const RayBundle& bundle) {
  const std::vector<std::uint32_t> zones = zone_of_each_ray(bundle);
  std::vector<RayPack> packs;
  for (std::size_t sensor = 0; sensor < bundle.n_sensors(); ++sensor) {
    const auto begin = bundle.zone_rays_begin[bundle.cluster_zones_begin[bundle.sensor_clusters_begin[sensor]]];
    const auto end = bundle.zone_rays_begin[bundle.cluster_zones_begin[bundle.sensor_clusters_begin[sensor + 1]]];
    std::vector<std::uint32_t> order(end - begin);
    std::iota(order.begin(), order.end(), begin);
    sort_into_packs(order, bundle.rays);
    for (std::size_t k = 0; k < order.size(); k += pack_size) {
      RayPack& pack = packs.emplace_back();
      for (std::size_t i = 0; i < pack_size; ++i) {
        const bool is_missing = k + i >= order.size();
        const std::uint32_t ray = is_missing ? order.back() : order[k + i];
        set(pack, i, bundle.rays[ray], is_missing ? -1.0F : bundle.range[ray], zones[ray]);
        pack.ray[i] = ray;
      }
    }
  }
  return packs;
}

std::vector<ConeBlock> cones_around(const std::vector<RayPack>& packs) {
  std::vector<ConeBlock> cones((packs.size() + pack_size - 1) / pack_size, untouchable());
  std::array<Ray, pack_size> rays;
  for (std::size_t p = 0; p < packs.size(); ++p) {
    const RayPack& pack = packs[p];
    for (std::size_t i = 0; i < pack_size; ++i) {
      rays[i] = {Vec3f(pack.origin_x[i], pack.origin_y[i], pack.origin_z[i]),
                 Vec3f(pack.direction_x[i], pack.direction_y[i], pack.direction_z[i])};
    }
    const ViewCone cone = cone_around(rays, pack.range);
    const float values[] = {cone.apex.x, cone.apex.y, cone.apex.z, cone.axis.x, cone.axis.y,
                            cone.axis.z, cone.cosine, cone.sine,   cone.length};
    for (std::size_t c = 0; c < std::size(columns); ++c) (cones[p / pack_size].*columns[c])[p % pack_size] = values[c];
  }
  return cones;
}

void pick(const std::vector<ConeBlock>& cones, const std::uint32_t* indices, std::size_t n,
          std::vector<ConeBlock>& picked) {
  static const ConeBlock empty = untouchable();
  picked.assign((n + pack_size - 1) / pack_size, empty);
  for (std::size_t k = 0; k < n; ++k) {
    const ConeBlock& from = cones[indices[k] / pack_size];
    for (const auto column : columns)
      (picked[k / pack_size].*column)[k % pack_size] = (from.*column)[indices[k] % pack_size];
  }
}

}  // namespace pirsim::rt
