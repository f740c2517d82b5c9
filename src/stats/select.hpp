// Some of a list.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace pirsim::stats::detail {

/// The values at the given places, in their order.
template <typename T>
[[nodiscard]] std::vector<T> select(std::span<const T> values, std::span<const std::size_t> places) {
  std::vector<T> selected;
  selected.reserve(places.size());
  for (const std::size_t place : places) selected.push_back(values[place]);
  return selected;
}

}  // namespace pirsim::stats::detail
