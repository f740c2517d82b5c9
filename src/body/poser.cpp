#include "body/poser.hpp"

#include <cstring>

namespace pirsim::body {
namespace {

/// By bytes, so that 0 and -0 count as different and no number as itself.
template <typename Value>
bool differ(const Value& a, const Value& b) noexcept {
  static_assert(sizeof(Value) % sizeof(double) == 0);
  return std::memcmp(static_cast<const void*>(&a), static_cast<const void*>(&b), sizeof a) != 0;
}

Limbs changes(const Outline& a, const Outline& b) noexcept {
  Limbs changed;
  if (a.lying.progress > 0.0 || b.lying.progress > 0.0) {  // what hangs on the surface hangs together
    Outline same_breath = a;
    same_breath.chest_m = b.chest_m;
    const bool any = differ(same_breath, b);
    return {any, any, differ(a.chest_m, b.chest_m), any, any, {any, any}};
  }
  changed.hips = differ(a.pelvis, b.pelvis) || differ(a.hip_height_m, b.hip_height_m);
  changed.spine = differ(a.spine_tilt, b.spine_tilt) || differ(a.spine_lean, b.spine_lean);
  changed.chest = differ(a.chest_m, b.chest_m);
  changed.head = differ(a.head_turn, b.head_turn);
  const bool floor = differ(a.floor_height_m, b.floor_height_m);
  for (const std::size_t side : {0U, 1U}) changed.ankles[side] = floor || differ(a.feet[side], b.feet[side]);
  changed.arms = changed.hips || changed.spine || changed.ankles[0] || changed.ankles[1] || differ(a.fall, b.fall) ||
                 differ(a.reach, b.reach) || differ(a.thigh_angle, b.thigh_angle) ||
                 differ(a.table_height_m, b.table_height_m) || differ(a.hand_offset_m, b.hand_offset_m) ||
                 differ(a.hand_ahead_m, b.hand_ahead_m) || differ(a.hand_up_m, b.hand_up_m) ||
                 differ(a.hand_to_head, b.hand_to_head);
  return changed;
}

constexpr std::uint32_t bit(Part left, std::size_t side = 0) {
  return 1U << (static_cast<std::uint32_t>(left) + static_cast<std::uint32_t>(side));
}

/// See update(Posture&, ...).
std::uint32_t parts_of(const Limbs& changed) noexcept {
  const bool trunk = changed.hips || changed.spine;
  std::uint32_t parts = 0;
  if (changed.hips) parts |= bit(Part::pelvis);
  if (trunk || changed.chest) parts |= bit(Part::torso);
  if (trunk || changed.head) parts |= bit(Part::head);
  for (const std::size_t side : {0U, 1U}) {
    if (trunk || changed.arms) parts |= bit(Part::left_upper_arm, side) | bit(Part::left_forearm, side);
    if (changed.hips || changed.ankles[side]) parts |= bit(Part::left_thigh, side) | bit(Part::left_shank, side);
    if (changed.ankles[side]) parts |= bit(Part::left_foot, side);
  }
  return parts;
}

}  // namespace

const Posture& Poser::posture(const Outline& outline) noexcept {
  const Limbs changed = begun_ ? changes(outline_, outline) : Limbs{};
  begun_ = true;
  outline_ = outline;
  update(pose_, *humanoid_, outline, changed);
  update(posture_, *humanoid_, pose_, changed);
  renewed_ = parts_of(changed);
  return posture_;
}

}  // namespace pirsim::body
