// What analog sensors receive of people who are known by the numbers of their postures.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "rt/tracer.hpp"
#include "sim/compiled_study.hpp"
#include "sim/people_tracks.hpp"
#include "sim/solids.hpp"

namespace pirsim::sim {

/// Follows the rays of some of a study's analog sensors, or of all. Belongs to one thread at a time; what it has
/// measured before changes no result.
class PosturePowers {
 public:
  /// left_out: (n_sensors) 1 for those whose rays aren't followed. study: with analog sensors; it outlives this.
  PosturePowers(const CompiledStudy& study, std::span<const std::uint8_t> left_out);
  /// Of these people together, who hide one another. people: (n_people) 0: not there. powers: (n_receivers)
  /// overwritten; of sensors that are left out nothing.
  void measure(const Postures& postures, std::span<const PostureIndex::Number> people, std::span<PowerSteps> powers);
  /// Zones of the power's rays that somebody was in then.
  [[nodiscard]] const ZoneSet& touched() const noexcept { return touched_; }
  /// The postures from n + 1 on have been forgotten: their numbers will stand for others.
  void shrink(std::size_t n) noexcept;

 private:
  static constexpr PostureIndex::Number forgotten = 0xFFFFFFFFU;
  /// Who was followed last.
  struct Figure {
    PostureIndex::Number posture = 0;  ///< 0: nobody
    std::uint64_t figure = 0;
    BodyRadiance radiance{};
    std::array<std::uint8_t, body::n_parts> surfaces{};
    Mannequin mannequin{};
  };

  void follow();
  [[nodiscard]] PowerSteps power(std::uint32_t ray, rt::SolidId solid) const noexcept {
    return solid == rt::no_solid ? 0 : power_.power(ray, figures_[solid.person].radiance[solid.solid]);
  }

  const PowerModel& power_;
  RayBundle rated_, clipped_;        ///< of the sensors that aren't left out
  std::vector<std::uint32_t> rays_;  ///< (n of their rays) each one's number in the study
  std::unique_ptr<rt::Tracer> tracer_;
  std::vector<Figure> figures_;         ///< (n_people)
  std::vector<PowerSteps> powers_;      ///< (n_receivers) of figures_
  std::vector<std::uint32_t> zone_of_;  ///< (n of rays_)
  std::vector<std::uint32_t> n_hit_;    ///< (n_zones) rays that end at somebody
  ZoneSet touched_;
  // Scratch.
  std::vector<rt::Moved> moved_;
  std::vector<rt::FirstHitChange> changes_;
};

}  // namespace pirsim::sim
