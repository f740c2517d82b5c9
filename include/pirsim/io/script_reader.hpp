// Studies as YAML; the format is described in docs/formats/script.md.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "pirsim/schema/script_spec.hpp"

namespace pirsim::io {

/// Reads and validates a script. Each override is `sensing.rays_per_zone=9`: it replaces a value before reading.
/// Throws Error (io: no such file; input: all faults with file:line:column; usage: an override).
[[nodiscard]] ScriptSpec read_script(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// The script as YAML that read_script() reads back to the same spec: trials and people written out.
[[nodiscard]] std::string to_yaml(const ScriptSpec& script);

/// The same script for a file in another folder: the files that it refers to are found from there.
[[nodiscard]] ScriptSpec moved(ScriptSpec script, const std::filesystem::path& folder);

}  // namespace pirsim::io
