// What happened in each area of a scene over some runs, and how often the sensors that watch it saw motion.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/pages/report.hpp"
#include "pirsim/model.hpp"
#include "pirsim/study.hpp"
#include "schema/areas.hpp"
#include "studies/summary.hpp"

namespace pirsim::studies {

class AreaTally {
 public:
  explicit AreaTally(const Model& model);

  void add_run(const RunResult& result);
  [[nodiscard]] bool empty() const noexcept { return sums_.empty(); }
  /// A line an area.
  [[nodiscard]] io::Table table() const;

 private:
  const Model* model_;
  Areas areas_;  ///< as the scene is drawn
  double window_s_;
  int runs_ = 0;
  std::vector<AreaSums> sums_;                     ///< (n_areas)
  std::vector<std::vector<std::size_t>> sensors_;  ///< (n_areas) that watch each
  std::vector<std::int64_t> with_motion_;          ///< (n_areas) rows in which one of these saw motion
};

/// "kitchen (PIR1, PIR2)"
[[nodiscard]] std::string with_sensors(const SceneSpec& scene, const Areas& areas, std::size_t area);

}  // namespace pirsim::studies
