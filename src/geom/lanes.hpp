// A SIMD vector of floats as wide as the including file's instruction set, for the templates of ray_tests.hpp. Every
// operation rounds each lane as the same operation on a float does; there is no fused multiply-add. All of it has
// internal linkage, so that no file takes another's instructions.
#pragma once

#include <cmath>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace pirsim::ray_tests {
namespace {  // NOLINT: one copy an instruction set is the purpose

#if defined(__AVX512F__)
constexpr int n_lanes = 16;
using Simd = __m512;
using SimdMask = __mmask16;
inline Simd broadcast(float x) noexcept { return _mm512_set1_ps(x); }
inline Simd load(const float* from) noexcept { return _mm512_loadu_ps(from); }
inline void store(Simd a, float* to) noexcept { _mm512_storeu_ps(to, a); }
inline SimdMask less(Simd a, Simd b) noexcept { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
inline SimdMask less_equal(Simd a, Simd b) noexcept { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
inline SimdMask equal(Simd a, Simd b) noexcept { return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ); }
inline SimdMask both(SimdMask a, SimdMask b) noexcept { return static_cast<SimdMask>(a & b); }
inline SimdMask either(SimdMask a, SimdMask b) noexcept { return static_cast<SimdMask>(a | b); }
inline Simd choose(SimdMask m, Simd a, Simd b) noexcept { return _mm512_mask_blend_ps(m, b, a); }
inline Simd minimum(Simd a, Simd b) noexcept { return _mm512_min_ps(a, b); }
inline Simd maximum(Simd a, Simd b) noexcept { return _mm512_max_ps(a, b); }
inline Simd root(Simd x) noexcept { return _mm512_sqrt_ps(x); }
inline unsigned int bits_of(SimdMask m) noexcept { return m; }
#elif defined(__AVX2__)
constexpr int n_lanes = 8;
using Simd = __m256;
using SimdMask = __m256;
inline Simd broadcast(float x) noexcept { return _mm256_set1_ps(x); }
inline Simd load(const float* from) noexcept { return _mm256_loadu_ps(from); }
inline void store(Simd a, float* to) noexcept { _mm256_storeu_ps(to, a); }
inline SimdMask less(Simd a, Simd b) noexcept { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
inline SimdMask less_equal(Simd a, Simd b) noexcept { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
inline SimdMask equal(Simd a, Simd b) noexcept { return _mm256_cmp_ps(a, b, _CMP_EQ_OQ); }
inline SimdMask both(SimdMask a, SimdMask b) noexcept { return _mm256_and_ps(a, b); }
inline SimdMask either(SimdMask a, SimdMask b) noexcept { return _mm256_or_ps(a, b); }
inline Simd choose(SimdMask m, Simd a, Simd b) noexcept { return _mm256_blendv_ps(b, a, m); }
inline Simd minimum(Simd a, Simd b) noexcept { return _mm256_min_ps(a, b); }
inline Simd maximum(Simd a, Simd b) noexcept { return _mm256_max_ps(a, b); }
inline Simd root(Simd x) noexcept { return _mm256_sqrt_ps(x); }
inline unsigned int bits_of(SimdMask m) noexcept { return static_cast<unsigned int>(_mm256_movemask_ps(m)); }
#elif defined(__SSE2__)
constexpr int n_lanes = 4;
using Simd = __m128;
using SimdMask = __m128;
inline Simd broadcast(float x) noexcept { return _mm_set1_ps(x); }
inline Simd load(const float* from) noexcept { return _mm_loadu_ps(from); }
inline void store(Simd a, float* to) noexcept { _mm_storeu_ps(to, a); }
inline SimdMask less(Simd a, Simd b) noexcept { return _mm_cmplt_ps(a, b); }
inline SimdMask less_equal(Simd a, Simd b) noexcept { return _mm_cmple_ps(a, b); }
inline SimdMask equal(Simd a, Simd b) noexcept { return _mm_cmpeq_ps(a, b); }
inline SimdMask both(SimdMask a, SimdMask b) noexcept { return _mm_and_ps(a, b); }
inline SimdMask either(SimdMask a, SimdMask b) noexcept { return _mm_or_ps(a, b); }
inline Simd choose(SimdMask m, Simd a, Simd b) noexcept { return _mm_or_ps(_mm_and_ps(m, a), _mm_andnot_ps(m, b)); }
inline Simd minimum(Simd a, Simd b) noexcept { return _mm_min_ps(a, b); }
inline Simd maximum(Simd a, Simd b) noexcept { return _mm_max_ps(a, b); }
inline Simd root(Simd x) noexcept { return _mm_sqrt_ps(x); }
inline unsigned int bits_of(SimdMask m) noexcept { return static_cast<unsigned int>(_mm_movemask_ps(m)); }
#else
constexpr int n_lanes = 1;
using Simd = float;
using SimdMask = bool;
inline Simd broadcast(float x) noexcept { return x; }
inline Simd load(const float* from) noexcept { return *from; }
inline void store(Simd a, float* to) noexcept { *to = a; }
inline SimdMask less(Simd a, Simd b) noexcept { return a < b; }
inline SimdMask less_equal(Simd a, Simd b) noexcept { return a <= b; }
inline SimdMask equal(Simd a, Simd b) noexcept { return a == b; }
inline SimdMask both(SimdMask a, SimdMask b) noexcept { return a && b; }
inline SimdMask either(SimdMask a, SimdMask b) noexcept { return a || b; }
inline Simd choose(SimdMask m, Simd a, Simd b) noexcept { return m ? a : b; }
inline Simd minimum(Simd a, Simd b) noexcept { return a < b ? a : b; }
inline Simd maximum(Simd a, Simd b) noexcept { return a > b ? a : b; }
inline Simd root(Simd x) noexcept { return std::sqrt(x); }
inline unsigned int bits_of(SimdMask m) noexcept { return m ? 1U : 0U; }
#endif

struct Mask {
  SimdMask value;
  friend Mask operator&(Mask a, Mask b) noexcept { return {both(a.value, b.value)}; }
  friend Mask operator|(Mask a, Mask b) noexcept { return {either(a.value, b.value)}; }
};
/// Bit i tells lane i.
inline unsigned int bits(Mask mask) noexcept { return bits_of(mask.value); }

struct Lanes {
  Simd value;
  Lanes() = default;
  explicit Lanes(float x) noexcept : value(broadcast(x)) {}
  static Lanes at(const float* first) noexcept { return Lanes(load(first)); }
#if defined(__SSE2__)
  explicit Lanes(Simd simd) noexcept : value(simd) {}
#endif
  friend Lanes operator+(Lanes a, Lanes b) noexcept { return Lanes(a.value + b.value); }
  friend Lanes operator-(Lanes a, Lanes b) noexcept { return Lanes(a.value - b.value); }
  friend Lanes operator*(Lanes a, Lanes b) noexcept { return Lanes(a.value * b.value); }
  friend Lanes operator/(Lanes a, Lanes b) noexcept { return Lanes(a.value / b.value); }
  friend Mask operator<(Lanes a, Lanes b) noexcept { return {less(a.value, b.value)}; }
  friend Mask operator>(Lanes a, Lanes b) noexcept { return {less(b.value, a.value)}; }
  friend Mask operator<=(Lanes a, Lanes b) noexcept { return {less_equal(a.value, b.value)}; }
  friend Mask operator>=(Lanes a, Lanes b) noexcept { return {less_equal(b.value, a.value)}; }
  friend Mask operator==(Lanes a, Lanes b) noexcept { return {equal(a.value, b.value)}; }
};

// What geom/ray_tests.hpp asks of a number type; the same as for a float where a number isn't one, or zeros differ in
// sign: the second operand.
inline Lanes select(Mask condition, Lanes if_true, Lanes if_false) noexcept {
  return Lanes(choose(condition.value, if_true.value, if_false.value));
}
inline Lanes smaller(Lanes a, Lanes b) noexcept { return Lanes(minimum(a.value, b.value)); }
inline Lanes larger(Lanes a, Lanes b) noexcept { return Lanes(maximum(b.value, a.value)); }
inline Lanes square_root(Lanes x) noexcept { return Lanes(root(x.value)); }

}  // namespace
}  // namespace pirsim::ray_tests
