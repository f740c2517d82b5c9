#include "sim/zone_cache.hpp"

#include <algorithm>

#include "sim/solids.hpp"

namespace pirsim::sim {

ZoneCache::ZoneCache(const CompiledStudy& study)
    : array_(study.array()),
      kind_(study.tracer()),
      tracer_(array_.make_tracer(kind_)),
      memory_(ZoneSet(array_.channels().n_zones()).words().size() +
              ZoneSet(array_.channels().n_channels()).words().size()),
      power_meter_(array_.analog() != nullptr ? std::make_unique<PowerMeter>(study) : nullptr),
      activity_(array_.channels().n_zones()),
      person_zones_(array_.channels().n_zones()),
      person_channels_(array_.channels().n_channels()) {}

void ZoneCache::look(const std::vector<Actor>& actors, Exposure& exposure) {
  // The slow tracers are there to be compared with: they remember nothing and see all people at once.
  if (kind_ == TracerKind::direct) {
    look_at_each(actors, exposure);
  } else {
    look_at_all(actors, exposure.zones);
    array_.expose(exposure);
  }
  if (power_meter_) power_meter_->measure(actors, exposure.powers);
}

void ZoneCache::look_at_each(const std::vector<Actor>& actors, Exposure& exposure) {
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

void ZoneCache::look_at_all(const std::vector<Actor>& actors, ZoneSet& zones) {
  solids_.clear();
  for (const Actor& actor : actors) append_solids(actor, solids_);
  tracer_->trace(solids_, activity_);
  zones.clear();
  for (std::size_t zone = 0; zone < activity_.size(); ++zone) {
    if (activity_[zone] != 0) zones.insert(zone);
  }
}

std::span<const ZoneSet::Word> ZoneCache::row_of(std::size_t person, const Actor& actor) {
  const body::Humanoid& humanoid = actor.person().humanoid;
  const body::Outline outline = actor.motion().outline();
  if (const auto known = memory_.find(person, &humanoid, outline); !known.empty()) return known;
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
