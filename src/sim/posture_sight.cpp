#include "sim/posture_sight.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace pirsim::sim {

std::span<const PosedShape> PostureSolids::of(const Postures& postures, Number number) {
  if (number <= n_kept_) return {&kept_[(number - 1) * body::n_parts], body::n_parts};
  const std::uint32_t person = postures.person(number);
  if (mannequins_.size() <= person) mannequins_.resize(person + 1);
  const auto solids = mannequins_[person].pose(postures.humanoid(number), postures.outline(number));
  if (number == n_kept_ + 1 && number <= n_to_keep_) {
    kept_.insert(kept_.end(), solids.begin(), solids.end());
    ++n_kept_;
  }
  return solids;
}

void PostureSolids::shrink(std::size_t n) {
  n_kept_ = std::min(n_kept_, n);
  kept_.resize(n_kept_ * body::n_parts);
}

// What two studies have in common.

namespace {

bool same_rays(const RayBundle& a, const RayBundle& b, std::size_t begin, std::size_t end) {
  static_assert(sizeof(Ray) == 6 * sizeof(float));  // nothing but numbers: equal bytes are equal rays
  return std::memcmp(a.rays.data() + begin, b.rays.data() + begin, (end - begin) * sizeof(Ray)) == 0 &&
         std::memcmp(a.range.data() + begin, b.range.data() + begin, (end - begin) * sizeof(float)) == 0;
}

bool same_shape(const RayBundle& a, const RayBundle& b) {
  return a.zone_rays_begin == b.zone_rays_begin && a.cluster_zones_begin == b.cluster_zones_begin &&
         a.sensor_clusters_begin == b.sensor_clusters_begin;
}

struct Range {
  std::uint32_t begin, end;
};
Range zones_of(const RayBundle& bundle, std::size_t sensor) {
  return {bundle.cluster_zones_begin[bundle.sensor_clusters_begin[sensor]],
          bundle.cluster_zones_begin[bundle.sensor_clusters_begin[sensor + 1]]};
}
Range rays_of(const RayBundle& bundle, std::size_t sensor) {
  const auto [begin, end] = zones_of(bundle, sensor);
  return {bundle.zone_rays_begin[begin], bundle.zone_rays_begin[end]};
}

bool same_zones(const SensorArray& a, const SensorArray& b, std::size_t sensor) {
  const auto [begin, end] = rays_of(b.clipped(), sensor);
  return same_shape(a.clipped(), b.clipped()) && same_rays(a.clipped(), b.clipped(), begin, end) &&
         same_rays(a.rated(), b.rated(), begin, end);
}

bool same_power(const PowerModel& a, const PowerModel& b, std::size_t sensor) {
  if (!same_shape(a.clipped(), b.clipped()) || a.receivers_begin() != b.receivers_begin()) return false;
  const auto [begin, end] = rays_of(b.clipped(), sensor);
  if (!same_rays(a.clipped(), b.clipped(), begin, end)) return false;
  for (std::uint32_t ray = begin; ray < end; ++ray) {
    if (a.receiver_of(ray) != b.receiver_of(ray) || a.background(ray) != b.background(ray) ||
        a.rays().weights[ray] != b.rays().weights[ray]) {
      return false;
    }
  }
  return true;
}

}  // namespace

InCommon in_common(const CompiledStudy& first, const CompiledStudy& other) {
  const SensorArray &a = first.array(), &b = other.array();
  InCommon common{ZoneSet(b.clipped().n_zones()), std::vector<std::uint8_t>(b.n_sensors(), 0), true};
  for (std::size_t sensor = 0; sensor < b.n_sensors(); ++sensor) {
    bool is_same = a.n_sensors() == b.n_sensors() && a.is_analog(sensor) == b.is_analog(sensor);
    if (b.is_analog(sensor)) {
      is_same = is_same && same_power(a.analog()->power(), b.analog()->power(), sensor);
      common.sensors[sensor] = is_same ? 1 : 0;
    } else {
      is_same = is_same && same_zones(a, b, sensor);
      const auto [begin, end] = zones_of(b.clipped(), sensor);
      for (std::size_t zone = begin; zone < end && is_same; ++zone) common.zones.insert(zone);
    }
    common.everything = common.everything && is_same;
  }
  return common;
}

