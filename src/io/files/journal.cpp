#include "io/files/journal.hpp"

#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/digest.hpp"
#include "pirsim/error.hpp"

namespace pirsim::io {
namespace {

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
