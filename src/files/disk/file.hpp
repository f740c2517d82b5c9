// A file descriptor whose every fault is an Error that names the file and the cause. Private to the stores.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/input_file.hpp"

namespace pirsim::io {

/// What "-" on a command line stands for: read as it was inherited, and so from where it stands.
constexpr const char* standard_input = "/dev/stdin";

enum class Lock { taken, of_another, unknown };  ///< unknown: a file system without locks
/// Until all copies of the descriptor are closed, however the process ends.
[[nodiscard]] Lock try_lock(int descriptor) noexcept;
/// False if the file was removed or replaced since it was opened.
[[nodiscard]] bool is_named(const std::filesystem::path& path, int descriptor) noexcept;

class PosixFile {
 public:
  enum class Mode {
    read,
    /// Reads, and writes at the end; made if it isn't there. Only a regular file of one name, and no link: what is
    /// written here in place is nobody else's.
    append,
  };
  /// Throws Error(io).
  PosixFile(std::filesystem::path path, Mode mode);
  ~PosixFile();
  PosixFile(PosixFile&& other) noexcept;
  PosixFile(const PosixFile&) = delete;
  PosixFile& operator=(const PosixFile&) = delete;

  /// How many bytes were read; 0 at the end. Throws Error(stopped) if a signal is handled while a pipe is waited for.
  [[nodiscard]] std::size_t read(char* to, std::size_t size);
  void append(std::string_view bytes);  ///< all of them
  void truncate(std::uint64_t size);
  void rewind();
  [[nodiscard]] std::uint64_t size() const;
  /// Throws Error(io) if another process holds the lock, or replaced the file meanwhile. Folders that know no locks
  /// pass.
  void lock();

 private:
  void require_own() const;
  void wait() const;                               ///< until there is something to read, or nobody left who writes
  [[noreturn]] void fail(const char* what) const;  ///< says what errno means

  std::filesystem::path path_;
  int descriptor_;
  bool is_regular_ = false;
};

// UTF-16 to UTF-8, piece by piece.

class Utf16Decoder {
 public:
  enum class ByteOrder { little, big };
  explicit Utf16Decoder(ByteOrder order) noexcept : order_(order) {}

  /// Appends what the bytes say; a character that they cut waits for the next ones. What isn't UTF-16 is told in words,
  /// and `text` then ends before it.
  [[nodiscard]] std::optional<std::string> add(std::string_view bytes, std::string& text);
  /// After the last bytes: what is missing, in words.
  [[nodiscard]] std::optional<std::string> finish() const;

 private:
  ByteOrder order_;
  std::optional<unsigned char> half_;  ///< a unit's first byte
  char32_t high_ = 0;                  ///< the first of a pair of surrogates; 0: none waits
};

// What comes in. Each input is opened once, and what is recorded of it is taken from the bytes that are parsed.

/// A regular file, a pipe, or standard input ("/dev/stdin"), whole.
struct Input {
  std::filesystem::path path;
  std::string bytes;

  [[nodiscard]] InputFile file() const;  ///< with its hash
  /// The bytes as UTF-8 without a byte order mark; UTF-16 is converted by its own. Throws Error(input) with line and
  /// column for what is neither.
  [[nodiscard]] std::string text() const;
};

constexpr std::size_t max_text_file_bytes = 16'000'000;

/// Throws Error: io if it can't be read, input if it is larger, stopped if a signal is handled while it is waited for.
[[nodiscard]] Input read_input(const std::filesystem::path& path, std::size_t max_bytes = max_text_file_bytes);

/// As records name it: the file's name, "stdin", or "pipe" for one that has none, whose number changes from call to
/// call.
[[nodiscard]] std::string name_of_input(const std::filesystem::path& path);
/// An input's name without its ending: what a study is called that doesn't say.
[[nodiscard]] std::string stem_of_input(const std::filesystem::path& path);
/// Where the files that it names are looked for: beside it, or in the working folder if it has no folder of its own.
[[nodiscard]] std::filesystem::path folder_of_input(const std::filesystem::path& path);

/// By its first 16 bytes, what holds no text but is often given for one, and what to do; empty for anything else.
[[nodiscard]] std::string_view name_of_binary(std::string_view bytes);

/// As Input::text(), of bytes; `name` stands in messages.
[[nodiscard]] std::string text_from(std::string bytes, const std::string& name);

// Files: read whole, and written whole or not at all.

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

// What is made piece by piece and may be interrupted: of what it is made, and which pieces are there.

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
