// What happens to rows after they were logged.
// Assumed: whole rows or columns, whatever they hold.
// Method: stages that change finished rows. Sources: no measurement.
#include <algorithm>

#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

// dead_sensor: a sensor that says nothing any more, or less and less.

/// Loses each row's bit with one probability from a moment of the run on.
class DeadSensor final : public CloneableRowStage<DeadSensor> {
 public:
  DeadSensor(std::vector<std::uint32_t> sensors, double loss, double from_s)
      : sensors_(std::move(sensors)), loss_(loss), from_s_(from_s) {}

  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    streams_ = streams_of(sensors_, seed, run, Purpose::dead_sensor);
  }

  void apply(Sample& row) noexcept override {
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      const bool lost = streams_[i].uniform() < loss_;
      if (lost && row.time_s > from_s_) row.bits[sensors_[i]] = 0;
    }
  }

 private:
  std::vector<std::uint32_t> sensors_;
  double loss_;
  double from_s_;
  std::vector<Stream> streams_;
};

std::unique_ptr<RowStage> make_dead_sensor(const EffectSpec& effect, const StageContext& context) {
  return std::make_unique<DeadSensor>(sensors_of(effect, context.scene), effect.parameters.at("loss"),
                                      effect.parameters.at("from_s"));
}

void draw_dead_sensor(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream& stream) {
  effect.choices["sensor"] = scene.sensors[stream.index(static_cast<std::uint32_t>(scene.sensors.size()))].id;
}

Effect dead_sensor() {
  return {.info = {.name = "dead_sensor",
                   .family = Family::data,
                   .stage = "books",
                   .summary =
                       "A sensor's rows are lost: all (dead) or a share of them (dying), from a moment of the run on.",
                   .fingerprint = "one column empty or thinned, the others fit",
                   .confused_with = {"missed_triggers"},
                   .parameters = {{.name = "loss",
                                   .unit = "",
                                   .off = 0.0,
                                   .typical = 1.0,
                                   .low = 0.5,
                                   .high = 1.0,
                                   .least = 0.0,
                                   .most = 1.0,
                                   .source = "assumed"},
                                  {.name = "from_s",
                                   .unit = "s",
                                   .role = Role::detail,
                                   .off = 0.0,
                                   .typical = 0.0,
                                   .low = 0.0,
                                   .high = 120.0,
                                   .least = 0.0,
                                   .most = 1e7,
                                   .source = "assumed"}},
                   .choices = {sensor_choice()},
                   .reach = Reach::rows,
                   .idle_in = {Survey::walk_test}},
          .make_row_stage = make_dead_sensor,
          .draw = draw_dead_sensor};
}

// labels_swapped: two sensors' columns are swapped.

class SwapColumns final : public CloneableRowStage<SwapColumns> {
 public:
  SwapColumns(std::size_t a, std::size_t b) : a_(a), b_(b) {}
  void begin_run(std::uint64_t, std::uint32_t) override {}
  void apply(Sample& row) noexcept override { std::swap(row.bits[a_], row.bits[b_]); }

 private:
  std::size_t a_, b_;
};

std::size_t sensor_index(const EffectSpec& effect, const std::string& choice, std::size_t otherwise,
                         const SceneSpec& scene) {
  const auto named = effect.choices.find(choice);
  if (named == effect.choices.end()) return std::min(otherwise, scene.sensors.size() - 1);
  const auto sensor = std::ranges::find(scene.sensors, named->second, &SensorSpec::id);
  return static_cast<std::size_t>(sensor - scene.sensors.begin());
}

std::unique_ptr<RowStage> make_labels_swapped(const EffectSpec& effect, const StageContext& context) {
  return std::make_unique<SwapColumns>(sensor_index(effect, "sensor", 0, context.scene),
                                       sensor_index(effect, "other", 1, context.scene));
}

/// In a room with one sensor there is no other to name.
std::string fault_labels_swapped(const EffectSpec& effect, const SceneSpec& scene) {
  const std::size_t n = scene.sensors.size(), a = sensor_index(effect, "sensor", 0, scene);
  if (n < 2 || a >= n || a != sensor_index(effect, "other", 1, scene)) return "";
  return "sensor and other are both '" + scene.sensors[a].id + "': nothing would be swapped";
}

void draw_labels_swapped(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream& stream) {
  const auto n = static_cast<std::uint32_t>(scene.sensors.size());
  const std::uint32_t a = stream.index(n);
  const std::uint32_t b = (a + 1 + stream.index(std::max(1U, n - 1))) % n;
  effect.choices["sensor"] = scene.sensors[a].id;
  effect.choices["other"] = scene.sensors[b].id;
}

Effect labels_swapped() {
  return {.info = {.name = "labels_swapped",
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
          .make_row_stage = make_labels_swapped,
          .draw = draw_labels_swapped,
          .fault = fault_labels_swapped};
}

}  // namespace

std::vector<Effect> books_effects() { return {dead_sensor(), labels_swapped()}; }

}  // namespace pirsim::effects
