#include "surveys/check_study.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <iomanip>
#include <iosfwd>
#include <ostream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "engine/sim/compiled_study.hpp"
#include "engine/sim/schedule.hpp"
#include "files/write/script_writer.hpp"
#include "model/core/error.hpp"
#include "model/core/text.hpp"
#include "model/schema/check_scene.hpp"
#include "model/schema/check_script.hpp"
#include "model/schema/clock.hpp"
#include "model/schema/words.hpp"
#include "pirsim/columns.hpp"
#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/look.hpp"
#include "pirsim/response.hpp"
#include "pirsim/schedule.hpp"
#include "surveys/picture.hpp"
#include "surveys/sight.hpp"

namespace pirsim::studies {
namespace {

constexpr std::uint32_t most_days = 1000;  ///< that an outlook draws

/// "{mean: 08:30, sd_min: 30}"
std::string written(const ClockSpec& clock) {
  return "{mean: " + io::time_of_day(clock.mean_h) + ", sd_min: " + shortest_number(clock.sd_min) + "}";
}

std::string staff_lines(int staff) {
  const ScheduleSpec usual;
  return "  staff:\n    - {role: staff, count: " + std::to_string(staff) +
         "}    # or manager, administrator; seats: [S1, ...] for desks of their own\n  arrival: " +
         written(usual.arrival) + "\n  departure: " + written(usual.departure) + "\n  lunch: " + written(usual.lunch) +
         "\n  lunch_min: " + shortest_number(usual.lunch_min) +
         "\n  lunch_sd_min: " + shortest_number(usual.lunch_sd_min) + '\n';
}

std::string meeting_lines() {
  const MeetingsSpec usual;
  const auto listed = [](const std::vector<double>& values, int decimals) {
    std::vector<std::string> words;
    for (const double value : values) words.push_back(fixed(value, decimals));
    return "[" + joined(words, ", ") + "]\n";
  };
  return "  meetings:\n    fewest_a_day: " + std::to_string(usual.fewest_a_day) +
         "\n    most_a_day: " + std::to_string(usual.most_a_day) +
         "\n    fewest_people: " + std::to_string(usual.fewest_people) +
         "                   # most_people: 8, or as many as there are seats\n    durations_min: " +
         listed(usual.durations_min, 0) + "    probabilities: " + listed(usual.probabilities, 2) +
         "    from: " + io::time_of_day(usual.from_h) + "\n    to: " + io::time_of_day(usual.to_h) +
         "\n    lateness_min: " + shortest_number(usual.lateness_min) + '\n';
}

std::string home_lines() {
  const HouseholdSpec usual;
  std::string text = "    visits_a_week: " + shortest_number(usual.visits_a_week) +
                     "                   # evenings on which somebody comes\n";
  for (const HouseholdClock& named : household_clocks) {
    text += "    " + std::string(named.key) + ": " + written(usual.*named.clock);
    text += named.clock == &HouseholdSpec::leaves ? "  # who works; who works at home begins\n" : "\n";
  }
  return text;
}

std::string given_or(const std::string& text, const char* otherwise) { return text.empty() ? otherwise : text; }

std::string office_lines(const OrdinaryDays& days) {
  std::ostringstream text;
  text << "  from: " << given_or(days.from, "00:00")
       << "                          # the part of each day that is simulated\n"
       << "  to: " << given_or(days.to, "24:00") << '\n';
  if (days.staff > 0) text << staff_lines(days.staff);
  if (days.meetings == OrdinaryDays::Meetings::held) text << meeting_lines();
  if (days.cleaning != "none") text << "  cleaning: " << given_or(days.cleaning, "19:00") << '\n';
  return text.str();
}

/// Every other one works.
std::string household_lines(const OrdinaryDays& days) {
  std::ostringstream text;
  text << "  household:                           # each day goes from 04:00 to 04:00\n    residents:\n";
  for (int i = 1; i <= days.residents; ++i) {
    const bool works = i % 2 == 1;
    text << "      - {id: resident_" << i << ", occupation: " << (works ? "works" : "at_home")
         << ", age_years: " << (works ? 40 : 68) << "}" << (i == 1 ? "    # or at_home, works_at_home" : "") << '\n';
  }
  text << home_lines();
  return text.str();
}

using sim::HomeActivity;

constexpr std::size_t at(HomeActivity activity) { return static_cast<std::size_t>(activity); }
HomeActivity activity_of(std::size_t index) { return static_cast<HomeActivity>(index); }

/// Sums over days; times are seconds of the day.
struct ExpectedResident {
  std::string id, bed;
  double up_s = 0.0, to_bed_s = 0.0;                      ///< ends of the night's sleep
  std::array<double, sim::n_home_activities> active_s{};  ///< with each activity
};

void add_day(ExpectedResident& resident, const std::vector<sim::HomeStay>& stays) {
  for (const sim::HomeStay& stay : stays) resident.active_s[at(stay.activity)] += stay.to_s - stay.from_s;
  // Who is up at four, or goes to bed after it, is so at the ends of the day.
  const auto is_up = [](const sim::HomeStay& stay) {
    return stay.activity != HomeActivity::sleep && stay.activity != HomeActivity::toilet;
  };
  const auto first = std::ranges::find_if(stays, is_up);
  const auto last = std::ranges::find_if(stays.rbegin(), stays.rend(), is_up);
  if (first == stays.end()) return;
  resident.up_s += first->from_s;
  resident.to_bed_s += last->to_s;
}

/// "23:10", also after midnight.
std::string time_of_day_text(double seconds) { return clock_text(0, seconds).substr(11, 5); }

void print_resident(std::ostream& out, const ExpectedResident& resident, double n_days) {
  out << "  " << std::left << std::setw(12) << resident.id << std::right << " bed " << resident.bed << "; up "
      << time_of_day_text(resident.up_s / n_days) << '-' << time_of_day_text(resident.to_bed_s / n_days)
      << "; hours a day:" << std::fixed << std::setprecision(1);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < resident.active_s.size(); ++i)
    if (resident.active_s[i] > 0.0) order.push_back(i);
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t i) { return resident.active_s[i] / n_days; });
  for (const std::size_t i : order)
    out << (i == order.front() ? " " : ", ") << sim::manner_of(activity_of(i)).phase << ' '
        << resident.active_s[i] / n_days / 3600.0;
  out << '\n';
}

