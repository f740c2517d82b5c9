#include "surveys/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "engine/rt/renderer.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/sim/observer.hpp"
#include "engine/sim/run_state.hpp"
#include "files/write/gltf_writer.hpp"
#include "model/geom/floor.hpp"
#include "model/geom/mesh.hpp"
#include "model/schema/door_leaf.hpp"
#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"
#include "show/png.hpp"

namespace pirsim::studies {
namespace {

/// (n_positions) of a mesh: pieces that share no corner have different numbers.
std::vector<std::size_t> pieces_of(const TriMesh& mesh) {
  std::vector<std::size_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::map<std::tuple<double, double, double>, std::size_t> at;  // corners at one place are one
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3& p = mesh.positions[i];
    parent[root(i)] = root(at.try_emplace({p.x, p.y, p.z}, i).first->second);
  }
  for (const auto& triangle : mesh.triangles) {
    parent[root(triangle[1])] = root(triangle[0]);
    parent[root(triangle[2])] = root(triangle[0]);
  }
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = root(i);
  return parent;
}

/// Andrew's monotone chain.
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::ranges::sort(points, {}, [](const Vec2& p) { return std::pair(p.x, p.y); });
  std::vector<Vec2> hull;
  const auto chain = [&](auto first, auto last) {
    const std::size_t begin = hull.size();
    for (auto p = first; p != last; ++p) {
      const auto turns_left = [&] {
        const Vec2 a = hull.back() - hull[hull.size() - 2], b = *p - hull.back();
        return a.x * b.y - a.y * b.x > 0.0;
      };
      while (hull.size() >= begin + 2 && !turns_left()) hull.pop_back();
      hull.push_back(*p);
    }
    if (!hull.empty()) hull.pop_back();
  };
  chain(points.begin(), points.end());
  chain(points.rbegin(), points.rend());
  return hull;
}

void add_pieces(const TriMesh& mesh, std::vector<std::vector<Vec2>>& polygons) {
  const std::vector<std::size_t> pieces = pieces_of(mesh);
  std::map<std::size_t, std::vector<Vec2>> points;
  for (std::size_t i = 0; i < pieces.size(); ++i) points[pieces[i]].push_back(floor_point(mesh.positions[i]));
  for (auto& [piece, corners] : points) {
    std::vector<Vec2> hull = convex_hull(std::move(corners));
    if (hull.size() >= 3) polygons.push_back(std::move(hull));
  }
}

void add_wall(const TriMesh& mesh, double floor_height_m, io::RoomPlan& plan) {
  constexpr double cut_m = 1.0, thickest_m = 0.6;
  MeshSection section = section_of(mesh, floor_height_m + cut_m);
  if (mean_thickness_m(section.loops) <= thickest_m) {
    if (!section.loops.empty()) plan.walls.push_back(std::move(section.loops));
  } else {  // a shell round the room
    for (std::vector<Vec2>& loop : section.loops) {
      loop.push_back(loop.front());
      plan.wall_lines.push_back(std::move(loop));
    }
  }
  std::ranges::move(section.lines, std::back_inserter(plan.wall_lines));
}

struct MeshLook {
  rt::Surface surface;
  rt::Colour colour;
};

/// Walls are cut away towards the camera.
MeshLook look_of(const TriMesh& mesh, double floor_y) {
  switch (role_of(mesh, floor_y)) {
    case MeshRole::ceiling:
      return {rt::Surface::hidden, {0.9F, 0.9F, 0.9F}};
    case MeshRole::wall:
      return {rt::Surface::see_through, {0.82F, 0.84F, 0.86F}};
    case MeshRole::floor:
      return {rt::Surface::opaque, {0.60F, 0.57F, 0.53F}};
    case MeshRole::furniture:
      break;
  }
  return {rt::Surface::opaque, {0.55F, 0.36F, 0.20F}};
}

rt::Colour shirt_of(std::size_t person) {
  const Vec3f colour(io::person_colour(person));
  return {colour.r, colour.g, colour.b};
}

