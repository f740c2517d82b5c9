#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/rt/ray_kernel.hpp"
#include "engine/rt/room_impl.hpp"
#include "engine/rt/tracer.hpp"

// What the slow tracers have in common: they keep where everybody is, and look at all of it at each call.

namespace pirsim::rt {

class AnewTracer : public Tracer {
 public:
  explicit AnewTracer(std::size_t n_rays) : first_(n_rays), now_(n_rays) {}

  void follow(std::span<const Moved> moved, std::vector<FirstHitChange>& changes) final {
    for (const auto& [person, solids, surfaces] : moved) {
      if (people_.size() <= person) people_.resize(person + 1);
      people_[person].assign(solids.begin(), solids.end());
    }
    solids_.clear();
    ids_.clear();
    for (std::size_t person = 0; person < people_.size(); ++person) {
      for (std::size_t i = 0; i < people_[person].size(); ++i) {
        solids_.push_back(people_[person][i]);
        ids_.push_back({static_cast<std::uint16_t>(person), static_cast<std::uint16_t>(i)});
      }
    }
    now_.assign(now_.size(), no_solid);
    find_first(solids_, hits_);
    for (const auto& [ray, solid] : hits_) now_[ray] = ids_[solid];
    changes.clear();
    for (std::uint32_t ray = 0; ray < now_.size(); ++ray) {
      if (now_[ray] != first_[ray]) changes.push_back({ray, first_[ray], now_[ray]});
    }
    std::swap(first_, now_);
  }
  [[nodiscard]] std::vector<SolidId> first_hits() const final { return first_; }

 protected:
  /// A ray, and the index of the solid that it hits before all others and the room.
  struct FirstHit {
    std::uint32_t ray = 0;
    std::uint32_t solid = 0;
  };
  /// One entry a ray that hits a solid within its range; `hits` is overwritten.
  virtual void find_first(std::span<const PosedShape> solids, std::vector<FirstHit>& hits) = 0;

 private:
  std::vector<std::vector<PosedShape>> people_;
  std::vector<PosedShape> solids_;  ///< of all of them
  std::vector<SolidId> ids_;        ///< (n_solids)
  std::vector<FirstHit> hits_;
  std::vector<SolidId> first_, now_;  ///< (n_rays)
};

// One Embree instance per solid, moved with it; each zone asks for any solid before the room and stops at the first, or
// each ray asks for the nearest.
// Embree leaves out the solids that a ray can't hit; whether it does hit one of the rest is decided by
// entry_distance() with the ray as it is in the world (docs/adr/0001-shared-ray-tests.md).

namespace {

/// Columns of the map from the cube [-1, 1]^3 to a box around a solid.
using Transform = std::array<Vec3f, 4>;

/// Room around a solid in which rounding of Embree's transformed rays and boxes gets lost, metres: at coordinates
/// up to a kilometre single precision is good to 6e-5 m.
constexpr float padding = 1e-3F;
constexpr float relative_padding = 1e-4F;

Transform around(const Vec3f& centre, const glm::mat3& axes, const Vec3f& half_extents) noexcept {
  const Vec3f reach = half_extents * (1.0F + relative_padding) + padding;
  return {axes[0] * reach.x, axes[1] * reach.y, axes[2] * reach.z, centre};
}

/// A right-handed frame with the given unit vector as its Y.
glm::mat3 frame_along(const Vec3f& y) noexcept {
  const Vec3f helper = std::abs(y.x) < 0.5F ? Vec3f(1.0F, 0.0F, 0.0F) : Vec3f(0.0F, 0.0F, 1.0F);
  const Vec3f z = glm::normalize(glm::cross(helper, y));
  return {glm::cross(y, z), y, z};
}

Transform cube_transform(const PosedShape& shape) noexcept {
  if (const auto* sphere = std::get_if<PosedSphere>(&shape)) {
    return around(sphere->centre, glm::mat3(1.0F), Vec3f(sphere->radius));
  }
  if (const auto* capsule = std::get_if<PosedCapsule>(&shape)) {
    const Vec3f half_axis = (capsule->b - capsule->a) * 0.5F;
    const float half_length = glm::length(half_axis);
    const glm::mat3 axes = half_length > 0.0F ? frame_along(half_axis / half_length) : glm::mat3(1.0F);
    const Vec3f half_extents(capsule->radius, half_length + capsule->radius, capsule->radius);
    return around((capsule->a + capsule->b) * 0.5F, axes, half_extents);
  }
  const auto* mesh = std::get_if<PosedMesh>(&shape);
  const PosedBox box = mesh != nullptr ? box_around(*mesh) : std::get<PosedBox>(shape);
  return around(box.centre, box.axes, box.half_extents);
}

struct SolidQuery : QueryContext {
  Ray ray;             ///< in the world
  float range = 0.0F;  ///< of the ray, or the nearest distance found so far
  std::span<const PosedShape> solids;
  std::optional<std::uint32_t> nearest;  ///< solid found so far
};

void bound_cube(const RTCBoundsFunctionArguments* arguments) {
  *arguments->bounds_o = {-1.0F, -1.0F, -1.0F, 0.0F, 1.0F, 1.0F, 1.0F, 0.0F};
}

void intersect_solid(const RTCOccludedFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  const auto& query = *static_cast<const SolidQuery*>(arguments->context);
  const PosedShape& solid = query.solids[query.instID[0]];
  if (!entry_distance(query.ray, solid, query.range)) return;
  RTCRayN_tfar(arguments->ray, arguments->N, 0) = -unlimited;  // Embree's sign for "occluded"
}

/// Takes the solid if it is entered before what was found, or as early and of a lower index.
void offer_solid(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  auto& query = *static_cast<SolidQuery*>(arguments->context);
  const std::uint32_t index = query.instID[0];
  const float reach = query.nearest ? std::nextafter(query.range, unlimited) : query.range;
  const auto distance = entry_distance(query.ray, query.solids[index], reach);
  if (!distance || (query.nearest && *distance == query.range && index > *query.nearest)) return;
  query.range = *distance;
  query.nearest = index;
  RTCRayN_tfar(RTCRayHitN_RayN(arguments->rayhit, arguments->N), arguments->N, 0) = *distance;
}

class EmbreeTracer final : public AnewTracer {
 public:
  explicit EmbreeTracer(const TracerSetup& setup)
      : AnewTracer(setup.clipped->rays.size()),
        device_(setup.room->impl().device.get()),
        bundle_(*setup.clipped),
        range_(setup.clipped->range),
        cuts_(setup.cuts),
        cluster_cones_(cluster_cones(bundle_)),
        zone_cones_(zone_cones(bundle_)),
        cube_(make_scene(device_, RTC_SCENE_FLAG_ROBUST)),
        everybody_(make_stage()) {
    const GeometryHandle cube = make_geometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(cube.get(), 1);
    rtcSetGeometryBoundsFunction(cube.get(), bound_cube, nullptr);
    rtcSetGeometryOccludedFunction(cube.get(), intersect_solid);
    rtcSetGeometryIntersectFunction(cube.get(), offer_solid);
    rtcCommitGeometry(cube.get());
    rtcAttachGeometry(cube_.get(), cube.get());
    commit(device_, cube_.get());
    if (cuts_ != nullptr) turn_leaves(rest_steps(cuts_->leaves()));
  }

