#include <filesystem>

#include "io/files/compression.hpp"
#include "io/files/input.hpp"
#include "io/read/occupancy_tables.hpp"
#include "io/read/reader_parts.hpp"
#include "io/read/yaml_map.hpp"

namespace pirsim::io {
namespace {

/// The table, or none after a fault.
std::optional<CsvTable> read_table(const std::string& file, const detail::FilesBeside& beside, const Where& where,
                                   std::vector<InputFile>& files, Diagnostics& faults) {
  const NamedFile named = beside.find(file, DataKind::measured);
  if (!named.fault.empty()) {
    faults.error(where, "occupancy: " + named.fault);
    return std::nullopt;
  }
  try {
    Input input = read_input(named.path);
    files.push_back(input.file());
    return CsvTable::parse(decompressed(std::move(input), max_text_file_bytes), named.path.string());
  } catch (const Error& fault) {
    for (const Issue& issue : fault.issues()) faults.error(issue.where, issue.message);
  }
  return std::nullopt;
}

/// `areas: {kitchen: people_kitchen}`; their numbers come with the table.
void read_areas(YamlMap& map, CountsSpec& counts) {
  const auto node = map.child("areas");
  if (!node) return;
  const std::vector<YamlKey> keys = node->keys();
  const std::vector<YamlNode> columns = node->items();
  if (keys.empty())
    map.faults().error(node->where(), map.label("areas") + ": expected each area's column, {kitchen: people_kitchen}");
  for (std::size_t i = 0; i < keys.size(); ++i)
    counts.areas.push_back({keys[i].name, columns[i].text(map.faults(), map.label("areas") + '.' + keys[i].name), {}});
}

}  // namespace

namespace detail {

std::optional<OccupancySpec> OccupancyReader::read(const std::optional<YamlNode>& node, const std::string& begin,
                                                   Diagnostics& faults) {
  if (!node) return std::nullopt;
  Diagnostics found;
  YamlMap map(*node, found, "occupancy");
  OccupancySpec spec;
  spec.where = node->where();
  read_fields(map, spec);
  if (map.child("counts")) {
    CountsSpec& counts = spec.counts.emplace();
    counts.file = map.required_text("counts");
    counts.time = map.text("time");
    counts.column = map.text("people");
    read_areas(map, counts);
    if (const auto table = read_table(counts.file, beside_, map.where("counts"), files_, found))
      read_counts(*table, counts, found);
  }
  if (map.child("places")) {
    PlacesSpec& places = spec.places.emplace();
    places.file = map.required_text("places");
    if (const auto table = read_table(places.file, beside_, map.where("places"), files_, found))
      read_places(*table, places, found);
  }
  if (map.child("positions")) {
    PositionsSpec& positions = spec.positions.emplace();
    positions.file = map.required_text("positions");
    if (const auto table = read_table(positions.file, beside_, map.where("positions"), files_, found))
      read_positions(*table, positions, found);
  }
  map.finish();
  if (!found.has_errors()) {
    check_together(spec, begin, [&](std::string_view field, const std::string& message) {
      if (field.ends_with("_h")) field.remove_suffix(2);
      found.error(map.where(std::string(field)), "occupancy: " + message);
    });
  }
  for (const Issue& issue : found.issues()) faults.error(issue.where, issue.message);
  return spec;
}

}  // namespace detail
}  // namespace pirsim::io
