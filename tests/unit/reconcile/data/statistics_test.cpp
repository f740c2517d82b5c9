#include "reconcile/data/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "pirsim/geometry.hpp"
#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

const StudyFrame frame{{"S1"}, {"PIR1"}, {}, 1.0};

ScriptSpec one_trial() {
  ScriptSpec script;
  script.trials = {{"S1", {}}};
  return script;
}

Series series_from(const std::string& bits) {
  Series series{0, 1, 0, bits.size(), {}};
  for (const char bit : bits) series.bits.push_back(bit == '?' ? unknown_bit : static_cast<std::uint8_t>(bit - '0'));
  return series;
}

/// The statistics of one sensor's bits, of which the base model expects as much as `expected` has.
std::vector<float> statistics(const std::string& bits, const std::string& expected) {
  const std::vector<Series> base{series_from(expected)}, data{series_from(bits)};
  const Profile profile = profile_of(frame, one_trial(), base);
  DataShape shape = full_shape(frame, Measured::Kind::series, 1, base);
  if (bits.find('?') != std::string::npos) {
    for (const char bit : bits) shape.runs[0].unknown.push_back(bit == '?' ? 1 : 0);
  }
  return statistics_of(frame, shape, profile, data);
}

float of(const std::vector<float>& values, CellStatistic statistic) {
  return DatasetStatistics(frame, values).cell(0, 0, statistic);
}

}  // namespace

TEST_CASE("statistics of bits counted by hand", "[statistics]") {
  //                            0         1
  //                            0123456789012345
  const auto s = statistics("0110100111000100", "0000000000000000");
  CHECK(of(s, CellStatistic::seconds) == 7.0F);
  CHECK(of(s, CellStatistic::silent_seconds) == 7.0F);
  CHECK(of(s, CellStatistic::half_difference) == 4.0F - 3.0F);
  CHECK(of(s, CellStatistic::onsets) == 4.0F);
  CHECK(of(s, CellStatistic::longest_run) == 3.0F);
  CHECK(of(s, CellStatistic::isolated) == 2.0F);
  CHECK(of(s, CellStatistic::single_gaps) == 1.0F);
  CHECK(of(s, CellStatistic::double_gaps) == 1.0F);
  CHECK(of(s, CellStatistic::longest_gap) == 3.0F);
  CHECK(of(s, CellStatistic::again_after_1) == Approx(3.0 / 7.0));
  CHECK(of(s, CellStatistic::again_after_2) == Approx(2.0 / 7.0));
}

TEST_CASE("unknown readings count neither as motion nor as none", "[statistics]") {
  const auto s = statistics("01?01??10", "000000000");
  CHECK(of(s, CellStatistic::seconds) == 3.0F);
  CHECK(of(s, CellStatistic::isolated) == 0.0F);
  CHECK(of(s, CellStatistic::onsets) == 2.0F);
  CHECK(of(s, CellStatistic::again_after_1) == 0.0F);
}

TEST_CASE("a periodic sensor stands out in the periodogram and chance does not", "[statistics]") {
  std::string periodic, scattered;
  Stream stream({7, 0, 0, Purpose::test});
  for (int i = 0; i < 180; ++i) {
    periodic += i % 15 == 0 ? '1' : '0';
    scattered += stream.uniform() < 1.0 / 15.0 ? '1' : '0';
  }
  const std::string none(180, '0');
  CHECK(of(statistics(periodic, none), CellStatistic::period_power) == Approx(12.0 * 12.0 / (12.0 * 168.0 / 180.0)));
  CHECK(of(statistics(scattered, none), CellStatistic::period_power) < 8.0F);
}

TEST_CASE("the periodogram of chance is that of the definition", "[statistics]") {
  std::string bits;
  Stream stream({4, 0, 0, Purpose::test});
  for (int i = 0; i < 187; ++i) bits += stream.uniform() < 0.3 ? '1' : '0';
  double greatest = 0.0, count = 0.0;
  for (const char bit : bits) count += bit == '1' ? 1.0 : 0.0;
  for (int f = 1; f <= 187 / 8; ++f) {
    double real = 0.0, imaginary = 0.0;
    for (int t = 0; t < 187; ++t) {
      if (bits[static_cast<std::size_t>(t)] != '1') continue;
      real += std::cos(2.0 * pi * f * t / 187.0);
      imaginary += std::sin(2.0 * pi * f * t / 187.0);
    }
    greatest = std::max(greatest, real * real + imaginary * imaginary);
  }
  const std::string none(187, '0');
  CHECK(of(statistics(bits, none), CellStatistic::period_power) == Approx(greatest / (count * (1.0 - count / 187.0))));
}

