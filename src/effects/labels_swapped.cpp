// Two sensors' columns are swapped.
#include <algorithm>

#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

class SwapColumns final : public CloneableRowStage<SwapColumns> {
 public:
  SwapColumns(std::size_t a, std::size_t b) : a_(a), b_(b) {}
  void begin_run(std::uint64_t, std::uint32_t) override {}
  void apply(Sample& row) noexcept override { std::swap(row.bits[a_], row.bits[b_]); }

 private:
  std::size_t a_, b_;
};

std::size_t index_of(const EffectSpec& effect, const std::string& choice, std::size_t otherwise,
                     const SceneSpec& scene) {
  const auto named = effect.choices.find(choice);
  if (named == effect.choices.end()) return std::min(otherwise, scene.sensors.size() - 1);
  const auto sensor = std::ranges::find(scene.sensors, named->second, &SensorSpec::id);
  return static_cast<std::size_t>(sensor - scene.sensors.begin());
}

std::unique_ptr<RowStage> make(const EffectSpec& effect, const StageContext& context) {
  return std::make_unique<SwapColumns>(index_of(effect, "sensor", 0, context.scene),
                                       index_of(effect, "other", 1, context.scene));
}

/// In a room with one sensor there is no other to name.
std::string fault(const EffectSpec& effect, const SceneSpec& scene) {
  const std::size_t n = scene.sensors.size(), a = index_of(effect, "sensor", 0, scene);
  if (n < 2 || a >= n || a != index_of(effect, "other", 1, scene)) return "";
  return "sensor and other are both '" + scene.sensors[a].id + "': nothing would be swapped";
}

void draw(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream& stream) {
  const auto n = static_cast<std::uint32_t>(scene.sensors.size());
  const std::uint32_t a = stream.index(n);
  const std::uint32_t b = (a + 1 + stream.index(std::max(1U, n - 1))) % n;
  effect.choices["sensor"] = scene.sensors[a].id;
  effect.choices["other"] = scene.sensors[b].id;
}

}  // namespace

const Effect& labels_swapped() {
  static const Effect effect{
      .info = {.name = "labels_swapped",
               .family = Family::data,
               .stage = "books",
               .summary = "The columns of two sensors are swapped.",
               .fingerprint = "two columns of the table of sums are permuted, everything else fits",
               .confused_with = {"mirrored_room"},
               .parameters = {whether("swapped", "assumed: any two sensors")},
               .choices = {{"sensor", ChoiceKind::sensor, {}, "the first sensor"},
                           {"other", ChoiceKind::sensor, {}, "the second sensor"}},
               .reach = Reach::rows,
               .idle_in = {Survey::walk_test}},
      .make_row_stage = make,
      .draw = draw,
      .fault = fault};
  return effect;
}

}  // namespace pirsim::effects
