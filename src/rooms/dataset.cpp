#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>

#include "files/disk/file.hpp"
#include "files/read/row_reader.hpp"
#include "files/write/gltf_writer.hpp"
#include "model/core/parallel.hpp"
#include "model/core/random.hpp"
#include "model/schema/clock.hpp"
#include "pirsim/effects.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/state.hpp"
#include "rooms/recipe.hpp"
#include "rooms/room_day.hpp"
#include "rooms/tables.hpp"
#include "show/png.hpp"
#include "surveys/picture.hpp"

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

namespace {

namespace fs = std::filesystem;

/// What was written differs from what is there, though it may be as long.
void require_written(const Store& store, const RoomDayRecord& record) {
  for (const WrittenFile& file : record.files) {
    if (!store.is_whole(file, Look::contents))
      throw Error(ErrorCode::input, Where{(store.folder() / file.path).string()},
                  "isn't what was written: remove it and make it anew with --resume");
  }
  if (record.scene && !store.is_whole(*record.scene, Look::contents))
    throw Error(
        ErrorCode::input, Where{(store.folder() / record.scene->path).string()},
        "isn't there or isn't the room that the rows were made of: move it away, and make it anew with --resume");
}

/// Those that were looked at until it was stopped.
std::vector<RoomDayRecord> whole_records(const Store& store, const DatasetOptions& options) {
  auto found = store.records();
  std::vector<RoomDayRecord> whole;
  std::uint32_t missing = 0, next = 0;
  ordered_parallel<bool>(
      store.recipe().n_room_days(), options.threads,
      [&](std::size_t i) {
        const auto record = found.find(static_cast<std::uint32_t>(i));
        if (record == found.end() || !store.is_whole(record->second, Look::sizes)) return false;
        require_written(store, record->second);
        return true;
      },
      [&](bool& is_there) {
        const std::uint32_t index = next++;
        if (is_there)
          whole.push_back(found.at(index));
        else
          ++missing;
      },
      options.goes_on);
  if (missing > 0) {
    throw Error(ErrorCode::input, Where{store.folder().string()},
                std::to_string(missing) + " of " + std::to_string(store.recipe().n_room_days()) +
                    " room-days aren't there yet, or are of another recipe or build: make them with --resume");
  }
  return whole;
}

/// As it is before anybody comes. Beams would cover it: a sensor has hundreds.
void draw_room_picture(const RecipeSpec& recipe, const SceneSpec& scene, int room, const fs::path& file) {
  ScriptSpec script = script_of(recipe, scene, room, 1);
  script.effects.clear();
  const Model model = compile(scene, std::move(script));
  studies::PictureSpec spec;
  spec.width = 960;
  spec.height = 540;
  const io::Pixels image = studies::picture(model, State(model, 0), spec);
  make_folders(file.parent_path());
  io::write_png(file, image.width, image.height, image.rgb);
}

DescribedRoom described_room(const Store& store, int number) {
  DescribedRoom room;
  room.number = number;
  const SceneSpec* own = store.own_scene(number);
  if (own == nullptr) room.kind = kind_of(group_of(store.recipe(), number));
  room.scene_file = own == nullptr ? room_path(number) : own_scene(store.recipe(), number)->file.filename().string();
  room.scene = own == nullptr ? io::read_scene(store.room_file(number), store.scenes()) : *own;
  return room;
}

void write_energyplus(const Description& described, const fs::path& folder) {
  std::vector<RoomProfile> rooms;  // each followed by its areas
  std::size_t first = 0;           // of the room at hand
  int year = 0;
  for (const RoomDayRecord& day : described.days) {
    if (year == 0) year = std::stoi(day.date.substr(0, 4));
    if (!day.fault.empty()) continue;  // who was there isn't known; a room without any other day has no columns
    const std::chrono::weekday weekday{std::chrono::sys_days(std::chrono::days(day_number(day.date, {})))};
    if (!rooms.empty() && rooms[first].room != room_name(day.room)) first = rooms.size();
    const auto add = [&](const std::string& name, const DayProfile& profile) {
      auto known = std::find_if(rooms.begin() + static_cast<std::ptrdiff_t>(first), rooms.end(),
                                [&](const RoomProfile& room) { return room.room == name; });
      if (known == rooms.end()) known = rooms.insert(rooms.end(), {name, {}});
      known->weekdays[(weekday.iso_encoding() - 1) % 7].push_back(profile);
    };
    add(room_name(day.room), {day.presence, day.people});
    for (const auto& [area, profile] : day.areas) add(room_name(day.room) + '_' + area, profile);
  }
  make_folders(folder / "exports/energyplus");
  io::write_text_file(folder / "exports/energyplus/presence.csv", to_energyplus(rooms, year));
}

}  // namespace

