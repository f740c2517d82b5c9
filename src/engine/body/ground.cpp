#include "engine/body/ground.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <queue>
#include <string>
#include <utility>

#include "pirsim/error.hpp"

namespace pirsim::body {
namespace {

/// A footprint of less area is a line (m2): what rounding makes of a vertical triangle of a few metres.
constexpr double line_area_m2 = 1e-9;

constexpr double same_line_m = 1e-9;  ///< what rounding makes of points on one line

double cross(const Vec2& a, const Vec2& b) noexcept { return a.x * b.y - a.y * b.x; }

/// Leaves the two ends of a line.
void make_line(Footprint& footprint, const Vec2& along) {
  const auto before = [&](const Vec2& a, const Vec2& b) { return glm::dot(a, along) < glm::dot(b, along); };
  const auto end = footprint.corners.begin() + footprint.n_corners;
  const auto [first, last] = std::minmax_element(footprint.corners.begin(), end, before);
  footprint.corners = {*first, *last};
  footprint.n_corners = 2;
  footprint.lower = glm::min(footprint.corners[0], footprint.corners[1]);
  footprint.upper = glm::max(footprint.corners[0], footprint.corners[1]);
}

/// The direction of a line footprint of any number of corners: from the first corner to the one farthest from it.
Vec2 direction_of_line(const Footprint& footprint) {
  Vec2 longest(0.0);
  for (std::uint32_t i = 1; i < footprint.n_corners; ++i) {
    const Vec2 way = footprint.corners[i] - footprint.corners[0];
    if (glm::dot(way, way) > glm::dot(longest, longest)) longest = way;
  }
  return longest;
}

Footprint seen_from_above(const std::vector<Vec3>& polygon, std::uint32_t mesh) {
  Footprint footprint{.n_corners = static_cast<std::uint32_t>(polygon.size()), .mesh = mesh};
  double twice_area = 0.0;
  footprint.lower = footprint.upper = floor_point(polygon.front());
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 corner = floor_point(polygon[i]);
    footprint.corners[i] = corner;
    footprint.lower = glm::min(footprint.lower, corner);
    footprint.upper = glm::max(footprint.upper, corner);
    if (i >= 2) twice_area += cross(footprint.corners[i - 1] - footprint.corners[0], corner - footprint.corners[0]);
  }
  footprint.covers_area = 0.5 * std::abs(twice_area) > line_area_m2;
  if (!footprint.covers_area) make_line(footprint, direction_of_line(footprint));
  return footprint;
}

/// Two lines of one obstacle that overlap become one: a wall is two triangles, each above most of the same line.
bool join(Footprint& line, const Footprint& next) {
  if (line.covers_area || next.covers_area || line.mesh != next.mesh) return false;
  const Vec2 way = direction_of_line(line);
  const double length = glm::length(way);
  if (length < same_line_m) return false;
  for (const Vec2& p : {next.corners[0], next.corners[1]}) {
    if (std::abs(cross(way, p - line.corners[0])) > same_line_m * length) return false;
  }
  const double a = glm::dot(next.corners[0] - line.corners[0], way),
               b = glm::dot(next.corners[1] - line.corners[0], way);
  if (std::max(a, b) < 0.0 || std::min(a, b) > length * length) return false;
  line.corners[2] = next.corners[0];
  line.corners[3] = next.corners[1];
  line.n_corners = 4;
  make_line(line, way);
  return true;
}

bool contains(const Footprint& footprint, const Vec2& point) noexcept {
  if (!footprint.covers_area) return false;
  bool left = false;
  bool right = false;
  for (std::uint32_t i = 0; i < footprint.n_corners; ++i) {
    const Vec2& a = footprint.corners[i];
    const Vec2& b = footprint.corners[(i + 1) % footprint.n_corners];
    const double side = cross(b - a, point - a);
    left = left || side > 0.0;
    right = right || side < 0.0;
  }
  return !(left && right);
}

double between_edges(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) noexcept {
  const bool crossing =
      cross(b - a, c - a) * cross(b - a, d - a) < 0.0 && cross(d - c, a - c) * cross(d - c, b - c) < 0.0;
  if (crossing) return 0.0;
  return std::min({body::distance(a, c, d), body::distance(b, c, d), body::distance(c, a, b), body::distance(d, a, b)});
}

double octile(int columns, int a, int b) noexcept {
  const int across = std::abs(a % columns - b % columns);
  const int along = std::abs(a / columns - b / columns);
  return std::max(across, along) + (std::numbers::sqrt2 - 1.0) * std::min(across, along);
}

std::vector<int> traced_back(const std::vector<int>& parent, int goal) {
  std::vector<int> way;
  for (int cell = goal; cell >= 0; cell = parent[static_cast<std::size_t>(cell)]) way.push_back(cell);
  std::reverse(way.begin(), way.end());
  return way;
}

constexpr double coarse_m = 0.05;  ///< distance of the places at which legs are cut short: half a cell
constexpr double fine_m = 0.005;
constexpr int max_passes = 10;      ///< each pass shortens; in rooms two or three suffice
constexpr double gain_m = 1e-4;     ///< a pass that gains less is the last
constexpr int halvings = 12;        ///< of the length by which a corner is cut off: to a millimetre and below
constexpr double corner_rad = 0.2;  ///< a smaller change of direction isn't cut off. assumed (0.1-0.5)

double length_of(const std::vector<Vec2>& way) {
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) length += glm::distance(way[i - 1], way[i]);
  return length;
}

