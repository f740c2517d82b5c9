#include "engine/pir/zone_motion.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "pirsim/geometry.hpp"

namespace pirsim::pir {

Channels::Channels(const RayBundle& bundle, ChangePer change_per) : n_sensors_(bundle.n_sensors()) {
  const bool per_cluster = change_per == ChangePer::cluster;
  n_channels_ = per_cluster ? bundle.n_clusters() : bundle.n_zones();
  for (std::uint32_t sensor = 0; sensor < n_sensors_; ++sensor) {
    ZoneSet mask(n_channels_);
    for (std::uint32_t c = bundle.sensor_clusters_begin[sensor]; c < bundle.sensor_clusters_begin[sensor + 1]; ++c) {
      for (std::uint32_t z = bundle.cluster_zones_begin[c]; z < bundle.cluster_zones_begin[c + 1]; ++z) {
        channel_of_zone_.push_back(per_cluster ? c : z);
        mask.insert(channel_of_zone_.back());
      }
    }
    sensor_masks_.insert(sensor_masks_.end(), mask.words().begin(), mask.words().end());
  }
}

void Channels::add_channels(const ZoneSet& zones, ZoneSet& channels) const noexcept {
  std::size_t first = 0;
  for (ZoneSet::Word word : zones.words()) {
    for (; word != 0; word &= word - 1) {
      channels.insert(channel_of_zone_[first + static_cast<std::size_t>(std::countr_zero(word))]);
    }
    first += ZoneSet::bits_per_word;
  }
}

void Channels::mark(std::span<const ZoneSet::Word> before, std::span<const ZoneSet::Word> after,
                    std::span<const ZoneSet::Word> watched, std::span<std::uint8_t> bits) const noexcept {
  for (std::size_t i = 0; i < before.size(); ++i) {
    const ZoneSet::Word changed = before[i] ^ after[i];
    if (changed == 0) continue;
    for (std::size_t sensor = 0; sensor < n_sensors_; ++sensor) {
      if ((changed & watched[sensor * before.size() + i]) != 0) bits[sensor] |= 1U;
    }
  }
}

PolarityFilter::PolarityFilter(const SceneSpec& scene, const DualPolaritySpec& spec, std::size_t n_levels,
                               double tick_s)
    : threshold_(spec.threshold),
      fast_share_(-std::expm1(-2.0 * pi * spec.low_pass_hz * tick_s)),
      slow_share_(-std::expm1(-2.0 * pi * spec.high_pass_hz * tick_s)),
      filters_(scene.sensors.size()) {
  for (std::uint32_t sensor = 0; sensor < scene.sensors.size(); ++sensor) {
    for (std::size_t level = 0; level < n_levels; ++level) {
      for (const ClusterSpec& cluster : scene.sensor_models.at(scene.sensors[sensor].model).clusters) {
        for (const ZoneSpec& zone : cluster.zones) {
          weight_.push_back(zone.polarity / static_cast<double>(n_levels));
          sensor_.push_back(sensor);
        }
      }
    }
  }
}

void PolarityFilter::begin_run(std::span<const double> rest) noexcept {
  for (std::size_t s = 0; s < filters_.size(); ++s) filters_[s] = {rest[s], rest[s]};
}

void PolarityFilter::add_up(const ZoneSet& zones, std::span<double> sums) const noexcept {
  std::ranges::fill(sums, 0.0);
  std::size_t first = 0;
  for (ZoneSet::Word word : zones.words()) {
    for (; word != 0; word &= word - 1) {
      const std::size_t zone = first + static_cast<std::size_t>(std::countr_zero(word));
      sums[sensor_[zone]] += weight_[zone];
    }
    first += ZoneSet::bits_per_word;
  }
}

void PolarityFilter::tick(std::span<const double> sums, std::span<std::uint8_t> triggers) noexcept {
  for (std::size_t s = 0; s < filters_.size(); ++s) {
    Filter& filter = filters_[s];
    filter.fast += fast_share_ * (sums[s] - filter.fast);
    filter.slow += slow_share_ * (filter.fast - filter.slow);
    if (std::abs(filter.fast - filter.slow) > threshold_) triggers[s] = 1;
  }
}

namespace {

constexpr double high_pass_hz = 0.3;          // assumed (0.1-0.5): corner of a common amplifier, as in dual_polarity
constexpr double no_difference = 1.0 / 64.0;  // of a zone; a filter that is so near has settled

}  // namespace

SoftEdges::SoftEdges(const Channels& detector, std::size_t n_levels, const SoftEdgesSpec& spec, int ticks_per_window,
                     double tick_s)
    : detector_(&detector),
      spec_(spec),
      n_levels_(n_levels),
      ticks_per_window_(ticks_per_window),
      n_words_(ZoneSet(detector.n_channels()).words().size()),
      watched_(detector.sensor_masks().begin(), detector.sensor_masks().end()),
      changed_(detector.n_channels()),
      forgets_(-std::expm1(-2.0 * pi * high_pass_hz * tick_s)),
      usual_(detector.n_channels() / n_levels, 0.0) {
  channels_begin_.push_back(0);
  for (std::size_t sensor = 0; sensor < detector.n_sensors(); ++sensor) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < n_words_; ++i)
      n += static_cast<std::size_t>(std::popcount(watched_[sensor * n_words_ + i]));
    channels_begin_.push_back(channels_begin_.back() + n);
  }
}