/// The first days of the first trial, as drawn without walking.
void print_home(std::ostream& out, const sim::CompiledStudy& study) {
  const sim::TrialModel& trial = study.trials().front();
  const auto n_trials = static_cast<std::uint32_t>(study.trials().size());
  std::vector<ExpectedResident> residents;
  for (const sim::PersonModel& person : trial.people) {
    const auto& part = person.spec.part;
    if (part && part->part == SchedulePart::resident) residents.push_back({person.spec.id, part->seat});
  }
  const std::uint32_t n_days = std::min(study.n_runs() / n_trials, most_days);
  std::size_t n_working_days = 0, n_visits = 0;
  for (std::uint32_t run = 0; run < n_days * n_trials; run += n_trials) {
    const std::int64_t day = sim::day_of(study, run);
    const sim::HomeDay drawn = sim::draw_home_day(*trial.schedule->household, study.seed(), run, day);
    n_working_days += is_working_day(day) ? 1 : 0;
    n_visits += drawn.visits.size();
    for (std::size_t i = 0; i < residents.size(); ++i) add_day(residents[i], drawn.residents[i]);
  }
  out << "household: " << counted(n_days, "day") << " from " << clock_text(sim::day_of(study, 0), 0.0).substr(0, 10)
      << " (" << counted(n_working_days, "working day")
      << "), each from 04:00 to 04:00; means as drawn, before anybody has walked\n";
  for (const ExpectedResident& resident : residents) print_resident(out, resident, std::max(1U, n_days));
  out << "  visits: " << n_visits << "\n\n";
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

/// Somebody is in the room from one moment of the day to another.
struct Visit {
  std::size_t person;
  double from_s, to_s;
};

bool is_in_room(const sim::Stay& stay) {
  return stay.place == sim::Place::desk || (stay.place == sim::Place::others_desk && stay.host) || stay.meeting;
}

std::vector<Visit> visits_of(const sim::DayDraw& draw) {
  std::vector<Visit> visits;
  for (std::size_t i = 0; i < draw.stays.size(); ++i) {
    for (const sim::Stay& stay : draw.stays[i]) {
      if (is_in_room(stay)) visits.push_back({i, stay.from_s, stay.to_s});
    }
  }
  for (const sim::Meeting& meeting : draw.meetings) {
    for (const sim::Attendance& who : meeting.people) visits.push_back({who.person, who.comes_s, who.goes_s});
  }
  return visits;
}

void note_most(ScheduleOutlook& outlook, const sim::DayDraw& draw, std::int64_t day) {
  const std::vector<Visit> visits = visits_of(draw);
  for (const Visit& one : visits) {
    std::set<std::size_t> people;  // who goes from one meeting to the next is one
    for (const Visit& other : visits) {
      if (other.from_s <= one.from_s && one.from_s < other.to_s) people.insert(other.person);
    }
    if (people.size() <= outlook.most_at_once) continue;
    outlook.most_at_once = people.size();
    outlook.most_when = clock_text(day, one.from_s);
  }
}

void note_person(ExpectedPerson& person, const std::vector<sim::Stay>& stays) {
  const auto first = std::ranges::find_if(stays, is_in_room);
  if (first == stays.end()) return;
  const auto last = std::ranges::find_if(stays.rbegin(), stays.rend(), is_in_room);
  if (!person.first_arrival_s) {
    person.first_arrival_s = first->from_s;
    person.first_departure_s = last->to_s;
  }
  ++person.days;
  person.mean_arrival_s += first->from_s;
  person.mean_departure_s += last->to_s;
  for (const sim::Stay& stay : stays) person.mean_present_s += is_in_room(stay) ? stay.to_s - stay.from_s : 0.0;
}

std::string clock(double seconds) { return seconds >= 86400.0 ? "24:00" : clock_text(0, seconds).substr(11, 5); }

void print_person(std::ostream& out, const ExpectedPerson& person) {
  out << "  " << std::left << std::setw(16) << person.id << " seat " << std::setw(5) << person.seat << std::right;
  if (person.days == 0) {
    out << " never comes\n";
    return;
  }
  out << " first day " << clock(*person.first_arrival_s) << '-' << clock(*person.first_departure_s) << ", mean of "
      << counted(static_cast<std::size_t>(person.days), "day") << ' ' << clock(person.mean_arrival_s) << '-'
      << clock(person.mean_departure_s) << ", in the room for " << std::fixed << std::setprecision(1)
      << person.mean_present_s / 3600.0 << " h\n";
}

// What `pirsim check` tells, for a reader.

void print(std::ostream& out, const ScheduleOutlook& outlook, const sim::CompiledStudy& study) {
  constexpr std::size_t most_told = 12;
  const ScheduleSpec& schedule = *study.trials().front().schedule;
  out << "schedule: " << counted(outlook.days, "day") << " from " << clock_text(outlook.first_day, 0.0).substr(0, 10)
      << " (" << counted(outlook.working_days, "working day") << "), each from " << clock(3600.0 * schedule.from_h)
      << " to " << clock(3600.0 * schedule.to_h) << "; times as drawn for whole days, before anybody has walked\n";
  for (const ExpectedPerson& person : outlook.staff) print_person(out, person);
  if (!schedule.meetings.empty()) out << "  meetings: " << outlook.meetings.size() << '\n';
  for (std::size_t i = 0; i < std::min(most_told, outlook.meetings.size()); ++i) {
    const ExpectedMeeting& meeting = outlook.meetings[i];
    out << "    " << clock_text(meeting.day, meeting.begin_s).substr(0, 16) << '-' << clock(meeting.end_s) << ", "
        << counted(static_cast<std::size_t>(meeting.people), "person", "people")
        << (meeting.area.empty() ? "" : " in " + meeting.area) << '\n';
  }
  if (outlook.meetings.size() > most_told) out << "    and so on\n";
  if (outlook.mean_cleaning_s) out << "  cleaning about " << clock(*outlook.mean_cleaning_s) << " on working days\n";
  out << "  at most " << outlook.most_at_once << " at once";
  if (!outlook.most_when.empty()) out << ", first at " << outlook.most_when;
  out << "; seats that are used:";
  for (const std::string& seat : outlook.seats) out << ' ' << seat;
  if (outlook.seats.empty()) out << " none";
  out << "\n\n";
}

/// "S1 S2", "all 10", or the first of very many.
std::string named(const std::vector<std::string>& seats, std::size_t n_all) {
  constexpr std::size_t most_named = 12;
  if (seats.empty()) return "none";
  if (seats.size() == n_all && n_all > 1) return "all " + std::to_string(n_all);
  const auto last = seats.begin() + static_cast<std::ptrdiff_t>(std::min(seats.size(), most_named));
  const std::string first = joined(std::vector(seats.begin(), last), " ");
  return seats.size() <= most_named ? first : std::to_string(seats.size()) + ": " + first + " ...";
}

void print(std::ostream& out, const SightReport& report, const SceneSpec& scene) {
  const auto percent = [&](std::size_t places) {
    return report.places == 0 ? 0.0 : 100.0 * static_cast<double>(places) / static_cast<double>(report.places);
  };
  std::size_t width = std::string_view("any sensor").size();
  for (const SensorSight& sight : report.sensors) width = std::max(width, sight.sensor.size());
  const auto line = [&](const auto& sensor, const auto& rays, const auto& cut, const auto& longest, const auto& floor) {
    out << "  " << std::left << std::setw(static_cast<int>(width)) << sensor << std::right << std::setw(6) << rays
        << std::setw(14) << cut << std::setw(13) << longest << std::setw(10) << floor;
  };
  out << "at rest: what each sensor sees of a person who stands on one of " << counted(report.places, "place")
      << " (every " << fixed(report.spacing_m, 2) << " m), or sits still (to be motion, the person has to move):\n";
  line("sensor", "rays", "end at room", "longest, m", "floor, %");
  out << "  seats at rest\n";
  for (const SensorSight& sight : report.sensors) {
    line(sight.sensor, sight.rays, sight.rays_cut, fixed(sight.longest_m, 2), fixed(percent(sight.places), 1));
    out << "  "
        << (sight.is_beam          ? "a beam: on while somebody or a leaf is in it"
            : sight.sees_nothing() ? "sees NOBODY"
                                   : named(sight.seats, scene.seats.size()))
        << '\n';
  }
  line("any sensor", "", "", "", fixed(percent(report.places_seen_by_any), 1));
  out << '\n';
  for (const SensorSight& sight : report.sensors) {
    if (!sight.about.empty()) out << "  " << sight.sensor << ": " << sight.about << '\n';
  }
  const auto is_floor = [&](const TriMesh& mesh) {
    return studies::role_of(mesh, scene.floor.height_m()) == studies::MeshRole::floor;
  };
  if (std::ranges::none_of(scene.meshes, is_floor)) {
    out << "  no ray ends at the floor: it has no mesh that occludes, only an outline\n";
  }
}

/// A line for each pet and sensor.
void print_pets(std::ostream& out, const Model& model) {
  const std::vector<SensorSpec>& sensors = model.scene().sensors;
  const std::vector<PetSight> pets = watch_pets(model);
  if (pets.empty() || sensors.empty()) return;
  out << "pets: each alone for a day, all doors open\n";
  for (const auto& [pet, passes, seen] : pets) {
    out << "  " << pet << ": " << counted(passes, "pass", "passes") << " of 1 m or more\n";
    for (std::size_t i = 0; i < sensors.size() && passes > 0; ++i) {
      out << "    " << sensors[i].id << " sees the " << pet << " in "
          << fixed(100.0 * static_cast<double>(seen[i]) / static_cast<double>(passes), 0) << " of 100 of its passes\n";
    }
  }
  out << '\n';
}

/// A line for each sensor that is deaf to any seat.
void print_deaf_sensors(std::ostream& out, const WorkReport& work, const Model& model) {
  const SceneSpec& scene = model.compiled().scene();
  const SensingSpec& sensing = model.compiled().sensing();
  const std::string channel = sensing.change_per == ChangePer::beam ? "beam" : "cluster";
  bool by_zones = false;
  for (std::size_t sensor = 0; sensor < scene.sensors.size(); ++sensor) {
    const std::vector<std::string> deaf = work.deaf_seats(sensor);
    if (deaf.empty()) continue;
    std::size_t n_seen = 0, n_channels = 0, n_for_good = 0;
    for (std::size_t seat = 0; seat < work.seats.size(); ++seat) {
      const WorkNotice& notice = work.notice(seat, sensor);
      n_seen += notice.channels > 0 ? 1 : 0;
      if (!notice.is_deaf()) continue;
      n_channels += notice.channels;
      n_for_good += notice.for_good;
    }
    out << "  " << scene.sensors[sensor].id << " is deaf to work in " << named(deaf, work.seats.size())
        << " (it sees somebody at work in " << counted(n_seen, "seat") << "): ";
    if (response_of(scene, sensing, scene.sensors[sensor]) == Response::analog) {
      out << "its signal stays within the threshold\n";
    } else {
      by_zones = true;
      out << counted(n_channels, channel) << " touched there, " << n_for_good << " of them covered for good\n";
    }
  }
  if (!by_zones) return;
  out << "  (response: zones, change_per: " << channel << "; what helps may be --response analog"
      << (sensing.change_per == ChangePer::beam ? "" : ", or change_per: beam") << ")\n";
}

void print(std::ostream& out, const WorkReport& work, const std::string& who, const Model& model) {
  const std::size_t n_places = model.scene().places.size();
  const std::size_t n_tried = work.seats.size(), n_all = model.scene().seats.size() + n_places;
  if (n_tried == 0) return;
  const SeatsAtWork seats = work.by_any();
  out << "at work: " << who << ", for " << work.seconds << " s in each of "
      << (n_tried < n_all ? std::to_string(n_tried) + " of the " : "") << counted(n_all, "seat")
      << (n_places > 0 ? " and places, or at what else they are for" : "") << ": noticed in "
      << named(seats.noticed, n_tried) << "; deaf (seen, but never noticed) in " << named(seats.deaf, n_tried)
      << "; unseen in " << named(seats.unseen, n_tried) << '\n';
  print_deaf_sensors(out, work, model);
  out << '\n';
}

/// When the first trial's people begin what they are to do at a given time.
void print_times(std::ostream& out, const sim::TrialModel& trial) {
  constexpr int most_told = 12;
  out << "clock: every run begins at " << trial.clock->text(0.0) << '\n';
  for (const sim::PersonModel& person : trial.people) {
    int n = 0;
    for (const ScriptedAction& action : person.spec.actions) {
      if (!action.at_s || ++n > most_told) continue;
      out << (n == 1 ? "  " + person.spec.id + " begins an action at " : ", ");
      out << trial.clock->shortest_text(*action.at_s);
    }
    if (n > 0) out << (n > most_told ? " and so on\n" : "\n");
  }
  out << '\n';
}

/// What the data behind a script say, and how much of it a run is.
void print_occupancy(std::ostream& out, const OccupancySpec& occupancy, const sim::TrialModel& trial) {
  const std::string& file = data_file(occupancy);
  out << "occupancy: ";
  if (occupancy.counts) {
    const CountsSpec& counts = *occupancy.counts;
    const auto [fewest, most] = std::ranges::minmax(counts.people);
    int changes = counts.people.front();
    for (std::size_t i = 1; i < counts.people.size(); ++i) changes += std::abs(counts.people[i] - counts.people[i - 1]);
    out << counted(counts.people.size(), "reading") << (file.empty() ? "" : " of " + file) << ", " << fewest << " to "
        << counted(static_cast<std::size_t>(most), "person", "people") << ", "
        << counted(static_cast<std::size_t>(changes), "coming or going", "comings and goings");
    for (const AreaCountsSpec& area : counts.areas)
      out << "; " << area.area << " up to " << *std::ranges::max_element(area.people);
  } else {
    out << counted(trial.people.size(), "person", "people") << (file.empty() ? "" : " of " + file);
  }
  const auto last = trial.begins_s.size() - 1;
  if (has_days(occupancy)) out << "; " << counted(last + 1, "day") << " of data, which replicates take in turn";
  out << "; a run lasts from " << span_text(trial.clock, 0.0, trial.duration_s.value_or(0.0)) << "\n\n";
}

/// Whose people are counted by themselves, which sensors watch each, and what of the floor is in none.
void print_areas(std::ostream& out, const SceneSpec& scene) {
  const Areas areas(scene);
  for (std::size_t i = 0; i < scene.areas.size(); ++i) {
    out << (i == 0 ? "areas: " : "       ") << areas.names()[i] << ' ' << fixed(areas.areas_m2()[i], 2) << " m2, ";
    std::vector<std::string> sensors;
    for (const std::size_t sensor : areas.sensors_of(i)) sensors.push_back(scene.sensors[sensor].id);
    out << (sensors.empty() ? "no sensor" : (sensors.size() == 1 ? "sensor " : "sensors ") + named(sensors, 0)) << '\n';
  }
  if (areas.empty()) return;
  if (areas.size() > scene.areas.size()) {
    out << "       " << fixed(areas.areas_m2().back(), 2) << " m2 of the floor ("
        << fixed(100.0 * areas.areas_m2().back() / scene.floor.area_m2(), 1) << " %) in no area: people there are in "
        << column_of_area(elsewhere) << '\n';
  }
  std::vector<std::string> astray;
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    if (!areas.of_sensors()[i]) astray.push_back(scene.sensors[i].id);
  }
  if (!astray.empty())
    out << "       of no area: " << (astray.size() == 1 ? "sensor " : "sensors ") << named(astray, 0) << '\n';
}