std::vector<Vec2> subdivided(const std::vector<Vec2>& way, double spacing_m) {
  std::vector<Vec2> points{way.front()};
  for (std::size_t i = 1; i < way.size(); ++i) {
    const int parts = std::max(1, static_cast<int>(std::ceil(glm::distance(way[i - 1], way[i]) / spacing_m)));
    for (int part = 1; part < parts; ++part) {
      points.push_back(way[i - 1] + (way[i] - way[i - 1]) * (static_cast<double>(part) / parts));
    }
    points.push_back(way[i]);
  }
  return points;
}

/// From each point straight to a far one, found by steps that double while they succeed and halve where they don't.
std::vector<Vec2> shortcut(const std::vector<Vec2>& points, const StraightWay& straight) {
  std::vector<Vec2> kept{points.front()};
  for (std::size_t i = 0; i + 1 < points.size();) {
    std::size_t next = i + 1;
    for (std::size_t step = 1; step > 0;) {
      const bool reached = next + step < points.size() && straight(points[i], points[next + step]);
      if (reached) next += step;
      step = reached ? 2 * step : step / 2;
    }
    kept.push_back(points[next]);
    i = next;
  }
  return kept;
}

/// How much of the corner between a and b can be cut off, measured along either leg.
double cut_m(const Vec2& a, const Vec2& corner, const Vec2& b, const StraightWay& straight) {
  const double turn = std::remainder(heading_of(b - corner) - heading_of(corner - a), 2.0 * std::numbers::pi);
  if (std::abs(turn) < corner_rad) return 0.0;
  const Vec2 to_a = glm::normalize(a - corner);
  const Vec2 to_b = glm::normalize(b - corner);
  double cut = 0.0;
  // Half of the shorter leg at most: the other half belongs to the corner at its other end.
  double step = 0.25 * std::min(glm::distance(a, corner), glm::distance(corner, b));
  for (int i = 0; i < halvings; ++i, step *= 0.5) {
    if (straight(corner + to_a * (cut + step), corner + to_b * (cut + step))) cut += step;
  }
  return cut;
}

/// Two corners of half the angle instead of each one.
std::vector<Vec2> corners_cut_off(const std::vector<Vec2>& way, const StraightWay& straight) {
  std::vector<Vec2> result{way.front()};
  for (std::size_t i = 1; i + 1 < way.size(); ++i) {
    const double cut = cut_m(way[i - 1], way[i], way[i + 1], straight);
    if (cut > 0.0) {
      result.push_back(way[i] + glm::normalize(way[i - 1] - way[i]) * cut);
      result.push_back(way[i] + glm::normalize(way[i + 1] - way[i]) * cut);
    } else {
      result.push_back(way[i]);
    }
  }
  result.push_back(way.back());
  return result;
}

constexpr double cell_m = FloorCells::side_m;
constexpr double max_cells = 2.5e7;  ///< assumed: an airport's hall of 1.2 km x 200 m just fits, in some 500 MB
/// How far the strip of an entrance reaches into the room. assumed: more than the depth of a door's reveal (0.1-0.5).
constexpr double strip_inside_m = 0.5;
/// How far the strip goes on behind the place where people wait. assumed: a body's length of room (0.3-1 m).
constexpr double strip_beyond_m = 0.5;

/// The way in and out through one entrance, a rectangle in the entrance's frame.
struct Strip {
  Frame entrance_from_world;
  double half_width_m;
  double outside_m;

  [[nodiscard]] bool contains(const Vec2& point, double height_m) const {
    const Vec3 p = entrance_from_world * Vec3(point.x, height_m, point.y);
    return std::abs(p.x) <= half_width_m && p.z >= -strip_inside_m && p.z <= outside_m + strip_beyond_m;
  }
};

