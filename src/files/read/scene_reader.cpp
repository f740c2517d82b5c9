#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "files/read/gltf_geometry.hpp"
#include "files/read/marks_file.hpp"
#include "files/read/reader_parts.hpp"
#include "files/read/scene_parts.hpp"
#include "model/core/text.hpp"
#include "model/schema/checks.hpp"
#include "model/schema/limits.hpp"
#include "pirsim/io.hpp"

namespace pirsim::io {
namespace {

using namespace detail;

class SceneBuilder {
 public:
  SceneBuilder(const std::filesystem::path& file, const SceneOptions& options)
      : file_(file), options_(options), document_(load_gltf(file, remarks_)) {
    spec_.name = name_of_input(file);
    if (!options.marks.empty()) marks_file_ = read_marks_file(options.marks, warnings_);
  }

  SceneSpec build() {
    warn_of_what_is_left_out();
    temperatures_c_ = material_temperatures_c(document_, remarks_);
    const PlacedNodes nodes =
        place_nodes(document_, remarks_, marks_file_ ? marks_file_->room_from_model : glm::dmat4(1.0));
    if (marks_file_) marks_of_nodes_ = marks_of_nodes(*marks_file_, document_, nodes, remarks_, warnings_);
    for (const HiddenNode& hidden : nodes.hidden) tell_of_hidden(hidden);
    for (const PlacedNode& placed : nodes.shown) {
      read_mark(placed.node);
      if (too_many_faults()) break;
    }
    for (const PlacedNode& placed : nodes.shown) {
      add_node(placed);
      if (too_many_faults()) break;
    }
    add_placed();
    spec_.files = document_.files;
    if (marks_file_) spec_.files.push_back(marks_file_->file);
    spec_.floor = floor_.build();
    require_floor();
    if (!remarks_.has_errors()) check_among_each_other();
    if (!remarks_.has_errors()) warn_of_doubts();
    if (spec_.sensors.empty() && !remarks_.has_errors()) {
      remarks_.warning(document_.text.where(""), "the scene has no sensors");
    }
    read_sensor_models();
    if (!remarks_.has_errors()) move_arrays(spec_);
    warnings_.tell(remarks_);
    remarks_.throw_if_errors();
    spec_.warnings = remarks_.warnings();
    return std::move(spec_);
  }

 private:
  void warn_of_what_is_left_out() {
    const nlohmann::json& root = document_.text.root();
    if (root.contains("animations") && !root["animations"].empty()) {
      remarks_.warning(document_.text.where_key("/animations"), "animations are not played; nodes stay at rest");
    }
    if (root.contains("skins") && !root["skins"].empty()) {
      remarks_.warning(document_.text.where_key("/skins"), "skins are not posed; meshes stay at rest");
    }
    for (const char* collection : {"meshes", "scenes"}) {
      const auto array = root.find(collection);
      for (std::size_t i = 0; array != root.end() && i < array->size(); ++i) {
        const auto extras = (*array)[i].find("extras");
        if (extras == (*array)[i].end() || !extras->is_object() || !extras->contains("pirsim")) continue;
        const std::string name = label_in(collection, i);
        warnings_.add(
            "off nodes",
            document_.text.where("/" + std::string(collection) + '/' + std::to_string(i) + "/extras/pirsim"), name,
            "'pirsim' counts on nodes only; here, on " + name +
                ", it is not read: put it on the object's node (in Blender: the object's properties, not its data's)");
      }
    }
  }
  [[nodiscard]] std::string label_in(const std::string& collection, std::size_t i) const {
    return collection == "meshes" ? mesh_label(document_.model, static_cast<int>(i)) : "a scene";
  }
  void warn_of_doubts() {
    doubt(spec_, nodes_, [&](const Doubt& doubt) {
      warnings_.add(doubt.kind, place_of(doubt.node), doubt.name, label_of(doubt.node) + ": " + doubt.message);
    });
  }

