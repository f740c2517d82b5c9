// Which few of many candidates cover most together? Ref: [NemhauserWolseyFisher1978].
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pirsim::studies {

/// Things that candidates cover. What a thing is worth counts once, however many cover it.
struct Cover {
  std::vector<std::uint64_t> worth;                 ///< (n_things)
  std::vector<std::vector<std::uint32_t>> covered;  ///< (n_candidates) things of each

  [[nodiscard]] std::uint64_t worth_of(const std::vector<std::size_t>& chosen) const;
};

/// Takes the candidate that adds most, `n` times, and the first of several such. What is covered is worth at least
/// 1 - 1/e of the most that n candidates can cover. n: at most n_candidates.
[[nodiscard]] std::vector<std::size_t> greedy_cover(const Cover& cover, std::size_t n);

/// Exchanges one candidate after the other for the best other one, until no exchange gains anything.
[[nodiscard]] std::vector<std::size_t> exchanged(const Cover& cover, std::vector<std::size_t> chosen);

/// The better of two starts, after exchanges: the greedy one and `start`. Never covers less than either.
[[nodiscard]] std::vector<std::size_t> best_cover(const Cover& cover, const std::vector<std::size_t>& start);

}  // namespace pirsim::studies
