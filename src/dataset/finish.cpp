#include <algorithm>
#include <chrono>

#include "core/digest.hpp"
#include "core/parallel.hpp"
#include "dataset/description.hpp"
#include "dataset/exports.hpp"
#include "dataset/store.hpp"
#include "io/atomic_file.hpp"
#include "io/png.hpp"
#include "pirsim/state.hpp"
#include "schema/clock.hpp"
#include "studies/picture.hpp"

namespace pirsim::dataset {
namespace {

namespace fs = std::filesystem;
constexpr int most_pictures = 6;

/// What was written differs from what is there, though it may be as long.
void require_written(const fs::path& folder, const RoomDayRecord& record) {
  for (const WrittenFile& file : record.files) {
    if (!is_whole(folder, file, Look::contents))
      throw Error(ErrorCode::input, Where{(folder / file.path).string()},
                  "isn't what was written: remove it and make it anew with --resume");
  }
  if (record.scene && !is_whole(folder, *record.scene, Look::contents))
    throw Error(
        ErrorCode::input, Where{(folder / record.scene->path).string()},
        "isn't there or isn't the room that the rows were made of: move it away, and make it anew with --resume");
}

/// Those that were read until it was stopped.
std::vector<RoomDayRecord> read_records(const RecipeSpec& recipe, const fs::path& folder, const std::string& made_by,
                                        const DatasetOptions& options) {
  using Found = std::optional<RoomDayRecord>;
  std::vector<RoomDayRecord> records;
  std::uint32_t missing = 0;
  ordered_parallel<Found>(
      recipe.n_room_days(), options.threads,
      [&](std::size_t i) {
        Found record = whole_record(recipe, folder, static_cast<std::uint32_t>(i), made_by, Look::sizes);
        if (record) require_written(folder, *record);
        return record;
      },
      [&](Found& record) {
        if (record)
          records.push_back(std::move(*record));
        else
          ++missing;
      },
      options.goes_on);
  if (missing > 0) {
    throw Error(ErrorCode::input, Where{folder.string()},
                std::to_string(missing) + " of " + std::to_string(recipe.n_room_days()) +
                    " room-days aren't there yet, or are of another recipe or build: make them with --resume");
  }
  return records;
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

DescribedRoom described_room(const RecipeSpec& recipe, const fs::path& folder, int number,
                             const io::SceneOptions& options) {
  DescribedRoom room;
  room.number = number;
  const fs::path own = own_scene(recipe, number);
  if (own.empty()) room.kind = group_of(recipe, number).rooms.kind;
  room.scene_file = own.empty() ? "rooms/" + room_name(number) + ".gltf" : own.filename().string();
  room.scene = io::read_scene(own.empty() ? room_file(folder, number) : own, options);
  return room;
}

void write_energyplus(const Description& described, const fs::path& folder) {
  std::vector<RoomProfile> rooms;
  int year = 0;
  for (const RoomDayRecord& day : described.days) {
    if (rooms.empty() || rooms.back().room != room_name(day.room)) rooms.push_back({room_name(day.room), {}});
    if (year == 0) year = std::stoi(day.date.substr(0, 4));
    if (!day.fault.empty()) continue;
    const std::chrono::weekday weekday{std::chrono::sys_days(std::chrono::days(day_number(day.date, {})))};
    rooms.back().weekdays[(weekday.iso_encoding() - 1) % 7].push_back({day.presence, day.people});
  }
  make_folders(folder / "exports/energyplus");
  io::write_text_file(folder / "exports/energyplus/presence.csv", to_energyplus(rooms, year));
}

}  // namespace

bool finish_dataset(const RecipeSpec& recipe, const fs::path& folder, const DatasetOptions& options) {
  const auto is_stopped = [&] { return options.goes_on && !options.goes_on(); };
  Description described{
      recipe, provenance(recipe, options.scenes), sensor_columns(recipe, options.scenes), {}, {}, parts_of(recipe), {}};
  described.days = read_records(recipe, folder, described.provenance, options);
  begin(options.observer, DatasetObserver::Stage::describing_rooms, static_cast<std::size_t>(recipe.n_rooms()));
  for (int number = 1; number <= recipe.n_rooms(); ++number) {
    if (is_stopped()) return false;
    done_one(options.observer);
    DescribedRoom room = described_room(recipe, folder, number, options.scenes);
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
  return true;
}

}  // namespace pirsim::dataset
