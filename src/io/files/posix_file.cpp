#include "io/files/posix_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "pirsim/error.hpp"

namespace pirsim::io {
namespace {

template <typename Call>
auto without_interruption(const Call& call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

[[noreturn]] void refuse(const std::filesystem::path& path, const char* why) {
  throw Error(ErrorCode::io, Where{path.string()}, std::string("can't be written: it ") + why + "; move it away");
}

}  // namespace

Lock try_lock(int descriptor) noexcept {
  if (without_interruption([&] { return ::flock(descriptor, LOCK_EX | LOCK_NB); }) == 0) return Lock::taken;
  return errno == EWOULDBLOCK ? Lock::of_another : Lock::unknown;
}

bool is_named(const std::filesystem::path& path, int descriptor) noexcept {
  struct stat opened {
  }, named{};
  return ::lstat(path.c_str(), &named) == 0 && ::fstat(descriptor, &opened) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

PosixFile::PosixFile(std::filesystem::path path, Mode mode) : path_(std::move(path)) {
  // A pipe that nobody writes to yet is opened at once, and waited for where a signal can end the waiting.
  const int flags = mode == Mode::read ? O_RDONLY | O_NONBLOCK : O_RDWR | O_CREAT | O_APPEND | O_NOFOLLOW;
  const bool is_standard_input = mode == Mode::read && path_ == standard_input;  // which can't be opened if a socket
  descriptor_ = is_standard_input
                    ? ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0)
                    : without_interruption([&] { return ::open(path_.c_str(), flags | O_CLOEXEC, 0666); });
  if (descriptor_ < 0 && errno == ELOOP && mode == Mode::append) refuse(path_, "is a link, which isn't followed");
  if (descriptor_ < 0) fail(mode == Mode::read ? "can't be read" : "can't write");
  if (mode == Mode::append) require_own();
  struct stat status {};
  is_regular_ = ::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
}

PosixFile::PosixFile(PosixFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      is_regular_(other.is_regular_) {}

PosixFile::~PosixFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void PosixFile::require_own() const {
  struct stat status {};
  if (::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode) && status.st_nlink == 1) return;
  const bool is_named_twice = S_ISREG(status.st_mode) && status.st_nlink > 1;
  ::close(descriptor_);  // whose constructor throws has no destructor
  refuse(path_, is_named_twice ? "has another name too (a hard link), under which it would change" : "is no file");
}

std::size_t PosixFile::read(char* to, std::size_t size) {
  while (true) {
    if (!is_regular_) wait();
    const ssize_t n = ::read(descriptor_, to, size);
    if (n >= 0) return static_cast<std::size_t>(n);
    if (errno != EINTR && errno != EAGAIN) fail("can't be read");
  }
}

void PosixFile::wait() const {
  pollfd input{descriptor_, POLLIN, 0};
  if (::poll(&input, 1, -1) >= 0) return;
  if (errno != EINTR) fail("can't be read");
  throw Error(ErrorCode::stopped, Where{path_.string()}, "a signal came while this was waited for");
}

void PosixFile::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = without_interruption([&] { return ::write(descriptor_, bytes.data(), bytes.size()); });
    if (n < 0) fail("can't write");
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void PosixFile::truncate(std::uint64_t size) {
  if (without_interruption([&] { return ::ftruncate(descriptor_, static_cast<off_t>(size)); }) < 0) fail("can't write");
}

void PosixFile::rewind() {
  if (::lseek(descriptor_, 0, SEEK_SET) < 0) fail("can't be read");
}

std::uint64_t PosixFile::size() const {
  struct stat status {};
  if (::fstat(descriptor_, &status) < 0) fail("can't be read");
  return static_cast<std::uint64_t>(status.st_size);
}

void PosixFile::lock() {
  const Lock lock = try_lock(descriptor_);
  if (lock == Lock::unknown || (lock == Lock::taken && is_named(path_, descriptor_))) return;
  throw Error(ErrorCode::io, Where{path_.string()}, "another process is at work on this");
}

void PosixFile::fail(const char* what) const {
  throw Error(ErrorCode::io, Where{path_.string()}, std::string(what) + ": " + std::generic_category().message(errno));
}

}  // namespace pirsim::io
