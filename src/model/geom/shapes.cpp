#include "model/geom/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "model/geom/ray_tests.hpp"
#include "pirsim/error.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim {
namespace {

using Vector = ray_tests::Vector<float>;
using Interval = ray_tests::Interval<float>;

template <typename... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <typename... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

Vector vector(const Vec3f& v) noexcept { return {v.x, v.y, v.z}; }

std::optional<float> entry_of(const Interval& inside, float t_max) noexcept {
  if (!ray_tests::is_hit(inside, t_max)) return std::nullopt;
  return ray_tests::entry(inside);
}

/// Point of the segment nearest to `point`.
Vec3f nearest_on_segment(const PosedCapsule& capsule, const Vec3f& point) noexcept {
  const Vec3f along = capsule.b - capsule.a;
  const float square = glm::dot(along, along);
  const float share = square > 0.0F ? glm::dot(point - capsule.a, along) / square : 0.0F;
  return capsule.a + along * std::clamp(share, 0.0F, 1.0F);
}

/// `direction` scaled to unit length; straight up where it has none.
Vec3f unit_or_up(const Vec3f& direction) noexcept {
  const float length = glm::length(direction);
  return length > 0.0F ? direction / length : Vec3f(0.0F, 1.0F, 0.0F);
}

/// The face whose plane the point is nearest to, from inside or outside.
Vec3f box_normal(const PosedBox& box, const Vec3f& point) noexcept {
  const Vec3f offset = point - box.centre;
  int face = 0;
  float greatest = -std::numeric_limits<float>::infinity();
  float side = 1.0F;
  for (int i = 0; i < 3; ++i) {
    const float along = glm::dot(offset, box.axes[i]);
    const float beyond = std::abs(along) - box.half_extents[i];
    if (beyond > greatest) {
      greatest = beyond;
      face = i;
      side = along < 0.0F ? -1.0F : 1.0F;
    }
  }
  return box.axes[face] * side;
}

Bounds bounds_of_box(const PosedBox& box) noexcept {
  const Vec3f reach = glm::abs(box.axes[0]) * box.half_extents.x + glm::abs(box.axes[1]) * box.half_extents.y +
                      glm::abs(box.axes[2]) * box.half_extents.z;
  return {box.centre - reach, box.centre + reach};
}

glm::mat3 axes_of(const Quat& rotation) {
  return {Vec3f(rotation * Vec3(1, 0, 0)), Vec3f(rotation * Vec3(0, 1, 0)), Vec3f(rotation * Vec3(0, 0, 1))};
}

/// Components along a mesh's axes: from the world to the mesh's frame, in double precision. The direction's length is
/// kept as it is, so that distances stay metres along the ray in the world.
Vec3 in_frame_of(const PosedMesh& mesh, const Vec3& v) noexcept {
  return {glm::dot(v, Vec3(mesh.axes[0])), glm::dot(v, Vec3(mesh.axes[1])), glm::dot(v, Vec3(mesh.axes[2]))};
}

}  // namespace

PosedShape place(const Shape& shape, const Frame& world_from_shape) {
  const Frame& frame = world_from_shape;
  return std::visit(Overloaded{[&](const Sphere& s) -> PosedShape {
                                 return PosedSphere{Vec3f(frame.origin), static_cast<float>(s.radius)};
                               },
                               [&](const Capsule& c) -> PosedShape {
                                 const Vec3 half_axis = frame.rotation * Vec3(0.0, c.half_length, 0.0);
                                 return PosedCapsule{Vec3f(frame.origin - half_axis), Vec3f(frame.origin + half_axis),
                                                     static_cast<float>(c.radius)};
                               },
                               [&](const Box& b) -> PosedShape {
                                 return PosedBox{Vec3f(frame.origin), axes_of(frame.rotation), Vec3f(b.half_extents)};
                               },
                               [&](const MeshSolid& m) -> PosedShape {
                                 return PosedMesh{m.surface.get(), Vec3f(frame.origin), axes_of(frame.rotation)};
                               }},
                    shape);
}

PosedBox box_around(const PosedMesh& mesh) noexcept {
  const Vec3f centre(0.5 * (mesh.surface->lower() + mesh.surface->upper()));
  const Vec3f half_extents(0.5 * (mesh.surface->upper() - mesh.surface->lower()));
  return {mesh.origin + mesh.axes * centre, mesh.axes, half_extents};
}

