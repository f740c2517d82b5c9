// A sensor that says nothing any more, or less and less.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

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

std::unique_ptr<RowStage> make(const EffectSpec& effect, const StageContext& context) {
  return std::make_unique<DeadSensor>(sensors_of(effect, context.scene), effect.parameters.at("loss"),
                                      effect.parameters.at("from_s"));
}

void draw(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream& stream) {
  effect.choices["sensor"] = scene.sensors[stream.index(static_cast<std::uint32_t>(scene.sensors.size()))].id;
}

}  // namespace

const Effect& dead_sensor() {
  static const Effect effect{
      .info = {.name = "dead_sensor",
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
      .make_row_stage = make,
      .draw = draw};
  return effect;
}

}  // namespace pirsim::effects
