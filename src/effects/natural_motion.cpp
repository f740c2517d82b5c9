// People don't keep to the choreography: they move as people do.
#include <algorithm>
#include <array>
#include <utility>

#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

constexpr std::array<std::pair<const char*, Activity>, 4> activities{{{"typing", Activity::typing},
                                                                      {"reading", Activity::reading},
                                                                      {"meeting", Activity::meeting},
                                                                      {"phone", Activity::phone}}};

std::vector<std::string> activity_names() {
  std::vector<std::string> names;
  for (const auto& [name, activity] : activities) names.emplace_back(name);
  return names;
}

void alter(StudyInForce& study, const EffectSpec& effect) {
  const std::string name = word(effect, "activity");
  const Activity activity = std::ranges::find(activities, name, [](const auto& a) { return a.first; })->second;
  for (TrialInForce& trial : study.trials) {
    for (PersonInForce& person : trial.people) person.style = MotionStyle::natural;
  }
  for_each_work(study, [&](action::Work& work) { work.activity = activity; });
}

}  // namespace

const Effect& natural_motion() {
  static const Effect effect{
      .info =
          {.name = "natural_motion",
           .family = Family::motion,
           .stage = "body",
           .summary =
               "Who sits, stands or walks moves naturally instead of by the paper's choreography: still, then moving, "
               "at all scales of time.",
           .fingerprint = "the arms' line in the spectrum is gone; activity comes in bouts of all lengths",
           .confused_with = {"fidgeting", "uneven_arms", "soft_zone_edges"},
           .parameters = {whether("present", "assumed")},
           .choices = {{"activity", ChoiceKind::variant, activity_names(), "typing"}},
           .reach = Reach::geometry,
           .sought = Sought::not_yet},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
