#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>
#include <utility>

#include "core/text.hpp"
#include "effects/catalogue.hpp"
#include "reconcile/report/pages.hpp"
#include "reconcile/report/sentences.hpp"

namespace pirsim::reconcile {
namespace {

std::string with_sign(double value) {
  const std::string text = fixed(value, 0);
  return (value > 0.0 && text != "0" ? "+" : "") + text;
}

/// Names in the order in which they first come.
std::vector<std::string> distinct(const std::vector<LocatedCell>& cells, std::string LocatedCell::*which) {
  std::vector<std::string> names;
  for (const LocatedCell& cell : cells) {
    if (std::ranges::find(names, cell.*which) == names.end()) names.push_back(cell.*which);
  }
  return names;
}

io::GridChart::Cell square(const LocatedCell& cell, double alpha) {
  const double difference = cell.measured_s - cell.expected_s;
  return {difference, with_sign(difference),
          "measured " + fixed(cell.measured_s, 1) + " s, model " + fixed(cell.expected_s, 1) + " s, usually " +
              fixed(cell.low_s, 0) + " to " + fixed(cell.high_s, 0) + " s",
          cell.adjusted_p <= alpha ? io::GridChart::Mark::framed : io::GridChart::Mark::none};
}

/// Where a number lies if its envelope is stretched to reach from -1 to 1, with the median at 0.
double beside_band(const EnvelopeFeature& feature) {
  const double d = feature.observed - feature.median;
  const double half = d > 0.0 ? feature.upper - feature.median : feature.median - feature.lower;
  constexpr double beyond_any_limit = 1e3;
  if (half > 0.0) return std::clamp(d / half, -beyond_any_limit, beyond_any_limit);
  return d == 0.0 ? 0.0 : std::copysign(beyond_any_limit, d);
}

/// What is measured, whoever's it is: a row of the picture.
std::string subject_of(const FeatureName& feature) {
  if (feature.kind == FeatureName::Kind::share_of_time) return "how motion spreads over the time";
  if (feature.kind == FeatureName::Kind::together) return "motion while another sensor moves";
  return in_plain_words(feature.statistic);
}

std::string place_of(const FeatureName& feature) {
  switch (feature.kind) {
    case FeatureName::Kind::cell:
      return feature.trial + " " + feature.sensor;
    case FeatureName::Kind::sensor:
      return feature.sensor;
    case FeatureName::Kind::mean:
      return "all cells, mean";
    case FeatureName::Kind::size:
      return "all cells, mean size of the differences";
    default:
      return in_words(feature);
  }
}

}  // namespace

std::string in_plain_words(const std::string& statistic) {
  static const std::map<std::string, std::string> words{{"seconds", "seconds with motion"},
                                                        {"busy_seconds", "motion when people change posture"},
                                                        {"silent_seconds", "motion when silence is expected"},
                                                        {"half_difference", "first half less second half"},
                                                        {"onsets", "how often motion begins"},
                                                        {"longest_run", "longest stretch of motion"},
                                                        {"isolated", "single seconds with motion"},
                                                        {"single_gaps", "gaps of one second"},
                                                        {"double_gaps", "gaps of two seconds"},
                                                        {"longest_gap", "longest silence"},
                                                        {"dispersion", "motion comes in clumps"},
                                                        {"period_power", "motion comes periodically"},
                                                        {"cycle_strength", "motion keeps time with the arms"},
                                                        {"agreement", "motion comes when expected"},
                                                        {"shift_s", "motion comes later than expected"},
                                                        {"lead_seconds", "motion before the main part"},
                                                        {"tail_seconds", "motion after the main part"},
                                                        {"late_tail_seconds", "motion long after the main part"},
                                                        {"run_variance", "runs differ from one another"}};
  if (const auto found = words.find(statistic); found != words.end()) return found->second;
  constexpr std::string_view again = "again_after_";
  if (statistic.starts_with(again)) return "motion again " + statistic.substr(again.size()) + " s later";
  constexpr std::string_view sixth = "sixth_";
  if (statistic.starts_with(sixth)) return "motion in part " + statistic.substr(sixth.size()) + " of 6";
  std::string text = statistic;
  std::ranges::replace(text, '_', ' ');
  return text;
}

io::GridChart difference_chart(const Location& location, double alpha) {
  io::GridChart chart;
  chart.title = "Measured less expected, seconds with motion";
  chart.note =
      "Orange: more motion was measured than the model expects; blue: less. A frame marks differences that chance and "
      "an inexactly known room don't explain.";
  chart.label = "seconds";
  chart.rows = distinct(location.cells, &LocatedCell::trial);
  chart.columns = distinct(location.cells, &LocatedCell::sensor);
  chart.colours = io::GridChart::Colours::about_zero;
  chart.max = 1.0;
  for (const std::string& trial : chart.rows) {
    for (const std::string& sensor : chart.columns) {
      const auto cell = std::ranges::find_if(
          location.cells, [&](const LocatedCell& c) { return c.trial == trial && c.sensor == sensor; });
      chart.cells.push_back(cell == location.cells.end()
                                ? io::GridChart::Cell{{}, "not measured", {}, io::GridChart::Mark::none}
                                : square(*cell, alpha));
      if (chart.cells.back().value) chart.max = std::max(chart.max, std::abs(*chart.cells.back().value));
    }
  }
  return chart;
}

io::BandChart envelope_chart(const Location& location, double alpha) {
  io::BandChart chart;
  chart.title = "All that was compared";
  chart.note =
      "Each dot is a number taken from the data, of one sensor or of all. The grey band holds what the model gives. "
      "Red dots lie outside: there the model is wrong. Point at a dot to see what it is.";
  chart.low = "less than the model";
  chart.high = "more than the model";
  chart.label = "deviation, in half-widths of the band";
  std::map<std::string, std::size_t> row_of;
  for (const EnvelopeFeature& feature : location.envelope) {
    const std::string subject = subject_of(feature.name);
    const auto [row, is_new] = row_of.try_emplace(subject, chart.rows.size());
    if (is_new) chart.rows.push_back({subject, {}});
    const bool outside = feature.adjusted_p <= alpha;
    chart.rows[row->second].points.push_back(
        {beside_band(feature),
         place_of(feature.name) + "\n" + subject + "\n" + (outside ? "outside" : "inside") + " the band, adjusted p " +
             short_number(feature.adjusted_p),
         outside ? io::BandChart::Point::Mark::outside : io::BandChart::Point::Mark::inside});
  }
  return chart;
}

io::BarChart ranking_chart(const Outcome& outcome) {
  io::BarChart chart;
  chart.title = "Which effect explains the data best";
  chart.note =
      "Long bars: likelier than the others. That alone decides nothing: only effects that can also make such data by "
      "themselves are kept (coloured).";
  chart.label = "probability among all hypotheses of the catalogue";
  constexpr double worth_drawing = 0.005;
  std::size_t left_out = 0;
  for (const Candidate& candidate : outcome.candidates) {
    const HypothesisScore& score = candidate.score;
    if (!candidate.kept && score.probability < worth_drawing) {
      ++left_out;
      continue;
    }
    chart.bars.push_back({score.hypothesis,
                          score.probability,
                          percent(score.probability) + (candidate.kept ? ", kept" : ""),
                          candidate.kept ? io::BarChart::Weight::strong : io::BarChart::Weight::faint,
                          {},
                          {},
                          in_words(candidate)});
  }
  if (left_out > 0) chart.note += " " + std::to_string(left_out) + " effects below 0.5 % are not drawn.";
  return chart;
}

std::vector<io::DotsChart> posterior_charts(const FittedEffect& fitted, const std::optional<RangeEnd>& end) {
  std::vector<io::DotsChart> charts;
  for (const FittedParameter& p : fitted.parameters) {
    const auto& infos = effects::find(fitted.effect.name).info.parameters;
    const auto info = std::ranges::find(infos, p.name, &effects::ParameterInfo::name);
    if (info == infos.end() || p.equally_likely.empty()) continue;
    io::DotsChart chart;
    chart.title = fitted.effect.name + ": " + p.name;
    const bool stepped = end && end->found && end->effect == fitted.effect.name && end->parameter == p.name;
    chart.note = stepped
                     ? "Each dot is a strength that was tried beyond the range looked for and with which the model can "
                       "have made the data. The shaded range spans them."
                     : "Each dot is as likely as any other to be the truth; in about nine cases of ten the truth lies "
                       "in the shaded range. The axis spans what was thought possible.";
    chart.label = p.unit;
    chart.values = p.equally_likely;
    chart.low = p.interval.low;
    chart.high = p.interval.high;
    chart.axis_low = info->low;
    chart.axis_high = info->high;
    chart.axis_low = std::min(chart.axis_low, chart.low);
    chart.axis_high = std::max(chart.axis_high, chart.high);
    if (info->scale == effects::Scale::logarithmic) {
      chart.scale = io::DotsChart::Scale::logarithmic;
    } else if (p.is_strength) {
      chart.axis_low = std::min(chart.axis_low, p.off);
      chart.axis_high = std::max(chart.axis_high, p.off);
    }
    if (p.is_strength) {
      chart.reference = p.off;
      chart.reference_label = "no effect";
    }
    charts.push_back(std::move(chart));
  }
  return charts;
}

io::BarChart held_out_chart(const Verification& v, const std::string& named) {
  io::BarChart chart;
  chart.title = "How far the model is from trials that it was not fitted on";
  chart.note =
      "Shorter is better. The last bar is what a right model comes to on average, since runs differ by chance; "
      "single data may lie nearer or farther.";
  chart.label = "distance (energy score)";
  const auto add = [&](const std::string& name, double value, io::BarChart::Weight weight) {
    chart.bars.push_back({name, value, fixed(value, 3), weight, {}, {}});
  };
  add("before: the model as it is", v.before.energy_score, io::BarChart::Weight::plain);
  add("after: with " + named, v.after.energy_score, io::BarChart::Weight::strong);
  if (!v.placebo_effect.empty()) {
    add("placebo: with " + v.placebo_effect + " instead", v.placebo, io::BarChart::Weight::faint);
  }
  add("the new model against itself", v.noise_floor, io::BarChart::Weight::faint);
  return chart;
}

std::string with_interval(const Rate& rate) {
  if (rate.of == 0) return "no case";
  return percent(rate.value()) + " (" + percent(rate.interval.low) + " to " + percent(rate.interval.high) + ", " +
         std::to_string(rate.hits) + " of " + std::to_string(rate.of) + ")";
}

std::string calibration_error(const SelftestResult& result) {
  return result.reliability.bins.empty() ? "no case" : fixed(result.reliability.expected_calibration_error, 3);
}

io::GridChart::Cell share_cell(const Rate& rate) {
  io::GridChart::Cell cell;
  cell.hint = with_interval(rate);
  if (rate.of == 0) return cell;
  cell.value = rate.value();
  cell.text = fixed(100.0 * rate.value(), 0);
  return cell;
}

io::GridChart confusion_grid(const std::vector<std::string>& hypotheses,
                             const std::vector<std::vector<double>>& shares) {
  constexpr double worth_a_number = 0.05;
  io::GridChart chart;
  chart.label = "share of a row";
  chart.rows = chart.columns = hypotheses;
  for (const std::vector<double>& row : shares) {
    const bool any = std::ranges::any_of(row, [](double share) { return share > 0.0; });
    for (const double share : row) {
      io::GridChart::Cell cell;
      if (any) cell.value = share;
      if (share >= worth_a_number) cell.text = fixed(100.0 * share, 0);
      cell.hint = any ? percent(share) : "no case";
      chart.cells.push_back(std::move(cell));
    }
  }
  return chart;
}

}  // namespace pirsim::reconcile
