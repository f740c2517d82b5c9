#include "sim/lookout.hpp"

#include <algorithm>

#include "sim/state.hpp"

namespace pirsim::sim {

Lookout::Lookout(const Model& model)
    : detector_(model.detector()),
      kind_(model.tracer()),
      tracer_(model.make_tracer()),
      memory_(ZoneSet(detector_.n_zones()).words().size() + ZoneSet(detector_.n_channels()).words().size()),
      power_meter_(model.analog() != nullptr ? std::make_unique<PowerMeter>(model) : nullptr),
      activity_(detector_.n_zones()),
      person_zones_(detector_.n_zones()),
      person_channels_(detector_.n_channels()) {}

void Lookout::look(const std::vector<Actor>& actors, ZoneSet& zones, ZoneSet& channels) {
  zones.clear();
  channels.clear();
  // The slow tracers are there to be compared with: they remember nothing and see all people at once.
  if (kind_ != rt::TracerKind::direct) {
    look_at_all(actors, zones, channels);
    return;
  }
  memory_.make_room_for(actors.size());
  if (mannequins_.size() < actors.size()) mannequins_.resize(actors.size());
  const std::size_t n_zone_words = zones.words().size();
  for (std::size_t person = 0; person < actors.size(); ++person) {
    if (!actors[person].present()) continue;
    const std::span<const ZoneSet::Word> row = row_of(person, actors[person]);
    zones.add(row.first(n_zone_words));
    channels.add(row.subspan(n_zone_words));
  }
}

void Lookout::look_at_all(const std::vector<Actor>& actors, ZoneSet& zones, ZoneSet& channels) {
  solids_.clear();
  for (const Actor& actor : actors) append_solids(actor, solids_);
  tracer_->trace(solids_, activity_);
  for (std::size_t zone = 0; zone < activity_.size(); ++zone) {
    if (activity_[zone] != 0) zones.insert(zone);
  }
  detector_.add_channels(zones, channels);
}

std::span<const ZoneSet::Word> Lookout::row_of(std::size_t person, const Actor& actor) {
  const body::Humanoid& humanoid = actor.person().humanoid;
  const body::Outline outline = actor.motion().outline();
  if (const auto known = memory_.find(person, &humanoid, outline); !known.empty()) return known;
  person_zones_.clear();
  person_channels_.clear();
  tracer_->add(person, mannequins_[person].pose(humanoid, outline), person_zones_);
  detector_.add_channels(person_zones_, person_channels_);
  row_.clear();
  for (const ZoneSet* set : {&person_zones_, &person_channels_}) {
    row_.insert(row_.end(), set->words().begin(), set->words().end());
  }
  memory_.remember(person, row_);
  return row_;
}

}  // namespace pirsim::sim
