// How a crowd fares, as CSV: many runs of people who enter a room, sit, and leave. docs/physics/people.md tells the
// results.
//   pirsim_crowd_trials SCENE CASE PEOPLE RUNS [--incidents FILE] [--tracks FILE RUN] [--threads N] [--seed N]
#include <fstream>
#include <iostream>
#include <map>

#include "model/core/parallel.hpp"
#include "pirsim/error.hpp"
#include "stats/intervals.hpp"
#include "support/crowd_watch.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

const std::map<std::string, CrowdPlan::Case> cases{{"mingled", CrowdPlan::Case::mingled},
                                                   {"in_turn", CrowdPlan::Case::in_turn},
                                                   {"one_enters", CrowdPlan::Case::one_enters}};

struct Options {
  std::string scene, kind;
  CrowdPlan plan;
  std::uint32_t n_runs = 0;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  std::ofstream incidents, tracks;
  std::uint32_t tracked_run = 0;
};

Options parse(const std::vector<std::string>& words) {
  if (words.size() < 4) throw Error(ErrorCode::usage, "SCENE CASE PEOPLE RUNS are needed");
  Options options;
  options.scene = words[0];
  options.kind = words[1];
  options.n_runs = std::uint32_t(std::stoul(words[3]));
  options.plan.kind = cases.at(words[1]);
  options.plan.n_people = std::uint32_t(std::stoul(words[2]));
  if (options.plan.kind == CrowdPlan::Case::in_turn) options.plan.statures = CrowdPlan::Statures::one;
  for (std::size_t i = 4; i < words.size(); ++i) {
    if (words[i] == "--threads") options.threads = unsigned(std::stoul(words.at(++i)));
    if (words[i] == "--seed") options.seed = std::stoull(words.at(++i));
    if (words[i] == "--incidents") options.incidents.open(words.at(++i));
    if (words[i] == "--tracks") {
      options.tracks.open(words.at(++i));
      options.tracks << "time_s,person,x_m,z_m,heading,stage,seat,passes_through,asks_for_way\n";
      options.tracked_run = std::uint32_t(std::stoul(words.at(++i)));
    }
  }
  return options;
}

/// Five rows a second and person.
void track(std::ostream& out, const sim::RunState& state) {
  if (state.tick % 10 != 0) return;
  for (const sim::Actor& actor : state.crowd.actors()) {
    if (!actor.present()) continue;
    const sim::Presence presence = actor.presence();
    out << 0.02 * double(state.tick) << ',' << actor.person().spec.id << ',' << presence.position.x << ','
        << presence.position.y << ',' << actor.motion().heading() << ',' << body::name(actor.motion().stage()) << ','
        << actor.seat() << ',' << (presence.solidity == sim::Presence::Solidity::passing_through ? 1 : 0) << ','
        << (presence.wished_way ? 1 : 0) << '\n';
  }
}

struct Totals {
  std::size_t people = 0, entries = 0, passes = 0, changed = 0, missed = 0, never_left = 0, never_sat = 0;
  std::size_t runs_with_overlap = 0, runs_with_pass = 0;
  double least_gap_m = 1e9;
  std::vector<double> door_to_seat_s, due_to_seat_s, called_to_gone_s;

  void add(const CrowdRecord& record, CrowdPlan::Case kind) {
    people += record.stays.size();
    passes += record.count(IncidentKind::passed_through);
    changed += record.count(IncidentKind::seat_changed);
    missed += record.count(IncidentKind::seat_missed);
    runs_with_pass += record.count(IncidentKind::passed_through) > 0 ? 1 : 0;
    runs_with_overlap += record.least_gap_m < 0.0 ? 1 : 0;
    least_gap_m = std::min(least_gap_m, record.least_gap_m);
    for (const Stay& stay : record.stays) {
      entries += stay.came_s >= 0.0 ? 1 : 0;
      never_left += stay.came_s >= 0.0 && stay.left_s < 0.0 ? 1 : 0;
      never_sat += stay.came_s >= 0.0 && stay.sat_s < 0.0 ? 1 : 0;
      if (stay.sat_s < 0.0 || (kind == CrowdPlan::Case::one_enters && &stay != &record.stays.back())) continue;
      door_to_seat_s.push_back(stay.sat_s - stay.came_s);
      due_to_seat_s.push_back(stay.sat_s - stay.due_s);
      if (stay.called_s > 0.0) called_to_gone_s.push_back(stay.left_s - stay.called_s);
    }
  }
};

