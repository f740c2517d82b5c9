// Which few of many candidate sensors make light go off on somebody least often?
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "studies/light_rows.hpp"

namespace pirsim::studies {

/// Looks among sets of the rows' sensors. Areas don't depend on each other: what an area's sensors do is worked out
/// once.
class LightSearch {
 public:
  /// Both outlive it.
  LightSearch(const LightRows& rows, const PlacementLightSpec& light)
      : rows_(rows), light_(light), known_(rows.areas.size()) {}

  /// Of all areas together.
  [[nodiscard]] LightSums of(const std::vector<std::size_t>& chosen);
  /// Takes the sensor that is best with those before it, `n` times, and the first of several such. n: at most as many
  /// as there are.
  [[nodiscard]] std::vector<std::size_t> greedy(std::size_t n);
  /// Exchanges one sensor after the other for the best other one, until no exchange gains anything.
  [[nodiscard]] std::vector<std::size_t> exchanged(std::vector<std::size_t> chosen);
  /// The better of two starts, after exchanges: the greedy one and `start`. Never worse than either.
  [[nodiscard]] std::vector<std::size_t> best(const std::vector<std::size_t>& start);

 private:
  using Sensors = std::vector<std::size_t>;
  [[nodiscard]] const LightSums& of_area(std::size_t area, const Sensors& chosen);
  /// The best to add to `chosen`.
  [[nodiscard]] std::size_t best_addition(Sensors chosen);

  const LightRows& rows_;
  const PlacementLightSpec& light_;
  std::vector<std::map<Sensors, LightSums>> known_;  ///< (n_areas) by the sensors that watch it, in order
};

}  // namespace pirsim::studies
