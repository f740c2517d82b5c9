// pirsim's command line: argv -> options -> library calls, and errors -> messages and exit codes.
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <boost/algorithm/string/join.hpp>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <map>
#include <new>
#include <sstream>
#include <string_view>
#include <vector>

#include "app/commands.hpp"
#include "app/output_checks.hpp"
#include "app/row_output.hpp"
#include "pirsim/error.hpp"
#include "pirsim/version.hpp"
#include "rt/room.hpp"

namespace {

using namespace pirsim;
using namespace pirsim::app;

constexpr const char* examples = R"(Examples:
  pirsim --scene room.gltf --script study.yaml                     rows of the whole study as CSV on stdout
  pirsim --scene room.gltf --script study.yaml -o rows.csv --summary table.md
  pirsim check --scene room.gltf --script study.yaml               validate, and report what each sensor can see
  pirsim preview --scene room.gltf --script study.yaml -o room.png  a picture of room, people and beams
  pirsim coverage --scene room.gltf --script studyB.yaml -o maps   where each sensor sees a moving target
  pirsim effects                                                   what a script can add to the plain model
  pirsim export --scene room.gltf --script study.yaml -o run.glb    an animated glTF of one run
  pirsim --scene room.gltf --script study.yaml --shard 3/100 -o out a block of the runs; then pirsim status, merge
)";

/// Without the script's seed and replicates, where others take their place.
void add_scene_and_script(CLI::App& command, Inputs& inputs) {
  command.add_option("--scene", inputs.scene, "room: a glTF 2.0 file (.gltf or .glb)")->option_text("FILE");
  command.add_option("--script", inputs.script, "study: a YAML file")->option_text("FILE");
  command.add_option("--set", inputs.overrides, "override a value of the script: sensing.rays_per_zone=9")
      ->option_text("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_option("--sensors", inputs.sensor_directories, "folder with sensor models, searched first")
      ->option_text("DIR")
      ->allow_extra_args(false);
  command.add_option("--tracer", inputs.tracer, "auto, direct, embree or reference")->option_text("NAME");
  command.add_flag_callback(
      "-q,--quiet", [&] { inputs.verbosity = Verbosity::quiet; }, "errors only");
  command.add_flag_callback(
      "-v,--verbose", [&] { inputs.verbosity = Verbosity::verbose; }, "more about what goes on");
}

void add_inputs(CLI::App& command, Inputs& inputs) {
  add_scene_and_script(command, inputs);
  command
      .add_option_function<std::int64_t>(
          "--seed", [&](std::int64_t n) { inputs.overrides.push_back("seed=" + std::to_string(n)); },
          "seed of all random streams")
      ->option_text("N");
  command
      .add_option_function<int>(
          "--replicates", [&](int n) { inputs.overrides.push_back("replicates=" + std::to_string(n)); },
          "how often every trial is run")
      ->option_text("N");
}

void add_run_options(CLI::App& command, RunOptions& options) {
  command
      .add_option("-o,--output", options.output, "rows, .csv, .csv.gz or .csv.zst (default: as CSV on standard output)")
      ->option_text("FILE");
  command.add_option("--summary", options.summary, "table of sums per trial and sensor, .csv or .md")
      ->option_text("FILE");
  command.add_option("--report", options.report, "counts and time series as one self-contained page, .html")
      ->option_text("FILE");
  command.add_option("--zones", options.zones, "every zone's activity at every tick, .csv, .csv.gz or .csv.zst")
      ->option_text("FILE");
  command
      .add_option("--trace", options.trace,
                  "analog sensors' power, signal and what is behind it at every tick, .csv, .csv.gz or .csv.zst")
      ->option_text("FILE");
  command.add_option("--threads", options.threads, "0: all cores; changes no byte of any result")->option_text("N");
  command
      .add_option("--shard", options.shard,
                  "only this block of the runs: I/N, auto/N or auto (in a job array); -o names a folder")
      ->option_text("I/N");
  command.add_option("--format", options.format, "of a shard: .csv, .csv.gz or .csv.zst (default: .csv)")
      ->option_text("ENDING")
      ->check(CLI::IsMember(table_endings()));
  command.add_flag_callback(
      "--resume", [&] { options.start = RunOptions::Start::resume; },
      "go on at the last whole run; nothing to do if all is done");
  command.add_option("--max-time", options.max_time_s, "stop at the end of a run after so long: 3000, 50m, 2h")
      ->option_text("TIME")
      ->transform(CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1.0}, {"m", 60.0}, {"h", 3600.0}},
                                        CLI::AsNumberWithUnit::CASE_SENSITIVE, "TIME"));
  command.add_flag_callback(
      "--print-config", [&] { options.action = RunOptions::Action::print_config; },
      "print the resolved script and stop");
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

