#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "core/digest.hpp"
#include "dataset/description.hpp"
#include "pirsim/version.hpp"

namespace pirsim::dataset {
namespace {

using json = nlohmann::ordered_json;

json field(const std::string& name, const std::string& type, const std::string& what, const std::string& unit = {}) {
  json one{{"name", name}, {"type", type}, {"description", what}};
  if (type == "datetime") one["format"] = "%Y-%m-%dT%H:%M:%S";
  if (!unit.empty()) one["unit"] = unit;
  return one;
}
json bit(const std::string& name, const std::string& what) {
  json one = field(name, "integer", what);
  one["constraints"] = {{"minimum", 0}, {"maximum", 1}};
  return one;
}
json count(const std::string& name, const std::string& what, const std::string& unit = "1") {
  json one = field(name, "integer", what, unit);
  one["constraints"] = {{"minimum", 0}};
  return one;
}

json room_field() { return field("room", "integer", "Number of the room; see the resource rooms."); }
json day_field() { return field("day", "integer", "Number of the day in this room, from 1; see the resource days."); }
json time_field() {
  return field("time", "datetime", "Local wall-clock time at the end of the window that the row covers, ISO 8601.");
}
json time_s_field() {
  return field("time_s", "number", "The same, from the beginning of the simulated part of the day.", "s");
}

json row_fields(const Description& described) {
  json fields{room_field(),
              day_field(),
              time_field(),
              time_s_field(),
              count("people", "People over the floor area at the end of the window: the truth to be estimated."),
              bit("presence", "1 if anybody is there at the end of the window."),
              count("arrivals", "People who are over the floor now and weren't at the end of the window before."),
              count("departures", "People who were over the floor at the end of the window before and aren't now.")};
  for (const std::string& sensor : described.sensor_columns) {
    fields.push_back(bit(sensor,
                         "1 if this sensor saw motion in the window. A motion sensor (Brick: Motion_Sensor), "
                         "not an occupancy sensor: nobody who keeps still is seen. Empty: this room has no such "
                         "sensor; see the resource sensors."));
  }
  return fields;
}

json occupant_fields() {
  return {room_field(),
          day_field(),
          time_field(),
          time_s_field(),
          field("person", "string", "Who it is, on all days of this room."),
          field("where", "string", "inside: over the floor area; outside: in or behind a doorway."),
          field("activity", "string", "What the person does."),
          field("seat", "string", "The seat that is theirs at the moment, or empty."),
          field("x_m", "number", "Of the pelvis in the room's scene.", "m"),
          field("z_m", "number", "Of the pelvis in the room's scene.", "m")};
}

json fields_of_table(const std::string& name) {
  if (name == "rooms.csv") {
    return {room_field(),
            field("part", "string", "train, validation or test_rooms; test_days are days of rooms in train."),
            field("kind", "string", "office or meeting; own: a scene of the recipe's author."),
            field("scene", "string", "glTF file of the room."),
            field("floor_m2", "number", "Floor area.", "m2"),
            count("doors", "Entrances."),
            count("seats", "Seats."),
            count("sensors", "Sensors."),
            count("staff", "People with a desk of their own here.")};
  }
  if (name == "sensors.csv") {
    return {room_field(),
            field("sensor", "string", "Name of the rows' column."),
            field("model", "string", "Which lens: a file of data/sensors of pirsim."),
            field("x_m", "number", "Place in the room's scene.", "m"),
            field("y_m", "number", "Height.", "m"),
            field("z_m", "number", "Place in the room's scene.", "m"),
            field("heading_deg", "number",
                  "Direction in which it looks, 0 along -z, positive to the left; of one that looks straight down, the "
                  "direction of its picture's upper edge.",
                  "deg"),
            field("tilt_deg", "number", "Of its axis below the horizon.", "deg")};
  }
  if (name == "days.csv") {
    return {room_field(),
            day_field(),
            field("date", "date", "Calendar date."),
            field("part", "string", "train, validation, test_days or test_rooms."),
            count("rows", "Rows of this day."),
            field("hours", "number", "That they cover.", "h"),
            count("most_people", "At once."),
            field("presence_share", "number", "Share of rows with anybody there."),
            count("arrivals", "Of the day."),
            count("departures", "Of the day."),
            count("passes_through", "How often two people who found no way round each other went through each other."),
            field("failed", "string", "Why the day has no rows, if it hasn't.")};
  }
  return {room_field(),
          day_field(),
          field("effect", "string", "Entry of pirsim's catalogue of effects."),
          field("sensor", "string", "The sensor that it acts on; empty: all, or the effect's own way."),
          field("parameter", "string", "Its name ends in its unit."),
          field("value", "string", "A number or a word.")};
}

/// Letters, digits and hyphens, as package names are.
std::string slug(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const bool fits = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (fits) result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (!fits && !result.empty() && result.back() != '-') result += '-';
  }
  while (result.ends_with('-')) result.pop_back();
  return result.empty() ? "dataset" : result;
}

json resource(const std::string& name, const std::string& title, json paths, json fields) {
  return {{"name", name},
          {"title", title},
          {"profile", "tabular-data-resource"},
          {"path", std::move(paths)},
          {"format", "csv"},
          {"mediatype", "text/csv"},
          {"encoding", "utf-8"},
          {"schema", {{"fields", std::move(fields)}, {"missingValues", {""}}}}};
}

/// The rows, or the occupants, of one part; null if there are none.
json resource_of_part(const Description& described, Part part, const std::string& folder) {
  json paths = json::array(), files = json::array();
  for (std::size_t i = 0; i < described.days.size(); ++i) {
    if (described.parts[i] != part) continue;
    for (const WrittenFile& file : described.days[i].files) {
      if (!file.path.starts_with(folder + '/')) continue;
      paths.push_back(file.path);
      files.push_back({{"path", file.path}, {"bytes", file.bytes}, {"hash", "sha256:" + file.sha256}});
    }
  }
  if (paths.empty()) return {};
  const bool is_rows = folder == "rows";
  json one =
      resource((is_rows ? "" : folder + "_") + name_of(part), (is_rows ? "Rows: " : "Who is where: ") + name_of(part),
               std::move(paths), is_rows ? row_fields(described) : occupant_fields());
  // Neither `bytes` nor `hash` of the whole: readers take them of what is unpacked and joined.
  one["files"] = std::move(files);
  return one;
}

}  // namespace

