#include "stats/trees.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::stats;

namespace {

struct Forecasts {
  Matrix<double> probabilities;
  std::vector<int> labels;
};

/// Labels drawn from random probabilities q; what is told of them is q^sharpness, scaled to sum 1.
Forecasts draw_forecasts(std::size_t rows, double sharpness, std::uint32_t study) {
  Stream stream({71, study, 0, Purpose::test});
  Forecasts drawn{Matrix<double>(rows, 4), {}};
  for (std::size_t r = 0; r < rows; ++r) {
    double sum = 0.0, told = 0.0;
    std::vector<double> q(4);
    for (double& share : q) sum += share = std::exp(1.2 * stream.normal());
    double place = stream.uniform() * sum;
    int label = 0;
    while (label < 3 && place >= q[static_cast<std::size_t>(label)]) place -= q[static_cast<std::size_t>(label++)];
    drawn.labels.push_back(label);
    for (std::size_t k = 0; k < 4; ++k) told += drawn.probabilities(r, k) = std::pow(q[k] / sum, sharpness);
    for (double& share : drawn.probabilities.row(r)) share /= told;
  }
  return drawn;
}

Matrix<double> combined(const LogPool& pool, const Forecasts& forecasts) {
  Matrix<double> result(forecasts.probabilities.rows(), 4);
  for (std::size_t r = 0; r < result.rows(); ++r) {
    const auto row = forecasts.probabilities.row(r);
    const std::vector<std::vector<double>> sources{{row.begin(), row.end()}};
    const std::vector<double> shares = pool.combine(sources);
    std::copy(shares.begin(), shares.end(), result.row(r).begin());
  }
  return result;
}

}  // namespace

TEST_CASE("temperature scaling finds the sharpness that was put in and repairs the calibration", "[stats]") {
  const Forecasts sharp = draw_forecasts(8000, 2.5, 0), fresh = draw_forecasts(8000, 2.5, 1);
  const std::vector<Matrix<double>> sources{sharp.probabilities};
  const LogPool pool = LogPool::fit(sources, sharp.labels);
  CHECK(pool.weights()[0] == Approx(1.0 / 2.5).epsilon(0.06));
  // Of 8,000 rows in 15 bins the error of perfect forecasts is about sqrt(15 / 8000) x 0.4 = 0.017.
  CHECK(reliability(fresh.probabilities, fresh.labels).expected_calibration_error > 0.1);
  CHECK(reliability(combined(pool, fresh), fresh.labels).expected_calibration_error < 0.025);
}

TEST_CASE("a pool gives no weight to a source that knows nothing", "[stats]") {
  const Forecasts honest = draw_forecasts(6000, 1.0, 2), noise = draw_forecasts(6000, 1.0, 3);
  const std::vector<Matrix<double>> sources{honest.probabilities, noise.probabilities};
  const LogPool pool = LogPool::fit(sources, honest.labels);
  CHECK(pool.weights()[0] == Approx(1.0).margin(0.08));
  CHECK(std::abs(pool.weights()[1]) < 0.05);
}

TEST_CASE("the calibration error is what its bins say", "[stats]") {
  Matrix<double> probabilities(4, 2);
  const std::vector<double> first{0.95, 0.95, 0.65, 0.65};
  for (std::size_t r = 0; r < 4; ++r) {
    probabilities(r, 0) = first[r];
    probabilities(r, 1) = 1.0 - first[r];
  }
  const Reliability result = reliability(probabilities, std::vector<int>{0, 0, 0, 1}, 10);
  CHECK(result.expected_calibration_error == Approx(0.5 * 0.05 + 0.5 * 0.15));
  CHECK(result.bins[9].rows == 2);
  CHECK(result.bins[6].share_right == Approx(0.5));
}
