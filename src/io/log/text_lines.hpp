// Lines that programs write for people, as rows of a table of time, sensor and state. Private to io.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/log/log_remarks.hpp"
#include "io/log/log_shape.hpp"

namespace pirsim::io {

class TextLines {
 public:
  enum class Writer { openhab, zigbee2mqtt, esphome };
  /// Whose text the first lines are; none: nobody's that is known.
  [[nodiscard]] static std::optional<Writer> writer_of(std::span<const HeadLine> head);

  TextLines(Writer writer, std::string file) : writer_(writer), file_(std::move(file)) {}

  [[nodiscard]] std::string_view name() const;
  /// Adds the changes that a line tells to `rows`, each a line of a table of tabs with the columns of `header`.
  void read(const HeadLine& line, std::vector<HeadLine>& rows, LogRemarks& remarks);
  static constexpr std::string_view header = "time\tsensor\tstate";
  /// Lines that tell of something else.
  [[nodiscard]] std::uint64_t n_other() const noexcept { return n_other_; }

 private:
  struct Change {
    std::string time, sensor, state;
    bool operator==(const Change&) const = default;
  };
  using Changes = std::vector<Change>;
  [[nodiscard]] Changes changes_in(std::string_view text, int line, LogRemarks& remarks);
  [[nodiscard]] Changes of_zigbee2mqtt(std::string_view text);
  [[nodiscard]] Changes of_esphome(std::string_view text, int line, LogRemarks& remarks);
  [[nodiscard]] std::string since_first_midnight(std::int64_t us, int line, LogRemarks& remarks);

  Writer writer_;
  std::string file_;
  std::uint64_t n_other_ = 0;
  std::map<std::string, std::map<std::string, Change>> told_;  ///< the last one by device and property
  std::int64_t last_us_ = 0, days_us_ = 0;                     ///< of times of day
};

}  // namespace pirsim::io
