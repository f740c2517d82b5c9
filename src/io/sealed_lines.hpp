// Lines of a text file of which each tells whether it, and all before it, are what was written. Private to the stores.
#pragma once

#include <optional>
#include <string>

namespace pirsim::io {

/// Every line ends in a digest of its text and of the line before. So a line that was altered, left out, doubled or
/// taken from another file is told from what was written. A text holds no end of line.
class SealedLines {
 public:
  /// The next line to write, with its end of line.
  [[nodiscard]] std::string sealed(const std::string& text);
  /// The text of the next line as it was read, without its end of line; none if it isn't what was written. Lines go on
  /// after the last one that was.
  [[nodiscard]] std::optional<std::string> opened(const std::string& line);

 private:
  [[nodiscard]] std::string digest_after(const std::string& text) const;
  std::string last_;  ///< digest
};

}  // namespace pirsim::io