bool finite(const Vec2& p) noexcept { return std::isfinite(p.x) && std::isfinite(p.y); }

void lay(FloorCells& grid, const FloorArea& floor, std::span<const EntranceSpec> entrances) {
  std::vector<Strip> strips;
  Vec2 least(std::numeric_limits<double>::infinity());
  Vec2 most = -least;
  const auto reach_to = [&](const Vec2& p) { least = glm::min(least, p), most = glm::max(most, p); };
  if (!floor.empty()) reach_to(floor.lower()), reach_to(floor.upper());
  for (const EntranceSpec& entrance : entrances) {
    strips.push_back({inverse(entrance.world_from_entrance), 0.5 * entrance.width_m, entrance.outside_m});
    for (const double x : {-0.5 * entrance.width_m, 0.5 * entrance.width_m}) {
      for (const double z : {-strip_inside_m, entrance.outside_m + strip_beyond_m}) {
        reach_to(floor_point(entrance.world_from_entrance * Vec3(x, 0.0, z)));
      }
    }
  }
  if (!finite(least) || !finite(most)) return;
  // The grid is centred on what it covers, so that a mirrored room has a mirrored grid.
  const Vec2 cells = glm::max(glm::ceil((most - least) / cell_m - rounding_m), Vec2(1.0));
  if (cells.x * cells.y > max_cells) {
    const auto whole = [](double metres) { return std::to_string(std::llround(metres)); };
    throw Error(ErrorCode::infeasible, "the floor and its entrances span " + whole(most.x - least.x) + " m x " +
                                           whole(most.y - least.y) +
                                           " m: too large to find ways on (glTF's unit is the metre)");
  }
  grid.lower = 0.5 * (least + most) - 0.5 * cell_m * cells;
  grid.columns = static_cast<int>(cells.x);
  grid.rows = static_cast<int>(cells.y);
  grid.on_floor.reserve(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Vec2 p = grid.centre(column, row);
      const bool on_strip = std::any_of(strips.begin(), strips.end(),
                                        [&](const Strip& strip) { return strip.contains(p, floor.height_m()); });
      grid.on_floor.push_back(on_strip || floor.contains(p) ? 1 : 0);
    }
  }
}

constexpr double lead_m = 0.5;  ///< how far a start or goal may be from a walkable cell

double disc_distance(const Vec2& a, const Vec2& b, const Disc& disc) noexcept {
  return distance(disc.centre, a, b) - disc.radius_m;
}

}  // namespace

std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, double height, double side) {
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[(i + 1) % polygon.size()];
    const double da = side * (a.y - height);
    const double db = side * (b.y - height);
    if (da >= 0.0) kept.push_back(a);
    if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) kept.push_back(glm::mix(a, b, da / (da - db)));
  }
  return kept;
}

std::vector<Footprint> footprints(std::span<const TriMesh> meshes, double lower_m, double upper_m) {
  constexpr double touching_m = 1e-3;  // what rounding makes of a lintel that begins where the heights end
  std::vector<Footprint> result;
  for (std::uint32_t mesh = 0; mesh < meshes.size(); ++mesh) {
    if (meshes[mesh].solidity == Solidity::screen) continue;
    const std::vector<Vec3>& positions = meshes[mesh].positions;
    for (const auto& [a, b, c] : meshes[mesh].triangles) {
      const std::vector<Vec3> triangle{positions[a], positions[b], positions[c]};
      const std::vector<Vec3> slab = clipped(clipped(triangle, lower_m, 1.0), upper_m, -1.0);
      const auto is_above = [&](const Vec3& p) { return p.y >= upper_m - touching_m; };
      if (slab.empty() || std::ranges::all_of(triangle, is_above)) continue;
      const Footprint footprint = seen_from_above(slab, mesh);
      if (result.empty() || !join(result.back(), footprint)) result.push_back(footprint);
    }
  }
  return result;
}

double distance(const Vec2& point, const Vec2& a, const Vec2& b) noexcept {
  const Vec2 ab = b - a;
  const double length2 = glm::dot(ab, ab);
  const double t = length2 > 0.0 ? std::clamp(glm::dot(point - a, ab) / length2, 0.0, 1.0) : 0.0;
  return glm::distance(point, a + t * ab);
}

double distance(const Vec2& point, const Footprint& footprint) noexcept {
  if (contains(footprint, point)) return 0.0;
  if (!footprint.covers_area) return distance(point, footprint.corners[0], footprint.corners[1]);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < footprint.n_corners; ++i) {
    const Vec2& next = footprint.corners[(i + 1) % footprint.n_corners];
    nearest = std::min(nearest, distance(point, footprint.corners[i], next));
  }
  return nearest;
}

