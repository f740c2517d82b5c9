#include "sim/power_meter.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace pirsim::sim {

PowerMeter::PowerMeter(const CompiledStudy& study)
    : power_(study.array().analog()->power()),
      kind_(study.tracer()),
      tracer_(study.array().make_power_tracer(kind_)),
      memory_(power_.n_sensors()),
      row_(power_.n_sensors()) {}

void PowerMeter::measure(const std::vector<Actor>& actors, std::span<PowerSteps> powers) {
  std::ranges::fill(powers, PowerSteps{0});
  const auto n_present = std::ranges::count_if(actors, &Actor::present);
  // People hide one another, so only who is alone is remembered. The slow tracers are there to be compared with.
  if (kind_ != TracerKind::direct) return add(actors, powers);
  if (n_present == 0) return;
  if (n_present > 1) return measure_several(actors, powers);
  const auto alone = std::ranges::find_if(actors, &Actor::present);
  const Actor& actor = *alone;
  const auto person = static_cast<std::size_t>(alone - actors.begin());
  memory_.make_room_for(actors.size());
  if (const auto known = memory_.find(person, &actor.person().humanoid, actor.motion().outline()); !known.empty()) {
    std::ranges::transform(known, powers.begin(),
                           [](PostureMemory::Word word) { return std::bit_cast<PowerSteps>(word); });
    return;
  }
  add(actors, powers);
  std::ranges::transform(powers, row_.begin(),
                         [](PowerSteps power) { return std::bit_cast<PostureMemory::Word>(power); });
  memory_.remember(person, row_);
}

void PowerMeter::measure_several(const std::vector<Actor>& actors, std::span<PowerSteps> powers) {
  now_.clear();
  for (std::uint32_t i = 0; i < actors.size(); ++i) {
    if (actors[i].present()) now_.push_back({i, &actors[i].person().humanoid, actors[i].motion().outline()});
  }
  const auto same = [](const Figure& a, const Figure& b) {
    return a.person == b.person && a.humanoid == b.humanoid &&
           std::memcmp(&a.outline, &b.outline, sizeof a.outline) == 0;
  };
  if (!std::ranges::equal(now_, before_, same)) {
    add(actors, powers);
    powers_.assign(powers.begin(), powers.end());
    std::swap(before_, now_);
  }
  std::ranges::copy(powers_, powers.begin());
}

void PowerMeter::add(const std::vector<Actor>& actors, std::span<PowerSteps> powers) {
  trace(actors);
  for (const auto& [ray, solid] : hits_) {
    const BodyRadiance& radiance = *radiances_[solid / body::n_parts];
    powers[power_.sensor_of(ray)] += power_.power(ray, radiance[solid % body::n_parts]);
  }
}

void PowerMeter::explain(const std::vector<Actor>& actors, std::vector<PowerShare>& shares) {
  trace(actors);
  shares.clear();
  for (const auto& [ray, solid] : hits_) {
    const std::size_t person = solid / body::n_parts, part = solid % body::n_parts;
    shares.push_back(
        {ray, people_[person], static_cast<body::Part>(part), power_.power(ray, (*radiances_[person])[part])});
  }
}

void PowerMeter::trace(const std::vector<Actor>& actors) {
  solids_.clear();
  radiances_.clear();
  people_.clear();
  if (mannequins_.size() < actors.size()) mannequins_.resize(actors.size());
  for (std::uint32_t i = 0; i < actors.size(); ++i) {
    if (!actors[i].present()) continue;
    const auto posed = mannequins_[i].pose(actors[i].person().humanoid, actors[i].motion().outline());
    solids_.insert(solids_.end(), posed.begin(), posed.end());
    radiances_.push_back(&actors[i].person().radiance);
    people_.push_back(i);
  }
  tracer_->find_first(solids_, hits_);
}

}  // namespace pirsim::sim