rt::Colour colour_of(body::Part part, std::size_t person) {
  switch (part) {
    case body::Part::head:
    case body::Part::left_forearm:
    case body::Part::right_forearm:
      return {0.78F, 0.50F, 0.36F};
    case body::Part::torso:
    case body::Part::left_upper_arm:
    case body::Part::right_upper_arm:
      return shirt_of(person);
    case body::Part::left_foot:
    case body::Part::right_foot:
      return {0.05F, 0.05F, 0.06F};
    default:
      return {0.14F, 0.15F, 0.20F};
  }
}

/// A part of the picture, in pixels; y runs down.
using io::PixelBox;

/// The corners of what is to be seen: the floor with its walls, and the names above them.
std::vector<Vec3> corners_of(const SceneSpec& scene) {
  constexpr double least_m = 2.0, most_m = 4.0, thickest_m = 0.6, name_m = 0.2;
  const double y = scene.floor.height_m();
  const Vec2 least = scene.floor.lower(), most = scene.floor.upper();
  Vec3 lower(least.x, y, least.y), upper(most.x, y + least_m, most.y);
  for (const TriMesh& mesh : scene.meshes) {
    if (role_of(mesh, y) != MeshRole::wall) continue;
    for (const Vec3& p : mesh.positions) {
      lower = glm::min(lower, glm::max(p, Vec3(least.x - thickest_m, y, least.y - thickest_m)));
      upper = glm::max(upper, glm::min(p, Vec3(most.x + thickest_m, y + most_m, most.y + thickest_m)));
    }
  }
  upper.y += name_m;
  std::vector<Vec3> corners;
  for (unsigned i = 0; i < 8; ++i) {
    corners.emplace_back((i & 1U) != 0 ? upper.x : lower.x, (i & 2U) != 0 ? upper.y : lower.y,
                         (i & 4U) != 0 ? upper.z : lower.z);
  }
  return corners;
}

/// From above and beside, as near as the points fit into a part of the picture.
rt::Camera camera_that_holds(const std::vector<Vec3>& points, const PixelBox& part, const PictureSpec& spec) {
  const Vec3 back = glm::normalize(Vec3(-0.55, 0.85, -1.0));
  const double half_height = 0.5 * spec.height, fov = radians(spec.field_of_view_deg);
  const double pixels_per_tangent = half_height / std::tan(0.5 * fov);
  const Vec3 right = glm::normalize(glm::cross(-back, Vec3(0, 1, 0))), up = glm::cross(right, -back);
  // A point at p is seen at the tangent (p - c) / (d - p_back), where c and d are the camera's place across and back.
  // So c + high d >= p + high p_back and c + low d <= p + low p_back, for the tangents of the part's edges.
  struct Axis {
    Vec3 across;
    double low, high;                 ///< tangents
    double least = -1e9, most = 1e9;  ///< of c + high d, and of c + low d
  };
  Axis x{right, (part.lower.x - 0.5 * spec.width) / pixels_per_tangent,
         (part.upper.x - 0.5 * spec.width) / pixels_per_tangent};
  Axis y{up, (half_height - part.upper.y) / pixels_per_tangent, (half_height - part.lower.y) / pixels_per_tangent};
  double away = 0.0;
  for (Axis* axis : {&x, &y}) {
    for (const Vec3& p : points) {
      const double at = glm::dot(p, axis->across), nearer = glm::dot(p, back);
      axis->least = std::max(axis->least, at + axis->high * nearer);
      axis->most = std::min(axis->most, at + axis->low * nearer);
    }
    away = std::max(away, (axis->least - axis->most) / (axis->high - axis->low));
  }
  Vec3 position = away * back, middle(0.0);
  for (const Axis* axis : {&x, &y})
    position += axis->across * 0.5 * (axis->least - axis->high * away + axis->most - axis->low * away);
  for (const Vec3& p : points) middle += p / static_cast<double>(points.size());
  return {position, position - back * glm::dot(position - middle, back), fov};
}

/// A camera that the user has placed.
void require_usable(const rt::Camera& camera) {
  constexpr double farthest_m = 1e5;
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(camera.position[i]) < farthest_m) || !(std::abs(camera.target[i]) < farthest_m)) {
      throw Error(ErrorCode::usage, "--camera and --look-at: expected coordinates in metres");
    }
  }
  if (glm::length(camera.target - camera.position) < 1e-6) {
    throw Error(ErrorCode::usage, "--camera and --look-at: the camera stands in the very point it looks at");
  }
}

