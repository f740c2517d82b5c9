#include "pirsim/random.hpp"

#include <array>
#include <cmath>

#include "model/core/random.hpp"
#include "support/catch.hpp"

using pirsim::Purpose;
using pirsim::Sha256;
using pirsim::Stream;

TEST_CASE("a stream with key zero gives Philox's published words for counter zero") {
  // Random123's known-answer file kat_vectors: philox4x32 10, counter 0, key 0.
  // Purpose 0 makes the whole counter zero.
  Stream stream({0, 0, 0, Purpose{0}});
  CHECK(stream.next_u32() == 0x6627e8d5U);
  CHECK(stream.next_u32() == 0xe169c58dU);
  CHECK(stream.next_u32() == 0xbc57ac4cU);
  CHECK(stream.next_u32() == 0x9b00dbd8U);
}

TEST_CASE("streams that differ in one part of the key are uncorrelated, a stream with itself is not") {
  const auto correlation = [](Stream a, Stream b) {
    constexpr int n = 20000;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) sum += (a.uniform() - 0.5) * (b.uniform() - 0.5);
    return sum / n * 12.0;
  };
  // The standard error of the correlation of 20,000 independent pairs is 1 / sqrt(20000) = 0.0071; four of them.
  const double bound = 4.0 / std::sqrt(20000.0);
  const pirsim::StreamKey base{1, 2, 3, Purpose::test};
  CHECK(std::abs(correlation(Stream(base), Stream({2, 2, 3, Purpose::test}))) < bound);
  CHECK(std::abs(correlation(Stream(base), Stream({1, 3, 3, Purpose::test}))) < bound);
  CHECK(std::abs(correlation(Stream(base), Stream({1, 2, 4, Purpose::test}))) < bound);
  CHECK(std::abs(correlation(Stream(base), Stream({1, 2, 3, Purpose::spine_tilt}))) < bound);
  CHECK(std::abs(correlation(Stream(base), Stream(base))) > bound);
}

TEST_CASE("normal() has mean 0 and variance 1, uniform() shifted to mean 0 does not") {
  constexpr int n = 40000;
  const auto moments = [](auto draw) {
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < n; ++i) {
      const double x = draw();
      sum += x;
      squares += x * x;
    }
    return std::array<double, 2>{sum / n, squares / n};
  };
  Stream stream({7, 0, 0, Purpose::test});
  const auto normal = moments([&] { return stream.normal(); });
  const auto uniform = moments([&] { return stream.uniform() - 0.5; });
  const double mean_error = 1.0 / std::sqrt(n);      // standard error of the mean
  const double variance_error = std::sqrt(2.0 / n);  // standard error of the variance of a normal
  CHECK(std::abs(normal[0]) < 4 * mean_error);
  CHECK(std::abs(normal[1] - 1.0) < 4 * variance_error);
  CHECK(std::abs(uniform[1] - 1.0) > 4 * variance_error);
}

TEST_CASE("index(3) gives each value a third of the time") {
  Stream stream({9, 0, 0, Purpose::test});
  constexpr int n = 30000;
  std::array<int, 3> counts{};
  for (int i = 0; i < n; ++i) ++counts.at(stream.index(3));
  const double standard_error = std::sqrt(n * (1.0 / 3) * (2.0 / 3));
  for (const int count : counts) CHECK(std::abs(count - n / 3.0) < 4 * standard_error);
}

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
