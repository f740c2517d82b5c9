#include "engine/sim/compiled_study.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "engine/body/skeleton.hpp"
#include "engine/effects/catalogue.hpp"
#include "engine/pir/calibration.hpp"
#include "engine/pir/optics.hpp"
#include "engine/sim/plan_people.hpp"
#include "engine/sim/thermal_array.hpp"
#include "model/schema/fields.hpp"
#include "model/schema/limits.hpp"
#include "pirsim/error.hpp"
#include "pirsim/response.hpp"

namespace pirsim::sim {

namespace {

/// Of all facets, each once, in ascending order.
std::vector<int> lens_steps(const SensorModelSpec& model) {
  std::set<int> steps;
  for (const ClusterSpec& cluster : model.clusters) steps.insert(cluster.lens_step);
  return {steps.begin(), steps.end()};
}

CalibratedSensor calibrated(const SensorModelSpec& model, double tick_s) {
  const pir::Calibration calibration = pir::calibrate(model);
  const double gain = calibration.volts_per_watt;
  CalibratedSensor sensor{
      model, tick_s, 1.0, {model.detector, gain, tick_s}, {pir::without_noise(model.detector), gain, tick_s}, {}, {}};
  for (const auto& [step, aperture_m2] : calibration.apertures_m2)
    sensor.rated_watts_per_step.push_back(aperture_m2 / pir::aperture_m2(model.optics) * watts_per_step);
  return sensor;
}

using Sensors = std::vector<std::shared_ptr<const CalibratedSensor>>;

/// As one of these, or as a sensor of the other model, if there is one of the make.
std::shared_ptr<const CalibratedSensor> with_gain(const SensorModelSpec& model, double tick_s, double gain,
                                                  const Sensors& own, const AnalogModel* like) {
  std::shared_ptr<const CalibratedSensor> of_make;
  const auto look_in = [&](const Sensors& sensors) {
    for (const auto& known : sensors) {
      if (known == nullptr || known->tick_s != tick_s || !same(known->model, model)) continue;
      if (of_make == nullptr || known->gain == gain) of_make = known;
      if (known->gain == gain) return;
    }
  };
  if (like != nullptr) look_in(like->sensors());
  if (of_make == nullptr || of_make->gain != gain) look_in(own);
  if (of_make != nullptr && of_make->gain == gain) return of_make;
  CalibratedSensor sensor = of_make != nullptr ? *of_make : calibrated(model, tick_s);
  sensor.gain = gain;
  sensor.watts_per_step.clear();
  for (const double watts : sensor.rated_watts_per_step) sensor.watts_per_step.push_back(watts * gain);
  return std::make_shared<const CalibratedSensor>(std::move(sensor));
}

struct Continuation {
  Ray ray;
  float range = 0.0F;
};

/// A direction turned by normal angles about two axes across it; the same for that ray in every run.
Vec3f scattered(const Vec3f& direction, double spread_rad, std::uint32_t ray) {
  if (spread_rad <= 0.0) return direction;
  Stream stream({0, 0, ray, Purpose::rough_surface});
  const Vec3f across =
      glm::normalize(glm::cross(direction, std::abs(direction.y) < 0.9F ? Vec3f(0, 1, 0) : Vec3f(1, 0, 0)));
  const auto right = static_cast<float>(spread_rad * stream.normal());
  const auto up = static_cast<float>(spread_rad * stream.normal());
  return glm::normalize(direction + right * across + up * glm::cross(direction, across));
}

std::optional<Continuation> mirrored(const Ray& ray, float range, const rt::Room& room,
                                     std::span<const ReflectionSpec* const> finishes, std::uint32_t index) {
  const auto hit = room.first_hit(ray, range);
  const ReflectionSpec* finish = hit ? finishes[hit->mesh] : nullptr;
  if (finish == nullptr || finish->coefficient <= 0.0) return std::nullopt;
  const float left = range * static_cast<float>(std::sqrt(finish->coefficient)) - hit->distance;
  constexpr float shortest_m = 0.01F, off_the_wall_m = 1e-3F;  // so that the ray doesn't hit the wall it comes from
  if (left <= shortest_m) return std::nullopt;
  const Vec3f at = ray.origin + hit->distance * ray.direction + off_the_wall_m * hit->normal;
  Vec3f onwards =
      scattered(glm::normalize(glm::reflect(ray.direction, hit->normal)), radians(finish->scatter_deg), index);
  if (glm::dot(onwards, hit->normal) <= 0.0F) onwards = glm::reflect(onwards, hit->normal);
  return Continuation{{at, onwards}, left};
}

/// Adds to every zone the mirrored continuation of those of its rays (at rated range) that first hit a glossy mesh.
/// Its range is what is left of the way at which a signal weakened by the coefficient still counts: power falls with
/// the square of the way, so sqrt(coefficient) of the rated range, less the way to the mesh. One reflection a ray.
void add_reflections(RayBundle& bundle, const rt::Room& room, std::span<const TriMesh> meshes,
                     std::span<const ReflectionSpec> reflections) {
  if (reflections.empty()) return;
  std::vector<const ReflectionSpec*> finishes;  // (n_meshes) null: mirrors nothing
  for (const TriMesh& mesh : meshes) {
    const auto glossy = std::ranges::find(reflections, mesh.name, &ReflectionSpec::mesh);
    finishes.push_back(glossy == reflections.end() ? nullptr : &*glossy);
  }
  RayBundle result;
  result.cluster_zones_begin = bundle.cluster_zones_begin;
  result.sensor_clusters_begin = bundle.sensor_clusters_begin;
  for (std::size_t zone = 0; zone < bundle.n_zones(); ++zone) {
    const std::size_t begin = bundle.zone_rays_begin[zone], end = bundle.zone_rays_begin[zone + 1];
    for (std::size_t i = begin; i < end; ++i) {
      result.rays.push_back(bundle.rays[i]);
      result.range.push_back(bundle.range[i]);
    }
    for (std::size_t i = begin; i < end; ++i) {
      const auto ghost = mirrored(bundle.rays[i], bundle.range[i], room, finishes, static_cast<std::uint32_t>(i));
      if (!ghost) continue;
      result.rays.push_back(ghost->ray);
      result.range.push_back(ghost->range);
    }
    result.zone_rays_begin.push_back(static_cast<std::uint32_t>(result.rays.size()));
  }
  bundle = std::move(result);
}

/// Sensors times zones times rays, before any is made.
void require_limit(const SceneSpec& scene, const SensingInForce& sensing) {
  std::size_t n_rays = 0;
  for (const SensorSpec& sensor : scene.sensors) {
    const SensorModelSpec& model = scene.sensor_models.at(sensor.model);
    const bool is_analog = response_of(scene, sensing, sensor) == Response::analog;
    const auto rays_per_zone =
        static_cast<std::size_t>(is_analog ? sensing.analog_rays_per_zone : static_cast<int>(sensing.rays_per_zone));
    for (const ClusterSpec& cluster : model.clusters) n_rays += cluster.zones.size() * rays_per_zone;
  }
  if (n_rays <= limits::rays) return;
  throw Error(ErrorCode::input, Where{scene.name},
              "its " + std::to_string(scene.sensors.size()) + " sensors have " + std::to_string(n_rays) +
                  " rays, more than " + std::to_string(limits::rays) +
                  ": fewer rays_per_zone or analog_rays_per_zone?");
}

RayBundle rated_rays(const SceneSpec& scene, const SensingInForce& sensing, const rt::Room& room) {
  require_limit(scene, sensing);
  RayBundle rays;
  const std::vector<double> levels = pir::edge_levels(sensing.soft_edges.sigma_deg);
  for (const SensorSpec& sensor : scene.sensors) {
    const SensorModelSpec& model = scene.sensor_models.at(sensor.model);
    const std::size_t first = rays.rays.size();
    pir::append(rays, sensor, model, sensing.rays_per_zone, levels);
    if (model.response != Response::beam) continue;
    for (std::size_t i = first; i < rays.rays.size(); ++i) {  // what is broken is nearer than the room
      const auto idle = room.first_hit(rays.rays[i], rays.range[i]);
      if (idle) rays.range[i] = idle->distance * static_cast<float>(model.idle_share);
    }
  }
  for (const BlindFieldSpec& field : sensing.blind_fields) pir::blind(rays, scene, field);
  add_reflections(rays, room, scene.meshes, sensing.reflections);
  return rays;
}

const rt::LeafCuts* of(const std::optional<rt::LeafCuts>& cuts) { return cuts ? &*cuts : nullptr; }

}  // namespace

const PowerModel::Lens& PowerModel::lens(const SensorModelSpec& model, const SensingInForce& sensing,
                                         const PowerModel* like) {
  std::shared_ptr<const Lens>& known = lenses_[model.id];
  if (known) return *known;
  Lens lens{model, sensing.analog_rays_per_zone, {}};
  // Two blurs in a row are one of their root sum of squares.
  lens.model.optics.blur_deg = glm::length(Vec2(model.optics.blur_deg, sensing.soft_edges.sigma_deg));
  if (like != nullptr) {
    const auto other = like->lenses_.find(model.id);
    if (other != like->lenses_.end() && other->second->rays_per_zone == lens.rays_per_zone &&
        same(other->second->model, lens.model)) {
      return *(known = other->second);
    }
  }
  lens.quadrature = pir::lens_quadrature(lens.model, lens.rays_per_zone);
  return *(known = std::make_shared<const Lens>(std::move(lens)));
}

PowerModel::PowerModel(const SceneSpec& scene, const SensingInForce& sensing, const rt::Room& room,
                       const PowerModel* like)
    : ambient_c_(sensing.ambient_c), rays_(std::make_unique<pir::PowerRays>()) {
  const RayBundle& bundle = rays_->bundle;
  for (const SensorSpec& sensor : scene.sensors) {
    if (response_of(scene, sensing, sensor) != Response::analog) {
      pir::append_blind(*rays_);
      receivers_begin_.push_back(receivers_begin_.back());
      continue;
    }
    const SensorModelSpec& model = scene.sensor_models.at(sensor.model);
    const std::size_t first_cluster = bundle.n_clusters();
    pir::append(*rays_, sensor, model, lens(model, sensing, like).quadrature);
    const std::vector<int> steps = lens_steps(model);
    for (std::size_t c = 0; c < model.clusters.size(); ++c) {
      const auto step = std::ranges::lower_bound(steps, model.clusters[c].lens_step) - steps.begin();
      const std::size_t end = bundle.zone_rays_begin[bundle.cluster_zones_begin[first_cluster + c + 1]];
      receivers_.resize(end, receivers_begin_.back() + static_cast<std::uint32_t>(step));
    }
    receivers_begin_.push_back(receivers_begin_.back() + static_cast<std::uint32_t>(steps.size()));
  }
  for (const BlindFieldSpec& field : sensing.blind_fields) pir::blind(rays_->bundle, scene, field);
  look_behind(scene, sensing, room);
}

PowerModel::PowerModel(pir::PowerRays rays, const pir::Band& band, const SceneSpec& scene,
                       const SensingInForce& sensing, const rt::Room& room)
    : band_(band), ambient_c_(sensing.ambient_c), rays_(std::make_unique<pir::PowerRays>(std::move(rays))) {
  receivers_.resize(rays_->weights.size());
  std::iota(receivers_.begin(), receivers_.end(), 0U);
  receivers_begin_.push_back(static_cast<std::uint32_t>(receivers_.size()));
  look_behind(scene, sensing, room);
}

void PowerModel::look_behind(const SceneSpec& scene, const SensingInForce& sensing, const rt::Room& room) {
  clipped_ = std::make_unique<RayBundle>(rays_->bundle);
  const double ambient = pir::band_radiance(pir::kelvin(sensing.ambient_c), band_);
  std::vector<double> mesh_radiances;
  for (const TriMesh& mesh : scene.meshes) {
    mesh_radiances.push_back(mesh.temperature_c ? pir::band_radiance(pir::kelvin(*mesh.temperature_c), band_)
                                                : ambient);
  }
  for (std::size_t i = 0; i < clipped_->rays.size(); ++i) {
    const auto hit = room.first_hit(clipped_->rays[i], clipped_->range[i]);
    if (hit) clipped_->range[i] = hit->distance;
    backgrounds_.push_back(hit ? mesh_radiances[hit->mesh] : ambient);
  }
}

BodyRadiance radiance_of(const WarmthSpec& warmth, double ambient_c, const pir::Band& band) {
  const auto temperatures_c = body::surface_temperatures_c(warmth, ambient_c);
  BodyRadiance radiance{};
  for (std::size_t i = 0; i < radiance.size(); ++i)
    radiance[i] = pir::band_radiance(pir::kelvin(temperatures_c[i]), band);
  return radiance;
}

BodyRadiance radiance_of(const PersonInForce& body, double ambient_c, const pir::Band& band) {
  if (!body.pet) return radiance_of(body.warmth, ambient_c, band);
  BodyRadiance radiance{};
  radiance.fill(pir::band_radiance(pir::kelvin(body::coat_c(ambient_c)), band));
  return radiance;
}

BodyRadiance PowerModel::radiance_of(const PersonModel& person) const {
  return band_ == pir::Band{} ? person.radiance : sim::radiance_of(person.spec, ambient_c_, band_);
}

bool AnalogModel::is_needed(const SceneSpec& scene, const SensingSpec& sensing) {
  return std::ranges::any_of(
      scene.sensors, [&](const SensorSpec& sensor) { return response_of(scene, sensing, sensor) == Response::analog; });
}

AnalogModel::AnalogModel(const SceneSpec& scene, const SensingInForce& sensing, const rt::Room& room,
                         const AnalogModel* like) {
  for (const SensorSpec& sensor : scene.sensors) {
    const bool is_analog = response_of(scene, sensing, sensor) == Response::analog;
    const SensorModelSpec& model = scene.sensor_models.at(sensor.model);
    sensors_.push_back(is_analog ? with_gain(model, 1.0 / sensing.tick_rate_hz, sensor.gain, sensors_, like) : nullptr);
  }
  power_ = std::make_unique<PowerModel>(scene, sensing, room, like != nullptr ? &like->power() : nullptr);
}

SensorArray::SensorArray(const SceneSpec& scene, const SensingInForce& sensing, std::shared_ptr<const rt::Room> room,
                         const SensorArray* like)
    : room_(std::move(room)),
      soft_edges_(sensing.soft_edges),
      tick_s_(1.0 / sensing.tick_rate_hz),
      n_levels_(pir::edge_levels(sensing.soft_edges.sigma_deg).size()),
      ticks_per_window_(sensing.ticks_per_window),
      rated_(rated_rays(scene, sensing, *room_)),
      clipped_(rated_),
      leaves_(leaves_of(scene, 1.0 / sensing.tick_rate_hz)),
      channels_(rated_, sensing.change_per) {
  room_->clip(clipped_);
  if (!leaves_.empty()) cuts_.emplace(clipped_, leaves_);
  rest_range_ = range(rest_steps(leaves_));
  if (sensing.dual_polarity) {
    polarity_.emplace(scene, *sensing.dual_polarity, n_levels_, 1.0 / sensing.tick_rate_hz);
  }
  for (const SensorSpec& sensor : scene.sensors)
    beams_.push_back(response_of(scene, sensing, sensor) == Response::beam ? 1 : 0);
  for (const SensorSpec& sensor : scene.sensors) {
    const DetectorSpec& detector = scene.sensor_models.at(sensor.model).detector;
    const bool by_zones = response_of(scene, sensing, sensor) == Response::zones;
    zone_outputs_.push_back(by_zones ? pir::output_of(detector, Response::zones, tick_s_) : std::nullopt);
  }
  if (!AnalogModel::is_needed(scene, sensing)) return;
  analog_.emplace(scene, sensing, *room_, like != nullptr ? like->analog() : nullptr);
  rest_power_range_ = analog_->power().clipped().range;
  if (!leaves_.empty()) {
    power_cuts_.emplace(analog_->power().clipped(), leaves_);
    power_cuts_->cut(rest_steps(leaves_), rest_power_range_);
  }
  ZoneSet unheard(clipped_.n_zones());
  for (std::size_t i = 0; i < n_sensors(); ++i) {
    if (is_analog(i)) unheard.insert(clipped_.first_zone(i), clipped_.first_zone(i + 1));
  }
  if (std::ranges::all_of(analog_->sensors(), [](const auto& sensor) { return sensor != nullptr; })) return;
  of_zone_sensors_.emplace(without(rated_, unheard), without(clipped_, unheard));
  if (!leaves_.empty()) zone_cuts_.emplace(of_zone_sensors_->second, leaves_);
}

RayBundle without(const RayBundle& bundle, const ZoneSet& zones) {
  RayBundle rest;
  rest.cluster_zones_begin = bundle.cluster_zones_begin;
  rest.sensor_clusters_begin = bundle.sensor_clusters_begin;
  for (std::size_t zone = 0; zone < bundle.n_zones(); ++zone) {
    for (std::size_t ray = bundle.zone_rays_begin[zone]; ray < bundle.zone_rays_begin[zone + 1] && !zones.test(zone);
         ++ray) {
      rest.rays.push_back(bundle.rays[ray]);
      rest.range.push_back(bundle.range[ray]);
    }
    rest.zone_rays_begin.push_back(static_cast<std::uint32_t>(rest.rays.size()));
  }
  return rest;
}

std::vector<float> SensorArray::range(std::span<const LeafStep> steps) const {
  if (!cuts_) return clipped_.range;
  std::vector<float> range;
  cuts_->cut(steps, range);
  return range;
}

std::vector<std::uint32_t> SensorArray::broken_by(std::span<const LeafStep> steps) const {
  std::vector<std::uint32_t> broken;
  const std::vector<float> now = range(steps);
  for (std::size_t sensor = 0; sensor < n_sensors(); ++sensor) {
    if (!is_beam(sensor)) continue;
    for (std::uint32_t zone = clipped_.first_zone(sensor); zone < clipped_.first_zone(sensor + 1); ++zone) {
      for (std::uint32_t ray = clipped_.zone_rays_begin[zone]; ray < clipped_.zone_rays_begin[zone + 1]; ++ray) {
        if (now[ray] >= clipped_.range[ray]) continue;
        broken.push_back(zone);
        break;
      }
    }
  }
  return broken;
}

std::unique_ptr<rt::Tracer> SensorArray::make_tracer(TracerKind kind, ZonesOf whose) const {
  if (whose == ZonesOf::all_sensors || !analog_) {
    return rt::make_tracer(kind, {room_.get(), &rated_, &clipped_, of(cuts_)});
  }
  if (!of_zone_sensors_) return nullptr;
  return rt::make_tracer(kind, {room_.get(), &of_zone_sensors_->first, &of_zone_sensors_->second, of(zone_cuts_)});
}

std::unique_ptr<rt::Tracer> SensorArray::make_power_tracer(TracerKind kind) const {
  return rt::make_tracer(kind,
                         {room_.get(), &analog_->power().rays().bundle, &analog_->power().clipped(), of(power_cuts_)});
}

Exposure SensorArray::unexposed() const {
  return {ZoneSet(channels_.n_zones()), ZoneSet(channels_.n_channels()),
          std::vector<double>(polarity_ ? n_sensors() : 0, 0.0),
          std::vector<PowerSteps>(analog_ ? analog_->power().n_receivers() : 0, PowerSteps{0})};
}

void SensorArray::expose(Exposure& exposure) const noexcept {
  exposure.channels.clear();
  channels_.add_channels(exposure.zones, exposure.channels);
  if (polarity_) polarity_->add_up(exposure.zones, exposure.sums);
}

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
  for (std::size_t i = 0; i < scene_.arrays.size(); ++i)
    arrays_.push_back(std::make_shared<const ThermalArray>(scene_, i, sensing_, seed_, *room, array_->leaves()));
  trials_ = like != nullptr && same_people(*like, *this, study.trials)
                ? like->trials_
                : std::make_shared<const std::vector<TrialModel>>(plan_people(*this, study.trials, like));
  stages_ = effects::Pipeline(script_given_.effects, {scene_, sensing_, array_->clipped(), n_runs()});
}

}  // namespace pirsim::sim
