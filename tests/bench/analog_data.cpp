// Numbers behind a picture of docs/physics/analog.md, as CSV: pirsim_analog_data SENSOR.yaml
#include <cmath>
#include <exception>
#include <iostream>

#include "engine/pir/calibration.hpp"
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

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 2) {
      std::cerr << "usage: pirsim_analog_data SENSOR.yaml\n";
      return 2;
    }
    write_ranges(io::read_sensor_model(argv[1]));
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
}
