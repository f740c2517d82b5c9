// What specs must hold beyond the ranges of their numbers (schema/fields.hpp), said once: readers of files call
// these with the places of their keys, check() with the names of fields.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim {

/// field: as the spec calls it.
using TellFault = std::function<void(std::string_view field, const std::string& message)>;

// Names. A fault is told in words; no text: there is none.

/// Ids of what is in a room become names of columns, models names of files.
[[nodiscard]] std::string name_fault(std::string_view name);
/// Of the id of what has a column of its own ("sensor", "area"), which must not be another column's.
[[nodiscard]] std::string column_fault(std::string_view id, const std::string& type = "sensor");

/// Of what a place is for. A message or none.
[[nodiscard]] std::string use_fault(const std::string& use);

/// Names that must differ.
class Names {
 public:
  explicit Names(std::string kind) : kind_(std::move(kind)) {}
  /// "a second seat 'S1'", or no text for a name that wasn't added before.
  [[nodiscard]] std::string fault_of_adding(const std::string& name);

 private:
  std::string kind_;
  std::set<std::string> names_;
};

// Rooms.

[[nodiscard]] bool is_in_world(const Vec3& place) noexcept;  ///< finite, and not too far from the origin
[[nodiscard]] bool is_upright(const Frame& frame) noexcept;  ///< of seats and doorways: +Y is up, within 5 degrees

/// Outlines of one floor, or of a part of it. A message or none: too many corners, out of the world, crossing, no area.
/// what: "floor" or "area", for the message.
[[nodiscard]] std::string outline_fault(const FloorArea& floor, const std::string& what = "floor");
[[nodiscard]] std::string too_many_corners(const std::string& what);  ///< of all together
/// Of an area's id, which must not be a column's or what those in no area are said to be in.
[[nodiscard]] std::string area_id_fault(const std::string& id);
/// Of areas whose outlines are right, beside each other and on the floor: each fault with the index of its area.
void check_together(const std::vector<AreaSpec>& areas, const FloorArea& floor,
                    const std::function<void(std::size_t area, const std::string& message)>& tell);
/// That a sensor names an area of the scene. A message or none.
[[nodiscard]] std::string area_fault(const SensorSpec& sensor, const std::vector<AreaSpec>& areas);
/// Do their edges cross? Touching is allowed.
[[nodiscard]] bool outlines_cross(const std::vector<Vec2>& first, const std::vector<Vec2>& second) noexcept;

// Sensors.

void check_together(const AmplifierSpec& amplifier, const TellFault& tell);
void check_together(const ComparatorSpec& comparator, const TellFault& tell);
void check_together(const DetectorSpec& detector, const TellFault& tell);
/// Its targets are of lens steps that it has.
void check_together(const SensorModelSpec& model, const TellFault& tell);
[[nodiscard]] std::string corners_fault(const ZoneSpec& zone);  ///< a message or none

// Scripts.

/// The choreographed style would ignore an activity. A message or none.
[[nodiscard]] std::string activity_fault(const PersonSpec& person, const ScriptedAction& action);
/// Of points at times, and headings at them if there are any. A message or none.
[[nodiscard]] std::string follow_fault(const std::vector<double>& times_s, const std::vector<Vec2>& points,
                                       const std::vector<double>& headings_deg);
void check_together(const WarmthSpec& warmth, const TellFault& tell);
/// Of the name of a part of the body, a message or none.
[[nodiscard]] std::string body_part_fault(const std::string& part);
/// Of a part's mesh in the part's frame, a message or none.
[[nodiscard]] std::string body_mesh_fault(const TriMesh& mesh);

void check_together(const HeldMeetingSpec& held, const TellFault& tell);
/// Calls `tell(i, j)` for meetings i and j < i that overlap, since they are in one room.
void check_together(std::span<const HeldMeetingSpec> held, const std::function<void(std::size_t, std::size_t)>& tell);
void check_together(const MeetingsSpec& meetings, const TellFault& tell);
void check_together(const ScheduleSpec& schedule, const TellFault& tell);
void check_together(const HouseholdSpec& household, const TellFault& tell);
/// begin: the script's; its own faults are told elsewhere.
void check_together(const OccupancySpec& occupancy, const std::string& begin, const TellFault& tell);
void check_together(const TrialSpec& trial, const TellFault& tell);

/// Of a phase that no run has, every sum would be 0. phase: index into those of the summary.
void check_phases(const ScriptSpec& script,
                  const std::function<void(std::size_t phase, const std::string& message)>& tell);
/// Runs are counted in 32 bits, and have one clock: the script's or the schedule's.
void check_together(const ScriptSpec& script, const TellFault& tell);

}  // namespace pirsim
