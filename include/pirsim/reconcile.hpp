// Model against measurement: do they agree, where don't they, which effect is missing, how strong is it, and does it
// help on trials that it wasn't fitted on? Link pirsim::reconcile. What every word means: docs/howto/reconcile.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/log.hpp"
#include "pirsim/reconcile_outcome.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim::reconcile {

using pirsim::unknown_bit;

/// The rows of one run of one trial, one after the other without a gap. The main part, which is compared in time, goes
/// from the first to the last row in a counted phase.
struct Series {
  std::size_t trial = 0;  ///< of the script
  int replicate = 1;
  std::size_t main_begin = 0, main_end = 0;  ///< rows
  std::vector<std::uint8_t> bits;            ///< (n_rows x n_sensors) 0, 1 or unknown_bit

  [[nodiscard]] std::size_t n_rows(std::size_t n_sensors) const noexcept { return bits.size() / n_sensors; }
  bool operator==(const Series&) const = default;
};

/// What was measured in the real room, checked against the study that it is compared with.
struct Measured {
  enum class Kind {
    series,  ///< a bit a window
    sums     ///< seconds with motion in the counted phases only
  };
  /// Seconds of one cell in one repetition.
  struct Sum {
    std::size_t trial = 0, sensor = 0;
    int replicate = 1;
    double seconds = 0.0;
  };
  Kind kind = Kind::series;
  std::vector<Series> runs;        ///< of series: by trial, then replicate, numbered from 1 in every trial
  std::vector<Sum> sums;           ///< of sums; cells that aren't there weren't measured
  std::vector<std::string> notes;  ///< what was done with which rows
  std::string file;                ///< its name, for messages
  std::string digest;              ///< SHA-256 of the file
  bool tells_phases = true;        ///< or all rows are taken for the counted ones
  std::vector<double> holds_s;     ///< (n_sensors) how long motion is held, as a log tells; 0: it doesn't. Or empty

  [[nodiscard]] int n_replicates() const noexcept;        ///< the greatest number of runs of a trial
  [[nodiscard]] std::vector<std::size_t> trials() const;  ///< ascending; of which anything was measured
};
/// Reads pirsim's own rows (docs/formats/rows.md), compressed or not, or sums with the columns trial (or seat), sensor,
/// seconds (or real) and, if it is there, replicate; or a log (docs/formats/log.md), whose columns and times `map` may
/// explain. Empty fields are missing values. Throws Error: io (no such file), input (all faults with file:line:column:
/// unknown names, other values than 0 and 1, rows that aren't a window apart, too little data; a script that draws who
/// is there, which no data can be compared with).
[[nodiscard]] Measured read_measured(const std::filesystem::path& file, const SceneSpec& scene,
                                     const ScriptSpec& script, const LogMap& map = {});
/// What a log says of the script's runs. Throws as read_measured() does.
[[nodiscard]] Measured measured_of(const Log& log, const SceneSpec& scene, const ScriptSpec& script);
/// The script with sensors that hold motion for as long as their log told, unless the script has such holds already.
[[nodiscard]] ScriptSpec with_holds(const SceneSpec& scene, const ScriptSpec& script, const Measured& measured);
/// Reads measured data from a text, as read_measured does from a file; file: its name in messages.
[[nodiscard]] Measured parse_measured(std::string_view text, const std::string& file, const SceneSpec& scene,
                                      const ScriptSpec& script);

struct TableSettings {
  std::uint32_t n_realizations = 1500;  ///< of the plain model, a dataset each
  std::uint32_t n_remembered = 1000;    ///< datasets of an effect that acts on remembered zones
  std::uint32_t n_traced = 400;         ///< datasets of an effect that needs new tracing
  std::vector<std::string> effects;     ///< names; empty: the whole catalogue
  bool operator==(const TableSettings&) const = default;
};
/// The fewest datasets of a hypothesis with which it can be ruled out at the level. Two fifths of its datasets
/// calibrate it, and two tests are combined: its p can't fall below 5 / (its number of datasets). A tenth is added for
/// realizations in which nobody can get about.
[[nodiscard]] constexpr std::uint32_t fewest_datasets_to_refuse(double level) {
  return static_cast<std::uint32_t>(5.5 / level + 0.5);
}

