#include "io/files/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "io/files/posix_file.hpp"
#include "pirsim/error.hpp"

namespace pirsim::io {
namespace {

constexpr int most_names = 1000;  // of files that processes with this number left behind
constexpr const char* writing = ".writing-";

/// Of a writer of this path that was killed: nobody holds a lock on it.
void remove_left_behind(const std::filesystem::path& path) {
  const std::string begin = path.filename().string() + writing;
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code fault;
  for (std::filesystem::directory_iterator entry(folder, fault), end; !fault && entry != end; entry.increment(fault)) {
    if (!entry->path().filename().string().starts_with(begin)) continue;
    const int descriptor = ::open(entry->path().c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) continue;
    if (try_lock(descriptor) == Lock::taken && is_named(entry->path(), descriptor)) ::unlink(entry->path().c_str());
    ::close(descriptor);
  }
}

/// False if it was taken for one that was left behind.
bool is_mine(const std::filesystem::path& path, int descriptor) {
  return try_lock(descriptor) != Lock::of_another && is_named(path, descriptor);
}

}  // namespace

bool is_written_directly(const std::filesystem::path& path) {
  std::error_code fault;
  const std::filesystem::file_status status = std::filesystem::status(path, fault);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

AtomicFile::Buffer::Buffer(int descriptor) : descriptor_(descriptor), waiting_(1U << 16U) {
  setp(waiting_.data(), waiting_.data() + waiting_.size());
}
AtomicFile::Buffer::~Buffer() { close(); }

void AtomicFile::Buffer::close() {
  if (is_open() && ::close(std::exchange(descriptor_, -1)) < 0 && fault == 0) fault = errno;
}

bool AtomicFile::Buffer::put(const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t n = ::write(descriptor_, data, size);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      if (fault == 0) fault = errno;
      return false;
    }
    data += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

int AtomicFile::Buffer::sync() {
  const bool is_written = put(pbase(), static_cast<std::size_t>(pptr() - pbase()));
  setp(waiting_.data(), waiting_.data() + waiting_.size());
  return is_written ? 0 : -1;
}

AtomicFile::Buffer::int_type AtomicFile::Buffer::overflow(int_type c) {
  if (sync() != 0) return traits_type::eof();
  if (!traits_type::eq_int_type(c, traits_type::eof())) sputc(traits_type::to_char_type(c));
  return traits_type::not_eof(c);
}

std::streamsize AtomicFile::Buffer::xsputn(const char* data, std::streamsize size) {
  if (size > epptr() - pptr() && sync() != 0) return 0;
  if (size > epptr() - pptr()) return put(data, static_cast<std::size_t>(size)) ? size : 0;
  std::copy_n(data, size, pptr());
  pbump(static_cast<int>(size));  // less than the buffer has
  return size;
}

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)), buffer_(open()) {}

int AtomicFile::open() {
  constexpr int written = O_WRONLY | O_CLOEXEC;
  constexpr mode_t anybody = 0666;  // that the umask allows
  int descriptor = -1;
  if (is_written_directly(path_)) {
    partial_ = path_;
    do {
      descriptor = ::open(path_.c_str(), written | O_TRUNC);
    } while (descriptor < 0 && errno == EINTR);
  } else {
    path_ = resolved(path_);
    remove_left_behind(path_);
    // Exclusively: what stands there under such a name, or where a link leads that does, isn't ours.
    errno = EEXIST;
    for (int i = 0; descriptor < 0 && errno == EEXIST && i < most_names; ++i) {
      partial_ = path_;
      partial_ += writing + std::to_string(::getpid()) + '-' + std::to_string(i);
      descriptor = ::open(partial_.c_str(), written | O_CREAT | O_EXCL, anybody);
      if (descriptor < 0 || is_mine(partial_, descriptor)) continue;
      ::close(std::exchange(descriptor, -1));
      errno = EEXIST;
    }
    if (descriptor >= 0) lock_ = ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
  }
  if (descriptor >= 0) return descriptor;
  partial_ = path_;  // nothing is to be removed
  throw Error(ErrorCode::io, Where{path_.string()}, "can't write: " + std::generic_category().message(errno));
}

AtomicFile::~AtomicFile() {
  if (buffer_.is_open()) {
    buffer_.close();
    std::error_code ignored;
    if (partial_ != path_) std::filesystem::remove(partial_, ignored);
  }
  if (lock_ >= 0) ::close(lock_);
}

void AtomicFile::close() {
  if (!buffer_.is_open()) throw Error(ErrorCode::internal, Where{path_.string()}, "the file was committed before");
  stream_.flush();
  if (!stream_) fail("can't write", buffer_.fault);
  buffer_.close();
  if (buffer_.fault != 0) fail("can't write", buffer_.fault);
}

void AtomicFile::commit() {
  close();
  if (partial_ == path_) return;
  std::error_code fault;
  std::filesystem::rename(partial_, path_, fault);
  if (fault) fail("can't replace the file", fault.value());
}

bool AtomicFile::commit_if_new() {
  close();
  if (partial_ == path_) return true;
  std::error_code fault, ignored;
  std::filesystem::create_hard_link(partial_, path_, fault);  // fails if it is there, which to rename doesn't
  if (fault && fault != std::errc::file_exists) {             // a file system without links
    if (!std::filesystem::exists(path_, ignored)) std::filesystem::rename(partial_, path_, fault);
    if (fault && !std::filesystem::exists(path_, ignored)) fail("can't be put in its place", fault.value());
  }
  std::filesystem::remove(partial_, ignored);
  return !fault;
}

void AtomicFile::fail(const char* what, int cause) {
  buffer_.close();
  std::error_code ignored;
  if (partial_ != path_) std::filesystem::remove(partial_, ignored);
  std::string message = what;
  if (cause != 0) message += ": " + std::generic_category().message(cause);
  throw Error(ErrorCode::io, Where{path_.string()}, message);
}

void write_text_file(const std::filesystem::path& path, std::string_view text) {
  AtomicFile file(path);
  file.stream() << text;
  file.commit();
}

bool write_once(const std::filesystem::path& path, std::string_view text) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    AtomicFile file(path);
    file.stream() << text;
    if (file.commit_if_new()) return true;
  }
  return read_text_file(path) == text;
}

std::string read_text_file(const std::filesystem::path& path, std::size_t max_bytes) {
  return read_input(path, max_bytes).bytes;
}

}  // namespace pirsim::io
