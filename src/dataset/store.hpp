// The dataset's folder: what is where, and what is whole.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "dataset/room_day.hpp"
#include "io/atomic_file.hpp"
#include "io/posix_file.hpp"

namespace pirsim::dataset {

/// In one line: the recipe's hash, those of the user's own scenes, a digest of sensor models and own scenes as read,
/// program, revision, compiler. Equal provenance: equal bytes. Throws as io::read_scene() and io::find_sensor_model().
[[nodiscard]] std::string provenance(const RecipeSpec& recipe, const io::SceneOptions& options);
/// From the index of a room-day.
[[nodiscard]] std::pair<int, int> room_and_day(const RecipeSpec& recipe, std::uint32_t index);
[[nodiscard]] std::filesystem::path room_file(const std::filesystem::path& folder, int room);
enum class Look {
  sizes,    ///< of files
  contents  ///< as well, by their hashes
};
[[nodiscard]] bool is_whole(const std::filesystem::path& folder, const WrittenFile& written, Look look);
/// The record of a room-day whose files are there, and the room that they were made of; none if it has to be made.
[[nodiscard]] std::optional<RoomDayRecord> whole_record(const RecipeSpec& recipe, const std::filesystem::path& folder,
                                                        std::uint32_t index, const std::string& made_by, Look look);

/// Throws Error(io).
/// Of an observer that may be empty.
void begin(const DatasetObserver& observer, DatasetObserver::Stage stage, std::size_t total);
void done_one(const DatasetObserver& observer);

void make_folders(const std::filesystem::path& folder);
/// A file that several processes may write at once, all the same. Throws Error(input) if another is in that place.
void write_once(const std::filesystem::path& file, const std::string& text);

/// One process at a time makes these room-days: a second one is refused by Error(io).
class AtWork {
 public:
  AtWork(const std::filesystem::path& folder, const std::optional<Shard>& shard);
  ~AtWork();
  AtWork(const AtWork&) = delete;
  AtWork& operator=(const AtWork&) = delete;

 private:
  std::filesystem::path path_;
  io::PosixFile file_;
};

}  // namespace pirsim::dataset