  /// One warning for all; another for those whose marks go with them.
  void tell_of_hidden(const HiddenNode& hidden) {
    if (marks_of_nodes_.ignored.contains(hidden.node)) return;
    const auto own = hidden_mark(hidden.node);
    if (own && (own->doubts == Doubts::not_told || std::holds_alternative<mark::Ignore>(own->what))) return;
    std::string marks;
    const auto note_mark = [&](int node) {
      const auto mark = hidden_mark(node);
      if (!mark) return;
      if (std::holds_alternative<mark::Floor>(mark->what)) hidden_floor_ = node_label(document_.model, node);
      const std::string name = name_of_mark(mark->what);
      if (!name.empty()) marks += (marks.empty() ? "" : ", ") + name;
    };
    note_mark(hidden.node);
    std::ranges::for_each(hidden.below, note_mark);
    const std::string label = node_label(document_.model, hidden.node);
    const std::string what = label + " is hidden and left out";
    const std::string with = hidden.below.empty() ? "" : ", with all that is below it";
    if (marks.empty()) return warnings_.add("hidden", place_of(hidden.node), label, what + with);
    warnings_.add("hidden mark", place_of(hidden.node), marks, what + with + ": " + marks);
  }
  [[nodiscard]] std::optional<NodeMark> hidden_mark(int node) const {
    if (const auto beside = marks_of_nodes_.marks.find(node); beside != marks_of_nodes_.marks.end())
      return beside->second;
    Diagnostics unread;
    GroupedWarnings untold;
    return read_markup(document_, node, unread, untold);
  }
  static std::string name_of_mark(const Markup& markup) {
    const auto name = [](const char* type, const std::string& id) { return std::string(type) + " '" + id + "'"; };
    if (const auto* sensor = std::get_if<SensorSpec>(&markup)) return name("sensor", sensor->id);
    if (const auto* seat = std::get_if<SeatSpec>(&markup)) return name("seat", seat->id);
    if (const auto* place = std::get_if<PlaceSpec>(&markup)) return name("place", place->id);
    if (const auto* entrance = std::get_if<EntranceSpec>(&markup)) return name("entrance", entrance->id);
    if (const auto* area = std::get_if<mark::Area>(&markup)) return name("area", area->id);
    if (const auto* door = std::get_if<DoorSpec>(&markup)) return name("door", door->id);
    return std::holds_alternative<mark::Floor>(markup) ? "a floor" : "";
  }

  void read_mark(int node) {
    std::optional<NodeMark> mark = read_markup(document_, node, remarks_, warnings_);
    if (!mark) warn_of_near_marks(document_, node, warnings_);
    if (const auto beside = marks_of_nodes_.marks.find(node); beside != marks_of_nodes_.marks.end()) {
      if (mark) {
        remarks_.error(beside->second.place.where(""), beside->second.place.label + ": " + mark->place.label +
                                                           " has a mark of its own" + in_place(mark->place.where("")));
      }
      mark = beside->second;
      mark->place.label = node_label(document_.model, node);
    }
    if (mark) keep(node, *std::move(mark));
  }
  void keep(int bearer, NodeMark mark) {
    if (mark.doubts == Doubts::not_told) {
      nodes_.as_meant.insert(bearer);
      if (is_node(bearer)) meshes_as_meant_.insert(mesh_of(bearer));
    }
    marks_.emplace(bearer, std::move(mark));
  }

  void add_node(const PlacedNode& placed) {
    const auto known = marks_.find(placed.node);
    const Markup* markup = known == marks_.end() ? nullptr : &known->second.what;
    if (markup && std::holds_alternative<mark::Ignore>(*markup)) return;
    const int mesh = mesh_of(placed.node);
    if (const auto ignored = marks_of_nodes_.ignored.find(placed.node); ignored != marks_of_nodes_.ignored.end()) {
      if (markup && is_about_mesh(*markup)) tell_of_both(known->second, ignored->second);
    } else if (mesh >= 0) {
      add_mesh(placed, mesh, markup);
    }
    if (markup) add_mark(placed, *markup);
  }
  static bool is_about_mesh(const Markup& markup) {
    const auto* outline = outlined(&markup);
    return (outline && !outline->polygon) || std::holds_alternative<mark::Surface>(markup);
  }
  void tell_of_both(const NodeMark& mark, const NodePattern& ignored) {
    remarks_.error(ignored.where, "ignore: '" + shortened(ignored.text) + "': " + mark.place.label +
                                      " has a mark that needs its mesh" + in_place(mark.place.where("")));
  }
  void add_mark(const PlacedNode& placed, const Markup& markup) {
    if (const auto* sensor = std::get_if<SensorSpec>(&markup)) add_sensor(placed, *sensor);
    if (const auto* seat = std::get_if<SeatSpec>(&markup)) {
      add_upright(placed, *seat, &SeatSpec::world_from_seat, "seat", "seats", limits::seats, spec_.seats, nodes_.seats);
    }
    if (const auto* place = std::get_if<PlaceSpec>(&markup)) {  // a seat is a place, and scripts name either
      add_upright(placed, *place, &PlaceSpec::world_from_place, "seat", "places", limits::places, spec_.places,
                  nodes_.places);
    }
    if (const auto* entrance = std::get_if<EntranceSpec>(&markup)) {
      add_upright(placed, *entrance, &EntranceSpec::world_from_entrance, "entrance", "entrances", limits::entrances,
                  spec_.entrances, nodes_.entrances);
    }
    if (const auto* door = std::get_if<DoorSpec>(&markup)) {
      add_upright(placed, *door, &DoorSpec::world_from_door, "door", "doors", limits::doors, spec_.doors, nodes_.doors);
    }
    if (const auto* outline = outlined(&markup)) add_outlined(placed, *outline, markup);
  }
  /// What the marks file places in the room.
  void add_placed() {
    if (!marks_file_) return;
    int bearer = static_cast<int>(document_.model.nodes.size());
    for (MarksFile::Placed& placed : marks_file_->placed) {
      const Markup markup = placed.mark.what;
      keep(bearer, std::move(placed.mark));
      add_mark({bearer++, placed.world_from_mark}, markup);
      if (too_many_faults()) break;
    }
  }

