#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "files/read/reader_parts.hpp"
#include "files/read/yaml.hpp"
#include "model/core/text.hpp"
#include "model/schema/dome.hpp"
#include "pirsim/error.hpp"
#include "pirsim/io.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim::io {
namespace {

namespace fs = std::filesystem;

struct ShippedKind {
  DataKind kind;
  std::string_view folder;
  std::array<std::string_view, 2> endings;  ///< what else lies there is about the data: pages, where numbers come from
};

constexpr std::array shipped_kinds{
    ShippedKind{DataKind::rooms, "rooms", {".gltf", ".glb"}},
    ShippedKind{DataKind::plans, "plans", {".yaml", ".yml"}},
    ShippedKind{DataKind::studies, "studies", {".yaml", ".yml"}},
    ShippedKind{DataKind::recipes, "recipes", {".yaml", ".yml"}},
    ShippedKind{DataKind::sensors, "sensors", {".yaml", ".yml"}},
    ShippedKind{DataKind::measured, "measured", {".csv", ".csv"}},
};

/// By name.
std::map<std::string, fs::path> files_of(const ShippedKind& kind, std::span<const fs::path> folders) {
  std::map<std::string, fs::path> files;
  for (const fs::path& folder : folders) {
    std::error_code fault;
    for (fs::directory_iterator entry(folder / kind.folder, fault), end; !fault && entry != end;
         entry.increment(fault)) {
      const fs::path& path = entry->path();
      if (std::ranges::find(kind.endings, path.extension().string()) == kind.endings.end()) continue;
      files.emplace(path.filename().string(), path.lexically_normal());  // the first of a name stays
    }
  }
  return files;
}

constexpr const char* dangling = "is a link to a file that isn't there";

const ShippedKind& of(DataKind kind) { return *std::ranges::find(shipped_kinds, kind, &ShippedKind::kind); }

}  // namespace

std::string_view folder_of(DataKind kind) { return of(kind).folder; }

std::vector<fs::path> data_folders(std::span<const fs::path> data_directories) {
  std::vector<fs::path> folders;
  std::error_code fault;
  if (const char* own = std::getenv("PIRSIM_DATA_DIR"); own != nullptr && *own != '\0') {
    if (!fs::is_directory(own, fault))
      throw Error(ErrorCode::io, Where{own}, "PIRSIM_DATA_DIR: there is no such folder");
    folders.emplace_back(own);
  }
  folders.insert(folders.end(), data_directories.begin(), data_directories.end());
  return folders;
}

std::vector<ShippedFile> shipped_files(std::span<const fs::path> data_directories) {
  const std::vector<fs::path> folders = data_folders(data_directories);
  std::vector<ShippedFile> all;
  for (const ShippedKind& kind : shipped_kinds) {
    for (const auto& [name, path] : files_of(kind, folders)) all.push_back({kind.kind, path});
  }
  return all;
}

fs::path find_file(const fs::path& file, DataKind kind, std::span<const fs::path> data_directories) {
  std::error_code fault;
  if (fs::exists(file, fault)) return file;
  if (fs::is_symlink(file, fault)) throw Error(ErrorCode::io, Where{file.string()}, dangling);
  const auto files = files_of(of(kind), data_folders(data_directories));
  if (file.has_parent_path()) {
    const std::string bare = file.filename().string();
    if (!files.contains(bare)) return file;
    throw Error(ErrorCode::io, Where{file.string()}, "no such file; '" + bare + "' without a folder is a shipped one");
  }
  const std::string name = file.string();
  if (const auto shipped = files.find(name); shipped != files.end()) return shipped->second;
  std::vector<std::string> names;
  for (const auto& [known, path] : files) names.push_back(known);
  std::string among;
  if (!names.empty()) among = ", nor one among the shipped " + std::string(folder_of(kind)) + near_or_all(name, names);
  throw Error(ErrorCode::io, Where{name}, "no such file" + among);
}