void report(const Options& options, const Totals& totals) {
  const auto quantile = [](const std::vector<double>& values, double at) {
    return values.empty() ? -1.0 : stats::quantile(values, at);
  };
  const auto share = stats::clopper_pearson(std::min(totals.passes, totals.entries), totals.entries);
  std::cout << "scene,case,people,runs,entries,passes,per_200,low,high,runs_with_pass,seats_changed,seats_missed,"
               "never_sat,never_left,runs_with_overlap,least_gap_m,door_to_seat_median_s,p90,max,due_to_seat_median_s,"
               "p90,max,called_to_gone_median_s,p90,max\n"
            << options.scene << ',' << options.kind << ',' << options.plan.n_people << ',' << options.n_runs << ','
            << totals.entries << ',' << totals.passes << ',' << 200.0 * double(totals.passes) / double(totals.entries)
            << ',' << 200.0 * share.low << ',' << 200.0 * share.high << ',' << totals.runs_with_pass << ','
            << totals.changed << ',' << totals.missed << ',' << totals.never_sat << ',' << totals.never_left << ','
            << totals.runs_with_overlap << ',' << totals.least_gap_m;
  for (const auto* values : {&totals.door_to_seat_s, &totals.due_to_seat_s, &totals.called_to_gone_s}) {
    for (const double at : {0.5, 0.9, 1.0}) std::cout << ',' << quantile(*values, at);
  }
  std::cout << std::endl;
}

void run(Options& options) {
  const SceneSpec scene = shipped_scene(options.scene);
  Totals totals;
  constexpr std::uint32_t batch = 100;  // trials that are compiled together
  for (std::uint32_t first = 0; first < options.n_runs; first += batch) {
    const std::uint32_t n = std::min(batch, options.n_runs - first);
    const ScriptSpec script = random_crowds(scene, options.plan, options.seed, first, n);
    const Model model = compile(scene, script);
    std::uint32_t trial = first;
    ordered_parallel<CrowdRecord>(
        n, options.threads,
        [&](std::size_t i) {
          const bool tracked = options.tracks.is_open() && first + i == options.tracked_run;
          CrowdRecord record = watch_crowd(model, std::uint32_t(i), 2, [&](const sim::RunState& state) {
            if (tracked) track(options.tracks, state);
          });
          for (std::size_t k = 0; k < record.stays.size(); ++k) {
            const auto& actions = script.trials[i].people[k].actions;
            record.stays[k].due_s = std::get<action::Wait>(actions.front().what).duration_s;
            record.stays[k].called_s = actions.back().at_s.value_or(0.0);
          }
          return record;
        },
        [&](CrowdRecord& record) {
          totals.add(record, options.plan.kind);
          for (const sim::Incident& incident : record.incidents) {
            options.incidents << trial << ',' << int(incident.kind) << ',' << 0.02 * double(incident.tick) << ",p"
                              << incident.person + 1 << ',' << incident.place.x << ',' << incident.place.y << '\n';
          }
          if (record.least_gap_m < 0.0) {
            options.incidents << trial << ",overlap," << record.least_gap_at_s << ",p" << record.least_gap_of[0] + 1
                              << "+p" << record.least_gap_of[1] + 1 << ',' << record.least_gap_m << ','
                              << body::name(record.least_gap_in[0]) << '+' << body::name(record.least_gap_in[1])
                              << '\n';
          }
          ++trial;
        });
  }
  report(options, totals);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Options options = parse({argv + 1, argv + argc});
    run(options);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
