#include <algorithm>
#include <cmath>
#include <iomanip>
#include <set>
#include <sstream>

#include "core/text.hpp"
#include "dataset/description.hpp"
#include "dataset/exports.hpp"
#include "pirsim/version.hpp"

namespace pirsim::dataset {
namespace {

constexpr std::array all_parts{Part::train, Part::validation, Part::test_days, Part::test_rooms};

std::string hours(double seconds) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(seconds < 360'000.0 ? 1 : 0) << seconds / 3600.0;
  return text.str();
}
double share(const MotionCount& count) {
  return count.all == 0 ? 0.0 : static_cast<double>(count.with_motion) / static_cast<double>(count.all);
}

struct PartSums {
  std::set<int> rooms;
  int days = 0, failed = 0;
  double seconds = 0.0;
  std::uint64_t rows = 0, occupied = 0, arrivals = 0;
};

PartSums sums_of(const Description& described, Part part) {
  PartSums sums;
  for (std::size_t i = 0; i < described.days.size(); ++i) {
    const RoomDayRecord& day = described.days[i];
    if (described.parts[i] != part) continue;
    sums.rooms.insert(day.room);
    ++sums.days;
    sums.failed += day.fault.empty() ? 0 : 1;
    sums.seconds += day.seconds;
    sums.rows += day.rows;
    sums.arrivals += day.arrivals;
    for (const auto& [people, count] : day.rows_by_people) sums.occupied += people > 0 ? count.all : 0;
  }
  return sums;
}

std::string table_of_parts(const Description& described) {
  std::string text =
      "| part | rooms | room-days | hours | rows | with anybody there | arrivals "
      "|\n|---|---:|---:|---:|---:|---:|---:|\n";
  for (const Part part : all_parts) {
    const PartSums sums = sums_of(described, part);
    if (sums.days == 0) continue;
    const double occupied = sums.rows == 0 ? 0.0 : static_cast<double>(sums.occupied) / static_cast<double>(sums.rows);
    text += "| `" + name_of(part) + "` | " + std::to_string(sums.rooms.size()) + " | " + std::to_string(sums.days) +
            (sums.failed > 0 ? " (" + std::to_string(sums.failed) + " without rows)" : "") + " | " +
            hours(sums.seconds) + " | " + std::to_string(sums.rows) + " | " + percent(occupied, 1) + " | " +
            std::to_string(sums.arrivals) + " |\n";
  }
  return text;
}

std::string table_of_counts(const Description& described) {
  std::map<int, MotionCount> rows, readings;
  std::uint64_t all = 0;
  for (const RoomDayRecord& day : described.days) {
    for (const auto& [people, count] : day.rows_by_people) {
      rows[people].all += count.all;
      rows[people].with_motion += count.with_motion;
      all += count.all;
    }
    for (const auto& [people, count] : day.readings_by_people) {
      readings[people].all += count.all;
      readings[people].with_motion += count.with_motion;
    }
  }
  const bool has_readings = rows_per_reading(described.recipe.sensing).has_value();
  std::string text = "| people | share of rows | rows with motion at any sensor |";
  text += has_readings ? " 30 s with motion at any sensor |\n|---:|---:|---:|---:|\n" : "\n|---:|---:|---:|\n";
  for (const auto& [people, count] : rows) {
    text += "| " + std::to_string(people) + " | " +
            percent(static_cast<double>(count.all) / static_cast<double>(all), 1) + " | " + percent(share(count), 1) +
            " |" + (has_readings ? ' ' + percent(share(readings[people]), 1) + " |" : "") + '\n';
  }
  return text;
}

std::string about_rooms(const Description& described) {
  const auto extent = [&](const auto& value) {
    auto least = value(described.rooms.front()), most = least;
    for (const DescribedRoom& room : described.rooms) {
      least = std::min(least, value(room));
      most = std::max(most, value(room));
    }
    std::ostringstream text;
    text << least;
    if (most != least) text << " to " << most;
    return text.str();
  };
  const auto squares = [](const DescribedRoom& room) { return std::round(room.scene.floor.area_m2()); };
  return extent(squares) + " m2, with " + extent([](const DescribedRoom& r) { return r.scene.seats.size(); }) +
         " seats and " + extent([](const DescribedRoom& r) { return r.scene.sensors.size(); }) + " sensors";
}

/// How to run a day again; scenes of the recipe's author stay where they are.
std::string rooms_and_scripts(const Description& described) {
  const auto is_drawn = [](const DescribedRoom& room) { return !room.kind.empty(); };
  const auto drawn = std::ranges::find_if(described.rooms, is_drawn);
  std::string text = "- ";
  if (drawn != described.rooms.end()) text += "`rooms/`: the rooms as glTF; ";
  text += "`scripts/`: who does what on each day.";
  if (!std::ranges::all_of(described.rooms, is_drawn))
    text += " The recipe's own scenes aren't part of the dataset; the lines below name them with their hashes.";
  const DescribedRoom& shown = drawn == described.rooms.end() ? described.rooms.front() : *drawn;
  return text + " A day again, to look at: " +
         markdown_code("pirsim --scene " + shown.scene_file + " --script scripts/" + room_name(shown.number) +
                       "/day_01.yaml") +
         ", whose replicate 1 is day 1.\n";
}

}  // namespace

std::string readme(const Description& described) {
  const RecipeSpec& recipe = described.recipe;
  double seconds = 0.0;
  std::uint64_t passes = 0;
  int most_people = 0, failed = 0;
  for (const RoomDayRecord& day : described.days) {
    seconds += day.seconds;
    passes += day.passes_through;
    most_people = std::max(most_people, day.most_people);
    failed += day.fault.empty() ? 0 : 1;
  }
  std::string text = "# " + markdown_text(recipe.name) + "\n";
  text += hours(seconds) + " hours of passive-infrared motion sensors in " + std::to_string(described.rooms.size()) +
          (described.rooms.size() == 1 ? " room" : " rooms") + " (" + about_rooms(described) + "), " +
          std::to_string(recipe.days) + (recipe.days == 1 ? " day" : " days") +
          " each, with the true number of people, " + std::to_string(most_people) +
          " at most. All of it is simulated: nobody was watched.\n\n";
  text += table_of_parts(described) + '\n';
  text +=
      "No room of `train` is in `validation` or `test_rooms`, no day of `train` is in `test_days`, and no row is split "
      "from "
      "its day.\n\n";
  text += "How often a sensor sees motion, by the number of people at the end of that time:\n\n" +
          table_of_counts(described) + '\n';
  for (std::size_t i = 0; i < described.pictures.size(); ++i)
    text += "![Room " + std::to_string(i + 1) + " without its front walls: seats, doors and sensors](" +
            described.pictures[i] + ")\n";
  if (!described.pictures.empty()) text += '\n';
  text += "## What is where\n";
  text +=
      "- `datapackage.json`: every file with its columns, units and hash "
      "([Frictionless](https://specs.frictionlessdata.io)).\n";
  text +=
      "- `rows/`: a file a room and day, a line a window; the columns are explained in `datapackage.json`. A sensor's "
      "column tells *motion*, not occupancy: who keeps still isn't seen.\n";
  text +=
      "- `rooms.csv`, `sensors.csv`, `days.csv`, `effects.csv`: what each room, sensor and day is, which part it "
      "belongs "
      "to, and which effects were drawn for it.\n";
  if (!described.columns.areas.empty())
    text += "- `areas.csv`: the named parts of each room's floor; rows count the people of each.\n";
  if (!described.columns.doors.empty())
    text += "- `doors.csv`: which areas each door joins; rows have a column of its contact.\n";
  text += rooms_and_scripts(described);
  if (recipe.occupants == Occupants::told)
    text += "- `occupants/`: who is where and does what, a line a window and person.\n";
  if (!recipe.exports.empty()) text += "- `exports/`: the same data in other tools' shapes.\n";
  text += "- `recipe.yaml`: what it was made from.\n\n";
  if (failed > 0)
    text +=
        std::to_string(failed) + " room-days have no rows since they couldn't be simulated; `days.csv` says why.\n\n";
  if (passes > 0)
    text += "Two people who found no way round each other went through each other " + std::to_string(passes) +
            " times.\n\n";
  std::string command = "pirsim dataset recipe.yaml -o DIR";
  for (const std::string& change : recipe.overrides) command += " --set '" + change + "'";
  text += "## How it was made, and how to cite it\n" + markdown_code(command) + " of " + program() +
          " makes the same bytes again. Cite pirsim, a headless simulator of passive-infrared motion "
          "sensors, version " +
          version() + ", with the recipe's hash:\n\n    " + described.provenance + '\n';
  return text;
}

}  // namespace pirsim::dataset