NamedFile find_beside(const fs::path& folder, const fs::path& file, DataKind kind,
                      std::span<const fs::path> data_directories) {
  std::error_code fault;
  const fs::path beside = folder / file;
  if (fs::exists(beside, fault) && !fs::is_directory(beside, fault)) return {beside, {}};
  if (!fs::exists(beside, fault) && fs::is_symlink(beside, fault))
    return {beside, "'" + beside.string() + "' " + dangling};
  const auto files = files_of(of(kind), data_folders(data_directories));
  const std::string bare = file.filename().string();
  const auto shipped = files.find(bare);
  const std::string none = "there is no file '" + beside.string() + "'";
  if (file.has_parent_path()) {
    const bool is_shipped = shipped != files.end();
    return {beside, none + (is_shipped ? "; '" + bare + "' without a folder is a shipped one" : "")};
  }
  if (shipped != files.end()) return {shipped->second, {}};
  std::vector<std::string> names;
  for (const auto& [known, path] : files) names.push_back(known);
  return {beside, none + did_you_mean(bare, names)};
}

namespace {

enum class Layout { diamond, square };
enum class Polarity { checkerboard, same };
enum class Missing { none, outer };

constexpr NumberRange length_m{.min = 1e-3, .max = 1000.0};  ///< what is shorter leaves no digits to directions
constexpr double pitch_to_side = 1.0 / 0.6;                  ///< of the quad's elements, quoted: docs/physics/zones.md

/// What the facets of one lens share.
struct FacetLaw {
  double plane_m = 1.0;
  Layout layout = Layout::diamond;
  double half_spacing_ratio = 0.0;  ///< of the distance from the sensor to the facet's centre on the plane
  double half_diagonal_ratio = 0.0;
  std::optional<double> range_m;
  Polarity polarity = Polarity::checkerboard;
};

/// Centres and half-sizes of the four zones of one facet, counter-clockwise from the right (or upper right) one.
struct Quad {
  std::array<Vec2, 4> centres;
  std::array<Vec2, 4> corner_offsets;  ///< from a zone's centre
};

Quad diamond(const Vec2& facet, double half_spacing_m, double half_diagonal_m) {
  Quad quad;
  const std::array<Vec2, 4> axes{Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1)};
  for (std::size_t i = 0; i < 4; ++i) {
    quad.centres[i] = facet + axes[i] * half_spacing_m;
    quad.corner_offsets[i] = axes[i] * half_diagonal_m;
  }
  return quad;
}
Quad square(const Vec2& facet, double pitch_m, double side_m) {
  Quad quad;
  const std::array<Vec2, 4> diagonals{Vec2(1, 1), Vec2(-1, 1), Vec2(-1, -1), Vec2(1, -1)};
  for (std::size_t i = 0; i < 4; ++i) {
    quad.centres[i] = facet + diagonals[i] * (0.5 * pitch_m);
    quad.corner_offsets[i] = diagonals[i] * (0.5 * side_m);
  }
  return quad;
}

/// Index of the zone that lies farthest from the lens axis; none if two do.
std::optional<std::size_t> outermost(const Quad& quad) {
  const auto off_axis_m = [&](std::size_t zone) { return glm::length(quad.centres[zone]); };
  std::array<std::size_t, 4> zones{0, 1, 2, 3};
  std::ranges::sort(zones, std::greater{}, off_axis_m);
  constexpr double equal = 1e-9;
  if (off_axis_m(zones[0]) - off_axis_m(zones[1]) <= equal * off_axis_m(zones[0])) return std::nullopt;
  return zones[0];
}

