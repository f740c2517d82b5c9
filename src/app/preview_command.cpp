#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <optional>
#include <sstream>

#include "app/commands.hpp"
#include "app/outputs.hpp"
#include "app/session.hpp"
#include "io/png.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/state.hpp"
#include "rt/renderer.hpp"
#include "sim/beams.hpp"
#include "sim/run_state.hpp"
#include "sim/solids.hpp"

namespace pirsim::app {
namespace {

struct PreviewOptions {
  std::filesystem::path output = "preview.png";
  RunChoice run;
  std::optional<double> time_s;    ///< empty: when the first person has been at work for a while
  std::vector<std::string> beams;  ///< sensors whose beams are drawn; "all", "none"
  std::optional<std::array<double, 3>> camera, look_at;
  double field_of_view_deg = 45.0;
  int width = 1280, height = 720;
};

struct Extent {
  Vec3 lower{1e9}, upper{-1e9};
};

Extent extent(const TriMesh& mesh) {
  Extent result;
  for (const Vec3& p : mesh.positions) {
    result.lower = glm::min(result.lower, p);
    result.upper = glm::max(result.upper, p);
  }
  return result;
}

struct MeshLook {
  rt::Surface surface;
  rt::Colour colour;
};

/// Tall or high things are walls and ceilings, cut away towards the camera; the rest is furniture.
MeshLook look_of(const TriMesh& mesh, double floor_y) {
  constexpr double wall_height_m = 2.0, floor_thickness_m = 0.05;
  const Extent e = extent(mesh);
  const Vec3 size = e.upper - e.lower;
  const bool is_high = e.lower.y >= floor_y + wall_height_m;
  if (is_high && size.y < std::min(size.x, size.z)) return {rt::Surface::hidden, {0.9F, 0.9F, 0.9F}};
  if (is_high || size.y > wall_height_m) return {rt::Surface::see_through, {0.82F, 0.84F, 0.86F}};
  if (e.upper.y < floor_y + floor_thickness_m) return {rt::Surface::opaque, {0.60F, 0.57F, 0.53F}};
  return {rt::Surface::opaque, {0.55F, 0.36F, 0.20F}};
}

rt::Colour colour_of(body::Part part) {
  switch (part) {
    case body::Part::head:
    case body::Part::left_forearm:
    case body::Part::right_forearm:
      return {0.78F, 0.50F, 0.36F};
    case body::Part::torso:
    case body::Part::left_upper_arm:
    case body::Part::right_upper_arm:
      return {0.10F, 0.28F, 0.52F};
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

bool reached_default_time(const State& state, std::int64_t& work_began, const Model& model) {
  constexpr double into_work_s = 10.0;
  const sim::Crowd& crowd = state.run_state().crowd;
  if (work_began < 0 && !crowd.actors().empty() && crowd.actors().front().phase() == "working")
    work_began = state.tick();
  return work_began >= 0 && static_cast<double>(state.tick() - work_began) * model.tick_s() >= into_work_s;
}

double time_s(const Model& model, const State& state) { return static_cast<double>(state.tick()) * model.tick_s(); }

/// Where somebody asks for a moment that never comes, a picture of another one would mislead.
void require_reached(double asked_s, const Model& model, const State& state) {
  const double reached_s = time_s(model, state);
  if (reached_s >= asked_s) return;
  std::ostringstream message;
  message << "--time: the run is shorter than " << asked_s << " s, trial " << model.trial_of(state.run()) << " lasts "
          << reached_s << " s";
  throw Error(ErrorCode::usage, message.str());
}

State go_to_moment(const Model& model, const PreviewOptions& options) {
  State state(model, find_run(model, options.run));
  std::int64_t work_began = -1;
  while (!state.finished()) {
    if (options.time_s ? time_s(model, state) >= *options.time_s : reached_default_time(state, work_began, model))
      break;
    step_tick(model, state);
  }
  if (options.time_s) require_reached(*options.time_s, model, state);
  return state;
}

void preview(const Inputs& inputs, const PreviewOptions& options) {
  check_outputs({{"-o", options.output, {".png"}}}, inputs);
  const Model model = load(inputs);
  const State state = go_to_moment(model, options);

  const SceneSpec& scene = model.compiled().scene();
  std::vector<rt::Surface> surfaces;
  std::vector<rt::Colour> colours;
  for (const TriMesh& mesh : scene.meshes) {
    const MeshLook look = look_of(mesh, scene.floor.height_m());
    surfaces.push_back(look.surface);
    colours.push_back(look.colour);
  }
  std::vector<rt::RenderedSolid> solids;
  for (const sim::Actor& actor : state.run_state().crowd.actors()) {
    std::vector<PosedShape> shapes;
    sim::append_solids(actor, shapes);
    for (std::size_t i = 0; i < shapes.size(); ++i)
      solids.push_back({shapes[i], colour_of(static_cast<body::Part>(i))});
  }
  std::vector<std::string> names = options.beams;
  if (names.empty() && !model.scene().sensors.empty()) names.push_back(model.scene().sensors.front().id);
  std::vector<rt::Beam> beams;
  constexpr rt::Colour idle{0.10F, 0.45F, 0.75F}, seeing{1.0F, 0.25F, 0.02F};
  for (const std::size_t sensor : find_sensors(model, names)) {
    for (const sim::BeamSegment& beam : sim::beams_of(model, state, sensor)) {
      beams.push_back({beam.from, beam.to, beam.sees_person ? seeing : idle});
    }
  }
  // What sees the person is drawn last, over the rest.
  std::stable_partition(beams.begin(), beams.end(), [&](const rt::Beam& beam) { return beam.colour == idle; });
  const double fov = radians(options.field_of_view_deg);
  rt::Camera camera = dolls_house_camera(scene, fov, static_cast<double>(options.width) / options.height);
  const auto vec = [](const std::array<double, 3>& a) { return Vec3(a[0], a[1], a[2]); };
  if (options.camera) camera.position = vec(*options.camera);
  if (options.look_at) camera.target = vec(*options.look_at);

  require_usable(camera);

  const rt::Image image = rt::render(model.compiled().array().room(), surfaces, colours, solids, beams, camera,
                                     options.width, options.height);
  io::write_png(options.output, image.width, image.height, image.rgb);
  if (inputs.verbosity != Verbosity::quiet) {
    std::cerr << "wrote " << options.output.string() << ": trial " << model.trial_of(state.run()) << " at "
              << time_s(model, state) << " s\n";
  }
}

/// One word "X,Y,Z": an option of three values would take the next option for the third.
void add_point(CLI::App& command, const std::string& name, std::optional<std::array<double, 3>>& point,
               const std::string& what) {
  const auto read = [name, &point](const std::string& text) {
    std::istringstream stream(text);
    std::array<double, 3> values{};
    char comma = ',', rest = 0;
    for (double& value : values) {
      const bool is_first = &value == values.data();
      if ((is_first || (stream >> comma && comma == ',')) && stream >> value) continue;
      throw Error(ErrorCode::usage, name + ": expected X,Y,Z in metres, got '" + text + "'");
    }
    if (stream >> rest) throw Error(ErrorCode::usage, name + ": expected X,Y,Z in metres, got '" + text + "'");
    point = values;
  };
  command.add_option_function<std::string>(name, read, what)->option_text("X,Y,Z");
}

}  // namespace

void add_preview_command(CLI::App& app) {
  CLI::App& command = add_command(app, "preview", "render room, people and beams as PNG", R"(
  pirsim preview --scene room.gltf --script study.yaml -o room.png  a picture of room, people and beams
  pirsim preview --scene room.gltf --script study.yaml --trial S8 --time 20 --beams PIR4,PIR5
  pirsim preview --scene room.gltf --script study.yaml --camera 0,6,0 --look-at 2,0,2
)");
  const auto inputs = std::make_shared<Inputs>();
  const auto options = std::make_shared<PreviewOptions>();
  offer_study(command, *inputs);
  offer_tracer(command, *inputs);
  offer_seed(command, *inputs);
  offer_output(command, options->output, "FILE", "PNG file (default: preview.png)");
  offer_run_choice(command, options->run);
  command.add_option("--time", options->time_s, "moment of the run in seconds (default: 10 s into desk work)")
      ->option_text("S");
  command.add_option("--beams", options->beams, "sensors whose beams are drawn, or all or none (default: the first)")
      ->option_text("ID,...")
      ->delimiter(',');
  add_point(command, "--camera", options->camera, "where the camera stands, m");
  add_point(command, "--look-at", options->look_at, "what it looks at, m");
  command.add_option("--fov-deg", options->field_of_view_deg, "vertical field of view (default: 45)")
      ->option_text("DEG")
      ->check(CLI::Range(1.0, 170.0));
  command.add_option("--width", options->width, "pixels (default: 1280)")
      ->option_text("N")
      ->check(CLI::Range(16, 7680));
  command.add_option("--height", options->height, "pixels (default: 720)")
      ->option_text("N")
      ->check(CLI::Range(16, 4320));
  on_call(command, inputs, [options](const Inputs& given) { preview(given, *options); });
}

}  // namespace pirsim::app
