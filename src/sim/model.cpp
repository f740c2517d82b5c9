#include "sim/model.hpp"

#include <mutex>
#include <utility>

#include "pir/optics.hpp"
#include "pirsim/effects.hpp"
#include "sim/alike.hpp"
#include "sim/lookout.hpp"
#include "sim/plan_people.hpp"
#include "sim/reflections.hpp"

namespace pirsim {

bool PersonModel::can_stand(const Vec2& place, const Vec2& facing, double half_depth_m) const noexcept {
  const double radius_m = humanoid.clearance_radius_m();
  if (half_depth_m >= radius_m) return floor->walkable(place);
  const Vec2 aside = (radius_m - half_depth_m) * Vec2(-facing.y, facing.x);
  return floor->has_room(place - aside, place + aside, half_depth_m);
}

std::uint32_t Model::n_runs() const noexcept {
  return static_cast<std::uint32_t>(trials().size()) * static_cast<std::uint32_t>(script_.replicates);
}

std::vector<std::string> Model::columns() const {
  std::vector<std::string> names{"replicate", "trial", "time_s", "phase", "people"};
  for (const SensorSpec& sensor : scene_.sensors) names.push_back(sensor.id);
  return names;
}

struct Model::Pool {
  std::mutex mutex;
  std::vector<std::unique_ptr<sim::Lookout>> idle;
};

std::unique_ptr<rt::Tracer> Model::make_tracer() const {
  return rt::make_tracer(tracer_, {room_.get(), rated_.get(), clipped_.get()});
}

std::unique_ptr<rt::Tracer> Model::make_power_tracer() const {
  return rt::make_tracer(tracer_, {room_.get(), &analog_->power().rays().bundle, &analog_->power().clipped()});
}

std::shared_ptr<sim::Lookout> Model::borrow_lookout() const {
  std::unique_ptr<sim::Lookout> lookout;
  {
    const std::lock_guard lock(idle_lookouts_->mutex);
    if (!idle_lookouts_->idle.empty()) {
      lookout = std::move(idle_lookouts_->idle.back());
      idle_lookouts_->idle.pop_back();
    }
  }
  if (!lookout) lookout = std::make_unique<sim::Lookout>(*this);
  return {lookout.release(), [pool = std::weak_ptr(idle_lookouts_)](sim::Lookout* used) {
            std::unique_ptr<sim::Lookout> back(used);
            if (const auto open = pool.lock()) {
              const std::lock_guard lock(open->mutex);
              open->idle.push_back(std::move(back));
            }
          }};
}

Model compile(SceneSpec scene, ScriptSpec script, const CompileOptions& options) {
  Model model;
  model.scene_ = std::move(scene);
  model.script_ = std::move(script);
  ScriptSpec altered = model.script_;
  effects::alter(model.scene_, altered);
  model.tracer_ = options.tracer;
  model.idle_lookouts_ = std::make_shared<Model::Pool>();
  const Model* like = options.like;
  model.room_ = like != nullptr && sim::same_meshes(like->scene(), model.scene_)
                    ? like->room_
                    : std::make_shared<const rt::Room>(model.scene_.meshes);
  model.rated_ = std::make_unique<RayBundle>();
  const std::vector<double> levels = pir::edge_levels(altered.sensing.edge_sigma_deg);
  for (const SensorSpec& sensor : model.scene_.sensors) {
    pir::append(*model.rated_, sensor, model.scene_.sensor_models.at(sensor.model), altered.sensing.rays_per_zone,
                levels);
  }
  sim::add_reflections(*model.rated_, *model.room_, model.scene_.meshes, altered.sensing.reflections);
  model.clipped_ = std::make_unique<RayBundle>(*model.rated_);
  model.room_->clip(*model.clipped_);
  model.detector_ = std::make_unique<pir::MotionDetector>(*model.rated_, altered.sensing.change_per);
  model.edge_draw_ = pir::EdgeDraw(*model.detector_, levels.size(), altered.sensing.ticks_per_window);
  if (altered.sensing.dual_polarity) {
    model.polarity_.emplace(model.scene_, *altered.sensing.dual_polarity, levels.size(), model.tick_s());
  }
  model.pipeline_ = effects::Pipeline(model.script_.effects, {model.scene_, altered.sensing, *model.clipped_});
  model.trials_ = like != nullptr && sim::same_people(*like, model.scene_, altered, model.script_)
                      ? like->trials_
                      : std::make_shared<const std::vector<TrialModel>>(
                            sim::plan_people(model.scene_, altered, model.script_, *model.room_, like));
  if (sim::AnalogModel::is_needed(model.scene_, altered.sensing)) {
    model.analog_ = std::make_unique<sim::AnalogModel>(model.scene_, altered.sensing, *model.room_);
  }
  return model;
}

}  // namespace pirsim
