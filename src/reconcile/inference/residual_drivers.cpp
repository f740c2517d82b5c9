#include "reconcile/inference/residual_drivers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace pirsim::reconcile {
namespace {

Who who(const ReferenceStudy& reference, std::string name, bool any_seat,
        const std::function<bool(std::size_t trial, std::size_t sensor)>& holds) {
  Who one{std::move(name), {}, any_seat};
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

  void add(const std::string& name, const std::function<double(double time_s, double length_s)>& weight) {
    When when{name, false, {}};
    for (const Profile::Trial& trial : reference_.table.profile.trials) {
      when.weight.emplace_back();
      const double length_s = static_cast<double>(trial.n_main) * reference_.frame.window_s;
      double mean = 0.0;
      for (std::size_t row = 0; row < trial.n_main; ++row) {
        when.weight.back().push_back(weight((static_cast<double>(row) + 0.5) * reference_.frame.window_s, length_s));
        mean += when.weight.back().back() / static_cast<double>(trial.n_main);
      }
      if (name.empty()) continue;  // always
      for (double& w : when.weight.back()) w -= mean;
    }
    all.push_back(std::move(when));
  }
  void add_part(const std::string& name, double from, double to) {
    add(name, [=](double t, double length) { return t >= from * length && t < to * length ? 1.0 : 0.0; });
  }
  /// n equal parts of every period; name_of(begin, end).
  void add_phases(double period_s, int n, const std::function<std::string(double, double)>& name_of) {
    for (int i = 0; i < n; ++i) {
      const double begin = period_s * i / n, end = period_s * (i + 1) / n;
      add(name_of(begin, end), [=](double t, double) {
        const double phase = std::fmod(t, period_s);
        return phase >= begin && phase < end ? 1.0 : 0.0;
      });
    }
  }

  std::vector<When> all;

 private:
  const ReferenceStudy& reference_;
};

std::string seconds(double value) { return std::to_string(std::lround(value)); }

const action::Work* first_work(const ScriptSpec& script) {
  for (const TrialSpec& trial : script.trials) {
    for (const PersonSpec& person : trial.people) {
      for (const ScriptedAction& step : person.actions) {
        if (const auto* work = std::get_if<action::Work>(&step.what)) return work;
      }
    }
  }
  return nullptr;
}

void add_posture(Times& times, double period_s) {
  constexpr int parts = 6;
  times.add_phases(period_s, parts, [&](double begin, double end) {
    if (end > period_s - 1e-9) return "in the last " + seconds(end - begin) + " s before each change of posture";
    return (begin == 0.0 ? "in the first " + seconds(end) + " s"
                         : "from " + seconds(begin) + " to " + seconds(end) + " s") +
           " after each change of posture";
  });
}

void add_waves(Times& times, double longest_s) {
  constexpr std::array<double, 11> periods_s{40, 45, 50, 56, 63, 71, 80, 90, 101, 113, 127};
  constexpr int phases = 8;
  for (const double period_s : periods_s) {
    if (1.5 * period_s > longest_s) continue;
    for (int i = 0; i < phases; ++i) {
      const double top_s = period_s * i / phases;
      times.add("rising and falling every " + seconds(period_s) + " s, most around second " + seconds(top_s),
                [=](double t, double) { return std::cos(2.0 * std::numbers::pi * (t - top_s) / period_s); });
      times.all.back().is_wave = true;
    }
  }
}

}  // namespace

std::vector<Who> all_who(const ReferenceStudy& reference) {
  std::vector<Who> all{who(reference, "all sensors", true, [](auto, auto) { return true; })};
  const StudyFrame& frame = reference.frame;
  for (std::size_t s = 0; s < frame.sensors.size(); ++s)
    all.push_back(who(reference, frame.sensors[s], true, [s](auto, std::size_t sensor) { return sensor == s; }));
  for (std::size_t t = 0; t < frame.trials.size(); ++t)
    all.push_back(who(reference, frame.trials[t], false, [t](std::size_t trial, auto) { return trial == t; }));
  const auto knowledge = [&](std::size_t trial, std::size_t sensor) -> const CellKnowledge& {
    return reference.knowledge[trial * frame.sensors.size() + sensor];
  };
  std::vector<double> distances;
  for (const CellKnowledge& cell : reference.knowledge) distances.push_back(cell.distance_m);
  const double near = stats::quantile(distances, 1.0 / 3.0), far = stats::quantile(distances, 2.0 / 3.0);
  all.push_back(who(reference, "sensors near the seat", true,
                    [&](std::size_t t, std::size_t s) { return knowledge(t, s).distance_m < near; }));
  all.push_back(who(reference, "sensors far from the seat", true,
                    [&](std::size_t t, std::size_t s) { return knowledge(t, s).distance_m > far; }));
  all.push_back(who(reference, "sensors that the sitter faces", true,
                    [&](std::size_t t, std::size_t s) { return knowledge(t, s).facing > 0.5; }));
  all.push_back(who(reference, "sensors behind the sitter", true,
                    [&](std::size_t t, std::size_t s) { return knowledge(t, s).facing < -0.5; }));
  return all;
}

std::vector<When> all_when(const ReferenceStudy& reference) {
  Times times(reference);
  double longest_s = 0.0;
  for (const Profile::Trial& trial : reference.table.profile.trials)
    longest_s = std::max(longest_s, static_cast<double>(trial.n_main) * reference.frame.window_s);
  times.add("", [](double, double) { return 1.0; });
  times.add_part("in the first half of each run", 0.0, 0.5);
  times.add_part("in the second half of each run", 0.5, 1.0);
  times.add_part("in the first third of each run", 0.0, 1.0 / 3.0);
  times.add_part("in the middle third of each run", 1.0 / 3.0, 2.0 / 3.0);
  times.add_part("in the last third of each run", 2.0 / 3.0, 1.0);
  constexpr double minute_s = 60.0;
  if (longest_s >= 2.0 * minute_s) {
    times.add_phases(minute_s, 10, [](double begin, double end) {
      return begin == 0.0 ? "in the first " + seconds(end) + " s of each minute"
                          : "from second " + seconds(begin) + " to " + seconds(end) + " of each minute";
    });
  }
  if (const action::Work* work = first_work(reference.source.script)) {
    if (longest_s >= 2.0 * work->tilt_every_s && work->tilt_choices_deg.size() > 1)
      add_posture(times, work->tilt_every_s);
    times.add_phases(work->arm_period_s, 3, [&](double begin, double end) {
      return "from " + seconds(100.0 * begin / work->arm_period_s) + " to " +
             seconds(100.0 * end / work->arm_period_s) + " % of the arm's cycle";
    });
  }
  add_waves(times, longest_s);
  return std::move(times.all);
}

std::string in_words(How how, bool up, const std::string& other) {
  switch (how) {
    case How::more:
      return up ? "more motion than expected" : "less motion than expected";
    case How::more_where_little:
      return up ? "motion where hardly any is expected" : "still less motion where hardly any is expected";
    case How::more_where_much:
      return up ? "still more motion where much is expected" : "less motion where much is expected";
    case How::opposite:
      return up ? "the opposite of what is expected" : "what is expected, but too surely";
    case How::beside:
      break;
  }
  return up ? "motion whenever " + other + " sees some" : "silence whenever " + other + " sees motion";
}

}  // namespace pirsim::reconcile
