// The command line as data.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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
  std::filesystem::path output;   ///< empty: standard output
  std::filesystem::path summary;  ///< .csv or .md
  std::filesystem::path zones;
  std::filesystem::path report;  ///< .html
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

struct EffectsOptions {
  std::string name;  ///< empty: all
  std::string format = "text";
};

struct ExportOptions {
  std::filesystem::path output = "run.glb";
  std::string trial;
  int replicate = 1;
  double keys_per_s = 10.0;
  std::vector<std::string> beams{"all"};
};

}  // namespace pirsim::app
