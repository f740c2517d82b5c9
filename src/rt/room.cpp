#include "pirsim/rt/room.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "pirsim/core/error.hpp"
#include "rt/room_impl.hpp"

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

template <typename Element>
void fill_buffer(RTCDevice device, RTCGeometry geometry, RTCBufferType type, RTCFormat format,
                 const std::vector<Element>& elements) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Element), elements.size());
  check(device, "store a mesh");
  std::copy(elements.begin(), elements.end(), static_cast<Element*>(buffer));
}

}  // namespace

void Room::Impl::attach_to(RTCScene target) const {
  for (std::uint32_t i = 0; i < n_meshes(); ++i) {
    if (meshes[i].triangles.empty()) continue;
    const GeometryHandle geometry = make_geometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    fill_buffer(device.get(), geometry.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, meshes[i].positions);
    fill_buffer(device.get(), geometry.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, meshes[i].triangles);
    rtcSetGeometryBuildQuality(geometry.get(), RTC_BUILD_QUALITY_MEDIUM);
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

std::optional<RoomHit> Room::first_hit(const Ray& ray, float t_max) const noexcept {
  QueryContext context;
  initialise(context);
  RTCRayHit query = embree_ray_hit(ray, t_max);
  closest_hit(impl_->scene.get(), context, query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID || !(query.ray.tfar < t_max)) return std::nullopt;
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
