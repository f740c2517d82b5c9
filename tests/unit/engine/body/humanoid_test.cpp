#include "engine/body/skeleton.hpp"

#include "pirsim/shapes.hpp"
#include "support/body_checks.hpp"
#include "support/fine_mesh.hpp"

using namespace pirsim;
using namespace pirsim::body;
using namespace pirsim::body::test;

namespace {

Humanoid person(double stature_m, double mass_kg) {
  PersonSpec spec;
  spec.stature_m = stature_m;
  spec.mass_kg = mass_kg;
  return Humanoid(spec);
}

/// A point of the solid on the segment between two joints, or inside a box or sphere.
double distance_to_axis(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
  return glm::distance(p, a + t * (b - a));
}

/// Smallest signed distance (negative inside) from a point to the solid's surface; boxes by their slabs.
double signed_distance(const Vec3& world_point, const Shape& shape, const Frame& frame) {
  const Vec3 p = inverse(frame) * world_point;
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return glm::length(p) - sphere->radius;
  if (const auto* c = std::get_if<Capsule>(&shape)) {
    return distance_to_axis(p, {0, c->half_length, 0}, {0, -c->half_length, 0}) - c->radius;
  }
  const Vec3 q = glm::abs(p) - std::get<Box>(shape).half_extents;
  return std::max({q.x, q.y, q.z});
}

}  // namespace

TEST_CASE("the parts are one sphere, three boxes and nine capsules, as the paper says", "[motion]") {
  // The paper counts the torso and both feet as boxes.
  int spheres = 0;
  int boxes = 0;
  int capsules = 0;
  for (const Shape& shape : man().solids()) {
    spheres += std::holds_alternative<Sphere>(shape);
    boxes += std::holds_alternative<Box>(shape);
    capsules += std::holds_alternative<Capsule>(shape);
  }
  CHECK(spheres == 1);
  CHECK(boxes == 3);
  CHECK(capsules == 9);
  CHECK(name(Part::pelvis) == "pelvis");
  CHECK(name(Part::right_foot) == "right_foot");
  CHECK(name(Part::left_thigh) == "left_thigh");
}

TEST_CASE("a thigh is a cylinder of Plagenhoef's 10.5 % of the mass", "[motion]") {
  constexpr double density_kg_m3 = 1050.0;
  for (const double mass : {50.0, 80.0, 120.0}) {
    const auto thigh = std::get<Capsule>(person(1.7, mass).solids()[at(Part::left_thigh)]);
    CHECK(density_kg_m3 * pi * thigh.radius * thigh.radius * 2.0 * thigh.half_length == Approx(0.105 * mass));
  }
}

TEST_CASE("lengths are Drillis and Contini's fractions of stature", "[motion]") {
  for (const double stature : {1.5, 1.86, 2.0}) {
    const Measures m = person(stature, 80.0).measures();
    CHECK(m.thigh_m == Approx(0.245 * stature));
    CHECK(m.shank_m + m.thigh_m + m.ankle_height_m == Approx(0.530 * stature));
    CHECK(m.upper_arm_m == Approx(0.186 * stature));
  }
  CHECK(person(1.86, 80).measures().forearm_m == Approx(0.400).margin(0.001));
}

TEST_CASE("widths grow with the square root of mass over stature", "[motion]") {
  const Humanoid heavy = person(1.86, 4.0 * 80.0);
  for (const Part part : {Part::pelvis, Part::left_upper_arm, Part::right_forearm, Part::left_thigh}) {
    CHECK(heavy.radius_m(part) == Approx(2.0 * man().radius_m(part)));
  }
}

TEST_CASE("a standing person is as tall as the stature says and stands on the floor with both soles", "[motion]") {
  for (const double stature : {1.5, 1.86, 2.05}) {
    const Humanoid humanoid = person(stature, 75.0);
    const Posture posture = Motion(humanoid, {1, 2}, 0.7, 0.25, tick_s).posture();
    const double top = posture[at(Part::head)].origin.y + humanoid.radius_m(Part::head) - 0.25;
    CHECK(top == Approx(stature).epsilon(0.003));  // knees are bent a little
    for (const Part foot : {Part::left_foot, Part::right_foot}) {
      CHECK(lowest_point(humanoid.solids()[at(foot)], posture[at(foot)]) == Approx(0.25).margin(1e-12));
    }
  }
}

