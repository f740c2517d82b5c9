#include "engine/rt/room.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "engine/rt/room_impl.hpp"
#include "model/geom/shapes.hpp"
#include "pirsim/error.hpp"

namespace pirsim::rt {
namespace {

RoomMesh in_single_precision(const TriMesh& mesh) {
  RoomMesh result;
  result.positions.assign(mesh.positions.begin(), mesh.positions.end());
  result.triangles = mesh.triangles;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) {
      if (index < mesh.positions.size()) continue;
      throw Error(ErrorCode::internal, "mesh '" + mesh.name + "' has " + std::to_string(mesh.positions.size()) +
                                           " vertices but a triangle asks for vertex " + std::to_string(index));
    }
  }
  return result;
}

std::array<Vec3f, 3> corners(const RoomMesh& mesh, unsigned int triangle) noexcept {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
}

void bound_triangle(const RTCBoundsFunctionArguments* arguments) {
  constexpr float padding = 1e-4F;  // metres; far more than Embree's rounding
  const auto [a, b, c] = corners(*static_cast<const RoomMesh*>(arguments->geometryUserPtr), arguments->primID);
  const Vec3f lower = glm::min(glm::min(a, b), c) - padding, upper = glm::max(glm::max(a, b), c) + padding;
  *arguments->bounds_o = {lower.x, lower.y, lower.z, 0.0F, upper.x, upper.y, upper.z, 0.0F};
}

void intersect_triangle(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  const auto [a, b, c] = corners(*static_cast<const RoomMesh*>(arguments->geometryUserPtr), arguments->primID);
  const float distance = distance_to_triangle(ray_of(*arguments), a, b, c);
  offer_hit(*arguments, distance, glm::cross(b - a, c - a));
}

void shade_triangle(const RTCOccludedFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  const auto [a, b, c] = corners(*static_cast<const RoomMesh*>(arguments->geometryUserPtr), arguments->primID);
  const RTCRay query = rtcGetRayFromRayN(arguments->ray, arguments->N, 0);
  const float distance = distance_to_triangle(pirsim_ray(query), a, b, c);
  if (distance >= query.tnear && distance < query.tfar) RTCRayN_tfar(arguments->ray, arguments->N, 0) = -unlimited;
}

}  // namespace

Ray ray_of(const RTCIntersectFunctionNArguments& arguments) noexcept {
  return pirsim_ray(rtcGetRayFromRayN(RTCRayHitN_RayN(arguments.rayhit, arguments.N), arguments.N, 0));
}

void offer_hit(const RTCIntersectFunctionNArguments& arguments, float distance, const Vec3f& normal) noexcept {
  RTCRayN* ray = RTCRayHitN_RayN(arguments.rayhit, arguments.N);
  RTCHitN* hit = RTCRayHitN_HitN(arguments.rayhit, arguments.N);
  const unsigned int n = arguments.N;
  const float reach = RTCRayN_tfar(ray, n, 0);
  const bool has_hit = RTCHitN_geomID(hit, n, 0) != RTC_INVALID_GEOMETRY_ID;
  const bool is_lower =
      std::pair(arguments.geomID, arguments.primID) < std::pair(RTCHitN_geomID(hit, n, 0), RTCHitN_primID(hit, n, 0));
  const bool is_nearer = distance < reach || (distance == reach && has_hit && is_lower);
  if (!is_nearer || distance < RTCRayN_tnear(ray, n, 0)) return;
  RTCRayN_tfar(ray, n, 0) = distance;
  RTCHitN_Ng_x(hit, n, 0) = normal.x;
  RTCHitN_Ng_y(hit, n, 0) = normal.y;
  RTCHitN_Ng_z(hit, n, 0) = normal.z;
  RTCHitN_geomID(hit, n, 0) = arguments.geomID;
  RTCHitN_primID(hit, n, 0) = arguments.primID;
}

void Room::Impl::attach_to(RTCScene target) const {
  for (std::uint32_t i = 0; i < n_meshes(); ++i) {
    const GeometryHandle geometry = make_geometry(device.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned int>(meshes[i].triangles.size()));
    rtcSetGeometryUserData(geometry.get(), const_cast<RoomMesh*>(&meshes[i]));
    rtcSetGeometryBoundsFunction(geometry.get(), bound_triangle, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), intersect_triangle);
    rtcSetGeometryOccludedFunction(geometry.get(), shade_triangle);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(target, geometry.get(), i);
    check(device.get(), "attach a mesh");
  }
}

Room::Room(std::span<const TriMesh> meshes) : impl_(std::make_unique<Impl>()) {
  impl_->device = make_device();
  impl_->meshes.reserve(meshes.size());
  for (const TriMesh& mesh : meshes) impl_->meshes.push_back(in_single_precision(mesh));
  impl_->scene = make_scene(impl_->device.get(), room_scene_flags);
  impl_->attach_to(impl_->scene.get());
  commit(impl_->device.get(), impl_->scene.get());
}

Room::~Room() = default;
Room::Room(Room&&) noexcept = default;
Room& Room::operator=(Room&&) noexcept = default;

std::size_t Room::n_meshes() const noexcept { return impl_->meshes.size(); }

std::optional<RoomHit> Room::first_hit(const Ray& ray, float t_max) const noexcept {
  QueryContext context;
  initialise(context);
  RTCRayHit query = embree_ray_hit(ray, t_max);
  closest_hit(impl_->scene.get(), context, query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const Vec3f normal = glm::normalize(Vec3f(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z));
  const bool faces_origin = glm::dot(normal, ray.direction) <= 0.0F;
  return RoomHit{query.ray.tfar, faces_origin ? normal : -normal, query.hit.geomID};
}

void Room::clip(RayBundle& bundle) const noexcept {
  for (std::size_t i = 0; i < bundle.rays.size(); ++i) {
    if (const auto hit = first_hit(bundle.rays[i], bundle.range[i])) bundle.range[i] = hit->distance;
  }
}

}  // namespace pirsim::rt