std::vector<ZoneSpec> zones_of(const Quad& quad, Polarity polarity, Missing missing) {
  std::vector<ZoneSpec> zones;
  for (std::size_t i = 0; i < 4; ++i) {
    if (missing == Missing::outer && i == outermost(quad)) continue;
    ZoneSpec zone;
    for (std::size_t k = 0; k < 4; ++k) zone.corners[k] = quad.centres[i] + quad.corner_offsets[k];
    zone.polarity = polarity == Polarity::checkerboard && i % 2 == 1 ? -1 : 1;
    zones.push_back(zone);
  }
  return zones;
}

/// What facets and clusters share; the sensor may say a range for all.
void read_cluster_numbers(YamlMap& map, const std::optional<double>& range_m, ClusterSpec& cluster) {
  if (range_m) {
    cluster.range_m = *range_m;
  } else {
    map.require("range_m");
  }
  read_numbers(map, cluster);
}

void check_corners(const ClusterSpec& cluster, const std::string& what, const Where& where, Diagnostics& faults) {
  if (faults.has_errors()) return;
  for (const ZoneSpec& zone : cluster.zones) {
    const std::string fault = corners_fault(zone);
    if (!fault.empty()) faults.error(where, what + ": the corners of its zones: " + fault);
  }
}

ClusterSpec read_facet(const YamlNode& node, const FacetLaw& law, Diagnostics& faults) {
  YamlMap map(node, faults, "facet");
  ClusterSpec cluster;
  cluster.centre = {map.required_number("x_m", accepted::on_lens_plane_m),
                    map.required_number("y_m", accepted::on_lens_plane_m)};
  read_cluster_numbers(map, law.range_m, cluster);
  const auto missing =
      map.choice<Missing>("missing", Missing::none, {{"none", Missing::none}, {"outer", Missing::outer}});
  Quad quad;
  if (law.layout == Layout::diamond) {
    const double distance = std::sqrt(glm::dot(cluster.centre, cluster.centre) + law.plane_m * law.plane_m);
    quad = diamond(cluster.centre, law.half_spacing_ratio * distance, law.half_diagonal_ratio * distance);
  } else {
    const double side = map.required_number("zone_side_m", length_m);
    quad = square(cluster.centre, map.optional_number("pitch_m", length_m).value_or(pitch_to_side * side), side);
  }
  if (missing == Missing::outer && !outermost(quad)) {
    faults.error(map.where("missing"),
                 "facet: missing: no single zone is the outermost: two are equally far off the axis");
  }
  cluster.zones = zones_of(quad, law.polarity, missing);
  check_corners(cluster, "facet", node.where(), faults);
  map.finish();
  return cluster;
}

ZoneSpec read_zone(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "zone");
  ZoneSpec zone;
  const std::vector<YamlNode> corners = map.required_list("corners_m");
  zone.polarity = map.choice<int>("polarity", 1, {{"1", 1}, {"-1", -1}});
  map.finish();
  if (!map.has("corners_m")) return zone;
  if (corners.size() != zone.corners.size()) {
    faults.error(map.where("corners_m"), "zone: corners_m: expected 4 corners, got " + std::to_string(corners.size()));
    return zone;
  }
  const std::size_t faults_before = faults.issues().size();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::vector<double> xy = read_numbers(corners[i], faults, "zone: corner", accepted::on_lens_plane_m);
    if (xy.size() == 2) {
      zone.corners[i] = {xy[0], xy[1]};
    } else if (corners[i].is_list()) {
      faults.error(corners[i].where(), "zone: corner: expected [x, y]");
    }
  }
  const std::string fault = corners_fault(zone);
  if (faults.issues().size() == faults_before && !fault.empty()) {
    faults.error(map.where("corners_m"), "zone: corners_m: " + fault);
  }
  return zone;
}

ClusterSpec read_cluster(const YamlNode& node, const std::optional<double>& range_m, Diagnostics& faults) {
  YamlMap map(node, faults, "cluster");
  ClusterSpec cluster;
  read_cluster_numbers(map, range_m, cluster);
  double corner_count = 0.0;
  for (const YamlNode& zone : map.required_list("zones")) {
    cluster.zones.push_back(read_zone(zone, faults));
    for (const Vec2& corner : cluster.zones.back().corners) cluster.centre += corner;
    corner_count += 4.0;
  }
  if (corner_count > 0.0) cluster.centre /= corner_count;
  map.finish();
  return cluster;
}