TEST_CASE("a posture scales with stature", "[motion]") {
  const Posture small = Motion(person(1.5, 60.0), {0, 0}, 0, 0, tick_s).posture();
  const Posture large = Motion(person(1.8, 60.0), {0, 0}, 0, 0, tick_s).posture();
  for (std::size_t i = 0; i < n_parts; ++i) {
    CHECK(glm::distance(large[i].origin, 1.2 * small[i].origin) < 0.02);
  }
  // Joints exactly; the torso box and what hangs on widths (girth) only nearly.
  CHECK(glm::distance(large[at(Part::left_shank)].origin, 1.2 * small[at(Part::left_shank)].origin) < 1e-12);
  CHECK(glm::distance(large[at(Part::left_forearm)].origin, 1.2 * small[at(Part::left_forearm)].origin) < 1e-12);
}

TEST_CASE("neighbouring parts overlap at their joint, so that the body has no gaps", "[motion]") {
  for (const double mass : {55.0, 80.0, 110.0}) {
    const Humanoid humanoid = person(1.86, mass);
    const Posture posture = Motion(humanoid, {0, 0}, 0, 0, tick_s).posture();
    const auto inside = [&](const Vec3& point, Part part) {
      return signed_distance(point, humanoid.solids()[at(part)], posture[at(part)]) < 0.0;
    };
    const auto joint = [&](Joint j) { return joint_places(humanoid, posture, j).by_child; };
    CHECK((inside(joint(Joint::left_knee), Part::left_thigh) && inside(joint(Joint::left_knee), Part::left_shank)));
    CHECK((inside(joint(Joint::left_elbow), Part::left_upper_arm) &&
           inside(joint(Joint::left_elbow), Part::left_forearm)));
    CHECK((inside(joint(Joint::left_hip), Part::pelvis) && inside(joint(Joint::left_hip), Part::left_thigh)));
    // Shoulder joint to torso, ankle joint to foot: the capsule's round end reaches into the box.
    CHECK(signed_distance(joint(Joint::right_shoulder), humanoid.solids()[at(Part::torso)], posture[at(Part::torso)]) <
          humanoid.radius_m(Part::right_upper_arm));
    CHECK(signed_distance(joint(Joint::right_ankle), humanoid.solids()[at(Part::right_foot)],
                          posture[at(Part::right_foot)]) < 0.5 * humanoid.radius_m(Part::right_shank));
    const Vec3 chin = posture[at(Part::head)].origin - Vec3(0, 0.99 * humanoid.radius_m(Part::head), 0);
    CHECK(inside(chin, Part::torso));
    CHECK(inside(posture[at(Part::pelvis)].origin + Vec3(0, 0.99 * humanoid.radius_m(Part::pelvis), 0), Part::torso));
  }
}

TEST_CASE("a mesh takes its part's place before the rays and changes nothing in how the body moves", "[body_mesh]") {
  PersonSpec spec;
  spec.body_meshes["torso"] = testing::mesh_solid(testing::box_mesh({-0.3, -0.1, -0.3}, {0.3, 0.1, 0.3}));
  spec.body_meshes["left_thigh"] = testing::mesh_solid(testing::round_mesh(0.2, 0.1, 4));
  const Humanoid dressed(spec);
  CHECK(dressed.primitives() == man().solids());
  CHECK(man().primitives() == man().solids());
  for (std::size_t i = 0; i < n_parts; ++i) {
    const std::string part(name(static_cast<Part>(i)));
    const auto mesh = spec.body_meshes.find(part);
    INFO(part);
    CHECK(dressed.solids()[i] == (mesh != spec.body_meshes.end() ? Shape(mesh->second) : man().solids()[i]));
  }
  CHECK(dressed.radius_m(Part::left_thigh) == man().radius_m(Part::left_thigh));
  CHECK(dressed.clearance_radius_m() == man().clearance_radius_m());

  const SeatPlace place{{rotation_from_heading(0.0), {0.0, 0.45, 0.0}}, 0.0, 0.74};
  const Vec2 stand = floor_point(place.world_from_seat.origin) + fall_back_m(man(), place) * direction_of(0.0);
  Motion plain(man(), stand, 0.0, 0.0, tick_s), meshed(dressed, stand, 0.0, 0.0, tick_s);
  plain.sit_down(place);
  meshed.sit_down(place);
  for (int tick = 0; tick < 300; ++tick) {
    plain.advance();
    meshed.advance();
    REQUIRE(meshed.posture() == plain.posture());
  }
  CHECK(plain.stage() == Stage::seated);
  CHECK(worst_gap(dressed, meshed.posture()) == worst_gap(man(), plain.posture()));
}

TEST_CASE("a mesh for a part that there is not is an error", "[body_mesh]") {
  PersonSpec spec;
  spec.body_meshes["tail"] = testing::mesh_solid(testing::box_mesh(Vec3(-0.1), Vec3(0.1)));
  CHECK_THROWS_AS(Humanoid(spec), Error);
}
