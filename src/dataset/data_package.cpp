#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "core/digest.hpp"
#include "dataset/description.hpp"
#include "pirsim/version.hpp"

namespace pirsim::dataset {
namespace {

using Json = nlohmann::ordered_json;

/// Of Table Schema.
std::string type_of(Holds holds) {
  switch (holds) {
    case Holds::whole:
    case Holds::count:
    case Holds::bit:
      return "integer";
    case Holds::number:
      return "number";
    case Holds::date:
      return "date";
    case Holds::moment:
      return "datetime";
    case Holds::text:
    case Holds::bits:
      break;
  }
  return "string";
}

Json field(const ColumnInfo& column, std::string_view name) {
  Json one{{"name", name}, {"type", type_of(column.holds)}, {"description", column.meaning}};
  if (column.holds == Holds::moment) one["format"] = "%Y-%m-%dT%H:%M:%S";
  if (!column.unit.empty()) one["unit"] = column.unit;
  if (column.holds == Holds::bit) one["constraints"] = {{"minimum", 0}, {"maximum", 1}};
  if (column.holds == Holds::count) one["constraints"] = {{"minimum", 0}};
  return one;
}

template <typename Row>
Json fields_of(const ColumnOwners& owners) {
  Json fields = Json::array();
  for (const Column<Row>& column : columns_of<Row>()) {
    if (column.each != nullptr && column.of == Each::sensor) {
      for (const std::string& sensor : owners.sensors) fields.push_back(field(column, sensor));
    } else if (column.each != nullptr && column.of == Each::area) {
      for (const std::string& area : owners.areas) fields.push_back(field(column, column_of_area(area)));
    } else if (column.each != nullptr) {
      for (const std::string& door : owners.doors) fields.push_back(field(column, column_of_door(door)));
    } else if (column.when != When::with_areas || !owners.areas.empty()) {
      fields.push_back(field(column, column.name));
    }
  }
  return fields;
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

Json resource(const std::string& name, const std::string& title, Json paths, Json fields) {
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
Json resource_of_part(const Description& described, Part part, const std::string& folder) {
  Json paths = Json::array(), files = Json::array();
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
  Json one = resource((is_rows ? "" : folder + "_") + name_of(part),
                      (is_rows ? "Rows: " : "Who is where: ") + name_of(part), std::move(paths),
                      is_rows ? fields_of<DayLine>(described.columns) : fields_of<DayOccupantLine>(described.columns));
  // Neither `bytes` nor `hash` of the whole: readers take them of what is unpacked and joined.
  one["files"] = std::move(files);
  return one;
}

}  // namespace

std::string data_package(const Description& described, const std::map<std::string, Table>& tables) {
  Json resources = Json::array();
  for (const std::string folder : {"rows", "occupants"}) {
    for (const Part part : {Part::train, Part::validation, Part::test_days, Part::test_rooms}) {
      Json one = resource_of_part(described, part, folder);
      if (!one.is_null()) resources.push_back(std::move(one));
    }
  }
  for (const auto& [name, table] : tables) {
    const std::string stem = name.substr(0, name.find('.'));
    Json fields = Json::array();
    for (const ColumnInfo& column : table.columns) fields.push_back(field(column, column.name));
    Json one = resource(stem, "One line each: " + stem, name, std::move(fields));
    one["bytes"] = table.text.size();
    one["hash"] = "sha256:" + sha256(table.text);
    resources.push_back(std::move(one));
  }
  const Json package{{"profile", "data-package"},
                     {"name", slug(described.recipe.name)},
                     {"title", described.recipe.name},
                     {"description",
                      "Simulated passive-infrared motion sensors in rooms with people, and the true number of people. "
                      "Made by pirsim; README.md has the figures."},
                     {"version", version()},
                     {"keywords", {"passive infrared", "occupancy", "people counting", "simulation"}},
                     {"contributors", {{{"title", program()}, {"role", "wrangler"}}}},
                     {"provenance", described.provenance},
                     {"recipe", {{"path", "recipe.yaml"}, {"hash", "sha256:" + sha256(described.recipe.text)}}},
                     {"resources", std::move(resources)}};
  return package.dump(1) + '\n';
}

}  // namespace pirsim::dataset
