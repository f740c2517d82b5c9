// A SIMD vector of floats as wide as the including file's instruction set, for the templates of ray_tests.hpp. Every
// operation rounds each lane as the same operation on a float does; there is no fused multiply-add. All of it has
// internal linkage, so that no file takes another's instructions.
#pragma once

#include <array>
#include <cmath>
#include <limits>

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

// The arithmetic of the three ray tests, written once for any number type: float here, a SIMD vector in a
// vectorised tracer. Only + - * /, square root, comparison and selection are used, each rounded on its own (no
// fused multiply-add), so a lane and a float get the same bits. Everything is a sum of products in which a
// mirrored coordinate changes sign twice or not at all: mirroring x changes no bit of a distance.
//
// All tests first move the ray's origin to its point nearest to the solid's centre. The numbers that are then
// squared and subtracted are as small as the solid, so a limb 12 m away is as sharp as one that is near.

// What the tests need of a number type beyond operators; a lane type brings its own overloads.
inline float select(bool condition, float if_true, float if_false) noexcept { return condition ? if_true : if_false; }
inline float smaller(float a, float b) noexcept { return a < b ? a : b; }
inline float larger(float a, float b) noexcept { return a < b ? b : a; }
inline float square_root(float x) noexcept { return std::sqrt(x); }