constexpr rt::Colour idle_beam{0.10F, 0.45F, 0.75F}, seeing_beam{0.90F, 0.02F, 0.02F};
constexpr rt::Colour leaf_colour{0.62F, 0.50F, 0.36F}, seat_colour{0.55F, 0.10F, 0.55F},
    door_colour{0.05F, 0.45F, 0.12F}, area_colour{0.02F, 0.38F, 0.42F}, scale_colour{0.05F, 0.05F, 0.06F};

/// A text beside a point of the room.
struct Label {
  Vec3 at{0.0};
  std::string text;
  rt::Colour colour{};
};
/// Lines and texts on top of the room.
struct Marks {
  std::vector<rt::Beam> lines;
  std::vector<Label> labels, people;
  std::vector<std::pair<std::string, rt::Colour>> of_people;  ///< in the key: "person mia"; a pet has its name alone
  std::optional<rt::Beam> scale;
};

/// The edges of a closed polygon, at a height.
void add_loop(const std::vector<Vec2>& loop, double y, const rt::Colour& colour, std::vector<rt::Beam>& lines) {
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 from = loop[i], to = loop[(i + 1) % loop.size()];
    lines.push_back({Vec3(from.x, y, from.y), Vec3(to.x, y, to.y), colour});
  }
}

/// From the seat's point the way who sits there faces.
void mark_seats(const SceneSpec& scene, Marks& marks) {
  constexpr double nose_m = 0.25, above_m = 0.25;
  const auto mark = [&](const Frame& world_from_seat, const std::string& id) {
    marks.lines.push_back({world_from_seat * Vec3(0.0, 0.0, -nose_m), world_from_seat.origin, seat_colour});
    marks.labels.push_back({world_from_seat.origin + Vec3(0.0, above_m, 0.0), id, seat_colour});
  };
  for (const SeatSpec& seat : scene.seats) mark(seat.world_from_seat, seat.id);
  for (const PlaceSpec& place : scene.places) mark(place.world_from_place, place.id);
}

/// The threshold, and the way in; what a leaf sweeps.
void mark_doors(const SceneSpec& scene, Marks& marks) {
  constexpr double way_m = 0.5, above_m = 0.02;
  for (const EntranceSpec& door : scene.entrances) {
    const auto at = [&](double x, double z) { return door.world_from_entrance * Vec3(x, above_m, z); };
    marks.lines.push_back({at(-0.5 * door.width_m, 0.0), at(0.5 * door.width_m, 0.0), door_colour});
    marks.lines.push_back({at(0.0, 0.0), at(0.0, -way_m), door_colour});
    marks.labels.push_back({at(0.0, 0.0), door.id, door_colour});
  }
  for (const DoorSpec& door : scene.doors) {
    add_loop(DoorLeaf(door, 1.0).sweep(), door.world_from_door.origin.y + above_m, door_colour, marks.lines);
    const Vec3 above = door.world_from_door * Vec3(0.0, door.height_m + 0.1, 0.0);
    marks.labels.push_back({above, door.id, door_colour});
  }
}

/// The border, and the name in the middle.
void mark_areas(const SceneSpec& scene, Marks& marks) {
  constexpr double above_m = 0.015;
  const double y = scene.floor.height_m() + above_m;
  for (const AreaSpec& area : scene.areas) {
    for (const std::vector<Vec2>& loop : area.outline.loops()) add_loop(loop, y, area_colour, marks.lines);
    const Vec2 middle = roomiest_point(area.outline);
    marks.labels.push_back({Vec3(middle.x, y, middle.y), area.id, area_colour});
  }
}

void mark_sensors(const SceneSpec& scene, Marks& marks) {
  constexpr double above_m = 0.1, stub_m = 0.03;
  for (const SensorSpec& sensor : scene.sensors) {
    const Vec3 at = sensor.world_from_sensor.origin;
    marks.lines.push_back({at + Vec3(0.0, stub_m, 0.0), at, scale_colour});
    marks.labels.push_back({at + Vec3(0.0, above_m, 0.0), sensor.id, scale_colour});
  }
}

