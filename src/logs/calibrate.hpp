// Means, quantiles and ranks of weighted values.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pirsim/calibrate.hpp"
#include "pirsim/counting.hpp"
#include "pirsim/interval.hpp"
#include "stats/matrix.hpp"

namespace pirsim::calibrate {

inline constexpr double minute_s = 60.0, hour_s = 3600.0;

inline constexpr int fewest_rooms = 10;  ///< that can be weighed

/// What a counter of such a calibration warns of; empty: of nothing.
[[nodiscard]] std::string warning_of(Verdict verdict);

// Weights are at least 0, and not all 0.

[[nodiscard]] double weighted_mean(std::span<const double> values, std::span<const double> weights);
[[nodiscard]] double weighted_sd(std::span<const double> values, std::span<const double> weights);
/// From 5 to 95 %.
[[nodiscard]] Interval weighted_interval(std::span<const double> values, std::span<const double> weights);
/// Spearman's, ties sharing their middle rank; 0 of fewer than three or of values that are all the same.
[[nodiscard]] double rank_correlation(std::span<const double> x, std::span<const double> y);

// What error to expect: each room is calibrated and counted as if it were the real one.

/// How far off figures are, case by case; as counting::figure_names.
using FigureErrors = std::array<std::vector<double>, std::size(counting::figure_names)>;
/// Of a room's days, by smoothed counts of each.
[[nodiscard]] FigureErrors figure_errors(std::span<const counting::Estimates> told,
                                         std::span<const counting::Stretch> days, double step_s);
/// times: by how much they are larger than in the rooms. step_s: of a reading, which arrivals aren't told closer than.
[[nodiscard]] counting::FiguresOff figures_off(const FigureErrors& errors, double times, double step_s);

/// (rooms) mean absolute errors of smoothed counts by the other rooms' models, weighed by the room's own log, or alike;
/// and what the weighed counter itself expects, by its probabilities.
struct RoomErrors {
  std::vector<std::optional<double>> weighed, stated, alike;
  FigureErrors figures;  ///< of all rooms
};
[[nodiscard]] RoomErrors errors_of_rooms(const counting::Counter& counter,
                                         std::span<const counting::LabelledRoom> rooms, unsigned threads);

/// The mean of the rooms' errors by weight, and the interval of nine tenths of all rooms; both are larger where the
/// counter itself expects more of the log (`stated`) than on average of the rooms.
void expect_error(const RoomErrors& errors, std::span<const double> weights, double stated, Calibration& made);

/// Readings that a score counts: from half an hour before the first person to half an hour after the last.
[[nodiscard]] std::vector<bool> in_use(const std::vector<int>& people, double step_s);

// Is a room one of these, by statistics of its motion?

/// Share of the rows, and the vector, that are at least as unlike all others as the vector is: a conformal p value,
/// valid at any number of rows if the vector is one more of them. Unlikeness is Mahalanobis' distance from the mean of
/// the others. rows: (rooms x statistics), more than one.
[[nodiscard]] double unlike_share(const stats::Matrix<double>& rows, std::span<const double> vector);
/// The same of one entry: by its distance from the median.
[[nodiscard]] double unlike_share(std::span<const double> values, double value);

// What motion tells of a room without counts, in a few numbers.

struct StatisticInfo {
  std::string name, unit;
  enum class Scale {
    plain,
    logarithm  ///< of a length in readings: told in minutes
  } scale = Scale::plain;
  Statistic::About about = Statistic::About::motion;
  std::string more{}, less{};  ///< of what it is a sign, as Statistic::sign
};
/// A statistic in its unit.
[[nodiscard]] double told(const StatisticInfo& info, double value, double step_s);
/// Of a room with so many sensors.
[[nodiscard]] std::vector<StatisticInfo> statistics_of(int n_sensors);

/// (statistics) of each stretch that has enough motion to tell.
[[nodiscard]] std::vector<std::vector<double>> motion_statistics(std::span<const counting::Stretch> stretches,
                                                                 double step_s);

}  // namespace pirsim::calibrate
