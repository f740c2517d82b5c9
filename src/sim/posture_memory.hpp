// Remembers what the sensors saw of postures.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pirsim/rays.hpp"
#include "sim/posture_index.hpp"

namespace pirsim::sim {

/// A row of words for each of a bounded number of postures. When it is full it starts anew.
class PostureMemory {
 public:
  using Word = ZoneSet::Word;
  /// Study A has some 30,000 different postures; with its 250 bytes each this bounds the memory to 16 MB a thread.
  static constexpr std::size_t most_entries = 65536;

  explicit PostureMemory(std::size_t words_per_row) : words_per_row_(words_per_row), index_(most_entries) {
    rows_.reserve(most_entries * words_per_row);
  }
  /// Empty if the posture isn't known; see PostureIndex::find.
  [[nodiscard]] std::span<const Word> find(std::size_t person, const void* humanoid,
                                           const body::Outline& outline) noexcept {
    const PostureIndex::Number known = index_.find(person, reinterpret_cast<std::uintptr_t>(humanoid), outline);
    if (known == 0) return {};
    return {&rows_[(known - 1) * words_per_row_], words_per_row_};
  }
  /// Remembers the row under what find() was last asked for in vain, for the same person.
  void remember(std::size_t person, std::span<const Word> row) {
    if (index_.size() == most_entries) {
      index_.forget_all();
      rows_.clear();
    }
    (void)index_.remember(person);
    rows_.insert(rows_.end(), row.begin(), row.end());
  }
  void make_room_for(std::size_t n_people) { index_.make_room_for(n_people); }

 private:
  std::size_t words_per_row_;
  PostureIndex index_;
  std::vector<Word> rows_;  ///< (n_postures x words_per_row)
};

}  // namespace pirsim::sim
