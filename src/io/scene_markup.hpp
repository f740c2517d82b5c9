// What a node is, if it isn't just geometry: `extras.pirsim`. Private to io.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "io/gltf_document.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::io::detail {

namespace mark {
struct Sensor {
  std::string id, model;
};
struct Seat {
  std::string id;
};
struct Entrance {
  std::string id;
  double width_m = 0.9;
  double outside_m = 1.5;
};
enum class Occludes { yes, no };
struct Floor {
  std::optional<std::vector<Vec2>> polygon;  ///< in the node's local XZ; otherwise the outline of the node's mesh
  Occludes occludes = Occludes::yes;
};
/// Says something of the node's mesh.
struct Surface {
  double temperature_c = 0.0;
};
struct Ignore {};
}  // namespace mark

using Markup = std::variant<mark::Sensor, mark::Seat, mark::Entrance, mark::Floor, mark::Surface, mark::Ignore>;

/// JSON pointer of a node's markup.
[[nodiscard]] std::string markup_pointer(int node);

/// Nothing for a node without markup, or with a faulty one (the faults are added).
[[nodiscard]] std::optional<Markup> read_markup(const GltfDocument& document, int node, Diagnostics& remarks);

}  // namespace pirsim::io::detail
