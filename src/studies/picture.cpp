#include "studies/picture.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "pirsim/error.hpp"
#include "sim/compiled_study.hpp"
#include "sim/run_state.hpp"
#include "sim/solids.hpp"

namespace pirsim::studies {
namespace {

struct Extent {
  Vec3 lower{1e9}, upper{-1e9};
};

Extent extent(const TriMesh& mesh) {
  Extent result;
  for (const Vec3& p : mesh.positions) {
    result.lower = glm::min(result.lower, p);
    result.upper = glm::max(result.upper, p);
  }
  return result;
}

struct MeshLook {
  rt::Surface surface;
  rt::Colour colour;
};

/// Tall or high things are walls and ceilings, cut away towards the camera; the rest is furniture.
MeshLook look_of(const TriMesh& mesh, double floor_y) {
  constexpr double wall_height_m = 2.0, floor_thickness_m = 0.05;
  const Extent e = extent(mesh);
  const Vec3 size = e.upper - e.lower;
  const bool is_high = e.lower.y >= floor_y + wall_height_m;
  if (is_high && size.y < std::min(size.x, size.z)) return {rt::Surface::hidden, {0.9F, 0.9F, 0.9F}};
  if (is_high || size.y > wall_height_m) return {rt::Surface::see_through, {0.82F, 0.84F, 0.86F}};
  if (e.upper.y < floor_y + floor_thickness_m) return {rt::Surface::opaque, {0.60F, 0.57F, 0.53F}};
  return {rt::Surface::opaque, {0.55F, 0.36F, 0.20F}};
}

rt::Colour colour_of(body::Part part) {
  switch (part) {
    case body::Part::head:
    case body::Part::left_forearm:
    case body::Part::right_forearm:
      return {0.78F, 0.50F, 0.36F};
    case body::Part::torso:
    case body::Part::left_upper_arm:
    case body::Part::right_upper_arm:
      return {0.10F, 0.28F, 0.52F};
    case body::Part::left_foot:
    case body::Part::right_foot:
      return {0.05F, 0.05F, 0.06F};
    default:
      return {0.14F, 0.15F, 0.20F};
  }
}

/// From above and beside, far enough to hold the whole floor area and a storey of height.
rt::Camera dolls_house_camera(const SceneSpec& scene, double fov_rad, double aspect) {
  const Vec2 lower = scene.floor.lower(), upper = scene.floor.upper();
  const Vec2 middle = 0.5 * (lower + upper);
  const Vec3 target(middle.x, scene.floor.height_m() + 0.6, middle.y);
  const double radius = 0.5 * glm::length(Vec3(upper.x - lower.x, 2.0, upper.y - lower.y));
  const double narrow = std::min(fov_rad, 2.0 * std::atan(std::tan(fov_rad / 2.0) * aspect));
  const Vec3 direction = glm::normalize(Vec3(-0.55, 0.85, -1.0));
  return {target + direction * (0.95 * radius / std::sin(narrow / 2.0)), target, fov_rad};
}

/// A camera that the user has placed.
void require_usable(const rt::Camera& camera) {
  constexpr double farthest_m = 1e5;
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(camera.position[i]) < farthest_m) || !(std::abs(camera.target[i]) < farthest_m)) {
      throw Error(ErrorCode::usage, "--camera and --look-at: expected coordinates in metres");
    }
  }
  if (glm::length(camera.target - camera.position) < 1e-6) {
    throw Error(ErrorCode::usage, "--camera and --look-at: the camera stands in the very point it looks at");
  }
}

}  // namespace

rt::Image picture(const Model& model, const State& state, const PictureSpec& spec) {
  const SceneSpec& scene = model.compiled().scene();
  std::vector<rt::Surface> surfaces;
  std::vector<rt::Colour> colours;
  for (const TriMesh& mesh : scene.meshes) {
    const MeshLook look = look_of(mesh, scene.floor.height_m());
    surfaces.push_back(look.surface);
    colours.push_back(look.colour);
  }
  std::vector<rt::RenderedSolid> solids;
  for (const sim::Actor& actor : state.run_state().crowd.actors()) {
    std::vector<PosedShape> shapes;
    sim::append_solids(actor, shapes);
    for (std::size_t i = 0; i < shapes.size(); ++i)
      solids.push_back({shapes[i], colour_of(static_cast<body::Part>(i))});
  }
  std::vector<rt::Beam> beams;
  constexpr rt::Colour idle{0.10F, 0.45F, 0.75F}, seeing{1.0F, 0.25F, 0.02F};
  for (const std::size_t sensor : spec.beams_of) {
    for (const sim::BeamSegment& beam : sim::beams_of(model, state, sensor)) {
      beams.push_back({beam.from, beam.to, beam.sees_person ? seeing : idle});
    }
  }
  // What sees the person is drawn last, over the rest.
  std::stable_partition(beams.begin(), beams.end(), [&](const rt::Beam& beam) { return beam.colour == idle; });
  const double fov = radians(spec.field_of_view_deg);
  rt::Camera camera = dolls_house_camera(scene, fov, static_cast<double>(spec.width) / spec.height);
  if (spec.camera) camera.position = *spec.camera;
  if (spec.look_at) camera.target = *spec.look_at;
  require_usable(camera);
  return rt::render(model.compiled().array().room(), surfaces, colours, solids, beams, camera, spec.width, spec.height);
}

}  // namespace pirsim::studies
