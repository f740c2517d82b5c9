#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>

#include "core/digest.hpp"
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

std::string hash_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  Sha256 hash;
  std::string piece(1U << 20U, '\0');
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0)
    hash.add({piece.data(), static_cast<std::size_t>(in.gcount())});
  return hash.hex();
}

std::vector<RoomDayRecord> read_records(const RecipeSpec& recipe, const fs::path& folder, const std::string& made_by) {
  std::vector<RoomDayRecord> records;
  std::uint32_t missing = 0;
  for (std::uint32_t i = 0; i < recipe.n_room_days(); ++i) {
    auto record = whole_record(recipe, folder, i, made_by);
    if (!record) {
      ++missing;
      continue;
    }
    for (const WrittenFile& file : record->files) {
      if (hash_of(folder / file.path) != file.sha256)
        throw Error(ErrorCode::input, Where{(folder / file.path).string()},
                    "isn't what was written: remove it and make it anew with --resume");
    }
    records.push_back(std::move(*record));
  }
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

void finish_dataset(const RecipeSpec& recipe, const fs::path& folder, const io::SceneOptions& options,
                    const DatasetObserver& observer) {
  Description described{recipe, provenance(recipe), sensor_columns(recipe, options), {}, {}, parts_of(recipe), {}};
  described.days = read_records(recipe, folder, described.provenance);
  begin(observer, DatasetObserver::Stage::describing_rooms, static_cast<std::size_t>(recipe.n_rooms()));
  for (int number = 1; number <= recipe.n_rooms(); ++number) {
    done_one(observer);
    DescribedRoom room = described_room(recipe, folder, number, options);
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
  std::map<std::string, WrittenFile> written;
  for (const auto& [name, text] : tables(described)) {
    io::write_text_file(folder / name, text);
    written[name] = {name, text.size(), sha256(text)};
  }
  if (std::ranges::find(recipe.exports, Export::energyplus) != recipe.exports.end())
    write_energyplus(described, folder);
  io::write_text_file(folder / "README.md", readme(described));
  io::write_text_file(folder / "datapackage.json", data_package(described, written));
}

}  // namespace pirsim::dataset
