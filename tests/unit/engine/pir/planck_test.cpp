#include "engine/pir/optics.hpp"

#include <cmath>

#include "pirsim/geometry.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using pir::band_radiance;
using pir::kelvin;

namespace {

double whole_radiance(double temperature_k) {
  constexpr double stefan_boltzmann = 5.670374419e-8;  // W m^-2 K^-4, CODATA 2018
  return stefan_boltzmann * temperature_k * temperature_k * temperature_k * temperature_k / pi;
}

}  // namespace

TEST_CASE("the radiance in a band is the share that published tables give", "[pir][planck]") {
  // Howell, Menguc, Daun, Siegel, Thermal Radiation Heat Transfer, appendix: F(0 to lambda T), lambda T in um K.
  struct Row {
    double lambda_t, fraction;
  };
  const Row rows[] = {{1000, 0.00032}, {2000, 0.06673}, {3000, 0.27323}, {6000, 0.73779}, {10000, 0.91416}};
  for (const double temperature_k : {250.0, 293.15, 310.0}) {
    for (const Row& row : rows) {
      const double share =
          band_radiance(temperature_k, {0.1, row.lambda_t / temperature_k}) / whole_radiance(temperature_k);
      CHECK(share == Approx(row.fraction).margin(1e-5));
    }
  }
}

TEST_CASE("the radiance in a band is the integral of Planck's law over it", "[pir][planck]") {
  const auto spectral = [](double wavelength_um, double temperature_k) {  // W m^-2 sr^-1 um^-1
    constexpr double c1 = 2.0 * 6.62607015e-34 * 299792458.0 * 299792458.0,
                     c2 = 6.62607015e-34 * 299792458.0 / 1.380649e-23;
    const double metres = wavelength_um * 1e-6;
    return c1 / std::pow(metres, 5) / std::expm1(c2 / (metres * temperature_k)) * 1e-6;
  };
  for (const double temperature_k : {263.15, 293.15, 309.0, 473.15}) {
    constexpr int n = 900;  // Simpson's rule
    constexpr double step = 9.0 / n;
    double sum = spectral(5.0, temperature_k) + spectral(14.0, temperature_k);
    for (int i = 1; i < n; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * spectral(5.0 + i * step, temperature_k);
    CHECK(band_radiance(temperature_k) == Approx(sum * step / 3.0).epsilon(1e-9));
  }
}

TEST_CASE("the radiance in the sensor's band rises with temperature and is nothing at absolute zero", "[pir][planck]") {
  CHECK(band_radiance(0.0) == 0.0);
  double before = 0.0;
  for (double temperature_k = 200.0; temperature_k < 400.0; temperature_k += 0.5) {
    CHECK(band_radiance(temperature_k) > before);
    before = band_radiance(temperature_k);
  }
  CHECK(kelvin(20.0) == 293.15);
}
