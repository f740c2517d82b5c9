// What specs must hold beyond the ranges of their numbers (schema/fields.hpp), said once: readers of files call
// these with the places of their keys, check() with the names of fields.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/schema/fields.hpp"
#include "model/schema/limits.hpp"
#include "pirsim/error.hpp"
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
void check_together(const ArraySpec& array, const TellFault& tell);
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

// Faults of specs that a program made, each with the place in the spec.

/// `script.trials[0].people[1]`, put into words only where something is wrong. The parts above must outlive it.
class SpecPath {
 public:
  explicit SpecPath(std::string_view root) : name_(root) {}
  [[nodiscard]] SpecPath field(std::string_view name) const { return {this, name, std::nullopt}; }
  [[nodiscard]] SpecPath item(std::string_view list, std::size_t index) const { return {this, list, index}; }
  [[nodiscard]] std::string text() const {
    std::string text = (above_ != nullptr ? above_->text() + '.' : std::string()) + std::string(name_);
    return index_ ? text + '[' + std::to_string(*index_) + ']' : text;
  }

 private:
  SpecPath(const SpecPath* above, std::string_view name, std::optional<std::size_t> index)
      : above_(above), name_(name), index_(index) {}

  const SpecPath* above_ = nullptr;
  std::string_view name_;
  std::optional<std::size_t> index_;
};

/// Tells faults with their path in the spec of this name.
class SpecFaults {
 public:
  SpecFaults(std::string spec, Diagnostics& diagnostics) : where_{std::move(spec)}, diagnostics_(diagnostics) {}

  void error(const SpecPath& path, const std::string& message) {
    diagnostics_.error(where_, path.text() + ": " + message);
  }
  /// A fault in words, if there is one.
  void error_if(const SpecPath& path, const std::string& message) {
    if (!message.empty()) error(path, message);
  }
  void number(const SpecPath& path, double value, const NumberRange& range) {
    if (!range.holds(value)) refuse(path, value, range);
  }
  /// Are there no more than that? What is too long isn't looked at.
  [[nodiscard]] bool few(const SpecPath& path, std::size_t n, std::size_t most) {
    if (n <= most) return true;
    error(path, "has " + std::to_string(n) + " entries, more than " + std::to_string(most));
    return false;
  }
  /// Every number, time of day and list of names of the spec itself.
  template <typename Spec>
  void fields(const Spec& spec, const SpecPath& path) {
    each_field<Spec>([&](const auto& field) {
      using F = std::remove_cvref_t<decltype(field)>;
      if constexpr (NumberField<F> || TimeField<F>)
        number_of(path.field(field.name), spec.*field.member, range_of(field, spec));
      if constexpr (std::same_as<std::remove_cvref_t<decltype(spec.*field.member)>, std::vector<std::string>>)
        names(path.field(field.name), spec.*field.member);
    });
  }
  template <typename Spec>
  void together(const Spec& spec, const SpecPath& path) {
    check_together(spec, [&](std::string_view name, const std::string& message) { error(path.field(name), message); });
  }

 private:
  void names(const SpecPath& path, const std::vector<std::string>& names) {
    const std::set<std::string> known(names.begin(), names.end());
    if (known.size() == names.size()) return;
    for (const std::string& name : known)
      if (std::ranges::count(names, name) > 1) error(path, "'" + name + "' is named twice");
  }
  void number_of(const SpecPath& path, double value, const NumberRange& range) { number(path, value, range); }
  void number_of(const SpecPath& path, int value, const IntegerRange& range) {
    if (!range.holds(value)) refuse(path, value, range);
  }
  void number_of(const SpecPath& path, std::uint64_t value, const IntegerRange& range) {
    if (value > static_cast<std::uint64_t>(range.max)) refuse(path, value, range);
  }
  template <typename T, typename Range>
  void number_of(const SpecPath& path, const std::optional<T>& value, const Range& range) {
    if (value) number_of(path, *value, range);
  }
  void number_of(const SpecPath& path, const std::vector<double>& values, const NumberRange& range) {
    if (!few(path, values.size(), limits::list_entries)) return;
    for (const double value : values) number(path, value, range);
  }
  void refuse(const SpecPath& path, auto value, const auto& range) {
    std::ostringstream got;
    got << value;
    error(path, "expected " + range.text() + ", got " + got.str());
  }

  Where where_;
  Diagnostics& diagnostics_;
};

// Parts of specs with a file of their own.

void check(const SensorModelSpec& model, const SpecPath& path, SpecFaults& faults);
void check(const ScheduleSpec& schedule, const SpecPath& path, SpecFaults& faults);
/// begin: the script's.
void check(const OccupancySpec& occupancy, const std::string& begin, const SpecPath& path, SpecFaults& faults);

}  // namespace pirsim
