#include "reconcile/inference/residual_drivers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "schema/action_facts.hpp"
#include "stats/intervals.hpp"

namespace pirsim::reconcile {
namespace {

using DriverWhen = ResidualDriver::When;

Who cells_of(const ReferenceStudy& reference, ResidualDriver::Who who, std::string name,
             const std::function<bool(std::size_t trial, std::size_t sensor)>& holds) {
  Who one{who, std::move(name), {}};
  for (std::size_t trial = 0; trial < reference.frame.trials.size(); ++trial) {
    for (std::size_t sensor = 0; sensor < reference.frame.sensors.size(); ++sensor)
      one.cells.push_back(holds(trial, sensor) ? 1 : 0);
  }
  return one;
}

/// Adds what depends on the time since the main part began and on its length alone. Weights have the mean 0 in each
/// run, so that a seat or a sensor that sees more all the time isn't taken for a matter of time.
class Times {
 public:
  explicit Times(const ReferenceStudy& reference) : reference_(reference) {}

  void add(ResidualDriver::When kind, double from, double to,
           const std::function<double(double time_s, double length_s)>& weight) {
    When when{kind, from, to, {}};
    for (const Profile::Trial& trial : reference_.table.profile.trials) {
      when.weight.emplace_back();
      const double length_s = static_cast<double>(trial.n_main) * reference_.frame.window_s;
      double mean = 0.0;
      for (std::size_t row = 0; row < trial.n_main; ++row) {
        when.weight.back().push_back(weight((static_cast<double>(row) + 0.5) * reference_.frame.window_s, length_s));
        mean += when.weight.back().back() / static_cast<double>(trial.n_main);
      }
      if (when.is_always()) continue;
      for (double& w : when.weight.back()) w -= mean;
    }
    all.push_back(std::move(when));
  }
  /// A part of the run, from and to as shares of its length.
  void add_part(ResidualDriver::When kind, double from, double to) {
    add(kind, from, to, [=](double t, double length) { return t >= from * length && t < to * length ? 1.0 : 0.0; });
  }
  /// n equal parts of every period; kind_of(begin, end) says what they are.
  void add_phases(double period_s, int n, const std::function<When(double, double)>& kind_of) {
    for (int i = 0; i < n; ++i) {
      const double begin = period_s * i / n, end = period_s * (i + 1) / n;
      const When kind = kind_of(begin, end);
      add(kind.when, kind.from, kind.to, [=](double t, double) {
        const double phase = std::fmod(t, period_s);
        return phase >= begin && phase < end ? 1.0 : 0.0;
      });
    }
  }

  std::vector<When> all;

 private:
  const ReferenceStudy& reference_;
};

const action::Work* first_work(const ScriptSpec& script) {
  for (const TrialSpec& trial : script.trials) {
    if (const auto* work = first<action::Work>(trial)) return work;
  }
  return nullptr;
}

void add_posture(Times& times, double period_s) {
  constexpr int parts = 6;
  times.add_phases(period_s, parts, [&](double begin, double end) {
    return When{end > period_s - 1e-9 ? DriverWhen::before_posture : DriverWhen::after_posture, begin, end, {}};
  });
}

void add_waves(Times& times, double longest_s) {
  constexpr std::array<double, 11> periods_s{40, 45, 50, 56, 63, 71, 80, 90, 101, 113, 127};
  constexpr int phases = 8;
  for (const double period_s : periods_s) {
    if (1.5 * period_s > longest_s) continue;
    for (int i = 0; i < phases; ++i) {
      const double top_s = period_s * i / phases;
      times.add(DriverWhen::wave, period_s, top_s,
                [=](double t, double) { return std::cos(2.0 * std::numbers::pi * (t - top_s) / period_s); });
    }
  }
}

}  // namespace

std::vector<Who> all_who(const ReferenceStudy& reference) {
  using enum ResidualDriver::Who;
  std::vector<Who> all{cells_of(reference, all_sensors, {}, [](auto, auto) { return true; })};
  const StudyFrame& frame = reference.frame;
  for (std::size_t s = 0; s < frame.sensors.size(); ++s)
    all.push_back(cells_of(reference, sensor, frame.sensors[s], [s](auto, std::size_t number) { return number == s; }));
  for (std::size_t t = 0; t < frame.trials.size(); ++t)
    all.push_back(cells_of(reference, trial, frame.trials[t], [t](std::size_t number, auto) { return number == t; }));
  const auto knowledge = [&](std::size_t t, std::size_t s) -> const CellKnowledge& {
    return reference.knowledge[frame.cell(t, s)];
  };
  std::vector<double> distances;
  for (const CellKnowledge& cell : reference.knowledge) distances.push_back(cell.distance_m);
  const double near = stats::quantile(distances, 1.0 / 3.0), far = stats::quantile(distances, 2.0 / 3.0);
  all.push_back(cells_of(reference, near_seat, {},
                         [&](std::size_t t, std::size_t s) { return knowledge(t, s).distance_m < near; }));
  all.push_back(cells_of(reference, far_from_seat, {},
                         [&](std::size_t t, std::size_t s) { return knowledge(t, s).distance_m > far; }));
  all.push_back(
      cells_of(reference, faced, {}, [&](std::size_t t, std::size_t s) { return knowledge(t, s).facing > 0.5; }));
  all.push_back(
      cells_of(reference, behind, {}, [&](std::size_t t, std::size_t s) { return knowledge(t, s).facing < -0.5; }));
  return all;
}

std::vector<When> all_when(const ReferenceStudy& reference) {
  Times times(reference);
  double longest_s = 0.0;
  for (const Profile::Trial& trial : reference.table.profile.trials)
    longest_s = std::max(longest_s, static_cast<double>(trial.n_main) * reference.frame.window_s);
  times.add(DriverWhen::always, 0.0, 0.0, [](double, double) { return 1.0; });
  times.add_part(DriverWhen::first_half, 0.0, 0.5);
  times.add_part(DriverWhen::second_half, 0.5, 1.0);
  times.add_part(DriverWhen::first_third, 0.0, 1.0 / 3.0);
  times.add_part(DriverWhen::middle_third, 1.0 / 3.0, 2.0 / 3.0);
  times.add_part(DriverWhen::last_third, 2.0 / 3.0, 1.0);
  constexpr double minute_s = 60.0;
  if (longest_s >= 2.0 * minute_s) {
    times.add_phases(minute_s, 10, [](double begin, double end) {
      return When{DriverWhen::of_minute, begin, end, {}};
    });
  }
  if (const action::Work* work = first_work(reference.source.script)) {
    if (longest_s >= 2.0 * work->tilt_every_s && work->tilt_choices_deg.size() > 1)
      add_posture(times, work->tilt_every_s);
    times.add_phases(work->arm_period_s, 3, [&](double begin, double end) {
      return When{DriverWhen::of_arm_cycle, 100.0 * begin / work->arm_period_s, 100.0 * end / work->arm_period_s, {}};
    });
  }
  add_waves(times, longest_s);
  return std::move(times.all);
}

}  // namespace pirsim::reconcile
