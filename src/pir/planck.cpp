#include "pir/planck.hpp"

#include <cmath>

#include "pirsim/geometry.hpp"

namespace pirsim::pir {
namespace {

constexpr double planck_j_s = 6.62607015e-34, light_m_s = 299792458.0, boltzmann_j_k = 1.380649e-23;

/// Radiance at wavelengths up to the given one, as a share of what 2 k^4 T^4 / (h^3 c^2) multiplies. The integral of
/// x^3 / (e^x - 1) from x to infinity, term by term in powers of e^-x.
double tail(double x) {
  constexpr double negligible = 1e-17;
  double sum = 0.0;
  for (int n = 1; n < 10000; ++n) {
    const double term =
        std::exp(-n * x) * (x * x * x / n + 3.0 * x * x / (n * n) + 6.0 * x / std::pow(n, 3) + 6.0 / std::pow(n, 4));
    sum += term;
    if (term < negligible * sum) break;
  }
  return sum;
}

}  // namespace

double band_radiance(double temperature_k, const Band& band) {
  if (temperature_k <= 0.0) return 0.0;
  const double thermal_j = boltzmann_j_k * temperature_k;
  const auto x_of = [&](double wavelength_um) { return planck_j_s * light_m_s / (wavelength_um * 1e-6 * thermal_j); };
  const double scale = 2.0 * std::pow(thermal_j, 4) / (std::pow(planck_j_s, 3) * light_m_s * light_m_s);
  return scale * (tail(x_of(band.to_um)) - tail(x_of(band.from_um)));
}

}  // namespace pirsim::pir