Bounds bounds(const PosedShape& shape) noexcept {
  return std::visit(Overloaded{[](const PosedSphere& s) {
                                 return Bounds{s.centre - s.radius, s.centre + s.radius};
                               },
                               [](const PosedCapsule& c) {
                                 return Bounds{glm::min(c.a, c.b) - c.radius, glm::max(c.a, c.b) + c.radius};
                               },
                               [](const PosedBox& b) { return bounds_of_box(b); },
                               [](const PosedMesh& m) { return bounds_of_box(box_around(m)); }},
                    shape);
}

std::optional<float> entry_distance(const Ray& ray, const PosedSphere& sphere, float t_max) noexcept {
  return entry_of(ray_tests::sphere(vector(ray.origin), vector(ray.direction), vector(sphere.centre), sphere.radius),
                  t_max);
}

std::optional<float> entry_distance(const Ray& ray, const PosedCapsule& capsule, float t_max) noexcept {
  const auto axis = ray_tests::capsule_axis(vector(capsule.a), vector(capsule.b));
  return entry_of(ray_tests::capsule(vector(ray.origin), vector(ray.direction), axis, capsule.radius), t_max);
}

std::optional<float> entry_distance(const Ray& ray, const PosedBox& box, float t_max) noexcept {
  const std::array<Vector, 3> axes{vector(box.axes[0]), vector(box.axes[1]), vector(box.axes[2])};
  return entry_of(
      ray_tests::box(vector(ray.origin), vector(ray.direction), vector(box.centre), axes, vector(box.half_extents)),
      t_max);
}

std::optional<float> entry_distance(const Ray& ray, const PosedMesh& mesh, float t_max) noexcept {
  const Vec3 origin = in_frame_of(mesh, Vec3(ray.origin) - Vec3(mesh.origin));
  return mesh.surface->first_hit(origin, in_frame_of(mesh, Vec3(ray.direction)), t_max);
}

std::optional<float> entry_distance(const Ray& ray, const PosedShape& shape, float t_max) noexcept {
  return std::visit([&](const auto& solid) { return entry_distance(ray, solid, t_max); }, shape);
}

Vec3f surface_normal(const PosedShape& shape, const Vec3f& point) noexcept {
  return std::visit(Overloaded{[&](const PosedSphere& s) { return unit_or_up(point - s.centre); },
                               [&](const PosedCapsule& c) { return unit_or_up(point - nearest_on_segment(c, point)); },
                               [&](const PosedBox& b) { return box_normal(b, point); },
                               [&](const PosedMesh& m) {
                                 const Vec3 local = in_frame_of(m, Vec3(point) - Vec3(m.origin));
                                 return unit_or_up(m.axes * Vec3f(m.surface->normal_near(local)));
                               }},
                    shape);
}

namespace {

/// Metres by which spheres are larger than what they hold: a thousand times what triangles reach over their edges and
/// what rounding takes, at the size of a body.
constexpr double padding = 1e-6;

/// The point of a triangle nearest to `p`. Ref: [Ericson2005], section 5.1.5.
Vec3 nearest_point(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  const Vec3 ab = b - a, ac = c - a;
  const double d1 = glm::dot(ab, p - a), d2 = glm::dot(ac, p - a);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const double d3 = glm::dot(ab, p - b), d4 = glm::dot(ac, p - b);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + ab * (d1 / (d1 - d3));
  const double d5 = glm::dot(ab, p - c), d6 = glm::dot(ac, p - c);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  return a + ab * (vb / (va + vb + vc)) + ac * (vc / (va + vb + vc));
}

}  // namespace

TriangleSurface::TriangleSurface(TriMesh mesh) : mesh_(std::move(mesh)) {
  check();
  lower_ = upper_ = corners(0).a;
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    const auto [a, b, c] = corners(i);
    lower_ = glm::min(lower_, glm::min(a, glm::min(b, c)));
    upper_ = glm::max(upper_, glm::max(a, glm::max(b, c)));
  }
  grow(0, mesh_.triangles.size());
}

void TriangleSurface::check() const {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::usage, "mesh '" + mesh_.name + "' " + why);
  };
  if (mesh_.triangles.empty()) refuse("has no triangles");
  for (const Vec3& p : mesh_.positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) refuse("has a vertex that isn't finite");
  }
  for (const auto& triangle : mesh_.triangles) {
    for (const std::uint32_t index : triangle) {
      if (index >= mesh_.positions.size()) refuse("has a triangle with a vertex that doesn't exist");
    }
  }
}

