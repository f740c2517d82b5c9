// Four floats side by side as a number type for the ray tests: every lane gets the bits that a float would get,
// because each operation is rounded on its own.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace pirsim::ray_tests {

struct FloatLanes {
  static constexpr int width = 4;
  using Floats [[gnu::vector_size(16)]] = float;
  using Bits [[gnu::vector_size(16)]] = std::int32_t;
  /// All bits of a lane set where a condition holds.
  struct Mask {
    Bits bits;
    friend Mask operator&(const Mask& a, const Mask& b) noexcept { return {a.bits & b.bits}; }
  };

  Floats value;

  FloatLanes() = default;
  explicit FloatLanes(float all) noexcept : value{all, all, all, all} {}
  explicit FloatLanes(Floats lanes) noexcept : value(lanes) {}
  [[nodiscard]] static FloatLanes load(const float* from) noexcept {
    FloatLanes lanes;
    std::memcpy(&lanes.value, from, sizeof lanes.value);
    return lanes;
  }

  friend FloatLanes operator+(const FloatLanes& a, const FloatLanes& b) noexcept {
    return FloatLanes(a.value + b.value);
  }
  friend FloatLanes operator-(const FloatLanes& a, const FloatLanes& b) noexcept {
    return FloatLanes(a.value - b.value);
  }
  friend FloatLanes operator*(const FloatLanes& a, const FloatLanes& b) noexcept {
    return FloatLanes(a.value * b.value);
  }
  friend FloatLanes operator/(const FloatLanes& a, const FloatLanes& b) noexcept {
    return FloatLanes(a.value / b.value);
  }
  friend Mask operator<(const FloatLanes& a, const FloatLanes& b) noexcept { return {a.value < b.value}; }
  friend Mask operator>(const FloatLanes& a, const FloatLanes& b) noexcept { return {a.value > b.value}; }
  friend Mask operator<=(const FloatLanes& a, const FloatLanes& b) noexcept { return {a.value <= b.value}; }
  friend Mask operator>=(const FloatLanes& a, const FloatLanes& b) noexcept { return {a.value >= b.value}; }
  friend Mask operator==(const FloatLanes& a, const FloatLanes& b) noexcept { return {a.value == b.value}; }
};

inline FloatLanes select(const FloatLanes::Mask& condition, const FloatLanes& if_true,
                         const FloatLanes& if_false) noexcept {
  return FloatLanes(condition.bits ? if_true.value : if_false.value);
}
inline FloatLanes smaller(const FloatLanes& a, const FloatLanes& b) noexcept { return select(a < b, a, b); }
inline FloatLanes larger(const FloatLanes& a, const FloatLanes& b) noexcept { return select(a < b, b, a); }
inline FloatLanes square_root(const FloatLanes& x) noexcept {
#if defined(__SSE__)
  return FloatLanes(FloatLanes::Floats(_mm_sqrt_ps(x.value)));
#else
  FloatLanes roots;
  for (int i = 0; i < FloatLanes::width; ++i) roots.value[i] = std::sqrt(x.value[i]);
  return roots;
#endif
}

}  // namespace pirsim::ray_tests
