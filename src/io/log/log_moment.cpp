// Moments of a log, and how they are told.
#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "core/text.hpp"
#include "io/log/log_units.hpp"
#include "pirsim/log.hpp"
#include "schema/clock.hpp"

namespace pirsim {

using io::us_per_s;
LogMoment Log::moment(std::int64_t us) const {
  const auto after = std::ranges::upper_bound(offsets, us, {}, &LogOffset::from_us);
  if (offsets.empty()) return {us, 0};
  return {us, after == offsets.begin() ? after->offset_s : (after - 1)->offset_s};
}

std::string to_text(const LogMoment& moment, LogClock clock) {
  if (clock == LogClock::elapsed) return shortest_number(moment.seconds()) + " s";
  const std::int64_t local = moment.local_us();
  const std::int64_t part = ((local % us_per_s) + us_per_s) % us_per_s;
  std::string text = RunClock{(local - part) / us_per_s}.text(0.0);
  if (part == 0) return text;
  std::array<char, 16> digits{};
  std::snprintf(digits.data(), digits.size(), ".%06d", static_cast<int>(part));
  text += digits.data();
  while (text.ends_with('0')) text.pop_back();
  return text;
}

}  // namespace pirsim
