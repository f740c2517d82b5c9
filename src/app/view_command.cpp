#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/moment.hpp"
#include "app/output_size.hpp"
#include "app/session.hpp"
#include "core/text.hpp"
#include "pirsim/look.hpp"
#include "sim/compiled_study.hpp"
#include "studies/coverage.hpp"

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

}  // namespace pirsim::app
