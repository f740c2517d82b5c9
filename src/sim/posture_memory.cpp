#include "sim/posture_memory.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace pirsim::sim {
namespace {

// A power of two. Few at first, so that what a single run looks up stays in the cache.
constexpr std::size_t fewest_buckets = 4096;

}  // namespace

PostureIndex::PostureIndex(std::size_t n_expected) {
  // Address space only, until it is used: nothing is allocated while a study runs.
  buckets_.reserve(2 * n_expected);
  buckets_.resize(fewest_buckets, 0);
  keys_.reserve(n_expected);
  successors_.reserve(n_expected + 1);
  successors_.push_back(0);
}

void PostureIndex::make_room_for(std::size_t n_people) {
  if (last_.size() < n_people) last_.resize(n_people, 0);
}

std::size_t PostureIndex::hash(const Key& key) noexcept {
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

std::size_t PostureIndex::bucket_of(const Key& key) const noexcept {
  std::size_t bucket = hash(key) % buckets_.size();
  while (buckets_[bucket] != 0 && keys_[buckets_[bucket] - 1] != key) bucket = (bucket + 1) % buckets_.size();
  return bucket;
}

void PostureIndex::follow(std::size_t person, Number number) noexcept {
  successors_[last_[person]] = number;
  last_[person] = number;
}

PostureIndex::Number PostureIndex::find(std::size_t person, std::uint64_t body, const body::Outline& outline,
                                        std::uint64_t doors) noexcept {
  static_assert(sizeof(body::Outline) % sizeof(Word) == 0);
  std::memcpy(wanted_.data(), &outline, sizeof outline);
  wanted_[n_outline_words] = body;
  wanted_.back() = doors;
  // As a rule what came last time comes again; it lies just behind in memory.
  if (const Number next = successors_[last_[person]]; next != 0 && keys_[next - 1] == wanted_) {
    last_[person] = next;
    return next;
  }
  free_bucket_ = bucket_of(wanted_);
  const Number known = buckets_[free_bucket_];
  if (known != 0) follow(person, known);
  return known;
}

void PostureIndex::spread() noexcept {
  buckets_.assign(2 * buckets_.size(), 0);
  for (Number number = 1; number <= size(); ++number) buckets_[bucket_of(keys_[number - 1])] = number;
  free_bucket_ = bucket_of(wanted_);
}

PostureIndex::Number PostureIndex::remember(std::size_t person) {
  if (2 * (size() + 1) > buckets_.size()) spread();
  const auto number = static_cast<Number>(size() + 1);
  keys_.push_back(wanted_);
  buckets_[free_bucket_] = number;
  successors_.push_back(0);
  follow(person, number);
  return number;
}

body::Outline PostureIndex::outline(Number number) const noexcept {
  body::Outline outline;
  std::memcpy(static_cast<void*>(&outline), keys_[number - 1].data(), sizeof outline);
  return outline;
}

void PostureIndex::shrink(std::size_t n) noexcept {
  if (n >= size()) return;
  // Last in, first out: what is left lies where it lay before the others came.
  for (std::size_t number = size(); number > n; --number) buckets_[bucket_of(keys_[number - 1])] = 0;
  keys_.resize(n);
  successors_.resize(n + 1);
  for (auto* numbers : {&successors_, &last_}) {
    std::ranges::replace_if(
        *numbers, [n](Number number) { return number > n; }, Number{0});
  }
}

void PostureIndex::forget_all() noexcept {
  buckets_.assign(fewest_buckets, 0);
  keys_.clear();
  successors_.assign(1, 0);
  std::ranges::fill(last_, Number{0});
  free_bucket_ = bucket_of(wanted_);
}

}  // namespace pirsim::sim
