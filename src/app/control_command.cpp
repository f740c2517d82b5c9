#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/dataset_command.hpp"
#include "app/log_command.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "files/disk/compression.hpp"
#include "files/disk/file.hpp"
#include "logs/log_rows.hpp"
#include "model/core/text.hpp"
#include "model/schema/check_scene.hpp"
#include "pirsim/control.hpp"
#include "pirsim/look.hpp"
#include "pirsim/version.hpp"
#include "show/report.hpp"
#include "surveys/light_page.hpp"

namespace pirsim::app {
namespace {

struct ControlOptions {
  std::vector<std::filesystem::path> rows;
  LogInputs log;
  Inputs inputs;  ///< of the scene
  std::filesystem::path rule, output, report, light;
  std::vector<double> delays_min;
  std::optional<double> window_s, at_most_a_week;
};

control::RuleSpec rule_of(const ControlOptions& options, std::vector<Issue>& remarks) {
  control::RuleSpec rule{"any sensor", {{}}};
  std::optional<SceneSpec> scene;
  if (!options.inputs.scene.empty()) scene = read_scene(options.inputs);
  if (!options.rule.empty()) {
    rule = control::read_rule(options.rule);
    if (scene) control::name_sensors(rule, *scene);
  } else if (scene) {
    rule = control::rule_of(*scene, io::stem_of_input(options.inputs.scene), remarks);
  }
  for (control::LightSpec& light : rule.lights) {
    if (!options.delays_min.empty()) light.delays_min = options.delays_min;
    light.at_most_a_week = options.at_most_a_week.value_or(light.at_most_a_week);
  }
  return rule;
}

/// Seats where none of a light's sensors notices somebody at work: who is alone there sits in the dark at any delay.
void remark_deaf_seats(const ControlOptions& options, const control::RuleSpec& rule, std::vector<Issue>& remarks) {
  if (options.inputs.scene.empty() || options.inputs.script.empty()) return;
  const Model model = load(options.inputs, Verbosity::quiet);
  const SceneSpec& scene = model.scene();
  const Areas areas(scene);
  const WorkReport work = check_study(model).work;
  const auto is_here = [&](const std::string& sensor) {
    return std::ranges::find(scene.sensors, sensor, &SensorSpec::id) != scene.sensors.end();
  };
  for (const control::LightSpec& light : rule.lights) {
    if (!std::ranges::all_of(light.sensors, is_here)) continue;  // the rows are of other sensors than the scene's
    std::vector<std::string> unnoticed;
    for (std::size_t seat = 0; seat < work.seats.size(); ++seat) {
      const SeatSpec& place = *std::ranges::find(scene.seats, work.seats[seat], &SeatSpec::id);
      if (!light.area.empty() && areas.name_at(floor_point(place.world_from_seat.origin)) != light.area) continue;
      bool is_noticed = false;
      for (std::size_t sensor = 0; sensor < scene.sensors.size(); ++sensor) {
        const bool switches =
            light.sensors.empty() || std::ranges::find(light.sensors, scene.sensors[sensor].id) != light.sensors.end();
        is_noticed = is_noticed || (switches && work.notice(seat, sensor).seconds > 0);
      }
      if (!is_noticed) unnoticed.push_back(place.id);
    }
    if (unnoticed.empty()) continue;
    remarks.push_back({Severity::warning,
                       {scene.name},
                       "light '" + light.id + "': none of its sensors notices somebody at work in " +
                           joined(unnoticed, ", ") +
                           ": who is alone there sits in the dark at any delay; `pirsim check` says why"});
  }
}

/// What rows are made into, as they come.
class Outputs {
 public:
  Outputs(const ControlOptions& options, const control::RuleSpec& rule, const control::RowsAbout& about)
      : control_(rule, about.columns, about.window_s, about.people), days_(rule, about.window_s) {
    if (!options.light.empty()) {
      lit_file_.emplace(options.light);
      lit_data_.emplace(lit_file_->stream(), io::compression_of(options.light));
      lit_.emplace(lit_text_, rule);
    }
  }

  void begin_run() noexcept { control_.begin_run(); }
  void add(const Sample& row, std::string_view day) {
    const control::LitRow lit = control_.add(row, day);
    days_.add(row, lit);
    if (!lit_) return;
    lit_->add(row, lit);
    constexpr std::streamoff piece = 1 << 16;
    if (lit_text_.tellp() > piece) flush();
  }

