// A scene as the text of a glTF file.
#pragma once

#include <string>

#include "pirsim/error.hpp"
#include "pirsim/scene.hpp"

namespace pirsim::io {

/// What write_scene() writes into a .gltf. where: for messages. Throws Error(usage) as write_scene() does.
[[nodiscard]] std::string scene_text(const SceneSpec& scene, const Where& where);

}  // namespace pirsim::io