void mark_people(const State& state, Marks& marks) {
  constexpr double above_m = 0.05;
  const auto& actors = state.run_state().crowd.actors();
  for (std::size_t i = 0; i < actors.size(); ++i) {
    std::vector<PosedShape> shapes;
    sim::append_solids(actors[i], shapes);
    if (shapes.empty()) continue;
    const Bounds head = bounds(shapes.at(static_cast<std::size_t>(body::Part::head)));
    const Vec3f top(0.5F * (head.lower.x + head.upper.x), head.upper.y, 0.5F * (head.lower.z + head.upper.z));
    const std::string& id = actors[i].person().spec.id;
    marks.people.push_back({Vec3(top) + Vec3(0.0, above_m, 0.0), id, shirt_of(i)});
    marks.of_people.emplace_back(actors[i].is_pet() ? id : "person " + id, shirt_of(i));
  }
}

/// A metre along x, on the floor before the room.
void mark_scale(const SceneSpec& scene, Marks& marks) {
  constexpr double before_m = 0.3, above_m = 0.01;
  const Vec2 corner = scene.floor.lower();
  const auto at = [&](double x) { return Vec3(corner.x + x, scene.floor.height_m() + above_m, corner.y - before_m); };
  marks.scale = {at(0.0), at(1.0), scale_colour};
  marks.lines.push_back({at(0.0), at(1.0), scale_colour});
  marks.lines.push_back({at(1.0), at(0.0), scale_colour});
}

/// Is all of a line in the picture, and nothing before it?
bool is_seen(const rt::Beam& line, const rt::View& view, const rt::Image& image) {
  constexpr int n_points = 11;
  constexpr float slack_m = 0.03F;
  for (int i = 0; i < n_points; ++i) {
    const Vec3f point(glm::mix(line.from, line.to, static_cast<double>(i) / (n_points - 1)));
    const auto pixel = view.pixel_of(point);
    if (!pixel || !(pixel->x >= 0.0F && pixel->y >= 0.0F)) return false;
    if (!(pixel->x < static_cast<float>(image.width) && pixel->y < static_cast<float>(image.height))) return false;
    const auto x = static_cast<std::size_t>(pixel->x), y = static_cast<std::size_t>(pixel->y);
    if (image.depth_m[y * static_cast<std::size_t>(image.width) + x] < view.depth_of(point) - slack_m) return false;
  }
  return true;
}

/// A floor that no mesh shows: a polygon in the scene's markup.
std::vector<rt::Beam> unseen_floor(const SceneSpec& scene) {
  const double y = scene.floor.height_m();
  const bool is_seen =
      std::ranges::any_of(scene.meshes, [&](const TriMesh& mesh) { return role_of(mesh, y) == MeshRole::floor; });
  if (is_seen) return {};
  constexpr rt::Colour colour{0.30F, 0.28F, 0.25F};
  std::vector<rt::Beam> edges;
  for (const std::vector<Vec2>& loop : scene.floor.loops()) add_loop(loop, y, colour, edges);
  return edges;
}

Marks marks_of(const Model& model, const State& state, const std::vector<Mark>& wanted) {
  const SceneSpec& scene = model.compiled().scene();
  Marks marks;
  for (const Mark mark : wanted) {
    if (mark == Mark::seats) mark_seats(scene, marks);
    if (mark == Mark::doors) mark_doors(scene, marks);
    if (mark == Mark::areas) mark_areas(scene, marks);
    if (mark == Mark::sensors) mark_sensors(scene, marks);
    if (mark == Mark::people) mark_people(state, marks);
    if (mark == Mark::scale) mark_scale(scene, marks);
  }
  return marks;
}

/// Darker than the lines, so that it can be read; light colours still more so.
Vec3 ink(const rt::Colour& colour) {
  const Vec3 light(colour[0], colour[1], colour[2]);
  const double luminance = glm::dot(light, Vec3(0.2126, 0.7152, 0.0722));
  return 255.0 * glm::pow(light, Vec3(1.0 / 2.2)) * (luminance > 0.4 ? 0.6 : 0.8);
}

