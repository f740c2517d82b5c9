#include "io/pages/png.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <limits>
#include <string>
#include <utility>

#include "core/text.hpp"
#include "io/files/atomic_file.hpp"
#include "io/pages/canvas.hpp"
#include "io/pages/lettering.hpp"
#include "pirsim/error.hpp"

// Static, because tinygltf brings another copy.
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

namespace pirsim::io {
namespace {

constexpr int channels = 3;

void append_chunk(void* text, void* data, int size) {
  static_cast<std::string*>(text)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

}  // namespace

std::string to_png(int width, int height, std::span<const std::uint8_t> rgb) {
  const std::int64_t bytes = std::int64_t{width} * height * channels;
  if (width < 1 || height < 1 || bytes > std::numeric_limits<int>::max() || std::cmp_not_equal(bytes, rgb.size())) {
    throw Error(ErrorCode::usage, "the picture's width, height and pixels don't match");
  }
  std::string png;
  if (stbi_write_png_to_func(append_chunk, &png, width, height, channels, rgb.data(), width * channels) == 0) {
    throw Error(ErrorCode::internal, "the picture can't be encoded");
  }
  return png;
}

void write_png(const std::filesystem::path& path, int width, int height, std::span<const std::uint8_t> rgb) {
  write_text_file(path, to_png(width, height, rgb));
}

namespace {

constexpr int wanted_px = 900;    ///< width of the squares
constexpr int margin_px = 16;     ///< white, on all sides
constexpr int line_px = 30;       ///< of the key below the map
constexpr double text_px = 17.0;  ///< in the key
constexpr double sign_px = 34.0;  ///< width of a sign in the key, beside its name
constexpr Vec3 black(0.0), white(255.0), marker_red(255.0, 77.0, 109.0), door_green(45.0, 164.0, 78.0),
    area_purple(130.0, 60.0, 170.0), ring_orange(255.0, 127.0, 14.0), pass_blue(127.0, 184.0, 230.0),
    fail_orange(224.0, 164.0, 88.0);

/// Viridis by nine of its colours (Smith and van der Walt, CC0); `share` is from 0 to 1.
Vec3 viridis(double share) {
  constexpr std::array<std::uint32_t, 9> colours{0x440154, 0x472c7a, 0x3b518b, 0x2c718e, 0x21908d,
                                                 0x27ad81, 0x5cc863, 0xaadc32, 0xfde725};
  const auto rgb = [&](std::size_t i) {
    return Vec3(colours[i] >> 16U & 0xFFU, colours[i] >> 8U & 0xFFU, colours[i] & 0xFFU);
  };
  const double place = std::clamp(share, 0.0, 1.0) * (colours.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), colours.size() - 2);
  return glm::mix(rgb(below), rgb(below + 1), place - static_cast<double>(below));
}

class MapPicture {
 public:
  explicit MapPicture(const MapChart& chart)
      : chart_(chart), square_px_(std::max(1, wanted_px / std::max(1, chart.columns))), canvas_(pixels_) {
    pixels_.width = chart.columns * square_px_ + 2 * margin_px;
    pixels_.height = chart.rows * square_px_ + 2 * margin_px;
    pixels_.rgb.assign(static_cast<std::size_t>(pixels_.width) * static_cast<std::size_t>(pixels_.height) * 3, 255);
  }

  Pixels draw() {
    for (int row = 0; row < chart_.rows; ++row) {
      for (int column = 0; column < chart_.columns; ++column) square(column, row);
    }
    for (const RoomPlan::Area& area : chart_.plan.areas) {
      for (const auto& loop : area.loops) {
        polygon(loop, white, no_dashes);
        polygon(loop, area_purple, long_dashes);
      }
    }
    for (const auto& loop : chart_.plan.furniture) {
      polygon(loop, black, no_dashes);
      polygon(loop, white, short_dashes);
    }
    draw_walls();
    for (const auto& loop : chart_.plan.outline) polygon(loop, black, no_dashes);
    for (const RoomPlan::Door& door : chart_.plan.doors) {
      for (const double aside : {-1.5, 1.5})
        line(pixel_of(door.from) + aside, pixel_of(door.to) + aside, door_green, no_dashes);
      polygon(door.sweep, door_green, no_dashes);
    }
    for (const MapChart::Marker& at : chart_.plan.seats) seat(pixel_of(at.point), at.heading);
    for (const auto& loop : chart_.dashed) polygon(loop, white, long_dashes);
    for (const Vec2& point : chart_.ringed) ring(pixel_of(point));
    for (const MapChart::Marker& at : chart_.markers) arrow(pixel_of(at.point), at.heading);
    write_names();
    write_key();
    return std::move(pixels_);
  }