  void turn_leaves(std::span<const LeafStep> steps) override { cuts_->cut(steps, range_); }

  void add(std::size_t person, std::span<const PosedShape> solids, ZoneSet& zones) override {
    while (people_.size() <= person) people_.push_back(make_stage());
    SolidQuery query;
    prepare(query, solids, people_[person]);
    for (const std::size_t zone : candidates_) {
      if (sees_solid(query, people_[person], zone)) zones.insert(zone);
    }
  }

  void find_first(std::span<const PosedShape> solids, std::vector<FirstHit>& hits) override {
    hits.clear();
    SolidQuery query;
    prepare(query, solids, everybody_);
    for (const std::size_t zone : candidates_) {
      for (std::uint32_t i = bundle_.zone_rays_begin[zone]; i < bundle_.zone_rays_begin[zone + 1]; ++i) {
        if (const auto solid = first_solid(query, i)) hits.push_back({i, *solid});
      }
    }
  }

 private:
  struct Instance {
    GeometryHandle geometry;
    Transform transform{};
    bool is_enabled = false;
  };
  /// A scene of its own for everyone whose solids move by themselves.
  struct Stage {
    SceneHandle scene;
    std::vector<Instance> instances;
  };
  [[nodiscard]] Stage make_stage() const {
    return {make_scene(device_, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC), {}};
  }

  /// Finds the candidates, of which the query can then be asked.
  void prepare(SolidQuery& query, std::span<const PosedShape> solids, Stage& stage) {
    find_candidates(solids);
    if (candidates_.empty()) return;
    move_instances(solids, stage);
    initialise(query);
    query.solids = solids;
  }

  /// Zones that may see a solid; coarse to fine: clusters against all solids at once, against each, zones against each.
  void find_candidates(std::span<const PosedShape> solids) {
    spheres_.clear();
    for (const PosedShape& solid : solids) spheres_.push_back(bounding_sphere(solid));
    candidates_.clear();
    if (spheres_.empty()) return;
    const BoundingSphere all = bounding_sphere(spheres_);
    for (std::size_t cluster = 0; cluster < bundle_.n_clusters(); ++cluster) {
      const ViewCone& cone = cluster_cones_[cluster];
      if (!may_touch_any(cone, {&all, 1}) || !may_touch_any(cone, spheres_)) continue;
      const std::size_t end = bundle_.cluster_zones_begin[cluster + 1];
      for (std::size_t zone = bundle_.cluster_zones_begin[cluster]; zone < end; ++zone) {
        if (may_touch_any(zone_cones_[zone], spheres_)) candidates_.push_back(zone);
      }
    }
  }

