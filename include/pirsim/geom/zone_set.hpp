// Which zones are active, one bit a zone.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pirsim {

/// A set of zones (or of other things counted from 0) as bits in 64-bit words. The unused bits of the last word are 0.
class ZoneSet {
 public:
  using Word = std::uint64_t;
  static constexpr std::size_t bits_per_word = 64;

  ZoneSet() = default;
  explicit ZoneSet(std::size_t n) : n_(n), words_((n + bits_per_word - 1) / bits_per_word, 0) {}

  [[nodiscard]] std::size_t size() const noexcept { return n_; }
  [[nodiscard]] bool test(std::size_t i) const noexcept {
    return ((words_[i / bits_per_word] >> (i % bits_per_word)) & 1U) != 0;
  }
  void insert(std::size_t i) noexcept { words_[i / bits_per_word] |= Word{1} << (i % bits_per_word); }
  void clear() noexcept { std::ranges::fill(words_, Word{0}); }
  /// Adds the members of a set of the same size, given as words.
  void add(std::span<const Word> words) noexcept {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= words[i];
  }
  [[nodiscard]] std::span<const Word> words() const noexcept { return words_; }
  [[nodiscard]] std::span<Word> words() noexcept { return words_; }
  bool operator==(const ZoneSet&) const = default;

 private:
  std::size_t n_ = 0;
  std::vector<Word> words_;
};

}  // namespace pirsim