void add_preview_options(CLI::App& command, PreviewOptions& options) {
  command.add_option("-o,--output", options.output, "PNG file (default: preview.png)")->option_text("FILE");
  command.add_option("--trial", options.trial, "which trial (default: the first)")->option_text("ID");
  command.add_option("--replicate", options.replicate, "which replicate (default: 1)")->option_text("N");
  command.add_option("--time", options.time_s, "moment of the run in seconds (default: 10 s into desk work)")
      ->option_text("S");
  command.add_option("--beams", options.beams, "sensors whose beams are drawn, or all or none (default: the first)")
      ->option_text("ID,...")
      ->delimiter(',');
  add_point(command, "--camera", options.camera, "where the camera stands, m");
  add_point(command, "--look-at", options.look_at, "what it looks at, m");
  command.add_option("--fov-deg", options.field_of_view_deg, "vertical field of view (default: 45)")
      ->option_text("DEG")
      ->check(CLI::Range(1.0, 170.0));
  command.add_option("--width", options.width, "pixels (default: 1280)")->option_text("N")->check(CLI::Range(16, 7680));
  command.add_option("--height", options.height, "pixels (default: 720)")
      ->option_text("N")
      ->check(CLI::Range(16, 4320));
}

void add_coverage_options(CLI::App& command, CoverageOptions& options) {
  command.add_option("-o,--output", options.output, "folder for maps and figures")->option_text("DIR");
  command.add_option("--report", options.report, "the maps as one self-contained page, .html")->option_text("FILE");
  command.add_option("--threads", options.threads, "0: all cores; changes no byte of any result")->option_text("N");
}

void add_walk_test_options(CLI::App& command, WalkTestOptions& options) {
  command.add_option("-o,--output", options.output, "points with tries and verdicts, as CSV")->option_text("FILE");
  command.add_option("--report", options.report, "the maps as one self-contained page, .html")->option_text("FILE");
  command.add_option("--threads", options.threads, "0: all cores; changes no byte of any result")->option_text("N");
}

void add_effects_options(CLI::App& command, EffectsOptions& options) {
  command.add_option("name", options.name, "one effect in detail")->option_text("NAME");
  command.add_option("--format", options.format, "text, csv or md")
      ->option_text("NAME")
      ->check(CLI::IsMember({"text", "csv", "md"}));
}

void add_export_options(CLI::App& command, ExportOptions& options) {
  command.add_option("-o,--output", options.output, "glTF file, .gltf or .glb (default: run.glb)")->option_text("FILE");
  command.add_option("--trial", options.trial, "which trial (default: the first)")->option_text("ID");
  command.add_option("--replicate", options.replicate, "which replicate (default: 1)")->option_text("N");
  command.add_option("--keys-per-s", options.keys_per_s, "animation keys a second (default: 10)")
      ->option_text("N")
      ->check(CLI::Range(0.001, 10000.0));
  command.add_option("--beams", options.beams, "sensors whose beams are drawn, or all or none (default: all)")
      ->option_text("ID,...")
      ->delimiter(',');
}

void add_campaign_options(CLI::App& command, CampaignOptions& options) {
  command.add_option("DIR", options.folder, "folder with the shards")->required();
  command.add_flag_callback(
      "-q,--quiet", [&] { options.verbosity = Verbosity::quiet; }, "errors only");
}

