#include "files/disk/file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "model/core/random.hpp"
#include "model/core/text.hpp"
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

void append_utf8(char32_t code, std::string& text) {
  const auto add = [&](char32_t bits) { text += static_cast<char>(static_cast<unsigned char>(bits)); };
  if (code < 0x80) return add(code);
  if (code < 0x800) return add(0xC0U | code >> 6U), add(0x80U | (code & 0x3FU));
  if (code < 0x10000) {
    add(0xE0U | code >> 12U);
  } else {
    add(0xF0U | code >> 18U);
    add(0x80U | (code >> 12U & 0x3FU));
  }
  add(0x80U | (code >> 6U & 0x3FU));
  add(0x80U | (code & 0x3FU));
}

constexpr const char* half_a_pair = "half of a pair of surrogates";

namespace fs = std::filesystem;

/// How `text` ends, as a place in its file: `text` is UTF-8 up to there.
Where end_of(std::string_view text, const std::string& name) {
  const auto line = 1 + std::ranges::count(text, '\n');
  const std::string_view last = text.substr(text.rfind('\n') + 1);  // npos + 1 is 0
  const auto column =
      1 + std::ranges::count_if(last, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
  return {name, static_cast<int>(line), static_cast<int>(column)};
}

std::string from_utf16(std::string_view bytes, Utf16Decoder::ByteOrder order, const std::string& name) {
  Utf16Decoder decoder(order);
  std::string text;
  auto fault = decoder.add(bytes, text);
  if (!fault) fault = decoder.finish();
  if (fault) throw Error(ErrorCode::input, end_of(text, name), "not UTF-16: " + *fault);
  return text;
}

bool has_folder(const fs::path& path) {
  const std::string whole = path.lexically_normal().string();
  std::error_code fault;
  return !whole.starts_with("/dev/") && !whole.starts_with("/proc/") && !fs::is_fifo(path, fault);
}

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

constexpr std::string_view before_digest = " #";

std::string next_digest(const std::string& last, const std::string& text) {
  constexpr std::size_t digits = 16;  // damage is to be told, not forgery
  return sha256(last + text).substr(0, digits);
}

/// With its end of line.
std::string sealed(std::string& last, const std::string& text) {
  last = next_digest(last, text);
  return text + std::string(before_digest) + last + '\n';
}

/// The text of the next line; none if it isn't what was written, or broke off.
std::optional<std::string> next_text(std::istream& lines, std::string& last) {
  std::string line;
  if (!std::getline(lines, line) || lines.eof()) return std::nullopt;
  const std::size_t at = line.rfind(before_digest);
  if (at == std::string::npos) return std::nullopt;
  std::string text = line.substr(0, at);
  std::string digest = next_digest(last, text);
  if (line.compare(at + before_digest.size(), std::string::npos, digest) != 0) return std::nullopt;
  last = std::move(digest);
  return text;
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

std::optional<std::string> Utf16Decoder::add(std::string_view bytes, std::string& text) {
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (!half_) {
      half_ = byte;
      continue;
    }
    const char32_t unit = order_ == ByteOrder::little ? *half_ | byte << 8U : *half_ << 8U | byte;
    half_.reset();
    const bool is_low = unit >= 0xDC00 && unit < 0xE000, is_high = unit >= 0xD800 && unit < 0xDC00;
    if (is_low != (high_ != 0)) return half_a_pair;
    if (is_high) {
      high_ = unit;
    } else {
      append_utf8(is_low ? 0x10000 + ((high_ - 0xD800) << 10U) + (unit - 0xDC00) : unit, text);
      high_ = 0;
    }
  }
  return std::nullopt;
}

std::optional<std::string> Utf16Decoder::finish() const {
  if (half_) return "it ends in half a character";
  if (high_ != 0) return half_a_pair;
  return std::nullopt;
}

InputFile Input::file() const { return {path.string(), sha256(bytes)}; }
std::string Input::text() const { return text_from(bytes, path.string()); }

Input read_input(const fs::path& path, std::size_t max_bytes) {
  const Where where{path.string()};
  std::error_code fault;
  const fs::file_status status = fs::status(path, fault);
  if (status.type() == fs::file_type::not_found) throw Error(ErrorCode::io, where, "no such file");
  if (fs::is_directory(status)) throw Error(ErrorCode::io, where, "is a directory");
  PosixFile file(path, PosixFile::Mode::read);
  Input input{path, {}};
  // In blocks, since most files are small; one byte more than allowed, so that endless devices end too.
  std::array<char, 1U << 13U> block;  // threads may have a small stack
  while (const std::size_t n = file.read(block.data(), block.size())) {
    input.bytes.append(block.data(), n);
    if (input.bytes.size() > max_bytes)
      throw Error(ErrorCode::input, where, "larger than " + std::to_string(max_bytes / 1'000'000) + " MB");
  }
  return input;
}

std::string name_of_input(const fs::path& path) {
  if (path == standard_input) return "stdin";
  const std::string folder = path.parent_path().string();
  const bool is_numbered = folder == "/dev/fd" || (folder.starts_with("/proc/") && folder.ends_with("/fd"));
  return is_numbered ? "pipe" : path.filename().string();
}

std::string stem_of_input(const fs::path& path) { return fs::path(name_of_input(path)).stem().string(); }

fs::path folder_of_input(const fs::path& path) { return has_folder(path) ? path.parent_path() : fs::path(); }

std::string_view name_of_binary(std::string_view bytes) {
  if (bytes.starts_with("PK\x03\x04"))
    return "a workbook or another archive (.xlsx, .ods, .zip): save the table as CSV";
  if (bytes.starts_with("SQLite format 3"))
    return "a database (SQLite): export its table as CSV; of Home Assistant's, `pirsim log FILE` reads the file itself";
  if (bytes.starts_with("%PDF")) return "a PDF";
  if (bytes.starts_with("PAR1")) return "a Parquet file: save the table as CSV";
  return {};
}

std::string text_from(std::string bytes, const std::string& name) {
  const std::string_view whole = bytes;
  if (const std::string_view kind = name_of_binary(whole); !kind.empty())
    throw Error(ErrorCode::input, {name}, "expected a text, got " + std::string(kind));
  if (whole.starts_with(std::string_view("\xFF\xFE\0\0", 4)) || whole.starts_with(std::string_view("\0\0\xFE\xFF", 4)))
    throw Error(ErrorCode::input, {name, 1, 1}, "UTF-32 isn't read: save the file as UTF-8");
  if (whole.starts_with("\xFF\xFE")) {
    bytes = from_utf16(whole.substr(2), Utf16Decoder::ByteOrder::little, name);
  } else if (whole.starts_with("\xFE\xFF")) {
    bytes = from_utf16(whole.substr(2), Utf16Decoder::ByteOrder::big, name);
  } else if (whole.starts_with("\xEF\xBB\xBF")) {
    bytes.erase(0, 3);
  }
  if (const auto bad = first_not_utf8(bytes)) {
    std::array<char, 8> byte{};
    std::snprintf(byte.data(), byte.size(), "0x%02X", static_cast<unsigned>(static_cast<unsigned char>(bytes[*bad])));
    throw Error(ErrorCode::input, end_of(std::string_view(bytes).substr(0, *bad), name),
                std::string("not UTF-8: byte ") + byte.data() + "; save the file as UTF-8");
  }
  if (const std::size_t zero = bytes.find('\0'); zero != std::string::npos) {
    throw Error(ErrorCode::input, end_of(std::string_view(bytes).substr(0, zero), name),
                "a NUL character in a text: is it UTF-16 without a byte order mark? Save the file as UTF-8");
  }
  return bytes;
}

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

std::optional<Journal::Content> Journal::read(const std::filesystem::path& file) {
  std::ifstream lines(file, std::ios::binary);
  std::string last;
  std::optional<std::string> text = next_text(lines, last);
  if (!text) {
    if (!lines || lines.eof()) return std::nullopt;
    throw Error(ErrorCode::input, Where{file.string(), 1, 1},
                "is damaged, or of another version of pirsim: remove it, and what it tells of is made anew");
  }
  Content content{std::move(*text), {}};
  while ((text = next_text(lines, last))) content.pieces.push_back(std::move(*text));
  return content;
}

std::string Journal::text(const Content& content) {
  std::string last, all = sealed(last, content.made_from);
  for (const std::string& piece : content.pieces) all += sealed(last, piece);
  return all;
}

Journal::Journal(std::filesystem::path file) : path_(std::move(file)), file_(path_, PosixFile::Mode::append) {
  file_.lock();
}

void Journal::begin(const std::string& made_from) {
  file_.truncate(0);
  last_digest_.clear();
  add(made_from);
}

void Journal::resume(const Content& found) {
  last_digest_.clear();
  std::size_t bytes = sealed(last_digest_, found.made_from).size();
  for (const std::string& piece : found.pieces) bytes += sealed(last_digest_, piece).size();
  file_.truncate(bytes);
}

void Journal::add(const std::string& piece) { file_.append(sealed(last_digest_, piece)); }

void Journal::remove() {
  std::error_code fault;
  std::filesystem::remove(path_, fault);
  if (fault) throw Error(ErrorCode::io, Where{path_.string()}, "can't be removed: " + fault.message());
}

}  // namespace pirsim::io