  [[nodiscard]] control::Costs costs() const { return control_.finish(); }
  [[nodiscard]] const control::LitDays& days() const noexcept { return days_; }

  void finish() {
    if (!lit_) return;
    flush();
    lit_data_->finish();
    lit_file_->commit();
  }

 private:
  void flush() {
    lit_data_->write(lit_text_.str());
    lit_text_.str({});
  }

  control::Control control_;
  control::LitDays days_;
  std::ostringstream lit_text_;
  std::optional<io::AtomicFile> lit_file_;
  std::optional<io::DataWriter> lit_data_;
  std::optional<control::LitTable> lit_;
};

std::string view_command(const ControlOptions& options) {
  if (options.inputs.scene.empty() || options.inputs.script.empty()) return {};
  std::string words = "pirsim view";
  for (const std::string& word : model_options(options.inputs)) words += " " + word;
  return words;
}

template <typename Source>
void control_rows(const ControlOptions& options, Source&& source) {
  std::vector<Issue> remarks;
  const control::RuleSpec rule = rule_of(options, remarks);
  remark_deaf_seats(options, rule, remarks);
  Outputs outputs(options, rule, source.about());
  {
    const Progress progress({"switching light"}, options.inputs.verbosity);
    const StopRequest stop;
    source.each(
        [&](const Sample& row, std::string_view day) {
          stop.throw_if_made();
          outputs.add(row, day);
        },
        [&] { outputs.begin_run(); });
  }
  control::Costs costs = outputs.costs();
  costs.remarks.insert(costs.remarks.begin(), remarks.begin(), remarks.end());
  if (const std::int64_t n = source.n_missing(); n > 0) {
    costs.remarks.push_back({Severity::warning,
                             {},
                             counted(static_cast<std::size_t>(n), "row") + " of " +
                                 shortest_number(source.about().window_s) +
                                 " s are missing between those that are there: nothing is known of them"});
  }
  if (source.about().people == control::People::unknown) {
    costs.remarks.push_back({Severity::warning, {}, "the rows have no people: who was left in the dark isn't known"});
  }
  outputs.finish();
  tell(costs.remarks, options.inputs.verbosity);
  if (options.inputs.verbosity != Verbosity::quiet) std::cout << control::to_text(costs);
  require_written();
  if (!options.output.empty()) io::write_text_file(options.output, control::to_csv(costs));
  if (!options.report.empty()) {
    io::Report report = control::control_page(costs, outputs.days(), view_command(options));
    std::vector<std::filesystem::path> files = options.rows.empty() ? options.log.files : options.rows;
    files.push_back(options.rule);
    report.footer = made_from(files);
    io::write_report(options.report, report);
  }
  tell_written({{options.output}, {options.light}, {options.report}}, options.inputs.verbosity);
}

void check_options(const ControlOptions& options) {
  if (options.rows.empty() == options.log.files.empty())
    throw Error(ErrorCode::usage, "say which rows: files of runs, a dataset's folder, or --log");
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
  control_rows(options, control::LogSamples(log, options.window_s));
}

}  // namespace

void add_control_command(CLI::App& app) {
  CLI::App& command = add_command(app, "control", "switch light by sensors, and say what each delay costs", R"(
  pirsim control week.csv --report light.html                        one light, by any sensor
  pirsim control week.csv --scene office.gltf --report light.html    a light for each area, by its own sensors
  pirsim control week.csv --rule rule.yaml -o costs.csv --light lit.csv
  pirsim control --log week.csv --delay 5 --report light.html        of a log: when it would have been lit
)");
  const auto options = std::make_shared<ControlOptions>();
  CLI::Option* rows =
      command.add_option("rows", options->rows, "rows of runs, a dataset's folder, or what pirsim log -o writes");
  declare_inputs(command, as_input(rows)->option_text("ROWS..."), options->rows, dataset_contents());
  offer_log(command, options->log);
  command.get_option("--log")->required(false);
  command.add_option("--step", options->window_s, "of an event log: length of a row (default: 1)")
      ->option_text("SECONDS");
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
  offer_quiet(command, inputs.verbosity);
  command.callback([options] { control_light(*options); });
}

}  // namespace pirsim::app