  void add_mesh(const PlacedNode& placed, int mesh, const Markup* markup) {
    const mark::Outlined* outline = outlined(markup);
    const auto* surface = std::get_if<mark::Surface>(markup);
    const auto temperature_c = surface ? surface->temperature_c : std::nullopt;
    const auto [known, is_first] = meshes_.try_emplace(mesh);
    GroupedWarnings untold;
    GroupedWarnings& warnings = meshes_as_meant_.contains(mesh) ? untold : warnings_;
    if (is_first) known->second = read_mesh_parts(document_, mesh, temperatures_c_, budget_, remarks_, warnings);
    const TriMesh whole = joined(known->second);
    if (whole.triangles.empty()) {
      if (outline && !outline->polygon && std::holds_alternative<mark::Area>(*markup))
        node_error(placed.node, "/mesh", "its mesh has no triangles, so the area has no outline");
      return;
    }
    if (!is_first && !budget_.take(whole.positions.size() + whole.triangles.size()))
      return node_error(placed.node, "/mesh", "the copies of its mesh make the scene too large");
    const TriMesh world = transformed(whole, placed.world_from_node, node_name(document_.model, placed.node));
    if (const auto far = std::ranges::find_if_not(world.positions, is_in_world); far != world.positions.end()) {
      const Vec3 origin = marks_file_ ? -Vec3(marks_file_->room_from_model[3]) : Vec3(0.0);
      return node_error(placed.node, "/mesh",
                        "its mesh reaches more than 100 km from the origin" + brought_here(origin + *far));
    }
    CleanMesh cleaned = clean(world);
    if (is_first) warn_of_audit(cleaned.audit, placed.node, mesh, warnings);
    if (outline && !outline->polygon) {
      const MarkPlace& place = mark_of(placed);
      add_outline(outlines_of(*markup).of_mesh(cleaned.mesh, place.where(""), place.label), *markup, placed.node);
    }
    if (outline && outline->occludes == mark::Occludes::no) return;
    if (temperature_c) cleaned.mesh.temperature_c = temperature_c;
    nodes_.meshes.resize(spec_.meshes.size() + (temperature_c ? 1 : known->second.size()), placed.node);
    if (temperature_c || known->second.size() == 1) {
      spec_.meshes.push_back(std::move(cleaned.mesh));
    } else {
      for (const TriMesh& part : known->second) {
        spec_.meshes.push_back(clean(transformed(part, placed.world_from_node, world.name)).mesh);
      }
    }
  }

  void warn_of_audit(const MeshAudit& audit, int node, int mesh, GroupedWarnings& warnings) {
    const auto warn = [&](std::size_t n, const char* what) {
      if (n == 0) return;
      const std::string label = mesh_label(document_.model, mesh);
      warnings.add(what, document_.text.where("/meshes/" + std::to_string(mesh)), label,
                   label + " (" + node_label(document_.model, node) + "): " + std::to_string(n) +
                       (n == 1 ? " triangle " : " triangles ") + what);
    };
    warn(audit.degenerate_triangles, "without area, dropped");
    warn(audit.duplicate_triangles, "given twice, dropped");
    warn(audit.non_manifold_triangles, "not manifold (an edge or corner shared by too many); kept as occluders");
  }

