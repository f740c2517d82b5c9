#include <algorithm>
#include <map>
#include <memory>
#include <mutex>

#include "core/digest.hpp"
#include "core/parallel.hpp"
#include "dataset/room_day.hpp"
#include "dataset/store.hpp"
#include "io/atomic_file.hpp"
#include "io/scene_writer.hpp"

namespace pirsim::dataset {
namespace {

namespace fs = std::filesystem;

/// Rooms as files of the dataset, which are what is simulated: whoever runs them again has the same.
class Rooms {
 public:
  struct Room {
    SceneSpec scene;
    std::optional<WrittenFile> file;  ///< of a drawn room
  };
  Rooms(const RecipeSpec& recipe, const fs::path& folder, const DatasetOptions& options)
      : recipe_(recipe), folder_(folder), options_(options) {}

  std::shared_ptr<const Room> room(int number) {
    const std::lock_guard lock(mutex_);
    if (const auto known = known_[number].lock()) return known;
    auto room = std::make_shared<const Room>(read(number));
    known_[number] = room;
    return room;
  }

 private:
  Room read(int number) const {
    if (const fs::path own = own_scene(recipe_, number); !own.empty())
      return {io::read_scene(own, options_.scenes), std::nullopt};
    const fs::path file = room_file(folder_, number);
    const std::string text = io::scene_text(room_of(recipe_, number, options_.scenes), Where{file.string()});
    write_once(file, text);
    const WrittenFile written{"rooms/" + file.filename().string(), text.size(), sha256(text)};
    return {io::read_scene(file, options_.scenes), written};
  }

