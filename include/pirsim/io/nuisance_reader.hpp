// What is uncertain about a real room, as YAML; the format is described in docs/formats/reconcile.md.
#pragma once

#include <filesystem>

#include "pirsim/schema/nuisance_spec.hpp"

namespace pirsim::io {

/// Throws Error (io: no such file; input: all faults with file:line:column).
[[nodiscard]] NuisanceSpec read_nuisance(const std::filesystem::path& file);

}  // namespace pirsim::io