// Sight.

namespace {

/// Zones that nobody looks at: those in common, and those of analog sensors.
ZoneSet unasked(const SensorArray& array, const ZoneSet& in_common) {
  ZoneSet zones = in_common;
  for (std::size_t sensor = 0; sensor < array.n_sensors(); ++sensor) {
    const auto [begin, end] = zones_of(array.clipped(), sensor);
    for (std::size_t zone = begin; zone < end && array.is_analog(sensor); ++zone) zones.insert(zone);
  }
  return zones;
}

}  // namespace

PostureSight::PostureSight(const CompiledStudy& study)
    : PostureSight(
          study,
          {ZoneSet(study.array().clipped().n_zones()), std::vector<std::uint8_t>(study.array().n_sensors(), 0), false},
          nullptr) {}

PostureSight::PostureSight(const CompiledStudy& study, const InCommon& common, PostureSight* other)
    : study_(study),
      common_(common),
      other_(other),
      zones_(common.zones.size()),
      n_zone_words_(zones_.words().size()),
      n_words_(n_zone_words_),
      known_(1, 1) {
  const SensorArray& array = study.array();
  const ZoneSet others = unasked(array, common.zones);
  rated_ = without(array.rated(), others);
  clipped_ = without(array.clipped(), others);
  if (!clipped_.rays.empty()) tracer_ = rt::make_tracer(study.tracer(), {&array.room(), &rated_, &clipped_});
  if (array.analog() != nullptr) {
    const PowerModel& power = array.analog()->power();
    for (std::size_t sensor = 0; sensor < array.n_sensors(); ++sensor) {
      const auto [first, last] = zones_of(power.clipped(), sensor);
      Analog analog{power.receivers_begin()[sensor], power.receivers_begin()[sensor + 1],
                    ZoneSet(power.clipped().n_zones())};
      for (std::size_t zone = first; zone < last; ++zone) analog.zones.insert(zone);
      analog_.push_back(std::move(analog));
    }
    n_touched_words_ = ZoneSet(power.clipped().n_zones()).words().size();
    powers_.resize(power.n_receivers());
    together_.resize(power.n_receivers());
    n_words_ += n_touched_words_ + powers_.size();
  }
  rows_.resize(n_words_, 0);
}

std::span<PostureSight::Word> PostureSight::row(const Postures& postures, PostureSolids& solids, Number number) {
  if (known_.size() <= number) {
    known_.resize(postures.size() + 1, 0);
    rows_.resize(known_.size() * n_words_);
  }
  const std::span<Word> row = std::span(rows_).subspan(number * n_words_, n_words_);
  if (known_[number] == 0) look(postures, solids, number, row);
  known_[number] = 1;
  return row;
}

PosturePowers& PostureSight::meter_of(std::uint32_t person) {
  if (meters_.size() <= person) meters_.resize(person + 1);
  if (!meters_[person]) meters_[person] = std::make_unique<PosturePowers>(study_, common_.sensors);
  return *meters_[person];
}

void PostureSight::look(const Postures& postures, PostureSolids& solids, Number number, std::span<Word> row) {
  zones_.clear();
  if (tracer_) tracer_->add(postures.person(number), solids.of(postures, number), zones_);
  std::ranges::copy(zones_.words(), row.begin());
  const std::span<Word> touched = row.subspan(n_zone_words_, n_touched_words_);
  const std::span<Word> powers = row.subspan(n_zone_words_ + n_touched_words_);
  if (!analog_.empty()) {
    PosturePowers& meter = meter_of(postures.person(number));
    meter.measure(postures, {&number, 1}, powers_);
    std::ranges::copy(meter.touched().words(), touched.begin());
    std::ranges::transform(powers_, powers.begin(), [](PowerSteps power) { return std::bit_cast<Word>(power); });
  }
  if (other_ == nullptr) return;
  const std::span<const Word> seen = other_->row(postures, solids, number);
  for (std::size_t i = 0; i < n_zone_words_; ++i) row[i] |= common_.zones.words()[i] & seen[i];
  for (std::size_t sensor = 0; sensor < analog_.size(); ++sensor) {
    if (common_.sensors[sensor] == 0) continue;
    const auto& [begin, end, zones, crowd] = analog_[sensor];
    for (std::size_t i = 0; i < n_touched_words_; ++i) touched[i] |= zones.words()[i] & seen[n_zone_words_ + i];
    for (std::uint32_t i = begin; i < end; ++i) powers[i] = seen[n_zone_words_ + n_touched_words_ + i];
  }
}