struct Settings {
  NuisanceSpec nuisance;  ///< what is uncertain about the room
  double alpha = 0.05;    ///< level of the tests
  int max_effects = 3;    ///< applied one after the other
  TableSettings table;
  std::filesystem::path table_folder;  ///< keeps the simulated datasets; empty: they are not kept
  std::size_t trees = 300;
  std::uint32_t verify_realizations = 60;  ///< simulated with each patched model
  std::vector<std::size_t> holdout;        ///< trials (ascending) kept from naming and fitting; none: folds
};
/// The usual settings at another level (0.001 to 0.5), with so many times the usual number of simulated datasets (0.05
/// to 20) and these effects to look for (none: the whole catalogue). Throws Error(usage) for other numbers, and for an
/// effect that isn't known, stands there twice or is in the script already.
[[nodiscard]] Settings settings_of(const ScriptSpec& script, double alpha, double budget,
                                   const std::vector<std::string>& effects);

/// Of a file; of "none", by which nothing is uncertain; of "" the usual one. Throws as io::read_nuisance() does.
[[nodiscard]] NuisanceSpec nuisance_of(const std::filesystem::path& asked);

/// What a caller may tell its user while it waits. Functions may be empty.
struct Observer {
  std::function<void(const std::string& what)> stage;  ///< what the analysis does now, in a few words
  /// Of the table's realizations: begins with 0, goes up by one for each that is simulated, by more for what was kept.
  std::function<void(std::uint32_t done, std::uint32_t total)> progress;
};

/// What every part of an analysis needs.
struct Context {
  std::uint64_t seed = 1;  ///< of everything random in the analysis; has nothing to do with the script's
  unsigned threads = 0;    ///< 0: all cores; never changes a result
  Observer observer = {};

  void begin(const std::string& stage) const {
    if (observer.stage) observer.stage(stage);
  }
};

/// Compares, names, fits, applies and verifies. Takes minutes; what it simulates is found again in
/// settings.table_folder. Throws Error: input (data that can't be of this study, a folder that holds the table of
/// another), usage (nothing is left to look for), infeasible (people can hardly get about in this room).
[[nodiscard]] Outcome reconcile(const SceneSpec& scene, const ScriptSpec& script, const Measured& measured,
                                const Settings& settings = {}, const Context& context = {});

/// The verdict for a reader, in a few short sentences on one line.
[[nodiscard]] std::string sentence(const Outcome& outcome);
/// What else a reader must know of the verdict, a sentence or two each.
[[nodiscard]] std::vector<std::string> details(const Outcome& outcome);
[[nodiscard]] std::string sentence(const Residuals& residuals);
/// Beside the effects of a verdict; empty if nothing is left over.
[[nodiscard]] std::string sentence_of_rest(const Residuals& rest);
/// Why an effect was kept or dropped.
[[nodiscard]] std::string in_words(const Candidate& candidate);
[[nodiscard]] std::string in_words(const DataFinding& finding);

/// The script with the named effects added, which plain `pirsim` runs. Nothing is added if the data are faulty.
[[nodiscard]] ScriptSpec patched(const ScriptSpec& script, const Outcome& outcome);

/// What made the results, for the report: file names as given.
struct Provenance {
  std::string program, scene, script, measured;
  /// What the user typed so that the model is this one, for commands to repeat: "--scene", "rooms/a.gltf", "--set", ...
  /// Empty: --scene and --script with the names above.
  std::vector<std::string> model_options;
  std::string marks{};  ///< the scene's file of marks; empty: none
};
/// report.json, report.html, where.csv, candidates.csv, script_patched.yaml (if an effect was named) and trail.log
/// (docs/formats/reconcile.md), each complete or not at all; the folder is made. Throws Error(io).
void write_report(const std::filesystem::path& folder, const Outcome& outcome, const Measured& measured,
                  const ScriptSpec& script, const Settings& settings, const Context& context,
                  const Provenance& provenance);

}  // namespace pirsim::reconcile
