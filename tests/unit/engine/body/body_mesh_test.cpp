// People whose parts are meshes.
#include "support/body_checks.hpp"
#include "support/fine_mesh.hpp"

using namespace pirsim;
using namespace pirsim::body;
using namespace pirsim::body::test;

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