  const RecipeSpec& recipe_;
  const fs::path& folder_;
  const DatasetOptions& options_;
  std::mutex mutex_;
  std::map<int, std::weak_ptr<const Room>> known_;
};

/// The record last, so that a room-day with a record is whole.
void write(const RoomDay& made, const fs::path& folder, const std::string& made_by) {
  for (const auto& [path, bytes] : made.contents) {
    make_folders((folder / path).parent_path());
    io::write_text_file(folder / path, bytes);
  }
  const fs::path record = folder / record_path(made.record.room, made.record.day);
  make_folders(record.parent_path());
  io::write_text_file(record, to_json(made.record, made_by));
}

/// What lies where a dataset's files would be written; empty: nothing. The recipe itself may.
fs::path first_in_the_way(const RecipeSpec& recipe, const fs::path& folder) {
  for (const char* name : {"README.md", "datapackage.json", "rooms.csv", "sensors.csv", "days.csv", "effects.csv",
                           "pictures", "rooms", "scripts", "rows", "occupants", "exports"}) {
    if (fs::exists(folder / name)) return folder / name;
  }
  const fs::path there = folder / "recipe.yaml";
  return fs::exists(there) && io::read_text_file(there) != recipe.text ? there : fs::path();
}

void claim_folder(const RecipeSpec& recipe, const fs::path& folder, const std::string& made_by) {
  make_folders(folder);
  const fs::path in_the_way = first_in_the_way(recipe, folder);  // before the next look: another shard may claim now
  const fs::path file = folder / "provenance.txt";
  if (fs::exists(file)) {
    const std::string there = io::read_text_file(file);
    if (there == made_by + '\n') return;
    throw Error(ErrorCode::input, Where{folder.string()},
                "holds another dataset, made from " + there.substr(0, there.find('\n')) + ", not from " + made_by +
                    ": name another folder, or remove this one");
  }
  if (!in_the_way.empty()) {
    throw Error(ErrorCode::input, Where{in_the_way.string()},
                "is there already, and of no dataset: it would be replaced; name another folder");
  }
  write_once(folder / "recipe.yaml", recipe.text);
  write_once(file, made_by + '\n');
}

/// Throws for a room that can't be drawn and for what a room lacks, before hours of work on others.
void check_rooms(const RecipeSpec& recipe, const std::vector<std::uint32_t>& wanted, const DatasetOptions& options) {
  std::vector<int> rooms;
  for (const std::uint32_t i : wanted) {
    const int room = room_and_day(recipe, i).first;
    if (rooms.empty() || rooms.back() != room) rooms.push_back(room);
  }
  begin(options.observer, DatasetObserver::Stage::checking_rooms, rooms.size());
  ordered_parallel<bool>(
      rooms.size(), options.threads,
      [&](std::size_t i) {
        const SceneSpec scene = room_of(recipe, rooms[i], options.scenes);
        try {
          static_cast<void>(compile(scene, script_of(recipe, scene, rooms[i], 1)));
        } catch (const Error& error) {
          if (error.code() != ErrorCode::infeasible) throw;  // which is a day without rows
        }
        return true;
      },
      [&](bool&) { done_one(options.observer); }, options.goes_on);
}

/// Of the shard, by index. Contents are read, since nobody will notice an altered row later.
std::vector<std::uint32_t> wanted_room_days(const RecipeSpec& recipe, const fs::path& folder,
                                            const std::string& made_by, const DatasetOptions& options) {
  const RunRange range = runs_of(options.shard.value_or(Shard{}), recipe.n_room_days());
  std::vector<std::uint32_t> wanted;
  std::uint32_t next = range.first;
  const bool resumes = options.start == DatasetOptions::Start::resume;
  begin(options.observer, DatasetObserver::Stage::looking_for_days, range.count());
  ordered_parallel<bool>(
      range.count(), options.threads,
      [&](std::size_t i) {
        const auto index = range.first + static_cast<std::uint32_t>(i);
        return resumes && whole_record(recipe, folder, index, made_by, Look::contents).has_value();
      },
      [&](bool& is_there) {
        if (!is_there) wanted.push_back(next);
        ++next;
        done_one(options.observer);
      },
      options.goes_on);
  return wanted;
}

}  // namespace

bool make_room_days(const RecipeSpec& recipe, const fs::path& folder, const DatasetOptions& options) {
  const std::string made_by = provenance(recipe, options.scenes);
  const std::vector<std::string> columns = sensor_columns(recipe, options.scenes);
  const std::vector<std::uint32_t> wanted = wanted_room_days(recipe, folder, made_by, options);
  check_rooms(recipe, wanted, options);
  if (options.goes_on && !options.goes_on()) return false;  // not all of them was looked at
  claim_folder(recipe, folder, made_by);                    // not by a recipe that can't be followed
  const AtWork at_work(folder, options.shard);
  Rooms rooms(recipe, folder, options);
  struct Made {
    RoomDayRecord record;
    std::string lack;
  };
  std::size_t done = 0;
  begin(options.observer, DatasetObserver::Stage::making_days, wanted.size());
  bool lack_told = false;  // rooms are alike: one speaks for all
  ordered_parallel<Made>(
      wanted.size(), options.threads,
      [&](std::size_t i) {
        const auto [room, day] = room_and_day(recipe, wanted[i]);
        const auto in = rooms.room(room);
        RoomDay made = simulate(recipe, in->scene, columns, room, day);
        made.record.scene = in->file;
        write(made, folder, made_by);
        return Made{made.record, lack_of_people(recipe, in->scene, room)};
      },
      [&](Made& made) {
        const RoomDayRecord& record = made.record;
        ++done;
        done_one(options.observer);
        if (!options.tell) return;
        if (!made.lack.empty() && !lack_told) {
          options.tell({Severity::warning, Where{recipe.file.string()}, made.lack});
          lack_told = true;
        }
        if (record.fault.empty()) return;
        options.tell({Severity::warning, Where{recipe.file.string()},
                      "room " + std::to_string(record.room) + ", day " + std::to_string(record.day) +
                          " has no rows: " + record.fault});
      },
      options.goes_on);
  return done == wanted.size();
}

std::vector<std::uint32_t> missing_room_days(const RecipeSpec& recipe, const fs::path& folder,
                                             const io::SceneOptions& options) {
  const std::string made_by = provenance(recipe, options);
  std::vector<std::uint32_t> missing;
  for (std::uint32_t i = 0; i < recipe.n_room_days(); ++i) {
    if (!whole_record(recipe, folder, i, made_by, Look::sizes)) missing.push_back(i);
  }
  return missing;
}

}  // namespace pirsim::dataset