bool finish_dataset(const RecipeSpec& recipe, const fs::path& folder, const DatasetOptions& options) {
  const auto is_stopped = [&] { return options.goes_on && !options.goes_on(); };
  const Store store(recipe, folder, options.scenes);
  Description described{recipe, store.provenance(), store.columns(), {}, {}, parts_of(recipe), {}};
  described.days = whole_records(store, options);
  begin(options.observer, DatasetObserver::Stage::describing_rooms, static_cast<std::size_t>(recipe.n_rooms()));
  for (int number = 1; number <= recipe.n_rooms(); ++number) {
    if (is_stopped()) return false;
    done_one(options.observer);
    DescribedRoom room = described_room(store, number);
    const auto first = static_cast<std::size_t>((number - 1) * recipe.days);
    room.part = described.parts[first];
    room.staff = described.days[first].staff;
    if (number <= recipe.pictures) {
      const std::string file = "pictures/" + room_name(number) + ".png";
      draw_room_picture(recipe, room.scene, number, folder / file);
      described.pictures.push_back(file);
    }
    described.rooms.push_back(std::move(room));
  }
  if (is_stopped()) return false;
  const std::map<std::string, Table> drawn = tables(described);
  for (const auto& [name, table] : drawn) io::write_text_file(folder / name, table.text);
  if (std::ranges::find(recipe.exports, Export::energyplus) != recipe.exports.end())
    write_energyplus(described, folder);
  io::write_text_file(folder / "README.md", readme(described));
  io::write_text_file(folder / "datapackage.json", data_package(described, drawn));
  store.join_journals(described.days);
  return true;
}

// A dataset read back, for who learns from it.

namespace {

namespace fs = std::filesystem;

/// Paths of a part's rows, relative to the folder.
std::vector<std::string> paths_of(const fs::path& folder, Part part) {
  const fs::path file = folder / "datapackage.json";
  if (!fs::exists(file)) {
    throw Error(ErrorCode::io, Where{folder.string()},
                "there is no datapackage.json: is it a dataset, and was it finished (pirsim dataset --finish)?");
  }
  std::vector<std::string> paths;
  try {
    const auto package = nlohmann::json::parse(io::read_text_file(file));
    for (const auto& resource : package.at("resources")) {
      if (resource.at("name") == name_of(part)) resource.at("path").get_to(paths);
    }
  } catch (const nlohmann::json::exception&) {
    throw Error(ErrorCode::input, Where{file.string()}, "isn't a dataset's description, as pirsim dataset writes it");
  }
  return paths;
}

RoomDayRows read_day(const fs::path& file) {
  io::RowReader reader(file);
  for (const auto& [column, name] : {std::pair{io::RowFormat::room, "room"}, std::pair{io::RowFormat::day, "day"},
                                     std::pair{io::RowFormat::people, "people"}}) {
    if (!reader.format().has(column))
      throw Error(ErrorCode::input, {file.string(), 1, 1}, "column '" + std::string(name) + "' is missing");
  }
  RoomDayRows read;
  read.window_s = reader.step_s();
  std::vector<std::size_t> columns;  // of the sensors that this room has
  std::string day;
  Sample row;
  while (reader.next_of_all(row)) {
    if (read.people.empty()) {
      read.room = row.replicate;
      day = row.trial;
      const auto number = io::parse_number<int>(day);
      if (!number)
        throw Error(ErrorCode::input, reader.format().where(io::RowFormat::day),
                    "day: expected a whole number, got '" + day + "'");
      read.day = *number;
      for (std::size_t i = 0; i < row.bits.size(); ++i) {
        if (row.bits[i] == absent_bit) continue;
        columns.push_back(i);
        read.sensors.push_back(reader.format().columns().sensors[i]);
      }
    }
    if (row.replicate != read.room || row.trial != day)
      throw Error(ErrorCode::input, reader.format().where(io::RowFormat::day), "rows of more than one day");
    read.people.push_back(row.people);
    for (const std::size_t column : columns) read.motion.push_back(row.bits[column]);
  }
  return read;
}

}  // namespace

std::vector<RoomDayRows> read_room_days(const fs::path& folder, Part part, unsigned threads) {
  const std::vector<std::string> paths = paths_of(folder, part);
  std::vector<RoomDayRows> days;
  ordered_parallel<RoomDayRows>(
      paths.size(), threads, [&](std::size_t i) { return read_day(folder / paths[i]); },
      [&](RoomDayRows& day) {
        if (!day.people.empty()) days.push_back(std::move(day));
      },
      {});
  return days;
}

}  // namespace pirsim::dataset
