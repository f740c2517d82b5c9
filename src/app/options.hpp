// The command line as data.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "reconcile/seal.hpp"
#include "reconcile/selftest.hpp"

namespace pirsim::app {

enum class Verbosity { quiet, normal, verbose };

/// What every command reads.
struct Inputs {
  std::filesystem::path scene;
  std::filesystem::path script;
  std::vector<std::string> overrides;  ///< "sensing.rays_per_zone=9"
  std::vector<std::filesystem::path> sensor_directories;
  std::string tracer = "auto";
  Verbosity verbosity = Verbosity::normal;
};

struct RunOptions {
  std::filesystem::path output;   ///< .csv, .csv.gz or .csv.zst; of a shard its folder; empty: standard output
  std::filesystem::path summary;  ///< .csv or .md
  std::filesystem::path zones;    ///< .csv, .csv.gz or .csv.zst
  std::filesystem::path trace;    ///< the same
  std::filesystem::path report;   ///< .html
  std::string shard;              ///< "3/100", "auto"; empty: the whole study
  std::string format = ".csv";    ///< ending of a shard's file
  enum class Start { anew, resume } start = Start::anew;
  std::optional<double> max_time_s;
  unsigned threads = 0;
  enum class Action { run, print_config } action = Action::run;
};

struct PreviewOptions {
  std::filesystem::path output = "preview.png";
  std::string trial;  ///< empty: the first
  int replicate = 1;
  std::optional<double> time_s;    ///< empty: when the first person has been at work for a while
  std::vector<std::string> beams;  ///< sensors whose beams are drawn; "all", "none"
  std::optional<std::array<double, 3>> camera, look_at;
  double field_of_view_deg = 45.0;
  int width = 1280, height = 720;
};

struct CoverageOptions {
  std::filesystem::path output = "coverage";  ///< folder
  std::filesystem::path report;               ///< .html
  unsigned threads = 0;
};

struct WalkTestOptions {
  std::filesystem::path output = "walk_test.csv";
  std::filesystem::path report;  ///< .html
  unsigned threads = 0;
};

struct PlacementOptions {
  unsigned threads = 0;
};

struct CampaignOptions {
  std::filesystem::path folder;        ///< with shards
  std::filesystem::path output;        ///< of merge
  std::filesystem::path summary;       ///< of merge
  std::filesystem::path script;        ///< for the summary
  std::vector<std::string> overrides;  ///< of the script
  Verbosity verbosity = Verbosity::normal;
};

/// What a reconciliation, its plan and its self-test share.
struct AnalysisOptions {
  std::filesystem::path table;  ///< folder of the reference table; empty: in the output folder
  std::string nuisance;         ///< file, "none", or empty: the usual
  double alpha = 0.05;
  std::vector<std::string> effects;  ///< candidates; empty: the whole catalogue
  double budget = 1.0;               ///< times the usual number of simulated datasets
  std::uint64_t seed = 1;
  unsigned threads = 0;
};

struct ReconcileOptions {
  std::filesystem::path measured;
  std::filesystem::path output = "reconcile";  ///< folder
  std::string holdout;                         ///< share or names of trials to be judged on; empty: folds
  int max_effects = 3;
};

struct PlanOptions {
  std::filesystem::path output = "reconcile_plan";  ///< folder
  reconcile::Measured::Kind kind = reconcile::Measured::Kind::series;
  int runs = 1;
};

struct SealOptions {
  std::filesystem::path output = "challenge";  ///< folder of what may be published
  std::filesystem::path answer;                ///< what must be kept secret
  std::string nuisance;                        ///< file, "none", or empty: the usual
  reconcile::Hidden hidden = reconcile::Hidden::any;
  int runs = 1;
  std::optional<std::uint64_t> secret_seed;
};

struct OpenOptions {
  std::filesystem::path answer, commitment, report;
};

struct EffectsOptions {
  std::string name;  ///< empty: all
  std::string format = "text";
};

struct SelftestOptions {
  std::filesystem::path output = "reconcile_selftest";  ///< folder
  reconcile::Measured::Kind kind = reconcile::Measured::Kind::series;
  int runs = 1;
  std::uint32_t nulls = 60, planted = 10, beyond = 0, pairs = 0, aliens = 0, verified = 0;
  reconcile::LeaveOut leave_out = reconcile::LeaveOut::none;
};

struct ExportOptions {
  std::filesystem::path output = "run.glb";
  std::string trial;
  int replicate = 1;
  double keys_per_s = 10.0;
  std::vector<std::string> beams{"all"};
};

}  // namespace pirsim::app
