// What the files of effects share, and the catalogue's entries.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "engine/effects/catalogue.hpp"
#include "model/schema/actions.hpp"
#include "pirsim/scene.hpp"

namespace pirsim::effects {

// The catalogue's entries by group, a file each: in the order in which they act.

[[nodiscard]] std::vector<Effect> room_effects();
[[nodiscard]] std::vector<Effect> people_effects();
[[nodiscard]] std::vector<Effect> mounting_effects();
[[nodiscard]] std::vector<Effect> motion_effects();
[[nodiscard]] std::vector<Effect> lens_effects();
[[nodiscard]] std::vector<Effect> environment_effects();
[[nodiscard]] std::vector<Effect> electronics_effects();
[[nodiscard]] std::vector<Effect> books_effects();

// Short forms of parameters that many effects have alike.

/// A factor on what the model has; 1 is off.
[[nodiscard]] inline ParameterInfo factor(std::string name, double low, double high, double typical,
                                          std::string source) {
  return {.name = std::move(name),
          .unit = "",
          .off = 1.0,
          .typical = typical,
          .low = low,
          .high = high,
          .least = 0.05,
          .most = 20.0,
          .scale = Scale::logarithmic,
          .source = std::move(source)};
}

/// Something to either side of what the model has; 0 is off.
[[nodiscard]] inline ParameterInfo offset(std::string name, std::string unit, double reach, double typical, double most,
                                          std::string source) {
  return {.name = std::move(name),
          .unit = std::move(unit),
          .off = 0.0,
          .typical = typical,
          .low = -reach,
          .high = reach,
          .least = -most,
          .most = most,
          .source = std::move(source)};
}

/// An amount; 0 is off, and the least that is accepted.
[[nodiscard]] inline ParameterInfo strength(std::string name, std::string unit, double typical, double low, double high,
                                            double most, std::string source, Condition only_if = {}) {
  return {.name = std::move(name),
          .unit = std::move(unit),
          .typical = typical,
          .low = low,
          .high = high,
          .most = most,
          .source = std::move(source),
          .only_if = std::move(only_if)};
}

/// How something happens, without an off of its own; all in `unit`.
[[nodiscard]] inline ParameterInfo detail(std::string name, std::string unit, double typical, double low, double high,
                                          double least, double most, std::string source, Condition only_if = {}) {
  return {.name = std::move(name),
          .unit = std::move(unit),
          .role = Role::detail,
          .off = typical,
          .typical = typical,
          .low = low,
          .high = high,
          .least = least,
          .most = most,
          .source = std::move(source),
          .only_if = std::move(only_if)};
}

/// The same, with words for a reader.
[[nodiscard]] inline ParameterInfo told_as(std::string phrase, ParameterInfo parameter) {
  parameter.phrase = std::move(phrase);
  return parameter;
}

/// The same, with a prior that spreads by factors.
[[nodiscard]] inline ParameterInfo logarithmic(ParameterInfo parameter) {
  parameter.scale = Scale::logarithmic;
  return parameter;
}

/// Of a place that is given, x_m or z_m.
[[nodiscard]] inline ParameterInfo floor_coordinate(std::string name, Condition only_if) {
  return detail(std::move(name), "m", 0.0, -50.0, 50.0, -1e4, 1e4, "assumed: a free place", std::move(only_if));
}

/// Happens (1) or not (0).
[[nodiscard]] inline ParameterInfo whether(std::string name, std::string source) {
  return {.name = std::move(name),
          .unit = "",
          .off = 0.0,
          .typical = 1.0,
          .low = 1.0,
          .high = 1.0,
          .least = 0.0,
          .most = 1.0,
          .scale = Scale::whole,
          .source = std::move(source)};
}

/// What was chosen, or the default.
[[nodiscard]] std::string word(const EffectSpec& effect, std::string_view choice);

/// One of the scene's sensors, or all.
[[nodiscard]] ChoiceInfo sensor_choice();

/// Whether a chance stays, or grows in the course of the study.
[[nodiscard]] ChoiceInfo trend_choice();

/// For Effect::draw: a trend is told from chance over fewest_runs_of_a_trend runs or more. In a shorter study the
/// effect is drawn steady.
inline constexpr std::size_t fewest_runs_of_a_trend = 5;  // assumed; of 3 runs, trends were 6 of 26 wrong names
void draw_trend(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec& script, Stream& stream);

/// What a chance is in each run of a study.
class Trend {
 public:
  Trend(const EffectSpec& effect, const StageContext& context);
  /// Steady: `mean`. Growing: from run to run in equal steps, so that `mean` is the mean over all runs.
  [[nodiscard]] double in_run(double mean, std::uint32_t run) const noexcept;
  /// The same of a chance: what would exceed 1 is 1.
  [[nodiscard]] double chance(double mean, std::uint32_t run) const noexcept {
    return std::min(1.0, in_run(mean, run));
  }

