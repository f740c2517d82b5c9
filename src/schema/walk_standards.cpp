// Walk tests after standards. What was read of each, and what is assumed: docs/formats/coverage.md.
#include "pirsim/error.hpp"
#include "pirsim/survey.hpp"

namespace pirsim {
namespace {

/// Ref: [NEMAWD7], as [NEMAWD7Tested] has it. Where no number was found, it is `assumed`.
WalkTestSpec nema_wd7() {
  WalkTestSpec spec;
  spec.name = "NEMA WD 7";
  spec.standard = WalkStandard::nema_wd7;
  spec.spacing_m = 0.9144;                 // 3 ft
  spec.person.stature_m = 1.70;            // 5 ft 3 in to 5 ft 11 in: the middle
  spec.person.mass_kg = 75.0;              // at most 190 lb (86 kg); assumed within
  spec.person.walking_speed_m_s = 1.2192;  // 4 ft/s
  spec.path_m = spec.spacing_m;
  spec.stop_s = 2.0;
  spec.major = {spec.major.within_s, 1.0, 4};  // assumed: from each side of the cell, and every time noticed
  spec.minor = {4.0, 0.5, 4};                  // assumed: 2 s of swinging and 2 s more; half of the swings noticed
  spec.arm = SwingingArmSpec{};
  return spec;
}

}  // namespace

WalkTestSpec walk_test_after(WalkStandard standard) {
  switch (standard) {
    case WalkStandard::nema_wd7:
      return nema_wd7();
  }
  throw Error(ErrorCode::internal, "unknown standard of a walk test");
}

}  // namespace pirsim
