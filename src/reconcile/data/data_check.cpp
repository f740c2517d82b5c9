#include "reconcile/data/data_check.hpp"

#include <algorithm>

#include "reconcile/data/data_checks.hpp"

namespace pirsim::reconcile {

double greatest_of(std::span<const DatasetRows> pilot, const std::function<double(const DatasetRows&)>& of) {
  double greatest = 0.0;
  for (const DatasetRows& dataset : pilot) greatest = std::max(greatest, of(dataset));
  return greatest;
}

namespace {

/// A dataset a realization: its trials ascend.
std::vector<DatasetRows> datasets_of(std::span<const Series> pilot, std::size_t n_sensors) {
  std::vector<DatasetRows> datasets;
  for (std::size_t begin = 0, end = 0; begin < pilot.size(); begin = end) {
    for (end = begin + 1; end < pilot.size() && pilot[end].trial > pilot[end - 1].trial;) ++end;
    datasets.push_back({pilot.subspan(begin, end - begin), n_sensors});
  }
  return datasets;
}

}  // namespace

std::vector<DataFinding> check_data(const StudyFrame& frame, const Measured& measured, std::span<const Series> pilot) {
  std::vector<DataFinding> findings;
  if (measured.kind != Measured::Kind::series) return findings;
  const DatasetRows data{measured.runs, frame.sensors.size()};
  const std::vector<DatasetRows> sets = datasets_of(pilot, frame.sensors.size());
  compare_columns(frame, data, sets, findings);
  find_constant(frame, data, sets, findings);
  find_beats(frame, data, sets, findings);
  find_polls(frame, data, sets, findings);
  find_repeat(frame, data, sets, findings);
  find_silence(frame, data, sets, findings);
  find_silent(frame, data, sets, findings);
  return findings;
}

bool any_impossible(std::span<const DataFinding> findings) noexcept {
  return std::ranges::any_of(findings, &DataFinding::is_impossible);
}

}  // namespace pirsim::reconcile