constexpr const char* round_its_axis =
    "; the 360 degrees of a ceiling detector go round its axis: 12 m in diameter at 2.5 m are `wide_deg: 135`, from "
    "edge "
    "to edge";

std::vector<ClusterSpec> read_dome(YamlMap& sensor, double plane_m, double range_m) {
  DomeSpec dome;
  const YamlNode node = *sensor.child("dome");
  Diagnostics found;
  YamlMap map(node, found, "dome");
  read_fields(map, dome);
  map.finish();
  for (const Issue& issue : found.issues()) {
    const auto is_at = [&](const char* key) { return map.has(key) && map.where(key) == issue.where; };
    sensor.faults().error(issue.where, issue.message + (is_at("wide_deg") || is_at("tall_deg") ? round_its_axis : ""));
  }
  if (sensor.faults().has_errors()) return {};
  std::vector<ClusterSpec> clusters = clusters_of(dome, plane_m, range_m);
  for (const ClusterSpec& cluster : clusters) check_corners(cluster, "dome", node.where(), sensor.faults());
  return clusters;
}

template <typename Spec>
void add_keys(std::vector<std::string>& keys) {
  each_field<Spec>([&](const auto& field) { keys.emplace_back(field.name); });
}

const std::vector<std::string>& sourced_keys() {
  static const std::vector<std::string> keys = [] {
    std::vector<std::string> all{"plane_m",
                                 "half_spacing_ratio",
                                 "half_diagonal_ratio",
                                 "range_m",
                                 "lens_step",
                                 "polarity",
                                 "x_m",
                                 "y_m",
                                 "zone_side_m",
                                 "pitch_m",
                                 "missing",
                                 "corners_m"};
    all.emplace_back("idle_share");
    add_keys<ArraySpec>(all);
    add_keys<DomeSpec>(all);
    add_keys<OpticsSpec>(all);
    add_keys<SensitivitySpec>(all);
    each_field<RatedTargetSpec>([&](const auto& field) {
      if (field.name != std::string_view("lens_step")) all.emplace_back(field.name);
    });
    const std::vector<std::string> detector = sourced_detector_keys();
    all.insert(all.end(), detector.begin(), detector.end());
    return all;
  }();
  return keys;
}

/// Adds the names of all keys in a tree that stand for a number with a source.
void collect_sourced_keys(const YamlNode& node, std::vector<YamlKey>& found) {
  const std::vector<YamlKey> keys = node.keys();
  const std::vector<YamlNode> items = node.items();
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i < keys.size()) {
      const std::string& name = keys[i].name;
      if (name == "sources") continue;
      const auto same = [&](const YamlKey& key) { return key.name == name; };
      const bool sourced = std::find(sourced_keys().begin(), sourced_keys().end(), name) != sourced_keys().end() &&
                           !(name == "zones" && items[i].is_list());  // a cluster's, not how many a target crosses
      if (sourced && std::none_of(found.begin(), found.end(), same)) found.push_back(keys[i]);
    }
    collect_sourced_keys(items[i], found);
  }
}