std::span<const PowerSteps> PostureSight::powers(const Postures& postures, PostureSolids& solids, Number number) {
  if (analog_.empty()) return {};
  const std::span<const Word> words = row(postures, solids, number).subspan(n_zone_words_ + n_touched_words_);
  std::ranges::transform(words, powers_.begin(), [](Word word) { return std::bit_cast<PowerSteps>(word); });
  return powers_;
}

bool PostureSight::apart(const Postures& postures, PostureSolids& solids, std::span<const Number> people,
                         const ZoneSet& zones) {
  occupied_.assign(n_touched_words_, 0);
  for (const Number number : people) {
    const std::span<const Word> touched = row(postures, solids, number).subspan(n_zone_words_, n_touched_words_);
    for (std::size_t i = 0; i < n_touched_words_; ++i) {
      const Word here = touched[i] & zones.words()[i];
      if ((occupied_[i] & here) != 0) return false;
      occupied_[i] |= here;
    }
  }
  return true;
}

void PostureSight::measure_together(const Postures& postures, std::span<const Number> people, std::size_t sensor,
                                    std::span<PowerSteps> powers) {
  if (other_ != nullptr && common_.sensors[sensor] != 0)
    return other_->measure_together(postures, people, sensor, powers);
  auto& [begin, end, zones, crowd] = analog_[sensor];
  if (!crowd) {
    std::vector<std::uint8_t> others(analog_.size(), 1);
    others[sensor] = 0;
    crowd.emplace(study_, others);
  }
  crowd->measure(postures, people, together_);
  for (std::uint32_t i = begin; i < end; ++i) powers[i] = together_[i];
}

std::span<const PowerSteps> PostureSight::powers(const Postures& postures, PostureSolids& solids,
                                                 std::span<const Number> people, std::span<const PowerSteps> there) {
  if (analog_.empty()) return {};
  for (const Number number : people) (void)row(postures, solids, number);  // uses powers_
  std::ranges::fill(powers_, 0);
  const std::size_t first_power = n_zone_words_ + n_touched_words_;
  for (std::size_t sensor = 0; sensor < analog_.size(); ++sensor) {
    const Analog& analog = analog_[sensor];
    if (analog.begin == analog.end) continue;
    if (common_.sensors[sensor] != 0 && !there.empty()) {
      for (std::uint32_t i = analog.begin; i < analog.end; ++i) powers_[i] = there[i];
    } else if (!apart(postures, solids, people, analog.zones)) {
      measure_together(postures, people, sensor, powers_);
    } else {
      for (const Number number : people) {
        const std::span<const Word> words = row(postures, solids, number).subspan(first_power);
        for (std::uint32_t i = analog.begin; i < analog.end; ++i) powers_[i] += std::bit_cast<PowerSteps>(words[i]);
      }
    }
  }
  return powers_;
}

void PostureSight::shrink(std::size_t n_postures) {
  for (const auto& meter : meters_) {
    if (meter) meter->shrink(n_postures);
  }
  for (Analog& analog : analog_) {
    if (analog.crowd) analog.crowd->shrink(n_postures);
  }
  if (known_.size() <= n_postures + 1) return;
  known_.resize(n_postures + 1);
  rows_.resize(known_.size() * n_words_);
}

}  // namespace pirsim::sim
