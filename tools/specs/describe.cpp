// Prints the description of all specs (model/schema/fields.hpp) as JSON: types and default values as Python writes
// them, what numbers are accepted, what each field means. tools/specs/write.py compiles it, and writes Python's classes
// and the pages' tables of keys from what it prints.
#include <array>
#include <charconv>
#include <cmath>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "model/schema/dome.hpp"
#include "model/schema/fields.hpp"
#include "rooms/recipe_fields.hpp"
#include "surveys/light_fields.hpp"

namespace pirsim {
namespace {

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string number(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  const std::string shortest(text.data(), end);
  return shortest.find_first_of(".e") == std::string::npos ? shortest + ".0" : shortest;
}

/// Words that are numbers are numbers in Python.
std::string word(std::string_view text) {
  return text.find_first_not_of("0123456789") == std::string::npos ? std::string(text) : in_quotes(text);
}

template <Worded T>
std::string literal() {
  std::string words;
  for (const auto& [name, value] : Words<T>::all) words += (words.empty() ? "" : ", ") + word(name);
  return "Literal[" + words + "]";
}

/// What Python calls a type, and how it writes a value of it.
template <typename T>
struct Python;

template <typename T>
std::string type_of() {
  return Python<T>::type();
}
template <typename T>
std::string written(const T& value) {
  return Python<T>::text(value);
}

template <>
struct Python<double> {
  static std::string type() { return "float"; }
  static std::string text(double value) { return number(value); }
};
template <typename T>
requires std::is_integral_v<T>
struct Python<T> {
  static std::string type() { return "int"; }
  static std::string text(T value) { return std::to_string(value); }
};
template <>
struct Python<std::string> {
  static std::string type() { return "str"; }
  static std::string text(const std::string& value) { return in_quotes(value); }
};
template <Worded T>
struct Python<T> {
  static std::string type() { return literal<T>(); }
  static std::string text(T value) { return word(word_of(value)); }
};
template <>
struct Python<Activity> {
  static std::string type() { return "Activity"; }
  static std::string text(Activity value) { return word(word_of(value)); }
};
template <typename T>
struct Python<std::optional<T>> {
  static std::string type() { return type_of<T>() + " | None"; }
  static std::string text(const std::optional<T>& value) { return value ? written(*value) : "None"; }
};
template <typename T>
struct Python<std::vector<T>> {
  static std::string type() { return "list[" + type_of<T>() + "]"; }
  static std::string text(const std::vector<T>& values) {
    std::string items;
    for (const T& value : values) items += (items.empty() ? "" : ", ") + written(value);
    return "[" + items + "]";
  }
};
template <typename T, std::size_t n>
struct Python<std::array<T, n>> {
  static std::string type() { return "Sequence[" + type_of<T>() + "]"; }
  static std::string text(const std::array<T, n>& values) {
    const std::string list = written(std::vector<T>(values.begin(), values.end()));
    return "(" + list.substr(1, list.size() - 2) + ")";
  }
};
template <typename T, typename Compare>
struct Python<std::map<std::string, T, Compare>> {
  static std::string type() { return "dict[str, " + type_of<T>() + "]"; }
  static std::string text(const std::map<std::string, T, Compare>&) { return "{}"; }  // none has entries by default
};
/// What is drawn, as files write it: a number, or [least, most].
template <typename T>
requires requires(T ends) { ends.least; }
struct Python<T> {
  static std::string type() { return "[least, most]"; }
  static std::string text(const T& ends) {
    const std::string least = written(ends.least), most = written(ends.most);
    return least == most ? least : "[" + least + ", " + most + "]";
  }
};
template <>
struct Python<Vec2> {
  static std::string type() { return "Point2"; }
  static std::string text(const Vec2& p) { return "(" + number(p.x) + ", " + number(p.y) + ")"; }
};
template <>
struct Python<Vec3> {
  static std::string type() { return "Point3"; }
  static std::string text(const Vec3& p) { return "(" + number(p.x) + ", " + number(p.y) + ", " + number(p.z) + ")"; }
};
/// Classes with a form of their own, without arguments by default.
template <typename T>
struct Named {
  static std::string text(const T&) { return Python<T>::type() + "()"; }
};
template <>
struct Python<Frame> : Named<Frame> {
  static std::string type() { return "Frame"; }
};
template <>
struct Python<FloorArea> : Named<FloorArea> {
  static std::string type() { return "Floor"; }
};
template <>
struct Python<MeshSolid> : Named<MeshSolid> {
  static std::string type() { return "MeshSolid"; }
};
template <>
struct Python<Action> : Named<Action> {
  static std::string type() { return "Action"; }
};
template <>
struct Python<ScriptedAction> : Named<ScriptedAction> {
  static std::string type() { return "Action"; }
};
template <Described T>
struct Python<T> {
  static std::string type() {
    if constexpr (requires { Fields<T>::name; }) {
      return Fields<T>::name;
    } else {
      return "None";  // no class of Python's
    }
  }
  static std::string text(const T& value) {
    const T plain{};
    std::string arguments;
    each_field<T>([&](const auto& field) {
      if (!same(value.*field.member, plain.*field.member))
        arguments += (arguments.empty() ? "" : ", ") + std::string(field.name) + "=" + written(value.*field.member);
    });
    return type() + "(" + arguments + ")";
  }
};

/// The words that a field may have, where those are only some of its type's.
template <Worded Enum, std::size_t n>
std::string among(const std::array<Enum, n>& allowed) {
  std::string words;
  for (const Enum one : allowed) words += (words.empty() ? "" : ", ") + in_quotes(word_of(one));
  return ", \"among\": [" + words + "]";
}
std::string among(const auto&) { return ""; }

template <typename Spec>
constexpr bool is_action = []<typename... What>(std::variant<What...>*) {
  return (std::same_as<Spec, What> || ...);
}(static_cast<Action*>(nullptr));

/// What a file has as a number, a time of day, a text, or several of them.
template <typename F, typename Value>
constexpr bool is_plain() {
  if constexpr (NumberField<F> || TimeField<F> || Worded<Value> || std::same_as<Value, std::string> ||
                std::same_as<Value, std::vector<std::string>>) {
    return true;
  } else if constexpr (requires { typename Value::value_type; }) {
    return Worded<typename Value::value_type>;
  } else {
    return false;
  }
}

std::string time_of_day(double hours) {
  const int minutes = static_cast<int>(std::lround(60.0 * hours));
  const auto two = [](int number) { return std::string(number < 10 ? "0" : "") + std::to_string(number); };
  return two(minutes / 60) + ":" + two(minutes % 60);
}

/// Of specs that only files have: their plain fields, for tables of keys.
template <typename Spec>
void print_keys() {
  const Spec spec{};
  std::cout << "  " << in_quotes(Fields<Spec>::name) << ": {\"is_action\": false, \"fields\": [";
  bool is_first = true;
  each_field<Spec>([&](const auto& field) {
    using F = std::remove_cvref_t<decltype(field)>;
    using Value = std::remove_cvref_t<decltype(spec.*field.member)>;
    if constexpr (is_plain<F, Value>()) {
      if (field.use != Use::study) return;
      std::string value = written(spec.*field.member);
      if constexpr (TimeField<F>) value = in_quotes(time_of_day(spec.*field.member));
      std::cout << (is_first ? "\n" : ",\n") << "    {\"name\": " << in_quotes(key_of(field))
                << ", \"type\": " << in_quotes(type_of<Value>()) << ", \"default\": " << in_quotes(value)
                << ", \"meaning\": " << in_quotes(field.meaning) << ", \"plain\": true" << among(field.range) << "}";
      is_first = false;
    }
  });
  std::cout << "]},\n";
}

template <typename Spec>
void print(std::string_view key) {
  const Spec spec{};
  std::cout << "  " << in_quotes(key) << ": {\"is_action\": " << (is_action<Spec> ? "true" : "false");
  if constexpr (requires { Fields<Spec>::about; }) std::cout << ", \"about\": " << in_quotes(Fields<Spec>::about);
  std::cout << ", \"fields\": [";
  bool is_first = true;
  each_field<Spec>([&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(spec.*field.member)>;
    std::cout << (is_first ? "\n" : ",\n") << "    {\"name\": " << in_quotes(field.name)
              << ", \"type\": " << in_quotes(type_of<Value>())
              << ", \"default\": " << in_quotes(written(spec.*field.member))
              << ", \"meaning\": " << in_quotes(field.meaning) << among(field.range) << "}";
    is_first = false;
  });
  std::cout << "]},\n";
}

template <typename... Specs>
void print_all(std::tuple<Specs...>*) {
  (print<Specs>(Fields<Specs>::name), ...);
}

}  // namespace
}  // namespace pirsim

