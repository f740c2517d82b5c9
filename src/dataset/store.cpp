#include "dataset/store.hpp"

#include <algorithm>
#include <fstream>

#include "core/digest.hpp"
#include "dataset/flat_furnish.hpp"
#include "dataset/flat_names.hpp"
#include "dataset/furnish.hpp"
#include "pirsim/version.hpp"
#include "schema/areas.hpp"
#include "schema/fingerprint.hpp"
#include "studies/campaign.hpp"

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

void add_sensors(Fingerprint& print, const FlatSpec& flats, const io::SceneOptions& options) {
  for (const SensorsAt at : flats.sensors_at) {
    for (const Mount mount : flats.mounts) {
      for (const std::string& model : models_of(flats, at, mount))
        print.add(io::find_sensor_model(model, {}, options, flats.models_where));
    }
  }
}

/// Of drawn rooms or homes.
void add_sensors(Fingerprint& print, const RoomGroupSpec& group, const io::SceneOptions& options) {
  if (group.home) return add_sensors(print, group.home->flats, options);
  for (const SensorGroupSpec& sensors : group.rooms.sensors) {
    for (const std::string& model : models_of(sensors))
      print.add(io::find_sensor_model(model, {}, options, sensors.where));
  }
}

/// "room.gltf 9f86d0...", of a file that the scene was read from.
std::string hash_told(const fs::path& file, const SceneSpec& scene) {
  const auto read = std::ranges::find(scene.files, file.string(), &InputFile::path);
  return file.filename().string() + ' ' + read->sha256;
}

std::string provenance_of(const RecipeSpec& recipe, const std::map<OwnScene, SceneSpec>& own_scenes,
                          const io::SceneOptions& options) {
  std::string text = "recipe " + sha256(recipe.text);
  Fingerprint print;
  for (const RoomGroupSpec& group : recipe.rooms) {
    for (const OwnScene& own : group.scenes) {
      const SceneSpec& scene = own_scenes.at(own);
      text += ", " + hash_told(own.file, scene);
      if (!own.marks.empty()) text += ", " + hash_told(own.marks, scene);
      print.add(scene);
    }
    if (group.scenes.empty()) add_sensors(print, group, options);
  }
  return text + ", sensors " + print.digest().substr(0, 16) + ", " + program() + ", " + compiler();
}

/// PIR1, PIR2, ..., as many as a drawn room may have.
std::vector<std::string> numbered_sensors(const RecipeSpec& recipe) {
  int most = 0;
  for (const RoomGroupSpec& group : recipe.rooms) {
    int sensors = 0;
    for (const SensorGroupSpec& sensor : group.rooms.sensors) sensors += sensor.count.most;
    if (group.scenes.empty() && !group.home) most = std::max(most, sensors);
  }
  std::vector<std::string> names;
  for (int i = 1; i <= most; ++i) names.push_back("PIR" + std::to_string(i));
  return names;
}

void add_new(std::vector<std::string>& names, const std::vector<std::string>& more) {
  for (const std::string& name : more) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
}

ColumnOwners columns_of(const RecipeSpec& recipe, const std::map<OwnScene, SceneSpec>& own_scenes) {
  ColumnOwners columns;
  columns.sensors = numbered_sensors(recipe);
  const auto add = [&](const ColumnOwners& names) {
    add_new(columns.sensors, names.sensors);
    add_new(columns.areas, names.areas);
    add_new(columns.doors, names.doors);
  };
  for (const RoomGroupSpec& group : recipe.rooms) {
    if (group.home) add(columns_of(group.home->flats));
    for (const OwnScene& own : group.scenes) {
      const SceneSpec& scene = own_scenes.at(own);
      ColumnOwners names{{}, Areas(scene).names(), {}};
      for (const SensorSpec& sensor : scene.sensors) names.sensors.push_back(sensor.id);
      for (const DoorSpec& door : scene.doors) names.doors.push_back(door.id);
      add(names);
    }
  }
  return columns;
}

constexpr const char* journal_ending = ".journal";

/// Of a whole dataset, or of one shard.
std::string journal_name(const std::optional<Shard>& shard) {
  return (shard ? studies::shard_name(*shard) : "dataset") + journal_ending;
}

}  // namespace

Store::Store(const RecipeSpec& recipe, fs::path folder, const io::SceneOptions& scenes)
    : recipe_(recipe), folder_(std::move(folder)), scenes_(scenes) {
  for (const RoomGroupSpec& group : recipe.rooms) {
    for (const OwnScene& own : group.scenes) {
      if (!own_scenes_.contains(own)) own_scenes_.emplace(own, read_own(own, scenes_));
    }
  }
  provenance_ = provenance_of(recipe_, own_scenes_, scenes_);
  columns_ = columns_of(recipe_, own_scenes_);
}

const SceneSpec* Store::own_scene(int room) const {
  const OwnScene* own = dataset::own_scene(recipe_, room);
  return own == nullptr ? nullptr : &own_scenes_.at(*own);
}

bool Store::is_whole(const WrittenFile& written, Look look) const {
  const fs::path file = folder_ / written.path;
  std::error_code fault;
  if (!fs::is_regular_file(file, fault) || fs::file_size(file, fault) != written.bytes || fault) return false;
  return look == Look::sizes || hash_of(file) == written.sha256;
}

bool Store::is_whole(const RoomDayRecord& record, Look look) const {
  const auto is_there = [&](const WrittenFile& written) { return is_whole(written, look); };
  return std::ranges::all_of(record.files, is_there) &&
         (look == Look::sizes || !record.scene || is_there(*record.scene));
}

std::vector<fs::path> Store::journals() const {
  std::vector<fs::path> files;
  std::error_code fault;  // of a folder that isn't there yet
  for (const auto& entry : fs::directory_iterator(folder_, fault)) {
    if (entry.path().extension() == journal_ending) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

std::map<std::uint32_t, RoomDayRecord> Store::records() const {
  std::map<std::uint32_t, RoomDayRecord> records;
  for (const fs::path& file : journals()) {
    const auto journal = io::Journal::read(file);
    if (!journal || journal->made_from != provenance_) continue;
    for (const std::string& piece : journal->pieces) {
      RoomDayRecord record = record_from_json(piece, file.string());
      const std::uint32_t index = index_of(recipe_, record.room, record.day);
      records.insert_or_assign(index, std::move(record));
    }
  }
  return records;
}

io::Journal Store::open_journal(const std::optional<Shard>& shard, DatasetOptions::Start start) const {
  const fs::path file = folder_ / journal_name(shard);
  io::Journal journal(file);
  const auto found = start == DatasetOptions::Start::resume ? io::Journal::read(file) : std::nullopt;
  if (found && found->made_from == provenance_) {
    journal.resume(*found);
  } else {
    journal.begin(provenance_);
  }
  return journal;
}

void Store::join_journals(const std::vector<RoomDayRecord>& records) const {
  std::vector<io::Journal> open;  // so that nobody adds to one meanwhile
  const fs::path whole = folder_ / journal_name({});
  std::vector<io::Journal> parts;
  for (const fs::path& file : journals()) (file == whole ? open : parts).emplace_back(file);
  io::Journal::Content all{provenance_, {}};
  for (const RoomDayRecord& record : records) all.pieces.push_back(to_json(record));
  io::write_text_file(whole, io::Journal::text(all));
  for (io::Journal& part : parts) part.remove();
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

}  // namespace pirsim::dataset
