#include "sim/compiled_study.hpp"

#include <cmath>
#include <utility>

#include "effects/catalogue.hpp"
#include "sim/alike.hpp"
#include "sim/plan_people.hpp"

namespace pirsim::sim {

bool PersonModel::can_stand(const Vec2& place, const Vec2& facing, double half_depth_m) const noexcept {
  const double radius_m = humanoid.clearance_radius_m();
  if (half_depth_m >= radius_m) return floor->walkable(place);
  const Vec2 aside = (radius_m - half_depth_m) * Vec2(-facing.y, facing.x);
  return floor->has_room(place - aside, place + aside, half_depth_m);
}

std::uint32_t CompiledStudy::n_runs() const noexcept {
  return static_cast<std::uint32_t>(trials().size()) * static_cast<std::uint32_t>(script_given_.replicates);
}

std::optional<RunClock> CompiledStudy::clock_of(std::uint32_t run) const noexcept {
  std::optional<RunClock> clock = trial_of(run).clock;
  constexpr std::int64_t day_s = 86400;
  if (trial_of(run).schedule) clock->begin_s += day_s * (replicate_of(run) - 1);
  const std::vector<double>& begins_s = trial_of(run).begins_s;
  if (clock && !begins_s.empty()) clock->begin_s += std::llround(data_second_of(run) - begins_s.front());
  return clock;
}

double CompiledStudy::data_second_of(std::uint32_t run) const noexcept {
  const std::vector<double>& begins_s = trial_of(run).begins_s;
  return begins_s[static_cast<std::size_t>(replicate_of(run) - 1) % begins_s.size()];
}

CompiledStudy::CompiledStudy(SceneSpec scene, ScriptSpec script, TracerKind tracer, const CompiledStudy* like)
    : CompiledStudy(scene, script, effects::in_force(scene, script), tracer, like) {}

CompiledStudy::CompiledStudy(SceneSpec scene, ScriptSpec script, StudyInForce study, TracerKind tracer,
                             const CompiledStudy* like)
    : scene_given_(std::move(scene)),
      script_given_(std::move(script)),
      scene_(std::move(study.scene)),
      areas_(scene_),
      sensing_(std::move(study.sensing)),
      seed_(study.seed),
      tracer_(tracer) {
  const auto room = like != nullptr && same_meshes(like->scene(), scene_)
                        ? like->array().shared_room()
                        : std::make_shared<const rt::Room>(scene_.meshes);
  array_ = std::make_unique<const SensorArray>(scene_, sensing_, room, like != nullptr ? &like->array() : nullptr);
  trials_ = like != nullptr && same_people(*like, *this, study.trials)
                ? like->trials_
                : std::make_shared<const std::vector<TrialModel>>(plan_people(*this, study.trials, like));
  stages_ = effects::Pipeline(script_given_.effects, {scene_, sensing_, array_->clipped(), n_runs()});
}

}  // namespace pirsim::sim
