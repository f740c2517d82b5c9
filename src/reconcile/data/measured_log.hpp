// Logs of real sensors as measured data: their windows where the script's runs are.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "pirsim/log.hpp"
#include "reconcile/data/measured.hpp"

namespace pirsim::reconcile {

/// Whether a file is a log rather than pirsim's own rows or sums: its first line has times and neither `time_s` nor
/// sums, or it is a database. Pipes are read once, by whoever parses rows: they are none.
[[nodiscard]] bool is_log(const std::filesystem::path& file);

/// begin_s: of the script's clock, when its run begins (since 1970); none without a clock. Throws Error(input) for a
/// log of other times or sensors, and for readings that are longer than the script's windows.
[[nodiscard]] Measured measured_of(const Log& log, const StudyFrame& frame, std::optional<std::int64_t> begin_s);

/// What the data's own counts (n_days x n_rows of the frame's units; -1: not known) say that the script's don't.
void note_people(const StudyFrame& frame, std::span<const std::int32_t> counted, LogMap::People means,
                 std::vector<DataNote>& notes);

}  // namespace pirsim::reconcile
