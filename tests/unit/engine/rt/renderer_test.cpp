#include "engine/rt/renderer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pirsim/error.hpp"
#include "support/catch.hpp"
#include "support/meeting_room.hpp"

using namespace pirsim;
using rt::Colour;
using rt::Image;
using rt::Surface;

namespace {

constexpr int width = 161, height = 121;

bool is_background(const Image& image, int x, int y) {
  const auto* pixel = &image.rgb[static_cast<std::size_t>(3 * (y * image.width + x))];
  return std::equal(pixel, pixel + 3, rt::background_rgb.begin());
}
long n_drawn(const Image& image) {
  long n = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) n += is_background(image, x, y) ? 0 : 1;
  }
  return n;
}

const rt::Room nothing{{}};
const rt::Camera down_z{{0, 0, 4}, {0, 0, 0}, 0.5};

}  // namespace

TEST_CASE("a view of nothing is background only", "[rt][render]") {
  const Image image = rt::render(nothing, {}, {}, {}, {}, down_z, width, height);
  CHECK(image.rgb.size() == std::size_t{3} * width * height);
  CHECK(n_drawn(image) == 0);
}

TEST_CASE("the depth of a pixel is the distance of what it shows, along the way the camera looks", "[rt][render]") {
  const float radius = 0.4F;
  const std::vector<rt::RenderedSolid> solids{{PosedSphere{{0, 0, 0}, radius}, Colour{1, 0, 0}}};
  const Image image = rt::render(nothing, {}, {}, solids, {}, down_z, width, height);
  REQUIRE(image.depth_m.size() == std::size_t{width} * height);
  CHECK(image.depth_m[(height / 2) * width + width / 2] == Approx(4.0F - radius).margin(1e-3));
  CHECK(std::isinf(image.depth_m.front()));
}

TEST_CASE("a sphere is drawn as a disc of the radius that its tangent cone has", "[rt][render]") {
  const double radius = 0.4, distance = 4.0;
  const std::vector<rt::RenderedSolid> solids{{PosedSphere{{0, 0, 0}, float(radius)}, Colour{1, 0, 0}}};
  const Image image = rt::render(nothing, {}, {}, solids, {}, down_z, width, height);
  // The silhouette lies at the angle asin(r / d); a picture plane at tangent 1 is half its height over tan(fov / 2).
  const double tangent = std::tan(std::asin(radius / distance));
  const double expected = tangent * 0.5 * height / std::tan(0.5 * down_z.vertical_fov_rad);
  int across = 0, down = 0;
  for (int x = 0; x < width; ++x) across += is_background(image, x, height / 2) ? 0 : 1;
  for (int y = 0; y < height; ++y) down += is_background(image, width / 2, y) ? 0 : 1;
  // The disc's middle is the middle pixel's. A pixel is drawn if its innermost sample, a quarter of a pixel nearer the
  // middle on both axes, is inside.
  const int exact = 2 * static_cast<int>(std::sqrt(expected * expected - 0.0625) + 0.25) + 1;
  CHECK(across == exact);
  CHECK(down == exact);
  CHECK(double(n_drawn(image)) == Approx(std::numbers::pi * expected * expected).epsilon(0.06));
}

TEST_CASE("a wall between camera and target is cut away if it is see-through, and stays if it is opaque",
          "[rt][render]") {
  const std::vector<TriMesh> meshes{testing::box_mesh({-9, -9, 1}, {9, 9, 1.1}),
                                    testing::box_mesh({-9, -9, -1}, {9, 9, -0.9})};
  const rt::Room room(meshes);
  const std::vector<Colour> colours{Colour{1, 0, 0}, Colour{0, 0, 1}};
  const auto middle_of = [&](Surface front) {
    const std::vector<Surface> surfaces{front, Surface::see_through};
    const Image image = rt::render(room, surfaces, colours, {}, {}, down_z, width, height);
    const auto* pixel = &image.rgb[3 * ((height / 2) * width + width / 2)];
    return pixel[0] > pixel[2] ? 'r' : 'b';
  };
  CHECK(middle_of(Surface::opaque) == 'r');
  CHECK(middle_of(Surface::see_through) == 'b');
  CHECK(middle_of(Surface::hidden) == 'b');
}

TEST_CASE("a beam shows before a surface and not behind it", "[rt][render]") {
  const std::vector<rt::RenderedSolid> screen{{PosedBox{{0, 0, 0}, glm::mat3(1.0F), {5, 5, 0.1F}}, Colour{1, 1, 1}}};
  const auto redness = [&](double z) {
    const std::vector<rt::Beam> beams{{{-0.5, 0, z}, {0.5, 0, z}, Colour{1, 0, 0}}};
    const Image image = rt::render(nothing, {}, {}, screen, beams, down_z, width, height);
    const auto* pixel = &image.rgb[3 * ((height / 2) * width + width / 2)];
    return pixel[0] - pixel[1];
  };
  CHECK(redness(0.5) > 20);
  CHECK(redness(-0.5) == 0);
}

TEST_CASE("the same picture twice is the same bytes", "[rt][render]") {
  const rt::Room room(testing::meeting_room());
  const std::vector<Surface> surfaces(room.n_meshes(), Surface::see_through);
  const std::vector<Colour> colours(room.n_meshes(), Colour{0.8F, 0.8F, 0.8F});
  std::vector<rt::RenderedSolid> solids;
  for (const PosedShape& part : testing::standing_person(5.2, -2.6, 0.6))
    solids.push_back({part, Colour{0.1F, 0.2F, 0.4F}});
  const std::vector<rt::Beam> beams{{{2.6, 2.6, 0}, {5.2, 1.0, -2.6}, Colour{1, 0, 0}}};
  const rt::Camera camera{{8.8, 5.6, 3.2}, {3.5, 0.7, -2.1}, 0.62};
  const Image once = rt::render(room, surfaces, colours, solids, beams, camera, width, height);
  CHECK(once.rgb == rt::render(room, surfaces, colours, solids, beams, camera, width, height).rgb);
  CHECK(n_drawn(once) > width * height / 3);
}

TEST_CASE("a picture with too few colours or without pixels is refused", "[rt][render]") {
  const rt::Room room(testing::meeting_room());
  CHECK_THROWS_AS(rt::render(room, {}, {}, {}, {}, down_z, width, height), Error);
  CHECK_THROWS_AS(rt::render(nothing, {}, {}, {}, {}, down_z, 0, height), Error);
}
