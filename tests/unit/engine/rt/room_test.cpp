#include "engine/rt/room.hpp"

#include <vector>

#include "engine/rt/room_impl.hpp"
#include "pirsim/error.hpp"
#include "support/catch.hpp"
#include "support/random_scene.hpp"

using namespace pirsim;

TEST_CASE("the first hit tells distance, side and mesh", "[rt]") {
  const std::vector<TriMesh> meshes{testing::box_mesh({-5, -5, -5}, {5, 5, 5}), TriMesh{"nothing", {}, {}},
                                    testing::box_mesh({-1, -1, -3}, {1, 1, -2})};
  const rt::Room room(meshes);
  const auto front = room.first_hit({Vec3f(0.2F, 0.1F, 0.0F), Vec3f(0, 0, -1)}, 100.0F);
  REQUIRE(front.has_value());
  CHECK(front->distance == Approx(2.0).margin(1e-6));
  CHECK(front->normal == Vec3f(0, 0, 1));
  CHECK(front->mesh == 2);
  const auto wall = room.first_hit({Vec3f(0.2F, 0.1F, 0.0F), Vec3f(1, 0, 0)}, 100.0F);
  REQUIRE(wall.has_value());
  CHECK(wall->distance == Approx(4.8).margin(1e-6));
  CHECK(wall->normal == Vec3f(-1, 0, 0));
  CHECK(wall->mesh == 0);
  CHECK_FALSE(room.first_hit({Vec3f(0.2F, 0.1F, 0.0F), Vec3f(1, 0, 0)}, 4.7F));
}

TEST_CASE("clip cuts a range at the room and leaves a shorter one alone", "[rt]") {
  const std::vector<TriMesh> meshes{testing::box_mesh({-5, -5, -5}, {5, 5, 5})};
  const rt::Room room(meshes);
  RayBundle bundle;
  bundle.rays.assign(2, Ray{Vec3f(0.0F), Vec3f(0, 0, -1)});
  bundle.range = {12.0F, 3.0F};
  room.clip(bundle);
  CHECK(bundle.range[0] == Approx(5.0).margin(1e-6));
  CHECK(bundle.range[1] == 3.0F);
}

TEST_CASE("an empty room stops no ray", "[rt]") {
  const rt::Room room({});
  CHECK_FALSE(room.first_hit(Ray{}, 1e6F));
}

TEST_CASE("a triangle that asks for a vertex which isn't there is refused", "[rt]") {
  const std::vector<TriMesh> meshes{{"lame", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}}};
  CHECK_THROWS_WITH(rt::Room(meshes), contains("lame") && contains("vertex 3"));
}

TEST_CASE("what Embree refuses becomes our error", "[rt]") {
  const rt::Device device = rt::make_device();
  const rt::SceneHandle scene = rt::make_scene(device.get(), RTC_SCENE_FLAG_ROBUST);
  CHECK_NOTHROW(rt::commit(device.get(), scene.get()));
  const rt::GeometryHandle geometry = rt::make_geometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcAttachGeometry(scene.get(), geometry.get());  // not committed, which Embree minds
  CHECK_THROWS_AS(rt::commit(device.get(), scene.get()), Error);
  CHECK_NOTHROW(rt::check(device.get(), "do nothing"));
}

TEST_CASE("a device is held to SSE 4.2 whatever the processor offers", "[rt]") {
  const rt::Device device = rt::make_device();
  CHECK(rt::instruction_set() == "sse4.2");
  // Packets of eight are native from AVX on.
  CHECK(rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) == 0);
  CHECK(rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED) == 1);
  CHECK(rt::embree_version() == RTC_VERSION_STRING);
}
