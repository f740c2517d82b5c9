#include "reconcile/ensemble/reference_table.hpp"

#include <sstream>

#include "pirsim/error.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

std::string sample() {
  std::stringstream out;
  BinaryWriter writer(out, "table", 3);
  writer.write(7);
  writer.write(std::vector<double>{0.25, -1.0});
  writer.write(std::string_view("soft"));
  writer.finish();
  return out.str();
}

struct Contents {
  int number = 0;
  std::vector<double> list;
  std::string text;
};

Contents read_all(const std::string& bytes, std::string_view kind = "table", std::uint32_t version = 3) {
  std::istringstream in(bytes);
  BinaryReader reader(in, kind, version);
  Contents contents;
  contents.number = reader.read<int>();
  contents.list = reader.read_vector<double>();
  contents.text = reader.read_text();
  reader.finish();
  return contents;
}

}  // namespace

TEST_CASE("numbers, lists and texts come back from their bytes", "[reconcile]") {
  const Contents contents = read_all(sample());
  CHECK(contents.number == 7);
  CHECK(contents.list == std::vector<double>{0.25, -1.0});
  CHECK(contents.text == "soft");
}

TEST_CASE("bytes of another kind or version, cut off or damaged are refused", "[reconcile]") {
  CHECK_THROWS_WITH(read_all(sample(), "forest"), contains("forest was expected"));
  CHECK_THROWS_WITH(read_all(sample(), "table", 4), contains("has version 3"));
  CHECK_THROWS_WITH(read_all(sample().substr(0, 40)), contains("ends too early"));
  CHECK_THROWS_WITH(read_all(""), contains("ends too early"));
  std::string last_bit = sample();
  last_bit.back() = static_cast<char>(last_bit.back() ^ 1);
  CHECK_THROWS_WITH(read_all(last_bit), contains("digest"));
}

TEST_CASE("any single damaged byte is noticed", "[reconcile]") {
  const std::string bytes = sample();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    CHECK_THROWS_AS(read_all(damaged), Error);
  }
}