 private:
  static constexpr double no_dashes = Canvas::no_dashes, short_dashes = 5.0, long_dashes = 10.0;

  /// A sign and what it means.
  struct KeyEntry {
    double sign_px;
    std::function<void(const Vec2&)> draw_sign;  ///< given the middle of its left edge
    std::string text;
  };

  [[nodiscard]] std::vector<KeyEntry> key() {
    std::vector<KeyEntry> entries;
    const auto add = [&](bool is_there, const std::string& text, std::function<void(const Vec2&)> sign) {
      if (is_there) entries.push_back({sign_px, std::move(sign), text});
    };
    const Vec2 along(sign_px, 0.0);
    if (!chart_.title.empty()) entries.push_back({0.0, [](const Vec2&) {}, chart_.title});
    if (chart_.colours == MapChart::Colours::scale) {
      entries.push_back({0.0, [](const Vec2&) {}, "0"});
      constexpr double bar_px = 160.0;
      const auto bar = [this](const Vec2& at) {
        rectangle(at - Vec2(0.0, 9.0), Vec2(bar_px, 18.0), [](double share) { return viridis(share); });
      };
      entries.push_back({bar_px, bar, fixed(chart_.max, 0) + " " + chart_.unit});
    } else {
      const auto patch = [this](const Vec3& colour) {
        return [this, colour](const Vec2& at) {
          rectangle(at - Vec2(0.0, 9.0), Vec2(sign_px, 18.0), [&](double) { return colour; });
        };
      };
      add(true, "pass", patch(pass_blue));
      add(true, "fail", patch(fail_orange));
    }
    add(!chart_.markers.empty(), "sensor", [this](const Vec2& at) { arrow(at + Vec2(4.0, 0.0), -0.5 * pi); });
    add(!chart_.plan.seats.empty(), "seat", [this](const Vec2& at) { seat(at + Vec2(12.0, 0.0), -0.5 * pi); });
    add(!chart_.ringed.empty(), chart_.ringed_as, [this](const Vec2& at) { ring(at + Vec2(0.5 * sign_px, 0.0)); });
    add(!chart_.plan.doors.empty(), "door", [=, this](const Vec2& at) {
      for (const double aside : {-1.5, 1.5}) line(at + aside, at + along + aside, door_green, no_dashes);
    });
    add(!chart_.plan.areas.empty(), "area", [=, this](const Vec2& at) {
      line(at, at + along, white, no_dashes);
      line(at, at + along, area_purple, long_dashes);
    });
    add(!chart_.plan.furniture.empty(), "furniture", [=, this](const Vec2& at) {
      line(at, at + along, black, no_dashes);
      line(at, at + along, white, short_dashes);
    });
    add(has_inner_wall(), "wall", [=, this](const Vec2& at) {
      rectangle(at - Vec2(0.0, 4.0), Vec2(sign_px, 8.0), [](double) { return black; });
    });
    add(!chart_.dashed.empty(), "taken out", [=, this](const Vec2& at) {
      rectangle(at - Vec2(0.0, 9.0), Vec2(sign_px, 18.0), [](double) { return viridis(0.0); });
      line(at, at + along, white, long_dashes);
    });
    constexpr std::array lengths_m{0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0};
    const double px_per_m = square_px_ / chart_.spacing_m, most_px = 0.2 * wanted_px;
    const auto longer = std::ranges::find_if(lengths_m, [&](double length) { return length * px_per_m > most_px; });
    const double length_m = longer == lengths_m.begin() ? lengths_m.front() : *(longer - 1);
    const double length_px = std::min(length_m * px_per_m, 1.0 * wanted_px);
    const auto scale = [=, this](const Vec2& at) {
      const Vec2 end = at + Vec2(length_px, 0.0), up(0.0, 6.0);
      line(at, end, black, no_dashes);
      for (const Vec2& tick : {at, end}) line(tick - up, tick + up, black, no_dashes);
    };
    entries.push_back({length_px, scale, fixed(length_m, length_m < 1.0 ? 1 : 0) + " m"});
    return entries;
  }