/// What the colours of a picture mean, in its lower left corner.
struct Key {
  std::vector<std::pair<std::string, rt::Colour>> entries;
  double line_px = 0.0, size_px = 0.0;
  PixelBox box;  ///< of no width if there are no entries

  [[nodiscard]] double sign_px() const { return 1.6 * size_px; }
};

Key key_of(const PictureSpec& spec, const SceneSpec& scene, const Marks& marks) {
  constexpr std::size_t most_people = 8;  // whose colours differ
  constexpr double reference_px = 15.0, reference_height = 720.0;
  const double size_px =
      std::max(9.0, reference_px * spec.height / reference_height);  // a larger picture shows the same
  const auto wanted = [&](Mark mark) { return std::ranges::find(spec.marks, mark) != spec.marks.end(); };
  const double height = spec.height;
  Key key{{}, 1.45 * size_px, size_px, {Vec2(0.0, height), Vec2(0.0, height)}};
  if (!wanted(Mark::key)) return key;
  if (!spec.beams_of.empty()) {
    key.entries.emplace_back("a sensor's beam", idle_beam);
    key.entries.emplace_back("a beam that hits a person", seeing_beam);
  }
  if (wanted(Mark::sensors)) key.entries.emplace_back("sensor", scale_colour);
  if (wanted(Mark::seats)) key.entries.emplace_back("seat", seat_colour);
  if (wanted(Mark::doors)) key.entries.emplace_back("door", door_colour);
  if (wanted(Mark::areas) && !scene.areas.empty()) key.entries.emplace_back("area", area_colour);
  if (marks.people.size() <= most_people) {
    key.entries.insert(key.entries.end(), marks.of_people.begin(), marks.of_people.end());
  } else {
    key.entries.emplace_back("people: name and shirt have one colour", scale_colour);
  }
  double width = 0.0;
  for (const auto& [text, colour] : key.entries) width = std::max(width, io::text_extent(text, size_px).x);
  if (key.entries.empty()) return key;
  key.box.lower.y -= key.line_px * (static_cast<double>(key.entries.size()) + 1.0);
  key.box.upper.x = width + key.sign_px() + 3.0 * key.line_px;
  return key;
}

void write_key(const Key& key, io::Pixels& image) {
  Vec2 at = Vec2(key.line_px, key.box.lower.y + key.line_px);
  for (const auto& [text, colour] : key.entries) {
    const Vec2 left = at + Vec2(0.0, 0.5 * key.size_px), extent = io::text_extent(text, key.size_px);
    io::Canvas(image).line(left, left + Vec2(key.sign_px(), 0.0), ink(colour), 0.3 * key.size_px);
    const double text_from = at.x + key.sign_px() + 0.6 * key.size_px;
    io::write_text(image, {text_from + 0.5 * extent.x, at.y + key.size_px}, text, key.size_px, ink(scale_colour));
    at.y += key.line_px;
  }
}

/// A line from the name to what it names, where the name stands apart from it.
void draw_leader(const io::Lettering& text, const Vec2& point, double size_px, io::Pixels& image) {
  const PixelBox box = io::box_of(text, size_px);
  const Vec2 from(std::clamp(point.x, box.lower.x, box.upper.x), std::clamp(point.y, box.lower.y, box.upper.y));
  io::Canvas canvas(image);
  canvas.line(from, point, Vec3(255.0), 0.22 * size_px);
  canvas.line(from, point, text.colour, 0.1 * size_px);
}