TriangleSurface::Corners TriangleSurface::corners(std::size_t triangle) const noexcept {
  const auto& [a, b, c] = mesh_.triangles[triangle];
  return {mesh_.positions[a], mesh_.positions[b], mesh_.positions[c]};
}

TriangleSurface::BoundingSphere TriangleSurface::bounding_sphere(std::size_t begin, std::size_t end) const noexcept {
  Vec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
  double square = 0.0;
  const auto for_each_corner = [&](const auto& function) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto [a, b, c] = corners(i);
      for (const Vec3& p : {a, b, c}) function(p);
    }
  };
  for_each_corner([&](const Vec3& p) { lower = glm::min(lower, p), upper = glm::max(upper, p); });
  const Vec3 centre = 0.5 * (lower + upper);
  for_each_corner([&](const Vec3& p) { square = std::max(square, glm::dot(p - centre, p - centre)); });
  return {centre, std::sqrt(square) + padding, begin, end, 0};
}

void TriangleSurface::grow(std::size_t begin, std::size_t end) {
  const std::size_t node = spheres_.size();
  spheres_.push_back(bounding_sphere(begin, end));
  if (!spheres_[node].is_leaf()) {
    Vec3 sum(0.0), sum_of_squares(0.0);
    const auto middle_of = [&](const auto& t) {
      return (mesh_.positions[t[0]] + mesh_.positions[t[1]] + mesh_.positions[t[2]]) / 3.0;
    };
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 middle = middle_of(mesh_.triangles[i]) - spheres_[node].centre;
      sum += middle, sum_of_squares += middle * middle;
    }
    const Vec3 spread = sum_of_squares - sum * sum / static_cast<double>(end - begin);
    const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
    const auto at = [&](std::size_t i) { return mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(i); };
    std::stable_sort(at(begin), at(end),
                     [&](const auto& s, const auto& t) { return middle_of(s)[axis] < middle_of(t)[axis]; });
    const std::size_t half = begin + (end - begin) / 2;
    grow(begin, half);
    grow(half, end);
  }
  spheres_[node].next = spheres_.size();
}

template <typename MayConcern, typename LookAt>
void TriangleSurface::visit(const MayConcern& may_concern, const LookAt& look_at) const noexcept {
  for (std::size_t node = 0; node < spheres_.size();) {
    const BoundingSphere& sphere = spheres_[node];
    if (!may_concern(sphere)) {
      node = sphere.next;
      continue;
    }
    for (std::size_t i = sphere.begin; sphere.is_leaf() && i < sphere.end; ++i) look_at(corners(i));
    ++node;
  }
}

std::optional<float> TriangleSurface::first_hit(const Vec3& origin, const Vec3& direction, float t_max) const noexcept {
  if (!(t_max > 0.0F)) return std::nullopt;
  float nearest = t_max;
  const double square_length = glm::dot(direction, direction);
  const auto may_hit = [&](const BoundingSphere& sphere) {
    const Vec3 offset = sphere.centre - origin;
    const double along = std::clamp(glm::dot(offset, direction) / square_length, 0.0, static_cast<double>(nearest));
    const Vec3 miss = offset - direction * along;
    return glm::dot(miss, miss) <= sphere.radius * sphere.radius;
  };
  visit(may_hit, [&](const Corners& triangle) {
    const float distance = distance_to_triangle(origin, direction, triangle.a, triangle.b, triangle.c);
    if (distance >= 0.0F && distance < nearest) nearest = distance;
  });
  return nearest < t_max ? std::optional(nearest) : std::nullopt;
}

Vec3 TriangleSurface::normal_near(const Vec3& point) const noexcept {
  double nearest = std::numeric_limits<double>::infinity();
  Vec3 normal(0.0, 1.0, 0.0);
  const auto may_be_nearer = [&](const BoundingSphere& sphere) {
    return glm::distance(point, sphere.centre) - sphere.radius < nearest;
  };
  visit(may_be_nearer, [&](const Corners& triangle) {
    const Vec3 facing = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
    const double distance = glm::distance(point, nearest_point(point, triangle.a, triangle.b, triangle.c));
    if (!(distance < nearest) || facing == Vec3(0.0)) return;
    nearest = distance;
    normal = glm::normalize(facing);
  });
  return normal;
}

}  // namespace pirsim
