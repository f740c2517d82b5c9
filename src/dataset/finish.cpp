#include <algorithm>
#include <chrono>

#include "core/digest.hpp"
#include "core/parallel.hpp"
#include "dataset/description.hpp"
#include "dataset/exports.hpp"
#include "dataset/store.hpp"
#include "io/files/atomic_file.hpp"
#include "io/pages/png.hpp"
#include "pirsim/state.hpp"
#include "schema/clock.hpp"
#include "studies/picture.hpp"

namespace pirsim::dataset {
namespace {

namespace fs = std::filesystem;
constexpr int most_pictures = 6;

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
    if (number <= most_pictures) {
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

}  // namespace pirsim::dataset
