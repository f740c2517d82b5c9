#include <algorithm>
#include <map>
#include <memory>
#include <mutex>

#include "core/digest.hpp"
#include "core/parallel.hpp"
#include "dataset/room_day.hpp"
#include "dataset/store.hpp"
#include "io/atomic_file.hpp"

namespace pirsim::dataset {
namespace {

namespace fs = std::filesystem;

/// Rooms as files of the dataset, which are what is simulated: whoever runs them again has the same.
class Rooms {
 public:
  Rooms(const RecipeSpec& recipe, const fs::path& folder, const DatasetOptions& options)
      : recipe_(recipe), folder_(folder), options_(options) {}

  std::shared_ptr<const SceneSpec> room(int number) {
    const std::lock_guard lock(mutex_);
    if (const auto known = known_[number].lock()) return known;
    auto scene = std::make_shared<const SceneSpec>(read(number));
    known_[number] = scene;
    return scene;
  }

 private:
  SceneSpec read(int number) const {
    if (const fs::path own = own_scene(recipe_, number); !own.empty()) return io::read_scene(own, options_.scenes);
    const fs::path file = room_file(folder_, number);
    const SceneSpec drawn = room_of(recipe_, number, options_.scenes);
    write_once(file, shard_name(options_), [&](const fs::path& here) { io::write_scene(here, drawn); });
    return io::read_scene(file, options_.scenes);
  }

  const RecipeSpec& recipe_;
  const fs::path& folder_;
  const DatasetOptions& options_;
  std::mutex mutex_;
  std::map<int, std::weak_ptr<const SceneSpec>> known_;
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

void claim_folder(const RecipeSpec& recipe, const fs::path& folder, const std::string& made_by,
                  const DatasetOptions& options) {
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
  write_once(folder / "recipe.yaml", shard_name(options),
             [&](const fs::path& here) { io::write_text_file(here, recipe.text); });
  write_once(file, shard_name(options), [&](const fs::path& here) { io::write_text_file(here, made_by + '\n'); });
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

}  // namespace

bool make_room_days(const RecipeSpec& recipe, const fs::path& folder, const DatasetOptions& options) {
  const std::string made_by = provenance(recipe);
  const std::vector<std::string> columns = sensor_columns(recipe, options.scenes);
  const RunRange range = runs_of(options.shard.value_or(Shard{}), recipe.n_room_days());
  std::vector<std::uint32_t> wanted;
  begin(options.observer, DatasetObserver::Stage::looking_for_days, range.count());
  for (std::uint32_t i = range.first; i < range.end; ++i) {
    done_one(options.observer);
    const bool is_there = options.start == DatasetOptions::Start::resume && whole_record(recipe, folder, i, made_by);
    if (!is_there) wanted.push_back(i);
  }
  check_rooms(recipe, wanted, options);
  claim_folder(recipe, folder, made_by, options);  // not by a recipe that can't be followed
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
        const auto scene = rooms.room(room);
        const RoomDay made = simulate(recipe, *scene, columns, room, day);
        write(made, folder, made_by);
        return Made{made.record, lack_of_people(recipe, *scene, room)};
      },
      [&](Made& made) {
        const RoomDayRecord& record = made.record;
        ++done;
        if (options.made_one) options.made_one();
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

std::vector<std::uint32_t> missing_room_days(const RecipeSpec& recipe, const fs::path& folder) {
  const std::string made_by = provenance(recipe);
  std::vector<std::uint32_t> missing;
  for (std::uint32_t i = 0; i < recipe.n_room_days(); ++i) {
    if (!whole_record(recipe, folder, i, made_by)) missing.push_back(i);
  }
  return missing;
}

}  // namespace pirsim::dataset
