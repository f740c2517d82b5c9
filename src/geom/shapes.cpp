#include "pirsim/shapes.hpp"

#include <algorithm>
#include <array>

#include "geom/ray_tests.hpp"
#include "geom/triangle_surface.hpp"

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

}  // namespace pirsim