void SoftEdges::begin_run(std::uint64_t seed, std::uint32_t run, const ZoneSet& rest) {
  const Purpose purpose = spec_.rule == EdgeRule::swept_area ? Purpose::swept_area : Purpose::zone_edge;
  streams_.clear();
  ticks_left_ = 0;
  for (std::uint32_t sensor = 0; sensor + 1 < channels_begin_.size(); ++sensor)
    streams_.emplace_back(StreamKey{seed, run, sensor, purpose});
  for (std::size_t sensor = 0; sensor < streams_.size(); ++sensor) {
    const std::size_t first = channels_begin_[sensor] / n_levels_, n = channels_begin_[sensor + 1] / n_levels_ - first;
    for (std::size_t i = 0; i < n; ++i)
      usual_[first + i] = static_cast<double>(n_active(rest, sensor, i)) / static_cast<double>(n_levels_);
  }
  settled_ = true;
}

void SoftEdges::tick_levels(const ZoneSet& before, const ZoneSet& after, std::span<std::uint8_t> bits) noexcept {
  switch (spec_.rule) {
    case EdgeRule::drawn_edge:
      draw_edges();
      return detector_->mark(before.words(), after.words(), watched_, bits);
    case EdgeRule::covered_area:
      settled_ = settled_ && before == after;
      return filter(after, bits);
    case EdgeRule::swept_area:
      return notice_swept(before, after, bits);
  }
}

void SoftEdges::tick_unchanged(const ZoneSet& channels, std::span<std::uint8_t> bits) noexcept {
  if (n_levels_ == 1) return;
  if (spec_.rule == EdgeRule::drawn_edge) draw_edges();
  if (spec_.rule == EdgeRule::covered_area) filter(channels, bits);
}

bool SoftEdges::is_at_rest() const noexcept {
  return n_levels_ == 1 || spec_.rule == EdgeRule::swept_area || (spec_.rule == EdgeRule::covered_area && settled_);
}

int SoftEdges::n_active(const ZoneSet& channels, std::size_t sensor, std::size_t channel) const noexcept {
  const std::size_t begin = channels_begin_[sensor], n = (channels_begin_[sensor + 1] - begin) / n_levels_;
  int active = 0;
  for (std::size_t level = 0; level < n_levels_; ++level) {
    const std::size_t place = begin + level * n + channel;
    active += channels.test(place) ? 1 : 0;
  }
  return active;
}

void SoftEdges::draw_edges() noexcept {
  if (ticks_left_ > 0) {
    --ticks_left_;
    return;
  }
  ticks_left_ = ticks_per_window_ - 1;
  std::ranges::fill(watched_, ZoneSet::Word{0});
  for (std::size_t sensor = 0; sensor < streams_.size(); ++sensor) {
    const std::size_t begin = channels_begin_[sensor], n = (channels_begin_[sensor + 1] - begin) / n_levels_;
    ZoneSet::Word* watched = &watched_[sensor * n_words_];
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t level = streams_[sensor].index(static_cast<std::uint32_t>(n_levels_));
      const std::size_t channel = begin + level * n + i;
      watched[channel / ZoneSet::bits_per_word] |= ZoneSet::Word{1} << (channel % ZoneSet::bits_per_word);
    }
  }
}

