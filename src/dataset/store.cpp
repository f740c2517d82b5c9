#include "dataset/store.hpp"

#include "core/digest.hpp"
#include "io/input.hpp"
#include "pirsim/version.hpp"

namespace pirsim::dataset {

namespace fs = std::filesystem;

namespace {
constexpr std::size_t largest_scene = 1'000'000'000;  // as io::read_scene() takes it
}

std::string provenance(const RecipeSpec& recipe) {
  std::string text = "recipe " + sha256(recipe.text);
  for (const RoomGroupSpec& group : recipe.rooms) {
    for (const fs::path& scene : group.scenes)
      text += ", " + scene.filename().string() + ' ' + io::read_input(scene, largest_scene).file().sha256;
  }
  return text + ", pirsim " + version() + " (" + git_revision() + "), " + compiler();
}

std::pair<int, int> room_and_day(const RecipeSpec& recipe, std::uint32_t index) {
  const int i = static_cast<int>(index);
  return {i / recipe.days + 1, i % recipe.days + 1};
}

fs::path room_file(const fs::path& folder, int room) { return folder / "rooms" / (room_name(room) + ".gltf"); }

std::optional<RoomDayRecord> whole_record(const RecipeSpec& recipe, const fs::path& folder, std::uint32_t index,
                                          const std::string& made_by) {
  const auto [room, day] = room_and_day(recipe, index);
  const fs::path file = folder / record_path(room, day);
  std::error_code fault;
  if (!fs::is_regular_file(file, fault)) return std::nullopt;
  try {
    auto [record, by] = record_from_json(io::read_text_file(file), file.string());
    if (by != made_by || record.room != room || record.day != day) return std::nullopt;
    for (const WrittenFile& written : record.files) {
      if (fs::file_size(folder / written.path, fault) != written.bytes || fault) return std::nullopt;
    }
    return std::move(record);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::input) throw;
    return std::nullopt;  // torn: made again
  }
}

void begin(const DatasetObserver& observer, DatasetObserver::Stage stage, std::size_t total) {
  if (observer.begin) observer.begin(stage, static_cast<std::uint32_t>(total));
}
void done_one(const DatasetObserver& observer) {
  if (observer.done_one) observer.done_one();
}

void make_folders(const fs::path& folder) {
  std::error_code fault;
  fs::create_directories(folder, fault);
  if (fault) throw Error(ErrorCode::io, Where{folder.string()}, "can't make the folder: " + fault.message());
}

void write_once(const fs::path& file, const std::string& shard, const std::function<void(const fs::path&)>& write) {
  make_folders(file.parent_path());
  const fs::path own = file.parent_path() / (file.stem().string() + '.' + shard + file.extension().string());
  write(own);
  std::error_code fault;
  if (fs::exists(file, fault) && io::read_text_file(file) != io::read_text_file(own)) {
    fs::remove(own, fault);
    throw Error(ErrorCode::input, Where{file.string()},
                "isn't what this recipe makes: move it away, or name another folder");
  }
  fs::rename(own, file, fault);
  if (fault) throw Error(ErrorCode::io, Where{file.string()}, "can't be put in its place: " + fault.message());
}

std::string shard_name(const DatasetOptions& options) {
  return "shard" + std::to_string(options.shard ? options.shard->index : 0);
}

}  // namespace pirsim::dataset