double distance(const Vec2& a, const Vec2& b, const Footprint& footprint) noexcept {
  if (contains(footprint, a)) return 0.0;
  if (!footprint.covers_area) return between_edges(a, b, footprint.corners[0], footprint.corners[1]);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < footprint.n_corners; ++i) {
    const Vec2& next = footprint.corners[(i + 1) % footprint.n_corners];
    nearest = std::min(nearest, between_edges(a, b, footprint.corners[i], next));
  }
  return nearest;
}

double distance_bound(const Vec2& a, const Vec2& b, const Footprint& footprint) noexcept {
  const double right = std::min(a.x, b.x) - footprint.upper.x;
  const double left = footprint.lower.x - std::max(a.x, b.x);
  const double behind = std::min(a.y, b.y) - footprint.upper.y;
  const double before = footprint.lower.y - std::max(a.y, b.y);
  return std::max({right, left, behind, before});
}

Obstacles::Obstacles(std::vector<Footprint> footprints) : footprints_(std::move(footprints)) {
  if (footprints_.empty()) return;
  Vec2 lower = footprints_.front().lower, upper = footprints_.front().upper;
  for (const Footprint& footprint : footprints_) {
    lower = glm::min(lower, footprint.lower);
    upper = glm::max(upper, footprint.upper);
  }
  corner_ = lower;
  // Larger squares where footprints are large, so that the table grows with their number alone.
  constexpr double most_squares_each = 16.0;
  const auto n_touched = [&](const Vec2& size) { return (size.x / side_m_ + 1.0) * (size.y / side_m_ + 1.0); };
  for (;; side_m_ *= 2.0) {
    double n = n_touched(upper - lower);
    for (const Footprint& footprint : footprints_) n += n_touched(footprint.upper - footprint.lower);
    if (n <= most_squares_each * static_cast<double>(footprints_.size()) + 4096.0) break;
  }
  n_columns_ = static_cast<std::size_t>((upper.x - lower.x) / side_m_) + 1;
  n_rows_ = static_cast<std::size_t>((upper.y - lower.y) / side_m_) + 1;
  begins_.assign(n_columns_ * n_rows_ + 1, 0);
  for (const Footprint& footprint : footprints_) each_square(footprint, [&](std::size_t at) { ++begins_[at + 1]; });
  for (std::size_t i = 1; i < begins_.size(); ++i) begins_[i] += begins_[i - 1];
  indices_.resize(begins_.back());
  std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
  for (std::uint32_t i = 0; i < footprints_.size(); ++i) {
    each_square(footprints_[i], [&](std::size_t at) { indices_[next[at]++] = i; });
  }
}

template <class Visit>
void Obstacles::each_square(const Footprint& footprint, const Visit& visit) const {
  for (std::size_t row = row_of(footprint.lower.y); row <= row_of(footprint.upper.y); ++row) {
    for (std::size_t column = column_of(footprint.lower.x); column <= column_of(footprint.upper.x); ++column) {
      visit(row * n_columns_ + column);
    }
  }
}

Obstacles::Interval Obstacles::crossing(const Vec2& a, const Vec2& b, std::size_t row, double reach) const noexcept {
  if (a.y == b.y) return {std::min(a.x, b.x), std::max(a.x, b.x)};
  const double begin = corner_.y + side_m_ * static_cast<double>(row);
  const auto x_at = [&](double z) { return a.x + std::clamp((z - a.y) / (b.y - a.y), 0.0, 1.0) * (b.x - a.x); };
  const double first = x_at(begin - reach), last = x_at(begin + side_m_ + reach);
  return {std::min(first, last), std::max(first, last)};
}

bool Obstacles::clear(const Vec2& a, const Vec2& b, double keep_m) const noexcept {
  const double limit = keep_m - rounding_m;
  return !any_near(a, b, keep_m, [&](const Footprint& footprint) {
    return distance_bound(a, b, footprint) < limit && distance(a, b, footprint) < limit;
  });
}