TEST_CASE("motion that keeps to the arm's cycle is told from motion that does not", "[statistics]") {
  std::string with, without;
  for (int i = 0; i < 180; ++i) {
    with += i % 3 == 0 ? '1' : '0';
    without += '1';
  }
  const std::string none(180, '0');
  CHECK(of(statistics(with, none), CellStatistic::cycle_strength) == Approx(1.0));
  CHECK(of(statistics(without, none), CellStatistic::cycle_strength) == Approx(0.0).margin(1e-6));
}

TEST_CASE("motion that comes early shows at its lag", "[statistics]") {
  std::string expected(180, '0'), early(180, '0');
  for (const std::size_t at : {10U, 47U, 100U, 131U}) {
    expected[at] = '1';
    early[at - 3] = '1';
  }
  const auto s = statistics(early, expected);
  const auto lag = [&](TrialStatistic which) { return DatasetStatistics(frame, s).trial(0, which); };
  CHECK(name(CellStatistic::shift_s) == "shift_s");
  CHECK(of(s, CellStatistic::shift_s) == Approx(-3.0).margin(0.01));
  CHECK(of(statistics(expected, early), CellStatistic::shift_s) == Approx(3.0).margin(0.01));
  CHECK(of(statistics(early, early), CellStatistic::shift_s) == Approx(0.0));
  CHECK(of(statistics(early, std::string(90, '0') + std::string(90, '1')), CellStatistic::shift_s) == 0.0F);
  CHECK(lag(TrialStatistic::lag_0) < 0.0F);
}

TEST_CASE("a clock that is off by 15 s is seen in rows of a quarter of a second too", "[statistics]") {
  std::vector<std::uint8_t> bits(400, 0);
  std::vector<float> expected(400, 0.0F);
  const std::vector<std::uint8_t> busy(400, 0);
  for (const std::size_t at : {100U, 137U, 210U, 241U}) {
    expected[at] = 1.0F;
    bits[at - 60] = 1;
  }
  CellValues values;
  add_main_statistics({bits, expected, busy, 12.0}, 0.25, values);
  CHECK(values[CellStatistic::shift_s] == Approx(-15.0).margin(0.01));
}

TEST_CASE("motion that comes late shows at its lag", "[statistics]") {
  std::string expected(180, '0'), late(180, '0');
  for (const std::size_t at : {10U, 47U, 100U, 131U}) {
    expected[at] = '1';
    late[at + 3] = '1';
  }
  const auto s = statistics(late, expected);
  const auto lag = [&](TrialStatistic which) { return DatasetStatistics(frame, s).trial(0, which); };
  CHECK(lag(TrialStatistic::lag_3) > 3.5F);
  CHECK(lag(TrialStatistic::lag_0) < 0.0F);
  CHECK(lag(TrialStatistic::lag_2) < 0.0F);
  CHECK(of(s, CellStatistic::agreement) < 0.0F);
  CHECK(of(statistics(expected, expected), CellStatistic::agreement) == Approx(1.0));
}

TEST_CASE("motion is told by the sixth and the eighteenth of the time in which it is", "[statistics]") {
  const auto s = statistics("110000000000000100", "000000000000000000");
  CHECK(of(s, CellStatistic::sixth_1) == 2.0F);
  CHECK(of(s, static_cast<CellStatistic>(static_cast<int>(CellStatistic::sixth_1) + 1)) == 0.0F);
  CHECK(of(s, CellStatistic::sixth_6) == 1.0F);
  const auto slice = [&](std::size_t n) {
    return DatasetStatistics(frame, s).trial(
        0, static_cast<TrialStatistic>(static_cast<std::size_t>(TrialStatistic::slice_1) + n - 1));
  };
  CHECK(slice(1) == 1.0F);
  CHECK(slice(2) == 1.0F);
  CHECK(slice(3) == 0.0F);
  CHECK(slice(16) == 1.0F);
}

TEST_CASE("a sensor that repeats another shows in the pair and not the other way round", "[statistics]") {
  const StudyFrame two{{"S1"}, {"A", "B"}, {}, 1.0};
  // A moves in rows 0 to 3, B in rows 0 and 1 of eight.
  const std::vector<Series> runs{{0, 1, 0, 8, {1, 1, 1, 1, 1, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0}}};
  const auto s =
      statistics_of(two, full_shape(two, Measured::Kind::series, 1, runs), profile_of(two, one_trial(), runs), runs);
  CHECK(DatasetStatistics(two, s).pair(0, 0, 1) == 0.0F);  // B never moves without A
  CHECK(DatasetStatistics(two, s).pair(0, 1, 0) == 2.0F);
  CHECK(&DatasetStatistics(two, s).pair(0, 1, 0) == &s.back());
}

