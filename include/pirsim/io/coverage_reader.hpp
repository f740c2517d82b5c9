// Coverage studies as YAML; the format is described in docs/formats/coverage.md.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "pirsim/schema/coverage_spec.hpp"

namespace pirsim::io {

/// Reads and validates; overrides as in read_script(). Throws Error (io, input, usage).
[[nodiscard]] CoverageSpec read_coverage(const std::filesystem::path& file,
                                         std::span<const std::string> overrides = {});

}  // namespace pirsim::io
