#include <algorithm>
#include <limits>
#include <sstream>
#include <utility>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/moment.hpp"
#include "app/output_size.hpp"
#include "app/session.hpp"
#include "pirsim/look.hpp"
#include "sim/compiled_study.hpp"

namespace pirsim::app {
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

}  // namespace pirsim::app