void SoftEdges::filter(const ZoneSet& channels, std::span<std::uint8_t> bits) noexcept {
  if (settled_) return;
  settled_ = true;
  for (std::size_t sensor = 0; sensor < streams_.size(); ++sensor) {
    const std::size_t first = channels_begin_[sensor] / n_levels_, n = channels_begin_[sensor + 1] / n_levels_ - first;
    for (std::size_t i = 0; i < n; ++i) {
      const double share = static_cast<double>(n_active(channels, sensor, i)) / static_cast<double>(n_levels_);
      double& usual = usual_[first + i];
      if (std::abs(share - usual) > spec_.threshold) bits[sensor] = 1;
      usual += forgets_ * (share - usual);
      if (std::abs(share - usual) < no_difference) usual = share;
      settled_ = settled_ && usual == share;
    }
  }
}

void SoftEdges::notice_swept(const ZoneSet& before, const ZoneSet& after, std::span<std::uint8_t> bits) noexcept {
  if (before == after) return;
  for (std::size_t i = 0; i < n_words_; ++i) changed_.words()[i] = before.words()[i] ^ after.words()[i];
  for (std::size_t sensor = 0; sensor < streams_.size(); ++sensor) {
    const std::size_t n = (channels_begin_[sensor + 1] - channels_begin_[sensor]) / n_levels_;
    double missed = 1.0;
    for (std::size_t i = 0; i < n; ++i)
      missed *= 1.0 - static_cast<double>(n_active(changed_, sensor, i)) / static_cast<double>(n_levels_);
    if (missed < 1.0 && streams_[sensor].uniform() >= missed) bits[sensor] = 1;
  }
}

std::optional<Comparator> output_of(const DetectorSpec& spec, Response response, double tick_s) {
  const auto& [hold_s, again_s, blind_s] = spec.report;
  const bool follows = spec.comparator.pulse_count == 1 && hold_s == 0.0 && again_s == 0.0 && blind_s == 0.0;
  if (follows || response == Response::beam) return std::nullopt;
  ComparatorSpec pulses = spec.comparator;
  if (response == Response::zones) pulses.pulse_signs = PulseSigns::any;
  return Comparator(pulses, spec.report, tick_s);
}

WindowReader::WindowReader(std::vector<std::int32_t> lead_ticks, std::int32_t ticks_per_window)
    : ticks_per_window_(ticks_per_window),
      ticks_left_(std::move(lead_ticks)),
      latches_(ticks_left_.size(), 0),
      readings_(ticks_left_.size(), 0) {
  for (std::int32_t& ticks : ticks_left_) ticks = ticks_per_window - ticks;
}

void WindowReader::advance(std::span<const std::uint8_t> triggers) noexcept {
  for (std::size_t sensor = 0; sensor < latches_.size(); ++sensor) {
    if (triggers[sensor] != 0) latches_[sensor] = 1;
    if (--ticks_left_[sensor] == 0) {
      ticks_left_[sensor] = ticks_per_window_;
      readings_[sensor] = std::exchange(latches_[sensor], std::uint8_t{0});
    }
  }
}

bool WindowReader::is_at_rest() const noexcept {
  const auto none = [](std::uint8_t bit) { return bit == 0; };
  return std::ranges::all_of(latches_, none) && std::ranges::all_of(readings_, none);
}

std::vector<std::int32_t> drawn_leads(std::size_t n_sensors, std::int32_t ticks_per_window, std::uint64_t seed,
                                      std::uint32_t run) {
  std::vector<std::int32_t> leads;
  for (std::uint32_t sensor = 0; sensor < n_sensors; ++sensor) {
    Stream stream({.seed = seed, .run = run, .entity = sensor, .purpose = Purpose::reader_phase});
    leads.push_back(static_cast<std::int32_t>(stream.index(static_cast<std::uint32_t>(ticks_per_window))));
  }
  return leads;
}

}  // namespace pirsim::pir
