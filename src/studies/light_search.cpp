#include "studies/light_search.hpp"

#include <algorithm>

namespace pirsim::studies {

const LightSums& LightSearch::of_area(std::size_t area, const Sensors& chosen) {
  Sensors own;
  for (const std::size_t sensor : chosen) {
    if (rows_.area_of[sensor] == area) own.push_back(sensor);
  }
  std::ranges::sort(own);
  const auto known = known_[area].find(own);
  if (known != known_[area].end()) return known->second;
  const LightSums sums = switch_light(rows_, area, own, light_);
  return known_[area].emplace(std::move(own), sums).first->second;
}

LightSums LightSearch::of(const Sensors& chosen) {
  LightSums sums;
  for (std::size_t area = 0; area < rows_.areas.size(); ++area) sums += of_area(area, chosen);
  return sums;
}

std::size_t LightSearch::best_addition(Sensors chosen) {
  std::size_t best = rows_.sensors.size();
  LightSums least;
  const Sensors taken = chosen;
  chosen.push_back(0);
  for (std::size_t i = 0; i < rows_.sensors.size(); ++i) {
    if (std::ranges::find(taken, i) != taken.end()) continue;
    chosen.back() = i;
    const LightSums sums = of(chosen);
    if (best < rows_.sensors.size() && !sums.better_than(least)) continue;
    best = i;
    least = sums;
  }
  return best;
}

std::vector<std::size_t> LightSearch::greedy(std::size_t n) {
  Sensors chosen;
  while (chosen.size() < n) chosen.push_back(best_addition(chosen));
  return chosen;
}

std::vector<std::size_t> LightSearch::exchanged(Sensors chosen) {
  for (bool gains = chosen.size() < rows_.sensors.size(); gains;) {
    gains = false;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      Sensors others = chosen;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      Sensors changed = chosen;
      changed[i] = best_addition(others);
      if (!of(changed).better_than(of(chosen))) continue;
      chosen = std::move(changed);
      gains = true;
    }
  }
  return chosen;
}

std::vector<std::size_t> LightSearch::best(const Sensors& start) {
  Sensors greedy_set = exchanged(greedy(start.size()));
  Sensors other = exchanged(start);
  return of(other).better_than(of(greedy_set)) ? other : greedy_set;
}

}  // namespace pirsim::studies
