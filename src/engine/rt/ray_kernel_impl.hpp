// Body of a RayKernel; included by one file an instruction set. Internal linkage throughout: see lanes.hpp.
#pragma once

#include "engine/rt/ray_kernel.hpp"
#include "model/geom/ray_tests.hpp"

namespace pirsim::rt {
namespace {

using ray_tests::Lanes, ray_tests::Mask, ray_tests::n_lanes;
using Vector = ray_tests::Vector<Lanes>;
using Interval = ray_tests::Interval<Lanes>;
using Near = ray_tests::Approach<Lanes>;

/// Metres added to a sphere before anything is left out: far above single precision's rounding (a kilometre from the
/// world's origin 6e-5 m), so that what the exact tests say of a ray outside the sphere is always "misses".
constexpr float sphere_margin = 1e-3F;
constexpr float relative_margin = 1e-5F;
constexpr float guess_margin = 1e-4F;   ///< metres, of a ray from where a capsule's surface is
constexpr float least_square = 1e-30F;  ///< instead of zero, to divide by

inline Vector vector_of(const Vec3f& v) noexcept { return {Lanes(v.x), Lanes(v.y), Lanes(v.z)}; }

inline Vector load(const Column& x, const Column& y, const Column& z, std::size_t i) noexcept {
  return {Lanes::at(x + i), Lanes::at(y + i), Lanes::at(z + i)};
}
inline Lanes size_of(Lanes x) noexcept { return larger(x, Lanes(0.0F) - x); }

/// may_touch() of culling.cpp.
[[gnu::flatten]] std::size_t cull(const ConeBlock* cones, std::size_t n_blocks, const BoundingSphere& sphere,
                                  std::uint32_t* indices) noexcept {
  const Vector centre = vector_of(sphere.centre);
  const Lanes radius(sphere.radius + sphere_margin), share(relative_margin);
  std::size_t n = 0;
  for (std::size_t block = 0; block < n_blocks; ++block) {
    const ConeBlock& cone = cones[block];
    for (std::size_t lane = 0; lane < packet_size; lane += n_lanes) {
      const Vector offset = centre - load(cone.apex_x, cone.apex_y, cone.apex_z, lane);
      const Vector axis = load(cone.axis_x, cone.axis_y, cone.axis_z, lane);
      const Lanes along = dot(offset, axis);
      const Vector aside = offset - axis * along;
      const Lanes across = square_root(dot(aside, aside));
      const Lanes reach = radius + share * (size_of(along) + across);
      const Lanes beside = across * Lanes::at(cone.cosine + lane) - along * Lanes::at(cone.sine + lane);
      unsigned int touched = bits((beside <= reach) & (along - reach <= Lanes::at(cone.length + lane)));
      for (; touched != 0; touched &= touched - 1) {
        const std::size_t bit = static_cast<std::size_t>(__builtin_ctz(touched));
        indices[n++] = static_cast<std::uint32_t>(block * packet_size + lane + bit);
      }
    }
  }
  return n;
}

/// What can be said of rays without the exact test.
struct Guess {
  Mask surely, perhaps;  ///< hits; neither: a miss
};

/// A ray misses that passes the bone clearly outside; one that is clearly inside where it passes the bone hits. The
/// exact test starts from the same `near`, so the margin covers the rounding of what follows only.
inline Guess guess_capsule(const ray_tests::CapsuleAxis<Lanes>& bone, Lanes radius, const Near& near,
                           const Vector& direction, Lanes slack, Lanes range) noexcept {
  const Lanes along = dot(bone.half_axis, direction), one(1.0F);
  const Vector across = bone.half_axis - direction * along;
  const Lanes square = dot(across, across), aside = dot(near.offset, across);
  const Lanes margin = Lanes(guess_margin) + slack, outside = radius + margin, inside = radius - margin;
  // Within a hundredth of a radian of the bone rounding could be worth more than the margin.
  const Lanes along_square = Lanes(1e-4F) * bone.half_length * bone.half_length;
  const Mask is_along = square < along_square;
  // Most packets pass the bone's endless line at a distance, which is told without a division.
  const Lanes offset_square = dot(near.offset, near.offset) * Lanes(1.0F - relative_margin);
  const Mask near_line = (offset_square - outside * outside) * square <= aside * aside;
  if (bits(near_line | is_along) == 0) return {near_line, near_line};
  const Lanes place = aside / larger(square, Lanes(least_square));
  const Lanes nearest = smaller(larger(place, Lanes(0.0F) - one), one);  // of the bone's points, in half axes
  const Vector apart = near.offset - across * nearest;
  const Lanes gap_square = dot(apart, apart), distance = near.distance + along * nearest;
  const Mask is_hit = (gap_square < inside * inside) & (inside > Lanes(0.0F)) & (square >= along_square);
  return {is_hit & (distance > margin) & (distance + margin < range), (gap_square <= outside * outside) | is_along};
}

/// Forgets where rays enter, or notes it.
struct HitsOnly {
  static constexpr bool wants_distances = false;
  void operator()(std::size_t, Lanes) const noexcept {}
};
struct Distances {
  static constexpr bool wants_distances = true;
  float* to;
  void operator()(std::size_t ray, Lanes distance) const noexcept { ray_tests::store(distance.value, to + ray); }
};

/// What all solids have in common: which rays, the sphere around the solid, where the answers go.
template <typename Note>
struct Query {
  const RayPacket* rays;
  const std::uint32_t* picked;
  std::size_t n;
  const BoundingSphere& around;
  PacketHits* hits;
  Note note;
};

template <typename Note, typename Guesser, typename Test>
inline void intersect(const Query<Note>& query, const Guesser& guess, const Test& inside_solid) noexcept {
  const Vector centre = vector_of(query.around.centre);
  const float reach = query.around.radius * (1.0F + relative_margin) + sphere_margin;
  const Lanes margin(reach), share(relative_margin);
  for (std::size_t k = 0; k < query.n; ++k) {
    const RayPacket& packet = query.rays[query.picked[k]];
    unsigned int found = 0;
    for (std::size_t lane = 0; lane < packet_size; lane += n_lanes) {
      const Vector origin = load(packet.origin_x, packet.origin_y, packet.origin_z, lane);
      const Vector direction = load(packet.direction_x, packet.direction_y, packet.direction_z, lane);
      const Lanes range = Lanes::at(packet.range + lane);
      const Near near = ray_tests::approach(origin, direction, centre);
      const Lanes slack = share * size_of(near.distance), wide = margin + slack;
      const Mask is_near = (dot(near.offset, near.offset) <= wide * wide) & (near.distance - wide <= range);
      if (bits(is_near) == 0) continue;
      const Guess guessed = guess(near, direction, slack, range);
      const unsigned int surely = bits(is_near & guessed.surely), perhaps = bits(is_near & guessed.perhaps) & ~surely;
      if (perhaps == 0 && (surely == 0 || !Note::wants_distances)) {
        found |= surely << lane;
        continue;
      }
      const Interval inside = inside_solid(origin, direction);
      found |= bits(ray_tests::is_hit(inside, range)) << lane;
      query.note(k * packet_size + lane, ray_tests::entry(inside));
    }
    query.hits[k] = static_cast<PacketHits>(found);
  }
}

inline Guess unsure(const Near&, const Vector&, Lanes slack, Lanes) noexcept {
  return {slack < Lanes(0.0F), slack >= Lanes(0.0F)};
}

template <typename Note>
inline void intersect_solid(const PosedSphere& solid, const Query<Note>& query) noexcept {
  const Vector centre = vector_of(solid.centre);
  const Lanes radius(solid.radius);
  intersect(query, unsure, [&](const Vector& origin, const Vector& direction) {
    return ray_tests::sphere(origin, direction, centre, radius);
  });
}

template <typename Note>
inline void intersect_solid(const PosedCapsule& solid, const Query<Note>& query) noexcept {
  const auto bone = ray_tests::capsule_axis(vector_of(solid.a), vector_of(solid.b));
  const Lanes radius(solid.radius);
  intersect(
      query,
      [&](const Near& near, const Vector& direction, Lanes slack, Lanes range) {
        return guess_capsule(bone, radius, near, direction, slack, range);
      },
      [&](const Vector& origin, const Vector& direction) {
        return ray_tests::capsule(origin, direction, bone, radius);
      });
}

template <typename Note>
inline void intersect_solid(const PosedBox& solid, const Query<Note>& query) noexcept {
  const Vector centre = vector_of(solid.centre), half_extents = vector_of(solid.half_extents);
  const std::array<Vector, 3> axes{vector_of(solid.axes[0]), vector_of(solid.axes[1]), vector_of(solid.axes[2])};
  intersect(query, unsure, [&](const Vector& origin, const Vector& direction) {
    return ray_tests::box(origin, direction, centre, axes, half_extents);
  });
}

template <typename Solid>
[[gnu::flatten]] void intersect_one(const RayPacket* rays, const std::uint32_t* picked, std::size_t n,
                                    const Solid& solid, const BoundingSphere& around, PacketHits* hits) noexcept {
  intersect_solid(solid, Query<HitsOnly>{rays, picked, n, around, hits, {}});
}
template <typename Solid>
[[gnu::flatten]] void enter_one(const RayPacket* rays, const std::uint32_t* picked, std::size_t n, const Solid& solid,
                                const BoundingSphere& around, PacketHits* hits, float* distances) noexcept {
  intersect_solid(solid, Query<Distances>{rays, picked, n, around, hits, {distances}});
}

/// The kernel of the including file's instruction set.
constexpr RayKernel make_kernel(std::string_view name, bool (*is_available)()) noexcept {
  return {name,
          is_available,
          cull,
          intersect_one<PosedSphere>,
          intersect_one<PosedCapsule>,
          intersect_one<PosedBox>,
          enter_one<PosedSphere>,
          enter_one<PosedCapsule>,
          enter_one<PosedBox>};
}

}  // namespace
}  // namespace pirsim::rt
