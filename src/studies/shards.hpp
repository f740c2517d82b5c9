// Which part of a study a task of a job array computes, and what its file is called.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "pirsim/sample.hpp"

namespace pirsim::studies {

/// A variable's value, if it is set.
using Environment = std::function<std::optional<std::string>(const char* name)>;
[[nodiscard]] std::optional<std::string> process_environment(const char* name);

/// "3/100" is the third of a hundred. "auto/100" takes the task's number, 1 to 100, from the job array. "auto" takes
/// the number of shards from it too: it needs the whole array, of evenly spaced numbers, and so doesn't serve to submit
/// a part of an array again. Read are SLURM_ARRAY_TASK_{ID,MIN,STEP,COUNT}, SGE_TASK_{ID,FIRST,LAST,STEPSIZE}, and
/// PBS_ARRAY_INDEX or PBS_ARRAYID (number only). Throws Error(usage).
[[nodiscard]] Shard parse_shard(std::string_view text, const Environment& environment = process_environment);

/// "shard-0003-of-0100"
[[nodiscard]] std::string shard_name(const Shard& shard);
/// The shard that a file name begins with, if it does.
[[nodiscard]] std::optional<Shard> shard_of(std::string_view file_name);

}  // namespace pirsim::studies
