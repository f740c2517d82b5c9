#include "sim/power_meter.hpp"

#include <algorithm>
#include <cstring>

namespace pirsim::sim {
namespace {

/// By bytes: numbers that are equal but not the same may give another posture.
bool is_same(const body::Outline& a, const body::Outline& b) noexcept { return std::memcmp(&a, &b, sizeof a) == 0; }

}  // namespace

PowerMeter::PowerMeter(const SensorArray& array, TracerKind kind)
    : power_(array.analog()->power()),
      tracer_(array.make_power_tracer(kind)),
      alone_(power_.n_receivers(), tracer_->may_be_remembered() ? most_postures : 0),
      powers_(power_.n_receivers(), 0) {}

std::array<std::uint8_t, body::n_parts> surfaces_of(const BodyRadiance& radiance) noexcept {
  std::array<std::uint8_t, body::n_parts> surfaces{};
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    surfaces[i] = static_cast<std::uint8_t>(std::ranges::find(radiance, radiance[i]) - radiance.begin());
  }
  return surfaces;
}

/// What people hid or showed before the leaves turned doesn't count any more.
void PowerMeter::turn(std::span<const LeafStep> leaves) {
  if (!leaves_.turn(leaves)) return;
  moved_.clear();
  for (std::size_t i = 0; i < figures_.size(); ++i) {
    if (figures_[i].is_there) moved_.push_back({i, {}, {}});
  }
  take_away();
  tracer_->turn_leaves(leaves);
}

void PowerMeter::measure(const std::vector<Actor>& actors, std::span<const LeafStep> leaves,
                         std::span<PowerSteps> powers) {
  turn(leaves);
  const auto first = std::ranges::find_if(actors, &Actor::present);
  const bool is_one = first != actors.end() && std::find_if(first + 1, actors.end(), [](const Actor& actor) {
                                                 return actor.present();
                                               }) == actors.end();
  if (!is_one) {
    follow(actors);
    std::ranges::copy(powers_, powers.begin());
    return;
  }
  const auto person = static_cast<std::size_t>(first - actors.begin());
  alone_.make_room_for(actors.size());
  const auto known = alone_.find(person, &first->person().humanoid, first->motion().outline(), leaves_.number());
  if (known) {
    std::ranges::copy(*known, powers.begin());
    return;
  }
  follow(actors);
  std::ranges::copy(powers_, powers.begin());
  alone_.remember(person, powers_);
}

void PowerMeter::measure(std::span<const PosedShape> solids, const BodyRadiance& radiance,
                         std::span<PowerSteps> powers) {
  moved_.clear();
  for (std::size_t i = 0; i < figures_.size(); ++i) {
    const Figure& figure = figures_[i];
    const bool stays =
        i == 0 && figure.humanoid == nullptr && figure.radiance == radiance && figure.n_solids == solids.size();
    if (figure.is_there && !stays) moved_.push_back({i, {}, {}});
  }
  take_away();
  figures_.resize(std::max<std::size_t>(figures_.size(), 1));
  if (!figures_.front().is_there)
    figures_.front() = {true, nullptr, solids.size(), radiance, surfaces_of(radiance), {}};
  moved_.assign(1, {0, solids, std::span(figures_.front().surfaces).first(solids.size())});
  follow(moved_);
  std::ranges::copy(powers_, powers.begin());
}

void PowerMeter::explain(const std::vector<Actor>& actors, std::span<const LeafStep> leaves,
                         std::vector<PowerShare>& shares) {
  turn(leaves);
  follow(actors);
  shares.clear();
  const std::vector<rt::SolidId> hits = tracer_->first_hits();
  for (std::uint32_t ray = 0; ray < hits.size(); ++ray) {
    if (hits[ray] == rt::no_solid) continue;
    shares.push_back({ray, hits[ray].person, static_cast<body::Part>(hits[ray].solid), power(ray, hits[ray])});
  }
}

void PowerMeter::follow(const std::vector<Actor>& actors) {
  // Of who is another person now, or left with the last run, nothing stays.
  moved_.clear();
  for (std::size_t i = 0; i < figures_.size(); ++i) {
    const bool stays = i < actors.size() && actors[i].present() && figures_[i].humanoid == &actors[i].person().humanoid;
    if (figures_[i].is_there && !stays) moved_.push_back({i, {}, {}});
  }
  take_away();
  moved_.clear();
  figures_.resize(std::max(figures_.size(), actors.size()));
  mannequins_.resize(figures_.size());
  for (std::size_t i = 0; i < actors.size(); ++i) {
    if (!actors[i].present()) continue;
    const PersonModel& person = actors[i].person();
    Figure& figure = figures_[i];
    const body::Outline outline = actors[i].motion().outline();
    const bool is_new = !figure.is_there;
    if (!is_new && tracer_->may_be_remembered() && is_same(outline, figure.outline)) continue;
    if (is_new) figure = {true, &person.humanoid, body::n_parts, person.radiance, surfaces_of(person.radiance), {}};
    figure.outline = outline;
    moved_.push_back({i, mannequins_[i].pose(person.humanoid, outline), figure.surfaces});
  }
  if (!moved_.empty()) follow(moved_);
}

void PowerMeter::take_away() {
  if (moved_.empty()) return;
  follow(moved_);
  for (const rt::Moved& gone : moved_) figures_[gone.person] = {};
}

void PowerMeter::follow(std::span<const rt::Moved> moved) {
  tracer_->follow(moved, changes_);
  for (const auto& [ray, before, after] : changes_) {
    powers_[power_.receiver_of(ray)] += power(ray, after) - power(ray, before);
  }
}

}  // namespace pirsim::sim