int main() {
  using namespace pirsim;
  std::cout << "{\n";
  print<ScriptedAction>("_Action");
  print_all(static_cast<SpecsOfPython*>(nullptr));
  print<DomeSpec>("dome");
  print<XShapesSpec>("x_shapes");
  print<CoverageSpec>("coverage");
  print<PlacementSearchSpec>("search");
  print<WalkRequirement>("requirement");
  print<WalkTestSpec>("walk_test");
  print<SwingingArmSpec>("arm");
  print<PlacementLightSpec>("placement_light");
  print<NuisanceSpec>("nuisance");
  print_keys<dataset::RecipeSpec>();
  print_keys<dataset::RoomGroupSpec>();
  print_keys<dataset::RoomSpec>();
  print_keys<dataset::SensorGroupSpec>();
  print_keys<dataset::FlatSpec>();
  print_keys<dataset::HomePlanSpec>();
  print_keys<dataset::PlanRoomSpec>();
  print_keys<dataset::PlanPieceSpec>();
  print_keys<dataset::PlanSensorSpec>();
  print_keys<dataset::PlanDoorSpec>();
  print_keys<dataset::HouseholdRangesSpec>();
  print_keys<dataset::VariedEffectSpec>();
  print_keys<dataset::SplitSpec>();
  print_keys<control::LightSpec>();
  print_keys<control::TogetherSpec>();
  print_keys<control::ManualSpec>();
  print_keys<control::NightSpec>();
  std::cout << "  \"Activity\": " << in_quotes(literal<Activity>()) << "\n}\n";
}
