#include "io/atomic_file.hpp"

#include <array>
#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "pirsim/error.hpp"

namespace pirsim::io {

bool is_written_directly(const std::filesystem::path& path) {
  std::error_code fault;
  const std::filesystem::file_status status = std::filesystem::status(path, fault);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

std::filebuf::int_type AtomicFile::Buffer::overflow(int_type c) {
  errno = 0;
  const int_type result = std::filebuf::overflow(c);
  if (traits_type::eq_int_type(result, traits_type::eof()) && fault == 0) fault = errno;
  return result;
}

std::streamsize AtomicFile::Buffer::xsputn(const char* data, std::streamsize size) {
  errno = 0;
  const std::streamsize written = std::filebuf::xsputn(data, size);
  if (written < size && fault == 0) fault = errno;
  return written;
}

int AtomicFile::Buffer::sync() {
  errno = 0;
  const int result = std::filebuf::sync();
  if (result != 0 && fault == 0) fault = errno;
  return result;
}

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)), partial_(path_) {
  if (!is_written_directly(path_)) {
    path_ = resolved(path_);
    partial_ = path_;
    partial_ += ".writing";  // rows that can be resumed stand in .partial
  }
  errno = 0;
  if (buffer_.open(partial_, std::ios::out | std::ios::binary | std::ios::trunc) == nullptr) fail("can't write", errno);
}

AtomicFile::~AtomicFile() {
  if (!buffer_.is_open()) return;
  buffer_.close();
  std::error_code ignored;
  if (partial_ != path_) std::filesystem::remove(partial_, ignored);
}

void AtomicFile::commit() {
  if (!buffer_.is_open()) throw Error(ErrorCode::internal, Where{path_.string()}, "the file was committed before");
  stream_.flush();
  if (!stream_) fail("can't write", buffer_.fault);
  errno = 0;
  if (buffer_.close() == nullptr) fail("can't write", errno);
  if (partial_ == path_) return;
  std::error_code fault;
  std::filesystem::rename(partial_, path_, fault);
  if (fault) fail("can't replace the file", fault.value());
}

void AtomicFile::fail(const char* what, int cause) {
  if (buffer_.is_open()) buffer_.close();
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

std::string read_text_file(const std::filesystem::path& path, std::size_t max_bytes) {
  const Where where{path.string(), 0, 0};
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw Error(ErrorCode::io, where, "is a directory");
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    const bool exists = std::filesystem::exists(path, ignored);
    throw Error(ErrorCode::io, where, exists ? "can't be read" : "no such file");
  }
  // In blocks, since most files are small; one byte more than allowed, so that endless devices end too.
  std::string text;
  std::array<char, 1U << 13U> block;
  while (text.size() <= max_bytes && file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) throw Error(ErrorCode::io, where, "can't be read");
  if (text.size() > max_bytes)
    throw Error(ErrorCode::input, where, "larger than " + std::to_string(max_bytes / 1'000'000) + " MB");
  return text;
}

}  // namespace pirsim::io