std::string habit_in_words(const DoorSpec& door) {
  if (door.state == DoorState::open) return "always open";
  if (door.state == DoorState::shut) return "shut behind whoever goes through";
  return "shut after " + percent(door.shut_share) + " of passes, else open for " + fixed(door.stands_open_s, 0) + " s";
}

/// What a leaf hides and to where it turns depends on all of this; where it leads is known by areas.
void print_doors(std::ostream& out, const SceneSpec& scene) {
  constexpr double away_m = 0.4;  // assumed: beyond a thick wall (0.3-0.6)
  const Areas areas(scene);
  const auto beside = [&](const DoorSpec& door, double ahead_m) {
    const Vec2 at = floor_point(door.world_from_door * Vec3(0, 0, -ahead_m));
    return scene.floor.contains(at) ? std::string(areas.name_at(at)) : "outside";
  };
  for (std::size_t i = 0; i < scene.doors.size(); ++i) {
    const DoorSpec& door = scene.doors[i];
    out << (i == 0 ? "doors: " : "       ") << door.id << ' ' << fixed(door.width_m, 2) << " x "
        << fixed(door.height_m, 2) << " m, ";
    if (!areas.empty()) out << "from " << beside(door, -away_m) << " to " << beside(door, away_m) << ", ";
    out << "hinge " << word_of(door.hinge) << ", opens " << word_of(door.opens) << ", " << habit_in_words(door) << '\n';
  }
}

