// What describes a spec: one entry a field with its name, the numbers that it accepts and what it means. Whatever goes
// through all fields of a spec goes through this description: fingerprints, comparisons, readers, checks, Python, docs.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "model/core/range.hpp"

namespace pirsim {

enum class Use {
  study,    ///< what a study yields hangs on it
  message,  ///< only messages and outputs say it: names, descriptions, places in files
  reader    ///< the same, and no key of a file: whoever reads the file adds it
};

/// The range of fields that have none.
struct Unbounded {};
/// Of hours since midnight, which files give as a time of day: `from_h` is `from: 08:30`.
struct TimeOfDay : NumberRange {};

template <typename Spec, typename Value, typename Range = Unbounded>
struct Field {
  const char* name;  ///< of the member, in files and in Python
  Value Spec::*member;
  Range range;          ///< a NumberRange, an IntegerRange, or a function that makes one from the spec's other fields
  const char* meaning;  ///< in a few words, for Python and the pages; "": the name says it
  Use use;
  using Owner = Spec;
};

template <typename Spec, typename Value>
constexpr Field<Spec, Value> field(const char* name, Value Spec::*member, const char* meaning = "") {
  return {name, member, {}, meaning, Use::study};
}
template <typename Spec, typename Value, typename Range>
requires(!std::convertible_to<Range, const char*>)  //
    constexpr Field<Spec, Value, Range> field(const char* name, Value Spec::*member, Range range,
                                              const char* meaning = "") {
  return {name, member, range, meaning, Use::study};
}
/// A field that only messages say.
template <typename Spec, typename Value>
constexpr Field<Spec, Value> label(const char* name, Value Spec::*member, const char* meaning = "") {
  return {name, member, {}, meaning, Use::message};
}

/// A field that whoever reads a file adds.
template <typename Spec, typename Value>
constexpr Field<Spec, Value> added(const char* name, Value Spec::*member) {
  return {name, member, {}, "", Use::reader};
}

/// Specialised for each spec (schema/fields.hpp): its `name` in Python, what it is `about`, and `all` fields.
template <typename Spec>
struct Fields;

template <typename T>
concept Described = requires {
  Fields<T>::all;
};

/// Doesn't compile for a spec that has another number of fields than n, which is at most 32.
template <std::size_t n, typename Spec>
constexpr bool has_fields() {
  [[maybe_unused]] const auto take = [](Spec& spec) {
    // clang-format off
    if constexpr (n == 1) { auto& [a] = spec; (void)a; }
    else if constexpr (n == 2) { auto& [a, b] = spec; (void)a; }
    else if constexpr (n == 3) { auto& [a, b, c] = spec; (void)a; }
    else if constexpr (n == 4) { auto& [a, b, c, d] = spec; (void)a; }
    else if constexpr (n == 5) { auto& [a, b, c, d, e] = spec; (void)a; }
    else if constexpr (n == 6) { auto& [a, b, c, d, e, f] = spec; (void)a; }
    else if constexpr (n == 7) { auto& [a, b, c, d, e, f, g] = spec; (void)a; }
    else if constexpr (n == 8) { auto& [a, b, c, d, e, f, g, h] = spec; (void)a; }
    else if constexpr (n == 9) { auto& [a, b, c, d, e, f, g, h, i] = spec; (void)a; }
    else if constexpr (n == 10) { auto& [a, b, c, d, e, f, g, h, i, j] = spec; (void)a; }
    else if constexpr (n == 11) { auto& [a, b, c, d, e, f, g, h, i, j, k] = spec; (void)a; }
    else if constexpr (n == 12) { auto& [a, b, c, d, e, f, g, h, i, j, k, l] = spec; (void)a; }
    else if constexpr (n == 13) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = spec; (void)a; }
    else if constexpr (n == 14) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o] = spec; (void)a; }
    else if constexpr (n == 15) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p] = spec; (void)a; }
    else if constexpr (n == 16) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q] = spec; (void)a; }
    else if constexpr (n == 17) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r] = spec; (void)a; }
    else if constexpr (n == 18) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s] = spec; (void)a; }
    else if constexpr (n == 19) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t] = spec; (void)a; }
    else if constexpr (n == 20) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u] = spec; (void)a; }
    else if constexpr (n == 21) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u,
      v] = spec; (void)a; }
    else if constexpr (n == 22) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v,
      w] = spec; (void)a; }
    else if constexpr (n == 23) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w,
      x] = spec; (void)a; }
    else if constexpr (n == 24) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x,
      y] = spec; (void)a; }
    else if constexpr (n == 25) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x, y,
      z] = spec; (void)a; }
    else if constexpr (n == 26) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x, y, z,
      a2] = spec; (void)a; }
    else if constexpr (n == 27) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x, y, z,
      a2, b2] = spec; (void)a; }
    else if constexpr (n == 28) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x, y, z,
      a2, b2, c2] = spec; (void)a; }
    else if constexpr (n == 29) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x, y, z,
      a2, b2, c2, d2] = spec; (void)a; }
    else if constexpr (n == 30) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x, y, z,
      a2, b2, c2, d2, e2] = spec; (void)a; }
    else if constexpr (n == 31) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x, y, z,
      a2, b2, c2, d2, e2, f2] = spec; (void)a; }
    else if constexpr (n == 32) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t, u, v, w, x, y, z,
      a2, b2, c2, d2, e2, f2, g2] = spec; (void)a; }
    else if constexpr (n == 0) static_assert(std::is_empty_v<Spec>, "the description has no fields, the spec has some");
    else static_assert(n <= 32, "has_fields() counts up to 32 fields: write a line more");
    // clang-format on
  };
  return true;
}

