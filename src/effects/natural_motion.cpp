// People don't keep to the choreography: they move as people do.
#include <algorithm>
#include <string>
#include <vector>

#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

/// What one does at a desk.
std::vector<std::string> activities() { return {activity_names.begin(), activity_names.begin() + 4}; }

void alter(StudyInForce& study, const EffectSpec& effect) {
  const auto which = std::ranges::find(activity_names, word(effect, "activity")) - activity_names.begin();
  for_each_person(study, [](PersonInForce& person) { person.style = MotionStyle::natural; });
  for_each_work(study, [&](action::Work& work) { work.activity = static_cast<Activity>(which); });
}

}  // namespace

const Effect& natural_motion() {
  static const Effect effect{
      .info = {.name = "natural_motion",
               .family = Family::motion,
               .stage = "body",
               .summary = "Everybody moves naturally instead of by the paper's choreography: still, then moving, "
                          "at all scales of time.",
               .fingerprint = "the arms' line in the spectrum is gone; activity comes in bouts of all lengths",
               .confused_with = {"fidgeting", "uneven_arms", "soft_zone_edges"},
               .parameters = {whether("present", "assumed")},
               .choices = {{"activity", ChoiceKind::variant, activities(), "typing"}},
               .reach = Reach::geometry,
               .idle_in = {Survey::coverage, Survey::walk_test}},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
