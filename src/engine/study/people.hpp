// The people that a schedule or an occupancy adds to a trial.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pirsim/scene.hpp"
#include "pirsim/schedule.hpp"
#include "pirsim/script.hpp"

namespace pirsim {

/// Of an action that only the next one ends.
inline constexpr double until_next_s = 1e6;

/// What somebody of a schedule is there for; an occupant is of an occupancy, which has no roles.
enum class SchedulePart { staff, guest, cleaner, occupant, resident, visitor };

struct ScheduledPerson {
  SchedulePart part = SchedulePart::staff;
  Role role = Role::staff;  ///< of staff
  std::string seat;         ///< own desk, of staff; own bed, of residents
  PersonSpec person;        ///< without actions
  std::size_t room = 0;     ///< of guests: index into the schedule's meetings
};

/// Somebody of no particular size and clothing, drawn from the study's seed; entity: which of the people so drawn.
[[nodiscard]] PersonSpec drawn_body(const std::string& id, MotionStyle style, std::uint64_t seed, std::uint32_t entity);
/// As large as drawn bodies get: where this one gets to, all of them do.
[[nodiscard]] PersonSpec largest_body(const std::string& id);

/// Staff in their order, then guests of meetings, then who cleans. Bodies are drawn from the study's seed and are the
/// same on all days. Throws Error(input) for more staff than seats, and for seats and entrances that the scene lacks.
[[nodiscard]] std::vector<ScheduledPerson> people_of(const ScheduleSpec& schedule, const SceneSpec& scene,
                                                     std::uint64_t seed);

/// The people of a count: as many as are ever there at once, or as the occupancy says. Their actions are drawn for each
/// run. Throws Error(input) for seats and entrances that the scene lacks.
[[nodiscard]] std::vector<ScheduledPerson> people_of(const OccupancySpec& occupancy, const SceneSpec& scene,
                                                     std::uint64_t seed);

/// Where the schedule's room-th meetings are held: the seats that are asked for, or those of the area that are nobody's
/// own desk and no other room's.
[[nodiscard]] std::vector<std::string> meeting_seats(const ScheduleSpec& schedule, std::size_t room,
                                                     const SceneSpec& scene);
/// How many may meet there: as many as asked for, else eight, or as many as there are seats and, of the staff, people.
[[nodiscard]] int most_at_meeting(const ScheduleSpec& schedule, std::size_t room, const SceneSpec& scene);

// People who are where data say, as people of a script.

/// Of places or positions; nobody of counts. begin_s: of the run, in the seconds of the data; what ended before it is
/// left out. tick_s: of the run. Seats are looked for when a Model is compiled.
[[nodiscard]] std::vector<PersonSpec> scripted_people(const OccupancySpec& occupancy, const SceneSpec& scene,
                                                      double begin_s, double tick_s, std::uint64_t seed);

}  // namespace pirsim