void add_merge_options(CLI::App& command, CampaignOptions& options) {
  command.add_option("-o,--output", options.output, "rows, .csv, .csv.gz or .csv.zst")->option_text("FILE");
  command.add_option("--summary", options.summary, "table of sums per trial and sensor, .csv or .md; needs --script")
      ->option_text("FILE");
  command.add_option("--script", options.script, "that of the shards, for the summary")->option_text("FILE");
  command.add_option("--set", options.overrides, "as for the shards")
      ->option_text("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_analysis_options(CLI::App& command, AnalysisOptions& options) {
  command.add_option("--table", options.table, "folder that keeps the reference table (default: DIR/table)")
      ->option_text("DIR");
  command.add_option("--nuisance", options.nuisance, "what is uncertain about the room, YAML; or none")
      ->option_text("FILE");
  command.add_option("--alpha", options.alpha, "level of the tests (default: 0.05)")
      ->option_text("P")
      ->check(CLI::Range(0.001, 0.5));
  command.add_option("--effects", options.effects, "candidates: a,b (default: the whole catalogue)")
      ->option_text("NAMES")
      ->delimiter(',');
  command.add_option("--budget", options.budget, "times the usual number of simulated datasets (default: 1)")
      ->option_text("X")
      ->check(CLI::Range(0.05, 20.0));
  command.add_option("--analysis-seed", options.seed, "of everything random in the analysis (default: 1)")
      ->option_text("N");
  command.add_option("--threads", options.threads, "0: all cores; changes no byte of any result")->option_text("N");
}

/// Returns what its subcommands don't take.
std::vector<CLI::Option*> add_reconcile_options(CLI::App& command, ReconcileOptions& options) {
  return {
      command.add_option("--measured", options.measured, "rows or sums from the real room, CSV")->option_text("FILE"),
      command.add_option("-o,--out", options.output, "folder for report and patched script (default: reconcile)")
          ->option_text("DIR"),
      command
          .add_option("--holdout", options.holdout,
                      "share (0.3) or names (S3,S8) of trials kept from naming and fitting, to be judged on "
                      "(default: every trial once, in folds)")
          ->option_text("TRIALS"),
      command.add_option("--max-effects", options.max_effects, "most effects to put in (default: 3)")
          ->option_text("N")
          ->check(CLI::Range(1, 5))};
}

/// Words for the values of an enumeration.
template <typename Value>
CLI::Validator one_of(std::map<std::string, Value> values) {
  return {[values = std::move(values)](std::string& text) -> std::string {
            if (const auto known = values.find(text); known != values.end()) {
              text = std::to_string(static_cast<int>(known->second));
              return {};
            }
            std::vector<std::string> words;
            for (const auto& [word, value] : values) words.push_back(word);
            return "expected one of " + boost::algorithm::join(words, ", ") + ", not '" + text + "'" +
                   did_you_mean(text, words);
          },
          "", "one of"};
}

void add_selftest_options(CLI::App& command, SelftestOptions& options) {
  using Kind = reconcile::Measured::Kind;
  using reconcile::LeaveOut;
  command.add_option("-o,--out", options.output, "folder for rates and pictures (default: reconcile_selftest)")
      ->option_text("DIR");
  command.add_option("--data", options.kind, "what is planted in: series or sums (default: series)")
      ->option_text("KIND")
      ->transform(one_of<Kind>({{"series", Kind::series}, {"sums", Kind::sums}}));
  command.add_option("--runs", options.runs, "runs of every trial (default: 1)")
      ->option_text("N")
      ->check(CLI::Range(1, 100));
  command.add_option("--nulls", options.nulls, "datasets with nothing hidden (default: 60)")->option_text("N");
  command.add_option("--planted", options.planted, "datasets of every effect and strength (default: 10)")
      ->option_text("N");
  command.add_option("--beyond", options.beyond, "of every effect, stronger than any in the table (default: 0)")
      ->option_text("N");
  command.add_option("--pairs", options.pairs, "datasets with two effects (default: 0)")->option_text("N");
  command.add_option("--aliens", options.aliens, "of every fault that no catalogue has (default: 0)")->option_text("N");
  command
      .add_option(
          "--verify", options.verified,
          "with the right name, judged on held-out trials; and all with nothing hidden and something suspected; "
          "and names put in, to see whether the model passes (default: 0)")
      ->option_text("N");
  command.add_option("--leave-out", options.leave_out, "none, or each: judge by catalogues that lack the effect, too")
      ->option_text("HOW")
      ->transform(one_of<LeaveOut>({{"none", LeaveOut::none}, {"each", LeaveOut::each}}));
}

void add_plan_options(CLI::App& command, PlanOptions& options) {
  using Kind = reconcile::Measured::Kind;
  command.add_option("-o,--out", options.output, "folder for page and tables (default: reconcile_plan)")
      ->option_text("DIR");
  command.add_option("--data", options.kind, "what is to be measured: series or sums (default: series)")
      ->option_text("KIND")
      ->transform(one_of<Kind>({{"series", Kind::series}, {"sums", Kind::sums}}));
  command.add_option("--runs", options.runs, "planned runs of every trial (default: 1)")
      ->option_text("N")
      ->check(CLI::Range(1, 100));
}

void add_seal_options(CLI::App& command, SealOptions& options) {
  using reconcile::Hidden;
  command.add_option("-o,--out", options.output, "folder for data and hash (default: challenge)")->option_text("DIR");
  command.add_option("--answer", options.answer, "where the sealed answer goes, JSON; keep it secret")
      ->option_text("FILE");
  command.add_option("--nuisance", options.nuisance, "what is uncertain about the room, YAML; or none")
      ->option_text("FILE");
  command.add_option("--hide", options.hidden, "any, nothing, one, two or alien (default: any)")
      ->option_text("KIND")
      ->transform(one_of<Hidden>({{"any", Hidden::any},
                                  {"nothing", Hidden::nothing},
                                  {"one", Hidden::one},
                                  {"two", Hidden::two},
                                  {"alien", Hidden::alien}}));
  command.add_option("--runs", options.runs, "runs of every trial (default: 1)")
      ->option_text("N")
      ->check(CLI::Range(1, 100));
  command.add_option("--secret-seed", options.secret_seed, "of everything drawn (default: from the system)")
      ->option_text("N");
}

void add_open_options(CLI::App& command, OpenOptions& options) {
  command.add_option("--answer", options.answer, "the sealed answer")->option_text("FILE")->required();
  command.add_option("--commitment", options.commitment, "the published hash")->option_text("FILE")->required();
  command.add_option("--report", options.report, "report.json to be scored")->option_text("FILE")->required();
}

std::string version_text() {
  return "pirsim " + version() + " (" + git_revision() + "), " + compiler() + ", Embree " + rt::embree_version() + " " +
         rt::instruction_set();
}

int run_command_line(int argc, char** argv) {
  CLI::App app{"Headless simulator of passive-infrared motion sensors", "pirsim"};
  app.footer(examples);
  app.set_version_flag("--version", version_text);
  app.require_subcommand(0, 1);

  Inputs inputs;
  RunOptions run_options;
  PreviewOptions preview_options;
  ExportOptions export_options;
  CoverageOptions coverage_options;
  WalkTestOptions walk_test_options;
  PlacementOptions placement_options;
  AnalysisOptions analysis_options;
  ReconcileOptions reconcile_options;
  SealOptions seal_options;
  OpenOptions open_options;
  EffectsOptions effects_options;
  SelftestOptions selftest_options;
  PlanOptions plan_options;
  add_inputs(app, inputs);
  add_run_options(app, run_options);
  CLI::App* run_command = app.add_subcommand("run", "run the study (the default)");
  add_inputs(*run_command, inputs);
  add_run_options(*run_command, run_options);
  CLI::App* check_command = app.add_subcommand("check", "validate scene and script without running them");
  add_inputs(*check_command, inputs);
  CLI::App* preview_command = app.add_subcommand("preview", "render room, people and beams as PNG");
  add_inputs(*preview_command, inputs);
  add_preview_options(*preview_command, preview_options);
  CLI::App* export_command = app.add_subcommand("export", "write one run as an animated glTF");
  add_inputs(*export_command, inputs);
  add_export_options(*export_command, export_options);

  CLI::App* effects_command = app.add_subcommand("effects", "list what a script can add to the plain model");
  add_effects_options(*effects_command, effects_options);
  CLI::App* coverage_command = app.add_subcommand("coverage", "map where each sensor sees a moving target");
  add_inputs(*coverage_command, inputs);
  add_coverage_options(*coverage_command, coverage_options);
  CLI::App* walk_test_command = app.add_subcommand("walktest", "how surely walkers and sitters are noticed in time");
  add_inputs(*walk_test_command, inputs);
  add_walk_test_options(*walk_test_command, walk_test_options);
  CLI::App* placements_command = app.add_subcommand("placements", "rank sets of sensors, and look for a better one");
  add_inputs(*placements_command, inputs);
  placements_command->add_option("--threads", placement_options.threads, "0: all cores; changes no byte of any result")
      ->option_text("N");

  CampaignOptions campaign_options;
  CLI::App* status_command = app.add_subcommand("status", "which shards of a folder are missing or broken");
  add_campaign_options(*status_command, campaign_options);
  CLI::App* merge_command = app.add_subcommand("merge", "shards to one file, the same as of one process");
  add_campaign_options(*merge_command, campaign_options);
  add_merge_options(*merge_command, campaign_options);

  CLI::App* reconcile_command =
      app.add_subcommand("reconcile", "where model and measurement disagree, and which effect is missing");
  add_inputs(*reconcile_command, inputs);
  const std::vector<CLI::Option*> reconcile_only = add_reconcile_options(*reconcile_command, reconcile_options);
  add_analysis_options(*reconcile_command, analysis_options);
  reconcile_command->require_subcommand(0, 1);
  CLI::App* selftest_command =
      reconcile_command->add_subcommand("selftest", "hide effects in simulated data and see which are found");
  add_scene_and_script(*selftest_command, inputs);
  add_selftest_options(*selftest_command, selftest_options);
  add_analysis_options(*selftest_command, analysis_options);
  CLI::App* plan_command =
      reconcile_command->add_subcommand("plan", "before measuring: what could be told apart, and what to measure next");
  add_scene_and_script(*plan_command, inputs);
  add_plan_options(*plan_command, plan_options);
  add_analysis_options(*plan_command, analysis_options);
  CLI::App* seal_command = reconcile_command->add_subcommand("seal", "hide something in data, to be found blindly");
  add_scene_and_script(*seal_command, inputs);
  add_seal_options(*seal_command, seal_options);
  CLI::App* open_command = reconcile_command->add_subcommand("open", "score a report against the sealed answer");
  add_open_options(*open_command, open_options);
  for (CLI::App* command : {selftest_command, plan_command, seal_command, open_command}) {
    for (CLI::Option* option : reconcile_only) command->excludes(option);
  }

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : static_cast<int>(ErrorCode::usage);
  }
  if (*status_command || *merge_command) {
    *status_command ? status(campaign_options) : merge(campaign_options);
    return 0;
  }
  if (*open_command) {
    open_challenge(open_options);
    return 0;
  }
  if (*effects_command) {
    list_effects(effects_options);
    return 0;
  }
  if (inputs.scene.empty() || inputs.script.empty()) {
    throw Error(ErrorCode::usage,
                std::string(inputs.scene.empty() ? "--scene" : "--script") + " FILE is missing; see pirsim --help");
  }
  if (*check_command) {
    check(inputs);
  } else if (*preview_command) {
    preview(inputs, preview_options);
  } else if (*coverage_command) {
    coverage(inputs, coverage_options);
  } else if (*walk_test_command) {
    walk_test(inputs, walk_test_options);
  } else if (*selftest_command) {
    reconcile_selftest(inputs, analysis_options, selftest_options);
  } else if (*plan_command) {
    reconcile_plan(inputs, analysis_options, plan_options);
  } else if (*seal_command) {
    seal_challenge(inputs, seal_options);
  } else if (*reconcile_command) {
    reconcile_data(inputs, analysis_options, reconcile_options);
  } else if (*placements_command) {
    placements(inputs, placement_options);
  } else if (*export_command) {
    export_gltf(inputs, export_options);
  } else {
    run(inputs, run_options);
  }
  return 0;
}

/// Libraries may allocate where they must not throw, as nlohmann's destructor does: that ends here.
[[noreturn]] void end_without_memory() {
  try {
    if (const std::exception_ptr fault = std::current_exception()) std::rethrow_exception(fault);
  } catch (const std::bad_alloc&) {
    constexpr std::string_view message = "error: out of memory\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message.data(), message.size());
    std::_Exit(static_cast<int>(ErrorCode::internal));
  } catch (...) {
  }
  std::abort();
}

}  // namespace

int main(int argc, char** argv) {
  std::set_terminate(end_without_memory);
  std::signal(SIGPIPE, SIG_IGN);  // so that unfinished files are removed first
  try {
    return run_command_line(argc, argv);
  } catch (const Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.code());
  } catch (const ClosedPipe&) {
    std::signal(SIGPIPE, SIG_DFL);  // `pirsim ... | head` ends quietly
    std::raise(SIGPIPE);
  } catch (const std::bad_alloc&) {
    std::cerr << "error: out of memory\n";
  } catch (const std::exception& error) {
    std::cerr << "error: internal fault: " << error.what() << '\n';
  }
  return static_cast<int>(ErrorCode::internal);
}
