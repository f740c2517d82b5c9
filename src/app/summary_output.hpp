// The table of sums, of a run or of merged shards.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/options.hpp"
#include "io/atomic_file.hpp"
#include "pirsim/script.hpp"
#include "studies/summary.hpp"

namespace pirsim::app {

/// Those that the script's summary refers to; none if it doesn't.
[[nodiscard]] std::vector<MeasuredCell> measured_cells(const ScriptSpec& script);
/// A document if `path` ends in .md, else CSV; and a copy on standard error unless all is quiet.
void write_summary(const studies::Summary& summary, io::AtomicFile& file, const std::filesystem::path& path,
                   const std::string& title, Verbosity verbosity);

}  // namespace pirsim::app
