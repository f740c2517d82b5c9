// Seeded draws for geometry tests, and signed distances in double precision to compare ray tests with.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "model/geom/shapes.hpp"
#include "pirsim/random.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim::testing {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : stream_({seed, 0, 0, Purpose::test}) {}
  double between(double low, double high) { return low + (high - low) * stream_.uniform(); }
  std::uint32_t index(std::uint32_t n) { return stream_.index(n); }
  Vec3 inside(const Vec3& low, const Vec3& high) {
    const double x = between(low.x, high.x), y = between(low.y, high.y), z = between(low.z, high.z);
    return {x, y, z};
  }
  Vec3 direction() {
    const double x = stream_.normal(), y = stream_.normal(), z = stream_.normal();
    return glm::normalize(Vec3(x, y, z));
  }
  Quat rotation() {
    const double w = stream_.normal(), x = stream_.normal(), y = stream_.normal(), z = stream_.normal();
    return glm::normalize(Quat(w, x, y, z));
  }
  /// A solid of a limb's to a torso's size.
  Shape shape() {
    const std::uint32_t kind = index(3);
    const double a = between(0.03, 0.15), b = between(0.0, 0.4), c = between(0.05, 0.3);
    if (kind == 0) return Sphere{a};
    if (kind == 1) return Capsule{a, b};
    return Box{Vec3(a, b + 0.01, c)};
  }

 private:
  Stream stream_;
};

inline Ray ray_through(const Vec3& from, const Vec3& to) { return {Vec3f(from), Vec3f(glm::normalize(to - from))}; }

// Euclidean distance to the surface, negative inside. Convex along any line, since the solids are convex.
inline double signed_distance(const PosedSphere& s, const Vec3& p) {
  return glm::length(p - Vec3(s.centre)) - s.radius;
}
inline double signed_distance(const PosedCapsule& c, const Vec3& p) {
  const Vec3 a(c.a), along = Vec3(c.b) - a;
  const double square = glm::dot(along, along);
  const double share = square > 0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0.0;
  return glm::length(p - a - share * along) - c.radius;
}
inline double signed_distance(const PosedBox& b, const Vec3& p) {
  const glm::dmat3 axes(b.axes);
  const Vec3 q = glm::abs(glm::transpose(axes) * (p - Vec3(b.centre))) - Vec3(b.half_extents);
  return glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}
/// Of a closed, convex mesh, outside from its faces' planes only: at most the distance to it, negative inside.
inline double signed_distance(const PosedMesh& m, const Vec3& p) {
  const Vec3 local = glm::transpose(glm::dmat3(m.axes)) * (p - Vec3(m.origin));
  const TriMesh& mesh = m.surface->mesh();
  double distance = -1e30;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 &corner = mesh.positions[a], facing = glm::cross(mesh.positions[b] - corner, mesh.positions[c] - corner);
    distance = std::max(distance, glm::dot(glm::normalize(facing), local - corner));
  }
  return distance;
}
inline double signed_distance(const PosedShape& shape, const Vec3& p) {
  return std::visit([&](const auto& solid) { return signed_distance(solid, p); }, shape);
}

/// What a ray hits, by search on the signed distance in double precision.
struct SearchedHit {
  double depth = 0.0;  ///< least signed distance on the ray within [0, t_end]; a hit if <= 0
  double entry = 0.0;  ///< metres; meaningful for a hit
};
inline SearchedHit search(const Ray& ray, const PosedShape& shape, double t_end) {
  const auto distance_at = [&](double t) { return signed_distance(shape, Vec3(ray.origin) + t * Vec3(ray.direction)); };
  double low = 0.0, high = t_end;
  for (int i = 0; i < 90; ++i) {  // 2/3 each: far below a nanometre
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (distance_at(a) < distance_at(b) ? high : low) = distance_at(a) < distance_at(b) ? b : a;
  }
  const double deepest = 0.5 * (low + high);
  SearchedHit hit{std::min({distance_at(deepest), distance_at(0.0), distance_at(t_end)}), 0.0};
  if (hit.depth > 0 || distance_at(0.0) <= 0) return hit;
  double outside = 0.0, inside = distance_at(deepest) <= 0 ? deepest : t_end;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (outside + inside);
    (distance_at(middle) <= 0 ? inside : outside) = middle;
  }
  hit.entry = inside;
  return hit;
}

// The world seen in the mirror x -> -x. A solid's own axes are mirrored too, so that they stay right-handed.
inline Vec3f mirrored(const Vec3f& v) { return {-v.x, v.y, v.z}; }
inline Vec3 mirrored(const Vec3& v) { return {-v.x, v.y, v.z}; }
inline Ray mirrored(const Ray& r) { return {mirrored(r.origin), mirrored(r.direction)}; }
inline Frame mirrored(const Frame& f) {
  return {Quat(f.rotation.w, f.rotation.x, -f.rotation.y, -f.rotation.z), mirrored(f.origin)};
}

}  // namespace pirsim::testing
