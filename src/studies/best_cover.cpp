#include "studies/best_cover.hpp"

#include <algorithm>
#include <utility>

namespace pirsim::studies {
namespace {

/// How many of the chosen cover each thing.
class Coverings {
 public:
  explicit Coverings(const Cover& cover) : cover_(cover), times_(cover.worth.size(), 0) {}

  void add(std::size_t candidate) {
    for (const std::uint32_t thing : cover_.covered[candidate]) ++times_[thing];
  }
  void remove(std::size_t candidate) {
    for (const std::uint32_t thing : cover_.covered[candidate]) --times_[thing];
  }
  /// Of a candidate that isn't chosen.
  [[nodiscard]] std::uint64_t gain(std::size_t candidate) const {
    std::uint64_t sum = 0;
    for (const std::uint32_t thing : cover_.covered[candidate]) sum += times_[thing] == 0 ? cover_.worth[thing] : 0;
    return sum;
  }
  /// The first that gains most. Takes none of `taken`.
  [[nodiscard]] std::size_t best(const std::vector<std::size_t>& taken) const {
    std::size_t best = cover_.covered.size();
    std::uint64_t most = 0;
    for (std::size_t i = 0; i < cover_.covered.size(); ++i) {
      if (std::ranges::find(taken, i) != taken.end()) continue;
      const std::uint64_t gained = gain(i);
      if (best == cover_.covered.size() || gained > most) {
        best = i;
        most = gained;
      }
    }
    return best;
  }

 private:
  const Cover& cover_;
  std::vector<std::size_t> times_;
};

}  // namespace

std::uint64_t Cover::worth_of(const std::vector<std::size_t>& chosen) const {
  Coverings coverings(*this);
  std::uint64_t sum = 0;
  for (const std::size_t candidate : chosen) {
    sum += coverings.gain(candidate);
    coverings.add(candidate);
  }
  return sum;
}

std::vector<std::size_t> greedy_cover(const Cover& cover, std::size_t n) {
  Coverings coverings(cover);
  std::vector<std::size_t> chosen;
  while (chosen.size() < n) {
    chosen.push_back(coverings.best(chosen));
    coverings.add(chosen.back());
  }
  return chosen;
}

std::vector<std::size_t> exchanged(const Cover& cover, std::vector<std::size_t> chosen) {
  Coverings coverings(cover);
  for (const std::size_t candidate : chosen) coverings.add(candidate);
  for (bool gains = chosen.size() < cover.covered.size(); gains;) {
    gains = false;
    for (std::size_t& candidate : chosen) {
      coverings.remove(candidate);
      const std::size_t other = coverings.best(chosen);
      if (coverings.gain(other) > coverings.gain(candidate)) {
        candidate = other;
        gains = true;
      }
      coverings.add(candidate);
    }
  }
  return chosen;
}

std::vector<std::size_t> best_cover(const Cover& cover, const std::vector<std::size_t>& start) {
  std::vector<std::size_t> greedy = exchanged(cover, greedy_cover(cover, start.size()));
  std::vector<std::size_t> other = exchanged(cover, start);
  return cover.worth_of(other) > cover.worth_of(greedy) ? other : greedy;
}

}  // namespace pirsim::studies
