// Recordings replayed with the Model's own detector and with effects.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "effects/pipeline.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/recording.hpp"
#include "sim/compiled_study.hpp"

namespace pirsim::sim {

/// The detector that the Model's own runs have: sim::Detector, fed by a recording.
[[nodiscard]] std::unique_ptr<DetectorLogic> make_logic(const Model& model);

/// Whether the run was recorded as far as clocks among the stages look ahead of its last row.
[[nodiscard]] bool goes_as_far_as(const RecordedRun& track, const SensingSpec& sensing,
                                  const effects::Pipeline& stages);

/// replay() with what the stages do to triggers and rows. With make_logic(model), the script's seed and the Model's
/// stages: the study's rows, bit for bit. Throws Error(usage) unless the run goes_as_far_as() the stages.
[[nodiscard]] RunResult replay(const Recording& recording, std::size_t index, DetectorLogic& detector,
                               std::uint64_t seed, const effects::Pipeline& stages);

/// What these effects do to triggers and rows of a study that was compiled without them, to be given to replay(). Those
/// that reach geometry are passed over: they need a Model of their own. Throws Error(input) for unknown names.
[[nodiscard]] effects::Pipeline make_stages(const Model& model, std::span<const EffectSpec> effects);

/// Without runs yet. Throws Error(usage) for sensors with an analog response.
[[nodiscard]] Recording empty_recording(const CompiledStudy& study);

class SetNumbering {
 public:
  /// Number 0 is the empty set.
  explicit SetNumbering(std::size_t n_zones) : buckets_(fewest_buckets, 0) { (void)number(ZoneSet(n_zones)); }

  std::uint32_t number(const ZoneSet& set) {
    std::size_t bucket = bucket_of(set);
    if (buckets_[bucket] != 0) return buckets_[bucket] - 1;
    sets_.push_back(set);
    buckets_[bucket] = static_cast<std::uint32_t>(sets_.size());
    if (2 * sets_.size() > buckets_.size()) spread();
    return static_cast<std::uint32_t>(sets_.size() - 1);
  }
  [[nodiscard]] std::vector<ZoneSet>& sets() noexcept { return sets_; }

 private:
  static constexpr std::size_t fewest_buckets = 1024;

  [[nodiscard]] std::size_t bucket_of(const ZoneSet& set) const noexcept {
    ZoneSet::Word hash = 0;
    for (const ZoneSet::Word word : set.words()) {
      hash = (hash ^ word) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 32U;
    }
    std::size_t bucket = hash % buckets_.size();
    while (buckets_[bucket] != 0 && sets_[buckets_[bucket] - 1] != set) bucket = (bucket + 1) % buckets_.size();
    return bucket;
  }
  void spread() {
    buckets_.assign(2 * buckets_.size(), 0);
    for (std::size_t i = 0; i < sets_.size(); ++i) {
      buckets_[bucket_of(sets_[i])] = static_cast<std::uint32_t>(i + 1);
    }
  }

  std::vector<std::uint32_t> buckets_;  ///< 1 + number, probed one after the other
  std::vector<ZoneSet> sets_;
};

}  // namespace pirsim::sim
