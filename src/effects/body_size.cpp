// People are taller or smaller than the script says.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

void alter(StudyInForce& study, const EffectSpec& effect) {
  const double scale = effect.parameters.at("scale");
  for_each_person(study, [&](PersonInForce& person) {
    person.stature_m *= scale;
    person.mass_kg *= scale * scale * scale;
  });
}

}  // namespace

const Effect& body_size() {
  static const Effect effect{
      .info = {.name = "body_size",
               .family = Family::person,
               .stage = "body",
               .summary = "Everybody's lengths are scaled, their mass by the cube; mesh bodies keep their meshes.",
               .fingerprint = "weak, everywhere",
               .confused_with = {"thermal_contrast", "range_scale", "arm_motion", "seat_shift"},
               .parameters = {factor("scale", 0.8, 1.2, 0.93, "assumed: 1.5-2.2 m for the 1.86 m of Study A")},
               .reach = Reach::geometry,
               .idle_in = {Survey::coverage}},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
