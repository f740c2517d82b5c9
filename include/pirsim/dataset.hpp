// Datasets of many rooms and days: what a recipe asks for, and how it is made. docs/formats/dataset.md
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pirsim/flat.hpp"
#include "pirsim/room.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/schedule.hpp"
#include "pirsim/script.hpp"
#include "pirsim/study.hpp"

namespace pirsim::dataset {

/// An effect of the catalogue, drawn anew for every room or every day of every room.
struct VariedEffectSpec {
  enum class Per { room, day };
  std::string name;
  Per per = Per::room;
  double chance = 1.0;                                      ///< of being there at all
  std::map<std::string, Range, std::less<>> parameters;     ///< those that are missing: the catalogue's prior
  std::map<std::string, std::string, std::less<>> choices;  ///< `sensor: each`: one a sensor, each with its own draw
  Where where;
};

/// A scene of the user's own.
struct OwnScene {
  std::filesystem::path file;
  std::filesystem::path marks = {};  ///< beside it (docs/formats/scene.md); empty: none
  auto operator<=>(const OwnScene&) const = default;
};

/// Who lives in a home: drawn once for each. All ranges are `assumed`.
struct HouseholdRangesSpec {
  double works = 0.55;          ///< probability that a resident goes to work
  double works_at_home = 0.0;   ///< and that one works at home; together at most 1
  Range age_years{25.0, 80.0};  ///< of each
  Range visits_a_week{0.0, 2.0};
  Range shift_min{-45.0, 45.0};  ///< by how much all clocks of a household are later than those below
  double cat = 0.0, dog = 0.0;   ///< probabilities that there is one
  HouseholdSpec usual;           ///< its clocks; the rest is drawn
};

/// Homes that are alike.
struct HomeGroupSpec {
  FlatSpec flats;
  HouseholdRangesSpec household;
};

/// Rooms that are alike: drawn from ranges, or scenes of the user's own.
struct RoomGroupSpec {
  int count = 1;
  RoomSpec rooms;
  std::optional<HomeGroupSpec> home{};  ///< if there: flats and who lives there, instead
  std::vector<OwnScene> scenes;         ///< if not empty: these, in turn, instead
  ScheduleSpec schedule;
  /// How many of the schedule's staff a room has, at most one a seat; none: all of them.
  std::optional<CountRange> people;
  /// Of the air in degrees Celsius: a room's mean. None: as the sensing of all says.
  std::optional<Range> ambient_c{};
  Where where;
};

/// Shares of the whole; at least one of what is asked for.
struct SplitSpec {
  double validation_rooms = 0.15;  ///< with all of their days
  double test_rooms = 0.15;        ///< the same
  double test_days = 0.2;          ///< of the rooms that are trained on: the last ones
};

/// train: rooms and days to learn from. test_days: the same rooms on later days. The others: rooms of their own.
enum class Part { train, validation, test_days, test_rooms };

enum class Export { uci864, casas, energyplus };

/// Rooms drawn with replacement from those that a recipe's ranges give, as a calibration weighs them. A room that is
/// drawn twice has the same furniture, sensors, people and effects, and other days.
struct DrawBySpec {
  int count = 1;
  std::vector<double> weights;  ///< (rooms of the ranges) at least 0, their sum above 0
  Where where;
};

struct RecipeSpec {
  std::string name;
  std::uint64_t seed = 1;
  std::vector<RoomGroupSpec> rooms;
  std::optional<DrawBySpec> draw_by;
  int days = 5;               ///< of each room, one after the other
  double ambient_sd_k = 0.7;  ///< of days about their room's mean. Ref: [Foldvary2018], days of a month in one building
  SensingSpec sensing;
  std::vector<VariedEffectSpec> effects;
  SplitSpec split;
  Occupants occupants = Occupants::counted;
  Frames frames = Frames::none;
  std::vector<Export> exports;
  std::string ending = ".csv.gz";  ///< of rows: .csv, .csv.gz or .csv.zst
  int pictures = 6;                ///< of so many rooms, the first ones
  std::filesystem::path file;
  std::vector<std::string> overrides;                     ///< "sensing.response=zones"
  std::string given;                                      ///< the file's content
  std::string text;                                       ///< the file's, and a comment for each override
  std::vector<int> originals{};                           ///< follows from draw_by
  std::vector<std::filesystem::path> data_directories{};  ///< where shipped scenes are looked for
  [[nodiscard]] int n_rooms() const;
  /// (n_rooms) which room of the ranges each one is, from 1; itself without draw_by.
  [[nodiscard]] int original_of(int room) const;
  [[nodiscard]] std::uint32_t n_room_days() const { return static_cast<std::uint32_t>(n_rooms() * days); }
};

/// Overrides and folders are as of scripts. Throws Error (io; input: all faults with file:line:column; usage: an
/// override).
[[nodiscard]] RecipeSpec read_recipe(const std::filesystem::path& file, std::span<const std::string> overrides = {},
                                     std::span<const std::filesystem::path> data_directories = {});

/// The same recipe with more overrides, without its file being read again. Throws as read_recipe().
[[nodiscard]] RecipeSpec with_overrides(const RecipeSpec& recipe, std::span<const std::string> more);

/// A room of a recipe by its number, from 1 on: drawn, or read. Throws as draw_room() and io::read_scene() do.
[[nodiscard]] SceneSpec room_of(const RecipeSpec& recipe, int number, const io::SceneOptions& options);

/// Which rooms and days are for what: (n_rooms x days), room by room. The same for the same recipe.
[[nodiscard]] std::vector<Part> parts_of(const RecipeSpec& recipe);

/// What a caller may tell its user while it waits. Functions may be empty.
struct DatasetObserver {
  enum class Stage { looking_for_days, checking_rooms, making_days, describing_rooms };
  std::function<void(Stage stage, std::uint32_t total)> begin{};
  std::function<void()> done_one{};  ///< of the stage's total; from one thread at a time
};

struct DatasetOptions {
  io::SceneOptions scenes;
  unsigned threads = 0;  ///< 0: all cores; changes no byte
  std::optional<Shard> shard;
  enum class Start { anew, resume } start = Start::anew;
  std::function<bool()> goes_on{};  ///< asked before each room-day, and before each piece of other work
  DatasetObserver observer{};
  std::function<void(const Issue&)> tell{};  ///< of what a user should know, from one thread at a time
};

/// Makes the room-days of the recipe, or a shard of them, each a file of its own that appears whole or not at all; what
/// is there already of the same recipe and build is kept if it is to be resumed and if its content is what was written.
/// Throws Error(input) for a folder that holds another dataset, and for a room that was changed; Error(io) if another
/// process is at the same shard. False if it was stopped.
bool make_room_days(const RecipeSpec& recipe, const std::filesystem::path& folder, const DatasetOptions& options);

/// Room-days that aren't there yet, by index (room by room). Files are told by their sizes.
[[nodiscard]] std::vector<std::uint32_t> missing_room_days(const RecipeSpec& recipe,
                                                           const std::filesystem::path& folder,
                                                           const io::SceneOptions& options);

/// When all room-days are there: tables, datapackage.json, README.md, pictures, exports of the whole. Throws
/// Error(input) if some are missing or aren't what was written. False if it was stopped.
bool finish_dataset(const RecipeSpec& recipe, const std::filesystem::path& folder, const DatasetOptions& options);

/// What a counter learns from: a dataset's day as numbers.
struct RoomDayRows {
  int room = 0, day = 0;
  double window_s = 1.0;
  std::vector<std::string> sensors;  ///< that this room has
  std::vector<std::uint8_t> motion;  ///< (rows x sensors) 2: unknown
  std::vector<int> people;           ///< (rows) -1: unknown
};

/// Days of one part of a finished dataset, room by room; those without rows are left out. Threads change no byte.
/// Throws Error: io (no dataset there), input (what a dataset hasn't got, with file and line).
[[nodiscard]] std::vector<RoomDayRows> read_room_days(const std::filesystem::path& folder, Part part,
                                                      unsigned threads = 0);

}  // namespace pirsim::dataset