/// Calls visit(field) for every field. A spec whose description lacks one doesn't compile.
template <Described Spec, typename Visit>
constexpr void each_field(Visit&& visit) {
  static_assert(has_fields<std::tuple_size_v<std::remove_cvref_t<decltype(Fields<Spec>::all)>>, Spec>());
  std::apply([&](const auto&... field) { (visit(field), ...); }, Fields<Spec>::all);
}

/// What a field accepts, in a spec with these other fields.
template <typename Spec, typename Value, typename Range>
[[nodiscard]] constexpr auto range_of(const Field<Spec, Value, Range>& field, const Spec& spec) {
  if constexpr (std::invocable<Range, const Spec&>) {
    return field.range(spec);
  } else {
    return field.range;
  }
}
template <typename F>
using RangeOf = decltype(range_of(std::declval<const F&>(), std::declval<const typename F::Owner&>()));
/// A field that is given as a number.
template <typename F>
concept NumberField = std::same_as<RangeOf<F>, NumberRange> || std::same_as<RangeOf<F>, IntegerRange>;
template <typename F>
concept TimeField = std::same_as<RangeOf<F>, TimeOfDay>;

/// The key of a field in files: times of day leave out their unit, `from_h` is `from`.
template <typename Spec, typename Value, typename Range>
[[nodiscard]] std::string key_of(const Field<Spec, Value, Range>& field) {
  std::string key = field.name;
  if constexpr (std::same_as<Range, TimeOfDay>) key.resize(key.size() - std::string_view("_h").size());
  return key;
}

/// Calls `visit(name, number, range)` for every number of the spec itself that is given as a number, not of its parts.
template <typename Spec, typename Visit>
requires Described<std::remove_const_t<Spec>>
void each_number(Spec& spec, Visit&& visit) {
  each_field<std::remove_const_t<Spec>>([&](const auto& field) {
    if constexpr (NumberField<std::remove_cvref_t<decltype(field)>>)
      visit(field.name, spec.*field.member, range_of(field, std::as_const(spec)));
  });
}

/// Are two values the same but for what only messages say?
template <typename Value>
[[nodiscard]] bool same(const Value& a, const Value& b) {
  if constexpr (Described<Value>) {
    bool is_same = true;
    each_field<Value>([&](const auto& field) {
      if (field.use == Use::study) is_same = is_same && same(a.*field.member, b.*field.member);
    });
    return is_same;
  } else if constexpr (requires { std::variant_size<Value>::value; }) {
    return a.index() == b.index() &&
           std::visit([&](const auto& one) { return same(one, std::get<std::remove_cvref_t<decltype(one)>>(b)); }, a);
  } else if constexpr (requires { a.has_value(); }) {
    return a.has_value() == b.has_value() && (!a || same(*a, *b));
  } else if constexpr (requires { a.data(); }) {
    return std::ranges::equal(a, b, [](const auto& x, const auto& y) { return same(x, y); });
  } else {
    return a == b;
  }
}

/// The description of one field: `field_of<&WalkTestSpec::path_m>()`.
template <auto member>
[[nodiscard]] constexpr auto field_of() {
  return []<typename Spec, typename Value>(Value Spec::*) {
    constexpr auto& all = Fields<Spec>::all;
    constexpr std::size_t index = []<std::size_t... i>(std::index_sequence<i...>) {
      std::size_t found = sizeof...(i);
      const auto compare = [&]<std::size_t at>() {
        if constexpr (std::same_as<std::remove_cvref_t<decltype(std::get<at>(Fields<Spec>::all).member)>,
                                   Value Spec::*>) {
          if (std::get<at>(Fields<Spec>::all).member == member) found = at;
        }
      };
      (compare.template operator()<i>(), ...);
      return found;
    }
    (std::make_index_sequence<std::tuple_size_v<std::remove_cvref_t<decltype(all)>>>());
    return std::get<index>(all);
  }(member);
}

}  // namespace pirsim

// Ranges that fields of several specs accept, and how a description names a member (schema/fields.hpp).

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
inline constexpr NumberRange array_noise_k{.min = 0.0, .max = 100.0};
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
