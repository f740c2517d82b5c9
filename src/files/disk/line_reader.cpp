#include "files/disk/line_reader.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "files/disk/file.hpp"
#include "model/core/text.hpp"

namespace pirsim::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t piece = 1U << 16U;

fs::path readable(fs::path path) {
  std::error_code fault;
  const fs::file_status status = fs::status(path, fault);
  if (status.type() == fs::file_type::not_found) throw Error(ErrorCode::io, Where{path.string()}, "no such file");
  if (fs::is_directory(status)) throw Error(ErrorCode::io, Where{path.string()}, "is a directory");
  return path;
}

bool is_plain(std::string_view line) {
  return std::ranges::all_of(line, [](char c) { return c != '\0' && static_cast<unsigned char>(c) < 0x80U; });
}

}  // namespace

LineReader::LineReader(fs::path path) : path_(readable(std::move(path))), opened_(path_, PosixFile::Mode::read) {
  begin();
}

std::size_t LineReader::read_raw(char* to, std::size_t size) {
  if (!head_.empty()) {
    const std::size_t n = head_.copy(to, size);
    head_.erase(0, n);
    return n;
  }
  const std::size_t n = opened_.read(to, size);
  hash_.add({to, n});
  return n;
}

void LineReader::begin() {
  constexpr std::size_t enough = 16;
  std::array<char, enough> bytes{};
  while (head_.size() < enough) {
    const std::size_t n = opened_.read(bytes.data(), enough - head_.size());
    if (n == 0) break;
    hash_.add({bytes.data(), n});
    head_.append(bytes.data(), n);
  }
  if (const std::string_view kind = name_of_binary(head_); !kind.empty())
    throw Error(ErrorCode::input, Where{path_.string()}, "expected a text, got " + std::string(kind));
  const Compression compression = head_.starts_with("\x1F\x8B")           ? Compression::gzip
                                  : head_.starts_with("\x28\xB5\x2F\xFD") ? Compression::zstd
                                                                          : Compression::none;
  data_.emplace(path_, compression, [this](char* to, std::size_t size) { return read_raw(to, size); });
  while (text_.size() < 4 && fill()) {
  }
  const auto begins = [&](std::string_view mark) { return text_.starts_with(mark); };
  if (begins(std::string_view("\xFF\xFE\0\0", 4)) || begins(std::string_view("\0\0\xFE\xFF", 4))) {
    line_ = 1;
    refuse("UTF-32 isn't read: save the file as UTF-8");
  }
  // Without a mark every second byte of UTF-16 is zero, if the text begins with ASCII.
  const bool has_mark = begins("\xFF\xFE") || begins("\xFE\xFF");
  const auto is_zero = [&](std::size_t at) { return at < text_.size() && text_[at] == '\0'; };
  const bool is_little = begins("\xFF\xFE") || (!is_zero(0) && is_zero(1) && !is_zero(2) && is_zero(3));
  const bool is_big = begins("\xFE\xFF") || (is_zero(0) && !is_zero(1) && is_zero(2) && !is_zero(3));
  if (is_little || is_big) {
    utf16_.emplace(is_little ? Utf16Decoder::ByteOrder::little : Utf16Decoder::ByteOrder::big);
    const std::string came = std::exchange(text_, {}).substr(has_mark ? 2 : 0);
    if (const auto fault = utf16_->add(came, text_)) refuse("not UTF-16: " + *fault);
  } else if (begins("\xEF\xBB\xBF")) {
    text_.erase(0, 3);
  }
}

bool LineReader::fill() {
  if (ended_) return false;
  text_.erase(0, std::exchange(at_, 0));
  std::array<char, piece> bytes;
  const std::size_t n = data_->read(bytes.data(), bytes.size());
  ended_ = n == 0;
  std::optional<std::string> fault;
  if (!utf16_) {
    text_.append(bytes.data(), n);
  } else {
    fault = ended_ ? utf16_->finish() : utf16_->add({bytes.data(), n}, text_);
  }
  if (fault) {
    line_ += static_cast<int>(1 + std::ranges::count(text_, '\n'));
    refuse("not UTF-16: " + *fault);
  }
  return !ended_;
}

std::string LineReader::rest(std::size_t longest) {
  std::string all;
  while (const auto line = next(longest)) {
    all.append(*line) += '\n';
    if (all.size() > longest) refuse("more than " + std::to_string(longest / 1'000'000) + " MB of JSON in one piece");
  }
  return all;
}

std::optional<std::string_view> LineReader::next(std::size_t longest) {
  std::size_t searched = at_;
  std::size_t end = text_.find('\n', searched);
  while (end == std::string::npos) {
    searched = text_.size() - at_;  // from the line's begin, which fill() moves to the front
    if (searched > longest) break;
    if (!fill()) break;
    end = text_.find('\n', searched);
  }
  ++line_;
  const std::size_t stop = std::min(end, text_.size());
  if (stop - at_ > longest) refuse("a line longer than " + std::to_string(longest / 1'000'000) + " MB");
  if (end == std::string::npos && at_ == text_.size()) return std::nullopt;
  std::string_view line = std::string_view(text_).substr(at_, stop - at_);
  at_ = std::min(stop + 1, text_.size());
  if (line.ends_with('\r')) line.remove_suffix(1);
  return checked(line);
}

std::string_view LineReader::checked(std::string_view line) {
  if (is_plain(line)) return line;
  const auto column_at = [&](std::size_t byte) {
    return 1 + static_cast<int>(std::ranges::count_if(
                   line.substr(0, byte), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
  };
  if (const auto bad = first_not_utf8(line)) {
    std::array<char, 8> byte{};
    std::snprintf(byte.data(), byte.size(), "0x%02X", static_cast<unsigned>(static_cast<unsigned char>(line[*bad])));
    refuse(std::string("not UTF-8: byte ") + byte.data() + "; is it a text? Save it as UTF-8", column_at(*bad));
  }
  if (const std::size_t zero = line.find('\0'); zero != std::string_view::npos) {
    refuse("a NUL character in a text: is it UTF-16 without a byte order mark? Save the file as UTF-8",
           column_at(zero));
  }
  return line;
}

void LineReader::refuse(const std::string& why, int column) const { throw Error(ErrorCode::input, where(column), why); }

}  // namespace pirsim::io
