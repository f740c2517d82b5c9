// What the sensors of a study see of postures that are known by number, each looked at once.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "rt/tracer.hpp"
#include "sim/compiled_study.hpp"
#include "sim/people_tracks.hpp"
#include "sim/posture_powers.hpp"
#include "sim/solids.hpp"

namespace pirsim::sim {

/// Solids of postures. From keep() on it remembers those of the first postures, as many as the memory for them should
/// hold: 30 MB. Study A has some 30,000.
class PostureSolids {
 public:
  using Number = PostureIndex::Number;

  /// Valid until the next call.
  [[nodiscard]] std::span<const PosedShape> of(const Postures& postures, Number number);
  void keep() noexcept { n_to_keep_ = most_kept; }
  void shrink(std::size_t n);

 private:
  static constexpr std::size_t most_kept = 32768;

  std::size_t n_to_keep_ = 0, n_kept_ = 0;
  std::vector<PosedShape> kept_;       ///< (n_kept x n_parts)
  std::vector<Mannequin> mannequins_;  ///< (n_people)
};

/// What looks alike in two studies: the same rays, which end alike and bring as much.
struct InCommon {
  ZoneSet zones;                      ///< of sensors that answer by them
  std::vector<std::uint8_t> sensors;  ///< (n_sensors) 1: an analog one whose power is the same

  /// Of all sensors.
  bool everything = false;
};
[[nodiscard]] InCommon in_common(const CompiledStudy& first, const CompiledStudy& other);

/// What the rays of one study see of postures, as far as anybody asked.
class PostureSight {
 public:
  using Number = PostureIndex::Number;

  explicit PostureSight(const CompiledStudy& study);
  /// Asks `other` about what looks the same in both; it may be null if nothing does.
  PostureSight(const CompiledStudy& study, const InCommon& common, PostureSight* other);

  /// Of one person alone.
  [[nodiscard]] std::span<const ZoneSet::Word> zones(const Postures& postures, PostureSolids& solids, Number number) {
    return row(postures, solids, number).first(n_zone_words_);
  }
  [[nodiscard]] std::span<const PowerSteps> powers(const Postures& postures, PostureSolids& solids, Number number);
  /// Of several people, who hide one another; nothing without analog sensors. Where the other study's people are the
  /// same at that moment, `there` has what its sensors received.
  [[nodiscard]] std::span<const PowerSteps> powers(const Postures& postures, PostureSolids& solids,
                                                   std::span<const Number> people, std::span<const PowerSteps> there);
  [[nodiscard]] std::size_t n_zones() const noexcept { return zones_.size(); }
  void shrink(std::size_t n_postures);

 private:
  using Word = ZoneSet::Word;
  /// Of one analog sensor.
  struct Analog {
    std::uint32_t begin = 0, end = 0;      ///< receivers
    ZoneSet zones;                         ///< of its power's rays
    std::optional<PosturePowers> crowd{};  ///< measures people together, once somebody asked
  };

  std::span<Word> row(const Postures& postures, PostureSolids& solids, Number number);
  void look(const Postures& postures, PostureSolids& solids, Number number, std::span<Word> row);
  [[nodiscard]] PosturePowers& meter_of(std::uint32_t person);
  /// True if no two of them are in one of the sensor's zones: then none hides another, and their powers add up.
  [[nodiscard]] bool apart(const Postures& postures, PostureSolids& solids, std::span<const Number> people,
                           const ZoneSet& zones);
  /// What one sensor receives of people together; powers: (n_receivers) only that sensor's are set.
  void measure_together(const Postures& postures, std::span<const Number> people, std::size_t sensor,
                        std::span<PowerSteps> powers);

  const CompiledStudy& study_;
  InCommon common_;
  PostureSight* other_ = nullptr;
  RayBundle rated_, clipped_;                           ///< of zones that nobody else looks at
  std::unique_ptr<rt::Tracer> tracer_;                  ///< null: no zones are to be looked at
  std::vector<std::unique_ptr<PosturePowers>> meters_;  ///< (n_people) of each alone, of sensors that aren't in common
  std::vector<Analog> analog_;                          ///< (n_sensors) or empty: none is analog
  ZoneSet zones_;                                       ///< scratch
  std::size_t n_zone_words_, n_touched_words_ = 0, n_words_;
  std::vector<Word> rows_;                     ///< (1 + n_postures x n_words) zones, zones touched, powers; 0: nobody
  std::vector<std::uint8_t> known_;            ///< (1 + n_postures) 1 where somebody asked
  std::vector<PowerSteps> powers_, together_;  ///< (n_receivers) scratch
  std::vector<Word> occupied_;                 ///< scratch
};

}  // namespace pirsim::sim
