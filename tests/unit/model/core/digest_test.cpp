#include "model/core/random.hpp"

#include "support/catch.hpp"

using pirsim::Sha256;

TEST_CASE("the hash is that of the examples of FIPS 180 however the bytes are cut", "[core][digest]") {
  const std::string abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
  const std::string two_blocks = "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1";
  const std::string million = "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0";
  const auto hash_in_pieces = [](const std::string& text, std::size_t piece) {
    Sha256 hash;
    for (std::size_t at = 0; at < text.size(); at += piece) {
      hash.add(std::string_view(text).substr(at, piece));
      CHECK(hash.hex().size() == 64);  // to ask in between changes nothing
    }
    return hash.hex();
  };
  for (const std::size_t piece : {1, 2, 7, 64}) {
    CHECK(hash_in_pieces("abc", piece) == abc);
    CHECK(hash_in_pieces("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq", piece) == two_blocks);
  }
  CHECK(hash_in_pieces(std::string(1'000'000, 'a'), 50'000) == million);
  CHECK(pirsim::sha256(abc) == hash_in_pieces(abc, 3));
}
