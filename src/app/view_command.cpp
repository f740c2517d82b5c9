#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/options.hpp"
#include "app/session.hpp"
#include "app/study_run.hpp"
#include "engine/sim/compiled_study.hpp"
#include "files/disk/file.hpp"
#include "files/read/marks_file.hpp"
#include "model/core/text.hpp"
#include "pirsim/look.hpp"
#include "rooms/suggested_marks.hpp"
#include "surveys/coverage.hpp"
#include "surveys/picture.hpp"

namespace pirsim::app {
namespace {

struct ViewOptions {
  std::filesystem::path output = "run.html";
  RunChoice run;
  std::string from, to;            ///< empty: not given
  std::filesystem::path coverage;  ///< a coverage study; empty: no map
  double keys_per_s = 10.0;
  Size size = Size::usual;
};

/// Of a part that is asked for: what nobody asks for is short.
void require_usual(const PageRequest& request, const Model& model, Size size) {
  if (!request.from_s || !request.to_s) return;
  constexpr double base64_and_copies = 1.4;  // of what is in the page, four characters of three bytes
  const sim::TrialModel& trial = model.compiled().trial_of(request.run);
  const double to_s = std::min(*request.to_s, trial.duration_s.value_or(*request.to_s));
  require_usual({"the page", trial.people.size(), request.keys_per_s, base64_and_copies}, to_s - *request.from_s, size);
}

void view(const Inputs& inputs, const ViewOptions& options) {
  const Model model = load(inputs);
  PageRequest request;
  request.run = find_run(model, options.run);
  const std::optional<RunClock> clock = model.compiled().clock_of(request.run);
  if (!options.from.empty()) request.from_s = moment("--from", options.from, clock);
  if (!options.to.empty()) request.to_s = moment("--to", options.to, clock);
  request.keys_per_s = options.keys_per_s;
  request.scene = io::name_of_input(inputs.scene);
  request.script = io::name_of_input(inputs.script);
  if (!options.coverage.empty()) {
    request.coverage = io::read_coverage(found(io::DataKind::studies, options.coverage));
    const studies::CoverageStudy study(model.compiled().scene(), *request.coverage);
    tell(study.warnings(), inputs.verbosity);
    tell_what_is_left_out(study, inputs.verbosity);
  }
  require_usual(request, model, options.size);
  std::optional<Progress> progress;
  progress.emplace(Work{"simulating", 1, "runs", request.to_s.value_or(0.0)}, inputs.verbosity);
  const StopRequest stop;
  request.simulated = [&](double seconds) {
    progress->simulated(seconds);
    stop.throw_if_made();
  };
  const Page page = page_of(model, request);
  progress.reset();
  io::write_text_file(options.output, page.html);
  if (inputs.verbosity == Verbosity::quiet) return;
  const double megabytes = std::ceil(static_cast<double>(page.html.size()) / 1e5) / 10.0;
  tell_written({{options.output, page.about + ", " + span_text(clock, page.from_s, page.to_s) + " of " +
                                     span_text(clock, 0.0, page.run_s) + ", " + fixed(megabytes, 1) + " MB"}},
               inputs.verbosity);
  if (page.is_busiest_part) {
    std::cerr << "the run is longer than " << page.to_s - page.from_s
              << " s: these are the seconds with most motion; --from and --to choose others\n";
  }
}

}  // namespace

void add_view_command(CLI::App& app) {
  CLI::App& command = add_command(app, "view", "write a page that plays one run, in any browser", R"(
  pirsim view --scene room.gltf --script study.yaml -o run.html                     the first trial
  pirsim view --scene room.gltf --script study.yaml --trial S8 --replicate 3 -o S8.html
  pirsim view --scene office.gltf --script week.yaml --from 09:00 --to 09:20        part of a day
  pirsim view --scene room.gltf --script study.yaml --coverage studyB.yaml          a coverage map on the floor
)");
  const auto inputs = std::make_shared<Inputs>();
  const auto options = std::make_shared<ViewOptions>();
  offer_study(command, *inputs);
  offer_tracer(command, *inputs);
  offer_seed(command, *inputs);
  offer_output(command, output_names, options->output, "page, .html (default: run.html)", {".html"});
  offer_run_choice(command, options->run);
  offer_moment(command, "--from", options->from, "where the page begins",
               "the run's beginning; of runs over 1200 s the 1200 s with most motion");
  offer_moment(command, "--to", options->to, "where the page ends, however long it gets",
               "the run's end, but at most 1200 s after --from");
  offer_input_file(command, "--coverage", options->coverage, "a coverage study, YAML, whose map is laid on the floor");
  command
      .add_option("--keys-per-s", options->keys_per_s, "pictures a second, between which it interpolates (default: 10)")
      ->option_text("N")
      ->check(CLI::Range(0.1, 100.0));
  offer_size(command, options->size);
  on_call(command, inputs, [options](const Inputs& given) { view(given, *options); });
}

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

namespace {

struct ExportOptions {
  std::filesystem::path output = "run.glb";
  RunChoice run;
  FilmRequest film;
  std::string from, to;  ///< empty: not given
  Size size = Size::usual;
};

/// How long a run is may be known only when it ends, so that a film that gets too large is refused when it does.
double write_film(const Model& model, FilmRequest film, const ExportOptions& options, Verbosity verbosity) {
  const sim::TrialModel& trial = model.compiled().trial_of(film.run);
  const FilmSize size{"the film", trial.people.size(), film.keys_per_s};
  const double from_s = film.from_s.value_or(0.0);
  const double known_end_s =
      std::min(film.to_s.value_or(std::numeric_limits<double>::max()), trial.duration_s.value_or(0.0));
  require_usual(size, known_end_s - from_s, options.size);
  Progress progress({"simulating and filming", 1, "runs", known_end_s}, verbosity);
  const StopRequest stop;
  double so_far_s = 0.0;
  film.simulated = [&](double seconds) {
    progress.simulated(seconds);
    stop.throw_if_made();
    require_usual(size, (so_far_s += seconds) - from_s, options.size);
  };
  return export_run(options.output, model, film);
}

void export_gltf(const Inputs& inputs, const ExportOptions& options) {
  const Model model = load(inputs);
  const std::uint32_t run = find_run(model, options.run);
  const std::optional<RunClock> clock = model.compiled().clock_of(run);
  FilmRequest film = options.film;
  film.run = run;
  if (!options.from.empty()) film.from_s = moment("--from", options.from, clock);
  if (!options.to.empty()) film.to_s = moment("--to", options.to, clock);
  const double length_s = write_film(model, std::move(film), options, inputs.verbosity);
  std::ostringstream about;
  about << model.script().name << ", trial " << model.trial_of(run) << ", " << length_s << " s";
  tell_written({{options.output, about.str()}}, inputs.verbosity);
}

}  // namespace

void add_export_command(CLI::App& app) {
  CLI::App& command = add_command(app, "export", "write one run as an animated glTF", R"(
  pirsim export --scene room.gltf --script study.yaml -o run.glb   the first trial
  pirsim export --scene room.gltf --script study.yaml --trial S8 --beams PIR4,PIR5 -o S8.gltf
  pirsim export --scene office.gltf --script week.yaml --from 09:00 --to 09:05      part of a day
)");
  const auto inputs = std::make_shared<Inputs>();
  const auto options = std::make_shared<ExportOptions>();
  offer_study(command, *inputs);
  offer_tracer(command, *inputs);
  offer_seed(command, *inputs);
  offer_output(command, output_names, options->output, "glTF file, .gltf or .glb (default: run.glb)",
               {".gltf", ".glb"});
  offer_run_choice(command, options->run);
  offer_moment(command, "--from", options->from, "where the film begins", "the run's beginning");
  offer_moment(command, "--to", options->to, "where the film ends", "the run's end");
  command.add_option("--keys-per-s", options->film.keys_per_s, "animation keys a second (default: 10)")
      ->option_text("N")
      ->check(CLI::Range(0.001, 10000.0));
  command.add_option("--beams", options->film.beams, "sensors whose beams are drawn, or all or none (default: all)")
      ->option_text("ID,...")
      ->delimiter(',');
  offer_size(command, options->size);
  on_call(command, inputs, [options](const Inputs& given) { export_gltf(given, *options); });
}

namespace {

struct CheckOptions {
  bool suggests = false;
  studies::SuggestionHints hints;
  std::filesystem::path output;  ///< empty: standard output
};

/// Marks that somebody edited are worth more than new ones.
void refuse_to_overwrite(const std::filesystem::path& file) {
  std::error_code unknown;
  if (!file.empty() && !io::is_written_directly(file) && std::filesystem::exists(file, unknown))
    throw Error(ErrorCode::usage, "-o: '" + file.string() + "' is there already and isn't overwritten");
}

void suggest(const Inputs& inputs, const CheckOptions& options) {
  if (!inputs.marks.empty()) throw Error(ErrorCode::usage, "--suggest makes marks; it doesn't go with --marks");
  refuse_to_overwrite(options.output);
  const std::string name = io::name_of_input(inputs.scene);
  const std::string text = [&] {
    const Progress progress({.what = "looking for floors and rooms in " + name}, inputs.verbosity);
    io::ModelParts model = io::read_model_parts(found(io::DataKind::rooms, inputs.scene));
    tell(model.warnings, inputs.verbosity);
    return studies::to_yaml(studies::suggest(std::move(model), options.hints, name), name);
  }();
  if (options.output.empty()) {
    std::cout << text;
    return require_written();
  }
  io::write_text_file(options.output, text);
  tell_written({{options.output}}, inputs.verbosity);
}

void check(const Inputs& inputs, const CheckOptions& options) {
  if (options.suggests) return suggest(inputs, options);
  if (options.hints.floor_m || !options.hints.ignored.empty() || !options.output.empty()) {
    throw Error(ErrorCode::usage, std::string(options.hints.floor_m           ? "--floor"
                                              : options.hints.ignored.empty() ? "-o"
                                                                              : "--ignore") +
                                      " goes with --suggest");
  }
  // Warnings are what a check is made for: --quiet leaves out only the report.
  Inputs with_warnings = inputs;
  with_warnings.verbosity = Verbosity::normal;
  const Model model = load(with_warnings, inputs.verbosity);
  const CheckReport report = [&] {
    const Progress progress({.what = "looking at what sensors see"}, inputs.verbosity);
    return check_study(model);
  }();
  if (inputs.verbosity != Verbosity::quiet) std::cout << report.text;
  require_written();
  tell(report.warnings, Verbosity::normal);  // last, where a terminal shows them
}

}  // namespace

void add_check_command(CLI::App& app) {
  CLI::App& command = add_command(app, "check", "validate scene and script without running them", R"(
  pirsim check --scene room.gltf --script study.yaml               validate, and report what each sensor can see
  pirsim check --scene room.gltf                                   the same of a room alone
  pirsim check --scene room.gltf --script study.yaml -q            only faults and warnings
  pirsim check --scene flat.glb --suggest -o marks.yaml            propose marks for a model that has none
)");
  const auto inputs = std::make_shared<Inputs>();
  const auto options = std::make_shared<CheckOptions>();
  offer_study(command, *inputs);
  offer_tracer(command, *inputs);
  offer_replicates(command, *inputs);
  command.add_flag("--suggest", options->suggests,
                   "propose a file of marks for the scene, to be edited; no script is needed");
  command
      .add_option("--floor", options->hints.floor_m,
                  "of --suggest: the floor's height (default: the lowest large one's)")
      ->option_text("M");
  command
      .add_option("--ignore", options->hints.ignored,
                  "of --suggest: a node to leave out with all below it, as `ignore` of marks; repeatable")
      ->option_text("NODE")
      ->allow_extra_args(false);
  offer_output(command, output_names, options->output, "of --suggest: marks, .yaml (default: standard output)",
               {".yaml", ".yml"});
  on_call(
      command, inputs, [options](const Inputs& given) { check(given, *options); }, Needs::scene);
}

}  // namespace pirsim::app