std::string data_package(const Description& described, const std::map<std::string, WrittenFile>& tables) {
  json resources = json::array();
  for (const std::string folder : {"rows", "occupants"}) {
    for (const Part part : {Part::train, Part::validation, Part::test_days, Part::test_rooms}) {
      json one = resource_of_part(described, part, folder);
      if (!one.is_null()) resources.push_back(std::move(one));
    }
  }
  for (const auto& [name, file] : tables) {
    const std::string stem = name.substr(0, name.find('.'));
    json one = resource(stem, "One line each: " + stem, name, fields_of_table(name));
    one["bytes"] = file.bytes;
    one["hash"] = "sha256:" + file.sha256;
    resources.push_back(std::move(one));
  }
  const json package{
      {"profile", "data-package"},
      {"name", slug(described.recipe.name)},
      {"title", described.recipe.name},
      {"description",
       "Simulated passive-infrared motion sensors in rooms with people, and the true number of people. "
       "Made by pirsim; README.md has the figures."},
      {"version", version()},
      {"keywords", {"passive infrared", "occupancy", "people counting", "simulation"}},
      {"contributors", {{{"title", "pirsim " + version() + " (" + git_revision() + ")"}, {"role", "wrangler"}}}},
      {"provenance", described.provenance},
      {"recipe", {{"path", "recipe.yaml"}, {"hash", "sha256:" + sha256(described.recipe.text)}}},
      {"resources", std::move(resources)}};
  return package.dump(1) + '\n';
}

}  // namespace pirsim::dataset