/// Rows of 0.1 were those of zones: who runs an older script should know that its rows are others now.
void print_response(std::ostream& out, const Model& model) {
  const SceneSpec& scene = model.scene();
  const SensingSpec& sensing = model.script().sensing;
  if (scene.sensors.empty()) return;
  out << "response of the sensors: " << responses_in_words(scene, sensing) << '\n';
  const bool is_any_analog = std::ranges::any_of(
      scene.sensors, [&](const SensorSpec& sensor) { return response_of(scene, sensing, sensor) == Response::analog; });
  if (!sensing.response && is_any_analog)
    out << "  note: sensors answer by the analog response (since 0.2; 0.1 used zones: --response zones)\n";
}

/// "'reader'", or who is watched where the script has nobody work.
std::string in_words(const Worker& worker) {
  return worker.person.id.empty() ? "somebody of natural style" : "'" + worker.person.id + "'";
}

void print_study(std::ostream& out, const Model& model, const CheckReport& report, const Worker& worker) {
  const SceneSpec& scene = model.compiled().scene();
  const ScriptSpec& script = model.script();
  out << scene.name << ": " << counted(scene.meshes.size(), "mesh", "meshes") << ", "
      << counted(scene.sensors.size(), "sensor") << ", " << counted(scene.seats.size(), "seat") << ", "
      << (scene.places.empty() ? "" : counted(scene.places.size(), "place") + ", ")
      << counted(scene.entrances.size(), "entrance")
      << (scene.doors.empty() ? "" : ", " + counted(scene.doors.size(), "door")) << ", floor "
      << fixed(scene.floor.area_m2(), 2) << " m2\n";
  out << script.name << ": " << counted(script.trials.size(), "trial") << " x "
      << counted(static_cast<std::size_t>(script.replicates), "replicate") << " = " << counted(model.n_runs(), "run")
      << '\n';
  print_areas(out, model.scene());
  print_doors(out, model.scene());
  print_response(out, model);
  out << '\n';
  if (!script.trials.empty() && script.trials.front().schedule) {
    if (script.trials.front().schedule->household) {
      print_home(out, model.compiled());
    } else {
      print(out, outlook(model.compiled()), model.compiled());
    }
  }
  if (!script.trials.empty() && script.trials.front().occupancy)
    print_occupancy(out, *script.trials.front().occupancy, model.compiled().trials().front());
  if (!script.begin.empty() && !script.trials.empty()) print_times(out, model.compiled().trials().front());
  print(out, report.sight, scene);
  print_pets(out, model);
  print(out, report.work, in_words(worker), model);
}

}  // namespace

