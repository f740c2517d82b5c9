#include "sim/posture_memory.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace pirsim::sim {
namespace {

// Powers of two. Few at first, so that what a single run looks up stays in the cache.
constexpr std::size_t fewest_buckets = 4096;
constexpr std::size_t most_buckets = 2 * PostureMemory::most_entries;

}  // namespace

PostureMemory::PostureMemory(std::size_t words_per_row)
    : words_per_row_(words_per_row), words_per_entry_(Key{}.size() + words_per_row) {
  // Address space only, until it is used: nothing is allocated while a study runs.
  buckets_.reserve(most_buckets);
  buckets_.resize(fewest_buckets, 0);
  entries_.reserve(most_entries * words_per_entry_);
  successors_.reserve(most_entries + 1);
  successors_.push_back(0);
}

void PostureMemory::make_room_for(std::size_t n_people) {
  if (last_.size() < n_people) last_.resize(n_people, 0);
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

bool PostureMemory::is_wanted(Number entry) const noexcept {
  return std::memcmp(&entries_[(entry - 1) * words_per_entry_], &wanted_, sizeof wanted_) == 0;
}

std::span<const PostureMemory::Word> PostureMemory::row(Number entry) const noexcept {
  return {&entries_[(entry - 1) * words_per_entry_ + wanted_.size()], words_per_row_};
}

void PostureMemory::follow(std::size_t person, Number entry) noexcept {
  successors_[last_[person]] = entry;
  last_[person] = entry;
}

std::span<const PostureMemory::Word> PostureMemory::find(std::size_t person, const void* humanoid,
                                                         const body::Outline& outline) noexcept {
  static_assert(sizeof(body::Outline) % sizeof(Word) == 0);
  std::memcpy(wanted_.data(), &outline, sizeof outline);
  wanted_.back() = std::bit_cast<std::uintptr_t>(humanoid);
  // As a rule what came last time comes again; it lies just behind in memory.
  if (const Number next = successors_[last_[person]]; next != 0 && is_wanted(next)) {
    last_[person] = next;
    return row(next);
  }
  std::size_t bucket = hash(wanted_) % buckets_.size();
  for (; buckets_[bucket] != 0; bucket = (bucket + 1) % buckets_.size()) {
    if (!is_wanted(buckets_[bucket])) continue;
    follow(person, buckets_[bucket]);
    return row(buckets_[bucket]);
  }
  free_bucket_ = bucket;
  return {};
}

void PostureMemory::spread() noexcept {
  buckets_.assign(2 * buckets_.size(), 0);
  const auto free_bucket = [&](const Key& key) {
    std::size_t bucket = hash(key) % buckets_.size();
    while (buckets_[bucket] != 0) bucket = (bucket + 1) % buckets_.size();
    return bucket;
  };
  for (Number entry = 1; entry < successors_.size(); ++entry) {
    Key key;
    std::copy_n(&entries_[(entry - 1) * words_per_entry_], key.size(), key.begin());
    buckets_[free_bucket(key)] = entry;
  }
  free_bucket_ = free_bucket(wanted_);
}

void PostureMemory::remember(std::size_t person, std::span<const Word> row) noexcept {
  if (successors_.size() > most_entries) {
    buckets_.assign(fewest_buckets, 0);
    std::ranges::fill(last_, 0U);
    entries_.clear();
    successors_.assign(1, 0);
    free_bucket_ = hash(wanted_) % buckets_.size();
  } else if (2 * successors_.size() > buckets_.size()) {
    spread();
  }
  entries_.insert(entries_.end(), wanted_.begin(), wanted_.end());
  entries_.insert(entries_.end(), row.begin(), row.end());
  buckets_[free_bucket_] = static_cast<Number>(successors_.size());
  successors_.push_back(0);
  follow(person, buckets_[free_bucket_]);
}

}  // namespace pirsim::sim