std::vector<int> shortest_way(const StepGrid& grid, int start, int goal) {
  using Entry = std::pair<double, int>;  // estimate of the whole way, cell: orders ties by the cell's index
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> frontier;
  std::vector<double> cost(grid.open.size(), std::numeric_limits<double>::infinity());
  std::vector<int> parent(grid.open.size(), -1);
  std::vector<std::uint8_t> done(grid.open.size(), 0);
  cost[static_cast<std::size_t>(start)] = 0.0;
  frontier.emplace(octile(grid.columns, start, goal), start);
  while (!frontier.empty()) {
    const int cell = frontier.top().second;
    frontier.pop();
    if (cell == goal) return traced_back(parent, goal);
    if (std::exchange(done[static_cast<std::size_t>(cell)], std::uint8_t{1}) != 0) continue;
    for (int direction = 0; direction < n_directions; ++direction) {
      if (!grid.is_open(cell, direction)) continue;
      const int next = grid.neighbour(cell, direction);
      const auto at = static_cast<std::size_t>(next);
      const double through = cost[static_cast<std::size_t>(cell)] + (direction % 2 == 0 ? 1.0 : std::numbers::sqrt2);
      if (through >= cost[at]) continue;
      cost[at] = through;
      parent[at] = cell;
      frontier.emplace(through + octile(grid.columns, next, goal), next);
    }
  }
  return {};
}

std::vector<int> connected_parts(const StepGrid& grid) {
  std::vector<int> label(grid.open.size(), -1);
  std::vector<int> pending;
  for (int seed = 0; seed < static_cast<int>(label.size()); ++seed) {
    if (label[static_cast<std::size_t>(seed)] >= 0) continue;
    label[static_cast<std::size_t>(seed)] = seed;
    pending.push_back(seed);
    while (!pending.empty()) {
      const int cell = pending.back();
      pending.pop_back();
      for (int direction = 0; direction < n_directions; ++direction) {
        if (!grid.is_open(cell, direction)) continue;
        const int next = grid.neighbour(cell, direction);
        if (label[static_cast<std::size_t>(next)] >= 0) continue;
        label[static_cast<std::size_t>(next)] = seed;
        pending.push_back(next);
      }
    }
  }
  return label;
}

std::vector<Vec2> pulled_tight(std::vector<Vec2> way, const StraightWay& straight) {
  if (way.size() < 3) return way;
  // Coarse first, because the way over the cells has many corners, then fine.
  for (const double spacing_m : {coarse_m, fine_m}) {
    for (int pass = 0; pass < max_passes; ++pass) {
      const double before = length_of(way);
      for (int direction = 0; direction < 2; ++direction) {
        way = shortcut(subdivided(way, spacing_m), straight);
        std::reverse(way.begin(), way.end());
      }
      if (before - length_of(way) < gain_m) break;
    }
  }
  return corners_cut_off(way, straight);
}

int FloorCells::column_of(double x) const noexcept {
  return static_cast<int>(std::floor(std::clamp((x - lower.x) / side_m, -1.0, static_cast<double>(columns))));
}
int FloorCells::row_of(double z) const noexcept {
  return static_cast<int>(std::floor(std::clamp((z - lower.y) / side_m, -1.0, static_cast<double>(rows))));
}

bool FloorCells::floor_at(int column, int row) const noexcept {
  if (column < 0 || column >= columns || row < 0 || row >= rows) return false;
  return on_floor[static_cast<std::size_t>(row * columns + column)] != 0;
}

bool FloorCells::floor_along(const Vec2& a, const Vec2& b) const noexcept {
  if (!finite(a) || !finite(b)) return false;
  int column = column_of(a.x);
  int row = row_of(a.y);
  if (!floor_at(column, row)) return false;
  const Vec2 way = b - a;
  const int side_x = way.x > 0.0 ? 1 : -1;
  const int side_z = way.y > 0.0 ? 1 : -1;
  int left_x = std::abs(column_of(b.x) - column);
  int left_z = std::abs(row_of(b.y) - row);
  // The share of the way at which the next border in x and in z is crossed.
  double next_x = left_x == 0 ? 2.0 : (lower.x + side_m * (column + (side_x > 0 ? 1 : 0)) - a.x) / way.x;
  double next_z = left_z == 0 ? 2.0 : (lower.y + side_m * (row + (side_z > 0 ? 1 : 0)) - a.y) / way.y;
  while (left_x + left_z > 0) {
    if (left_z == 0 || (left_x > 0 && next_x < next_z)) {
      column += side_x;
      next_x += side_m / std::abs(way.x);
      --left_x;
    } else {
      row += side_z;
      next_z += side_m / std::abs(way.y);
      --left_z;
    }
    if (!floor_at(column, row)) return false;
  }
  return true;
}

