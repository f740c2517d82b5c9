#include "show/png.hpp"

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
