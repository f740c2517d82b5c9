#include "io/reader_parts.hpp"

namespace pirsim::io {
namespace {

constexpr NumberRange seconds{.min = 0.0, .max = 3600.0};
constexpr NumberRange time_constant{.above = 0.0, .max = 1000.0};
constexpr NumberRange corner{.above = 0.0, .max = 1000.0};
constexpr NumberRange volts{.min = 0.0, .max = 100.0};
constexpr NumberRange threshold{.above = 0.0, .max = 100.0};

void read_element(const std::optional<YamlNode>& node, Diagnostics& faults, ElementSpec& element) {
  if (!node) return;
  YamlMap map(*node, faults, "element");
  element.thermal_s = map.number("thermal_s", element.thermal_s, time_constant);
  element.electrical_s = map.number("electrical_s", element.electrical_s, time_constant);
  map.finish();
}

void read_amplifier(const std::optional<YamlNode>& node, Diagnostics& faults, AmplifierSpec& amplifier) {
  if (!node) return;
  YamlMap map(*node, faults, "amplifier");
  amplifier.low_hz = map.number("low_hz", amplifier.low_hz, corner);
  amplifier.high_hz = map.number("high_hz", amplifier.high_hz, corner);
  amplifier.order = map.integer("order", amplifier.order, {.min = 1, .max = 3});
  amplifier.volts_per_watt = map.optional_number("volts_per_watt", {.above = 0.0});
  amplifier.noise_v_pp = map.number("noise_v_pp", amplifier.noise_v_pp, volts);
  amplifier.offset_v = map.number("offset_v", amplifier.offset_v, volts);
  amplifier.lowest_v = map.number("lowest_v", amplifier.lowest_v, volts);
  amplifier.highest_v = map.number("highest_v", amplifier.highest_v, volts);
  if (amplifier.low_hz >= amplifier.high_hz) {
    faults.error(map.where("high_hz"), "amplifier: expected high_hz above low_hz");
  }
  if (amplifier.lowest_v >= amplifier.offset_v || amplifier.offset_v >= amplifier.highest_v) {
    faults.error(map.where("offset_v"), "amplifier: expected offset_v between lowest_v and highest_v");
  }
  map.finish();
}

void read_comparator(const std::optional<YamlNode>& node, Diagnostics& faults, ComparatorSpec& comparator) {
  if (!node) return;
  YamlMap map(*node, faults, "comparator");
  comparator.positive_v = map.number("positive_v", comparator.positive_v, threshold);
  comparator.negative_v = map.number("negative_v", comparator.negative_v, threshold);
  comparator.pulse_count = map.integer("pulse_count", comparator.pulse_count, {.min = 1, .max = 8});
  comparator.pulse_window_s = map.number("pulse_window_s", comparator.pulse_window_s, seconds);
  comparator.pulse_signs = map.choice<PulseSigns>("pulse_signs", comparator.pulse_signs,
                                                  {{"any", PulseSigns::any}, {"alternating", PulseSigns::alternating}});
  comparator.hold_s = map.number("hold_s", comparator.hold_s, seconds);
  comparator.blind_s = map.number("blind_s", comparator.blind_s, seconds);
  if (comparator.pulse_count > 1 && comparator.pulse_window_s <= 0.0) {
    faults.error(map.where("pulse_count"), "comparator: several pulses need a pulse_window_s");
  }
  map.finish();
}

/// A signal that saturates before a threshold would never be noticed.
void check_thresholds(const YamlMap& sensor, const DetectorSpec& detector) {
  const auto& [element, amplifier, comparator] = detector;
  const double up = amplifier.highest_v - amplifier.offset_v, down = amplifier.offset_v - amplifier.lowest_v;
  const bool levels_make_sense = up > 0.0 && down > 0.0;
  if (levels_make_sense && (comparator.positive_v >= up || comparator.negative_v >= down)) {
    sensor.faults().error(sensor.where("comparator"), "comparator: the output saturates before it reaches a threshold");
  }
}

}  // namespace

DetectorSpec read_detector(YamlMap& sensor) {
  DetectorSpec detector;
  read_element(sensor.child("element"), sensor.faults(), detector.element);
  read_amplifier(sensor.child("amplifier"), sensor.faults(), detector.amplifier);
  read_comparator(sensor.child("comparator"), sensor.faults(), detector.comparator);
  check_thresholds(sensor, detector);
  return detector;
}

const std::vector<std::string>& sourced_detector_keys() {
  static const std::vector<std::string> keys{
      "thermal_s",   "electrical_s",   "low_hz",      "high_hz",   "order",      "volts_per_watt",
      "noise_v_pp",  "offset_v",       "lowest_v",    "highest_v", "positive_v", "negative_v",
      "pulse_count", "pulse_window_s", "pulse_signs", "hold_s",    "blind_s"};
  return keys;
}

}  // namespace pirsim::io