Ground::Ground(const FloorArea& floor, std::span<const EntranceSpec> entrances, std::span<const TriMesh> meshes,
               double reach_m) {
  auto cells = std::make_shared<FloorCells>();
  cells->n_meshes = meshes.size();
  cells->obstacles = Obstacles(footprints(meshes, floor.height_m() + solid_from_m, floor.height_m() + solid_to_m));
  lay(*cells, floor, entrances);
  cells_ = std::move(cells);
  measure_cells(reach_m + 2.0 * cell_m);  // a step may begin beyond and come near on its way
  measure_steps(reach_m);
}

void Ground::measure_cells(double reach_m) {
  room_m_.assign(cells_->on_floor.size(), std::numeric_limits<double>::infinity());
  for (const Footprint& obstacle : cells_->obstacles.all()) {
    cells_->each_near(obstacle.lower, obstacle.upper, reach_m, [&](int cell) {
      double& room = room_m_[static_cast<std::size_t>(cell)];
      const Vec2 centre = cells_->centre(cell);
      if (distance_bound(centre, centre, obstacle) < room) room = std::min(room, distance(centre, obstacle));
    });
  }
}

/// Both ends of a step between walkable cells have room; what is left to know is where it passes a corner.
void Ground::measure_steps(double reach_m) {
  for (int row = 0; row < cells_->rows; ++row) {
    for (int column = 0; column < cells_->columns; ++column) {
      const double room_here_m = room_at(column, row);
      if (room_here_m <= 0.0 || room_here_m > reach_m + 2.0 * cell_m) continue;
      for (int direction = 0; direction < n_directions / 2; ++direction) {
        const Step step = steps[static_cast<std::size_t>(direction)];
        if (!cells_->floor_at(column, row) || !cells_->floor_at(column + step.column, row + step.row)) continue;
        const double at_ends_m = std::min(room_here_m, room_at(column + step.column, row + step.row));
        const double room_m =
            room_between(cells_->centre(column, row), cells_->centre(column + step.column, row + step.row), reach_m);
        if (room_m < at_ends_m) narrow_steps_.push_back({row * cells_->columns + column, direction, room_m});
      }
    }
  }
}

/// Infinite beyond the reach.
double Ground::room_between(const Vec2& a, const Vec2& b, double reach_m) const {
  double room_m = std::numeric_limits<double>::infinity();
  (void)cells_->obstacles.any_near(a, b, reach_m, [&](const Footprint& obstacle) {
    // Rounding may tell the two ways apart; a step is taken both ways or not at all.
    if (distance_bound(a, b, obstacle) < std::min(room_m, reach_m))
      room_m = std::min({room_m, distance(a, b, obstacle), distance(b, a, obstacle)});
    return false;
  });
  return room_m;
}

std::vector<std::uint8_t> Ground::open_cells(double clearance_m) const {
  std::vector<std::uint8_t> open = cells_->on_floor;
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (room_m_[i] < clearance_m - rounding_m) open[i] = 0;
  }
  return open;
}

StepGrid Ground::steps_between(std::span<const std::uint8_t> open, double clearance_m) const {
  StepGrid grid{cells_->columns, cells_->rows, std::vector<std::uint8_t>(open.size(), 0)};
  const auto is_open = [&](int column, int row) {
    return column >= 0 && column < grid.columns && row >= 0 && row < grid.rows &&
           open[static_cast<std::size_t>(row * grid.columns + column)] != 0;
  };
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (!is_open(column, row)) continue;
      for (int direction = 0; direction < n_directions; ++direction) {
        const Step step = steps[static_cast<std::size_t>(direction)];
        // A diagonal step needs both cells that it passes between.
        if (is_open(column + step.column, row + step.row) && is_open(column + step.column, row) &&
            is_open(column, row + step.row)) {
          grid.open[static_cast<std::size_t>(row * grid.columns + column)] |=
              static_cast<std::uint8_t>(1U << direction);
        }
      }
    }
  }
  for (const NarrowStep& step : narrow_steps_) {
    if (step.room_m < clearance_m - rounding_m) grid.close(step.cell, step.direction);
  }
  return grid;
}

struct WalkableFloor::Impl {
  double clearance_m = 0.0;
  std::shared_ptr<const FloorCells> cells;
  std::vector<std::uint8_t> open;  ///< (rows x columns) 1 where the cell is walkable
  StepGrid grid;
  std::vector<int> parts;  ///< (rows x columns) labels of cells that are connected

