#include "stats/binary.hpp"

#include <bit>
#include <istream>
#include <ostream>

#include "pirsim/error.hpp"

namespace pirsim::stats {
namespace {

static_assert(std::endian::native == std::endian::little, "the byte order of the format is that of the machine");

}  // namespace

BinaryWriter::BinaryWriter(std::ostream& out, std::string_view kind, std::uint32_t version) : out_(out) {
  write(kind);
  write(version);
}

void BinaryWriter::put(const void* bytes, std::size_t count) {
  digest_.add({static_cast<const char*>(bytes), count});
  out_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count));
}

void BinaryWriter::write(std::string_view text) {
  write(static_cast<std::uint64_t>(text.size()));
  put(text.data(), text.size());
}

void BinaryWriter::finish() {
  out_ << digest_.hex();
  if (!out_) throw Error(ErrorCode::io, "can't write a fitted object: the stream failed");
}

BinaryReader::BinaryReader(std::istream& in, std::string_view kind, std::uint32_t version) : in_(in), kind_(kind) {
  const auto length = read<std::uint64_t>();
  std::string found(length == kind.size() ? kind.size() : 0, '\0');
  get(found.data(), found.size());
  if (found != kind) fail("was expected, but the stream holds something else");
  const auto found_version = read<std::uint32_t>();
  if (found_version != version)
    fail("has version " + std::to_string(found_version) + ", this build reads version " + std::to_string(version));
}

void BinaryReader::get(void* bytes, std::size_t count) {
  in_.read(static_cast<char*>(bytes), static_cast<std::streamsize>(count));
  if (static_cast<std::size_t>(in_.gcount()) != count) fail("ends too early");
  digest_.add({static_cast<const char*>(bytes), count});
}

std::string BinaryReader::read_text() {
  std::vector<char> text;
  get_many(text, read<std::uint64_t>());
  return {text.begin(), text.end()};
}

void BinaryReader::finish() {
  const std::string expected = digest_.hex();
  std::string found(expected.size(), '\0');
  get(found.data(), found.size());
  if (found != expected) fail("is damaged: its digest differs");
}

void BinaryReader::fail(const std::string& what) const { throw Error(ErrorCode::input, kind_ + " " + what); }

}  // namespace pirsim::stats