TEST_CASE("sums give seconds and nothing else", "[statistics]") {
  Measured measured;
  measured.kind = Measured::Kind::sums;
  measured.sums = {{0, 0, 1, 0.5}, {0, 0, 2, 3.5}};
  const std::vector<Series> pilot{series_from("0101")};
  const DataShape shape = shape_of(frame, measured, pilot);
  const auto s = statistics_of(frame, shape, profile_of(frame, one_trial(), pilot), measured);
  CHECK(of(s, CellStatistic::seconds) == 2.0F);
  CHECK(of(s, CellStatistic::run_variance) == 4.5F);
  CHECK(std::isnan(of(s, CellStatistic::onsets)));
  CHECK(std::isnan(DatasetStatistics(frame, s).trial(0, TrialStatistic::lag_0)));
  // Simulated data are made to tell as little.
  std::vector<Series> runs{series_from("0111"), series_from("0001")};
  runs[1].replicate = 2;
  const auto simulated = statistics_of(frame, shape, profile_of(frame, one_trial(), pilot), runs);
  CHECK(of(simulated, CellStatistic::seconds) == 2.0F);
  CHECK(of(simulated, CellStatistic::run_variance) == 2.0F);
  CHECK(std::isnan(of(simulated, CellStatistic::onsets)));
}

TEST_CASE("a cell's mean is over the runs in which its sensor is known", "[statistics]") {
  const StudyFrame two{{"S1", "S2"}, {"A", "B"}, {}, 1.0};
  const std::vector<TrialSpec> trials(2, one_trial().trials.front());
  ScriptSpec script = one_trial();
  script.trials = trials;
  const std::vector<std::uint8_t> both(8, 1), none(8, 0);
  const std::vector<Series> pilot{{0, 1, 0, 4, both}, {1, 1, 0, 4, both}};
  Measured measured;
  measured.kind = Measured::Kind::sums;  // of A in S1 two, of B there and of both in S2 one
  measured.sums = {{0, 0, 1, 4.0}, {0, 0, 2, 0.0}, {0, 1, 1, 4.0}, {1, 0, 1, 4.0}, {1, 1, 1, 4.0}};
  const DataShape shape = shape_of(two, measured, pilot);
  const Profile profile = profile_of(two, script, pilot);
  const std::vector<Series> runs{{0, 1, 0, 4, both}, {0, 2, 0, 4, none}, {1, 1, 0, 4, both}, {1, 2, 0, 4, none}};
  for (const auto& s : {statistics_of(two, shape, profile, runs), statistics_of(two, shape, profile, measured)}) {
    CHECK(DatasetStatistics(two, s).cell(0, 0, CellStatistic::seconds) == 2.0F);
    CHECK(DatasetStatistics(two, s).cell(0, 0, CellStatistic::run_variance) == 8.0F);
    CHECK(DatasetStatistics(two, s).cell(0, 1, CellStatistic::seconds) == 4.0F);
    CHECK(std::isnan(DatasetStatistics(two, s).cell(0, 1, CellStatistic::run_variance)));
    CHECK(DatasetStatistics(two, s).cell(1, 0, CellStatistic::seconds) == 4.0F);
    CHECK(DatasetStatistics(two, s).cell(1, 1, CellStatistic::seconds) == 4.0F);
  }
}

namespace {

const StudyFrame phased{{"S1"}, {"A", "B"}, {"working"}, 1.0};

Series phased_run(std::size_t lead, std::size_t main, std::size_t tail) {
  return {0, 1, lead, lead + main, std::vector<std::uint8_t>(2 * (lead + main + tail), 0)};
}

Measured measured_of(Series run) {
  Measured measured;
  measured.file = "m.csv";
  measured.runs = {std::move(run)};
  return measured;
}

std::vector<std::string> notes(const StudyFrame& of, const Series& run, const std::vector<Series>& pilot) {
  const Measured measured = measured_of(run);
  return notes_on(of, shape_of(of, measured, pilot), measured, pilot);
}

std::string only_note(const StudyFrame& of, const Series& run, const std::vector<Series>& pilot) {
  const auto all = notes(of, run, pilot);
  REQUIRE(all.size() == 1);
  return all.front();
}

}  // namespace