  void add_sensor(const PlacedNode& placed, SensorSpec sensor) {
    if (!has_room(spec_.sensors.size(), limits::sensors, "sensors")) return;
    check_unique("sensor", sensor.id, placed.node);
    const std::string fault = column_fault(sensor.id);
    if (!fault.empty()) mark_error(placed.node, "/id", fault);
    model_places_.try_emplace(sensor.model, mark_of(placed).where("/model"));
    nodes_.sensors.push_back(placed.node);
    sensor.world_from_sensor = rigid_frame(placed.world_from_node);
    spec_.sensors.push_back(std::move(sensor));
  }
  /// What stands at its node. type: of its id; plural: for messages.
  template <typename Spec>
  void add_upright(const PlacedNode& placed, Spec spec, Frame Spec::*frame, const char* type, const char* plural,
                   std::size_t most, std::vector<Spec>& all, std::vector<int>& bearers) {
    if (!has_room(all.size(), most, plural)) return;
    check_unique(type, spec.id, placed.node);
    bearers.push_back(placed.node);
    spec.*frame = upright_frame(placed);
    all.push_back(std::move(spec));
  }
  /// Counts it; its mesh, if it has no polygon, is added with the others.
  void add_outlined(const PlacedNode& placed, const mark::Outlined& outline, const Markup& markup) {
    const bool is_floor = std::holds_alternative<mark::Floor>(markup);
    if (is_floor ? !has_room(n_floors_++, limits::floors, "floors") : !has_room(n_areas_++, limits::areas, "areas"))
      return;
    if (is_floor) nodes_.floor = placed.node;
    if (!outline.polygon) return;
    std::vector<Vec3> corners;
    for (const Vec2& p : *outline.polygon)
      corners.emplace_back(placed.world_from_node * glm::dvec4(p.x, 0.0, p.y, 1.0));
    const MarkPlace& place = mark_of(placed);
    add_outline(outlines_of(markup).of_polygon(corners, place.where("/polygon_xz_m"), place.label), markup,
                placed.node);
  }
  OutlineReader& outlines_of(const Markup& markup) {
    return std::holds_alternative<mark::Floor>(markup) ? floor_outlines_ : area_outlines_;
  }
  /// outline: none if it is faulty, which is told.
  void add_outline(std::optional<FloorArea> outline, const Markup& markup, int bearer) {
    if (const auto* area = std::get_if<mark::Area>(&markup)) check_unique("area", area->id, bearer);
    if (!outline) return;
    const MarkPlace& place = marks_.at(bearer).place;
    if (std::holds_alternative<mark::Floor>(markup))
      return floor_.add(*std::move(outline), place.where(outlined(&markup)->polygon ? "/polygon_xz_m" : ""),
                        place.label);
    spec_.areas.push_back({std::get<mark::Area>(markup).id, *std::move(outline)});
    nodes_.areas.push_back(bearer);
  }
  /// Of areas, once all sensors are known.
  void check_among_each_other() {
    for (std::size_t i = 0; i < spec_.areas.size(); ++i) {
      const std::string fault = area_id_fault(spec_.areas[i].id);
      if (!fault.empty()) mark_error(nodes_.areas[i], "/id", fault);
    }
    check_together(spec_.areas, spec_.floor,
                   [&](std::size_t area, const std::string& message) { mark_error(nodes_.areas[area], "", message); });
    for (std::size_t i = 0; i < spec_.sensors.size(); ++i) {
      const std::string fault = area_fault(spec_.sensors[i], spec_.areas);
      if (!fault.empty()) mark_error(nodes_.sensors[i], "/area", fault);
    }
  }

  /// So many are there already. A fault if the scene can't have one more.
  bool has_room(std::size_t n, std::size_t most, const char* what) {
    if (n < most) return true;
    remarks_.error({file_.string()}, "the scene has " + too_many(most, what));
    return false;
  }

  Frame upright_frame(const PlacedNode& placed) {
    const Frame frame = rigid_frame(placed.world_from_node);
    if (!is_upright(frame)) {
      constexpr double flat = 0.0038;  // of the upward axis: within a quarter of a degree of level
      remarks_.error(mark_of(placed).where(""),
                     mark_of(placed).label + ": must stand upright (its +Y up)" +
                         (std::abs(frame.up().y) < flat ? "; it lies: is the file Z-up?" : ""));
    }
    return frame;
  }

