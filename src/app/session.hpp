// What all commands begin with: read, compile, tell what is odd.
#pragma once

#include <string>

#include "app/options.hpp"
#include "pirsim/io.hpp"
#include "pirsim/model.hpp"
#include "pirsim/script.hpp"

namespace pirsim::app {

/// Reads and compiles; warnings of the readers go to standard error unless quiet.
[[nodiscard]] Model load(const Inputs& inputs);
/// The same for a script that the command made.
[[nodiscard]] Model load(const Inputs& inputs, ScriptSpec script);
/// Index of a run. Throws Error(usage).
[[nodiscard]] std::uint32_t find_run(const Model& model, const RunChoice& choice);
/// Resolves "all", "none" and sensor names to indices. Throws Error(usage).
[[nodiscard]] std::vector<std::size_t> find_sensors(const Model& model, const std::vector<std::string>& names);
/// Where a scene's sensors are looked for: what the user names, and last the data that came with this program. Throws
/// Error(io) if the user names what isn't a folder.
[[nodiscard]] io::SceneOptions scene_options(const Inputs& inputs);
/// Of --nuisance: a file, "none", or "" for the usual one.
[[nodiscard]] NuisanceSpec nuisance_of(const std::string& asked);
void tell(const std::vector<Issue>& issues, Verbosity verbosity);

}  // namespace pirsim::app
