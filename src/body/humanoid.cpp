#include "body/humanoid.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "schema/body_part_names.hpp"

namespace pirsim::body {

namespace {

// Ref: [Plagenhoef1983], table 4, male: fractions of the body's mass.
constexpr double head_and_neck = 0.0828;
constexpr double thorax = 0.201;
constexpr double abdomen = 0.1306;
constexpr double pelvis = 0.1366;
constexpr double upper_arm = 0.0325;
constexpr double forearm = 0.0187;
constexpr double hand = 0.0065;
constexpr double thigh = 0.105;
constexpr double shank = 0.0475;
constexpr double foot = 0.0143;

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

std::array<double, n_parts> masses_of(double mass) {
  const double arm = forearm + hand;
  std::array<double, n_parts> masses{
      pelvis, thorax + abdomen, head_and_neck, upper_arm, upper_arm, arm, arm, thigh, thigh, shank, shank, foot, foot};
  for (double& m : masses) m *= mass;
  return masses;
}

/// A cylinder of the segment's mass and length; the round ends overlap at the joints.
Capsule limb(double mass_kg, double length_m) {
  const double radius = std::sqrt(mass_kg / (tissue_density_kg_m3 * std::numbers::pi * length_m));
  return {radius, 0.5 * length_m};
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

}  // namespace

Humanoid::Humanoid(const PersonSpec& person)
    : measures_(measures_of(person.stature_m)),
      masses_kg_(masses_of(person.mass_kg)),
      walking_speed_m_s_(person.walking_speed_m_s) {
  const Measures& m = measures_;
  const double h = m.stature_m;
  // Widths grow as those of a body of constant density do.
  const double girth = std::sqrt((person.mass_kg / reference_mass_kg) / (h / reference_stature_m));
  const auto set = [this](Part part, const Shape& shape) { primitives_[at(part)] = shape; };
  const auto mass = [this](Part part) { return masses_kg_[at(part)]; };

  set(Part::pelvis, Capsule{pelvis_radius_m * girth, 0.5 * m.hip_width_m});
  const double torso_half_height = 0.5 * (torso_top * h - m.hip_height_m - torso_bottom * h);
  const Capsule arm = limb(mass(Part::left_upper_arm), m.upper_arm_m);
  for (const Part part : {Part::left_upper_arm, Part::right_upper_arm}) set(part, arm);
  // A slender person's torso still reaches into the arms.
  const double torso_half_width = std::max(torso_half_width_m * girth, 0.5 * (m.shoulder_width_m - arm.radius));
  set(Part::torso, Box{{torso_half_width, torso_half_height, torso_half_depth_m * girth}});
  set(Part::head, Sphere{head_radius * h});
  for (const Part part : {Part::left_forearm, Part::right_forearm}) set(part, limb(mass(part), m.forearm_m));
  for (const Part part : {Part::left_thigh, Part::right_thigh}) set(part, limb(mass(part), m.thigh_m));
  for (const Part part : {Part::left_shank, Part::right_shank}) set(part, limb(mass(part), m.shank_m));
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

}  // namespace pirsim::body