  [[nodiscard]] StepGrid grid_around(std::span<const Disc> others) const;
  [[nodiscard]] bool clear(const Vec2& a, const Vec2& b, std::span<const Disc> others) const noexcept;
  [[nodiscard]] bool walkable(const Vec2& a, const Vec2& b, std::span<const Disc> others) const noexcept {
    return cells->floor_along(a, b) && clear(a, b, others);
  }
  /// Whether one can go from a point to a cell near it.
  class Lead;
  struct Ends {
    int start, goal;
  };
  /// The cells near `from` and `to` between which a way over the grid leads. labels: its parts.
  [[nodiscard]] std::optional<Ends> ends(std::span<const int> labels, const Vec2& from, const Vec2& to,
                                         std::span<const Disc> others) const;
  /// find_way() where one can't go straight; labels: the parts of `grid_left`.
  [[nodiscard]] WayMemory::Way way_over(const StepGrid& grid_left, std::span<const int> labels, const Vec2& from,
                                        const Vec2& to, std::span<const Disc> others) const;
  [[nodiscard]] std::vector<int> cells_near(const Vec2& point) const;
  [[nodiscard]] std::vector<double> mesh_distances(const Vec2& point) const;
};

StepGrid WalkableFloor::Impl::grid_around(std::span<const Disc> others) const {
  StepGrid left = grid;
  for (const Disc& disc : others) {
    const auto too_near = [&](int cell, int direction) {
      return disc_distance(cells->centre(cell), cells->centre(left.neighbour(cell, direction)), disc) <
             clearance_m - rounding_m;
    };
    cells->each_near(disc.centre - disc.radius_m, disc.centre + disc.radius_m, clearance_m + WalkableFloor::cell_m,
                     [&](int cell) {
                       for (int direction = 0; direction < n_directions; ++direction) {
                         if (left.is_open(cell, direction) && too_near(cell, direction)) left.close(cell, direction);
                       }
                     });
  }
  return left;
}

bool WalkableFloor::Impl::clear(const Vec2& a, const Vec2& b, std::span<const Disc> others) const noexcept {
  const double limit = clearance_m - rounding_m;
  for (const Disc& disc : others) {
    if (disc_distance(a, b, disc) < limit) return false;
  }
  return cells->obstacles.clear(a, b, clearance_m);
}

/// Walkable cells within lead_m of the point, nearest first, ties by index.
std::vector<int> WalkableFloor::Impl::cells_near(const Vec2& point) const {
  std::vector<std::pair<double, int>> found;
  cells->each_near(point, point, lead_m, [&](int cell) {
    const double away = glm::distance(point, cells->centre(cell));
    if (open[static_cast<std::size_t>(cell)] != 0 && away <= lead_m) found.emplace_back(away, cell);
  });
  std::sort(found.begin(), found.end());
  std::vector<int> nearest;
  for (const auto& [away, cell] : found) nearest.push_back(cell);
  return nearest;
}

/// How far the point is from each mesh, clearance_m at most: what a lead from there has to keep.
std::vector<double> WalkableFloor::Impl::mesh_distances(const Vec2& point) const {
  std::vector<double> distances(cells->n_meshes, clearance_m);
  (void)cells->obstacles.any_near(point, point, clearance_m, [&](const Footprint& obstacle) {
    double& nearest = distances[obstacle.mesh];
    if (distance_bound(point, point, obstacle) < nearest) nearest = std::min(nearest, distance(point, obstacle));
    return false;
  });
  return distances;
}

/// Straight, and without coming nearer to a mesh or another person than the point is, as far as it is within their
/// clearance.
class WalkableFloor::Impl::Lead {
 public:
  Lead(const Impl& floor, const Vec2& point, std::span<const Disc> others)
      : floor_(floor),
        point_(point),
        others_(others),
        kept_(floor.mesh_distances(point)),
        starts_on_floor_(floor.cells->floor_along(point, point)) {}

  [[nodiscard]] bool is_open(int cell) const {
    const Vec2 end = floor_.cells->centre(cell);
    if (starts_on_floor_ && !floor_.cells->floor_along(point_, end)) return false;
    for (const Disc& disc : others_) {
      const double keep = std::min(disc_distance(point_, point_, disc), floor_.clearance_m);
      if (disc_distance(end, end, disc) < floor_.clearance_m - rounding_m) return false;
      if (disc_distance(point_, end, disc) < keep - rounding_m) return false;
    }
    return !floor_.cells->obstacles.any_near(point_, end, floor_.clearance_m, [&](const Footprint& obstacle) {
      const double keep = kept_[obstacle.mesh] - rounding_m;
      return distance_bound(point_, end, obstacle) < keep && distance(point_, end, obstacle) < keep;
    });
  }

 private:
  const Impl& floor_;
  Vec2 point_;
  std::span<const Disc> others_;
  std::vector<double> kept_;
  bool starts_on_floor_;
};

