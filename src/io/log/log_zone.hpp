// A time zone of the IANA data base, with its summer time. Private to io.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/log.hpp"

namespace pirsim::io {

class LogZone {
 public:
  /// Throws Error: input, at `where`, for a name that the system's data base hasn't got; io if there is none.
  LogZone(const std::string& name, const Where& where);
  ~LogZone();

  /// How much local time is ahead of UTC then, seconds.
  [[nodiscard]] std::int32_t offset_at(std::int64_t utc_us);
  /// From begin to end.
  [[nodiscard]] std::vector<LogOffset> offsets(std::int64_t begin_us, std::int64_t end_us);

  enum class Kind {
    unique,
    ambiguous,  ///< clocks were put back: it was so late twice
    missing     ///< clocks were put forward: it was never so late
  };
  struct Found {
    std::int64_t utc_us;
    std::int64_t later_us;  ///< of an ambiguous time: the second one
    Kind kind;
  };
  /// A missing time is taken as that of a clock that wasn't put forward.
  [[nodiscard]] Found utc_of(std::int64_t local_us);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace pirsim::io
