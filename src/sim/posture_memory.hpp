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

  explicit PostureMemory(std::size_t words_per_row);
  /// The row of everything a posture depends on; humanoid: whose measures. Empty if the posture isn't known. person:
  /// counted from 0; what followed upon their last posture before is looked at first.
  [[nodiscard]] std::span<const Word> find(std::size_t person, const void* humanoid,
                                           const body::Outline& outline) noexcept;
  /// Remembers the row under what find() was last asked for in vain, for the same person.
  void remember(std::size_t person, std::span<const Word> row) noexcept;
  /// People are counted up to here.
  void make_room_for(std::size_t n_people);

 private:
  using Key = std::array<Word, sizeof(body::Outline) / sizeof(Word) + 1>;
  using Number = std::uint32_t;  ///< 1 + index of an entry, or 0
  [[nodiscard]] static std::size_t hash(const Key& key) noexcept;
  [[nodiscard]] bool is_wanted(Number entry) const noexcept;
  [[nodiscard]] std::span<const Word> row(Number entry) const noexcept;
  void spread() noexcept;  ///< over twice as many buckets
  void follow(std::size_t person, Number entry) noexcept;

  std::size_t words_per_row_, words_per_entry_;
  std::vector<Number> buckets_;     ///< probed one after the other
  std::vector<Word> entries_;       ///< (n_entries x words_per_entry): key, then row
  std::vector<Number> successors_;  ///< (1 + n_entries) what came after an entry the last time
  std::vector<Number> last_;        ///< (n_people)
  Key wanted_{};
  std::size_t free_bucket_ = 0;  ///< for wanted_
};

}  // namespace pirsim::sim
