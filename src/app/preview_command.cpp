#include <algorithm>
#include <array>
#include <iostream>
#include <optional>
#include <sstream>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/moment.hpp"
#include "app/session.hpp"
#include "pirsim/look.hpp"
#include "sim/compiled_study.hpp"
#include "studies/picture.hpp"

namespace pirsim::app {
namespace {

struct PreviewOptions {
  std::filesystem::path output = "preview.png";
  RunChoice run;
  std::string time;  ///< empty: not given
  PictureRequest picture;
};

/// `--marks seats,doors` was the option before scenes had marks beside them.
void refuse_words(const std::filesystem::path& marks) {
  const std::string given = marks.string(), first = given.substr(0, given.find(','));
  const auto is_word = [&](studies::Mark mark) { return name(mark) == first; };
  if (first == "all" || first == "none" || std::ranges::any_of(studies::all_marks, is_word))
    throw Error(ErrorCode::usage, "--marks: takes a file of marks; what a picture names is --labels " + given);
}

void preview(const Inputs& inputs, const PreviewOptions& options) {
  refuse_words(inputs.marks);
  const Model model = load(inputs);
  PictureRequest request = options.picture;
  request.run = find_run(model, options.run);
  const std::optional<RunClock> clock = model.compiled().clock_of(request.run);
  if (!options.time.empty()) request.time_s = moment("--time", options.time, clock);
  std::optional<Progress> progress;
  progress.emplace(Work{"simulating up to that moment", 1, "runs", request.time_s.value_or(0.0)}, inputs.verbosity);
  request.simulated = [&](double seconds) { progress->simulated(seconds); };
  const Picture picture = picture_of(model, request);
  progress.reset();
  io::write_text_file(options.output, picture.png);
  const std::string about = "trial " + model.trial_of(request.run) + " at " + moment_text(clock, picture.time_s);
  tell_written({{options.output, about}}, inputs.verbosity);
}

/// One word "X,Y,Z": an option of three values would take the next option for the third.
void add_point(CLI::App& command, const std::string& name, std::optional<Vec3>& point, const std::string& what) {
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
    point = Vec3(values[0], values[1], values[2]);
  };
  command.add_option_function<std::string>(name, read, what)->option_text("X,Y,Z");
}

}  // namespace

void add_preview_command(CLI::App& app) {
  CLI::App& command = add_command(app, "preview", "render room, people and beams as PNG", R"(
  pirsim preview --scene room.gltf --script study.yaml -o room.png  a picture of room, people and beams
  pirsim preview --scene room.gltf                                  of the room alone
  pirsim preview --scene room.gltf --script study.yaml --trial S8 --time 20 --beams PIR4,PIR5
  pirsim preview --scene room.gltf --script study.yaml --camera 0,6,0 --look-at 2,0,2
  pirsim preview --scene room.gltf --script study.yaml --labels seats,doors  their ids, and nothing else's
)");
  const auto inputs = std::make_shared<Inputs>();
  const auto options = std::make_shared<PreviewOptions>();
  offer_study(command, *inputs);
  offer_tracer(command, *inputs);
  offer_seed(command, *inputs);
  offer_output(command, output_names, options->output, "PNG file (default: preview.png)", {".png"});
  offer_run_choice(command, options->run);
  offer_moment(command, "--time", options->time, "which moment", "10 s into desk work");
  command
      .add_option("--beams", options->picture.beams,
                  "sensors whose beams are drawn, or all or none (default: the first)")
      ->option_text("ID,...")
      ->delimiter(',');
  std::vector<std::string> words{"all", "none"};
  for (const studies::Mark mark : studies::all_marks) words.emplace_back(name(mark));
  command
      .add_option(
          "--labels", options->picture.marks,
          "what is marked and named: seats, doors, areas, sensors, people, scale, key, or all or none (default: "
          "all)")
      ->option_text("WORD,...")
      ->delimiter(',')
      ->check(CLI::IsMember(words));
  add_point(command, "--camera", options->picture.camera, "where the camera stands, m");
  add_point(command, "--look-at", options->picture.look_at, "what it looks at, m");
  command.add_option("--fov-deg", options->picture.field_of_view_deg, "vertical field of view (default: 45)")
      ->option_text("DEG")
      ->check(CLI::Range(1.0, 170.0));
  command.add_option("--width", options->picture.width, "pixels (default: 1280)")
      ->option_text("N")
      ->check(CLI::Range(16, 7680));
  command.add_option("--height", options->picture.height, "pixels (default: 720)")
      ->option_text("N")
      ->check(CLI::Range(16, 4320));
  on_call(
      command, inputs, [options](const Inputs& given) { preview(given, *options); }, Needs::scene);
}

}  // namespace pirsim::app
