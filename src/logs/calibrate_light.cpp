#include "logs/calibrate_light.hpp"

#include "pirsim/calibrate.hpp"

namespace pirsim::control {

CountedSamples::CountedSamples(const Log& log, const counting::Counter& counter)
    : samples_(log, counter.settings.step_s), about_(samples_.about()) {
  about_.people = People::known;
  constexpr int n_draws = 100;  // the middle 90 % of them are told
  const calibrate::LogTraits traits = calibrate::traits_of(facts_of(log));
  const LogRows rows = LogWindows(log, counter.settings.step_s).rows();
  const calibrate::LogCounts counts = calibrate::count_log(counter, rows, traits, counting::Pass::smoothed);
  const counting::Estimates forward = calibrate::count_log(counter, rows, traits, counting::Pass::forward).estimates;
  if (!counts.warning.empty()) remarks_.push_back({Severity::warning, {}, counts.warning});
  for (const std::string& remark : counts.remarks) remarks_.push_back({Severity::warning, {}, remark});
  for (std::size_t i = 0; i < rows.n_windows(); ++i) {
    people_.push_back(counts.estimates.count(i));
    nobody_.push_back(forward.probabilities[i * static_cast<std::size_t>(forward.n_counts)]);
  }
  courses_ = counting::draw_people(counter, calibrate::whole_log(rows), n_draws);
}

void CountedSamples::each_counted(const TakeCounted& take) const {
  std::size_t reading = 0;
  Sample counted;
  samples_.each([&](const Sample& row, std::string_view day) { take(counted = row, day, reading++); }, [] {});
}

std::int64_t CountedSamples::each(const TakeRow& take, const std::function<void()>& /*begin*/) const {
  each_counted([&](Sample& row, std::string_view day, std::size_t reading) {
    row.people = people_[reading];
    take(row, day);
  });
  return 0;
}

Costs CountedSamples::expected_costs(const RuleSpec& rule) const {
  std::vector<Control> controls;
  for (std::size_t draw = 0; draw < courses_.size(); ++draw)
    controls.emplace_back(rule, about().columns, about().window_s, People::expected);
  each_counted([&](Sample& row, std::string_view day, std::size_t reading) {
    for (std::size_t draw = 0; draw < courses_.size(); ++draw) {
      row.people = courses_[draw][reading];
      controls[draw].add(row, day, nobody_[reading]);
    }
  });
  std::vector<Costs> costs;
  for (const Control& control : controls) costs.push_back(control.finish());
  return expected_of(costs);
}

}  // namespace pirsim::control
