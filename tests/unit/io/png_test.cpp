#include "io/pages/png.hpp"
#include "io/pages/lettering.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "pirsim/error.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::io;

namespace {

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
  return value;
}

/// CRC-32 as the PNG specification's appendix defines it.
std::uint32_t crc(const std::string& bytes) {
  std::uint32_t value = 0xFFFFFFFFU;
  for (const char c : bytes) {
    value ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) value = (value & 1U) != 0 ? 0xEDB88320U ^ (value >> 1) : value >> 1;
  }
  return ~value;
}

}  // namespace

TEST_CASE("a picture is a PNG of its size in 8-bit RGB with sound chunks from header to end", "[png]") {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> rgb(5 * 3 * 3);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(i * 37);
  write_png(folder.path() / "a.png", 5, 3, rgb);
  const std::string bytes = content(folder.path() / "a.png");
  REQUIRE(bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n");
  std::vector<std::string> chunks;
  for (std::size_t at = 8; at < bytes.size();) {
    const std::uint32_t size = big_endian(bytes, at);
    chunks.push_back(bytes.substr(at + 4, 4));
    REQUIRE(crc(bytes.substr(at + 4, 4 + size)) == big_endian(bytes, at + 8 + size));
    at += 12 + size;
  }
  CHECK(chunks == std::vector<std::string>{"IHDR", "IDAT", "IEND"});
  CHECK(big_endian(bytes, 16) == 5);
  CHECK(big_endian(bytes, 20) == 3);
  CHECK(bytes[24] == 8);
  CHECK(bytes[25] == 2);
}

TEST_CASE("a map is drawn in viridis, white off the floor, with the edge in black and an arrow", "[png]") {
  MapChart chart;
  chart.columns = 3;
  chart.rows = 1;
  chart.spacing_m = 0.5;
  chart.values = {0.0, 60.0, std::nullopt};
  chart.max = 60;
  const auto colour = [](const Pixels& picture, int x, int y) {
    const auto at = static_cast<std::size_t>(3 * (y * picture.width + x));
    return std::array<int, 3>{picture.rgb[at], picture.rgb[at + 1], picture.rgb[at + 2]};
  };
  const std::array<int, 3> violet{0x44, 0x01, 0x54}, yellow{0xfd, 0xe7, 0x25}, white{255, 255, 255}, black{0, 0, 0};
  const Pixels plain = drawn(chart);
  REQUIRE(plain.width == 3 * 300 + 2 * 16);
  REQUIRE(plain.height > 300 + 2 * 16);  // the key is below
  CHECK(plain.rgb.size() == static_cast<std::size_t>(plain.width * plain.height * 3));
  CHECK(colour(plain, 5, 100) == white);
  CHECK(colour(plain, 100, 100) == violet);
  CHECK(colour(plain, 500, 100) == yellow);
  CHECK(colour(plain, 800, 100) == white);

  chart.plan.outline = {{{0, 0}, {1, 0}, {1, 0.5}, {0, 0.5}}};
  chart.markers = {{"", {0.25, 0.25}, -pi / 2}};  // looks along +X: to the right
  const Pixels marked = drawn(chart);
  CHECK(colour(marked, 16, 166) == black);
  CHECK(colour(marked, 616, 166) == black);
  CHECK(colour(marked, 166, 166) == std::array<int, 3>{255, 77, 109});
  CHECK(colour(marked, 186, 166) == std::array<int, 3>{255, 77, 109});
  CHECK(colour(marked, 146, 166) == violet);
  chart.markers.front().point = {-40.0, 90.0};  // outside of the picture
  chart.plan.outline.front().front() = {-1e6, 0.1};
  CHECK(drawn(chart).rgb.size() == marked.rgb.size());
}

TEST_CASE("a map shows furniture, seats and doors where they are, and pass and fail as two colours", "[png]") {
  MapChart chart;
  chart.columns = 3;
  chart.rows = 1;
  chart.spacing_m = 0.5;
  chart.values = {1.0, 0.0, 0.0};
  chart.colours = MapChart::Colours::pass_or_fail;
  const auto colour = [](const Pixels& picture, double x_m, double z_m) {
    const int x = 16 + static_cast<int>(600 * x_m), y = 16 + static_cast<int>(600 * z_m);
    const auto at = static_cast<std::size_t>(3 * (y * picture.width + x));
    return std::array<int, 3>{picture.rgb[at], picture.rgb[at + 1], picture.rgb[at + 2]};
  };
  const Pixels plain = drawn(chart);
  CHECK(colour(plain, 0.1, 0.1) == std::array<int, 3>{0x7f, 0xb8, 0xe6});
  CHECK(colour(plain, 0.7, 0.1) == std::array<int, 3>{0xe0, 0xa4, 0x58});
  chart.plan.furniture = {{{0.2, 0.1}, {0.4, 0.1}, {0.4, 0.3}, {0.2, 0.3}}};
  chart.plan.seats = {{"S1", {0.75, 0.25}, 0.0}};
  chart.plan.doors = {{"door", {1.1, 0.45}, {1.4, 0.45}}};
  const Pixels marked = drawn(chart);
  CHECK(colour(marked, 0.75, 0.25) == std::array<int, 3>{255, 255, 255});
  CHECK(colour(marked, 1.25, 0.45) == std::array<int, 3>{45, 164, 78});
  CHECK(colour(marked, 0.2, 0.2) != colour(plain, 0.2, 0.2));
  CHECK(colour(marked, 0.3, 0.2) == colour(plain, 0.3, 0.2));  // only its edge
}

TEST_CASE("a map shows walls in black with a light rim, hollow where they are, and as wide as they are", "[png]") {
  MapChart chart;
  chart.columns = 3;
  chart.rows = 2;
  chart.spacing_m = 0.5;
  chart.values.assign(6, 0.0);
  const auto colour = [](const Pixels& picture, double x_m, double z_m) {
    const int x = 16 + static_cast<int>(600 * x_m), y = 16 + static_cast<int>(600 * z_m);
    const auto at = static_cast<std::size_t>(3 * (y * picture.width + x));
    return std::array<int, 3>{picture.rgb[at], picture.rgb[at + 1], picture.rgb[at + 2]};
  };
  const std::array<int, 3> black{0, 0, 0}, violet{0x44, 0x01, 0x54};
  chart.plan.walls = {
      {{{0.3, 0.0}, {0.4, 0.0}, {0.4, 0.8}, {0.3, 0.8}}},
      {{{0.8, 0.2}, {1.4, 0.2}, {1.4, 0.8}, {0.8, 0.8}}, {{0.9, 0.3}, {1.3, 0.3}, {1.3, 0.7}, {0.9, 0.7}}}};
  chart.plan.wall_lines = {{{0.6, 0.1}, {0.6, 0.9}}};
  const Pixels picture = drawn(chart);
  for (const double z : {0.05, 0.4, 0.75}) CHECK(colour(picture, 0.35, z) == black);
  CHECK(colour(picture, 0.35, 0.9) == violet);
  CHECK(colour(picture, 0.6, 0.5) == black);
  CHECK(colour(picture, 0.6, 0.95) == violet);
  CHECK(colour(picture, 0.85, 0.5) == black);
  CHECK(colour(picture, 1.1, 0.5) == violet);  // in the hole
  CHECK(colour(picture, 0.4 + 2.0 / 600, 0.4)[1] > 100);
}

TEST_CASE("names on a map cover neither each other nor a sensor, and those without room are left out", "[png]") {
  MapChart chart;
  chart.columns = 3;
  chart.rows = 2;
  chart.spacing_m = 0.5;
  chart.values.assign(6, 60.0);  // yellow: only signs and names are dark
  chart.max = 60.0;
  const auto dark = [](const Pixels& picture) {
    int n = 0;
    for (int y = 17; y < 16 + 600 - 1; ++y) {
      for (int x = 17; x < 16 + 900 - 1; ++x) {
        const auto at = static_cast<std::size_t>(3 * (y * picture.width + x));
        n += picture.rgb[at] < 60 && picture.rgb[at + 1] < 60 ? 1 : 0;
      }
    }
    return n;
  };
  const auto picture_of = [&](int n, const std::string& label) {
    chart.plan.seats.clear();
    for (int i = 0; i < n; ++i) chart.plan.seats.push_back({label, {0.3 + i * 0.025, 0.4}, 0.0});
    return dark(drawn(chart));
  };
  const int one = picture_of(1, "D10") - picture_of(1, "");
  CHECK(one > 30);
  // Every 15 pixels, which is less than a name is wide: whole names, some above and some below.
  const int twelve = picture_of(12, "D10") - picture_of(12, "");
  const double names = static_cast<double>(twelve) / one;
  CHECK((names > 3.9 && names < 11.1));
  CHECK(std::abs(names - std::round(names)) < 0.2);  // a name may hide a bit of a seat
}

TEST_CASE("below a map a key shows its colours and signs, and those alone, however narrow the map is", "[png]") {
  const std::array<int, 3> red{255, 77, 109}, green{45, 164, 78}, yellow{0xfd, 0xe7, 0x25}, orange{0xe0, 0xa4, 0x58};
  const int columns = GENERATE(1, 3, 500);
  MapChart chart;
  chart.title = "PIR1";
  chart.unit = "s of 60 with motion";
  chart.columns = columns;
  chart.rows = 1;
  chart.spacing_m = 0.5;
  chart.values.assign(static_cast<std::size_t>(columns), 0.0);
  const int key_from = 2 * 16 + 900 / columns;
  const auto has = [&](const Pixels& picture, const std::array<int, 3>& colour) {
    for (auto at = static_cast<std::size_t>(key_from * picture.width) * 3; at < picture.rgb.size(); at += 3) {
      if (std::abs(picture.rgb[at] - colour[0]) < 3 && std::abs(picture.rgb[at + 1] - colour[1]) < 3 &&
          std::abs(picture.rgb[at + 2] - colour[2]) < 3)
        return true;
    }
    return false;
  };
  const Pixels plain = drawn(chart);
  CHECK(has(plain, yellow));
  CHECK(has(plain, {0, 0, 0}));
  CHECK_FALSE((has(plain, red) || has(plain, green) || has(plain, orange)));
  chart.markers = {{"PIR1", {0.2, 0.2}, 0.0}};
  chart.plan.doors = {{"door", {0.1, 0.1}, {0.3, 0.1}}};
  chart.plan.seats = {{"S1", {0.2, 0.3}, 0.0}};
  chart.plan.furniture = {{{0.2, 0.1}, {0.4, 0.1}, {0.4, 0.3}}};
  chart.dashed = chart.plan.furniture;
  const Pixels marked = drawn(chart);
  CHECK((has(marked, red) && has(marked, green)));
  chart.colours = MapChart::Colours::pass_or_fail;
  CHECK(has(drawn(chart), orange));
  // Nothing is cut off: the outermost pixels are paper.
  for (int y = key_from; y < marked.height; ++y) {
    for (const int x : {0, marked.width - 1}) {
      REQUIRE(marked.rgb[static_cast<std::size_t>(3 * (y * marked.width + x))] == 255);
    }
  }
}

TEST_CASE("a text stands where it is asked for, and is cut off at the picture's edge", "[png]") {
  const Pixels paper{200, 60, std::vector<std::uint8_t>(std::size_t{200} * 60 * 3, 128)};
  Pixels written = paper;
  write_text(written, {100.0, 40.0}, "S10", 16.0, Vec3(0.0));
  int left = 200, right = 0, top = 60, bottom = 0, dark = 0;
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 200; ++x) {
      const std::uint8_t value = written.rgb[static_cast<std::size_t>(3 * (y * 200 + x))];
      if (value >= 128) continue;
      ++dark;
      left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
    }
  }
  CHECK(dark > 50);
  CHECK(std::abs(0.5 * (left + right) - 100.0) < 4.0);
  CHECK(top >= 40 - 16 - 2);
  CHECK(bottom <= 40);
  for (const Vec2 at : {Vec2(0.0, 0.0), Vec2(-500.0, 20.0), Vec2(1e7, 1e7)}) {
    Pixels cut = paper;
    write_text(cut, at, "a long text, with ä and \n in it", 16.0, Vec3(0.0));
    CHECK(cut.rgb.size() == paper.rgb.size());
  }
  // Letters have smooth edges, and those beyond ASCII are themselves.
  std::vector<bool> shades(256);
  for (const std::uint8_t value : written.rgb) shades[value] = true;
  CHECK(std::count(shades.begin(), shades.end(), true) > 30);
  CHECK(text_extent("ä", 16.0).x == text_extent("a", 16.0).x);
  CHECK(text_extent("\u017e\xff", 16.0).x == Approx(text_extent("z?", 16.0).x));
  CHECK(text_extent("\u5b57", 16.0).x == text_extent("?", 16.0).x);
  Pixels none = paper;
  write_text(none, {100.0, 40.0}, "", 16.0, Vec3(0.0));
  CHECK(none.rgb == paper.rgb);
}

