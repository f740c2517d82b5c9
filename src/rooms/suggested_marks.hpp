// What a model without marks may need: a proposal, made of its shapes and names, to be edited.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "files/read/marks_file.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::studies {

/// From the model to a room in metres with +Y up.
struct SuggestedFrame {
  std::string unit = "m";  ///< a word of marks files; empty: a scale that is only guessed
  double metres = 1.0;     ///< of a unit
  char up = 'y';           ///< which of the model's axes
  Vec3 origin_m{0.0};      ///< after unit and axis; not 0 for a model in the coordinates of a map
};

struct SuggestedArea {
  std::string id;
  std::string named_by;       ///< the node; empty: by its number
  std::vector<Vec2> outline;  ///< (x, z)
  double square_metres = 0.0;
};
/// An opening from one area to another, or to the outside.
struct SuggestedGap {
  std::string from, to;  ///< ids of areas; to is empty: the outside
  Vec2 at{0.0};          ///< its middle, on the floor
  Vec2 inwards{0.0};     ///< of length 1, into `from`
  double width_m = 0.0;
};
struct SuggestedSeat {
  std::string id, node;
  Vec3 pelvis{0.0};
  Vec2 facing{0.0};
  std::string reason;  ///< why it looks like one, and how sure that is
};

struct Suggestion {
  SuggestedFrame frame;
  double floor_m = 0.0;                   ///< height, after the frame
  std::vector<double> other_floors_m;     ///< that were found, too, from below
  std::vector<std::vector<Vec2>> floors;  ///< (x, z) outlines
  std::vector<SuggestedArea> areas;
  std::vector<SuggestedGap> doors, entrances;
  std::vector<SuggestedSeat> seats;
  std::vector<std::string> door_leaves;  ///< nodes that shut openings
  std::vector<std::string> spaces;       ///< nodes that are rooms' volumes
  std::vector<std::string> around;       ///< nodes of the ground and the sky
  std::vector<std::string> ignored;      ///< patterns, as given
  std::vector<std::string> beds;         ///< nodes
  bool is_between_walls = false;         ///< no surface is a floor: it is what the walls enclose
  bool is_open = false;                  ///< no way in was found, and a side without walls is taken for one
};

/// What the user knows better.
struct SuggestionHints {
  std::optional<double> floor_m{};     ///< its height after unit and axis; none: the lowest of the large ones
  std::vector<std::string> ignored{};  ///< patterns of nodes, as of a marks file
};

/// Throws Error(input) if nothing looks like a floor, Error(usage) for a pattern that no node has.
[[nodiscard]] Suggestion suggest(io::ModelParts model, const SuggestionHints& hints, const std::string& name);

/// A marks file with what is in doubt in comments.
[[nodiscard]] std::string to_yaml(const Suggestion& suggestion, const std::string& model_name);

}  // namespace pirsim::studies
