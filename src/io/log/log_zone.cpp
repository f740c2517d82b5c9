#include "io/log/log_zone.hpp"

#include <date/tz.h>

#include <chrono>
#include <optional>
#include <stdexcept>
#include <vector>

#include "io/log/log_units.hpp"

namespace pirsim::io {
namespace {

using std::chrono::seconds;
/// Rounded down.
seconds whole_seconds(std::int64_t us) { return std::chrono::floor<seconds>(std::chrono::microseconds(us)); }

/// Some systems keep the rules of years to come in a form that the date library passes over: clocks would never be
/// changed again, and nobody would know. Such a data base lacks what every other one has.
void require_coming_years(const date::tzdb& known) {
  constexpr seconds july_2036{2'098'656'000};
  constexpr seconds ahead{7200};
  for (const date::time_zone& zone : known.zones) {
    if (zone.name() != "Europe/Berlin") continue;
    if (zone.get_info(date::sys_seconds(july_2036)).offset == ahead) return;
    throw Error(ErrorCode::io,
                "the system's time zones don't list summer times of the years to come (made by zic -b slim); "
                "time_zone needs those that do (zic -b fat)");
  }
}

const date::time_zone* find_zone(const std::string& name, const Where& where) {
  try {
    const date::tzdb& known = date::get_tzdb();
    require_coming_years(known);
    for (const date::time_zone& zone : known.zones) {
      if (zone.name() == name) return &zone;
    }
    std::vector<std::string> names;
    for (const date::time_zone& zone : known.zones) names.push_back(zone.name());
    throw Error(ErrorCode::input, where,
                "time_zone: '" + name + "' is not a time zone, as Europe/Berlin is one" + did_you_mean(name, names));
  } catch (const std::runtime_error& fault) {
    if (dynamic_cast<const Error*>(&fault) != nullptr) throw;
    throw Error(ErrorCode::io, std::string("the system's time zones can't be read (package tzdata): ") + fault.what());
  }
}

}  // namespace

struct LogZone::Data {
  const date::time_zone* zone;
  std::optional<date::sys_info> last;  ///< most times have the offset of the one before

  const date::sys_info& at(seconds utc) {
    const date::sys_seconds moment(utc);
    if (!last || moment < last->begin || moment >= last->end) last = zone->get_info(moment);
    return *last;
  }
};

LogZone::LogZone(const std::string& name, const Where& where)
    : data_(std::make_unique<Data>(Data{find_zone(name, where), std::nullopt})) {}
LogZone::~LogZone() = default;

std::int32_t LogZone::offset_at(std::int64_t utc_us) {
  return static_cast<std::int32_t>(data_->at(whole_seconds(utc_us)).offset.count());
}

std::vector<LogOffset> LogZone::offsets(std::int64_t begin_us, std::int64_t end_us) {
  std::vector<LogOffset> found;
  std::int64_t from_us = begin_us;
  while (true) {
    const date::sys_info& info = data_->at(whole_seconds(from_us));
    found.push_back({from_us, static_cast<std::int32_t>(info.offset.count())});
    const seconds end = info.end.time_since_epoch();
    if (end > whole_seconds(end_us)) return found;
    from_us = us_per_s * end.count();
  }
}

LogZone::Found LogZone::utc_of(std::int64_t local_us) {
  constexpr std::int64_t away_us = 86'400 * us_per_s;  // from any change, so that none can concern it
  if (data_->last) {
    const std::int64_t utc_us = local_us - us_per_s * data_->last->offset.count();
    const seconds before = whole_seconds(utc_us - away_us), after = whole_seconds(utc_us + away_us);
    if (before >= data_->last->begin.time_since_epoch() && after < data_->last->end.time_since_epoch())
      return {utc_us, utc_us, Kind::unique};
  }
  const date::local_info found = data_->zone->get_info(date::local_seconds(whole_seconds(local_us)));
  const std::int64_t first = local_us - us_per_s * found.first.offset.count();
  data_->last = found.first;
  if (found.result == date::local_info::unique) return {first, first, Kind::unique};
  const std::int64_t second = local_us - us_per_s * found.second.offset.count();
  return {first, second, found.result == date::local_info::ambiguous ? Kind::ambiguous : Kind::missing};
}

}  // namespace pirsim::io
