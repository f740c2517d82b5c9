#include <algorithm>
#include <map>
#include <memory>
#include <mutex>

#include "core/digest.hpp"
#include "core/parallel.hpp"
#include "dataset/room_day.hpp"
#include "dataset/store.hpp"
#include "io/files/atomic_file.hpp"
#include "io/write/scene_writer.hpp"
#include "pirsim/effects.hpp"

namespace pirsim::dataset {
namespace {

namespace fs = std::filesystem;

/// Which room and which of its days.
std::pair<int, int> room_and_day(const RecipeSpec& recipe, std::uint32_t index) {
  const int i = static_cast<int>(index);
  return {i / recipe.days + 1, i % recipe.days + 1};
}

/// Drawn rooms as the text of their files, by number.
using DrawnRooms = std::map<int, std::string>;

/// Rooms as files of the dataset, which are what is simulated: whoever runs them again has the same.
class Rooms {
 public:
  Rooms(const Store& store, const DrawnRooms& drawn) : store_(store), drawn_(drawn) {}

  std::shared_ptr<const Room> room(int number) {
    const std::lock_guard lock(mutex_);
    std::shared_ptr<const Room> room = known_[number].lock();
    if (!room) known_[number] = room = read(number);
    newest_ = room;  // the next day is most likely one of this room
    return room;
  }

 private:
  [[nodiscard]] std::shared_ptr<const Room> read(int number) const {
    if (const SceneSpec* own = store_.own_scene(number))
      return std::make_shared<const Room>(number, *own, std::nullopt);
    const std::string& text = drawn_.at(number);
    write_once(store_.room_file(number), text);
    return std::make_shared<const Room>(number, io::read_scene(store_.room_file(number), store_.scenes()),
                                        WrittenFile{room_path(number), text.size(), sha256(text)});
  }

  const Store& store_;
  const DrawnRooms& drawn_;
  std::mutex mutex_;
  std::map<int, std::weak_ptr<const Room>> known_;
  std::shared_ptr<const Room> newest_;
};

void write(const RoomDay& made, const fs::path& folder) {
  for (const auto& [path, bytes] : made.contents) {
    make_folders((folder / path).parent_path());
    io::write_text_file(folder / path, bytes);
  }
}

/// What lies where a dataset's files would be written; empty: nothing. The recipe itself may.
fs::path first_in_the_way(const RecipeSpec& recipe, const fs::path& folder) {
  for (const char* name : dataset_parts) {
    if (fs::exists(folder / name)) return folder / name;
  }
  const fs::path there = folder / "recipe.yaml";
  return fs::exists(there) && io::read_text_file(there) != recipe.text ? there : fs::path();
}

void claim_folder(const Store& store) {
  const RecipeSpec& recipe = store.recipe();
  const fs::path& folder = store.folder();
  const std::string& made_by = store.provenance();
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

/// Of the recipe's effects those that do nothing in any of the rooms.
void tell_idle_effects(const RecipeSpec& recipe, const SceneSpec& all_sensors, const DatasetOptions& options) {
  std::vector<EffectSpec> all;
  for (const VariedEffectSpec& effect : recipe.effects) all.push_back({effect.name, {}, {}, effect.where});
  for (const Issue& issue : effects::idle(all, all_sensors, recipe.sensing)) options.tell(issue);
}

/// Throws for a room that can't be drawn and for what a room lacks, before hours of work on others.
DrawnRooms draw_and_check(const Store& store, const std::vector<std::uint32_t>& wanted, const DatasetOptions& options) {
  const RecipeSpec& recipe = store.recipe();
  std::vector<int> rooms;
  for (const std::uint32_t i : wanted) {
    const int room = room_and_day(recipe, i).first;
    if (rooms.empty() || rooms.back() != room) rooms.push_back(room);
  }
  const auto check = [&](const SceneSpec& scene, int room) {
    try {
      static_cast<void>(compile(scene, script_of(recipe, scene, room, 1)));
    } catch (const Error& error) {
      if (error.code() != ErrorCode::infeasible) throw;  // which is a day without rows
    }
  };
  struct Checked {
    std::string text;
    SceneSpec scene;
  };
  DrawnRooms drawn;
  SceneSpec all_sensors;  // of all rooms, and nothing else
  std::size_t n_checked = 0;
  begin(options.observer, DatasetObserver::Stage::checking_rooms, rooms.size());
  ordered_parallel<Checked>(
      rooms.size(), options.threads,
      [&](std::size_t i) {
        const SceneSpec* own = store.own_scene(rooms[i]);
        SceneSpec scene = own != nullptr ? *own : room_of(recipe, rooms[i], store.scenes());
        check(scene, rooms[i]);
        const Where file{store.room_file(rooms[i]).string()};
        std::string text = own != nullptr ? std::string{} : io::scene_text(scene, file);
        return Checked{std::move(text), std::move(scene)};
      },
      [&](Checked& checked) {
        drawn.emplace(rooms[n_checked++], std::move(checked.text));
        std::ranges::copy(checked.scene.sensors, std::back_inserter(all_sensors.sensors));
        all_sensors.sensor_models.merge(checked.scene.sensor_models);
        done_one(options.observer);
      },
      options.goes_on);
  if (options.tell && !rooms.empty()) tell_idle_effects(recipe, all_sensors, options);
  return drawn;
}

/// Of the shard, by index. Contents are read, since nobody will notice an altered row later.
std::vector<std::uint32_t> wanted_room_days(const Store& store, const DatasetOptions& options) {
  const RunRange range = runs_of(options.shard.value_or(Shard{}), store.recipe().n_room_days());
  const bool resumes = options.start == DatasetOptions::Start::resume;
  const auto records = resumes ? store.records() : std::map<std::uint32_t, RoomDayRecord>{};
  std::vector<std::uint32_t> wanted;
  std::uint32_t next = range.first;
  begin(options.observer, DatasetObserver::Stage::looking_for_days, range.count());
  ordered_parallel<bool>(
      range.count(), options.threads,
      [&](std::size_t i) {
        const auto found = records.find(range.first + static_cast<std::uint32_t>(i));
        return found != records.end() && store.is_whole(found->second, Look::contents);
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
  const Store store(recipe, folder, options.scenes);
  const std::vector<std::uint32_t> wanted = wanted_room_days(store, options);
  const DrawnRooms drawn = draw_and_check(store, wanted, options);
  if (options.goes_on && !options.goes_on()) return false;  // not all of them was looked at
  claim_folder(store);                                      // not by a recipe that can't be followed
  io::Journal journal = store.open_journal(options.shard, options.start);
  std::mutex of_journal;
  Rooms rooms(store, drawn);
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
        const RoomDay made = simulate(recipe, *in, day, store.columns());
        write(made, folder);
        const std::lock_guard lock(of_journal);
        journal.add(to_json(made.record));  // last: what the journal names is whole
        return Made{made.record, lack_of_people(recipe, in->scene(), room)};
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
  const Store store(recipe, folder, options);
  const auto records = store.records();
  std::vector<std::uint32_t> missing;
  for (std::uint32_t i = 0; i < recipe.n_room_days(); ++i) {
    const auto found = records.find(i);
    if (found == records.end() || !store.is_whole(found->second, Look::sizes)) missing.push_back(i);
  }
  return missing;
}

}  // namespace pirsim::dataset
