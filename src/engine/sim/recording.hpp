// Recordings replayed with the Model's own detector and with effects.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/effects/pipeline.hpp"
#include "engine/sim/compiled_study.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/recording.hpp"

namespace pirsim::sim {

/// The detector that the Model's own runs have: sim::Detector, fed by a recording. Its prepare() throws Error(usage)
/// for a recording of other optics than the Model's.
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

/// Without runs yet.
[[nodiscard]] Recording empty_recording(const CompiledStudy& study);
/// Of a run of which nothing has been recorded.
[[nodiscard]] RecordedRun begun_run(const CompiledStudy& study, std::uint32_t run);
/// Appends what all receivers got at a moment; nothing without analog sensors.
void add_powers(const Recording& recording, std::uint32_t moment, std::vector<PowerSteps>& powers);

/// Hands out numbers 0, 1, 2, ... to things that somebody else keeps.
class Numbering {
 public:
  /// The number of the thing that is_it(number) says it is, or the next one. Equal things have equal hashes.
  template <typename IsIt>
  std::uint32_t number(std::uint64_t hash, const IsIt& is_it) {
    std::size_t bucket = hash % buckets_.size();
    for (; buckets_[bucket] != 0; bucket = (bucket + 1) % buckets_.size()) {
      const std::uint32_t known = buckets_[bucket] - 1;
      if (hashes_[known] == hash && is_it(known)) return known;
    }
    hashes_.push_back(hash);
    buckets_[bucket] = static_cast<std::uint32_t>(hashes_.size());
    if (2 * hashes_.size() > buckets_.size()) spread();
    return static_cast<std::uint32_t>(hashes_.size() - 1);
  }

 private:
  static constexpr std::size_t fewest_buckets = 1024;

  void spread() {
    buckets_.assign(2 * buckets_.size(), 0);
    for (std::size_t i = 0; i < hashes_.size(); ++i) {
      std::size_t bucket = hashes_[i] % buckets_.size();
      while (buckets_[bucket] != 0) bucket = (bucket + 1) % buckets_.size();
      buckets_[bucket] = static_cast<std::uint32_t>(i + 1);
    }
  }

  std::vector<std::uint32_t> buckets_ = std::vector<std::uint32_t>(fewest_buckets, 0);  ///< 1 + number
  std::vector<std::uint64_t> hashes_;
};

/// Numbers what the optics show: fills in a Recording, all but its runs.
class MomentNumbering {
 public:
  /// Of an empty_recording(), to which it adds. Number 0 is the empty room.
  MomentNumbering(Recording& recording, std::size_t n_zones);

  /// zones: of sensors that answer by them, as words. powers: (n_receivers), empty if none is analog.
  std::uint32_t number(std::span<const ZoneSet::Word> zones, std::span<const PowerSteps> powers);

 private:
  std::uint32_t number_set(std::span<const ZoneSet::Word> zones);
  std::uint32_t number_row(std::size_t sensor, std::span<const PowerSteps> powers);

  Recording& recording_;
  std::size_t n_zones_;
  Numbering sets_, moments_;
  std::vector<Numbering> rows_;  ///< (n_sensors)
};

}  // namespace pirsim::sim
