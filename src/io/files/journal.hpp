// What is made piece by piece and may be interrupted: of what it is made, and which pieces are there.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/files/posix_file.hpp"

namespace pirsim::io {

/// A text file of one process at a time: a line that says of what everything is made, then a line a finished piece.
/// Each line ends in a digest of its text and of the line before. So a line that was altered, left out, doubled or
/// taken from elsewhere is told from what was written, and the journal ends before it. No text holds an end of line.
class Journal {
 public:
  /// As far as it was written whole.
  struct Content {
    std::string made_from;
    std::vector<std::string> pieces;  ///< the first is line 2
  };
  /// Of any journal, whoever is at work on it; none if there is no whole line. Throws Error(input) if the first line
  /// isn't what was written.
  [[nodiscard]] static std::optional<Content> read(const std::filesystem::path& file);
  [[nodiscard]] static std::string text(const Content& content);

  /// Opens the file, or makes it. Throws Error(io), also if another process is at work on it.
  explicit Journal(std::filesystem::path file);

  [[nodiscard]] bool is_empty() const { return file_.size() == 0; }
  /// Starts anew.
  void begin(const std::string& made_from);
  /// Continues what read() found and forgets what follows.
  void resume(const Content& found);
  /// The piece is in the file when this returns.
  void add(const std::string& piece);
  /// All is made, or there is no sense in going on.
  void remove();

 private:
  std::filesystem::path path_;
  PosixFile file_;
  std::string last_digest_;
};

}  // namespace pirsim::io
