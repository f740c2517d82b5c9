// Numbers behind the pictures of docs/physics/analog.md, as CSV: pirsim_analog_data ranges|alarms SENSOR.yaml
#include <cmath>
#include <exception>
#include <iostream>
#include <string_view>
#include <vector>

#include "pir/analog_circuit.hpp"
#include "pir/calibration.hpp"
#include "pirsim/io.hpp"

namespace {

using namespace pirsim;

/// Up to which distance each lens step detects its maker's plate.
void write_ranges(const SensorModelSpec& model) {
  const pir::Calibration calibration = pir::calibrate(model);
  std::cout << "lens_step,speed_m_s,difference_k,range_m\n";
  for (const auto& [step, aperture_m2] : calibration.apertures_m2) {
    const pir::RatedStep facets(model, step);
    for (const double speed : {0.25, 0.5, 1.0, 2.0, 4.0}) {
      for (double difference = 0.5; difference < 20.0; difference *= std::pow(2.0, 0.25)) {
        pir::TargetPass pass = facets.rated();
        pass.target.speed_m_s = speed;
        pass.target.contrast_k = difference;
        std::cout << step << ',' << speed << ',' << difference << ','
                  << facets.detection_range(aperture_m2 * calibration.volts_per_watt, pass) << '\n';
      }
    }
  }
}

/// How often noise alone passes thresholds at so many standard deviations, in either direction.
void write_alarms(const SensorModelSpec& model) {
  constexpr double seconds = 20000.0;
  std::cout << "tick_s,level_sd,alarms,seconds\n";
  for (const double tick_s : {0.02, 0.005}) {
    for (double level = 0.5; level < 4.1; level += 0.25) {
      DetectorSpec spec = model.detector;
      spec.comparator = {.positive_v = level * spec.amplifier.noise_v_pp / 6.6,
                         .negative_v = level * spec.amplifier.noise_v_pp / 6.6};
      const pir::AnalogCircuit detector(spec, 1.0, tick_s);
      pir::AnalogCircuit::State state =
          detector.start(0.0, {.seed = 1, .run = 0, .entity = 0, .purpose = Purpose::detector_noise});
      std::int64_t alarms = 0;
      for (std::int64_t tick = 0; tick < std::llround(seconds / tick_s); ++tick) {
        const bool before = pir::AnalogCircuit::on(state);
        detector.advance(state, 0.0);
        if (!before && pir::AnalogCircuit::on(state)) ++alarms;
      }
      std::cout << tick_s << ',' << level << ',' << alarms << ',' << seconds << '\n';
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::string_view what = argc == 3 ? argv[1] : "";
    if (what == "ranges") {
      write_ranges(io::read_sensor_model(argv[2]));
    } else if (what == "alarms") {
      write_alarms(io::read_sensor_model(argv[2]));
    } else {
      std::cerr << "usage: pirsim_analog_data ranges|alarms SENSOR.yaml\n";
      return 2;
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
}
