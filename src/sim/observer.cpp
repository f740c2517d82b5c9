#include "sim/observer.hpp"

#include <algorithm>

namespace pirsim::sim {
namespace {

std::size_t n_words(std::size_t n_bits) { return ZoneSet(n_bits).words().size(); }

PostureMemory memory_for(const rt::Tracer* tracer, std::size_t words_per_row) {
  return PostureMemory(words_per_row,
                       tracer != nullptr && tracer->may_be_remembered() ? PostureMemory::most_entries : 0);
}

}  // namespace

Observer::Observer(const SensorArray& array, TracerKind kind, ZonesOf whose)
    : array_(array),
      tracer_(array.make_tracer(kind, whose)),
      memory_(memory_for(tracer_.get(), n_words(array.channels().n_zones()) + n_words(array.channels().n_channels()))),
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
    const std::span<const ZoneSet::Word> row = row_of(person, actors[person]);
    exposure.zones.add(row.first(n_zone_words));
    exposure.channels.add(row.subspan(n_zone_words));
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

std::span<const ZoneSet::Word> Observer::row_of(std::size_t person, const Actor& actor) {
  const body::Humanoid& humanoid = actor.person().humanoid;
  const body::Outline outline = actor.motion().outline();
  if (const auto known = memory_.find(person, &humanoid, outline, leaves_.number()); !known.empty()) return known;
  person_zones_.clear();
  person_channels_.clear();
  tracer_->add(person, mannequins_[person].pose(humanoid, outline), person_zones_);
  array_.channels().add_channels(person_zones_, person_channels_);
  row_.clear();
  for (const ZoneSet* set : {&person_zones_, &person_channels_}) {
    row_.insert(row_.end(), set->words().begin(), set->words().end());
  }
  memory_.remember(person, row_);
  return row_;
}

}  // namespace pirsim::sim