std::string script_text(const OrdinaryDays& days) {
  const bool is_home = days.is_home();
  std::ostringstream text;
  text << "# Ordinary days. Each replicate is a day, from first_day on"
       << (is_home ? ".\n" : "; nobody comes on Saturdays and Sundays.\n") << "pirsim_script: 1\n"
       << "name: "
       << (is_home          ? "days at home"
           : days.staff > 0 ? "office days"
                            : "meeting days")
       << '\n'
       << "seed: 1\n"
       << "replicates: " << days.days << '\n'
       << "schedule:\n"
       << "  first_day: " << days.first_day << '\n'
       << (is_home ? household_lines(days) : office_lines(days));
  return text.str();
}

/// What residents do where they are, since the scene has no place for it, and who can't get out of bed. Empty without
/// a household.
std::vector<Issue> warnings_of_home(const sim::CompiledStudy& study) {
  const auto has_household = [](const sim::TrialModel& trial) { return trial.schedule && trial.schedule->household; };
  const auto home = std::ranges::find_if(study.trials(), has_household);
  if (home == study.trials().end()) return {};
  const auto& residents = home->schedule->household->residents;
  const bool someone_works_there = std::ranges::any_of(
      residents, [](const auto& resident) { return resident.occupation == Occupation::works_at_home; });
  GroupedWarnings lacking;
  for (std::size_t i = 0; i < sim::n_home_activities; ++i) {
    if (activity_of(i) == HomeActivity::work && !someone_works_there) continue;
    const sim::HomeManner manner = sim::manner_of(activity_of(i));
    const std::size_t n_places = sim::n_places_for(study.scene(), activity_of(i));
    if (activity_of(i) == HomeActivity::eat && n_places > 0 && n_places < residents.size())
      lacking.add("few places", home->schedule->where, manner.phase,
                  "household: " + counted(n_places, "place") + " for eating and " +
                      counted(residents.size(), "resident") + ": the others eat where they rest");
    if (n_places > 0 || manner.uses.empty()) continue;
    lacking.add("no place", home->schedule->where, manner.phase,
                std::string("household: no place for ") + manner.phase + " (`for: [" +
                    std::string(manner.uses.front()) + "]` in its mark): residents do that where they are");
  }
  Diagnostics told;
  lacking.tell(told);
  warn_of_beds(study, *home, told);
  return told.warnings();
}

