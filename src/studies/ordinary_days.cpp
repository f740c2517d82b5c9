#include "studies/ordinary_days.hpp"

#include <sstream>

namespace pirsim::studies {
namespace {

constexpr const char* staff_lines = R"(  staff:
    - {role: staff, count: @staff@}    # or manager, administrator; seats: [S1, ...] for desks of their own
  arrival: {mean: 08:30, sd_min: 30}
  departure: {mean: 17:30, sd_min: 30}
  lunch: {mean: 12:00, sd_min: 30}
  lunch_min: 60
  lunch_sd_min: 15
)";

constexpr const char* meeting_lines = R"(  meetings:
    fewest_a_day: 2
    most_a_day: 6
    fewest_people: 2                   # most_people: 8, or as many as there are seats
    durations_min: [30, 60, 90, 120]
    probabilities: [0.13, 0.70, 0.12, 0.05]
    from: 09:00
    to: 18:00
    lateness_min: 2
)";

constexpr const char* home_lines = R"(    visits_a_week: 1                   # evenings on which somebody comes
    wakes: {mean: 07:00, sd_min: 30}
    wakes_on_free_days: {mean: 08:30, sd_min: 45}
    goes_to_bed: {mean: 23:00, sd_min: 30}
    leaves: {mean: 08:15, sd_min: 20}  # who works; who works at home begins
    comes_home: {mean: 17:15, sd_min: 40}
    lunch: {mean: 13:00, sd_min: 20}
    dinner: {mean: 19:30, sd_min: 30}
)";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

std::string given_or(const std::string& text, const char* otherwise) { return text.empty() ? otherwise : text; }

std::string office_lines(const OrdinaryDays& days) {
  std::ostringstream text;
  text << "  from: " << given_or(days.from, "00:00")
       << "                          # the part of each day that is simulated\n"
       << "  to: " << given_or(days.to, "24:00") << '\n';
  if (days.staff > 0) text << replaced(staff_lines, "@staff@", std::to_string(days.staff));
  if (days.meetings == OrdinaryDays::Meetings::held) text << meeting_lines;
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
  text << home_lines;
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