  void check_unique(const std::string& type, const std::string& id, int bearer) {
    const auto [first, is_new] = ids_.try_emplace({type, id}, bearer);
    if (is_new) return;
    const MarkPlace& other = marks_.at(first->second).place;
    mark_error(
        bearer, "/id",
        type + " id '" + id + "' is taken by " + other.label + (marks_file_ ? in_place(other.where("/id")) : ""));
  }

  void require_floor() {
    if (!spec_.floor.empty() || remarks_.has_errors()) return;
    if (!hidden_floor_.empty()) {
      return remarks_.error(document_.text.where("/nodes"),
                            "the scene has no floor area: " + hidden_floor_ + ", a floor, is hidden and left out");
    }
    remarks_.error(document_.text.where("/nodes"),
                   "the scene has no floor area; give the floor's node extras {\"pirsim\": {\"type\": \"floor\"}}");
  }

  void read_sensor_models() {
    const SensorSearch search(options_, folder_of_input(file_));
    for (const auto& [model, where] : model_places_) {
      try {
        auto found = search.find(model);
        if (!found) {
          remarks_.error(where, search.unknown(model));
          continue;
        }
        for (const Issue& remark : found->remarks)
          warnings_.add("sensor id", remark.where, "model '" + model + "'", remark.message);
        spec_.sensor_models.emplace(model, std::move(found->model));
        if (found->file) spec_.files.push_back(*found->file);
      } catch (const Error& fault) {
        for (const Issue& issue : fault.issues()) remarks_.error(issue.where, issue.message);
      }
    }
  }

  /// A faulty exporter makes thousands, each of which is looked for in the text.
  [[nodiscard]] bool too_many_faults() const {
    const auto is_error = [](const Issue& issue) { return issue.severity == Severity::error; };
    return remarks_.has_errors() && std::count_if(remarks_.issues().begin(), remarks_.issues().end(), is_error) >= 20;
  }

  [[nodiscard]] bool is_node(int bearer) const { return bearer < static_cast<int>(document_.model.nodes.size()); }
  [[nodiscard]] int mesh_of(int node) const { return document_.model.nodes[static_cast<std::size_t>(node)].mesh; }
  [[nodiscard]] Where place_of(int bearer) const {
    return is_node(bearer) ? document_.text.where("/nodes/" + std::to_string(bearer))
                           : marks_.at(bearer).place.where("");
  }
  [[nodiscard]] std::string label_of(int bearer) const {
    return is_node(bearer) ? node_label(document_.model, bearer) : marks_.at(bearer).place.label;
  }
  [[nodiscard]] const MarkPlace& mark_of(const PlacedNode& placed) const { return marks_.at(placed.node).place; }
  void mark_error(int bearer, const std::string& member, const std::string& message) {
    const MarkPlace& mark = marks_.at(bearer).place;
    remarks_.error(mark.where(member), mark.label + ": " + message);
  }
  void node_error(int node, const std::string& member, const std::string& message) {
    remarks_.error(document_.text.where("/nodes/" + std::to_string(node) + member),
                   node_label(document_.model, node) + ": " + message);
  }

  std::filesystem::path file_;
  const SceneOptions& options_;
  Diagnostics remarks_;
  GroupedWarnings warnings_;
  GltfDocument document_;
  GeometryBudget budget_;
  OutlineReader floor_outlines_{"floor", remarks_}, area_outlines_{"area", remarks_};
  FloorBuilder floor_{remarks_};
  SceneSpec spec_;
  MarkedNodes nodes_;
  std::optional<MarksFile> marks_file_;
  MarksOfNodes marks_of_nodes_;    ///< of the marks file
  std::map<int, NodeMark> marks_;  ///< by bearer: nodes by their index, then what the marks file places
  std::set<int> meshes_as_meant_;  ///< of a node that says so
  std::string hidden_floor_;       ///< its node, as messages name it
  std::size_t n_floors_ = 0, n_areas_ = 0;
  std::vector<std::optional<double>> temperatures_c_;       ///< (n_materials)
  std::map<int, std::vector<TriMesh>> meshes_;              ///< in their own frames, by index, in equally warm parts
  std::map<std::string, Where> model_places_;               ///< where each sensor model is first named
  std::map<std::pair<std::string, std::string>, int> ids_;  ///< (type, id) to bearer
};

}  // namespace

SceneSpec read_scene(const std::filesystem::path& file, const SceneOptions& options) {
  return SceneBuilder(file, options).build();
}

}  // namespace pirsim::io

