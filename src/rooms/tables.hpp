// What a dataset says of itself: tables of rooms, sensors, days and effects; datapackage.json; README.md.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pirsim/columns.hpp"
#include "rooms/room_day.hpp"

namespace pirsim::dataset {

struct DescribedRoom {
  int number = 0;
  Part part = Part::train;  ///< of its first day
  std::string kind;         ///< as in recipes; empty: the user's own
  std::string scene_file;   ///< relative to the dataset, or as the user named it
  SceneSpec scene;
  int staff = 0;
};

/// All there is to say, of a dataset that is complete.
struct Description {
  const RecipeSpec& recipe;
  std::string provenance;
  ColumnOwners columns;  ///< of the rows
  std::vector<DescribedRoom> rooms;
  std::vector<RoomDayRecord> days;    ///< room by room
  std::vector<Part> parts;            ///< (n_days)
  std::vector<std::string> pictures;  ///< of rooms, relative to the dataset
};

struct Table {
  std::string text;
  std::vector<ColumnInfo> columns;
};
/// By file name: rooms.csv, sensors.csv, days.csv, effects.csv; areas.csv and doors.csv if there are any.
[[nodiscard]] std::map<std::string, Table> tables(const Description& described);
[[nodiscard]] std::string data_package(const Description& described, const std::map<std::string, Table>& tables);
[[nodiscard]] std::string readme(const Description& described);

}  // namespace pirsim::dataset
