// A room-day in the shapes that other tools read.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "files/disk/file.hpp"
#include "pirsim/columns.hpp"
#include "pirsim/model.hpp"
#include "pirsim/script.hpp"
#include "pirsim/study.hpp"
#include "rooms/recipe.hpp"

namespace pirsim::dataset {

/// 30 s of rows: motion in any of them, and the people at their end.
struct Reading {
  std::string clock;  ///< of its end
  int people = 0;
  std::vector<int> people_of_areas;  ///< (n_areas) as a Sample's
  std::vector<std::uint8_t> bits;
  [[nodiscard]] bool any() const;
};
/// None if 30 s aren't a whole number of rows.
[[nodiscard]] std::optional<int> rows_per_reading(const SensingSpec& sensing);
[[nodiscard]] std::vector<Reading> readings(std::span<const Sample> rows, int rows_per_reading);

/// Shaped like UCI's Room Occupancy Estimation (864): Date,Time,<sensor>_PIR,...,Room_Occupancy_Count, and
/// <area>_Occupancy_Count of each area.
[[nodiscard]] std::string to_uci864(std::span<const Reading> readings, const std::vector<std::string>& sensors,
                                    const std::vector<std::string>& areas);
/// As io::CasasWriter has it.
[[nodiscard]] std::string to_casas(const RunResult& run, const std::vector<std::string>& sensors,
                                   const std::vector<std::string>& doors);

/// Hours of a day: share of the hour with anybody there, people on average.
struct DayProfile {
  std::array<double, 24> presence{}, people{};
};
struct RoomProfile {
  std::string room;
  /// (7) from Monday on: the days of this weekday that were simulated, in order.
  std::array<std::vector<DayProfile>, 7> weekdays;
};
/// For EnergyPlus' Schedule:File: a line of headings, then 8760 hours from 1 January of `year` (29 February left out),
/// columns `<room>_presence` and `<room>_people`. Each date takes the simulated days of its weekday by turns; a weekday
/// that wasn't simulated takes those of the other days of its kind, working or weekend, or is empty.
[[nodiscard]] std::string to_energyplus(std::span<const RoomProfile> rooms, int year);

// One room on one day: the unit of work. Its rows, its exports, and what the dataset's description says of it.

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

// A dataset on its way: the recipe with all that it names, read once, and the folder: what is where, what is whole.

enum class Look {
  sizes,    ///< of files
  contents  ///< as well, by their hashes
};

class Store {
 public:
  /// Throws as io::read_scene() and io::find_sensor_model().
  Store(const RecipeSpec& recipe, std::filesystem::path folder, const io::SceneOptions& scenes);

  [[nodiscard]] const RecipeSpec& recipe() const noexcept { return recipe_; }
  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }
  [[nodiscard]] const io::SceneOptions& scenes() const noexcept { return scenes_; }
  /// In one line: the recipe's hash, those of the user's own scenes, a digest of sensor models and own scenes as read,
  /// program, revision, compiler. Equal provenance: equal bytes.
  [[nodiscard]] const std::string& provenance() const noexcept { return provenance_; }
  /// In all rows. Sensors: PIR1, PIR2, ... as many as a drawn room may have, and the ids of homes and of the user's own
  /// scenes that aren't among them. Areas and doors: those of the user's own scenes, and those that homes may have.
  [[nodiscard]] const ColumnOwners& columns() const noexcept { return columns_; }
  /// As it was read; null for a drawn room.
  [[nodiscard]] const SceneSpec* own_scene(int room) const;
  [[nodiscard]] std::filesystem::path room_file(int room) const { return folder_ / room_path(room); }

  [[nodiscard]] bool is_whole(const WrittenFile& written, Look look) const;
  /// With the room that it was made of, if its contents are looked at.
  [[nodiscard]] bool is_whole(const RoomDayRecord& record, Look look) const;

  /// By index: what the folder's journals say of room-days of this provenance.
  [[nodiscard]] std::map<std::uint32_t, RoomDayRecord> records() const;
  /// Of the room-days that this process makes, which no other may make meanwhile: that is refused by Error(io).
  [[nodiscard]] io::Journal open_journal(const std::optional<Shard>& shard, DatasetOptions::Start start) const;
  /// Of all of them in one journal, as one process would have written it.
  void join_journals(const std::vector<RoomDayRecord>& records) const;

 private:
  [[nodiscard]] std::vector<std::filesystem::path> journals() const;

  const RecipeSpec& recipe_;
  std::filesystem::path folder_;
  io::SceneOptions scenes_;
  std::map<OwnScene, SceneSpec> own_scenes_;
  std::string provenance_;
  ColumnOwners columns_;
};

// Of an observer that may be empty.
void begin(const DatasetObserver& observer, DatasetObserver::Stage stage, std::size_t total);
void done_one(const DatasetObserver& observer);

/// Throws Error(io).
void make_folders(const std::filesystem::path& folder);
/// A file that several processes may write at once, all the same. Throws Error(input) if another is in that place.
void write_once(const std::filesystem::path& file, const std::string& text);

}  // namespace pirsim::dataset
