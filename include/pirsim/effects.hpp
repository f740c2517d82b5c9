// Everything that a plain model is known to leave out: what it is called, what it does, how strong it may be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/random.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim::effects {

/// What a stage may know of the compiled study, of which nothing is kept beyond the making of the stage.
struct StageContext {
  const SceneSpec& scene;
  const SensingSpec& sensing;
  const RayBundle& clipped_rays;  ///< world frame, cut at the room
};

/// Changes which sensors trigger at a tick. A value behind a pointer: clone() goes on by itself from the same moment.
class TriggerStage {
 public:
  virtual ~TriggerStage() = default;
  [[nodiscard]] virtual std::unique_ptr<TriggerStage> clone() const = 0;
  /// Before tick 1 of a run: forgets everything. All randomness follows from these two.
  virtual void begin_run(std::uint64_t seed, std::uint32_t run) = 0;
  /// Somebody rose from a seat (index into the scene's) in the step to the tick that comes next.
  virtual void seat_left(std::size_t /*seat*/) {}
  /// Once a tick, from tick 1 on. triggers: (n_sensors) 1 where the sensor triggers at this tick, and at it alone.
  virtual void tick(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept = 0;
};

/// Changes finished rows: what a logger or a person keeping the books does to them.
class RowStage {
 public:
  virtual ~RowStage() = default;
  [[nodiscard]] virtual std::unique_ptr<RowStage> clone() const = 0;
  virtual void begin_run(std::uint64_t seed, std::uint32_t run) = 0;
  virtual void apply(Sample& row) noexcept = 0;
};

/// All stages of a study, a value; without stages it does nothing. Their order is the catalogue's, whatever the order
/// in the script; the same effect twice (for two sensors, say) acts in the script's order.
class Pipeline {
 public:
  Pipeline() = default;
  /// Only of effects that act here; the others are passed over. The names have been checked.
  Pipeline(std::span<const EffectSpec> effects, const StageContext& context);
  Pipeline(const Pipeline& other);
  Pipeline& operator=(const Pipeline& other);
  Pipeline(Pipeline&&) noexcept = default;
  Pipeline& operator=(Pipeline&&) noexcept = default;
  ~Pipeline() = default;

  void add(std::unique_ptr<TriggerStage> stage) { trigger_stages_.push_back(std::move(stage)); }
  void add(std::unique_ptr<RowStage> stage) { row_stages_.push_back(std::move(stage)); }
  [[nodiscard]] std::size_t size() const noexcept { return trigger_stages_.size() + row_stages_.size(); }

  void begin_run(std::uint64_t seed, std::uint32_t run);
  void seat_left(std::size_t seat);
  void tick(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept;
  void apply(Sample& row) noexcept;

 private:
  std::vector<std::unique_ptr<TriggerStage>> trigger_stages_;
  std::vector<std::unique_ptr<RowStage>> row_stages_;
};

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
  Role role = Role::strength;
  double off = 0.0;
  double typical = 0.0;            ///< what a script gets that doesn't say
  double low = 0.0, high = 0.0;    ///< the prior
  double least = 0.0, most = 0.0;  ///< what is accepted
  Scale scale = Scale::linear;
  std::string source;   ///< of the range: a paper, a data sheet, or `assumed`
  Condition only_if{};  ///< else it means nothing (a chair's back has no place of its own); empty: always
};
enum class ChoiceKind { sensor, mesh, word };
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

struct EffectInfo {
  std::string name;
  Family family = Family::data;
  std::string stage;        ///< where it acts: placement, body, optics, detector, environment, electronics, books
  std::string summary;      ///< one sentence
  std::string fingerprint;  ///< what it does to the data
  std::vector<std::string> confused_with{};  ///< other entries with a like fingerprint
  std::string same_as{};                     ///< another entry that changes the model in the same way; empty: none
  std::vector<ParameterInfo> parameters{};   ///< the first is the one that names its strength
  std::vector<ChoiceInfo> choices{};
  Reach reach = Reach::geometry;
};

/// One file of src/effects. Hooks get an EffectSpec with every parameter filled in; null where the effect doesn't act.
struct Effect {
  EffectInfo info;
  void (*alter)(SceneSpec& scene, ScriptSpec& script, const EffectSpec& effect) = nullptr;
  std::unique_ptr<TriggerStage> (*make_stage)(const EffectSpec& effect, const StageContext& context) = nullptr;
  std::unique_ptr<RowStage> (*make_row_stage)(const EffectSpec& effect, const StageContext& context) = nullptr;
  /// Puts what the ranges alone can't draw (a free place in the room) into a spec drawn from them.
  void (*draw)(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec& script, Stream& stream) = nullptr;
  /// Moves parameters that were estimated to what the room has a place for.
  void (*settle)(EffectSpec& effect, const SceneSpec& scene) = nullptr;
  /// Why it can't be meant so in this scene, though every name and number of the script is good; empty: it can.
  std::string (*fault)(const EffectSpec& effect, const SceneSpec& scene) = nullptr;
};

/// In the order in which they act; alter() first, then stages tick by tick, then rows.
[[nodiscard]] const std::vector<const Effect*>& catalogue();
/// Throws Error(usage) with the nearest name.
[[nodiscard]] const Effect& find(std::string_view name);

/// The entry that stands for it where data are judged: no data tell entries apart that are the same change of the
/// model.
[[nodiscard]] std::string judged_as(std::string_view name);
/// Names of the others that it stands for.
[[nodiscard]] std::vector<std::string> twins_of(std::string_view name);

/// Every unknown name, sensor or mesh and every value out of bounds. The first is without a scene: names and bounds.
void check(std::span<const EffectSpec> effects, Diagnostics& diagnostics);
void check(std::span<const EffectSpec> effects, const SceneSpec& scene, Diagnostics& diagnostics);

/// Applies alter() of script.effects, in the catalogue's order, to both. Throws Error(input) for what check() finds.
void alter(SceneSpec& scene, ScriptSpec& script);

/// Whether a parameter of that effect means anything with its choices.
[[nodiscard]] bool applies(const ParameterInfo& parameter, const EffectSpec& effect);
/// The first of an effect's strengths that applies.
[[nodiscard]] const ParameterInfo& strength_parameter(const EffectSpec& effect);
[[nodiscard]] bool is_off(const EffectSpec& effect);
/// With every parameter that applies: those not given take the typical value.
[[nodiscard]] EffectSpec resolved(const Effect& effect, EffectSpec spec);
[[nodiscard]] EffectSpec off(const Effect& effect);
/// Parameters that apply, from their priors; a sensor from all and each (even odds between `all` and one of them).
[[nodiscard]] EffectSpec draw_from_prior(const Effect& effect, const SceneSpec& scene, const ScriptSpec& script,
                                         Stream& stream);

/// An effect whose parameters were estimated, as this scene has room for it: somebody stands in a free place, no sensor
/// hangs in the ceiling.
[[nodiscard]] EffectSpec settled(EffectSpec effect, const SceneSpec& scene);

}  // namespace pirsim::effects
