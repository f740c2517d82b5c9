// Postures by number, and what the sensors saw of them: a choreography repeats its postures, bit for bit.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "body/motion.hpp"

namespace pirsim::sim {

/// A hash table from everything that a posture depends on to numbers 1, 2, 3, ... in the order of remembering.
class PostureIndex {
 public:
  using Number = std::uint32_t;  ///< 0: none
  using Word = std::uint64_t;

  /// Room for so many without allocating, if it is known.
  explicit PostureIndex(std::size_t n_expected = 0);
  /// 0 if the posture isn't known. body: whose measures, as a number or an address. person: counted from 0; what
  /// followed upon their last posture before is looked at first. doors: how they stand, as a number.
  [[nodiscard]] Number find(std::size_t person, std::uint64_t body, const body::Outline& outline,
                            std::uint64_t doors = 0) noexcept;
  /// Remembers what find() was last asked for in vain, for the same person.
  Number remember(std::size_t person);
  /// People are counted up to here.
  void make_room_for(std::size_t n_people);
  /// How many there are: the last number.
  [[nodiscard]] std::size_t size() const noexcept { return successors_.size() - 1; }
  [[nodiscard]] std::uint64_t body(Number number) const noexcept { return keys_[number - 1][n_outline_words]; }
  [[nodiscard]] body::Outline outline(Number number) const noexcept;
  /// Forgets all but the first n.
  void shrink(std::size_t n) noexcept;
  void forget_all() noexcept;  ///< but what find() was last asked for can still be remembered

 private:
  static constexpr std::size_t n_outline_words = sizeof(body::Outline) / sizeof(Word);
  using Key = std::array<Word, n_outline_words + 2>;  ///< then whose body, and the doors
  [[nodiscard]] static std::size_t hash(const Key& key) noexcept;
  /// Where the key is, or would be.
  [[nodiscard]] std::size_t bucket_of(const Key& key) const noexcept;
  void spread() noexcept;  ///< over twice as many buckets
  void follow(std::size_t person, Number number) noexcept;

  std::vector<Number> buckets_;  ///< probed one after the other
  std::vector<Key> keys_;
  std::vector<Number> successors_;  ///< (1 + n) what came after a posture the last time
  std::vector<Number> last_;        ///< (n_people)
  Key wanted_{};
  std::size_t free_bucket_ = 0;  ///< for wanted_
};

/// A row of items for each of a bounded number of postures. When it is full it starts anew. A capacity of 0 remembers
/// nothing.
template <class Item>
class PostureMemory {
 public:
  /// items_per_row: in most rows at most; longer ones take more memory when they come.
  PostureMemory(std::size_t items_per_row, std::size_t capacity) : capacity_(capacity), index_(capacity) {
    rows_.reserve(capacity * items_per_row);
    begins_.reserve(capacity + 1);
    begins_.push_back(0);
  }
  /// None if the posture isn't known; see PostureIndex::find.
  [[nodiscard]] std::optional<std::span<const Item>> find(std::size_t person, const void* humanoid,
                                                          const body::Outline& outline,
                                                          std::uint64_t doors = 0) noexcept {
    const auto body = reinterpret_cast<std::uintptr_t>(humanoid);
    const PostureIndex::Number known = index_.find(person, body, outline, doors);
    if (known == 0) return std::nullopt;
    return std::span(rows_).subspan(begins_[known - 1], begins_[known] - begins_[known - 1]);
  }
  /// Remembers the row under what find() was last asked for in vain, for the same person.
  void remember(std::size_t person, std::span<const Item> row) {
    if (capacity_ == 0) return;
    if (index_.size() == capacity_) {
      index_.forget_all();
      rows_.clear();
      begins_.assign(1, 0);
    }
    (void)index_.remember(person);
    rows_.insert(rows_.end(), row.begin(), row.end());
    begins_.push_back(rows_.size());
  }
  void make_room_for(std::size_t n_people) { index_.make_room_for(n_people); }

 private:
  std::size_t capacity_;
  PostureIndex index_;
  std::vector<Item> rows_;
  std::vector<std::size_t> begins_;  ///< (n_postures + 1) of rows, in rows_
};

/// Study A has some 30,000 different postures; with its 250 bytes each this bounds the memory to 16 MB a thread.
inline constexpr std::size_t most_postures = 65536;

}  // namespace pirsim::sim
