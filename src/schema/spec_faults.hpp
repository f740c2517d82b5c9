// Faults of specs that a program made, each with the place in the spec.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pirsim/error.hpp"
#include "schema/check_specs.hpp"
#include "schema/fields.hpp"
#include "schema/limits.hpp"

namespace pirsim {

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
