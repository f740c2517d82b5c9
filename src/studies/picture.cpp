#include "studies/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <string>
#include <utility>

#include "io/lettering.hpp"
#include "io/person_colours.hpp"
#include "pirsim/error.hpp"
#include "rt/renderer.hpp"
#include "sim/compiled_study.hpp"
#include "sim/run_state.hpp"
#include "sim/solids.hpp"
#include "studies/room_plan.hpp"

namespace pirsim::studies {
namespace {

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

/// From above and beside, far enough to hold the whole floor area and a storey of height.
rt::Camera dolls_house_camera(const SceneSpec& scene, double fov_rad, double aspect) {
  const Vec2 lower = scene.floor.lower(), upper = scene.floor.upper();
  const Vec2 middle = 0.5 * (lower + upper);
  const Vec3 target(middle.x, scene.floor.height_m() + 0.6, middle.y);
  const double radius = 0.5 * glm::length(Vec3(upper.x - lower.x, 2.0, upper.y - lower.y));
  const double narrow = std::min(fov_rad, 2.0 * std::atan(std::tan(fov_rad / 2.0) * aspect));
  const Vec3 direction = glm::normalize(Vec3(-0.55, 0.85, -1.0));
  return {target + direction * (0.95 * radius / std::sin(narrow / 2.0)), target, fov_rad};
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
constexpr rt::Colour seat_colour{0.55F, 0.10F, 0.55F}, door_colour{0.05F, 0.45F, 0.12F},
    scale_colour{0.05F, 0.05F, 0.06F};

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
  std::optional<rt::Beam> scale;
};

/// From the seat's point the way who sits there faces.
void mark_seats(const SceneSpec& scene, Marks& marks) {
  constexpr double nose_m = 0.25, above_m = 0.25;
  for (const SeatSpec& seat : scene.seats) {
    const Vec3 at = seat.world_from_seat.origin;
    marks.lines.push_back({seat.world_from_seat * Vec3(0.0, 0.0, -nose_m), at, seat_colour});
    marks.labels.push_back({at + Vec3(0.0, above_m, 0.0), seat.id, seat_colour});
  }
}

/// The threshold, and the way in.
void mark_doors(const SceneSpec& scene, Marks& marks) {
  constexpr double way_m = 0.5, above_m = 0.02;
  for (const EntranceSpec& door : scene.entrances) {
    const auto at = [&](double x, double z) { return door.world_from_entrance * Vec3(x, above_m, z); };
    marks.lines.push_back({at(-0.5 * door.width_m, 0.0), at(0.5 * door.width_m, 0.0), door_colour});
    marks.lines.push_back({at(0.0, 0.0), at(0.0, -way_m), door_colour});
    marks.labels.push_back({at(0.0, 0.0), door.id, door_colour});
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
    marks.people.push_back({Vec3(top) + Vec3(0.0, above_m, 0.0), actors[i].person().spec.id, shirt_of(i)});
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
  for (const std::vector<Vec2>& loop : scene.floor.loops()) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec2 from = loop[i], to = loop[(i + 1) % loop.size()];
      edges.push_back({Vec3(from.x, y, from.y), Vec3(to.x, y, to.y), colour});
    }
  }
  return edges;
}

Marks marks_of(const Model& model, const State& state, const std::vector<Mark>& wanted) {
  const SceneSpec& scene = model.compiled().scene();
  Marks marks;
  for (const Mark mark : wanted) {
    if (mark == Mark::seats) mark_seats(scene, marks);
    if (mark == Mark::doors) mark_doors(scene, marks);
    if (mark == Mark::sensors) mark_sensors(scene, marks);
    if (mark == Mark::people) mark_people(state, marks);
    if (mark == Mark::scale) mark_scale(scene, marks);
  }
  return marks;
}

/// Of texts, in pixels, so that a larger picture shows the same.
double text_size(const io::Pixels& image) {
  constexpr double size_px = 12.5, reference_height = 720.0;
  return std::max(8.0, size_px * image.height / reference_height);
}

/// Darker than the lines, so that it can be read; light colours still more so.
Vec3 ink(const rt::Colour& colour) {
  const Vec3 light(colour[0], colour[1], colour[2]);
  const double luminance = glm::dot(light, Vec3(0.2126, 0.7152, 0.0722));
  return 255.0 * glm::pow(light, Vec3(1.0 / 2.2)) * (luminance > 0.4 ? 0.6 : 0.8);
}

void write_labels(const Marks& marks, const rt::View& view, bool scale_is_seen, io::Pixels& image) {
  const double size = text_size(image);
  const auto height = static_cast<float>(image.height);
  std::vector<Label> labels = marks.labels;
  labels.insert(labels.end(), marks.people.begin(), marks.people.end());
  if (scale_is_seen) {
    constexpr double before_m = 0.3;
    labels.push_back({0.5 * (marks.scale->from + marks.scale->to) - Vec3(0.0, 0.0, before_m), "1 m", scale_colour});
  }
  std::vector<io::Lettering> texts;
  for (const Label& label : labels) {
    auto at = view.pixel_of(Vec3f(label.at));
    if (!at) continue;
    // One that the lower edge would cut stands on it.
    if (at->y > height && at->y < height + size) at->y = height;
    texts.push_back({Vec2(*at), label.text, ink(label.colour)});
  }
  for (const io::Lettering& text : io::set_apart(std::move(texts), size))
    io::write_text(image, text.bottom, text.text, size, text.colour);
}

/// What the colours of this picture mean, in its lower left corner.
void write_key(const PictureSpec& spec, const Marks& marks, io::Pixels& image) {
  constexpr std::size_t most_people = 8;  // whose colours differ
  const auto wanted = [&](Mark mark) { return std::ranges::find(spec.marks, mark) != spec.marks.end(); };
  if (!wanted(Mark::key)) return;
  std::vector<std::pair<std::string, rt::Colour>> entries;
  if (!spec.beams_of.empty()) {
    entries.emplace_back("a sensor's beam", idle_beam);
    entries.emplace_back("a beam that hits a person", seeing_beam);
  }
  if (wanted(Mark::sensors)) entries.emplace_back("sensor", scale_colour);
  if (wanted(Mark::seats)) entries.emplace_back("seat", seat_colour);
  if (wanted(Mark::doors)) entries.emplace_back("door", door_colour);
  if (marks.people.size() <= most_people) {
    for (const Label& person : marks.people) entries.emplace_back("person " + person.text, person.colour);
  } else {
    entries.emplace_back("people: name and shirt have one colour", scale_colour);
  }
  const double size = text_size(image), line = 1.5 * size;
  Vec2 at(line, image.height - line - line * (static_cast<double>(entries.size()) - 1.0));
  for (const auto& [text, colour] : entries) {
    io::write_text(image, at + Vec2(0.5 * io::text_extent(text, size).x, 0.0), text, size, ink(colour));
    at.y += line;
  }
}

}  // namespace

std::string_view name(Mark mark) noexcept {
  static constexpr std::array<std::string_view, all_marks.size()> names{"seats",  "doors", "sensors",
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
      solids.push_back({shapes[i], colour_of(static_cast<body::Part>(i), person)});
  }
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
  const double fov = radians(spec.field_of_view_deg);
  rt::Camera camera = dolls_house_camera(scene, fov, static_cast<double>(spec.width) / spec.height);
  if (spec.camera) camera.position = *spec.camera;
  if (spec.look_at) camera.target = *spec.look_at;
  require_usable(camera);
  rt::Image image =
      rt::render(model.compiled().array().room(), surfaces, colours, solids, beams, camera, spec.width, spec.height);
  const rt::View view = rt::make_view(camera, spec.width, spec.height);
  const bool scale_is_seen = marks.scale && is_seen(*marks.scale, view, image);
  io::Pixels pixels{image.width, image.height, std::move(image.rgb)};
  write_labels(marks, view, scale_is_seen, pixels);
  write_key(spec, marks, pixels);
  return pixels;
}

}  // namespace pirsim::studies
