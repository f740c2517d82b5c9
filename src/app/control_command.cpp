#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/dataset_command.hpp"
#include "app/log_command.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "files/disk/file.hpp"
#include "logs/calibrate_light.hpp"
#include "logs/log_rows.hpp"
#include "model/core/text.hpp"
#include "pirsim/control.hpp"
#include "show/report.hpp"
#include "surveys/light_page.hpp"

namespace pirsim::app {
namespace {

struct ControlOptions {
  std::vector<std::filesystem::path> rows;
  LogInputs log;
  Inputs inputs;  ///< of the scene
  std::filesystem::path rule, counter, output, report, light, advised;
  std::vector<double> delays_min;
  std::optional<double> window_s, at_most_a_week;
};

control::RuleSpec rule_of(const ControlOptions& options, std::vector<Issue>& remarks) {
  std::optional<SceneSpec> scene;
  if (!options.inputs.scene.empty()) scene = read_scene(options.inputs);
  std::optional<control::RuleSpec> given;
  if (!options.rule.empty()) given = control::read_rule(options.rule);
  control::RuleSpec rule =
      control::rule_for(std::move(given), scene ? &*scene : nullptr, io::stem_of_input(options.inputs.scene), remarks);
  for (control::LightSpec& light : rule.lights) {
    if (!options.delays_min.empty()) light.delays_min = options.delays_min;
    light.at_most_a_week = options.at_most_a_week.value_or(light.at_most_a_week);
  }
  return rule;
}

bool has_study(const ControlOptions& options) {
  return !options.inputs.scene.empty() && !options.inputs.script.empty();
}

std::string view_command(const ControlOptions& options) {
  if (!has_study(options)) return {};
  std::string words = "pirsim view";
  for (const std::string& word : model_options(options.inputs)) words += " " + word;
  return words;
}

template <typename Source>
control::Costs costs_of(const Source& /*source*/, const control::Control& control, const control::RuleSpec& /*rule*/) {
  return control.finish();
}
control::Costs costs_of(const control::CountedSamples& source, const control::Control& /*control*/,
                        const control::RuleSpec& rule) {
  control::Costs costs = source.expected_costs(rule);
  costs.remarks.insert(costs.remarks.end(), source.remarks().begin(), source.remarks().end());
  return costs;
}

template <typename Source>
void control_rows(const ControlOptions& options, Source&& source) {
  std::vector<Issue> remarks;
  const control::RuleSpec rule = rule_of(options, remarks);
  if (has_study(options)) {
    const std::vector<Issue> deaf = control::deaf_seats(rule, load(options.inputs, Verbosity::quiet));
    remarks.insert(remarks.end(), deaf.begin(), deaf.end());
  }
  const control::RowsAbout& about = source.about();
  control::Control control(rule, about.columns, about.window_s, about.people);
  control::LitDays days(rule, about.window_s);
  std::optional<control::LitTable> lit_table;
  if (!options.light.empty()) lit_table.emplace(options.light, rule);
  {
    const Progress progress({"switching light"}, options.inputs.verbosity);
    const StopRequest stop;
    const auto take = [&](const Sample& row, std::string_view day) {
      stop.throw_if_made();
      const control::LitRow lit = control.add(row, day);
      days.add(row, lit);
      if (lit_table) lit_table->add(row, lit);
    };
    control.note_missing(source.each(take, [&] { control.begin_run(); }));
  }
  control::Costs costs = costs_of(source, control, rule);
  costs.remarks.insert(costs.remarks.begin(), remarks.begin(), remarks.end());
  if (lit_table) lit_table->finish();
  tell(costs.remarks, options.inputs.verbosity);
  if (options.inputs.verbosity != Verbosity::quiet) std::cout << control::to_text(costs);
  require_written();
  if (!options.output.empty()) io::write_text_file(options.output, control::to_csv(costs));
  if (!options.advised.empty()) io::write_text_file(options.advised, control::advised_rule(rule, costs));
  if (!options.report.empty()) {
    io::Report report = control::control_page(costs, days, view_command(options));
    std::vector<std::filesystem::path> files = options.rows.empty() ? options.log.files : options.rows;
    files.push_back(options.rule);
    report.footer = made_from(files);
    io::write_report(options.report, report);
  }
  tell_written({{options.output}, {options.light}, {options.advised}, {options.report}}, options.inputs.verbosity);
}

void check_options(const ControlOptions& options) {
  if (options.rows.empty() == options.log.files.empty())
    throw Error(ErrorCode::usage, "say which rows: files of runs, a dataset's folder, or --log");
  if (!options.counter.empty() && options.log.files.empty())
    throw Error(ErrorCode::usage, "--counter: it counts the people of a --log");
  for (auto delay = options.delays_min.begin(); delay != options.delays_min.end(); ++delay) {
    if (std::find(options.delays_min.begin(), delay, *delay) != delay)
      throw Error(ErrorCode::usage, "--delay: " + shortest_number(*delay) + " is given twice");
  }
}

void control_light(const ControlOptions& options) {
  check_options(options);
  if (!options.rows.empty()) {
    control::RowFiles rows(options.rows);
    keep_inputs(options.inputs, rows.files());
    return control_rows(options, rows);
  }
  const Log log = read_log(options.log, options.inputs.verbosity);
  if (options.counter.empty()) return control_rows(options, control::LogSamples(log, options.window_s));
  control_rows(options, control::CountedSamples(log, counting::read_counter(options.counter)));
}

}  // namespace

void add_control_command(CLI::App& app) {
  CLI::App& command = add_command(app, "control", "switch light by sensors, and say what each delay costs", R"(
  pirsim control week.csv --report light.html                        one light, by any sensor
  pirsim control week.csv --scene office.gltf --report light.html    a light for each area, by its own sensors
  pirsim control week.csv --rule rule.yaml -o costs.csv --light lit.csv
  pirsim control --log week.csv --delay 5 --report light.html        of a log: when it would have been lit
  pirsim control --log week.csv --counter DIR/counter.json           and on whom it would have gone off, probably
)");
  const auto options = std::make_shared<ControlOptions>();
  CLI::Option* rows =
      command.add_option("rows", options->rows, "rows of runs, a dataset's folder, or what pirsim log -o writes");
  declare_inputs(command, as_input(rows)->option_text("ROWS..."), options->rows, dataset_contents());
  offer_log(command, options->log);
  command.get_option("--log")->required(false);
  CLI::Option* step = command.add_option("--step", options->window_s, "of an event log: length of a row (default: 1)")
                          ->option_text("SECONDS");
  offer_input_file(command, "--counter", options->counter,
                   "of pirsim calibrate: what to expect of a log that nobody counted; rows are of its step")
      ->excludes(step);
  offer_input_file(command, "--rule", options->rule, "lights, their sensors and delays, YAML (default: any sensor)");
  command
      .add_option("--delay", options->delays_min, "instead of the rule's; several: the first is the one that counts")
      ->option_text("MINUTES...")
      ->check(CLI::Range(0.0, 1440.0));
  command
      .add_option(
          "--at-most", options->at_most_a_week,
          "so often a week the light may go off on somebody: which delay is told to be long enough (default: 1)")
      ->option_text("TIMES")
      ->check(CLI::Range(1e-3, 1e4));
  Inputs& inputs = options->inputs;
  offer_input_file(command, "--scene", inputs.scene,
                   "its areas' sensors: of a rule's lights, or of one for each area; .gltf or .glb");
  offer_input_file(command, "--marks", inputs.marks, "marks for a scene without: a YAML file");
  offer_input_file(command, "--script", inputs.script,
                   "with --scene: what made the rows, for links to the worst moments and seats that no sensor notices");
  offer_sensors(command, inputs);
  offer_output(command, output_names, options->output, "costs by light and delay, .csv", {".csv"});
  offer_output(command, "--report", options->report,
               "a page with the curves, the lit times and the worst moments, .html", {".html"});
  offer_output(command, "--light", options->light, "rows of when each light is on, .csv, .csv.gz or .csv.zst",
               io::table_endings());
  offer_output(command, "--advised", options->advised, "the rule with the delays that are advised, .yaml",
               {".yaml", ".yml"});
  offer_quiet(command, inputs.verbosity);
  command.callback([options] { control_light(*options); });
}

}  // namespace pirsim::app
