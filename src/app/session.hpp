// What all commands begin with: read, compile, tell what is odd.
#pragma once

#include <string>

#include "app/options.hpp"
#include "io/atomic_file.hpp"
#include "io/report.hpp"
#include "pirsim/io.hpp"
#include "pirsim/script.hpp"
#include "pirsim/model.hpp"

namespace pirsim::app {

/// Reads and compiles; warnings of the readers go to standard error unless quiet.
[[nodiscard]] Model load(const Inputs& inputs);
/// Index of the run of a trial ("" for the first) and replicate (from 1). Throws Error(usage).
[[nodiscard]] std::uint32_t find_run(const Model& model, const std::string& trial, int replicate);
/// Resolves "all", "none" and sensor names to indices. Throws Error(usage).
[[nodiscard]] std::vector<std::size_t> find_sensors(const Model& model, const std::vector<std::string>& names);
/// Writes a report with what made it in the footer, and commits the file.
void write_page(io::AtomicFile& file, io::Report report, const Inputs& inputs);
/// Where a scene's sensors are looked for: what the user names, and last the data that came with this program.
[[nodiscard]] io::SceneOptions scene_options(const Inputs& inputs);
/// Of --nuisance: a file, "none", or "" for the usual one.
[[nodiscard]] NuisanceSpec nuisance_of(const std::string& asked);
void tell(const std::vector<Issue>& issues, Verbosity verbosity);

}  // namespace pirsim::app
