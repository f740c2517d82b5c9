// A dataset read back, for who learns from it.
#include <nlohmann/json.hpp>

#include "core/parallel.hpp"
#include "dataset/recipe.hpp"
#include "io/files/atomic_file.hpp"
#include "io/read/row_reader.hpp"
#include "pirsim/sample.hpp"

namespace pirsim::dataset {
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
