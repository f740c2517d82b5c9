#include "io/schedule_writer.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "pirsim/csv.hpp"

namespace pirsim::io {
namespace {

YAML::Node number(double value) { return YAML::Node(csv_number(value)); }

YAML::Node numbers(const std::vector<double>& values) {
  YAML::Node list(YAML::NodeType::Sequence);
  for (const double value : values) list.push_back(number(value));
  list.SetStyle(YAML::EmitterStyle::Flow);
  return list;
}

/// "08:30"; times are read in minutes.
std::string time_of_day(double hours) {
  const auto minutes = static_cast<int>(std::lround(60.0 * hours));
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%02d:%02d", minutes / 60, minutes % 60);
  return text.data();
}

YAML::Node write(const ClockSpec& clock) {
  YAML::Node node;
  node["mean"] = time_of_day(clock.mean_h);
  node["sd_min"] = number(clock.sd_min);
  return node;
}

YAML::Node write(const StaffSpec& staff) {
  static constexpr std::array<const char*, 3> roles{"staff", "manager", "administrator"};
  YAML::Node node;
  node["role"] = roles[static_cast<std::size_t>(staff.role)];
  node["count"] = staff.count;
  if (!staff.seats.empty()) node["seats"] = staff.seats;
  return node;
}

YAML::Node write(const MeetingsSpec& meetings) {
  YAML::Node node;
  node["fewest_a_day"] = meetings.fewest_a_day;
  node["most_a_day"] = meetings.most_a_day;
  node["fewest_people"] = meetings.fewest_people;
  if (meetings.most_people) node["most_people"] = *meetings.most_people;
  node["durations_min"] = numbers(meetings.durations_min);
  node["probabilities"] = numbers(meetings.probabilities);
  node["from"] = time_of_day(meetings.from_h);
  node["to"] = time_of_day(meetings.to_h);
  node["lateness_min"] = number(meetings.lateness_min);
  for (const HeldMeetingSpec& held : meetings.held) {
    YAML::Node entry;
    entry["at"] = time_of_day(held.at_h);
    entry["duration_min"] = number(held.duration_min);
    entry["people"] = held.people;
    node["held"].push_back(entry);
  }
  if (!meetings.seats.empty()) node["seats"] = meetings.seats;
  return node;
}

YAML::Node write(const ProfileSpec& profile) {
  YAML::Node node;
  node["presence"] = numbers(profile.presence);
  node["mobility"] = number(profile.mobility);
  node["step_min"] = number(profile.step_min);
  return node;
}

}  // namespace

YAML::Node to_node(const ScheduleSpec& schedule) {
  YAML::Node node;
  node["first_day"] = schedule.first_day;
  node["from"] = time_of_day(schedule.from_h);
  node["to"] = time_of_day(schedule.to_h);
  for (const StaffSpec& staff : schedule.staff) node["staff"].push_back(write(staff));
  if (schedule.meetings) node["meetings"] = write(*schedule.meetings);
  if (schedule.profile) node["profile"] = write(*schedule.profile);
  node["arrival"] = write(schedule.arrival);
  node["departure"] = write(schedule.departure);
  node["lunch"] = write(schedule.lunch);
  node["lunch_min"] = number(schedule.lunch_min);
  node["lunch_sd_min"] = number(schedule.lunch_sd_min);
  if (schedule.cleaning_h) node["cleaning"] = time_of_day(*schedule.cleaning_h);
  if (!schedule.entrances.empty()) node["entrances"] = schedule.entrances;
  if (schedule.style == MotionStyle::choreographed) node["style"] = "choreographed";
  return node;
}

}  // namespace pirsim::io
