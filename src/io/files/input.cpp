#include "io/files/input.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/digest.hpp"
#include "core/text.hpp"
#include "io/files/posix_file.hpp"
#include "io/files/utf16.hpp"
#include "pirsim/error.hpp"

namespace pirsim::io {
namespace {

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

}  // namespace

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

}  // namespace pirsim::io
