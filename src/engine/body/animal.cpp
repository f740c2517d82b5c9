// Cats and dogs: a trunk, a head and four legs of capsules.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/body/motion.hpp"
#include "engine/body/skeleton.hpp"

namespace pirsim::body {
namespace {

struct Size {
  double height_m, length_m, mass_kg;
};
/// A cat's as a maker of flaps has it, 4.5 kg; of a dog of middle size: assumed (0.2-0.8 m, 2-60 kg).
constexpr Size usual_size(PetKind kind) { return kind == PetKind::cat ? Size{0.24, 0.46, 4.5} : Size{0.5, 0.8, 20.0}; }

// Shares of the mass, the neck's with the trunk; assumed (trunk 0.65-0.78, head 0.06-0.12).
constexpr double trunk_share = 0.72, head_share = 0.08, leg_share = 0.05;
constexpr double trunk_length = 0.75;  // of the length from nose to rump, assumed (0.65-0.8)
constexpr double knee_slack = 1.05;    // legs are longer than the trunk is high, assumed (1.02-1.2)
constexpr double coat_m = 0.01;        // assumed (0.005-0.03): rays meet the tips of the hair
constexpr double density_kg_m3 = 1050.0;

constexpr double core_c = 38.5;         // of cats and dogs
constexpr double coat_of_core = 0.324;  // 6 K above air of 20 C: assumed (4-8 K)

PersonSpec somebody_as_high(const PetSpec& pet) {
  PersonSpec person;
  person.stature_m = pet.height_m.value_or(usual_size(pet.kind).height_m);
  person.mass_kg = pet.mass_kg.value_or(usual_size(pet.kind).mass_kg);
  return person;
}

}  // namespace

AnimalMeasures measures_of(const PetSpec& pet) {
  const Size usual = usual_size(pet.kind);
  const double mass_kg = pet.mass_kg.value_or(usual.mass_kg), height_m = pet.height_m.value_or(usual.height_m);
  const double trunk_m = trunk_length * pet.length_m.value_or(usual.length_m);
  /// Of a cylinder with that share of the mass.
  const auto radius_m = [&](double share, double length_m) {
    return std::sqrt(share * mass_kg / (density_kg_m3 * std::numbers::pi * length_m));
  };
  AnimalMeasures animal;
  animal.trunk_radius_m = radius_m(trunk_share, trunk_m) + coat_m;
  animal.half_trunk_m = std::max(0.0, 0.5 * trunk_m - animal.trunk_radius_m);
  animal.axis_height_m = std::max(height_m - animal.trunk_radius_m, animal.trunk_radius_m);
  animal.leg_m = knee_slack * animal.axis_height_m;
  animal.leg_radius_m = radius_m(leg_share, animal.leg_m) + 0.5 * coat_m;
  animal.head_radius_m =
      std::cbrt(3.0 * head_share * mass_kg / (4.0 * std::numbers::pi * density_kg_m3)) + 0.5 * coat_m;
  return animal;
}

Solids solids_of(const AnimalMeasures& animal) {
  const Capsule leg{animal.leg_radius_m, 0.25 * animal.leg_m};
  Solids solids;
  solids.fill(leg);
  solids[at(Part::pelvis)] = Sphere{animal.trunk_radius_m};
  solids[at(Part::torso)] = Capsule{animal.trunk_radius_m, animal.half_trunk_m};
  solids[at(Part::head)] = Sphere{animal.head_radius_m};
  for (const Part paw : {Part::left_foot, Part::right_foot}) solids[at(paw)] = Sphere{animal.leg_radius_m};
  return solids;
}

double coat_c(double ambient_c) noexcept { return std::lerp(ambient_c, core_c, coat_of_core); }

Humanoid::Humanoid(const PetSpec& pet) : Humanoid(somebody_as_high(pet)) {
  animal_ = body::measures_of(pet);
  solids_ = solids_of(*animal_);
  constexpr double whiskers_m = 0.04;  // assumed (0.02-0.1): kept beside the trunk
  clearance_radius_m_ = animal_->trunk_radius_m + whiskers_m;
}

Posture posture_of(const AnimalMeasures& animal, const Outline& outline) noexcept {
  const double axis_m = std::lerp(animal.axis_height_m, animal.trunk_radius_m, outline.fall);
  const Frame trunk{rotation_from_heading(outline.pelvis.heading),
                    Vec3(outline.pelvis.position.x, outline.floor_height_m + axis_m, outline.pelvis.position.y)};
  const Quat lengthwise = glm::angleAxis(-0.5 * std::numbers::pi, x_axis);  // a capsule's axis is its Y
  constexpr double neck = 0.8;                                              // of the head's radius, as is the next
  constexpr double held_up = 0.6;
  Posture posture;
  posture[at(Part::torso)] = {glm::normalize(trunk.rotation * lengthwise), trunk.origin};
  posture[at(Part::pelvis)] = {trunk.rotation, trunk * Vec3(0, 0, animal.half_trunk_m)};
  posture[at(Part::head)] = {trunk.rotation,
                             trunk * Vec3(0, held_up * animal.head_radius_m,
                                          -animal.half_trunk_m - animal.trunk_radius_m - neck * animal.head_radius_m)};
  const double bone_m = 0.5 * animal.leg_m;
  constexpr double stretched_out = 0.9;  // assumed: so much of a leg lies before the joint of who lies
  for (const std::size_t side : {0U, 1U}) {
    for (const std::size_t hind : {0U, 1U}) {
      const double x = 0.5 * sign_of(side) * animal.trunk_radius_m * (1.0 + outline.fall);
      const double z = hind == 0 ? -animal.half_trunk_m : animal.half_trunk_m;
      const double ahead_m =
          std::lerp(outline.hand_ahead_m[(side + hind) % 2], stretched_out * animal.leg_m, outline.fall);
      const Vec3 joint = trunk * Vec3(x, 0, z), paw = trunk * Vec3(x, animal.leg_radius_m - axis_m, z - ahead_m);
      // Elbows point back, knees ahead; those of who lies, aside.
      const double back = (hind == 0 ? 1.0 : -1.0) * (1.0 - outline.fall);
      const Vec3 pole = trunk.rotation * Vec3(sign_of(side) * outline.fall, 0, back);
      const Vec3 middle = two_bone_joint(joint, paw, bone_m, bone_m, pole);
      const Vec3 right = trunk.rotation * x_axis, up = glm::normalize(joint - middle);
      const Vec3 lower_up = glm::normalize(middle - paw);
      const Part upper = hind == 0 ? Part::left_upper_arm : Part::left_thigh;
      const Part lower = hind == 0 ? Part::left_forearm : Part::left_shank;
      posture[at(upper) + side] = {rotation_of(right, up), 0.5 * (joint + middle)};
      posture[at(lower) + side] = {rotation_of(right, lower_up), middle - 0.5 * bone_m * lower_up};
      if (hind == 1) posture[at(Part::left_foot) + side] = {trunk.rotation, paw};
    }
  }
  return posture;
}

}  // namespace pirsim::body