/// Every number in the file has to say where it comes from.
void check_sources(YamlMap& map, const YamlNode& root) {
  Diagnostics& faults = map.faults();
  YamlMap sources(map.required_child("sources"), faults, "sources");
  for (const std::string& name : sourced_keys()) {
    const std::string text = sources.prose(name, "assumed:");
    const std::string tag = text.substr(0, text.find(':'));
    if (tag != "quoted" && tag != "measured" && tag != "inferred" && tag != "fitted" && tag != "assumed") {
      faults.error(
          sources.where(name),
          "sources: " + name + ": expected 'quoted:', 'measured:', 'inferred:', 'fitted:' or 'assumed:' in front");
    }
  }
  sources.finish();
  if (!map.has("sources")) return;
  std::vector<YamlKey> used;
  collect_sourced_keys(root, used);
  const std::vector<YamlKey> given = map.required_child("sources").keys();
  for (const YamlKey& key : used) {
    const bool is_misspelt = std::ranges::any_of(given, [&](const YamlKey& source) {  // which is told already
      return std::ranges::find(sourced_keys(), source.name) == sourced_keys().end() &&
             did_you_mean(source.name, sourced_keys()) == did_you_mean(source.name, {key.name});
    });
    if (!sources.has(key.name) && !is_misspelt)
      faults.error(key.where, "'" + key.name + "' has no entry under 'sources'");
  }
}

std::vector<RatedTargetSpec> read_targets(YamlMap& sensor) {
  std::vector<RatedTargetSpec> targets;
  for (const YamlNode& node : sensor.list("targets")) {
    YamlMap map(node, sensor.faults(), "target");
    read_fields(map, targets.emplace_back());
    map.finish();
  }
  return targets;
}

/// Its element, amplifier, comparator and reports; what isn't there keeps its default.
DetectorSpec read_detector(YamlMap& sensor) {
  DetectorSpec detector;
  read_part(sensor, "element", detector.element);
  read_part(sensor, "amplifier", detector.amplifier,
            [&](YamlMap& map) { check_together(detector.amplifier, faults_of(map, "amplifier")); });
  read_part(sensor, "comparator", detector.comparator, [&](YamlMap& map) {
    check_together(detector.comparator, faults_of(map, "comparator"));
    each_field<ReportSpec>([&](const auto& field) {
      if (map.child(field.name))
        map.faults().error(map.where(field.name),
                           "comparator: '" + std::string(field.name) + "' stands under 'report' beside 'comparator'");
    });
  });
  read_part(sensor, "report", detector.report);
  // A signal that saturates before a threshold would never be noticed.
  check_together(detector, faults_of(sensor, "comparator"));
  return detector;
}

FacetLaw read_law(YamlMap& map, double plane_m, const std::optional<double>& range_m) {
  FacetLaw law;
  law.plane_m = plane_m;
  law.range_m = range_m;
  if (!map.has("layout")) {
    map.faults().error(map.where(), "sensor: 'layout' is missing");
    for (const char* key : {"half_spacing_ratio", "half_diagonal_ratio"}) static_cast<void>(map.child(key));
  }
  law.layout = map.choice<Layout>("layout", Layout::square, {{"diamond", Layout::diamond}, {"square", Layout::square}});
  if (law.layout == Layout::diamond) {
    law.half_spacing_ratio = map.required_number("half_spacing_ratio", {.above = 0.0, .max = 1.0});
    law.half_diagonal_ratio = map.required_number("half_diagonal_ratio", {.above = 0.0, .max = 1.0});
  }
  law.polarity = map.choice<Polarity>("polarity", Polarity::checkerboard,
                                      {{"checkerboard", Polarity::checkerboard}, {"same", Polarity::same}});
  return law;
}

/// Is a key of the file meant for range_m? Then each facet would tell that it is missing.
bool misspells_range(const YamlNode& root) {
  const std::vector<std::string> known{"id",
                                       "description",
                                       "plane_m",
                                       "range_m",
                                       "response",
                                       "targets",
                                       "sensitivity",
                                       "optics",
                                       "facets",
                                       "clusters",
                                       "dome",
                                       "names",
                                       "report",
                                       "layout",
                                       "polarity",
                                       "sources",
                                       "half_spacing_ratio",
                                       "half_diagonal_ratio"};
  const std::vector<YamlKey> keys = root.keys();
  return std::ranges::any_of(keys, [&](const YamlKey& key) {
    return std::ranges::find(known, key.name) == known.end() &&
           did_you_mean(key.name, known) == did_you_mean("range_m", {"range_m"});
  });
}

