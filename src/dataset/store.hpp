// The dataset's folder: what is where, and what is whole.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "dataset/room_day.hpp"
#include "io/atomic_file.hpp"

namespace pirsim::dataset {

/// In one line: the recipe's hash (and those of the user's own scenes), program, revision, compiler. Equal provenance:
/// equal bytes.
[[nodiscard]] std::string provenance(const RecipeSpec& recipe);
/// From the index of a room-day.
[[nodiscard]] std::pair<int, int> room_and_day(const RecipeSpec& recipe, std::uint32_t index);
[[nodiscard]] std::filesystem::path room_file(const std::filesystem::path& folder, int room);
/// The record of a room-day whose files are there in their sizes; none if it has to be made.
[[nodiscard]] std::optional<RoomDayRecord> whole_record(const RecipeSpec& recipe, const std::filesystem::path& folder,
                                                        std::uint32_t index, const std::string& made_by);

/// Throws Error(io).
/// Of an observer that may be empty.
void begin(const DatasetObserver& observer, DatasetObserver::Stage stage, std::size_t total);
void done_one(const DatasetObserver& observer);

void make_folders(const std::filesystem::path& folder);
/// A file that several shards may write at once, all the same: each under a name of its own, then moved into its place.
/// Throws Error(input) if another is in that place.
void write_once(const std::filesystem::path& file, const std::string& shard,
                const std::function<void(const std::filesystem::path&)>& write);
[[nodiscard]] std::string shard_name(const DatasetOptions& options);

}  // namespace pirsim::dataset