namespace pirsim::io::detail {
namespace {

constexpr double flatness_m = 0.01;  // assumed: less than any step one could trip over

using Loop = std::vector<Vec2>;

/// Whether the floor just beside an edge of the first, on its inner side, also belongs to the second.
bool edge_runs_inside(const FloorArea& own, const FloorArea& other) {
  for (const Loop& loop : own.loops()) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec2 a = loop[i], along = loop[(i + 1) % loop.size()] - a;
      const Vec2 aside = Vec2(-along.y, along.x) * 1e-6;
      for (const Vec2& beside : {a + 0.5 * along + aside, a + 0.5 * along - aside}) {
        if (own.contains(beside) && other.contains(beside)) return true;
      }
    }
  }
  return false;
}

bool boxes_meet(const FloorArea& a, const FloorArea& b) {
  return a.lower().x < b.upper().x && b.lower().x < a.upper().x && a.lower().y < b.upper().y &&
         b.lower().y < a.upper().y;
}

/// Floors may touch, but an overlap would count as no floor by the even-odd rule.
bool overlap(const FloorArea& first, const FloorArea& second) {
  if (!boxes_meet(first, second)) return false;
  for (const Loop& a : first.loops()) {
    for (const Loop& b : second.loops()) {
      if (outlines_cross(a, b)) return true;
    }
  }
  return edge_runs_inside(first, second) || edge_runs_inside(second, first);
}

}  // namespace

bool OutlineReader::flat(const std::vector<Vec3>& points, const Where& where, const std::string& label) {
  const auto [lowest, highest] =
      std::minmax_element(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) { return a.y < b.y; });
  if (highest->y - lowest->y <= flatness_m) return true;
  const auto spans = [&](auto member) {
    const auto [least, most] = std::minmax_element(points.begin(), points.end(),
                                                   [&](const Vec3& a, const Vec3& b) { return a.*member < b.*member; });
    return (*most).*member - (*least).*member;
  };
  const bool upright = std::min(spans(&Vec3::x), spans(&Vec3::z)) <= flatness_m;
  faults_.error(where, label + (what_ == "area" ? ": an area" : ": a floor") + " must be flat and level; this one " +
                           (upright ? "stands upright, as in files that are Z-up (glTF's +Y is up), and " : "") +
                           "rises by " + std::to_string(highest->y - lowest->y) + " m");
  return false;
}

std::optional<FloorArea> OutlineReader::of_mesh(const TriMesh& mesh, const Where& where, const std::string& label) {
  if (mesh.positions.empty()) {
    faults_.error(where, label + ": its mesh has no triangles, so it has no floor area");
    return std::nullopt;
  }
  if (!flat(mesh.positions, where, label)) return std::nullopt;
  try {
    return checked({boundary_loops_xz(mesh), mesh.positions.front().y}, where, label);
  } catch (const Error& fault) {
    faults_.error(where, label + ": " + fault.issues().front().message);
    return std::nullopt;
  }
}

std::optional<FloorArea> OutlineReader::of_polygon(const std::vector<Vec3>& corners, const Where& where,
                                                   const std::string& label) {
  if (!flat(corners, where, label)) return std::nullopt;
  Loop loop;
  for (const Vec3& corner : corners) loop.push_back(floor_point(corner));
  return checked({{std::move(loop)}, corners.front().y}, where, label);
}

std::optional<FloorArea> OutlineReader::checked(FloorArea area, const Where& where, const std::string& label) {
  for (const Loop& loop : area.loops()) n_corners_ += loop.size();
  const std::string fault = n_corners_ > limits::floor_corners ? too_many_corners(what_) : outline_fault(area, what_);
  if (fault.empty()) return area;
  faults_.error(where, label + ": " + fault);
  return std::nullopt;
}

void FloorBuilder::add(FloorArea part, const Where& where, const std::string& label) {
  parts_.push_back({std::move(part), where, label});
}

FloorArea FloorBuilder::build() {
  std::vector<Loop> loops;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    if (std::abs(part.area.height_m() - parts_.front().area.height_m()) > flatness_m) {
      faults_.error(part.where, part.label + " and " + parts_.front().label + " are floors at different heights");
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (overlap(parts_[k].area, part.area)) {
        faults_.error(part.where, part.label + " overlaps the floor of " + parts_[k].label);
      }
    }
    loops.insert(loops.end(), part.area.loops().begin(), part.area.loops().end());
  }
  return {std::move(loops), parts_.empty() ? 0.0 : parts_.front().area.height_m()};
}

}  // namespace pirsim::io::detail