  /// Below the map, in as many lines as it takes.
  void write_key() {
    constexpr double gap_px = 10.0, space_px = 24.0;
    const std::vector<KeyEntry> entries = key();
    const double right_px = pixels_.width - margin_px;
    std::vector<Vec2> places;  // left ends
    Vec2 at(margin_px, pixels_.height + 0.5 * line_px - margin_px + 8.0);
    for (const KeyEntry& entry : entries) {
      const double width = entry.sign_px + (entry.sign_px > 0.0 ? gap_px : 0.0) + text_extent(entry.text, text_px).x;
      if (at.x > margin_px && at.x + width > right_px) at = Vec2(margin_px, at.y + line_px);
      places.push_back(at);
      at.x += width + (entry.text == "0" ? gap_px : space_px);
    }
    pixels_.height = static_cast<int>(at.y + 0.5 * line_px) + margin_px / 2;
    pixels_.rgb.resize(static_cast<std::size_t>(pixels_.width) * static_cast<std::size_t>(pixels_.height) * 3, 255);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      entries[i].draw_sign(places[i]);
      const Vec2 extent = text_extent(entries[i].text, text_px);
      const double left = places[i].x + entries[i].sign_px + (entries[i].sign_px > 0.0 ? gap_px : 0.0);
      write_text(pixels_, {left + 0.5 * extent.x, places[i].y + 0.5 * extent.y}, entries[i].text, text_px, black);
    }
  }

  /// Three strokes wide.
  void ring(const Vec2& middle) {
    constexpr int n_sides = 32;
    for (const double radius_px : {13.0, 14.0, 15.0}) {
      const auto corner = [&](int i) { return middle + radius_px * direction_of(2.0 * pi * i / n_sides); };
      for (int i = 0; i < n_sides; ++i) line(corner(i), corner(i + 1), ring_orange, no_dashes);
    }
  }

  /// Coloured by the share of its width, from its left edge on.
  template <typename Colour>
  void rectangle(const Vec2& lower, const Vec2& size, Colour colour) {
    canvas_.each_near(lower, lower + size, 0.0, [&](int x, int y, const Vec2& centre) {
      canvas_.blend(x, y, colour((centre.x - lower.x) / size.x), 1.0);
    });
  }

  /// Of others the floor's edge alone is drawn.
  [[nodiscard]] bool has_inner_wall() const {
    const Vec2 end = chart_.lower + chart_.spacing_m * Vec2(chart_.columns, chart_.rows);
    const auto enters = [&](const std::vector<Vec2>& points) {
      Vec2 lower(1e9), upper(-1e9);
      for (const Vec2& p : points) lower = glm::min(lower, p), upper = glm::max(upper, p);
      const double slack_m = chart_.spacing_m;  // squares reach beyond the floor
      return lower.x < end.x - slack_m && lower.y < end.y - slack_m && upper.x > chart_.lower.x + slack_m &&
             upper.y > chart_.lower.y + slack_m;
    };
    return std::ranges::any_of(chart_.plan.wall_lines, enters) ||
           std::ranges::any_of(chart_.plan.walls,
                               [&](const auto& loops) { return std::ranges::any_of(loops, enters); });
  }

  [[nodiscard]] Vec2 pixel_of(const Vec2& point) const {
    return Vec2(margin_px) + (point - chart_.lower) * (square_px_ / chart_.spacing_m);
  }
  [[nodiscard]] std::vector<Vec2> pixels_of(const std::vector<Vec2>& points) const {
    std::vector<Vec2> pixels;
    for (const Vec2& point : points) pixels.push_back(pixel_of(point));
    return pixels;
  }

  void square(int column, int row) {
    const auto& value = chart_.values[static_cast<std::size_t>(row * chart_.columns + column)];
    if (!value) return;
    const bool verdict = chart_.colours == MapChart::Colours::pass_or_fail;
    const Vec3 colour = !verdict ? viridis(*value / chart_.max) : *value > 0.0 ? pass_blue : fail_orange;
    for (int y = 0; y < square_px_; ++y) {
      for (int x = 0; x < square_px_; ++x) {
        canvas_.blend(margin_px + column * square_px_ + x, margin_px + row * square_px_ + y, colour, 1.0);
      }
    }
  }

  /// Those between the squares; the floor's edge stands for the others. With a light rim, which shows where the floor
  /// is dark.
  void draw_walls() {
    const Vec2 lower(margin_px), upper(pixels_.width - margin_px, pixels_.height - margin_px);
    Canvas inside(pixels_, {lower, upper});
    std::vector<std::vector<std::vector<Vec2>>> walls;
    std::vector<std::vector<Vec2>> edges;
    for (const auto& loops : chart_.plan.walls) {
      auto& wall = walls.emplace_back();
      for (const auto& loop : loops) {
        wall.push_back(pixels_of(loop));
        edges.push_back(wall.back());
        edges.back().push_back(edges.back().front());
      }
    }
    for (const auto& points : chart_.plan.wall_lines) edges.push_back(pixels_of(points));
    const auto draw_edges = [&](const Vec3& colour, double width_px) {
      for (const auto& points : edges) {
        for (std::size_t i = 1; i < points.size(); ++i) inside.line(points[i - 1], points[i], colour, width_px);
      }
    };
    draw_edges(white, 5.0);
    draw_edges(black, 2.0);
    for (const auto& loops : walls) inside.area(loops, black);
  }

