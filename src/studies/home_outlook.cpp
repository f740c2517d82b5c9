#include "studies/home_outlook.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <iomanip>
#include <ostream>

#include "core/grouped_warnings.hpp"
#include "core/text.hpp"
#include "pirsim/geometry.hpp"
#include "schema/clock.hpp"
#include "sim/home_plan.hpp"

namespace pirsim::studies {
namespace {

using sim::HomeActivity;

constexpr std::size_t at(HomeActivity activity) { return static_cast<std::size_t>(activity); }
HomeActivity activity_of(std::size_t index) { return static_cast<HomeActivity>(index); }

void add_day(ExpectedResident& resident, const std::vector<sim::HomeStay>& stays) {
  for (const sim::HomeStay& stay : stays) resident.mean_s[at(stay.activity)] += stay.to_s - stay.from_s;
  // Who is up at four, or goes to bed after it, is so at the ends of the day.
  const auto is_up = [](const sim::HomeStay& stay) {
    return stay.activity != HomeActivity::sleep && stay.activity != HomeActivity::toilet;
  };
  const auto first = std::ranges::find_if(stays, is_up);
  const auto last = std::ranges::find_if(stays.rbegin(), stays.rend(), is_up);
  if (first == stays.end()) return;
  resident.mean_up_s += first->from_s;
  resident.mean_to_bed_s += last->to_s;
}

/// "23:10", also after midnight.
std::string time_of_day_text(double seconds) { return clock_text(0, seconds).substr(11, 5); }

void print_resident(std::ostream& out, const ExpectedResident& resident) {
  out << "  " << std::left << std::setw(12) << resident.id << std::right << " bed " << resident.bed << "; up "
      << time_of_day_text(resident.mean_up_s) << '-' << time_of_day_text(resident.mean_to_bed_s) << "; hours a day:" << std::fixed
      << std::setprecision(1);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < resident.mean_s.size(); ++i)
    if (resident.mean_s[i] > 0.0) order.push_back(i);
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t i) { return resident.mean_s[i]; });
  for (const std::size_t i : order)
    out << (i == order.front() ? " " : ", ") << sim::manner_of(activity_of(i)).phase << ' '
        << resident.mean_s[i] / 3600.0;
  out << '\n';
}

/// The place of somebody else over which a resident gets into their own bed, or nullptr.
const PlaceSpec* place_between(const SceneSpec& scene, const std::string& own, const sim::LyingPlan& plan) {
  constexpr double beside_m = 0.4;  // assumed: half a sleeper's width and some (0.3-0.5)
  const auto bed = std::ranges::find(scene.places, own, &PlaceSpec::id);
  const Vec2 from = floor_point(bed->world_from_place.origin), to = plan.edge.stand(plan.edge.place.world_from_seat);
  const Vec2 along = glm::normalize(to - from);
  for (const PlaceSpec& other : scene.places) {
    if (&other == &*bed || other.posture != PlacePosture::lie) continue;
    const Vec2 away = floor_point(other.world_from_place.origin) - from;
    const double ahead_m = glm::dot(away, along);
    if (ahead_m > beside_m && ahead_m < glm::distance(from, to) && glm::distance(away, ahead_m * along) < beside_m)
      return &other;
  }
  return nullptr;
}

/// Who can't get out while the other one sleeps.
void warn_of_beds(const sim::CompiledStudy& study, const sim::TrialModel& trial, Diagnostics& told) {
  for (const sim::PersonModel& person : trial.people) {
    if (!person.spec.part || person.spec.part->part != SchedulePart::resident) continue;
    const std::string& own = person.spec.part->seat;
    const auto plan = person.beds.find(own);
    const PlaceSpec* between = plan == person.beds.end() ? nullptr : place_between(study.scene(), own, plan->second);
    if (between == nullptr) continue;
    told.warning(
        {study.scene().name},
        "'" + person.spec.id + "' gets into '" + own + "' over '" + between->id +
            "', and stays in bed while somebody sleeps there: no way leads to a place to stand at its own side");
  }
}

}  // namespace

HomeOutlook home_outlook(const sim::CompiledStudy& study, std::size_t trial, int most_days) {
  const sim::TrialModel& model = study.trials()[trial];
  const HouseholdSpec& household = *model.schedule->household;
  const auto n_trials = static_cast<std::uint32_t>(study.trials().size());
  HomeOutlook result;
  result.first_day = sim::day_of(study, static_cast<std::uint32_t>(trial));
  result.days =
      static_cast<int>(std::min<std::uint32_t>(study.n_runs() / n_trials, static_cast<std::uint32_t>(most_days)));
  for (const sim::PersonModel& person : model.people) {
    const auto& part = person.spec.part;
    if (part && part->part == SchedulePart::resident) result.residents.push_back({person.spec.id, part->seat});
  }
  for (int k = 0; k < result.days; ++k) {
    const auto run = static_cast<std::uint32_t>(k) * n_trials + static_cast<std::uint32_t>(trial);
    const std::int64_t day = sim::day_of(study, run);
    const sim::HomeDay drawn = sim::draw_home_day(household, study.seed(), run, day);
    result.working_days += is_working_day(day) ? 1 : 0;
    result.visits += static_cast<int>(drawn.visits.size());
    for (std::size_t i = 0; i < result.residents.size(); ++i) add_day(result.residents[i], drawn.residents[i]);
  }
  const double n = std::max(1, result.days);
  for (ExpectedResident& resident : result.residents) {
    resident.mean_up_s /= n, resident.mean_to_bed_s /= n;
    for (double& mean_s : resident.mean_s) mean_s /= n;
  }
  return result;
}

void print(std::ostream& out, const HomeOutlook& outlook) {
  out << "household: " << counted(static_cast<std::size_t>(outlook.days), "day") << " from "
      << clock_text(outlook.first_day, 0.0).substr(0, 10) << " ("
      << counted(static_cast<std::size_t>(outlook.working_days), "working day")
      << "), each from 04:00 to 04:00; means as drawn, before anybody has walked\n";
  for (const ExpectedResident& resident : outlook.residents) print_resident(out, resident);
  out << "  visits: " << outlook.visits << "\n\n";
}

std::vector<Issue> warnings_of_home(const sim::CompiledStudy& study) {
  const auto has_household = [](const sim::TrialModel& trial) { return trial.schedule && trial.schedule->household; };
  const auto home = std::ranges::find_if(study.trials(), has_household);
  if (home == study.trials().end()) return {};
  const bool someone_works_there = std::ranges::any_of(home->schedule->household->residents, [](const auto& resident) {
    return resident.occupation == Occupation::works_at_home;
  });
  GroupedWarnings lacking;
  for (std::size_t i = 0; i < sim::n_home_activities; ++i) {
    if (activity_of(i) == HomeActivity::work && !someone_works_there) continue;
    const sim::HomeManner manner = sim::manner_of(activity_of(i));
    if (sim::has_place_for(study.scene(), activity_of(i))) continue;
    lacking.add("no place", home->schedule->where, manner.phase,
                std::string("household: no place for ") + manner.phase + " (`for: [" +
                    std::string(manner.uses.front()) + "]` in its mark): residents do that where they are");
  }
  Diagnostics told;
  lacking.tell(told);
  warn_of_beds(study, *home, told);
  return told.warnings();
}

}  // namespace pirsim::studies
