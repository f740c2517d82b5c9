#include "io/scene_parts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "schema/limits.hpp"

namespace pirsim::io::detail {
namespace {

constexpr double flatness_m = 0.01;  // assumed: less than any step one could trip over

constexpr double world_limit_m = 1e5;  // as for nodes

using Loop = std::vector<Vec2>;

/// Twice the signed area of a triangle.
double side(const Vec2& a, const Vec2& b, const Vec2& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// Two segments that cross in their inner points; touching is allowed.
bool cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  // Rounding must not make touching edges cross: within this many square metres a point is on the line.
  constexpr double on_line = 1e-9;
  const auto opposite = [&](double s, double t) {
    return (s > on_line && t < -on_line) || (s < -on_line && t > on_line);
  };
  return opposite(side(a, b, c), side(a, b, d)) && opposite(side(c, d, a), side(c, d, b));
}

bool cross(const Loop& first, const Loop& second) {
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t j = 0; j < second.size(); ++j) {
      if (cross(first[i], first[(i + 1) % first.size()], second[j], second[(j + 1) % second.size()])) return true;
    }
  }
  return false;
}

/// Whether the floor just beside an edge of the first, on its inner side, also belongs to the second.
bool edge_runs_inside(const FloorArea& own, const FloorArea& other) {
  for (const Loop& loop : own.loops()) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec2 a = loop[i], along = loop[(i + 1) % loop.size()] - a;
      const Vec2 aside = Vec2(-along.y, along.x) * 1e-6;
      for (const Vec2& beside : {a + 0.5 * along + aside, a + 0.5 * along - aside}) {
        if (own.contains(beside) && other.contains(beside)) return true;
      }
    }
  }
  return false;
}

bool boxes_meet(const FloorArea& a, const FloorArea& b) {
  return a.lower().x < b.upper().x && b.lower().x < a.upper().x && a.lower().y < b.upper().y &&
         b.lower().y < a.upper().y;
}

/// Floors may touch, but an overlap would count as no floor by the even-odd rule.
bool overlap(const FloorArea& first, const FloorArea& second) {
  if (!boxes_meet(first, second)) return false;
  for (const Loop& a : first.loops()) {
    for (const Loop& b : second.loops()) {
      if (cross(a, b)) return true;
    }
  }
  return edge_runs_inside(first, second) || edge_runs_inside(second, first);
}

}  // namespace

bool FloorBuilder::flat(const std::vector<Vec3>& points, const Where& where, const std::string& label) {
  const auto [lowest, highest] =
      std::minmax_element(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) { return a.y < b.y; });
  if (highest->y - lowest->y <= flatness_m) return true;
  const auto spans = [&](auto member) {
    const auto [least, most] = std::minmax_element(points.begin(), points.end(),
                                                   [&](const Vec3& a, const Vec3& b) { return a.*member < b.*member; });
    return (*most).*member - (*least).*member;
  };
  const bool upright = std::min(spans(&Vec3::x), spans(&Vec3::z)) <= flatness_m;
  faults_.error(where, label + ": a floor must be flat and level; this one " +
                           (upright ? "stands upright, as in files that are Z-up (glTF's +Y is up), and " : "") +
                           "rises by " + std::to_string(highest->y - lowest->y) + " m");
  return false;
}

void FloorBuilder::add_mesh(const TriMesh& mesh, const Where& where, const std::string& label) {
  if (mesh.positions.empty())
    return faults_.error(where, label + ": its mesh has no triangles, so it has no floor area");
  if (!flat(mesh.positions, where, label)) return;
  try {
    add({{boundary_loops_xz(mesh), mesh.positions.front().y}, where, label});
  } catch (const Error& fault) {
    faults_.error(where, label + ": " + fault.issues().front().message);
  }
}

void FloorBuilder::add_polygon(const std::vector<Vec3>& corners, const Where& where, const std::string& label) {
  if (!flat(corners, where, label)) return;
  Loop loop;
  for (const Vec3& corner : corners) loop.push_back(floor_point(corner));
  add({{{std::move(loop)}, corners.front().y}, where, label});
}

void FloorBuilder::add(Part part) {
  for (const Loop& loop : part.area.loops()) {
    n_corners_ += loop.size();
    if (n_corners_ > limits::floor_corners) {
      return faults_.error(part.where, part.label + ": the floor's outline has more than " +
                                           std::to_string(limits::floor_corners) + " corners");
    }
    for (const Vec2& p : loop) {
      if (std::abs(p.x) <= world_limit_m && std::abs(p.y) <= world_limit_m) continue;
      return faults_.error(part.where, part.label + ": the floor reaches more than 100 km from the origin");
    }
  }
  for (const Loop& loop : part.area.loops()) {
    if (cross(loop, loop)) return faults_.error(part.where, part.label + ": the outline of the floor crosses itself");
  }
  if (part.area.area_m2() < 1e-6) return faults_.error(part.where, part.label + ": the floor has no area");
  parts_.push_back(std::move(part));
}

FloorArea FloorBuilder::build() {
  std::vector<Loop> loops;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    if (std::abs(part.area.height_m() - parts_.front().area.height_m()) > flatness_m) {
      faults_.error(part.where, part.label + " and " + parts_.front().label + " are floors at different heights");
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (overlap(parts_[k].area, part.area)) {
        faults_.error(part.where, part.label + " overlaps the floor of " + parts_[k].label);
      }
    }
    loops.insert(loops.end(), part.area.loops().begin(), part.area.loops().end());
  }
  return {std::move(loops), parts_.empty() ? 0.0 : parts_.front().area.height_m()};
}

}  // namespace pirsim::io::detail
