#include "dataset/store.hpp"

#include <algorithm>
#include <fstream>

#include "core/digest.hpp"
#include "dataset/furnish.hpp"
#include "pirsim/version.hpp"
#include "schema/fingerprint.hpp"

namespace pirsim::dataset {

namespace fs = std::filesystem;

namespace {

std::string hash_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  Sha256 hash;
  std::string piece(1U << 20U, '\0');
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0)
    hash.add({piece.data(), static_cast<std::size_t>(in.gcount())});
  return hash.hex();
}

void add_sensors(Fingerprint& print, const RoomGroupSpec& group, const io::SceneOptions& options) {
  for (const SensorGroupSpec& sensors : group.rooms.sensors) {
    for (const std::string& model : models_of(sensors)) {
      try {
        print.add(io::find_sensor_model(model, {}, options));
      } catch (const Error& error) {
        const Issue& first = error.issues().front();
        if (!first.where.file.empty()) throw;  // of the model's own file
        throw Error(error.code(), sensors.where, first.message);
      }
    }
  }
}

}  // namespace

std::string provenance(const RecipeSpec& recipe, const io::SceneOptions& options) {
  std::string text = "recipe " + sha256(recipe.text);
  Fingerprint print;
  for (const RoomGroupSpec& group : recipe.rooms) {
    for (const fs::path& scene : group.scenes) {
      const SceneSpec read = io::read_scene(scene, options);
      text += ", " + scene.filename().string() + ' ' + read.files.front().sha256;
      print.add(read);
    }
    if (group.scenes.empty()) add_sensors(print, group, options);
  }
  return text + ", sensors " + print.digest().substr(0, 16) + ", pirsim " + version() + " (" + git_revision() + "), " +
         compiler();
}

std::pair<int, int> room_and_day(const RecipeSpec& recipe, std::uint32_t index) {
  const int i = static_cast<int>(index);
  return {i / recipe.days + 1, i % recipe.days + 1};
}

fs::path room_file(const fs::path& folder, int room) { return folder / "rooms" / (room_name(room) + ".gltf"); }

bool is_whole(const fs::path& folder, const WrittenFile& written, Look look) {
  const fs::path file = folder / written.path;
  std::error_code fault;
  if (!fs::is_regular_file(file, fault) || fs::file_size(file, fault) != written.bytes || fault) return false;
  return look == Look::sizes || hash_of(file) == written.sha256;
}

std::optional<RoomDayRecord> whole_record(const RecipeSpec& recipe, const fs::path& folder, std::uint32_t index,
                                          const std::string& made_by, Look look) {
  const auto [room, day] = room_and_day(recipe, index);
  const fs::path file = folder / record_path(room, day);
  std::error_code fault;
  if (!fs::is_regular_file(file, fault)) return std::nullopt;
  try {
    auto [record, by] = record_from_json(io::read_text_file(file), file.string());
    if (by != made_by || record.room != room || record.day != day) return std::nullopt;
    const auto is_there = [&](const WrittenFile& written) { return is_whole(folder, written, look); };
    if (!std::ranges::all_of(record.files, is_there)) return std::nullopt;
    if (look == Look::contents && record.scene && !is_there(*record.scene)) return std::nullopt;
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

void write_once(const fs::path& file, const std::string& text) {
  make_folders(file.parent_path());
  if (io::write_once(file, text)) return;
  throw Error(ErrorCode::input, Where{file.string()},
              "isn't what this recipe makes: move it away, or name another folder");
}

namespace {

fs::path lock_path(const fs::path& folder, const std::optional<Shard>& shard) {
  if (!shard) return folder / "at_work.lock";
  return folder / ("at_work_" + std::to_string(shard->index) + "_of_" + std::to_string(shard->count) + ".lock");
}

}  // namespace

AtWork::AtWork(const fs::path& folder, const std::optional<Shard>& shard)
    : path_(lock_path(folder, shard)), file_(path_, io::PosixFile::Mode::append) {
  file_.lock();
}

AtWork::~AtWork() {
  std::error_code ignored;
  fs::remove(path_, ignored);
}

}  // namespace pirsim::dataset
