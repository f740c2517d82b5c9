// What a plain model is known to leave out: what each effect is called, what it does, how strong it may be.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim::effects {

enum class Scale { linear, logarithmic, whole };  ///< how a prior spreads over its range; whole: whole numbers
enum class Role {
  strength,  ///< with all of these at `off` nothing happens, bit for bit
  detail     ///< how it happens; has no off of its own (`off` repeats `typical`)
};
/// That choice has that word, in the script or because it says nothing.
struct Condition {
  std::string choice, word;
};
struct ParameterInfo {
  std::string name;  ///< with unit suffix
  std::string unit;  ///< "" for a pure number
  /// For a reader, where the name without its unit doesn't say it: "probability of a miss".
  std::string phrase{};
  Role role = Role::strength;
  double off = 0.0;
  double typical = 0.0;            ///< what a script gets that doesn't say
  double low = 0.0, high = 0.0;    ///< the prior
  double least = 0.0, most = 0.0;  ///< what is accepted
  Scale scale = Scale::linear;
  std::string source;   ///< of the range: a paper, a data sheet, or `assumed`
  Condition only_if{};  ///< else it means nothing (a chair's back has no place of its own); empty: always

  /// Of an angle: all directions are thought of, so that the range has no end.
  [[nodiscard]] bool goes_round() const { return unit == "deg" && high - low >= 360.0; }
};
enum class ChoiceKind {
  sensor,
  mesh,
  word,
  variant  ///< a word that says how the same cause is modelled
};
[[nodiscard]] constexpr bool is_word(ChoiceKind kind) noexcept {
  return kind == ChoiceKind::word || kind == ChoiceKind::variant;
}
struct ChoiceInfo {
  std::string name;
  ChoiceKind kind = ChoiceKind::word;
  std::vector<std::string> words;  ///< of a word; the first is the default
  std::string otherwise;           ///< what happens if the script doesn't say
};

enum class Family { optics, person, mounting, occlusion, electronics, environment, motion, data };
/// What must be computed anew when the effect changes.
enum class Reach {
  geometry,  ///< people or rays differ: must be traced again
  triggers,  ///< acts tick by tick on what remembered zones trigger
  rows       ///< acts on finished rows
};
[[nodiscard]] std::string_view name(Family family) noexcept;
[[nodiscard]] std::string_view name(Reach reach) noexcept;
[[nodiscard]] std::string_view name(Scale scale) noexcept;

enum class ActsOn {
  all_sensors,
  zone_sensors  ///< does nothing to sensors whose response is analog
};
/// What a script must have for the effect to change anything.
enum class Needs { nothing, counts };
/// Studies that move a target of their own instead of a script's people.
enum class Survey { coverage, walk_test };
[[nodiscard]] std::string_view name(Survey survey) noexcept;  ///< "coverage study", "walk test"

struct EffectInfo {
  std::string name;
  Family family = Family::data;
  std::string stage;        ///< where it acts: placement, body, optics, detector, environment, electronics, books
  std::string summary;      ///< one sentence
  std::string fingerprint;  ///< what it does to the data
  /// Of a fault of the data, and of no other effect: "The data look as if " and this.
  std::string as_if{};
  std::vector<std::string> confused_with{};  ///< other entries with a like fingerprint
  std::string same_as{};                     ///< another entry that changes the model in the same way; empty: none
  std::vector<ParameterInfo> parameters{};   ///< the first is the one that names its strength
  std::vector<ChoiceInfo> choices{};
  Reach reach = Reach::geometry;
  /// Sensors of which response it acts on: of zones, or of both.
  ActsOn acts_on = ActsOn::all_sensors;
  std::string in_analog{};  ///< what it is with the analog response, as the end of a sentence; empty: just the same
  Needs needs = Needs::nothing;
  std::vector<Survey> idle_in{};  ///< those that it changes nothing in: they lack the people or the rows it acts on
};

/// All entries of the catalogue, in the order in which they act.
[[nodiscard]] std::vector<EffectInfo> list();
/// Throws Error(usage) with the nearest name.
[[nodiscard]] const EffectInfo& info(std::string_view name);

/// Every unknown name, sensor or mesh and every value out of bounds. The first is without a scene: names and bounds.
void check(std::span<const EffectSpec> effects, Diagnostics& diagnostics);
void check(std::span<const EffectSpec> effects, const SceneSpec& scene, Diagnostics& diagnostics);

/// A warning for each effect that changes nothing here, since it acts on a response (zones or analog) that none of its
/// sensors has. The effects have been checked.
[[nodiscard]] std::vector<Issue> idle(std::span<const EffectSpec> effects, const SceneSpec& scene,
                                      const SensingSpec& sensing);

}  // namespace pirsim::effects