enum class Kind { pir, array, beam };

void read_array(YamlMap& map, SensorModelSpec& model) {
  model.names = map.texts("names");
  for (const char* key : {"rows", "columns", "wide_deg", "tall_deg", "rate_hz", "netd_k"}) map.require(key);
  ArraySpec& array = model.array.emplace();
  read_fields(map, array);
  check_together(array, faults_of(map, "array"));
}

/// A beam's zones are its own; nothing of a PIR sensor's electronics is behind them.
void check_kind(YamlMap& map, Kind kind) {
  if (kind == Kind::pir && map.has("idle_share"))
    map.faults().error(map.where("idle_share"), "sensor: 'idle_share' is of kind: beam");
  if (kind != Kind::beam) return;
  for (const char* key :
       {"response", "targets", "sensitivity", "optics", "element", "amplifier", "comparator", "report"}) {
    if (map.has(key))
      map.faults().error(map.where(key), "sensor: '" + std::string(key) + "' is of PIR sensors, and this is a beam");
  }
}

SensorModelSpec read_model(const YamlNode& root) {
  Diagnostics faults;
  YamlMap map(root, faults, "sensor");
  SensorModelSpec model;
  model.id = map.required_text("id");
  model.description = map.prose("description");
  const Kind kind =
      map.choice<Kind>("kind", Kind::pir, {{"pir", Kind::pir}, {"array", Kind::array}, {"beam", Kind::beam}});
  if (kind == Kind::array) {
    read_array(map, model);
    check_sources(map, root);
    map.finish();
    faults.throw_if_errors();
    return model;
  }
  check_kind(map, kind);
  if (!map.has("dome")) map.require("plane_m");
  read_fields(map, model);
  if (kind == Kind::beam) {
    model.response = Response::beam;
  } else if (model.response == Response::beam) {
    faults.error(map.where("response"), "sensor: response: expected zones or analog; a beam says kind: beam");
  }
  std::optional<double> range_m =  // of all facets or clusters that don't say their own
      map.optional_number("range_m", field_of<&ClusterSpec::range_m>().range);
  if (!range_m && misspells_range(root)) range_m = 1.0;  // the file is refused for that key
  model.targets = read_targets(map);
  read_part(map, "sensitivity", model.sensitivity);
  read_part(map, "optics", model.optics);
  model.detector = read_detector(map);
  const std::array ways{"facets", "clusters", "dome"};
  if (std::ranges::count_if(ways, [&](const char* way) { return map.has(way); }) != 1)
    faults.error(map.where(), "sensor: expected one of 'facets', 'clusters' and 'dome'");
  if (map.has("dome")) {
    if (!range_m) map.require("range_m");
    model.clusters = read_dome(map, model.plane_m, range_m.value_or(1.0));
  } else if (map.has("clusters")) {
    for (const YamlNode& node : map.required_list("clusters"))
      model.clusters.push_back(read_cluster(node, range_m, faults));
  } else if (map.has("facets")) {
    const FacetLaw law = read_law(map, model.plane_m, range_m);
    const std::vector<YamlNode> facets = map.required_list("facets");
    for (const YamlNode& node : map.has("layout") ? facets : std::vector<YamlNode>{})  // which says what facets need
      model.clusters.push_back(read_facet(node, law, faults));
  }
  if (map.has("targets")) check_together(model, faults_of(map, "targets"));
  check_sources(map, root);
  map.finish();
  faults.throw_if_errors();
  return model;
}

}  // namespace

std::vector<std::string> sourced_detector_keys() {
  std::vector<std::string> keys;
  add_keys<ElementSpec>(keys);
  add_keys<AmplifierSpec>(keys);
  add_keys<ComparatorSpec>(keys);
  add_keys<ReportSpec>(keys);
  return keys;
}