TEST_CASE("texts that would cover each other are set apart, and others stay where they are", "[png]") {
  constexpr double size = 12.0;
  std::vector<Lettering> texts{{{400.0, 300.0}, "front_door", Vec3(0.0)}, {{10.0, 20.0}, "S9", Vec3(0.0)}};
  for (int i = 0; i < 6; ++i) texts.push_back({{400.0 + 5.0 * i, 302.0 - i}, "S" + std::to_string(i), Vec3(0.0)});
  const std::vector<Lettering> placed = set_apart(texts, size);
  REQUIRE(placed.size() == texts.size());
  CHECK(placed[0].bottom == texts[0].bottom);
  CHECK(placed[1].bottom == texts[1].bottom);
  // Written one by one on paper of its own, no two darken the same pixel.
  std::vector<int> dark(std::size_t{800} * 600);
  int moved = 0;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    CHECK(placed[i].text == texts[i].text);
    CHECK(placed[i].bottom.x == texts[i].bottom.x);
    CHECK(std::abs(placed[i].bottom.y - texts[i].bottom.y) <= 10.0 * size);
    if (placed[i].bottom != texts[i].bottom) ++moved;
    Pixels paper{800, 600, std::vector<std::uint8_t>(dark.size() * 3, 255)};
    write_text(paper, placed[i].bottom, placed[i].text, size, Vec3(0.0));
    for (std::size_t pixel = 0; pixel < dark.size(); ++pixel) dark[pixel] += paper.rgb[3 * pixel] < 128 ? 1 : 0;
  }
  CHECK(moved >= 5);
  const PixelBox key{{350.0, 250.0}, {450.0, 320.0}};
  for (const Lettering& text : set_apart(texts, size, std::vector{key})) CHECK_FALSE(overlap(box_of(text, size), key));
  CHECK(*std::max_element(dark.begin(), dark.end()) == 1);
}

TEST_CASE("a picture of the wrong size is refused and nothing is written", "[png]") {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> rgb(12);
  CHECK_THROWS_AS(write_png(folder.path() / "a.png", 2, 3, rgb), Error);
  CHECK_THROWS_AS(write_png(folder.path() / "a.png", 0, 0, {}), Error);
  CHECK_THROWS_AS(write_png(folder.path() / "a.png", -2, -2, rgb), Error);
  CHECK_THROWS_AS(write_png(folder.path() / "a.png", 1 << 20, 1 << 20, rgb), Error);
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("a picture that can't be written is an io error", "[png]") {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> rgb(12);
  try {
    write_png(folder.path() / "none" / "a.png", 2, 2, rgb);
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.code() == ErrorCode::io);
  }
}