  /// Behind what looks or faces somewhere. A name that would cover another or a sign is left out.
  void write_names() {
    std::vector<PixelBox> taken;
    for (const auto* signs : {&chart_.markers, &chart_.plan.seats}) {
      for (const MapChart::Marker& sign : *signs)
        taken.push_back({pixel_of(sign.point) - 7.5, pixel_of(sign.point) + 7.5});
    }
    const auto write = [&](const MapChart::Marker& marker, double away_px, double size_px) {
      const Vec2 extent = text_extent(marker.label, size_px), reach = 0.5 * extent + away_px;
      const Vec2 ahead = direction_of(marker.heading), aside(-ahead.y, ahead.x);
      for (const Vec2& side : {-ahead, aside, -aside, ahead}) {
        const Vec2 bottom = glm::round(pixel_of(marker.point) + side * reach + Vec2(0.0, 0.5 * extent.y));
        const Lettering text{bottom, marker.label, black};
        const PixelBox box = box_of(text, size_px);
        const bool fits =
            box.lower.x >= 0.0 && box.lower.y >= 0.0 && box.upper.x <= pixels_.width && box.upper.y <= pixels_.height;
        if (!fits || std::ranges::any_of(taken, [&](const PixelBox& other) { return overlap(box, other); })) continue;
        write_text(pixels_, bottom, text.text, size_px, black);
        taken.push_back(box);
        return;
      }
    };
    write_area_names(taken);
    for (const MapChart::Marker& marker : chart_.markers) write(marker, 10.0, 15.0);
    for (const MapChart::Marker& marker : chart_.plan.seats) write(marker, 9.0, 13.0);
  }

  /// In the middle of each, or a little above or below it.
  void write_area_names(std::vector<PixelBox>& taken) {
    constexpr double size_px = 18.0;
    for (const RoomPlan::Area& area : chart_.plan.areas) {
      const Vec2 extent = text_extent(area.label, size_px);
      for (const double lines : {0.0, -1.2, 1.2, -2.4, 2.4, -3.6, 3.6}) {
        const Vec2 bottom = glm::round(pixel_of(area.middle) + Vec2(0.0, 0.5 * extent.y + lines * size_px));
        const PixelBox box = box_of({bottom, area.label, area_purple}, size_px);
        if (std::ranges::any_of(taken, [&](const PixelBox& other) { return overlap(box, other); })) continue;
        write_text(pixels_, bottom, area.label, size_px, area_purple);
        taken.push_back(box);
        break;
      }
    }
  }

  void polygon(const std::vector<Vec2>& loop, const Vec3& colour, double dash_px) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      line(pixel_of(loop[i]), pixel_of(loop[(i + 1) % loop.size()]), colour, dash_px);
    }
  }

  /// A shaft, and a head that narrows towards its tip.
  void arrow(const Vec2& from, double heading) {
    constexpr double shaft_px = 30.0, head_px = 14.0;
    const Vec2 ahead = direction_of(heading), tip = from + shaft_px * ahead;
    canvas_.disc(from, 6.0, marker_red);
    line(from, tip - head_px * ahead, marker_red, no_dashes);
    for (double back = 0.0; back <= head_px; back += 0.5) canvas_.disc(tip - back * ahead, 0.45 * back, marker_red);
  }

  /// A disc with a rim, and a nose the way who sits there faces.
  void seat(const Vec2& at, double heading) {
    line(at, at + 14.0 * direction_of(heading), black, no_dashes);
    canvas_.disc(at, 7.0, black);
    canvas_.disc(at, 5.0, white);
  }

  void line(const Vec2& a, const Vec2& b, const Vec3& colour, double dash_px) {
    constexpr double width_px = 3.0;
    canvas_.line(a, b, colour, width_px, dash_px);
  }

  const MapChart& chart_;
  int square_px_;
  Pixels pixels_;
  Canvas canvas_;
};

}  // namespace

Pixels drawn(const MapChart& chart) { return MapPicture(chart).draw(); }

}  // namespace pirsim::io
