// Specs to and from the plain objects of pirsim.specs, and vectors to arrays of numpy.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "model/schema/fields.hpp"
#include "pirsim/effects.hpp"
#include "pirsim/sample.hpp"

namespace pirsim {

template <>
struct Words<IncidentKind> {
  static constexpr WordList<IncidentKind, 4> all{{{"passed_through", IncidentKind::passed_through},
                                                  {"seat_changed", IncidentKind::seat_changed},
                                                  {"seat_missed", IncidentKind::seat_missed},
                                                  {"waited_outside", IncidentKind::waited_outside}}};
};
template <>
struct Words<effects::Reach> {
  static constexpr WordList<effects::Reach, 3> all{
      {{"geometry", effects::Reach::geometry}, {"triggers", effects::Reach::triggers}, {"rows", effects::Reach::rows}}};
};

}  // namespace pirsim

namespace pirsim::python {

namespace nb = nanobind;

/// Both need the GIL. `path` names the value in messages: "script.trials[0].people[0].stature_m".
template <typename T>
struct Convert;

template <typename T>
[[nodiscard]] nb::object to_python(const T& value) {
  return Convert<T>::to(value);
}
template <typename T>
[[nodiscard]] T from_python(nb::handle value, const std::string& path) {
  return Convert<T>::from(value, path);
}

/// A class of pirsim.specs.
[[nodiscard]] nb::object spec_class(const char* name);
/// Throws TypeError: "<path>: expected <what>, got a <type of value>".
[[noreturn]] void refuse(nb::handle value, const std::string& path, const std::string& what);
[[nodiscard]] nb::object item(nb::handle sequence, std::size_t i);
/// Of anything that can be iterated over but a text.
[[nodiscard]] nb::object as_tuple(nb::handle value, const std::string& path, const std::string& what);

template <>
struct Convert<double> {
  static nb::object to(double value) { return nb::float_(value); }
  static double from(nb::handle value, const std::string& path);
};
template <typename T>
requires(std::is_integral_v<T>) struct Convert<T> {
  static nb::object to(T value) { return nb::int_(value); }
  static T from(nb::handle value, const std::string& path) {
    T number{};
    if (nb::isinstance<nb::bool_>(value) || !nb::try_cast<T>(value, number)) refuse(value, path, "a whole number");
    return number;
  }
};
template <>
struct Convert<std::string> {
  static nb::object to(const std::string& value) { return nb::str(value.c_str(), value.size()); }
  static std::string from(nb::handle value, const std::string& path);
};
template <>
struct Convert<RaysPerZone> {
  static nb::object to(RaysPerZone value) { return nb::int_(static_cast<int>(value)); }
  static RaysPerZone from(nb::handle value, const std::string& path);
};
template <Worded T>
struct Convert<T> {
  static nb::object to(T value) { return nb::str(word_of(value)); }
  static T from(nb::handle value, const std::string& path) {
    std::string known;
    for (const auto& [word, meaning] : Words<T>::all) {
      if (nb::isinstance<nb::str>(value) && nb::cast<std::string>(value) == word) return meaning;
      known += (known.empty() ? "'" : ", '") + std::string(word) + "'";
    }
    refuse(value, path, "one of " + known);
  }
};

template <typename T>
struct Convert<std::optional<T>> {
  static nb::object to(const std::optional<T>& value) { return value ? to_python(*value) : nb::none(); }
  static std::optional<T> from(nb::handle value, const std::string& path) {
    if (value.is_none()) return std::nullopt;
    return from_python<T>(value, path);
  }
};
template <typename T>
struct Convert<std::vector<T>> {
  static nb::object to(const std::vector<T>& values) {
    nb::list list;
    for (const T& value : values) list.append(to_python(value));
    return list;
  }
  static std::vector<T> from(nb::handle value, const std::string& path) {
    const nb::object items = as_tuple(value, path, "a list");
    std::vector<T> values;
    for (std::size_t i = 0; i < nb::len(items); ++i) {
      values.push_back(from_python<T>(item(items, i), path + "[" + std::to_string(i) + "]"));
    }
    return values;
  }
};
template <typename T, std::size_t n>
struct Convert<std::array<T, n>> {
  static nb::object to(const std::array<T, n>& values) {
    return nb::tuple(to_python(std::vector<T>(values.begin(), values.end())));
  }
  static std::array<T, n> from(nb::handle value, const std::string& path) {
    const std::vector<T> values = from_python<std::vector<T>>(value, path);
    if (values.size() != n) refuse(value, path, std::to_string(n) + " items");
    std::array<T, n> result{};
    std::copy(values.begin(), values.end(), result.begin());
    return result;
  }
};
template <typename T, typename Compare>
struct Convert<std::map<std::string, T, Compare>> {
  using Map = std::map<std::string, T, Compare>;
  static nb::object to(const Map& values) {
    nb::dict dict;
    for (const auto& [key, value] : values) dict[to_python(key)] = to_python(value);
    return dict;
  }
  static Map from(nb::handle value, const std::string& path) {
    if (!nb::isinstance<nb::dict>(value)) refuse(value, path, "a dict");
    Map values;
    for (const auto& [key, entry] : nb::borrow<nb::dict>(value)) {
      const auto name = from_python<std::string>(key, path + ": a key");
      values[name] = from_python<T>(entry, path + "['" + name + "']");
    }
    return values;
  }
};

template <Described T>
struct Convert<T> {
  static nb::object to(const T& spec) {
    nb::dict fields;
    add(spec, fields);
    return spec_class(Fields<T>::name)(**fields);
  }
  static void add(const T& spec, nb::dict& fields) {
    each_field<T>([&](const auto& field) { fields[field.name] = to_python(spec.*field.member); });
  }
  static T from(nb::handle value, const std::string& path) {
    if (!nb::isinstance(value, spec_class(Fields<T>::name)))
      refuse(value, path, "a pirsim." + std::string(Fields<T>::name));
    T spec;
    each_field<T>([&](const auto& field) {
      using Value = std::remove_cvref_t<decltype(spec.*field.member)>;
      spec.*field.member = from_python<Value>(value.attr(field.name), path + "." + field.name);
    });
    return spec;
  }
};

/// What isn't a plain list of fields; defined one by one.
template <typename T>
struct Special {
  static nb::object to(const T& value);
  static T from(nb::handle value, const std::string& path);
};
template <>
struct Convert<Vec2> : Special<Vec2> {};
template <>
struct Convert<Vec3> : Special<Vec3> {};
template <>
struct Convert<Frame> : Special<Frame> {};
template <>
struct Convert<FloorArea> : Special<FloorArea> {};
template <>
struct Convert<TriMesh> : Special<TriMesh> {};
template <>
struct Convert<MeshSolid> : Special<MeshSolid> {};
template <>
struct Convert<ScriptedAction> : Special<ScriptedAction> {};
template <>
struct Convert<Issue> : Special<Issue> {};

/// A vector handed to numpy without a copy: the array owns the memory. Read-only, in C order. `As`: the element type
/// that numpy shows, of the same size.
template <typename As, typename T>
[[nodiscard]] nb::object to_numpy_as(std::vector<T>&& values, std::initializer_list<std::size_t> shape) {
  static_assert(sizeof(As) == sizeof(T));
  auto owned = std::make_unique<std::vector<T>>(std::move(values));
  const void* data = owned->data();
  nb::capsule owner(owned.get(), [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  (void)owned.release();
  return nb::cast(nb::ndarray<nb::numpy, const As>(data, shape.size(), shape.begin(), owner));
}
template <typename T>
[[nodiscard]] nb::object to_numpy(std::vector<T>&& values, std::initializer_list<std::size_t> shape) {
  return to_numpy_as<T>(std::move(values), shape);
}

/// Whatever `tell` makes of each item.
template <typename Item, typename Tell>
[[nodiscard]] nb::list listed(const std::vector<Item>& items, const Tell& tell) {
  nb::list all;
  for (const Item& item : items) all.append(tell(item));
  return all;
}

/// A scene or script made in Python, refused as a file with the same in it would be.
[[nodiscard]] SceneSpec checked_scene(nb::handle scene);
[[nodiscard]] ScriptSpec checked_script(nb::handle script);

}  // namespace pirsim::python
