#include "sim/observer.hpp"

#include <algorithm>

namespace pirsim::sim {
namespace {

/// Most people are seen by few sensors.
std::size_t usual_parts(const SensorArray& array) {
  constexpr std::size_t most = 16;
  const auto n_words = [](std::size_t n_bits) { return ZoneSet(n_bits).words().size(); };
  return std::min(most, n_words(array.channels().n_zones()) + n_words(array.channels().n_channels()));
}

}  // namespace

Observer::Observer(const SensorArray& array, TracerKind kind, ZonesOf whose)
    : array_(array),
      tracer_(array.make_tracer(kind, whose)),
      memory_(usual_parts(array), tracer_ && tracer_->may_be_remembered() ? most_postures : 0),
      power_meter_(array.analog() != nullptr ? std::make_unique<PowerMeter>(array, kind) : nullptr),
      person_zones_(array.channels().n_zones()),
      person_channels_(array.channels().n_channels()) {}

void Observer::look(const std::vector<Actor>& actors, std::span<const LeafStep> leaves, Exposure& exposure) {
  if (tracer_) look_at_zones(actors, leaves, exposure);
  if (power_meter_) power_meter_->measure(actors, leaves, exposure.powers);
}

void Observer::look_at_zones(const std::vector<Actor>& actors, std::span<const LeafStep> leaves, Exposure& exposure) {
  if (leaves_.turn(leaves)) tracer_->turn_leaves(leaves);
  exposure.zones.clear();
  exposure.channels.clear();
  memory_.make_room_for(actors.size());
  if (mannequins_.size() < actors.size()) mannequins_.resize(actors.size());
  const std::size_t n_zone_words = exposure.zones.words().size();
  for (std::size_t person = 0; person < actors.size(); ++person) {
    if (!actors[person].present()) continue;
    for (const auto& [at, word] : seen_of(person, actors[person])) {
      (at < n_zone_words ? exposure.zones.words()[at] : exposure.channels.words()[at - n_zone_words]) |= word;
    }
  }
  if (array_.polarity()) array_.polarity()->add_up(exposure.zones, exposure.sums);
}

void Observer::look(std::span<const PosedShape> solids, const BodyRadiance& radiance, Exposure& exposure) {
  if (tracer_) {
    exposure.zones.clear();
    tracer_->add(0, solids, exposure.zones);
    array_.expose(exposure);
  }
  if (power_meter_) power_meter_->measure(solids, radiance, exposure.powers);
}

Observer::Parts Observer::seen_of(std::size_t person, const Actor& actor) {
  const body::Humanoid& humanoid = actor.person().humanoid;
  const body::Outline outline = actor.motion().outline();
  if (const auto known = memory_.find(person, &humanoid, outline, leaves_.number()); known) return *known;
  person_zones_.clear();
  person_channels_.clear();
  tracer_->add(person, mannequins_[person].pose(humanoid, outline), person_zones_);
  array_.channels().add_channels(person_zones_, person_channels_);
  parts_.clear();
  std::size_t at = 0;
  for (const ZoneSet* set : {&person_zones_, &person_channels_}) {
    for (const ZoneSet::Word word : set->words()) {
      if (word != 0) parts_.push_back({at, word});
      ++at;
    }
  }
  memory_.remember(person, parts_);
  return parts_;
}

}  // namespace pirsim::sim
