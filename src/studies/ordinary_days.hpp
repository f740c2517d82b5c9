// A script for ordinary days of a room, to be run or edited.
#pragma once

#include <string>

namespace pirsim::studies {

/// Staff, meetings or both; or residents.
struct OrdinaryDays {
  int staff = 0;  ///< who have a desk
  enum class Meetings { none, held } meetings = Meetings::none;
  int residents = 0;  ///< every other one goes to work
  int days = 5;
  std::string first_day = "2026-03-02";
  std::string from, to;  ///< times of day; empty: 00:00 and 24:00
  std::string cleaning;  ///< time of day, or "none"; empty: 19:00

  [[nodiscard]] bool is_office() const noexcept { return staff > 0 || meetings == Meetings::held; }
  [[nodiscard]] bool is_home() const noexcept { return residents > 0; }
};

/// The script as YAML. Nothing is checked: dates and times are put into it as they are.
[[nodiscard]] std::string script_text(const OrdinaryDays& days);

}  // namespace pirsim::studies
