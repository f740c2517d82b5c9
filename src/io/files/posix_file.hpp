// A file descriptor whose every fault is an Error that names the file and the cause. Private to the stores.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

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

}  // namespace pirsim::io