SensorModelSpec read_sensor_model(const std::filesystem::path& path) {
  return read_model(YamlNode::load(read_input(path)));
}

}  // namespace pirsim::io

namespace pirsim::io::detail {

namespace fs = std::filesystem;

SensorSearch::SensorSearch(const SceneOptions& options, const fs::path& scene_folder)
    : folders_(options.sensor_directories) {
  folders_.push_back(scene_folder / "sensors");
  folders_.push_back(scene_folder / ".." / "sensors");
  if (!options.marks.empty()) folders_.push_back(folder_of_input(options.marks) / "sensors");
  for (const fs::path& data : data_folders(options.data_directories)) folders_.push_back(data / "sensors");
}

std::optional<FoundSensor> SensorSearch::find(const std::string& model) const {
  for (const fs::path& folder : folders_) {
    std::error_code fault;
    const fs::path file = folder / (model + ".yaml");
    const fs::file_status status = fs::status(file, fault);
    const bool is_dangling = !fs::exists(status) && fs::is_symlink(file, fault);  // whose reader says so
    if (fs::is_directory(status) || (!fs::exists(status) && !is_dangling)) continue;
    const Input input = read_input(file);
    const YamlNode root = YamlNode::load(input);
    FoundSensor found{read_model(root), input.file(), {}};
    if (found.model.id != model) {
      Diagnostics remarks;
      remarks.warning(YamlMap(root, remarks, "sensor").where("id"),
                      "id '" + found.model.id + "' isn't the file's name: scenes name this model '" + model + "'");
      found.remarks = remarks.warnings();
    }
    return found;
  }
  for (const NamedText& shipped : shipped_sensors()) {
    if (shipped.name == model) return FoundSensor{read_model(YamlNode::parse(shipped.text, model + ".yaml")), {}, {}};
  }
  return std::nullopt;
}

std::vector<std::string> SensorSearch::names() const {
  std::set<std::string> names;
  for (const NamedText& shipped : shipped_sensors()) names.emplace(shipped.name);
  for (const fs::path& folder : folders_) {
    std::error_code fault;
    for (fs::directory_iterator entry(folder, fault), end; !fault && entry != end; entry.increment(fault)) {
      if (entry->path().extension() == ".yaml") names.insert(entry->path().stem().string());
    }
  }
  return {names.begin(), names.end()};
}

std::string SensorSearch::carrier(const std::string& product) const {
  for (const std::string& name : names()) {
    try {
      const std::optional<FoundSensor> found = find(name);
      const auto is_product = [&](const std::string& known) { return bare_name(known) == bare_name(product); };
      if (is_product(name) || (found && std::ranges::any_of(found->model.names, is_product))) return name;
    } catch (const Error&) {
      continue;  // a file's faults are told to those who ask for it
    }
  }
  return {};
}

std::string SensorSearch::unknown(const std::string& model) const {
  const auto told = [](const fs::path& folder) { return "'" + folder.lexically_normal().string() + "'"; };
  const std::string known = carrier(model);
  if (!known.empty()) return "sensor model '" + model + "' is called '" + known + "' here";
  std::string searched;
  for (const fs::path& folder : folders_) {
    if (searched.find(told(folder)) == std::string::npos) searched += (searched.empty() ? "" : ", ") + told(folder);
  }
  return "sensor model '" + model + "' is not known" + near_or_all(model, names()) + "; looked for '" + model +
         ".yaml' in " + searched + " and among the models that pirsim carries";
}

}  // namespace pirsim::io::detail

namespace pirsim::io {

SensorModelSpec find_sensor_model(const std::string& model, const std::filesystem::path& scene_file,
                                  const SceneOptions& options, const Where& named_at) {
  const detail::SensorSearch search(options, folder_of_input(scene_file));
  if (auto found = search.find(model)) return std::move(found->model);
  throw Error(ErrorCode::input, named_at, search.unknown(model));
}

}  // namespace pirsim::io
