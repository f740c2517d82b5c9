#include "sim/reflections.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

namespace pirsim::sim {
namespace {

struct Continuation {
  Ray ray;
  float range = 0.0F;
};

std::optional<Continuation> mirrored(const Ray& ray, float range, const rt::Room& room,
                                     std::span<const double> coefficients) {
  const auto hit = room.first_hit(ray, range);
  if (!hit || coefficients[hit->mesh] <= 0.0) return std::nullopt;
  const float left = range * static_cast<float>(std::sqrt(coefficients[hit->mesh])) - hit->distance;
  constexpr float shortest_m = 0.01F, off_the_wall_m = 1e-3F;  // so that the ray doesn't meet the wall it comes from
  if (left <= shortest_m) return std::nullopt;
  const Vec3f at = ray.origin + hit->distance * ray.direction + off_the_wall_m * hit->normal;
  return Continuation{{at, glm::normalize(glm::reflect(ray.direction, hit->normal))}, left};
}

}  // namespace

void add_reflections(RayBundle& bundle, const rt::Room& room, std::span<const TriMesh> meshes,
                     std::span<const ReflectionSpec> reflections) {
  if (reflections.empty()) return;
  std::vector<double> coefficients;  // (n_meshes)
  for (const TriMesh& mesh : meshes) {
    const auto glossy = std::ranges::find(reflections, mesh.name, &ReflectionSpec::mesh);
    coefficients.push_back(glossy == reflections.end() ? 0.0 : glossy->coefficient);
  }
  RayBundle result;
  result.cluster_zones_begin = bundle.cluster_zones_begin;
  result.sensor_clusters_begin = bundle.sensor_clusters_begin;
  for (std::size_t zone = 0; zone < bundle.n_zones(); ++zone) {
    const std::size_t begin = bundle.zone_rays_begin[zone], end = bundle.zone_rays_begin[zone + 1];
    for (std::size_t i = begin; i < end; ++i) {
      result.rays.push_back(bundle.rays[i]);
      result.range.push_back(bundle.range[i]);
    }
    for (std::size_t i = begin; i < end; ++i) {
      const auto ghost = mirrored(bundle.rays[i], bundle.range[i], room, coefficients);
      if (!ghost) continue;
      result.rays.push_back(ghost->ray);
      result.range.push_back(ghost->range);
    }
    result.zone_rays_begin.push_back(static_cast<std::uint32_t>(result.rays.size()));
  }
  bundle = std::move(result);
}

}  // namespace pirsim::sim
