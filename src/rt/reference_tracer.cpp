// The plain way, which the others are measured against: at each look a new scene of all triangles and all solids,
// and for every ray the nearest hit within the rated range. No ray is cut at the room, no zone is left early.
#include <algorithm>
#include <optional>
#include <vector>

#include "rt/anew_tracer.hpp"
#include "rt/room_impl.hpp"

namespace pirsim::rt {
namespace {

void bound_solid(const RTCBoundsFunctionArguments* arguments) {
  constexpr float slack = 1e-3F;  // metres; far more than the ray tests' rounding
  const auto [lower, upper] = bounds(*static_cast<const PosedShape*>(arguments->geometryUserPtr));
  *arguments->bounds_o = {lower.x - slack, lower.y - slack, lower.z - slack, 0.0F,
                          upper.x + slack, upper.y + slack, upper.z + slack, 0.0F};
}

void intersect_solid(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  const auto& solid = *static_cast<const PosedShape*>(arguments->geometryUserPtr);
  if (const auto distance = entry_distance(ray_of(*arguments), solid, unlimited)) {
    offer_hit(*arguments, *distance, Vec3f(0.0F));
  }
}

class ReferenceTracer final : public AnewTracer {
 public:
  explicit ReferenceTracer(const TracerSetup& setup)
      : AnewTracer(setup.rated->rays.size()), room_(setup.room->impl()), rated_(*setup.rated), cuts_(setup.cuts) {
    if (cuts_ != nullptr) turn_leaves(rest_steps(cuts_->leaves()));
  }

  void turn_leaves(std::span<const LeafStep> steps) override {
    leaves_.clear();
    for (std::size_t i = 0; i < steps.size(); ++i) leaves_.emplace_back(cuts_->leaves()[i].at(steps[i]));
  }

  void add(std::size_t, std::span<const PosedShape> solids, ZoneSet& zones) override {
    const SceneHandle scene = build(solids);
    for (std::size_t zone = 0; zone < rated_.n_zones(); ++zone) {
      for (std::uint32_t i = rated_.zone_rays_begin[zone]; i < rated_.zone_rays_begin[zone + 1]; ++i) {
        if (first_solid(scene.get(), i)) zones.insert(zone);
      }
    }
  }

  void find_first(std::span<const PosedShape> solids, std::vector<FirstHit>& hits) override {
    const SceneHandle scene = build(solids);
    hits.clear();
    for (std::uint32_t i = 0; i < rated_.rays.size(); ++i) {
      if (const auto solid = first_solid(scene.get(), i)) hits.push_back({i, *solid});
    }
  }

 private:
  [[nodiscard]] SceneHandle build(std::span<const PosedShape> solids) const {
    RTCDevice device = room_.device.get();
    SceneHandle scene = make_scene(device, room_scene_flags);
    room_.attach_to(scene.get());
    attach(leaves_, room_.n_meshes(), scene.get());
    attach(solids, n_before_solids(), scene.get());
    check(device, "attach a solid");
    commit(device, scene.get());
    return scene;
  }
  void attach(std::span<const PosedShape> solids, std::uint32_t first_id, RTCScene scene) const {
    for (std::uint32_t i = 0; i < solids.size(); ++i) {
      const GeometryHandle geometry = make_geometry(room_.device.get(), RTC_GEOMETRY_TYPE_USER);
      rtcSetGeometryUserPrimitiveCount(geometry.get(), 1);
      rtcSetGeometryUserData(geometry.get(), const_cast<PosedShape*>(&solids[i]));
      rtcSetGeometryBoundsFunction(geometry.get(), bound_solid, nullptr);
      rtcSetGeometryIntersectFunction(geometry.get(), intersect_solid);
      rtcCommitGeometry(geometry.get());
      rtcAttachGeometryByID(scene, geometry.get(), first_id + i);
    }
  }
  /// Meshes, and leaves, which come after them: a solid that begins where a leaf does is hidden.
  [[nodiscard]] std::uint32_t n_before_solids() const noexcept {
    return room_.n_meshes() + static_cast<std::uint32_t>(leaves_.size());
  }

  /// What the ray hits first, if that is a solid.
  [[nodiscard]] std::optional<std::uint32_t> first_solid(RTCScene scene, std::uint32_t ray) const noexcept {
    QueryContext context;
    initialise(context);
    RTCRayHit nearest = embree_ray_hit(rated_.rays[ray], rated_.range[ray]);
    closest_hit(scene, context, nearest);
    const bool is_solid = nearest.hit.geomID != RTC_INVALID_GEOMETRY_ID && nearest.hit.geomID >= n_before_solids();
    return is_solid ? std::optional(nearest.hit.geomID - n_before_solids()) : std::nullopt;
  }

  const Room::Impl& room_;
  const RayBundle& rated_;
  const LeafCuts* cuts_;  ///< null: there are no doors
  std::vector<PosedShape> leaves_;
};

}  // namespace

std::unique_ptr<Tracer> make_reference_tracer(const TracerSetup& setup) {
  return std::make_unique<ReferenceTracer>(setup);
}

}  // namespace pirsim::rt