ScheduleOutlook outlook(const sim::CompiledStudy& study) {
  const sim::TrialModel& model = study.trials().front();
  const auto n_trials = static_cast<std::uint32_t>(study.trials().size());
  ScheduleOutlook result;
  result.first_day = sim::day_of(study, 0);
  result.days = std::min(study.n_runs() / n_trials, most_days);
  std::vector<std::size_t> staff;
  for (std::size_t i = 0; i < model.people.size(); ++i) {
    const auto& part = model.people[i].spec.part;
    if (!part || part->part != SchedulePart::staff) continue;
    staff.push_back(i);
    result.staff.push_back({model.people[i].spec.id, part->seat, 0, {}, {}, 0.0, 0.0, 0.0});
  }
  double cleaning_s = 0.0;
  int cleanings = 0;
  std::set<std::string> seats;
  for (std::uint32_t run = 0; run < result.days * n_trials; run += n_trials) {
    const std::int64_t day = sim::day_of(study, run);
    const sim::DayDraw draw = sim::draw_times(study, run);
    result.working_days += is_working_day(day) ? 1 : 0;
    for (std::size_t i = 0; i < staff.size(); ++i) {
      note_person(result.staff[i], draw.stays[staff[i]]);
      if (!draw.stays[staff[i]].empty()) seats.insert(result.staff[i].seat);
    }
    for (const sim::Meeting& meeting : draw.meetings) {
      result.meetings.push_back(
          {day, meeting.begin_s, meeting.end_s, meeting.people.size(), model.schedule->meetings[meeting.room].area});
    }
    if (draw.cleaning_s) cleaning_s += *draw.cleaning_s, ++cleanings;
    note_most(result, draw, day);
  }
  for (ExpectedPerson& person : result.staff) {
    const double n = std::max(1, person.days);
    person.mean_arrival_s /= n, person.mean_departure_s /= n, person.mean_present_s /= n;
  }
  if (cleanings > 0) result.mean_cleaning_s = cleaning_s / cleanings;
  std::ranges::stable_sort(result.meetings, {},
                           [](const ExpectedMeeting& meeting) { return std::pair(meeting.day, meeting.begin_s); });
  for (std::size_t room = 0; room < model.schedule->meetings.size() && !result.meetings.empty(); ++room) {
    for (const std::string& seat : meeting_seats(*model.schedule, room, study.scene())) seats.insert(seat);
  }
  for (const SeatSpec& seat : study.scene().seats) {
    if (seats.contains(seat.id)) result.seats.push_back(seat.id);
  }
  return result;
}

}  // namespace pirsim::studies

namespace pirsim {

CheckReport check_study(const Model& model) {
  CheckReport report;
  report.sight = studies::look_around(model);
  const sim::CompiledStudy& study = model.compiled();
  const studies::Worker worker = studies::worker_of(study.trials());
  report.work = studies::watch_sitters(studies::room_of(study), worker);
  std::ostringstream text;
  studies::print_study(text, model, report, worker);
  report.text = std::move(text).str();
  report.warnings = studies::warnings(report.sight, model.scene());
  for (Issue& warning : studies::warnings_of_home(study)) report.warnings.push_back(std::move(warning));
  return report;
}

}  // namespace pirsim
