#include "pirsim/sim/model.hpp"

#include <mutex>
#include <utility>

#include "pirsim/pir/optics.hpp"
#include "sim/plan_people.hpp"

namespace pirsim {

std::uint32_t Model::n_runs() const noexcept {
  return static_cast<std::uint32_t>(trials_.size()) * static_cast<std::uint32_t>(script_.replicates);
}

std::vector<std::string> Model::columns() const {
  std::vector<std::string> names{"replicate", "trial", "time_s", "phase", "people"};
  for (const SensorSpec& sensor : scene_.sensors) names.push_back(sensor.id);
  return names;
}

struct Model::TracerPool {
  std::mutex mutex;
  std::vector<std::unique_ptr<rt::Tracer>> idle;
};

std::shared_ptr<rt::Tracer> Model::borrow_tracer() const {
  std::unique_ptr<rt::Tracer> tracer;
  {
    const std::lock_guard lock(idle_tracers_->mutex);
    if (!idle_tracers_->idle.empty()) {
      tracer = std::move(idle_tracers_->idle.back());
      idle_tracers_->idle.pop_back();
    }
  }
  if (!tracer) tracer = rt::make_tracer(tracer_, {room_.get(), rated_.get(), clipped_.get()});
  return {tracer.release(), [pool = idle_tracers_](rt::Tracer* used) {
            const std::lock_guard lock(pool->mutex);
            pool->idle.emplace_back(used);
          }};
}

Model compile(SceneSpec scene, ScriptSpec script, const CompileOptions& options) {
  Model model;
  model.scene_ = std::move(scene);
  model.script_ = std::move(script);
  model.tracer_ = options.tracer;
  model.idle_tracers_ = std::make_shared<Model::TracerPool>();
  model.room_ = std::make_unique<rt::Room>(model.scene_.meshes);
  model.rated_ = std::make_unique<RayBundle>();
  for (const SensorSpec& sensor : model.scene_.sensors) {
    pir::append(*model.rated_, sensor, model.scene_.sensor_models.at(sensor.model), model.script_.sensing.rays_per_zone);
  }
  model.clipped_ = std::make_unique<RayBundle>(*model.rated_);
  model.room_->clip(*model.clipped_);
  model.trials_ = sim::plan_people(model.scene_, model.script_, *model.room_);
  return model;
}

}  // namespace pirsim
