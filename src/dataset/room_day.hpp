// One room on one day: the unit of work. Its rows, its exports, and what the dataset's description says of it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dataset/exports.hpp"
#include "dataset/recipe.hpp"
#include "pirsim/columns.hpp"
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

/// What a journal says of a room-day: all that the description needs of it.
struct RoomDayRecord {
  int room = 0, day = 0;
  std::string date;  ///< ISO 8601
  std::uint64_t rows = 0;
  double seconds = 0.0;  ///< that the rows cover
  double ambient_c = 0.0;
  int staff = 0, most_people = 0;
  std::uint64_t arrivals = 0, departures = 0, passes_through = 0;
  std::map<int, MotionCount> rows_by_people, readings_by_people;
  std::array<double, 24> presence{}, people{};  ///< share of the hour with anybody there; people on average
  std::map<std::string, DayProfile> areas{};    ///< the same of each
  std::vector<EffectSpec> effects;
  std::vector<WrittenFile> files;    ///< the first is that of the rows; none if the day failed
  std::optional<WrittenFile> scene;  ///< a drawn room's file, of which the day was made
  std::string fault;                 ///< why there are no rows
};

struct RoomDay {
  RoomDayRecord record;
  std::map<std::string, std::string> contents;  ///< of record.files, by path
};

/// A room, which its days share: what was compiled for one of them isn't compiled again for the others.
class Room {
 public:
  /// `file`: of a drawn room.
  Room(int number, SceneSpec scene, std::optional<WrittenFile> file)
      : number_(number), scene_(std::move(scene)), file_(std::move(file)) {}

  [[nodiscard]] int number() const noexcept { return number_; }
  [[nodiscard]] const SceneSpec& scene() const noexcept { return scene_; }
  [[nodiscard]] const std::optional<WrittenFile>& file() const noexcept { return file_; }
  /// From any thread.
  [[nodiscard]] Model model(ScriptSpec script) const;

 private:
  int number_;
  SceneSpec scene_;
  std::optional<WrittenFile> file_;
  mutable std::mutex mutex_;
  mutable std::optional<Model> first_;
};

/// Simulates it and writes nothing. What makes a day impossible (a place that can't be reached) is the record's fault.
[[nodiscard]] RoomDay simulate(const RecipeSpec& recipe, const Room& room, int day, const ColumnOwners& columns);

/// In one line.
[[nodiscard]] std::string to_json(const RoomDayRecord& record);
/// Throws Error(input).
[[nodiscard]] RoomDayRecord record_from_json(const std::string& text, const std::string& name);

}  // namespace pirsim::dataset
