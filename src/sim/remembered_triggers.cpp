#include "sim/remembered_triggers.hpp"

#include <algorithm>

#include "sim/detection.hpp"

namespace pirsim::sim {

std::span<const double> NoiseMemory::normals(const Stream& from, std::size_t n) {
  auto known = std::ranges::find(drawn_, from, &Drawn::from);
  if (known == drawn_.end()) {
    if (n_kept_ + n > most_kept) {
      Stream stream = from;
      beyond_.resize(n);
      std::ranges::generate(beyond_, [&] { return stream.normal(); });
      return beyond_;
    }
    known = drawn_.insert(drawn_.end(), Drawn{from, from, {}});
  }
  auto& [begin, next, numbers] = *known;
  n_kept_ += std::max(n, numbers.size()) - numbers.size();
  while (numbers.size() < n) numbers.push_back(next.normal());
  return std::span(numbers).first(n);
}

namespace {

constexpr std::size_t bits_per_word = 64;

void set(std::vector<std::uint64_t>& bits, std::size_t tick) {
  bits[tick / bits_per_word] |= std::uint64_t{1} << (tick % bits_per_word);
}

std::size_t n_words(std::size_t n_ticks) { return (n_ticks + bits_per_word - 1) / bits_per_word; }

/// Of a moment, as detectors take it.
void show(const SensorArray& array, const Recording& recording, std::uint32_t moment, Exposure& exposure) {
  exposure.zones = recording.zones(moment);
  array.expose(exposure);
}

}  // namespace

RememberedTriggers::RememberedTriggers(const CompiledStudy& study, const Recording& recording, NoiseMemory& noise,
                                       const RememberedTriggers* like)
    : study_(study), recording_(recording), noise_(noise), like_(like) {}

void RememberedTriggers::prepare(const Recording& recording) {
  if (&recording != &recording_) throw Error(ErrorCode::usage, "triggers are remembered of one recording only");
}

void RememberedTriggers::begin_run(std::uint64_t seed, std::uint32_t run) {
  tick_ = 0;
  const auto known = runs_.find(run);
  if (known != runs_.end() && known->second.seed == seed) {
    now_ = &known->second;
    return;
  }
  const auto number = [](const RecordedRun& track) { return track.rows.run; };
  const auto track = std::ranges::find(recording_.runs, run, number);
  if (track == recording_.runs.end()) throw Error(ErrorCode::usage, "a run that isn't recorded has no triggers");
  now_ = &(runs_[run] = find_triggers(*track, seed));
}

void RememberedTriggers::tick(std::uint32_t, std::uint32_t, std::span<std::uint8_t> triggers) noexcept {
  const std::size_t word = tick_ / bits_per_word, bit = tick_ % bits_per_word;
  for (std::size_t sensor = 0; sensor < triggers.size(); ++sensor) {
    triggers[sensor] = static_cast<std::uint8_t>(now_->triggers[sensor][word] >> bit & 1U);
  }
  ++tick_;
}

RememberedTriggers::Run RememberedTriggers::find_triggers(const RecordedRun& track, std::uint64_t seed) {
  const SensorArray& array = study_.array();
  Run run{seed, &track, {}};
  run.triggers.assign(array.n_sensors(), Bits(n_words(track.moments.size()), 0));
  find_zone_triggers(run);
  for (std::uint32_t sensor = 0; sensor < array.n_sensors(); ++sensor) {
    if (!array.is_analog(sensor)) continue;
    const Bits* known = known_triggers(run, sensor);
    run.triggers[sensor] = known != nullptr ? *known : analog_triggers(run, sensor);
  }
  return run;
}

void RememberedTriggers::find_zone_triggers(Run& run) const {
  const SensorArray& array = study_.array();
  bool any = false;
  for (std::size_t sensor = 0; sensor < array.n_sensors(); ++sensor) any = any || !array.is_analog(sensor);
  if (!any) return;
  Exposure before = array.unexposed(), after = before;
  show(array, recording_, run.track->rest, before);
  Detector detector(array);
  detector.begin_run(run.seed, run.track->rows.run, before);
  std::vector<std::uint8_t> triggers(array.n_sensors());
  std::uint32_t number = run.track->rest;
  for (std::size_t tick = 0; tick < run.track->moments.size(); ++tick) {
    const std::uint32_t now = run.track->moments[tick];
    if (now == number) {
      detector.tick_zones_unchanged(before, triggers);
    } else {
      show(array, recording_, now, after);
      detector.tick_zones(before, after, triggers);
      std::swap(before, after);
      number = now;
    }
    for (std::size_t sensor = 0; sensor < triggers.size(); ++sensor) {
      if (triggers[sensor] != 0) set(run.triggers[sensor], tick);
    }
  }
}

RememberedTriggers::Bits RememberedTriggers::analog_triggers(const Run& run, std::uint32_t sensor) {
  const CalibratedSensor& made = *study_.array().analog()->sensors()[sensor];
  const RecordedRun& track = *run.track;
  const auto watts = [&](std::uint32_t moment) { return made.watts(recording_.powers_of(moment, sensor)); };
  pir::AnalogCircuit::State state =
      made.detector.start(watts(track.rest), {run.seed, track.rows.run, sensor, Purpose::detector_noise});
  std::span<const double> normals;
  if (made.detector.noisy()) normals = noise_.normals(state.noise, track.moments.size());
  Bits bits(n_words(track.moments.size()), 0);
  for (std::size_t tick = 0; tick < track.moments.size(); ++tick) {
    made.detector.advance(state, watts(track.moments[tick]), normals.empty() ? 0.0 : normals[tick]);
    if (pir::AnalogCircuit::on(state)) set(bits, tick);
  }
  return bits;
}

const RememberedTriggers::Bits* RememberedTriggers::known_triggers(const Run& run, std::uint32_t sensor) const {
  if (like_ == nullptr || like_->study_.array().analog() == nullptr) return nullptr;
  const auto& others = like_->study_.array().analog()->sensors();
  if (sensor >= others.size() || others[sensor] != study_.array().analog()->sensors()[sensor]) return nullptr;
  const auto known = like_->runs_.find(run.track->rows.run);
  if (known == like_->runs_.end() || known->second.seed != run.seed) return nullptr;
  const RecordedRun &track = *run.track, &other = *known->second.track;
  if (track.moments.size() != other.moments.size()) return nullptr;
  const auto receives_the_same = [&](std::uint32_t moment, std::uint32_t there) {
    return std::ranges::equal(recording_.powers_of(moment, sensor), like_->recording_.powers_of(there, sensor));
  };
  if (!receives_the_same(track.rest, other.rest)) return nullptr;
  for (std::size_t tick = 0; tick < track.moments.size(); ++tick) {
    if (!receives_the_same(track.moments[tick], other.moments[tick])) return nullptr;
  }
  return &known->second.triggers[sensor];
}

}  // namespace pirsim::sim
