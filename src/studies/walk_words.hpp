// A walk test in words.
#pragma once

#include <cstddef>
#include <string>

#include "studies/walk_test.hpp"

namespace pirsim::studies {

/// Points that could be tried, and those of them that pass.
struct PassCount {
  std::size_t tried = 0, passed = 0;
};

[[nodiscard]] bool passes(const Tries& tries, const WalkRequirement& requirement);

/// What a walk test calls things, and what it says of them. The test outlives it.
class WalkWords {
 public:
  explicit WalkWords(const WalkTest& test) : test_(test), spec_(test.spec()) {}

  /// "walker noticed within 1.5 s in at least 90 % of 8 directions: 59 of 63 points pass", without a full stop.
  [[nodiscard]] std::string of_major(const PassCount& count) const;
  [[nodiscard]] std::string of_minor(const PassCount& count) const;
  /// "kitchen (PIR1): walker 3 of 4 points pass, arms 2 of 4"
  [[nodiscard]] std::string of_area(const std::string& area, const PassCount& major, const PassCount& minor) const;
  /// Of all tries of minor motion: how many failed, and in how many of those sensors saw what moved.
  [[nodiscard]] std::string of_deafness(const WalkTestResult& result) const;
  /// A line, or no text without seats.
  [[nodiscard]] std::string of_seats(const WalkTestResult& result) const;
  /// Until when motion counts: "within 1.5 s".
  [[nodiscard]] std::string time_of_major() const;
  [[nodiscard]] std::string time_of_minor() const;

  [[nodiscard]] std::string title() const;
  [[nodiscard]] std::string minor_heading() const;
  /// What is done, and what the sensors answer by.
  [[nodiscard]] std::string method() const;

 private:
  [[nodiscard]] std::string required(const WalkRequirement& requirement) const;
  [[nodiscard]] std::string planes() const;

  const WalkTest& test_;
  const WalkTestSpec& spec_;
};

}  // namespace pirsim::studies
