#include "pirsim/random.hpp"

#include <Random123/philox.h>

#include <cmath>
#include <numbers>

namespace pirsim {

std::uint32_t Stream::next_u32() noexcept {
  if (used_ == 4) {
    const r123::Philox4x32 philox;
    const r123::Philox4x32::ctr_type counter{{key_.run, key_.entity, static_cast<std::uint32_t>(key_.purpose), block_}};
    const r123::Philox4x32::key_type key{
        {static_cast<std::uint32_t>(key_.seed), static_cast<std::uint32_t>(key_.seed >> 32U)}};
    const auto words = philox(counter, key);
    for (std::size_t i = 0; i < 4; ++i) words_[i] = words[i];
    ++block_;
    used_ = 0;
  }
  return words_[used_++];
}

double Stream::uniform() noexcept {
  const std::uint64_t high = next_u32();
  const std::uint64_t low = next_u32();
  return static_cast<double>(((high << 32U) | low) >> 11U) * 0x1.0p-53;
}

std::uint32_t Stream::index(std::uint32_t n) noexcept {
  // Lemire's multiply-shift with rejection. Ref: [Lemire2019]
  std::uint64_t product = std::uint64_t{next_u32()} * n;
  const std::uint32_t threshold = (0U - n) % n;
  while (static_cast<std::uint32_t>(product) < threshold) product = std::uint64_t{next_u32()} * n;
  return static_cast<std::uint32_t>(product >> 32U);
}

double Stream::normal() noexcept {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

}  // namespace pirsim
