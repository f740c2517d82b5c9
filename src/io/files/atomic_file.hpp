// Files: read whole, and written whole or not at all.
#pragma once

#include <charconv>
#include <filesystem>
#include <optional>
#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/input.hpp"

namespace pirsim::io {

/// A path that exists and isn't a regular file: /dev/stdout, a pipe.
[[nodiscard]] bool is_written_directly(const std::filesystem::path& path);

/// Writes a file of its own in the same folder (`<path>.writing-...`, which no other process has) and renames it onto
/// the path at commit, so that no reader, crash or full disk ever leaves half a file, and an older file survives a
/// failure. What a killed writer of this path left behind is removed. What is_written_directly() is not renamed. Every
/// fault is Error(io) that names the path and the cause.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();  ///< without commit: removes the partial file
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  [[nodiscard]] std::ostream& stream() noexcept { return stream_; }
  /// Flushes, checks that everything was written, and puts the file in its place. Once.
  void commit();
  /// As commit(), but a file that is there already stays: false then.
  [[nodiscard]] bool commit_if_new();

 private:
  /// Of a file that this object made, or of a device. Keeps the errno of the first write that failed, which streams
  /// forget.
  class Buffer : public std::streambuf {
   public:
    explicit Buffer(int descriptor);
    ~Buffer() override;
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;
    void close();
    [[nodiscard]] bool is_open() const noexcept { return descriptor_ >= 0; }
    int fault = 0;

   protected:
    int_type overflow(int_type c) override;
    std::streamsize xsputn(const char* data, std::streamsize size) override;
    int sync() override;

   private:
    bool put(const char* data, std::size_t size);
    int descriptor_;
    std::vector<char> waiting_;
  };
  /// The descriptor of `partial_`, which it names.
  int open();
  void close();  ///< with all that was written
  [[noreturn]] void fail(const char* what, int cause);

  std::filesystem::path path_;
  std::filesystem::path partial_;  ///< what is written; the path itself where it isn't a regular file
  int lock_ = -1;                  ///< a descriptor that keeps the lock on it until it is in its place
  Buffer buffer_;
  std::ostream stream_{&buffer_};
};

/// An AtomicFile with this text.
void write_text_file(const std::filesystem::path& path, std::string_view text);
/// Writes this text if there is no such file; one that is there stays as it is. False if another text is there.
[[nodiscard]] bool write_once(const std::filesystem::path& path, std::string_view text);

// How outputs treat their paths.

/// A link is followed, so that the file that it names is replaced and not the link.
[[nodiscard]] inline std::filesystem::path resolved(const std::filesystem::path& path) {
  std::error_code fault;
  const std::filesystem::path target = std::filesystem::canonical(path, fault);
  return fault ? path : target;
}

// What every reader of text files needs.

/// The bytes of what pirsim itself wrote, as read_input() reads them; what users write is read as text.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& path,
                                         std::size_t max_bytes = max_text_file_bytes);

/// The whole of `text` as a number, independent of the locale; a leading plus is allowed.
template <typename Number>
[[nodiscard]] std::optional<Number> parse_number(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Number value{};
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace pirsim::io
