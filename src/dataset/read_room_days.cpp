// A dataset read back, for who learns from it.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/parallel.hpp"
#include "dataset/recipe.hpp"
#include "io/files/atomic_file.hpp"
#include "io/read/csv_reader.hpp"
#include "pirsim/columns.hpp"

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

/// Columns of sensors: the others have names of their own.
std::vector<std::size_t> sensor_columns(const io::CsvTable& table) {
  std::vector<std::size_t> columns;
  const std::vector<std::string> names = table.names(), own = column_names<DayLine>();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool is_sensor = std::ranges::find(own, names[i]) == own.end() && owner_of(names[i]) == Each::sensor;
    if (is_sensor && table.n_rows() > 0 && !table.text(0, i).empty()) columns.push_back(i);
  }
  return columns;
}

RoomDayRows read_day(const fs::path& file) {
  const io::CsvTable table = io::CsvTable::read(file);
  Diagnostics faults;
  const auto room = table.required_column("room", faults), day = table.required_column("day", faults);
  const auto time = table.required_column("time_s", faults), people = table.required_column("people", faults);
  faults.throw_if_errors();
  RoomDayRows read;
  if (table.n_rows() == 0) return read;
  read.room = table.integer(0, *room, faults).value_or(0);
  read.day = table.integer(0, *day, faults).value_or(0);
  read.window_s = table.number(0, *time, faults).value_or(1.0);
  const std::vector<std::size_t> columns = sensor_columns(table);
  for (const std::size_t column : columns) read.sensors.push_back(table.names()[column]);
  read.motion.reserve(table.n_rows() * columns.size());
  read.people.reserve(table.n_rows());
  for (std::size_t row = 0; row < table.n_rows(); ++row) {
    const auto count = table.integer(row, *people, faults);
    if (!count || *count < 0) faults.error(table.where(row, *people), "people: expected a count");
    read.people.push_back(count.value_or(0));
    for (const std::size_t column : columns) {
      const std::string& text = table.text(row, column);
      if (text != "0" && text != "1") faults.error(table.where(row, column), "expected 0 or 1, got '" + text + "'");
      read.motion.push_back(text == "1" ? 1 : 0);
    }
    if (faults.has_errors()) break;
  }
  if (!(read.window_s > 0.0)) faults.error(table.where(0, *time), "time_s: the first window has no length");
  faults.throw_if_errors();
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
