#include "files/disk/compression.hpp"

#include <fstream>
#include <sstream>

#include "pirsim/error.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;

namespace {

std::string compressed(const std::string& text, io::Compression how, std::size_t piece) {
  std::ostringstream out;
  io::DataWriter writer(out, how);
  for (std::size_t at = 0; at < text.size(); at += piece) writer.write(std::string_view(text).substr(at, piece));
  writer.finish();
  return out.str();
}

std::string read_all(const std::filesystem::path& file, std::size_t piece) {
  io::DataReader reader(file);
  std::string text, buffer(piece, '\0');
  while (const std::size_t n = reader.read(buffer.data(), buffer.size())) text.append(buffer, 0, n);
  return text;
}

std::string many_rows() {
  std::string text;
  for (int i = 0; i < 40000; ++i) text += std::to_string(i * 7919 % 10007) + ",walking,0,1\n";
  return text;
}

const std::vector<std::pair<std::string, io::Compression>> kinds{{"rows.csv", io::Compression::none},
                                                                 {"rows.csv.gz", io::Compression::gzip},
                                                                 {"rows.csv.zst", io::Compression::zstd}};

}  // namespace

TEST_CASE("what is compressed in pieces of any size is read back in pieces of any size", "[io][compression]") {
  const TemporaryFolder folder;
  const std::string text = many_rows();
  for (const auto& [name, kind] : kinds) {
    CHECK(io::compression_of(name) == kind);
    CHECK(io::without_compression(name) == "rows.csv");
    const std::string whole = compressed(text, kind, text.size());
    if (kind != io::Compression::none) CHECK(whole.size() < text.size() / 3);
    for (const std::size_t piece : {13U, 4096U, 1U << 20U}) {
      CHECK(compressed(text, kind, piece) == whole);  // so that the same rows give the same file
      CHECK((read_all(folder.write(name, whole), piece) == text));
    }
    CHECK(read_all(folder.write(name, compressed("", kind, 1)), 100).empty());
  }
}

TEST_CASE("files of several members are read to their end", "[io][compression]") {
  const TemporaryFolder folder;
  for (const auto& [name, kind] : kinds) {
    const std::string both = compressed("one\n", kind, 4) + compressed("two\n", kind, 4);
    CHECK(read_all(folder.write(name, both), 3) == "one\ntwo\n");
  }
}

TEST_CASE("a compressed file that is cut short or altered anywhere is refused or reads the same", "[io][compression]") {
  const TemporaryFolder folder;
  const std::string text = many_rows().substr(0, 5000);
  for (const auto& [name, kind] : kinds) {
    if (kind == io::Compression::none) continue;
    const std::string whole = compressed(text, kind, text.size());
    for (std::size_t length = 1; length < whole.size(); length += 11) {
      INFO(name << " of " << length << " bytes");
      CHECK_THROWS_AS(read_all(folder.write(name, whole.substr(0, length)), 512), Error);
    }
    std::size_t refused = 0;
    for (std::size_t at = 0; at < whole.size(); ++at) {
      std::string altered = whole;
      altered[at] = static_cast<char>(altered[at] ^ 0x10);
      std::string told;
      try {
        told = read_all(folder.write(name, altered), 512);
      } catch (const Error& error) {
        CHECK(error.code() == ErrorCode::input);
        ++refused;
        continue;
      }
      CHECK((told == text));  // a byte of gzip's header that tells nothing
    }
    CHECK(refused >= whole.size() - 10);
  }
}
