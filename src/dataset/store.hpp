// A dataset on its way: the recipe with all that it names, read once, and the folder: what is where, what is whole.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dataset/room_day.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/journal.hpp"

namespace pirsim::dataset {

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
