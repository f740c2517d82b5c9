#include "dataset/floor_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

namespace pirsim::dataset {
namespace {

constexpr double rounding_m = 1e-9;

/// Cosine and sine of whole quarters, exactly.
std::array<int, 2> turn(int quarters) {
  constexpr std::array<std::array<int, 2>, 4> turns{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  return turns[static_cast<std::size_t>(((quarters % 4) + 4) % 4)];
}

/// Of what faces that way; `direction` is along an axis.
int quarters_facing(const Vec2& direction) { return static_cast<int>(std::lround(heading_of(direction) / (0.5 * pi))); }

}  // namespace

Vec2 Spot::operator*(const Vec2& own) const {
  const auto [c, s] = turn(quarters);
  return origin + Vec2(c * own.x + s * own.y, c * own.y - s * own.x);
}

Rectangle Spot::operator*(const Rectangle& own) const {
  const Vec2 a = *this * own.lower, b = *this * own.upper;
  return {glm::min(a, b), glm::max(a, b)};
}

Frame Spot::frame(double height_m) const {
  return {rotation_from_heading(0.5 * pi * quarters), Vec3(origin.x, height_m, origin.y)};
}

double Wall::length_m() const { return glm::distance(from, to); }
Vec2 Wall::along() const { return (to - from) / length_m(); }
Vec2 Wall::inward() const { return {along().y, -along().x}; }
Spot Wall::facing_room(double along_m) const { return {at(along_m), quarters_facing(inward())}; }
Spot Wall::facing_wall(double along_m, double inward_m) const {
  return {at(along_m, inward_m), quarters_facing(-inward())};
}

FloorPlan::FloorPlan(double width_m, double depth_m, std::optional<Rectangle> missing_corner)
    : bounds_{{0.0, -depth_m}, {width_m, 0.0}}, missing_(missing_corner) {
  outline_ = {{0.0, 0.0}, {width_m, 0.0}};
  if (!missing_) {
    outline_.insert(outline_.end(), {{width_m, -depth_m}, {0.0, -depth_m}});
  } else if (missing_->upper.x == width_m) {
    outline_.insert(outline_.end(), {{width_m, missing_->upper.y},
                                     {missing_->lower.x, missing_->upper.y},
                                     {missing_->lower.x, -depth_m},
                                     {0.0, -depth_m}});
  } else {
    outline_.insert(outline_.end(), {{width_m, -depth_m},
                                     {missing_->upper.x, -depth_m},
                                     {missing_->upper.x, missing_->upper.y},
                                     {0.0, missing_->upper.y}});
  }
  build_walls();
}

FloorPlan::FloorPlan(const Rectangle& bounds)
    : bounds_(bounds),
      outline_{{bounds.lower.x, bounds.upper.y}, bounds.upper, {bounds.upper.x, bounds.lower.y}, bounds.lower} {
  build_walls();
}

void FloorPlan::build_walls() {
  const std::size_t n = outline_.size();
  const auto is_inner = [&](const Vec2& p) {
    return missing_ && p.y == missing_->upper.y && p.x != bounds_.lower.x && p.x != bounds_.upper.x;
  };
  for (std::size_t i = 0; i < n; ++i) {
    Wall& wall = walls_.emplace_back();
    wall.from = outline_[i];
    wall.to = outline_[(i + 1) % n];
    wall.convex_at_from = !is_inner(wall.from);
    wall.convex_at_to = !is_inner(wall.to);
    if (!wall.convex_at_from || !wall.convex_at_to) wall.kind = Wall::Kind::of_missing_corner;
  }
}

bool overlap(const Rectangle& a, const Rectangle& b) noexcept {
  return a.lower.x < b.upper.x - rounding_m && b.lower.x < a.upper.x - rounding_m &&
         a.lower.y < b.upper.y - rounding_m && b.lower.y < a.upper.y - rounding_m;
}

bool FloorPlan::contains(const Rectangle& r) const noexcept {
  const bool within = r.lower.x >= bounds_.lower.x - rounding_m && r.lower.y >= bounds_.lower.y - rounding_m &&
                      r.upper.x <= bounds_.upper.x + rounding_m && r.upper.y <= bounds_.upper.y + rounding_m;
  return within && !(missing_ && overlap(r, *missing_));
}

bool FloorPlan::is_free(const Rectangle& r) const noexcept {
  return contains(r) && std::ranges::none_of(occupied_, [&](const Rectangle& other) { return overlap(r, other); });
}

double draw(const Range& range, Stream& stream) { return range.least + (range.most - range.least) * stream.uniform(); }
int draw(const CountRange& range, Stream& stream) {
  return range.least + static_cast<int>(stream.index(static_cast<std::uint32_t>(range.most - range.least + 1)));
}
double draw_length(const Range& range, Stream& stream) {
  const double length = std::round(100.0 * draw(range, stream)) / 100.0;
  return std::clamp(length, range.least, range.most);
}

namespace {

/// Single precision, as a file holds it, so that a room in memory and one read back are the same.
using Sides = std::array<float, 2>;
Sides sides(double lower, double upper) { return {static_cast<float>(lower), static_cast<float>(upper)}; }

}  // namespace

TriMesh boxes(const std::string& name, const Spot& spot, std::span<const BoxPart> parts) {
  // Corner k has the upper x, y, z where bit 0, 1, 2 is set; outward, counter-clockwise.
  constexpr std::array<std::array<std::uint32_t, 4>, 6> quads{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  TriMesh mesh;
  mesh.name = name;
  for (const BoxPart& part : parts) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Rectangle r = spot * part.footprint;
    const Sides x = sides(r.lower.x, r.upper.x), y = sides(part.from_y_m, part.to_y_m), z = sides(r.lower.y, r.upper.y);
    for (std::size_t k = 0; k < 8; ++k) mesh.positions.emplace_back(x[k & 1], y[k >> 1 & 1], z[k >> 2 & 1]);
    for (const auto& q : quads) {
      mesh.triangles.push_back({first + q[0], first + q[1], first + q[2]});
      mesh.triangles.push_back({first + q[0], first + q[2], first + q[3]});
    }
  }
  return mesh;
}

TriMesh floor_mesh(const std::vector<Rectangle>& pieces) {
  TriMesh mesh;
  mesh.name = "floor";
  for (const Rectangle& r : pieces) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Sides x = sides(r.lower.x, r.upper.x), z = sides(r.lower.y, r.upper.y);
    for (const auto& [i, k] : {std::pair(0, 1), std::pair(1, 1), std::pair(1, 0), std::pair(0, 0)}) {
      mesh.positions.emplace_back(x[static_cast<std::size_t>(i)], 0.0F, z[static_cast<std::size_t>(k)]);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

}  // namespace pirsim::dataset
