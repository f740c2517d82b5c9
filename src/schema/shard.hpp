// A study cut into blocks of runs that can be computed anywhere.
#pragma once

#include <cstdint>

namespace pirsim {

/// Runs first, first + 1, ... end - 1 of a study.
struct RunRange {
  std::uint32_t first = 0;
  std::uint32_t end = 0;
  [[nodiscard]] std::uint32_t count() const noexcept { return end - first; }
  bool operator==(const RunRange&) const = default;
};

/// The index-th (from 1) of `count` blocks.
struct Shard {
  std::uint32_t index = 1;
  std::uint32_t count = 1;
  bool operator==(const Shard&) const = default;
};

/// Contiguous blocks whose sizes differ by one run at most; together they are all runs, each once. Blocks are empty
/// where there are more shards than runs.
[[nodiscard]] constexpr RunRange runs_of(const Shard& shard, std::uint32_t n_runs) noexcept {
  const auto cut = [&](std::uint64_t blocks) { return static_cast<std::uint32_t>(n_runs * blocks / shard.count); };
  return {cut(shard.index - 1), cut(shard.index)};
}

}  // namespace pirsim