void write_labels(const Marks& marks, const rt::View& view, bool scale_is_seen, const Key& key, io::Pixels& image) {
  const double size = key.size_px, lift = 0.9 * size;  // of a person's name above the head
  std::vector<Label> labels = marks.labels;
  if (scale_is_seen) {
    constexpr double before_m = 0.3;
    labels.push_back({0.5 * (marks.scale->from + marks.scale->to) - Vec3(0.0, 0.0, before_m), "1 m", scale_colour});
  }
  const std::size_t n_things = labels.size();
  labels.insert(labels.end(), marks.people.begin(), marks.people.end());
  std::vector<io::Lettering> texts;
  std::vector<Vec2> points;
  const auto is_in_picture = [&](const Vec2& at) {
    return at.x >= 0.0 && at.y >= 0.0 && at.x < image.width && at.y < image.height + size;
  };
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto at = view.pixel_of(Vec3f(labels[i].at));
    if (!at || !is_in_picture(Vec2(*at))) continue;
    const double half = 0.5 * io::text_extent(labels[i].text, size).x, width = image.width;
    // One that an edge would cut stands on it.
    Vec2 bottom(std::clamp<double>(at->x, std::min(half, 0.5 * width), std::max(width - half, 0.5 * width)),
                at->y - (i < n_things ? 0.0 : lift));
    bottom.y = std::clamp(bottom.y, std::min<double>(size, image.height), static_cast<double>(image.height));
    points.emplace_back(*at);
    texts.push_back({bottom, labels[i].text, ink(labels[i].colour)});
  }
  std::vector<PixelBox> taken;
  if (!key.entries.empty()) taken.push_back(key.box);
  texts = io::set_apart(std::move(texts), size, taken);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (glm::distance(texts[i].bottom, points[i]) > 0.8 * size) draw_leader(texts[i], points[i], size, image);
  }
  for (const io::Lettering& text : texts) io::write_text(image, text.bottom, text.text, size, text.colour);
}

/// The room and its scale beside the key or above it, where they are larger.
rt::Camera dolls_house_camera(const SceneSpec& scene, const Marks& marks, const Key& key, const PictureSpec& spec) {
  const double margin_px = 0.008 * std::min(spec.width, spec.height);
  const PixelBox all{Vec2(margin_px), Vec2(spec.width, spec.height) - margin_px};
  PixelBox beside = all, above = all;
  beside.lower.x = std::min(std::max(all.lower.x, key.box.upper.x), 0.5 * spec.width);
  above.upper.y = std::max(std::min(all.upper.y, key.box.lower.y), 0.5 * spec.height);
  std::vector<Vec3> corners = corners_of(scene);
  constexpr double below_scale_m = 0.15;  // its name
  if (marks.scale) {
    for (const Vec3& end : {marks.scale->from, marks.scale->to}) corners.push_back(end - Vec3(0.0, 0.0, below_scale_m));
  }
  const rt::Camera right = camera_that_holds(corners, beside, spec), top = camera_that_holds(corners, above, spec);
  const auto away = [](const rt::Camera& camera) { return glm::distance(camera.position, camera.target); };
  return away(right) <= away(top) ? right : top;
}

}  // namespace

MeshRole role_of(const TriMesh& mesh, double floor_height_m) {
  constexpr double wall_height_m = 2.0, floor_thickness_m = 0.05;
  Vec3 lower(1e9), upper(-1e9);
  for (const Vec3& p : mesh.positions) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  const Vec3 size = upper - lower;
  const bool is_high = lower.y >= floor_height_m + wall_height_m;
  if (is_high && size.y < std::min(size.x, size.z)) return MeshRole::ceiling;
  if (is_high || size.y > wall_height_m) return MeshRole::wall;
  return upper.y < floor_height_m + floor_thickness_m ? MeshRole::floor : MeshRole::furniture;
}

io::RoomPlan plan_of(const SceneSpec& scene) {
  io::RoomPlan plan;
  plan.outline = scene.floor.loops();
  for (const TriMesh& mesh : scene.meshes) {
    const MeshRole role = role_of(mesh, scene.floor.height_m());
    if (role == MeshRole::furniture) add_pieces(mesh, plan.furniture);
    if (role == MeshRole::wall) add_wall(mesh, scene.floor.height_m(), plan);
  }
  for (const SeatSpec& seat : scene.seats)
    plan.seats.push_back({seat.id, floor_point(seat.world_from_seat.origin), heading_of(seat.world_from_seat)});
  for (const EntranceSpec& door : scene.entrances) {
    const auto jamb = [&](double side) {
      return floor_point(door.world_from_entrance * Vec3(0.5 * side * door.width_m, 0.0, 0.0));
    };
    plan.doors.push_back({door.id, jamb(-1.0), jamb(1.0), {}});
  }
  for (const DoorSpec& door : scene.doors) {
    std::vector<Vec2> sweep = DoorLeaf(door, 1.0).sweep();
    plan.doors.push_back({door.id, sweep[0], sweep[1], std::move(sweep)});
  }
  for (const AreaSpec& area : scene.areas)
    plan.areas.push_back({area.id, roomiest_point(area.outline), area.outline.loops()});
  return plan;
}

