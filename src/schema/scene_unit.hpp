// Whether a scene is measured in metres.
#pragma once

#include <optional>
#include <string>

#include "pirsim/scene.hpp"

namespace pirsim {

/// What its sizes say if they are hardly metres: which unit makes a plausible room of them, and of what size. Nothing
/// for a scene that may be in metres.
[[nodiscard]] std::optional<std::string> doubt_of_unit(const SceneSpec& scene);

}  // namespace pirsim
