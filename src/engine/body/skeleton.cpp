#include "engine/body/skeleton.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>

#include "engine/body/motion.hpp"
#include "model/schema/words.hpp"

namespace pirsim::body {
namespace {

static_assert(body_part_names.size() == n_parts);

constexpr double skin_at_0_c = 30.2, skin_per_k = 0.125;
constexpr double clo = 0.155;        // m^2 K/W
constexpr double to_air = 8.0;       // W/(m^2 K) by convection and radiation, assumed (6-10)
constexpr double hair_clo = 1.0;     // 0.6 to 1 [Nomoto2020]; wigs on a manikin up to 2 [Lasisi2023]
constexpr double hand_share = 0.32;  // of the forearm's surface: a loosely closed hand's of its length

/// Insulation of what covers a part over that of the whole outfit: medians of 21 outfits with trousers, 0.5 to 1 clo,
/// on a manikin [LeeZhangArens2013, Nomoto2020]. Of a hat: assumed.
constexpr std::array<double, n_parts> local_share{2.0, 2.2, 1.0, 1.4, 1.4, 1.2, 1.2, 0.8, 0.8, 0.7, 0.7, 1.0, 1.0};

/// What covers the skin and the air around it divide the step between the two as their resistances do.
double outside_of(double insulation_clo, double skin_c, double ambient_c) {
  return ambient_c + (skin_c - ambient_c) / (1.0 + to_air * clo * insulation_clo);
}

double mixed(double a, double b, double share_of_b) { return a + share_of_b * (b - a); }

// Ref: [Plagenhoef1983], table 4, male: fractions of the body's mass.
constexpr double upper_arm = 0.0325;
constexpr double forearm = 0.0187;
constexpr double hand = 0.0065;
constexpr double thigh = 0.105;
constexpr double shank = 0.0475;

constexpr double tissue_density_kg_m3 = 1050.0;  // assumed; limbs 1030-1100
// Widths without a source, assumed; the range considered stands behind each.
constexpr double reference_mass_kg = 80.0;
constexpr double pelvis_radius_m = 0.09;          // 0.08-0.10: 0.09 sits on a chair of 0.44 m
constexpr double torso_half_width_m = 0.165;      // 0.15-0.18
constexpr double torso_half_depth_m = 0.11;       // 0.10-0.13
constexpr double torso_bottom = 0.02;             // of stature above the hips; 0-0.04
constexpr double torso_top = 0.857;               // of stature; 0.82-0.87: the base of the neck, so that no gap remains
constexpr double head_radius = 0.0725;            // of stature; 0.065-0.075: one sphere for head and neck
constexpr double closed_hand = 0.64;              // of the hand's length; 0.5-0.7: knuckles of a loosely closed hand
constexpr double foot_width = 0.055;              // of stature; 0.05-0.06
constexpr double heel = 0.25;                     // of the foot's length, ankle to heel; 0.2-0.3
constexpr double soft_parts_at_shoulder = 0.054;  // of stature, both sides together; 0.04-0.07
constexpr double soft_parts_at_hip = 0.086;       // 0.07-0.10

Measures measures_of(double stature) {
  Measures m;
  m.stature_m = stature;
  m.hip_height_m = 0.530 * stature;
  m.knee_height_m = 0.285 * stature;
  m.ankle_height_m = 0.039 * stature;
  m.thigh_m = 0.245 * stature;
  m.shank_m = 0.246 * stature;
  m.foot_length_m = 0.152 * stature;
  m.shoulder_height_m = 0.818 * stature;
  m.shoulder_width_m = (0.259 - soft_parts_at_shoulder) * stature;
  m.hip_width_m = (0.191 - soft_parts_at_hip) * stature;
  m.upper_arm_m = 0.186 * stature;
  m.forearm_m = (0.146 + closed_hand * 0.108) * stature;
  m.head_height_m = 0.130 * stature;
  m.heel_m = heel * m.foot_length_m;
  return m;
}

Solids with_meshes(Solids solids, const BodyMeshes& meshes) {
  for (const auto& [name, mesh] : meshes) {
    const auto part = std::find(body_part_names.begin(), body_part_names.end(), name);
    if (part == body_part_names.end())
      throw Error(ErrorCode::usage, "a mesh for '" + name + "', which is no body part");
    solids[static_cast<std::size_t>(part - body_part_names.begin())] = mesh;
  }
  return solids;
}

constexpr std::size_t at(Part left, std::size_t side) { return at(left) + side; }

/// The pelvis capsule's Y points to the person's right.
Quat hips_from_pelvis() { return {std::numbers::sqrt2 / 2, 0.0, 0.0, -std::numbers::sqrt2 / 2}; }

double torso_centre(const Humanoid& humanoid) {
  // The box ends where the head's sphere begins.
  const Measures& m = humanoid.measures();
  const double top = m.stature_m - 2.0 * humanoid.radius_m(Part::head) + 0.002 * m.stature_m - m.hip_height_m;
  return top - std::get<Box>(humanoid.primitives()[at(Part::torso)]).half_extents.y;
}
double head_centre(const Humanoid& humanoid) {
  const Measures& m = humanoid.measures();
  return m.stature_m - humanoid.radius_m(Part::head) - m.hip_height_m;
}

/// The head turns about an axis that runs through the neck, a little behind its middle.
Frame world_from_head(const Humanoid& humanoid, const Frame& torso, double turn) {
  const Vec3 centre(0, head_centre(humanoid), 0);
  if (turn == 0.0) return {torso.rotation, torso * centre};
  const double ahead = neck_behind_m(humanoid.measures());
  const Quat turned = rotation_from_heading(turn);
  return torso * Frame{turned, centre + Vec3(0, 0, ahead) + turned * Vec3(0, 0, -ahead)};
}

void put_arm(const Measures& m, const Frame& torso, const ArmPose& arm, std::size_t side, Posture& posture) {
  const Frame upper{glm::normalize(torso.rotation * arm.torso_from_upper_arm), torso * shoulder(m, side)};
  const Frame lower{glm::normalize(upper.rotation * glm::angleAxis(arm.elbow_flexion, x_axis)),
                    upper * Vec3(0, -m.upper_arm_m, 0)};
  posture[at(Part::left_upper_arm, side)] = {upper.rotation, upper * Vec3(0, -0.5 * m.upper_arm_m, 0)};
  posture[at(Part::left_forearm, side)] = {lower.rotation, lower * Vec3(0, -0.5 * m.forearm_m, 0)};
}

void put_leg(const Measures& m, const Frame& hips, const Frame& ankle, std::size_t side, Posture& posture) {
  const Vec3 hip = hips * Vec3(0.5 * sign_of(side) * m.hip_width_m, 0, 0);
  // The knee points between where the pelvis and where the foot does; hip and ankle share the turn as their limits do.
  const Vec3 toes = ankle.rotation * Vec3(0, 0, -1), up = hips.up();
  const Vec3 pole = 35.0 * hips.forward() + 45.0 * glm::normalize(toes - glm::dot(toes, up) * up);
  const Vec3 knee = two_bone_joint(hip, ankle.origin, m.thigh_m, m.shank_m, pole);
  const Vec3 thigh_up = (hip - knee) / m.thigh_m;
  const Vec3 shank_up = glm::normalize(knee - ankle.origin);
  const Vec3 right = glm::normalize(glm::cross(pole, hip - ankle.origin));
  posture[at(Part::left_thigh, side)] = {rotation_of(right, thigh_up), knee + 0.5 * m.thigh_m * thigh_up};
  posture[at(Part::left_shank, side)] = {rotation_of(right, shank_up), knee - 0.5 * m.shank_m * shank_up};
}

void put_foot(const Measures& m, const Frame& ankle, std::size_t side, Posture& posture) {
  const Vec3 ankle_to_centre(0, -0.5 * m.ankle_height_m, m.heel_m - 0.5 * m.foot_length_m);
  posture[at(Part::left_foot, side)] = {ankle.rotation, ankle * ankle_to_centre};
}

}  // namespace

Quat rotation_of(const Vec3& right, const Vec3& up) {
  const Vec3 x = glm::normalize(right - glm::dot(right, up) * up);
  return glm::normalize(glm::quat_cast(glm::dmat3(x, up, glm::cross(x, up))));
}

std::string_view name(Part part) noexcept { return body_part_names[at(part)]; }

std::array<double, n_parts> surface_temperatures_c(const WarmthSpec& warmth, double ambient_c) {
  const double skin_c = warmth.skin_c.value_or(skin_at_0_c + skin_per_k * ambient_c + warmth.skin_above_k);
  std::array<double, n_parts> temperatures{};
  for (std::size_t i = 0; i < n_parts; ++i) {
    const auto part = static_cast<Part>(i);
    const std::string key(name(part));
    const double covered_c = outside_of(local_share[i] * warmth.clothing_clo, skin_c, ambient_c);
    const bool is_bare = std::ranges::find(warmth.bare, key) != warmth.bare.end();
    if (const auto known = warmth.parts_c.find(key); known != warmth.parts_c.end()) {
      temperatures[i] = known->second;
    } else if (part == Part::head && is_bare) {
      temperatures[i] = mixed(skin_c, outside_of(hair_clo, skin_c, ambient_c), warmth.hair_share);
    } else if ((part == Part::left_forearm || part == Part::right_forearm) && !is_bare) {
      temperatures[i] = mixed(covered_c, skin_c, hand_share);
    } else {
      temperatures[i] = is_bare ? skin_c : covered_c;
    }
  }
  return temperatures;
}

Humanoid::Humanoid(const PersonSpec& person)
    : measures_(measures_of(person.stature_m)), walking_speed_m_s_(person.walking_speed_m_s) {
  const Measures& m = measures_;
  const double h = m.stature_m;
  // Widths grow as those of a body of constant density do.
  const double girth = std::sqrt((person.mass_kg / reference_mass_kg) / (h / reference_stature_m));
  const auto set = [this](Part part, const Shape& shape) { primitives_[at(part)] = shape; };
  /// A cylinder of the segment's share of the mass and length; the round ends overlap at the joints.
  const auto limb = [&](double share, double length_m) -> Capsule {
    const double radius = std::sqrt(share * person.mass_kg / (tissue_density_kg_m3 * std::numbers::pi * length_m));
    return {radius, 0.5 * length_m};
  };

  set(Part::pelvis, Capsule{pelvis_radius_m * girth, 0.5 * m.hip_width_m});
  const double torso_half_height = 0.5 * (torso_top * h - m.hip_height_m - torso_bottom * h);
  const Capsule arm = limb(upper_arm, m.upper_arm_m);
  for (const Part part : {Part::left_upper_arm, Part::right_upper_arm}) set(part, arm);
  // A slender person's torso still reaches into the arms.
  const double torso_half_width = std::max(torso_half_width_m * girth, 0.5 * (m.shoulder_width_m - arm.radius));
  set(Part::torso, Box{{torso_half_width, torso_half_height, torso_half_depth_m * girth}});
  set(Part::head, Sphere{head_radius * h});
  for (const Part part : {Part::left_forearm, Part::right_forearm}) set(part, limb(forearm + hand, m.forearm_m));
  for (const Part part : {Part::left_thigh, Part::right_thigh}) set(part, limb(thigh, m.thigh_m));
  for (const Part part : {Part::left_shank, Part::right_shank}) set(part, limb(shank, m.shank_m));
  const Box foot_box{{0.5 * foot_width * h, 0.5 * m.ankle_height_m, 0.5 * m.foot_length_m}};
  for (const Part part : {Part::left_foot, Part::right_foot}) set(part, foot_box);
  solids_ = with_meshes(primitives_, person.body_meshes);
  // Arms hang 10 degrees out from the shoulders.
  constexpr double out = 0.1736;
  clearance_radius_m_ = 0.5 * m.shoulder_width_m + out * m.upper_arm_m + radius_m(Part::left_upper_arm);
}

double Humanoid::half_depth_m() const noexcept {
  constexpr double to_spare_m = 0.01;  // assumed (0-0.03)
  return std::get<Box>(primitives_[at(Part::torso)]).half_extents.z + to_spare_m;
}

double Humanoid::half_width_m() const noexcept {
  constexpr double to_spare_m = 0.02;  // assumed (0-0.04)
  return std::get<Box>(primitives_[at(Part::torso)]).half_extents.x + to_spare_m;
}

double Humanoid::trunk_radius_m() const noexcept {
  const Vec3& torso = std::get<Box>(primitives_[at(Part::torso)]).half_extents;
  const auto& pelvis = std::get<Capsule>(primitives_[at(Part::pelvis)]);
  return std::max(glm::length(Vec2(torso.x, torso.z)), pelvis.half_length + pelvis.radius);
}

double Humanoid::trunk_height_m() const noexcept { return torso_top * measures_.stature_m - measures_.hip_height_m; }

double Humanoid::radius_m(Part part) const noexcept {
  const Shape& shape = primitives_[at(part)];
  if (const auto* capsule = std::get_if<Capsule>(&shape)) return capsule->radius;
  const auto* sphere = std::get_if<Sphere>(&shape);
  assert(sphere != nullptr);
  return sphere->radius;
}

Quat torso_rotation(const Pose& pose) noexcept {
  const Quat tilted = glm::angleAxis(-pose.spine_tilt, x_axis);
  return pose.spine_lean == 0.0 ? tilted : tilted * glm::angleAxis(-pose.spine_lean, z_axis);
}

Frame world_from_torso(const Pose& pose) noexcept {
  return pose.world_from_hips * Frame{torso_rotation(pose), Vec3(0.0)};
}

double neck_behind_m(const Measures& measures) noexcept {
  return 0.016 * measures.stature_m;  // assumed (0.01-0.03): 3 cm
}

Vec3 shoulder(const Measures& measures, std::size_t side) noexcept {
  return {0.5 * sign_of(side) * measures.shoulder_width_m, measures.shoulder_height_m - measures.hip_height_m, 0.0};
}

ArmPose arm_through(const Vec3& shoulder, const Vec3& elbow, const Vec3& hand) noexcept {
  const Vec3 upper = glm::normalize(elbow - shoulder);
  const Vec3 lower = glm::normalize(hand - elbow);
  const double flexion = std::acos(std::clamp(glm::dot(upper, lower), -1.0, 1.0));
  return {rotation_of(glm::normalize(glm::cross(upper, lower)), -upper), flexion};
}

ArmPose blend(const ArmPose& a, const ArmPose& b, double weight_of_b) noexcept {
  if (weight_of_b <= 0.0) return a;
  if (weight_of_b >= 1.0) return b;
  const double sign = glm::dot(a.torso_from_upper_arm, b.torso_from_upper_arm) < 0.0 ? -1.0 : 1.0;
  const Quat sum = a.torso_from_upper_arm * (1.0 - weight_of_b) + b.torso_from_upper_arm * (sign * weight_of_b);
  return {glm::normalize(sum), a.elbow_flexion + weight_of_b * (b.elbow_flexion - a.elbow_flexion)};
}

void update(Posture& posture, const Humanoid& humanoid, const Pose& pose, const Limbs& changed) noexcept {
  const Measures& m = humanoid.measures();
  const Frame& hips = pose.world_from_hips;
  const bool trunk = changed.hips || changed.spine;
  if (changed.hips) posture[at(Part::pelvis)] = {glm::normalize(hips.rotation * hips_from_pelvis()), hips.origin};
  if (trunk || changed.chest || changed.head || changed.arms) {
    const Frame torso = world_from_torso(pose);
    if (trunk || changed.chest)
      posture[at(Part::torso)] = {torso.rotation, torso * Vec3(0, torso_centre(humanoid), -pose.chest_m)};
    if (trunk || changed.head) posture[at(Part::head)] = world_from_head(humanoid, torso, pose.head_turn);
    for (std::size_t side : {0U, 1U}) {
      if (trunk || changed.arms) put_arm(m, torso, pose.arms[side], side, posture);
    }
  }
  for (std::size_t side : {0U, 1U}) {
    const Frame& ankle = pose.world_from_ankle[side];
    if (changed.hips || changed.ankles[side]) put_leg(m, hips, ankle, side, posture);
    if (changed.ankles[side]) put_foot(m, ankle, side, posture);
  }
}

Posture posture_of(const Humanoid& humanoid, const Pose& pose) noexcept {
  Posture posture;
  update(posture, humanoid, pose, {});
  return posture;
}

}  // namespace pirsim::body