io::RoomPlan::Marker marker_of(const SensorSpec& sensor) {
  return {sensor.id, floor_point(sensor.world_from_sensor.origin), heading_of(sensor.world_from_sensor)};
}

std::string signs_of_maps(const SceneSpec& scene) {
  const std::string signs =
      "Red triangles are sensors and white ones seats, both pointing the way they face; a name is left out where there "
      "is no room for it, then point at the seat. A green line is a door, dotted lines are furniture, black areas are "
      "walls, the solid line is the floor's edge.";
  return scene.areas.empty() ? signs : signs + " Violet dashes are the borders of named areas.";
}

std::string_view name(Mark mark) noexcept {
  static constexpr std::array<std::string_view, all_marks.size()> names{"seats",  "doors", "areas", "sensors",
                                                                        "people", "scale", "key"};
  return names[static_cast<std::size_t>(mark)];
}

io::Pixels picture(const Model& model, const State& state, const PictureSpec& spec) {
  const SceneSpec& scene = model.compiled().scene();
  std::vector<rt::Surface> surfaces;
  std::vector<rt::Colour> colours;
  for (const TriMesh& mesh : scene.meshes) {
    const MeshLook look = look_of(mesh, scene.floor.height_m());
    surfaces.push_back(look.surface);
    colours.push_back(look.colour);
  }
  std::vector<rt::RenderedSolid> solids;
  const auto& actors = state.run_state().crowd.actors();
  for (std::size_t person = 0; person < actors.size(); ++person) {
    std::vector<PosedShape> shapes;
    sim::append_solids(actors[person], shapes);
    for (std::size_t i = 0; i < shapes.size(); ++i)
      solids.push_back(
          {shapes[i], actors[person].is_pet() ? shirt_of(person) : colour_of(static_cast<body::Part>(i), person)});
  }
  const std::vector<DoorLeaf>& leaves = model.compiled().array().leaves();
  const std::span<const LeafStep> steps = state.run_state().crowd.doors().steps();
  for (std::size_t i = 0; i < leaves.size(); ++i) solids.push_back({leaves[i].at(steps[i]), leaf_colour});
  std::vector<rt::Beam> beams = unseen_floor(scene);
  const auto edges = static_cast<std::ptrdiff_t>(beams.size());
  for (const std::size_t sensor : spec.beams_of) {
    for (const sim::BeamSegment& beam : sim::beams_of(model, state, sensor)) {
      beams.push_back({beam.from, beam.to, beam.sees_person ? seeing_beam : idle_beam});
    }
  }
  // What sees the person is drawn last, over the rest.
  std::stable_partition(beams.begin() + edges, beams.end(),
                        [](const rt::Beam& beam) { return beam.colour == idle_beam; });
  const Marks marks = marks_of(model, state, spec.marks);
  beams.insert(beams.end(), marks.lines.begin(), marks.lines.end());
  const Key key = key_of(spec, scene, marks);
  rt::Camera camera = dolls_house_camera(scene, marks, key, spec);
  if (spec.camera) camera.position = *spec.camera;
  if (spec.look_at) camera.target = *spec.look_at;
  require_usable(camera);
  rt::Image image =
      rt::render(model.compiled().array().room(), surfaces, colours, solids, beams, camera, spec.width, spec.height);
  const rt::View view = rt::make_view(camera, spec.width, spec.height);
  const bool scale_is_seen = marks.scale && is_seen(*marks.scale, view, image);
  io::Pixels pixels{image.width, image.height, std::move(image.rgb)};
  write_labels(marks, view, scale_is_seen, key, pixels);
  write_key(key, pixels);
  return pixels;
}

}  // namespace pirsim::studies
