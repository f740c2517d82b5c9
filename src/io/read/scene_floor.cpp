#include "io/read/scene_parts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "schema/check_specs.hpp"
#include "schema/limits.hpp"

namespace pirsim::io::detail {
namespace {

constexpr double flatness_m = 0.01;  // assumed: less than any step one could trip over

using Loop = std::vector<Vec2>;

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
      if (outlines_cross(a, b)) return true;
    }
  }
  return edge_runs_inside(first, second) || edge_runs_inside(second, first);
}

}  // namespace

bool OutlineReader::flat(const std::vector<Vec3>& points, const Where& where, const std::string& label) {
  const auto [lowest, highest] =
      std::minmax_element(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) { return a.y < b.y; });
  if (highest->y - lowest->y <= flatness_m) return true;
  const auto spans = [&](auto member) {
    const auto [least, most] = std::minmax_element(points.begin(), points.end(),
                                                   [&](const Vec3& a, const Vec3& b) { return a.*member < b.*member; });
    return (*most).*member - (*least).*member;
  };
  const bool upright = std::min(spans(&Vec3::x), spans(&Vec3::z)) <= flatness_m;
  faults_.error(where, label + (what_ == "area" ? ": an area" : ": a floor") + " must be flat and level; this one " +
                           (upright ? "stands upright, as in files that are Z-up (glTF's +Y is up), and " : "") +
                           "rises by " + std::to_string(highest->y - lowest->y) + " m");
  return false;
}

std::optional<FloorArea> OutlineReader::of_mesh(const TriMesh& mesh, const Where& where, const std::string& label) {
  if (mesh.positions.empty()) {
    faults_.error(where, label + ": its mesh has no triangles, so it has no floor area");
    return std::nullopt;
  }
  if (!flat(mesh.positions, where, label)) return std::nullopt;
  try {
    return checked({boundary_loops_xz(mesh), mesh.positions.front().y}, where, label);
  } catch (const Error& fault) {
    faults_.error(where, label + ": " + fault.issues().front().message);
    return std::nullopt;
  }
}

std::optional<FloorArea> OutlineReader::of_polygon(const std::vector<Vec3>& corners, const Where& where,
                                                   const std::string& label) {
  if (!flat(corners, where, label)) return std::nullopt;
  Loop loop;
  for (const Vec3& corner : corners) loop.push_back(floor_point(corner));
  return checked({{std::move(loop)}, corners.front().y}, where, label);
}

std::optional<FloorArea> OutlineReader::checked(FloorArea area, const Where& where, const std::string& label) {
  for (const Loop& loop : area.loops()) n_corners_ += loop.size();
  const std::string fault = n_corners_ > limits::floor_corners ? too_many_corners(what_) : outline_fault(area, what_);
  if (fault.empty()) return area;
  faults_.error(where, label + ": " + fault);
  return std::nullopt;
}

void FloorBuilder::add(FloorArea part, const Where& where, const std::string& label) {
  parts_.push_back({std::move(part), where, label});
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