TEST_CASE("what was recorded of the walks in and out is compared only if none of it was missed", "[statistics]") {
  const std::vector<Series> pilot{phased_run(9, 60, 8), phased_run(8, 60, 7)};
  const auto shape = [&](std::size_t lead, std::size_t tail) {
    return shape_of(phased, measured_of(phased_run(lead, 60, tail)), pilot).runs.front();
  };
  using Known = std::vector<std::uint8_t>;
  const Known both{1, 1}, none{0, 0};
  CHECK(shape(8, 7).lead_known == both);
  CHECK(shape(7, 6).lead_known == both);  // a row is within what another gait does
  CHECK(shape(7, 6).tail_known == both);
  CHECK(shape(12, 12).lead_known == both);
  CHECK(shape(6, 7).lead_known == none);
  CHECK(shape(6, 7).tail_known == both);
  CHECK(shape(8, 5).tail_known == none);
  CHECK(shape(0, 0).lead_known == none);
  CHECK_THAT(only_note(phased, phased_run(3, 60, 7), pilot),
             contains("before the counted phases") && contains("1 run,"));
  CHECK(notes(phased, phased_run(8, 60, 7), pilot).empty());

  Series gap = phased_run(8, 60, 7);  // of B, while somebody walks in
  gap.bits[3 * 2 + 1] = unknown_bit;
  const DataShape half = shape_of(phased, measured_of(gap), pilot);
  CHECK(half.runs.front().lead_known == Known{1, 0});
  CHECK(half.runs.front().tail_known == both);
  CHECK_THAT(only_note(phased, gap, pilot), contains("before the counted phases") && contains("some readings"));
  const Profile profile = profile_of(phased, one_trial(), pilot);
  const std::vector<float> values = statistics_of(phased, half, profile, pilot);
  CHECK_FALSE(std::isnan(DatasetStatistics(phased, values).cell(0, 0, CellStatistic::lead_seconds)));
  CHECK(std::isnan(DatasetStatistics(phased, values).cell(0, 1, CellStatistic::lead_seconds)));
  CHECK_FALSE(std::isnan(DatasetStatistics(phased, values).cell(0, 1, CellStatistic::tail_seconds)));

  Series no_b = phased_run(8, 60, 7);  // B was measured nowhere: that is told elsewhere
  for (std::size_t i = 1; i < no_b.bits.size(); i += 2) no_b.bits[i] = unknown_bit;
  CHECK(notes(phased, no_b, pilot).empty());
}

TEST_CASE("what runs that begin or end within a counted phase are taken for is told", "[statistics]") {
  const std::vector<Series> pilot{phased_run(9, 60, 8), phased_run(8, 61, 7)};
  CHECK_THAT(only_note(phased, phased_run(0, 60, 7), pilot),
             contains("1 run of the file") && contains("its beginning"));
  CHECK_THAT(only_note(phased, phased_run(8, 50, 7), pilot), contains("ends") && contains("as far as"));
  CHECK(notes(phased, phased_run(8, 58, 7), pilot).empty());
  CHECK(notes(phased, phased_run(0, 60, 0), std::vector{phased_run(0, 60, 0)}).empty());
}

TEST_CASE("rows after the longest simulated main part are left out", "[statistics]") {
  const StudyFrame all{{"S1"}, {"A", "B"}, {}, 1.0};
  const std::vector<Series> pilot{phased_run(0, 60, 0), phased_run(0, 62, 0)};
  Series longer = phased_run(0, 90, 0);
  longer.bits.back() = unknown_bit;
  CHECK_THAT(only_note(all, longer, pilot),
             contains("after the end of the longest simulated run") && contains("1 run."));
  const DataShape::Run shape = shape_of(all, measured_of(longer), pilot).runs.front();
  CHECK(shape.n_main == 62);
  CHECK(shape.unknown.empty());
  CHECK(notes(all, phased_run(0, 61, 0), pilot).empty());
}

TEST_CASE("rows and sums that can't be of the counted phases are refused", "[statistics]") {
  const std::vector<Series> pilot{phased_run(9, 60, 8)};
  Measured rows = measured_of(phased_run(0, 77, 0));
  CHECK(shape_of(phased, rows, pilot).runs.front().n_main == 60);  // the file says itself which are
  rows.tells_phases = false;
  CHECK_THROWS_WITH(shape_of(phased, rows, pilot), contains("m.csv: error: trial 'S1': 77 rows") && contains("60 s"));
  rows.runs = {phased_run(0, 62, 0)};
  CHECK_NOTHROW(shape_of(phased, rows, pilot));
  Measured sums;
  sums.kind = Measured::Kind::sums;
  sums.sums = {{0, 0, 1, 60.0}, {0, 1, 1, 999.0}};
  CHECK_THROWS_WITH(shape_of(phased, sums, pilot), contains("'B' has 999 s with motion"));
  sums.sums[1].seconds = 12.0;
  CHECK_NOTHROW(shape_of(phased, sums, pilot));
}

