// A study and others that differ from it in a little: whatever is the same is followed and traced once.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "engine/sim/compiled_study.hpp"
#include "engine/sim/recording.hpp"
#include "pirsim/random.hpp"
#include "pirsim/recording.hpp"

namespace pirsim::sim {

/// Who moves as the first study's people do (CompiledStudy::moves_people_as) isn't moved again; what rays that are the
/// same saw of a posture, or brought of it, isn't traced again. Belongs to one thread at a time. Remembers every
/// posture of the first study.
class RecordingFamily {
 public:
  /// Follows these runs of `first`, which must outlive the family.
  RecordingFamily(const Model& first, std::span<const std::uint32_t> runs);
  ~RecordingFamily();
  RecordingFamily(RecordingFamily&&) noexcept;
  RecordingFamily& operator=(RecordingFamily&&) noexcept;
  RecordingFamily(const RecordingFamily&) = delete;
  RecordingFamily& operator=(const RecordingFamily&) = delete;

  [[nodiscard]] const Recording& first() const noexcept;
  /// record() of a Model compiled like the first one, but for the order of sets. runs: of `other`; each is run of
  /// the same number of the first study as well, if that has been followed. Throws as the constructor does.
  [[nodiscard]] Recording record(const Model& other, std::span<const std::uint32_t> runs);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// What detectors make of recorded runs, found once: effects on triggers and rows act behind it, and so may be tried as
// often as one likes.

/// The numbers that analog sensors' noise is made of, drawn once for all studies that have them in common.
class NoiseMemory {
 public:
  /// The next n normal numbers of a stream. Valid until the next call.
  [[nodiscard]] std::span<const double> normals(const Stream& from, std::size_t n);

 private:
  struct Drawn {
    Stream from;
    Stream next;  ///< behind the numbers
    std::vector<double> numbers;
  };
  static constexpr std::size_t most_kept = std::size_t{1} << 22U;  ///< 32 MB

  std::vector<Drawn> drawn_;
  std::vector<double> beyond_;  ///< that there is no room for
  std::size_t n_kept_ = 0;
};

/// A Model's own detectors on a recording of it. Belongs to one thread at a time. Study, recording, noise and the
/// triggers that it is like outlive it.
class RememberedTriggers final : public DetectorLogic {
 public:
  /// like: triggers of a study with the same seed, or null. An analog sensor that is the same and receives the same all
  /// the time triggers as it does there.
  RememberedTriggers(const CompiledStudy& study, const Recording& recording, NoiseMemory& noise,
                     const RememberedTriggers* like);

  void prepare(const Recording& recording) override;  ///< checks that it is the one that was given
  void begin_run(std::uint64_t seed, std::uint32_t run) override;
  void tick(std::uint32_t before, std::uint32_t after, std::span<std::uint8_t> triggers) noexcept override;

 private:
  using Bits = std::vector<std::uint64_t>;  ///< one a tick
  using Told = std::array<Bits, 3>;         ///< of one sensor, by the bits of a trigger; empty: never set
  struct Run {
    std::uint64_t seed = 0;
    const RecordedRun* track = nullptr;
    std::vector<Told> triggers;  ///< (n_sensors)
  };

  [[nodiscard]] Run find_triggers(const RecordedRun& track, std::uint64_t seed);
  void find_zone_triggers(Run& run) const;
  [[nodiscard]] Told analog_triggers(const Run& run, std::uint32_t sensor);
  /// Those of the other study's run, if the sensor receives the same.
  [[nodiscard]] const Told* known_triggers(const Run& run, std::uint32_t sensor) const;

  const CompiledStudy& study_;
  const Recording& recording_;
  NoiseMemory& noise_;
  const RememberedTriggers* like_;
  std::map<std::uint32_t, Run> runs_;  ///< by number, those that were begun
  const Run* now_ = nullptr;
  std::size_t tick_ = 0;
};

}  // namespace pirsim::sim
