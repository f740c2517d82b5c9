// The parts that a suggestion is made of. Private to studies.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/read/model_parts.hpp"
#include "studies/suggested_floor.hpp"
#include "studies/suggestion.hpp"

namespace pirsim::studies {

struct Extent {
  Vec3 least{0.0}, most{0.0};
  [[nodiscard]] Vec3 size() const { return most - least; }
  [[nodiscard]] Vec3 middle() const { return 0.5 * (least + most); }
};
[[nodiscard]] Extent extent_of(std::span<const TriMesh* const> meshes);

/// From sizes alone: metres and +Y up, as glTF says, unless these make no building and others do.
[[nodiscard]] SuggestedFrame frame_of(const io::ModelParts& model);
/// Turns and scales the model.
void to_room(io::ModelParts& model, const SuggestedFrame& frame);

/// Nodes of the ground that the rooms stand on, of a sky around them, and the like: much larger than all the rest. By
/// sizes alone, so that a room around a few things may be among them.
[[nodiscard]] std::vector<int> surroundings_of(const io::ModelParts& model);
void leave_out(io::ModelParts& model, const std::vector<int>& nodes);
/// Leaves out what patterns of a marks file name, with all below. Throws Error(usage) for one that names nothing.
void ignore(io::ModelParts& model, const std::vector<std::string>& patterns);

/// A node with all parts below it.
struct Thing {
  int node = 0;
  std::vector<const TriMesh*> meshes;
  Extent extent;
};
/// Whether a name has one of the words in it, in any case: "chair" in "Chair.001".
[[nodiscard]] bool has_word(std::string_view name, std::span<const std::string_view> words);
/// Nodes with a word in their name, the topmost of each branch whose size `fits`.
[[nodiscard]] std::vector<Thing> things_named(const io::ModelParts& model, std::span<const std::string_view> words,
                                              const std::function<bool(const Extent&)>& fits);

/// Chairs, sofas, stools and toilets on the floor, by names and by shapes. Beds aren't among them: they go to `beds`.
[[nodiscard]] std::vector<SuggestedSeat> seats_of(const io::ModelParts& model, const FloorPlan& plan);
[[nodiscard]] std::vector<std::string> beds_of(const io::ModelParts& model, const FloorPlan& plan);

}  // namespace pirsim::studies
