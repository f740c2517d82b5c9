#include "engine/sim/observer.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "engine/sim/run_state.hpp"

namespace pirsim::sim {

void append_solids(const body::Humanoid& humanoid, const body::Posture& posture, std::vector<PosedShape>& solids) {
  for (std::size_t i = 0; i < body::n_parts; ++i) solids.push_back(place(humanoid.solids()[i], posture[i]));
}

void append_solids(const Actor& actor, std::vector<PosedShape>& solids) {
  if (actor.present()) append_solids(actor.person().humanoid, actor.motion().posture(), solids);
}

std::vector<BeamSegment> beams_of(const Model& model, const State& state, std::size_t sensor) {
  const RayBundle& bundle = model.rays();
  const std::vector<float> range = model.compiled().array().range(state.run_state().crowd.doors().steps());
  std::vector<PosedShape> solids;
  for (const Actor& actor : state.run_state().crowd.actors()) append_solids(actor, solids);
  std::vector<BeamSegment> beams;
  for (auto i = bundle.first_ray(sensor); i < bundle.first_ray(sensor + 1); ++i) {
    const Ray& ray = bundle.rays[i];
    float reach = range[i];
    bool sees_person = false;
    for (const PosedShape& solid : solids) {
      if (const auto distance = entry_distance(ray, solid, reach)) {
        reach = *distance;
        sees_person = true;
      }
    }
    beams.push_back({Vec3(ray.origin), Vec3(ray.origin + reach * ray.direction), sees_person});
  }
  return beams;
}

namespace {

// A power of two. Few at first, so that what a single run looks up stays in the cache.
constexpr std::size_t fewest_buckets = 4096;

/// By bytes: numbers that are equal but not the same may give another posture.
bool is_same(const body::Outline& a, const body::Outline& b) noexcept { return std::memcmp(&a, &b, sizeof a) == 0; }

/// Most people are seen by few sensors.
std::size_t usual_parts(const SensorArray& array) {
  constexpr std::size_t most = 16;
  const auto n_words = [](std::size_t n_bits) { return ZoneSet(n_bits).words().size(); };
  return std::min(most, n_words(array.channels().n_zones()) + n_words(array.channels().n_channels()));
}

}  // namespace

PostureIndex::PostureIndex(std::size_t n_expected) {
  // Address space only, until it is used: nothing is allocated while a study runs.
  buckets_.reserve(2 * n_expected);
  buckets_.resize(fewest_buckets, 0);
  keys_.reserve(n_expected);
  successors_.reserve(n_expected + 1);
  successors_.push_back(0);
}

void PostureIndex::make_room_for(std::size_t n_people) {
  if (last_.size() < n_people) last_.resize(n_people, 0);
}

std::size_t PostureIndex::hash(const Key& key) noexcept {
  // Four multiplicative hashes side by side, since each step waits for its multiplication.
  constexpr Word factor = 0x9E3779B97F4A7C15U;
  std::array<Word, 4> lanes{1, 2, 3, 4};
  for (std::size_t i = 0; i < key.size(); ++i) {
    Word& lane = lanes[i % lanes.size()];
    lane = (lane ^ key[i]) * factor;
    lane ^= lane >> 32U;
  }
  Word all = 0;
  for (const Word lane : lanes) {
    all = (std::rotl(all, 23) ^ lane) * factor;
    all ^= all >> 32U;
  }
  return static_cast<std::size_t>(all);
}

std::size_t PostureIndex::bucket_of(const Key& key) const noexcept {
  std::size_t bucket = hash(key) % buckets_.size();
  while (buckets_[bucket] != 0 && keys_[buckets_[bucket] - 1] != key) bucket = (bucket + 1) % buckets_.size();
  return bucket;
}

void PostureIndex::follow(std::size_t person, Number number) noexcept {
  successors_[last_[person]] = number;
  last_[person] = number;
}

PostureIndex::Number PostureIndex::find(std::size_t person, std::uint64_t body, const body::Outline& outline,
                                        std::uint64_t doors) noexcept {
  static_assert(sizeof(body::Outline) % sizeof(Word) == 0);
  std::memcpy(wanted_.data(), &outline, sizeof outline);
  wanted_[n_outline_words] = body;
  wanted_.back() = doors;
  // As a rule what came last time comes again; it lies just behind in memory.
  if (const Number next = successors_[last_[person]]; next != 0 && keys_[next - 1] == wanted_) {
    last_[person] = next;
    return next;
  }
  free_bucket_ = bucket_of(wanted_);
  const Number known = buckets_[free_bucket_];
  if (known != 0) follow(person, known);
  return known;
}

void PostureIndex::spread() noexcept {
  buckets_.assign(2 * buckets_.size(), 0);
  for (Number number = 1; number <= size(); ++number) buckets_[bucket_of(keys_[number - 1])] = number;
  free_bucket_ = bucket_of(wanted_);
}

PostureIndex::Number PostureIndex::remember(std::size_t person) {
  if (2 * (size() + 1) > buckets_.size()) spread();
  const auto number = static_cast<Number>(size() + 1);
  keys_.push_back(wanted_);
  buckets_[free_bucket_] = number;
  successors_.push_back(0);
  follow(person, number);
  return number;
}

body::Outline PostureIndex::outline(Number number) const noexcept {
  body::Outline outline;
  std::memcpy(static_cast<void*>(&outline), keys_[number - 1].data(), sizeof outline);
  return outline;
}

void PostureIndex::shrink(std::size_t n) noexcept {
  if (n >= size()) return;
  // Last in, first out: what is left lies where it lay before the others came.
  for (std::size_t number = size(); number > n; --number) buckets_[bucket_of(keys_[number - 1])] = 0;
  keys_.resize(n);
  successors_.resize(n + 1);
  for (auto* numbers : {&successors_, &last_}) {
    std::ranges::replace_if(
        *numbers, [n](Number number) { return number > n; }, Number{0});
  }
}

void PostureIndex::forget_all() noexcept {
  buckets_.assign(fewest_buckets, 0);
  keys_.clear();
  successors_.assign(1, 0);
  std::ranges::fill(last_, Number{0});
  free_bucket_ = bucket_of(wanted_);
}

PowerMeter::PowerMeter(const SensorArray& array, TracerKind kind)
    : PowerMeter(array.analog()->power(), array.make_power_tracer(kind), most_postures) {}

PowerMeter::PowerMeter(const PowerModel& power, std::unique_ptr<rt::Tracer> tracer, std::size_t n_remembered)
    : power_(power),
      tracer_(std::move(tracer)),
      alone_(power_.n_receivers(), tracer_->may_be_remembered() ? n_remembered : 0),
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

bool PowerMeter::follow(const std::vector<Actor>& actors, std::span<const LeafStep> leaves) {
  has_changed_ = false;
  turn(leaves);
  follow(actors);
  return has_changed_;
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
    if (is_new) {
      const BodyRadiance radiance = power_.radiance_of(person);
      figure = {true, &person.humanoid, body::n_parts, radiance, surfaces_of(radiance), {}};
    }
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
  has_changed_ = has_changed_ || !changes_.empty();
  for (const auto& [ray, before, after] : changes_) {
    powers_[power_.receiver_of(ray)] += power(ray, after) - power(ray, before);
  }
}

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
  if (leaves_.turn(leaves)) {
    tracer_->turn_leaves(leaves);
    if (array_.has_beams()) broken_ = array_.broken_by(leaves);
  }
  exposure.zones.clear();
  for (const std::uint32_t zone : broken_) exposure.zones.insert(zone);
  exposure.channels.clear();
  if (!broken_.empty()) array_.channels().add_channels(exposure.zones, exposure.channels);
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
