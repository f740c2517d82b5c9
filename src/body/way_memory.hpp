// Ways found before: every replicate of a study asks for the same ones.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "pirsim/geometry.hpp"

namespace pirsim::body {

/// Safe to use from any thread, of bounded size, and without influence on what is found.
class WayMemory {
 public:
  using Way = std::optional<std::vector<Vec2>>;

  /// What search() finds between the points; searched once for points that are the same bit for bit.
  [[nodiscard]] Way way(const Vec2& from, const Vec2& to, const std::function<Way()>& search) {
    const std::array<double, 4> ends{from.x, from.y, to.x, to.y};
    {
      const std::lock_guard lock(mutex_);
      if (const auto known = ways_.find(ends); known != ways_.end()) return known->second;
    }
    Way found = search();
    const std::lock_guard lock(mutex_);
    if (ways_.size() >= most_ways) ways_.clear();
    ways_.emplace(ends, found);
    return found;
  }

 private:
  static constexpr std::size_t most_ways = 1024;  ///< a study with fixed seats has two a seat
  std::mutex mutex_;
  std::map<std::array<double, 4>, Way> ways_;
};

}  // namespace pirsim::body