  void add_instance(Stage& stage) const {
    Instance instance{make_geometry(device_, RTC_GEOMETRY_TYPE_INSTANCE), {}, false};
    rtcSetGeometryInstancedScene(instance.geometry.get(), cube_.get());
    rtcSetGeometryTimeStepCount(instance.geometry.get(), 1);
    rtcCommitGeometry(instance.geometry.get());
    rtcAttachGeometryByID(stage.scene.get(), instance.geometry.get(),
                          static_cast<unsigned int>(stage.instances.size()));
    rtcDisableGeometry(instance.geometry.get());
    check(device_, "add an instance");
    stage.instances.push_back(std::move(instance));
  }

  /// Instance i follows solid i; instances that are left over are switched off and kept.
  void move_instances(std::span<const PosedShape> solids, Stage& stage) const {
    while (stage.instances.size() < solids.size()) add_instance(stage);
    bool has_changed = false;
    for (std::size_t i = 0; i < stage.instances.size(); ++i) {
      const bool is_wanted = i < solids.size();
      has_changed |= set_enabled(stage.instances[i], is_wanted);
      if (is_wanted) has_changed |= set_transform(stage.instances[i], cube_transform(solids[i]));
    }
    if (has_changed) commit(device_, stage.scene.get());
  }

  static bool set_enabled(Instance& instance, bool is_wanted) noexcept {
    if (instance.is_enabled == is_wanted) return false;
    instance.is_enabled = is_wanted;
    is_wanted ? rtcEnableGeometry(instance.geometry.get()) : rtcDisableGeometry(instance.geometry.get());
    return true;
  }

  static bool set_transform(Instance& instance, const Transform& transform) noexcept {
    if (instance.transform == transform) return false;
    instance.transform = transform;
    rtcSetGeometryTransform(instance.geometry.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, transform.data());
    rtcCommitGeometry(instance.geometry.get());
    return true;
  }

  [[nodiscard]] bool sees_solid(SolidQuery& query, const Stage& stage, std::size_t zone) const noexcept {
    for (std::uint32_t i = bundle_.zone_rays_begin[zone]; i < bundle_.zone_rays_begin[zone + 1]; ++i) {
      query.ray = bundle_.rays[i];
      query.range = range_[i];
      RTCRay ray = embree_ray(query.ray, query.range);
      any_hit(stage.scene.get(), query, ray);
      if (ray.tfar < 0.0F) return true;
    }
    return false;
  }

  [[nodiscard]] std::optional<std::uint32_t> first_solid(SolidQuery& query, std::uint32_t ray) const noexcept {
    query.ray = bundle_.rays[ray];
    query.range = range_[ray];
    query.nearest.reset();
    RTCRayHit nearest = embree_ray_hit(query.ray, query.range);
    closest_hit(everybody_.scene.get(), query, nearest);
    return query.nearest;
  }

  RTCDevice device_;
  const RayBundle& bundle_;
  std::vector<float> range_;             ///< (n_rays) cut at leaves as well
  const LeafCuts* cuts_;                 ///< null: there are no doors
  std::vector<ViewCone> cluster_cones_;  ///< (n_clusters)
  std::vector<ViewCone> zone_cones_;     ///< (n_zones)
  SceneHandle cube_;                     ///< the one primitive that every instance shows: a cube around its solid
  Stage everybody_;                      ///< of find_first(), which knows no people
  std::vector<Stage> people_;
  std::vector<BoundingSphere> spheres_;  ///< (n_solids)
  std::vector<std::size_t> candidates_;
};

}  // namespace

std::unique_ptr<Tracer> make_embree_tracer(const TracerSetup& setup) { return std::make_unique<EmbreeTracer>(setup); }

// The plain way, which the others are measured against: at each look a new scene of all triangles and all solids,
// and for every ray the nearest hit within the rated range. No ray is cut at the room, no zone is left early.

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

std::string_view name(TracerKind kind) noexcept {
  switch (kind) {
    case TracerKind::reference:
      return "reference";
    case TracerKind::embree:
      return "embree";
    case TracerKind::direct:
      return "direct";
  }
  return "unknown";
}

std::string_view direct_instruction_set() noexcept { return best_ray_kernel().name; }

std::unique_ptr<Tracer> make_tracer(TracerKind kind, const TracerSetup& setup) {
  assert(setup.room != nullptr && setup.rated != nullptr && setup.clipped != nullptr);
  switch (kind) {
    case TracerKind::reference:
      return make_reference_tracer(setup);
    case TracerKind::embree:
      return make_embree_tracer(setup);
    case TracerKind::direct:
      break;
  }
  return make_direct_tracer(setup);
}

}  // namespace pirsim::rt
