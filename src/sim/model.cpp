#include "pirsim/model.hpp"

#include <algorithm>
#include <utility>

#include "pirsim/columns.hpp"
#include "sim/compiled_study.hpp"

namespace pirsim {

const SceneSpec& Model::scene() const noexcept { return compiled_->scene_given(); }
const ScriptSpec& Model::script() const noexcept { return compiled_->script_given(); }
std::uint32_t Model::n_runs() const noexcept { return compiled_->n_runs(); }
const std::string& Model::trial_of(std::uint32_t run) const noexcept { return compiled_->trial_of(run).id; }
int Model::replicate_of(std::uint32_t run) const noexcept { return compiled_->replicate_of(run); }
double Model::tick_s() const noexcept { return compiled_->tick_s(); }
const RayBundle& Model::rays() const noexcept { return compiled_->array().clipped(); }

std::vector<std::string> Model::columns() const {
  const bool has_clock =
      std::ranges::any_of(compiled_->trials(), [](const sim::TrialModel& trial) { return trial.clock.has_value(); });
  ColumnOwners owners{.areas = areas()};
  for (const DoorSpec& door : scene().doors) owners.doors.push_back(door.id);
  for (const SensorSpec& sensor : scene().sensors) owners.sensors.push_back(sensor.id);
  return column_names<Sample>(owners, [&](When when) { return when != When::with_clock || has_clock; });
}

const std::vector<std::string>& Model::areas() const noexcept { return compiled_->areas().names(); }

Model compile(SceneSpec scene, ScriptSpec script, const CompileOptions& options) {
  const sim::CompiledStudy* like = options.like != nullptr ? &options.like->compiled() : nullptr;
  return Model(std::make_shared<const sim::CompiledStudy>(std::move(scene), std::move(script), options.tracer, like));
}

}  // namespace pirsim
