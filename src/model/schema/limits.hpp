// How long the lists of a spec may be, in one place: docs/formats/inputs.md tells them. Whoever reads a list counts it
// first, so that what is too long costs nothing.
#pragma once

#include <cstddef>

namespace pirsim::limits {

// Of YAML files.
inline constexpr std::size_t yaml_values = 1'000'000;  ///< with aliases followed, and with trials written out
inline constexpr std::size_t yaml_levels = 64;
inline constexpr std::size_t list_entries = 1'000;  ///< of each list that has no limit of its own

// Of scripts. All limits are assumed: some ten times what the largest studies known to us have.
inline constexpr std::size_t trials = 20'000;
inline constexpr std::size_t people = 10'000;        ///< of a trial
inline constexpr std::size_t actions = 100'000;      ///< of a person
inline constexpr std::size_t walk_points = 100'000;  ///< of an action
inline constexpr std::size_t held_meetings = 100;    ///< of a day, as drawn ones

// Of the data behind a script's `occupancy`.
inline constexpr std::size_t occupancy_rows = 1'000'000;  ///< two years of counts, one a minute

// Of recipes.
inline constexpr std::size_t rooms = 100'000;

// Of scenes.
inline constexpr std::size_t sensors = 2'000;
inline constexpr std::size_t arrays = 256;  ///< of these: thermopile arrays
inline constexpr std::size_t seats = 5'000;
inline constexpr std::size_t places = 5'000;  ///< to lie and to stand
inline constexpr std::size_t entrances = 1'000;
inline constexpr std::size_t doors = 1'000;
inline constexpr std::size_t floors = 1'000;
inline constexpr std::size_t areas = 1'000;           ///< each is a column of rows
inline constexpr std::size_t floor_corners = 10'000;  ///< of all floors, or all areas; every pair is compared
inline constexpr std::size_t scene_elements =
    20'000'000;                                 ///< vertices and triangles; a scanned office has a few million
inline constexpr std::size_t rays = 2'000'000;  ///< of all sensors together
/// Of squares of 0.1 m on which ways are found, over all sizes of people: each has a map of its own, some 12 bytes a
/// square.
inline constexpr std::size_t way_squares = 500'000'000;

// Of measured data, of which each dataset of a reconciliation has as many.
inline constexpr double measured_run_s = 1e7;               ///< as a script's duration_s
inline constexpr std::size_t measured_rows = 10'000'000;    ///< with gaps filled; 100 MB of ten sensors
inline constexpr std::size_t measured_replicates = 10'000;  ///< of a trial: 27 years of days

// Of logs. All limits are assumed: some ten times a year of ten sensors.
inline constexpr std::size_t log_columns = 10'000;
inline constexpr std::size_t log_changes = 20'000'000;  ///< of all sensors; 24 bytes each
inline constexpr std::size_t log_windows = 1'000'000'000;
inline constexpr std::size_t log_cells = 2'000'000'000;    ///< windows x sensors that are asked for at once
inline constexpr std::size_t counter_bytes = 200'000'000;  ///< of a file: 10,000 rooms of 10 counts and 10 sensors

}  // namespace pirsim::limits
