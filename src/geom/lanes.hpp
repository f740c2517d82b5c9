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
using Pack = __m512;
using PackMask = __mmask16;
inline Pack broadcast(float x) noexcept { return _mm512_set1_ps(x); }
inline Pack load(const float* from) noexcept { return _mm512_loadu_ps(from); }
inline void store(Pack a, float* to) noexcept { _mm512_storeu_ps(to, a); }
inline PackMask less(Pack a, Pack b) noexcept { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
inline PackMask less_equal(Pack a, Pack b) noexcept { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
inline PackMask equal(Pack a, Pack b) noexcept { return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ); }
inline PackMask both(PackMask a, PackMask b) noexcept { return static_cast<PackMask>(a & b); }
inline PackMask either(PackMask a, PackMask b) noexcept { return static_cast<PackMask>(a | b); }
inline Pack choose(PackMask m, Pack a, Pack b) noexcept { return _mm512_mask_blend_ps(m, b, a); }
inline Pack minimum(Pack a, Pack b) noexcept { return _mm512_min_ps(a, b); }
inline Pack maximum(Pack a, Pack b) noexcept { return _mm512_max_ps(a, b); }
inline Pack root(Pack x) noexcept { return _mm512_sqrt_ps(x); }
inline unsigned int bits_of(PackMask m) noexcept { return m; }
#elif defined(__AVX2__)
constexpr int n_lanes = 8;
using Pack = __m256;
using PackMask = __m256;
inline Pack broadcast(float x) noexcept { return _mm256_set1_ps(x); }
inline Pack load(const float* from) noexcept { return _mm256_loadu_ps(from); }
inline void store(Pack a, float* to) noexcept { _mm256_storeu_ps(to, a); }
inline PackMask less(Pack a, Pack b) noexcept { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
inline PackMask less_equal(Pack a, Pack b) noexcept { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
inline PackMask equal(Pack a, Pack b) noexcept { return _mm256_cmp_ps(a, b, _CMP_EQ_OQ); }
inline PackMask both(PackMask a, PackMask b) noexcept { return _mm256_and_ps(a, b); }
inline PackMask either(PackMask a, PackMask b) noexcept { return _mm256_or_ps(a, b); }
inline Pack choose(PackMask m, Pack a, Pack b) noexcept { return _mm256_blendv_ps(b, a, m); }
inline Pack minimum(Pack a, Pack b) noexcept { return _mm256_min_ps(a, b); }
inline Pack maximum(Pack a, Pack b) noexcept { return _mm256_max_ps(a, b); }
inline Pack root(Pack x) noexcept { return _mm256_sqrt_ps(x); }
inline unsigned int bits_of(PackMask m) noexcept { return static_cast<unsigned int>(_mm256_movemask_ps(m)); }
#elif defined(__SSE2__)
constexpr int n_lanes = 4;
using Pack = __m128;
using PackMask = __m128;
inline Pack broadcast(float x) noexcept { return _mm_set1_ps(x); }
inline Pack load(const float* from) noexcept { return _mm_loadu_ps(from); }
inline void store(Pack a, float* to) noexcept { _mm_storeu_ps(to, a); }
inline PackMask less(Pack a, Pack b) noexcept { return _mm_cmplt_ps(a, b); }
inline PackMask less_equal(Pack a, Pack b) noexcept { return _mm_cmple_ps(a, b); }
inline PackMask equal(Pack a, Pack b) noexcept { return _mm_cmpeq_ps(a, b); }
inline PackMask both(PackMask a, PackMask b) noexcept { return _mm_and_ps(a, b); }
inline PackMask either(PackMask a, PackMask b) noexcept { return _mm_or_ps(a, b); }
inline Pack choose(PackMask m, Pack a, Pack b) noexcept { return _mm_or_ps(_mm_and_ps(m, a), _mm_andnot_ps(m, b)); }
inline Pack minimum(Pack a, Pack b) noexcept { return _mm_min_ps(a, b); }
inline Pack maximum(Pack a, Pack b) noexcept { return _mm_max_ps(a, b); }
inline Pack root(Pack x) noexcept { return _mm_sqrt_ps(x); }
inline unsigned int bits_of(PackMask m) noexcept { return static_cast<unsigned int>(_mm_movemask_ps(m)); }
#else
constexpr int n_lanes = 1;
using Pack = float;
using PackMask = bool;
inline Pack broadcast(float x) noexcept { return x; }
inline Pack load(const float* from) noexcept { return *from; }
inline void store(Pack a, float* to) noexcept { *to = a; }
inline PackMask less(Pack a, Pack b) noexcept { return a < b; }
inline PackMask less_equal(Pack a, Pack b) noexcept { return a <= b; }
inline PackMask equal(Pack a, Pack b) noexcept { return a == b; }
inline PackMask both(PackMask a, PackMask b) noexcept { return a && b; }
inline PackMask either(PackMask a, PackMask b) noexcept { return a || b; }
inline Pack choose(PackMask m, Pack a, Pack b) noexcept { return m ? a : b; }
inline Pack minimum(Pack a, Pack b) noexcept { return a < b ? a : b; }
inline Pack maximum(Pack a, Pack b) noexcept { return a > b ? a : b; }
inline Pack root(Pack x) noexcept { return std::sqrt(x); }
inline unsigned int bits_of(PackMask m) noexcept { return m ? 1U : 0U; }
#endif

struct Mask {
  PackMask value;
  friend Mask operator&(Mask a, Mask b) noexcept { return {both(a.value, b.value)}; }
  friend Mask operator|(Mask a, Mask b) noexcept { return {either(a.value, b.value)}; }
};
/// Bit i tells lane i.
inline unsigned int bits(Mask mask) noexcept { return bits_of(mask.value); }

struct Lanes {
  Pack value;
  Lanes() = default;
  explicit Lanes(float x) noexcept : value(broadcast(x)) {}
  static Lanes at(const float* first) noexcept { return Lanes(load(first)); }
#if defined(__SSE2__)
  explicit Lanes(Pack pack) noexcept : value(pack) {}
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
