// Remembers what the sensors saw of postures: a choreography repeats them, bit for bit.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pirsim/body/motion.hpp"
#include "pirsim/geom/zone_set.hpp"

namespace pirsim::sim {

/// A hash table of bounded size from a person's outline to a row of words. When it is full it starts anew.
class PostureMemory {
 public:
  using Word = ZoneSet::Word;
  /// Study A has some 30,000 different postures; with its 250 bytes each this bounds the memory to 16 MB a thread.
  static constexpr std::size_t most_entries = 65536;

  explicit PostureMemory(std::size_t words_per_entry);
  /// Everything a posture depends on; person: which measures. Empty if the posture isn't known.
  [[nodiscard]] std::span<const Word> find(const void* person, const body::Outline& outline) noexcept;
  /// Remembers the row under what find() was last asked for in vain; valid until the next call.
  void remember(std::span<const Word> row) noexcept;

 private:
  using Key = std::array<Word, sizeof(body::Outline) / sizeof(Word) + 1>;
  [[nodiscard]] static std::size_t hash(const Key& key) noexcept;

  std::size_t words_per_entry_;
  std::vector<std::uint32_t> buckets_;  ///< 1 + index of an entry, or 0; probed one after the other
  std::vector<Key> keys_;               ///< (n_entries)
  std::vector<Word> rows_;              ///< (n_entries x words_per_entry)
  Key wanted_{};
  std::size_t free_bucket_ = 0;  ///< for wanted_
};

}  // namespace pirsim::sim