std::optional<WalkableFloor::Impl::Ends> WalkableFloor::Impl::ends(std::span<const int> labels, const Vec2& from,
                                                                   const Vec2& to, std::span<const Disc> others) const {
  const auto part_of = [&](int cell) { return labels[static_cast<std::size_t>(cell)]; };
  const std::vector<int> starts = cells_near(from), goals = cells_near(to);
  const Lead from_start(*this, from, others), to_goal(*this, to, others);
  std::vector<int> left;  // parts that one can get to from the start, but not to the goal
  for (const int start : starts) {
    if (std::ranges::find(left, part_of(start)) != left.end() || !from_start.is_open(start)) continue;
    const auto goal =
        std::ranges::find_if(goals, [&](int cell) { return part_of(cell) == part_of(start) && to_goal.is_open(cell); });
    if (goal != goals.end()) return Ends{start, *goal};
    left.push_back(part_of(start));
  }
  return std::nullopt;
}

WalkableFloor::WalkableFloor(const Ground& ground, double clearance_m) : known_ways_(std::make_shared<WayMemory>()) {
  auto impl = std::make_shared<Impl>();
  impl->clearance_m = clearance_m;
  impl->cells = ground.cells();
  impl->open = ground.open_cells(clearance_m);
  impl->grid = ground.steps_between(impl->open, clearance_m);
  impl->parts = connected_parts(impl->grid);
  impl_ = std::move(impl);
}

WalkableFloor::WalkableFloor(const FloorArea& floor, std::span<const EntranceSpec> entrances,
                             std::span<const TriMesh> obstacles, double clearance_m)
    : WalkableFloor(Ground(floor, entrances, obstacles, clearance_m), clearance_m) {}

bool WalkableFloor::walkable(const Vec2& point) const noexcept { return impl_->walkable(point, point, {}); }
bool WalkableFloor::walkable(const Vec2& a, const Vec2& b, std::span<const Disc> others) const noexcept {
  return impl_->walkable(a, b, others);
}

double WalkableFloor::clearance_m() const noexcept { return impl_->clearance_m; }

bool WalkableFloor::has_room(const Vec2& a, const Vec2& b, double clearance_m) const noexcept {
  return impl_->cells->floor_along(a, b) && impl_->cells->obstacles.clear(a, b, clearance_m);
}

WayMemory::Way WalkableFloor::Impl::way_over(const StepGrid& grid_left, std::span<const int> labels, const Vec2& from,
                                             const Vec2& to, std::span<const Disc> others) const {
  const auto found = ends(labels, from, to, others);
  if (!found) return std::nullopt;
  // An end that isn't walkable keeps its lead; everything else is pulled tight.
  std::vector<Vec2> way;
  if (walkable(from, from, others)) way.push_back(from);
  for (const int cell : shortest_way(grid_left, found->start, found->goal)) way.push_back(cells->centre(cell));
  if (walkable(to, to, others)) way.push_back(to);
  way = pulled_tight(std::move(way), [&](const Vec2& a, const Vec2& b) { return walkable(a, b, others); });
  if (way.front() != from) way.insert(way.begin(), from);
  if (way.back() != to) way.push_back(to);
  return way;
}

std::shared_ptr<const StepsLeft> WalkableFloor::steps_left(std::span<const Disc> others) const {
  WayMemory::Others key;
  for (const Disc& disc : others) key.push_back({disc.centre.x, disc.centre.y, disc.radius_m});
  return known_ways_->left_by(std::move(key), [&] {
    StepGrid grid = impl_->grid_around(others);
    std::vector<int> parts = connected_parts(grid);
    return StepsLeft{std::move(grid), std::move(parts)};
  });
}

std::optional<std::vector<Vec2>> WalkableFloor::find_way(const Vec2& from, const Vec2& to,
                                                         std::span<const Disc> others) const {
  if (!finite(from) || !finite(to)) return std::nullopt;
  if (from == to || walkable(from, to, others)) return std::vector<Vec2>{from, to};
  if (others.empty()) {
    return known_ways_->way(from, to, [&] { return impl_->way_over(impl_->grid, impl_->parts, from, to, {}); });
  }
  const auto left = steps_left(others);
  return impl_->way_over(left->grid, left->parts, from, to, others);
}

bool WalkableFloor::has_way(const Vec2& from, const Vec2& to, std::span<const Disc> others) const {
  if (!finite(from) || !finite(to)) return false;
  if (from == to || walkable(from, to, others)) return true;
  if (others.empty()) return impl_->ends(impl_->parts, from, to, {}).has_value();
  return impl_->ends(steps_left(others)->parts, from, to, others).has_value();
}

}  // namespace pirsim::body
