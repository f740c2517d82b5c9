#include "sim/observer.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace pirsim::sim {
namespace {

std::size_t n_words(std::size_t n_bits) { return ZoneSet(n_bits).words().size(); }

PostureMemory memory_for(const rt::Tracer& tracer, std::size_t words_per_row) {
  return PostureMemory(words_per_row, tracer.may_be_remembered() ? PostureMemory::most_entries : 0);
}

}  // namespace

PowerMeter::PowerMeter(const SensorArray& array, TracerKind kind)
    : power_(array.analog()->power()),
      tracer_(array.make_power_tracer(kind)),
      memory_(memory_for(*tracer_, power_.n_receivers())),
      row_(power_.n_receivers()) {}

bool PowerMeter::is_same(const Figure& a, const Figure& b) noexcept {
  return a.person == b.person && a.humanoid == b.humanoid && std::memcmp(&a.outline, &b.outline, sizeof a.outline) == 0;
}

void PowerMeter::measure(const std::vector<Actor>& actors, std::span<PowerSteps> powers) {
  now_.clear();
  for (std::uint32_t i = 0; i < actors.size(); ++i) {
    if (actors[i].present()) now_.push_back({i, &actors[i].person().humanoid, actors[i].motion().outline()});
  }
  if (now_.empty()) {
    std::ranges::fill(powers, PowerSteps{0});
    return;
  }
  // People hide one another: of several at once no more is remembered than how they stood last.
  if (now_.size() > 1) {
    if (!tracer_->may_be_remembered() || !std::ranges::equal(now_, before_, is_same)) {
      trace(actors);
      powers_.resize(powers.size());
      add_up(powers_);
      std::swap(before_, now_);
    }
    std::ranges::copy(powers_, powers.begin());
    return;
  }
  const auto& [person, humanoid, outline] = now_.front();
  memory_.make_room_for(actors.size());
  if (const auto known = memory_.find(person, humanoid, outline); !known.empty()) {
    std::ranges::transform(known, powers.begin(),
                           [](PostureMemory::Word word) { return std::bit_cast<PowerSteps>(word); });
    return;
  }
  trace(actors);
  add_up(powers);
  std::ranges::transform(powers, row_.begin(),
                         [](PowerSteps power) { return std::bit_cast<PostureMemory::Word>(power); });
  memory_.remember(person, row_);
}

void PowerMeter::measure(std::span<const PosedShape> solids, const BodyRadiance& radiance,
                         std::span<PowerSteps> powers) {
  radiances_.assign(1, &radiance);
  tracer_->find_first(solids, hits_);
  add_up(powers);
}

void PowerMeter::explain(const std::vector<Actor>& actors, std::vector<PowerShare>& shares) {
  trace(actors);
  std::vector<std::uint32_t> people;
  for (std::uint32_t i = 0; i < actors.size(); ++i) {
    if (actors[i].present()) people.push_back(i);
  }
  shares.clear();
  for (const auto& [ray, solid] : hits_) {
    const std::size_t person = solid / body::n_parts, part = solid % body::n_parts;
    shares.push_back(
        {ray, people[person], static_cast<body::Part>(part), power_.power(ray, (*radiances_[person])[part])});
  }
}

void PowerMeter::trace(const std::vector<Actor>& actors) {
  solids_.clear();
  radiances_.clear();
  if (mannequins_.size() < actors.size()) mannequins_.resize(actors.size());
  for (std::size_t i = 0; i < actors.size(); ++i) {
    if (!actors[i].present()) continue;
    const auto posed = mannequins_[i].pose(actors[i].person().humanoid, actors[i].motion().outline());
    solids_.insert(solids_.end(), posed.begin(), posed.end());
    radiances_.push_back(&actors[i].person().radiance);
  }
  tracer_->find_first(solids_, hits_);
}

void PowerMeter::add_up(std::span<PowerSteps> powers) const {
  std::ranges::fill(powers, PowerSteps{0});
  for (const auto& [ray, solid] : hits_) {
    const BodyRadiance& radiance = *radiances_[solid / body::n_parts];
    powers[power_.receiver_of(ray)] += power_.power(ray, radiance[solid % body::n_parts]);
  }
}

Observer::Observer(const SensorArray& array, TracerKind kind)
    : array_(array),
      tracer_(array.make_tracer(kind)),
      memory_(memory_for(*tracer_, n_words(array.channels().n_zones()) + n_words(array.channels().n_channels()))),
      power_meter_(array.analog() != nullptr ? std::make_unique<PowerMeter>(array, kind) : nullptr),
      person_zones_(array.channels().n_zones()),
      person_channels_(array.channels().n_channels()) {}

void Observer::look(const std::vector<Actor>& actors, Exposure& exposure) {
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
  if (power_meter_) power_meter_->measure(actors, exposure.powers);
}

void Observer::look(std::span<const PosedShape> solids, const BodyRadiance& radiance, Exposure& exposure) {
  exposure.zones.clear();
  tracer_->add(0, solids, exposure.zones);
  array_.expose(exposure);
  if (power_meter_) power_meter_->measure(solids, radiance, exposure.powers);
}

std::span<const ZoneSet::Word> Observer::row_of(std::size_t person, const Actor& actor) {
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