TEST_CASE("a correlation is that of the textbook and doesn't ask where the numbers lie", "[reconcile]") {
  // Anscombe's first quartet, r = 0.81642 (Anscombe, The American Statistician 27, 1973), also with both columns moved.
  constexpr std::array<std::pair<double, double>, 11> quartet{{{10, 8.04},
                                                               {8, 6.95},
                                                               {13, 7.58},
                                                               {9, 8.81},
                                                               {11, 8.33},
                                                               {14, 9.96},
                                                               {6, 7.24},
                                                               {4, 4.26},
                                                               {12, 10.84},
                                                               {7, 4.82},
                                                               {5, 5.68}}};
  Correlation correlation, moved, against;
  for (const auto& [x, y] : quartet) {
    correlation.add(x, y);
    moved.add(x + 100.0, 3.0 * y - 50.0);
    against.add(-x, y);
  }
  CHECK(correlation.value() == Approx(0.81642).epsilon(1e-5));
  CHECK(moved.value() == Approx(0.81642).epsilon(1e-5));
  CHECK(against.value() == Approx(-0.81642).epsilon(1e-5));
}

TEST_CASE("what doesn't vary goes together with nothing", "[reconcile]") {
  Correlation correlation;
  CHECK(correlation.value() == 0.0);
  for (const double x : {1.0, 2.0, 3.0}) correlation.add(x, 0.7);
  CHECK(correlation.value() == 0.0);
}

TEST_CASE("what sensors lose together, one instead of another, or each by itself is told apart", "[statistics]") {
  constexpr std::size_t n = 2;
  const std::vector<float> both_sure{0.9F, 0.9F}, one_sure{0.9F, 0.1F};
  Stream stream({1, 0, 0, Purpose::test});
  /// lose: of a row in which both are sure, or the first alone.
  const auto rows = [&](const std::function<void(std::array<std::uint8_t, n> & bits, bool both)>& lose) {
    SureRows sure(n);
    for (int row = 0; row < 2000; ++row) {
      std::array<std::uint8_t, n> bits{1, 1};
      lose(bits, row % 2 == 0);
      sure.add(row % 2 == 0 ? both_sure : one_sure, bits);
    }
    return sure;
  };
  const SureRows by_itself = rows([&](auto& bits, bool) {
    for (std::uint8_t& bit : bits) bit = stream.uniform() < 0.2 ? 0 : 1;
  });
  const SureRows jammed = rows([&](auto& bits, bool) { bits[0] = bits[1] = stream.uniform() < 0.2 ? 0 : 1; });
  const SureRows collided = rows([&](auto& bits, bool both) { bits[both ? stream.index(2) : 1] = 0; });
  CHECK(std::abs(by_itself.joint_loss()) < 0.02);
  CHECK(std::abs(by_itself.loss_in_company()) < 0.06);
  CHECK(jammed.joint_loss() == Approx(0.2 * 0.8).margin(0.02));
  CHECK(std::abs(jammed.loss_in_company()) < 0.06);
  CHECK(collided.joint_loss() == Approx(-0.25).margin(0.01));
  CHECK(collided.loss_in_company() == Approx(0.5).margin(0.01));
}

TEST_CASE("sure rows are those of the whole run, as far as they are known", "[statistics]") {
  const StudyFrame two{{"S1"}, {"A", "B"}, {"working"}, 1.0};
  Series sure{0, 1, 4, 6, {1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1}};
  const Profile profile = profile_of(two, one_trial(), std::span(&sure, 1));
  DataShape shape = full_shape(two, Measured::Kind::series, 1, std::span(&sure, 1));
  Series lost = sure;
  for (const std::size_t row : {1, 3, 7}) lost.bits[2 * row] = lost.bits[2 * row + 1] = 0;
  const auto joint_loss = [&] {
    return DatasetStatistics(two, statistics_of(two, shape, profile, std::span(&lost, 1)))
        .trial(0, TrialStatistic::joint_loss);
  };
  CHECK(joint_loss() == Approx(0.25));  // three of six
  shape.runs[0].tail_known = {0, 0};
  CHECK(joint_loss() == Approx(0.25));  // two of four
  shape.runs[0].lead_known = {0, 0};
  CHECK(joint_loss() == 0.0F);
}