 private:
  enum class Kind { steady, growing } kind_;
  std::uint32_t n_runs_;
};

/// Indices of the sensors that an effect is for: the one named, or all.
[[nodiscard]] std::vector<std::uint32_t> sensors_of(const EffectSpec& effect, const SceneSpec& scene);

/// change(SensorSpec&) for those of the sensors that an effect is for.
template <typename Change>
void for_each_sensor(StudyInForce& study, const EffectSpec& effect, const Change& change) {
  for (const std::uint32_t i : sensors_of(effect, study.scene)) change(study.scene.sensors[i]);
}

/// One stream a sensor of `sensors`, at its beginning for this run.
[[nodiscard]] std::vector<Stream> streams_of(const std::vector<std::uint32_t>& sensors, std::uint64_t seed,
                                             std::uint32_t run, Purpose purpose);

/// Ticks to the next event of a Poisson process, at least 1: its chance in each tick is 1 - exp(-mean), mean > 0.
[[nodiscard]] std::int64_t ticks_to_event(Stream& stream, double mean_per_tick) noexcept;

/// change(PersonInForce&) for everybody of the script and whoever effects added, but for objects.
template <typename Change>
void for_each_person(StudyInForce& study, const Change& change) {
  for (TrialInForce& trial : study.trials) {
    for (PersonInForce& person : trial.people) {
      if (person.changes.role != PersonRole::object) change(person);
    }
  }
}

/// change(action::Work&) for whatever anybody does at a seat.
template <typename Change>
void for_each_work(StudyInForce& study, const Change& change) {
  for_each_person(study, [&](PersonInForce& person) { for_each<action::Work>(person, change); });
}

/// clone() by copying.
template <typename Stage>
class CloneableTriggerStage : public TriggerStage {
 public:
  [[nodiscard]] std::unique_ptr<TriggerStage> clone() const override {
    return std::make_unique<Stage>(static_cast<const Stage&>(*this));
  }
};
template <typename Stage>
class CloneableRowStage : public RowStage {
 public:
  [[nodiscard]] std::unique_ptr<RowStage> clone() const override {
    return std::make_unique<Stage>(static_cast<const Stage&>(*this));
  }
};

// Where in a room something more has its place.

/// Points of a grid on the floor with `clear_m` to everything solid below a person's height, to seats and to
/// entrances; the one farthest from all seats first. Empty in a room without such a place.
[[nodiscard]] std::vector<Vec2> free_places(const SceneSpec& scene, double clear_m);
/// Draws one of them into x_m and z_m; false if there is none.
[[nodiscard]] bool draw_free_place(EffectSpec& effect, const SceneSpec& scene, double clear_m, Stream& stream);
/// Moves x_m and z_m to nearest_free().
void settle_free_place(EffectSpec& effect, const SceneSpec& scene, double clear_m);
/// The place itself if it is within a cell of the grid of a free one, else the nearest of these; the place if none is.
[[nodiscard]] Vec2 nearest_free(const SceneSpec& scene, double clear_m, const Vec2& place);

}  // namespace pirsim::effects
