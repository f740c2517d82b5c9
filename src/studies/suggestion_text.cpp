// A suggestion as a marks file.
#include <algorithm>
#include <sstream>

#include "core/text.hpp"
#include "io/read/scene_parts.hpp"
#include "studies/suggestion.hpp"

namespace pirsim::studies {
namespace {

/// As YAML takes it back; readers have refused names with line breaks.
std::string quoted(const std::string& name) {
  std::string text = "'";
  for (const char c : name) text += c == '\'' ? "''" : std::string(1, c);
  return text + "'";
}

/// To a centimetre, without a minus before a zero.
std::string centimetres(double value) {
  const std::string text = fixed(value, 2);
  return text == "-0.00" ? "0.00" : text;
}
std::string flat_point(const Vec2& p) { return "[" + centimetres(p.x) + ", " + centimetres(p.y) + "]"; }
std::string room_point(const Vec3& p) {
  return "[" + centimetres(p.x) + ", " + centimetres(p.y) + ", " + centimetres(p.z) + "]";
}
std::string polygon(const std::vector<Vec2>& corners) {
  std::vector<std::string> points;
  for (const Vec2& p : corners) points.push_back(flat_point(p));
  return "[" + joined(points, ", ") + "]";
}

class SuggestionWriter {
 public:
  SuggestionWriter(const Suggestion& suggestion, const std::string& model) : given_(suggestion), model_(model) {}

  std::string run() {
    out_ << "# A proposal for " << model_
         << ", made of its shapes and names by `pirsim check --suggest`: look at it, and\n"
         << "# edit it. Positions are in the room: metres, +Y up.\npirsim_marks: 1\n";
    frame();
    floors();
    areas();
    entrances();
    seats();
    ignored();
    out_ << "\n# Sensors aren't proposed. One in a corner, 2.3 m up, that looks into the room and 20 degrees down:\n"
            "# sensors:\n# - {id: PIR1, model: EKMC1604111, position_m: [0, "
         << centimetres(given_.floor_m + 2.3) << ", 0], yaw_deg: 225, tilt_deg: 20}\n";
    return out_.str();
  }

 private:
  void frame() {
    const SuggestedFrame& frame = given_.frame;
    if (frame.unit.empty()) {
      out_ << "scale: " << shortest_number(frame.metres)
           << "  # a guess: no unit makes a building of the model; so it is one storey high\n";
    } else {
      out_ << "unit: " << frame.unit << (frame.unit == "m" ? "\n" : "  # by the model's size\n");
    }
    out_ << "up: " << frame.up << (frame.up == 'y' ? "\n" : "  # by the model's size: along +Y it is no storey\n");
  }

  void floors() {
    out_ << "\nfloors:\n";
    for (const auto& outline : given_.floors) {
      out_ << "- {height_m: " << centimetres(given_.floor_m) << ", polygon_xz_m: " << polygon(outline) << "}\n";
    }
    if (given_.other_floors_m.empty()) return;
    std::vector<std::string> heights;
    for (const double height_m : given_.other_floors_m) heights.push_back(centimetres(height_m));
    out_ << "# Other floors were found at " << joined(heights, ", ") << " m; `--floor " << heights.front()
         << "` proposes marks for that one.\n";
  }

  void areas() {
    const std::vector<std::string> types = io::detail::mark_types();
    const bool are_marks = std::ranges::find(types, "area") != types.end();
    const char* begin = are_marks ? "" : "# ";
    out_ << '\n' << begin << "areas:\n";
    for (const SuggestedArea& area : given_.areas) {
      out_ << begin << "- {id: " << area.id << ", height_m: " << centimetres(given_.floor_m)
           << ", polygon_xz_m: " << polygon(area.outline) << "}  # " << fixed(area.square_metres, 1) << " m2"
           << (area.named_by.empty() ? "" : ", named after " + quoted(area.named_by)) << '\n';
    }
    for (const SuggestedGap& gap : given_.doors) {
      out_ << "# An opening between " << gap.from << " and " << gap.to << ", " << fixed(gap.width_m, 2)
           << " m wide, at " << flat_point(gap.at) << ".\n";
    }
  }

  void entrances() {
    if (given_.entrances.empty()) {
      out_ << "\n# No way in was found. People can `appear` in a script, or:\n# entrances:\n"
              "# - {id: entrance_1, position_m: [0, "
           << centimetres(given_.floor_m) << ", 0], direction: [0, 0, -1]}\n";
      return;
    }
    out_ << "\nentrances:\n";
    int n = 0;
    for (const SuggestedGap& gap : given_.entrances) {
      out_ << "- {id: entrance_" << ++n << ", position_m: " << room_point({gap.at.x, given_.floor_m, gap.at.y})
           << ", direction: " << room_point({gap.inwards.x, 0.0, gap.inwards.y})
           << ", width_m: " << fixed(gap.width_m, 2) << "}  # into " << gap.from
           << (given_.is_open ? ": a side without walls, since no door leads in" : "") << '\n';
    }
  }

  void seats() {
    if (!given_.seats.empty()) out_ << "\nseats:\n";
    for (const SuggestedSeat& seat : given_.seats) {
      out_ << "- {id: " << seat.id << ", position_m: " << room_point(seat.pelvis)
           << ", direction: " << room_point({seat.facing.x, 0.0, seat.facing.y}) << "}  # " << quoted(seat.node) << ", "
           << seat.reason << '\n';
    }
    for (const std::string& bed : given_.beds) out_ << "# A bed: " << quoted(bed) << ".\n";
  }

  void ignored() {
    if (given_.door_leaves.empty() && given_.spaces.empty() && given_.around.empty() && given_.ignored.empty()) return;
    out_ << "\nignore:\n";
    for (const std::string& pattern : given_.ignored) out_ << "- " << quoted(pattern) << "\n";
    for (const std::string& name : given_.around)
      out_ << "- " << quoted(name) << "  # lies around all else: no floor was looked for on it\n";
    for (const std::string& name : given_.door_leaves) out_ << "- " << quoted(name) << "  # shuts an opening\n";
    for (const std::string& name : given_.spaces) out_ << "- " << quoted(name) << "  # a room's volume\n";
  }

  const Suggestion& given_;
  const std::string& model_;
  std::ostringstream out_;
};

}  // namespace

std::string to_yaml(const Suggestion& suggestion, const std::string& model_name) {
  return SuggestionWriter(suggestion, model_name).run();
}

}  // namespace pirsim::studies
