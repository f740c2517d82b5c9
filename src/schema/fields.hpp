// Every spec's fields, said once: what is called how, which numbers are accepted, what it means. A field that is added
// to a struct is added in schema/fields/, without which nothing compiles that goes through all fields; fingerprints,
// comparisons, checks, plain keys of files, Python's classes and the pages' tables of keys then follow (tools/specs).
// Who needs descriptions includes this file, never a part of it: here the parts' macros end.
#pragma once

#include <tuple>

#include "schema/fields/files.hpp"
#include "schema/fields/occupancy.hpp"
#include "schema/fields/people.hpp"
#include "schema/fields/scenes.hpp"
#include "schema/fields/schedules.hpp"
#include "schema/fields/sensors.hpp"
#include "schema/fields/surveys.hpp"
#include "schema/fields/trials.hpp"

#undef FIELD
#undef LABEL

namespace pirsim {

/// Specs that Python has classes of, each before those that it is a part of.
using SpecsOfPython =
    std::tuple<Where, InputFile, SensorSpec, SeatSpec, PlaceSpec, EntranceSpec, DoorSpec, OpticsSpec, ElementSpec,
               AmplifierSpec, ComparatorSpec, ReportSpec, DetectorSpec, ZoneSpec, ClusterSpec, RatedTargetSpec,
               SensitivitySpec, SensorModelSpec, AreaSpec, SceneSpec, action::Wait, action::Appear, action::Enter,
               action::Walk, action::Sit, action::Work, action::Rise, action::Leave, action::Turn, action::Follow,
               action::Lie, action::Stand, SeatScatterSpec, WarmthSpec, PersonSpec, ClockSpec, StaffSpec,
               HeldMeetingSpec, MeetingsSpec, ResidentSpec, HouseholdSpec, ScheduleSpec, AreaCountsSpec, CountsSpec,
               StaySpec, PlacesSpec, TrackSpec, PositionsSpec, OccupancySpec, TrialSpec, SensingSpec, SummarySpec,
               EffectSpec, ScriptSpec>;

}  // namespace pirsim
