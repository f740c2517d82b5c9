// Ranges that fields of several specs accept, and how a description names a member (schema/fields.hpp).
#pragma once

#include <limits>

#include "core/range.hpp"
#include "schema/field.hpp"

// FIELD and LABEL name a member of the spec `S` of the description that they stand in.
#define FIELD(member, ...) field(#member, &S::member __VA_OPT__(, ) __VA_ARGS__)
#define LABEL(member, ...) label(#member, &S::member __VA_OPT__(, ) __VA_ARGS__)

namespace pirsim {

namespace accepted {

inline constexpr TimeOfDay hour_of_day{{.min = 0.0, .max = 24.0}};
inline constexpr TimeOfDay hour_or_next_days{{.min = 0.0, .max = 28.0}};
inline constexpr NumberRange at_s{.min = 0.0, .max = 1e7};
inline constexpr NumberRange on_floor_m{.min = -1e4, .max = 1e4};  ///< where people go
/// assumed: far beyond any building, yet 1e-5 of it is still exact in float
inline constexpr NumberRange in_world_m{.min = -1e5, .max = 1e5};
inline constexpr NumberRange on_lens_plane_m{.min = -1e3, .max = 1e3};
inline constexpr NumberRange window_s{.above = 0.0, .max = 3600.0};
inline constexpr NumberRange probability{.min = 0.0, .max = 1.0};
inline constexpr NumberRange surface_c{.min = -50.0, .max = 200.0};  ///< degrees Celsius, of what stands in rooms
inline constexpr NumberRange skin_c{.min = -50.0, .max = 60.0};
inline constexpr NumberRange turned_deg{.min = -360.0, .max = 360.0};
inline constexpr NumberRange tilted_deg{.min = -90.0, .max = 90.0};
inline constexpr NumberRange time_constant_s{.above = 0.0, .max = 1000.0};
inline constexpr NumberRange corner_hz{.above = 0.0, .max = 1000.0};
inline constexpr NumberRange output_v{.min = 0.0, .max = 100.0};
inline constexpr NumberRange threshold_v{.above = 0.0, .max = 100.0};
inline constexpr NumberRange held_s{.min = 0.0, .max = 3600.0};
inline constexpr NumberRange waited_s{.min = 0.0, .max = 1e6};
inline constexpr NumberRange worked_s{.above = 0.0, .max = 1e6};
inline constexpr NumberRange meeting_min{.min = 1.0, .max = 1440.0};
inline constexpr IntegerRange meetings_a_day{.min = 0, .max = 100};
inline constexpr IntegerRange people_at_once{.min = 1, .max = 200};
inline constexpr IntegerRange people_of_counts{.min = 1, .max = 1000};
inline constexpr IntegerRange seed{.min = 0, .max = std::numeric_limits<long long>::max()};

}  // namespace accepted

}  // namespace pirsim
