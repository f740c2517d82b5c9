// One room on one day: the unit of work. Its rows, its exports, and what the dataset's description says of it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dataset/recipe.hpp"
#include "pirsim/model.hpp"
#include "pirsim/study.hpp"

namespace pirsim::dataset {

struct WrittenFile {
  std::string path;  ///< relative to the dataset
  std::uint64_t bytes = 0;
  std::string sha256;
  bool operator==(const WrittenFile&) const = default;
};

/// Rows, or 30 s readings, with so many people, and those of them in which some sensor saw motion.
struct MotionCount {
  std::uint64_t all = 0, with_motion = 0;
};

/// What stands beside the rows, in `<rows>.json`: all that the description needs of them.
struct RoomDayRecord {
  int room = 0, day = 0;
  std::string date;  ///< ISO 8601
  std::uint64_t rows = 0;
  double seconds = 0.0;  ///< that the rows cover
  int staff = 0, most_people = 0;
  std::uint64_t arrivals = 0, departures = 0, passes_through = 0;
  std::map<int, MotionCount> rows_by_people, readings_by_people;
  std::array<double, 24> presence{}, people{};  ///< share of the hour with anybody there; people on average
  std::vector<EffectSpec> effects;
  std::vector<WrittenFile> files;    ///< the first is that of the rows; none if the day failed
  std::optional<WrittenFile> scene;  ///< a drawn room's file, of which the day was made
  std::string fault;                 ///< why there are no rows
};

struct RoomDay {
  RoomDayRecord record;
  std::map<std::string, std::string> contents;  ///< of record.files, by path
};

/// Simulates it and writes nothing. What makes a day impossible (a place that can't be reached) is the record's fault.
[[nodiscard]] RoomDay simulate(const RecipeSpec& recipe, const SceneSpec& scene,
                               const std::vector<std::string>& sensor_columns, int room, int day);

[[nodiscard]] std::string to_json(const RoomDayRecord& record, const std::string& made_by);
/// The record, and what made it. Throws Error(input), also for a record of which a letter was altered.
[[nodiscard]] std::pair<RoomDayRecord, std::string> record_from_json(const std::string& text, const std::string& name);

/// Relative to the dataset's folder.
[[nodiscard]] std::string rows_path(const RecipeSpec& recipe, int room, int day);
[[nodiscard]] std::string record_path(int room, int day);

}  // namespace pirsim::dataset
