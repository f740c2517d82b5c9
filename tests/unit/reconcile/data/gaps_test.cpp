// Silence that sensors share, against closed forms.
#include "reconcile/data/alignment.hpp"

#include <cmath>
#include <vector>

#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

constexpr std::size_t n_gap_rows = 20000;

Series series_of(std::vector<std::uint8_t> bits, std::size_t n_sensors) {
  return {0, 1, 0, bits.size() / n_sensors, std::move(bits)};
}

/// Sensors that always move, of which each (alone) or all (jointly) lose a row with this chance.
enum class Loss { alone, joint };
JointSilence silence_of(std::size_t n_sensors, double lost, Loss loss) {
  Stream stream({1, 0, 0, Purpose::test});
  std::vector<std::uint8_t> bits;
  for (std::size_t row = 0; row < n_gap_rows; ++row) {
    const bool all = stream.uniform() < lost;
    for (std::size_t s = 0; s < n_sensors; ++s) {
      const bool own = stream.uniform() < lost;
      bits.push_back((loss == Loss::joint ? all : own) ? 0 : 1);
    }
  }
  const std::vector<Series> runs{series_of(std::move(bits), n_sensors)};
  return joint_silence(runs, n_sensors);
}

}  // namespace

TEST_CASE("gaps and joint silence counted by hand", "[statistics]") {
  // A is awaited in rows 1 to 4, B in rows 2 and 3. Both are silent in row 2, A alone in row 3.
  const std::vector<Series> runs{series_of({1, 0, 1, 1, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0}, 2)};
  const std::vector<Gaps> gaps = gaps_of(runs.front(), 2);
  CHECK(gaps[0].awaited == 4.0);
  CHECK(gaps[0].silent == 2.0);
  CHECK(gaps[1].awaited == 2.0);
  CHECK(gaps[1].silent == 1.0);
  const JointSilence joint = joint_silence(runs, 2);
  CHECK(joint.rows == 1.0);
  // A is silent in two of its four rows, B in one of its two; two rows have both.
  CHECK(joint.by_chance == Approx(2 * (2.0 / 4.0) * (1.0 / 2.0)));
  CHECK(joint.log_ratio() == Approx(std::log(1.5 / 1.0)));
}

TEST_CASE("sensors that lose rows by themselves are silent together by chance alone", "[statistics]") {
  constexpr double lost = 0.3;
  for (const std::size_t n_sensors : {2U, 3U}) {
    CAPTURE(n_sensors);
    // A sensor is awaited unless it loses all three rows before, or all three after.
    const double awaited = std::pow(1.0 - std::pow(lost, 3), 2), n = n_gap_rows;
    const double two = std::pow(lost * awaited, 2), three = std::pow(lost * awaited, 3);
    const double chance = n_sensors == 2 ? two : three + 3.0 * two * (1.0 - awaited);
    const double standard_error = std::sqrt(chance * (1.0 - chance) * n);
    const JointSilence alone = silence_of(n_sensors, lost, Loss::alone);
    CHECK(std::abs(alone.rows - alone.by_chance) < 4.0 * standard_error);
    CHECK(alone.by_chance == Approx(chance * n).epsilon(0.05));
    const JointSilence joint = silence_of(n_sensors, lost, Loss::joint);
    CHECK(joint.rows == Approx(lost * awaited * n).epsilon(0.05));
    CHECK(joint.log_ratio() == Approx(std::log(lost / std::pow(lost, n_sensors))).margin(0.05));
    CHECK_FALSE(std::abs(joint.rows - joint.by_chance) < 4.0 * standard_error);  // must fail
  }
}

TEST_CASE("of one sensor, and of what nobody knows, no silence is shared", "[statistics]") {
  CHECK(silence_of(1, 0.3, Loss::joint).log_ratio() == 0.0);
  const std::vector<Series> unknown{series_of(std::vector<std::uint8_t>(40, unknown_bit), 2)};
  CHECK(joint_silence(unknown, 2).log_ratio() == 0.0);
  CHECK(joint_silence({}, 2).log_ratio() == 0.0);
}
