#include "studies/ordinary_days.hpp"

#include <sstream>
#include <vector>

#include "core/text.hpp"
#include "io/write/spec_writer.hpp"
#include "pirsim/schedule.hpp"
#include "schema/household_clocks.hpp"

namespace pirsim::studies {
namespace {

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

}  // namespace pirsim::studies