template <typename F>
struct Vector {
  F x, y, z;
  friend Vector operator+(const Vector& a, const Vector& b) noexcept { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vector operator-(const Vector& a, const Vector& b) noexcept { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vector operator*(const Vector& a, const F& s) noexcept { return {a.x * s, a.y * s, a.z * s}; }
};
template <typename F>
F dot(const Vector<F>& a, const Vector<F>& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Where the ray is inside: from `enter` to `leave`, metres from its origin; empty if enter > leave.
template <typename F>
struct Interval {
  F enter, leave;
};
inline constexpr float infinity = std::numeric_limits<float>::infinity();
template <typename F>
Interval<F> everything() noexcept {
  return {F(-infinity), F(infinity)};
}
template <typename F>
Interval<F> intersection(const Interval<F>& a, const Interval<F>& b) noexcept {
  return {larger(a.enter, b.enter), smaller(a.leave, b.leave)};
}
/// Of two intervals whose union is one interval; an empty one adds nothing.
template <typename F>
Interval<F> united(const Interval<F>& a, const Interval<F>& b) noexcept {
  const auto a_empty = a.enter > a.leave, b_empty = b.enter > b.leave;
  const Interval<F> both{smaller(a.enter, b.enter), larger(a.leave, b.leave)};
  return {select(a_empty, b.enter, select(b_empty, a.enter, both.enter)),
          select(a_empty, b.leave, select(b_empty, a.leave, both.leave))};
}
/// `interval` where the condition holds, else empty.
template <typename F, typename Condition>
Interval<F> only_if(const Condition& condition, const Interval<F>& interval) noexcept {
  const Interval<F> all = everything<F>();
  return {select(condition, interval.enter, all.leave), select(condition, interval.leave, all.enter)};
}
template <typename F>
Interval<F> shifted(const Interval<F>& interval, const F& by) noexcept {
  return {interval.enter + by, interval.leave + by};
}

/// The ray's point nearest to `centre`: its distance along the ray and its position relative to `centre`.
template <typename F>
struct Approach {
  F distance;
  Vector<F> offset;
};
template <typename F>
Approach<F> approach(const Vector<F>& origin, const Vector<F>& direction, const Vector<F>& centre) noexcept {
  const Vector<F> to_centre = centre - origin;
  const F distance = dot(to_centre, direction);
  return {distance, direction * distance - to_centre};
}

/// A sphere at the origin, for a line through `start`.
template <typename F>
Interval<F> inside_sphere(const Vector<F>& start, const Vector<F>& direction, const F& radius) noexcept {
  const F nearest = F(0) - dot(start, direction);
  const Vector<F> offset = start + direction * nearest;
  const F square = radius * radius - dot(offset, offset);
  const F half_chord = square_root(larger(square, F(0)));
  return only_if(square >= F(0), Interval<F>{nearest - half_chord, nearest + half_chord});
}

/// One pair of planes, -half_width <= start + s step <= half_width; a zero step gives no NaN.
template <typename F>
Interval<F> inside_slab(const F& start, const F& step, const F& half_width) noexcept {
  const auto parallel = step == F(0);
  const F divisor = select(parallel, F(1), step);
  const F lower = (F(0) - half_width - start) / divisor, upper = (half_width - start) / divisor;
  const auto within = (start >= F(0) - half_width) & (start <= half_width);
  const Interval<F> crossing{smaller(lower, upper), larger(lower, upper)};
  const Interval<F> along = only_if(within, everything<F>());
  return {select(parallel, along.enter, crossing.enter), select(parallel, along.leave, crossing.leave)};
}

/// A round bar without ends along the unit `axis` through the origin.
template <typename F>
Interval<F> inside_bar(const Vector<F>& start, const Vector<F>& direction, const Vector<F>& axis,
                       const F& radius) noexcept {
  const Vector<F> step = direction - axis * dot(direction, axis);
  const Vector<F> across = start - axis * dot(start, axis);
  const F step_square = dot(step, step);
  // Below 1e-6 rad `step` is rounding alone, and over a limb's length it is worth a micrometre: call it parallel.
  const auto parallel = step_square < F(1e-12F);
  const F divisor = select(parallel, F(1), step_square);
  const F nearest = select(parallel, F(0), F(0) - dot(across, step) / divisor);
  const Vector<F> offset = across + step * nearest;
  const F square = radius * radius - dot(offset, offset);
  const F half_chord = square_root(larger(square, F(0)) / divisor);
  const Interval<F> all = everything<F>();
  return only_if(square >= F(0), Interval<F>{select(parallel, all.enter, nearest - half_chord),
                                             select(parallel, all.leave, nearest + half_chord)});
}

template <typename F>
Interval<F> sphere(const Vector<F>& origin, const Vector<F>& direction, const Vector<F>& centre,
                   const F& radius) noexcept {
  const Approach<F> near = approach(origin, direction, centre);
  return shifted(inside_sphere(near.offset, direction, radius), near.distance);
}

/// What a capsule's test needs that doesn't depend on the ray.
template <typename F>
struct CapsuleAxis {
  Vector<F> centre, half_axis, axis;  ///< axis: half_axis as a unit vector
  F half_length;
};
template <typename F>
CapsuleAxis<F> capsule_axis(const Vector<F>& a, const Vector<F>& b) noexcept {
  const Vector<F> half_axis = (b - a) * F(0.5F);
  const F half_length = square_root(dot(half_axis, half_axis));
  const F divisor = select(half_length > F(0), half_length, F(1));
  const Vector<F> axis{half_axis.x / divisor, half_axis.y / divisor, half_axis.z / divisor};
  return {(a + b) * F(0.5F), half_axis, axis, half_length};
}

/// A capsule is convex and the union of two spheres and a bar cut off at their centres.
template <typename F>
Interval<F> capsule(const Vector<F>& origin, const Vector<F>& direction, const CapsuleAxis<F>& bone,
                    const F& radius) noexcept {
  const Approach<F> near = approach(origin, direction, bone.centre);
  const Interval<F> ends = united(inside_sphere(near.offset - bone.half_axis, direction, radius),
                                  inside_sphere(near.offset + bone.half_axis, direction, radius));
  const Interval<F> bar =
      only_if(bone.half_length > F(0),
              intersection(inside_bar(near.offset, direction, bone.axis, radius),
                           inside_slab(dot(near.offset, bone.axis), dot(direction, bone.axis), bone.half_length)));
  return shifted(united(ends, bar), near.distance);
}

template <typename F>
Interval<F> box(const Vector<F>& origin, const Vector<F>& direction, const Vector<F>& centre,
                const std::array<Vector<F>, 3>& axes, const Vector<F>& half_extents) noexcept {
  const Approach<F> near = approach(origin, direction, centre);
  const Interval<F> x = inside_slab(dot(near.offset, axes[0]), dot(direction, axes[0]), half_extents.x);
  const Interval<F> y = inside_slab(dot(near.offset, axes[1]), dot(direction, axes[1]), half_extents.y);
  const Interval<F> z = inside_slab(dot(near.offset, axes[2]), dot(direction, axes[2]), half_extents.z);
  return shifted(intersection(intersection(x, y), z), near.distance);
}

/// The ray starts at 0: what lies behind it doesn't count, and from inside the distance is 0 (never -0).
template <typename F>
F entry(const Interval<F>& inside) noexcept {
  return larger(F(0), inside.enter);
}
template <typename F>
auto is_hit(const Interval<F>& inside, const F& t_max) noexcept {
  return (inside.enter <= inside.leave) & (inside.leave >= F(0)) & (entry(inside) < t_max);
}

}  // namespace pirsim::ray_tests
