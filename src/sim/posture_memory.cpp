#include "sim/posture_memory.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace pirsim::sim {
namespace {

constexpr std::size_t n_buckets = 2 * PostureMemory::most_entries;  // a power of two

}  // namespace

PostureMemory::PostureMemory(std::size_t words_per_entry) : words_per_entry_(words_per_entry), buckets_(n_buckets, 0) {
  // Address space only, until it is used: nothing is allocated while a study runs.
  keys_.reserve(most_entries);
  rows_.reserve(most_entries * words_per_entry);
}

std::size_t PostureMemory::hash(const Key& key) noexcept {
  // Four multiplicative hashes side by side, since each step waits for its multiplication.
  constexpr Word factor = 0x9E3779B97F4A7C15U;
  std::array<Word, 4> lanes{1, 2, 3, 4};
  for (std::size_t i = 0; i < key.size(); ++i) {
    Word& lane = lanes[i % lanes.size()];
    lane = (lane ^ key[i]) * factor;
    lane ^= lane >> 32U;
  }
  Word all = 0;
  for (const Word lane : lanes) {
    all = (std::rotl(all, 23) ^ lane) * factor;
    all ^= all >> 32U;
  }
  return static_cast<std::size_t>(all);
}

std::span<const PostureMemory::Word> PostureMemory::find(const void* person, const body::Outline& outline) noexcept {
  static_assert(sizeof(body::Outline) % sizeof(Word) == 0);
  std::memcpy(wanted_.data(), &outline, sizeof outline);
  wanted_.back() = std::bit_cast<std::uintptr_t>(person);
  std::size_t bucket = hash(wanted_) % n_buckets;
  for (; buckets_[bucket] != 0; bucket = (bucket + 1) % n_buckets) {
    const std::size_t entry = buckets_[bucket] - 1;
    if (std::memcmp(&keys_[entry], &wanted_, sizeof wanted_) == 0) {
      return {&rows_[entry * words_per_entry_], words_per_entry_};
    }
  }
  free_bucket_ = bucket;
  return {};
}

void PostureMemory::remember(std::span<const Word> row) noexcept {
  if (keys_.size() == most_entries) {
    std::ranges::fill(buckets_, 0U);
    keys_.clear();
    rows_.clear();
    free_bucket_ = hash(wanted_) % n_buckets;
  }
  keys_.push_back(wanted_);
  rows_.insert(rows_.end(), row.begin(), row.end());
  buckets_[free_bucket_] = static_cast<std::uint32_t>(keys_.size());
}

}  // namespace pirsim::sim
