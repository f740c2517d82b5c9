#include "surveys/coverage.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <glm/geometric.hpp>
#include <iomanip>
#include <numeric>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>

#include "engine/effects/catalogue.hpp"
#include "engine/pir/optics.hpp"
#include "engine/sim/thermal_array.hpp"
#include "model/core/parallel.hpp"
#include "model/core/text.hpp"
#include "model/geom/ray_tests.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/geometry.hpp"
#include "surveys/study_report.hpp"

namespace pirsim::studies {
namespace {

SceneSpec without_noise(SceneSpec scene) {
  for (auto& [id, model] : scene.sensor_models) {
    if (!model.array && model.response != Response::beam) model.detector.amplifier.noise_v_pp = 0.0;
  }
  return scene;
}

/// Degrees, from 0 up to 360: computed so that ticks one turn apart have the same bits.
double angle_deg(const TurnSpec& turn, int tick_rate_hz, std::int64_t tick) {
  return std::fmod(turn.deg_per_s * static_cast<double>(tick), 360.0 * tick_rate_hz) / tick_rate_hz;
}

Quat orientation(const XShapesSpec& spec, int tick_rate_hz, std::int64_t tick) {
  Quat rotation(1.0, 0.0, 0.0, 0.0);
  for (const TurnSpec& turn : spec.turns) {
    rotation = rotation * glm::angleAxis(radians(angle_deg(turn, tick_rate_hz, tick)), glm::normalize(turn.axis));
  }
  return glm::normalize(rotation);
}

bool is_period(const XShapesSpec& spec, int tick_rate_hz, std::int64_t ticks) {
  for (const TurnSpec& turn : spec.turns) {
    if (angle_deg(turn, tick_rate_hz, ticks) != 0.0) return false;
  }
  return true;
}

bool is_called(const TriMesh& mesh, const std::string& name) {
  return mesh.name == name || mesh.name.starts_with(name + " ");
}

/// Takes things out of the scene and returns them as they were.
std::vector<TriMesh> take_out(SceneSpec& scene, const CoverageSpec& spec) {
  Diagnostics faults;
  std::vector<std::string> known;
  for (const TriMesh& mesh : scene.meshes) {
    known.push_back(mesh.name.substr(0, mesh.name.find(' ')));
    known.push_back(mesh.name);
  }
  std::ranges::sort(known);
  known.erase(std::ranges::unique(known).begin(), known.end());
  for (std::size_t i = 0; i < spec.without.size(); ++i) {
    const std::string& name = spec.without[i];
    if (std::ranges::any_of(scene.meshes, [&](const TriMesh& mesh) { return is_called(mesh, name); })) continue;
    const Where where = i < spec.without_where.size() ? spec.without_where[i] : Where{};
    faults.error(where, "without: " + scene.name + " has no mesh '" + name + "'" + near_or_all(name, known));
  }
  faults.throw_if_errors();
  const auto stays = [&](const TriMesh& mesh) {
    return std::ranges::none_of(spec.without, [&](const std::string& name) { return is_called(mesh, name); });
  };
  const auto first_out = std::stable_partition(scene.meshes.begin(), scene.meshes.end(), stays);
  std::vector<TriMesh> taken(std::make_move_iterator(first_out), std::make_move_iterator(scene.meshes.end()));
  scene.meshes.erase(first_out, scene.meshes.end());
  return taken;
}

int count_windows(const CoverageSpec& spec) {
  return static_cast<int>(std::lround(spec.duration_s * spec.sensing.tick_rate_hz / spec.sensing.ticks_per_window));
}

/// Counts the motion in one square after another. Belongs to one thread.
class SquareCounter {
 public:
  explicit SquareCounter(const CoverageStudy& study)
      : study_(study),
        array_(study.survey().array()),
        n_poses_(study.target().n_poses()),
        detector_(study.survey().make_detector()),
        logger_(study.survey().make_logger()),
        repeats_(detector_.is_memoryless() && study.survey().stages().empty() &&
                 study.survey().sensing().reader == Reader::in_step),
        active_(padded(n_poses_)),
        exposures_(n_poses_, array_.unexposed()),
        triggers_(array_.n_sensors()),
        radiance_(pir::band_radiance(pir::kelvin(study.spec().target.temperature_c))) {
    for (const auto& array : study.survey().arrays()) watches_.emplace_back(*array, fastest_tracer);
    for (const TurningCross& cross : study.target().crosses()) {
      Posed& posed = posed_.emplace_back();
      for (const auto& rotation : cross.rotation) posed.half_axes.push_back(half_axes(cross.bar, rotation));
      posed.bars.resize(posed.half_axes.size());
    }
  }

  /// all: (n_counted); square: its number, which keys what effects draw.
  void count(const Vec2& point, std::uint32_t square, std::span<MotionCount> all) {
    const std::span<MotionCount> counts = all.first(array_.n_sensors());
    foot_ = {point.x, study_.scene().floor.height_m(), point.y};
    for (Posed& posed : posed_) posed.up_to_date = 0;
    const bool anything = expose();
    if (!repeats_) {
      count_windows(square, counts);
    } else if (anything) {
      count_periods(counts);
    } else {
      std::ranges::fill(counts, MotionCount{0});
    }
    for (std::size_t i = 0; i < watches_.size(); ++i) all[counts.size() + i] = windows_seen(watches_[i]);
  }

 private:
  /// Windows at whose end the array sees the crosses.
  MotionCount windows_seen(sim::ArrayWatch& watch) {
    sim::BodyRadiance radiance{};
    radiance.fill(pir::band_radiance(pir::kelvin(study_.spec().target.temperature_c), watch.array().band()));
    std::vector<std::optional<bool>> seen(n_poses_);
    MotionCount count = 0;
    std::int64_t tick = 0;
    for (int window = 0; window < study_.n_windows(); ++window) {
      tick += study_.survey().sensing().ticks_per_window;
      auto& now = seen[static_cast<std::size_t>(tick) % n_poses_];
      if (!now) now = watch.look(study_.target().solids(foot_, tick), radiance).is_seen();
      count = static_cast<MotionCount>(count + (*now ? 1 : 0));
    }
    return count;
  }

  /// A cross at the present square; posed when the first ray comes near.
  struct Posed {
    std::vector<std::vector<Vec3>> half_axes;
    std::vector<BarPoses> bars;
    std::uint8_t up_to_date = 0;
  };

  /// What the optics show in every pose; false if that is an empty room in all of them.
  bool expose() {
    if (std::exchange(exposed_, false)) std::ranges::fill(exposures_, array_.unexposed());
    expose_zones();
    if (array_.analog() != nullptr) expose_powers();
    return exposed_;
  }

  void expose_zones() {
    const RayBundle& rays = array_.clipped();
    for (std::uint32_t zone = 0; zone < rays.n_zones(); ++zone) {
      bool near = false;
      for (std::size_t k = 0; k < posed_.size(); ++k) {
        const TurningCross& cross = study_.target().crosses()[k];
        const rt::BoundingSphere around{Vec3f(foot_ + cross.middle), static_cast<float>(cross.reach_m)};
        if (!rt::may_touch(study_.zone_cones()[zone], around)) continue;
        for (auto i = rays.zone_rays_begin[zone]; i < rays.zone_rays_begin[zone + 1]; ++i) {
          mark_poses(rays.rays[i], array_.range()[i], k, near);
        }
      }
      if (near) for_active([&](std::size_t pose) { exposures_[pose].zones.insert(zone); });
    }
    if (!exposed_) return;
    for (sim::Exposure& exposure : exposures_) array_.expose(exposure);
  }

  /// All crosses are equally warm, so that it doesn't matter which of them a ray hits first.
  void expose_powers() {
    const sim::PowerModel& power = array_.analog()->power();
    const RayBundle& rays = power.clipped();
    for (std::uint32_t i = 0; i < rays.rays.size(); ++i) {
      bool near = false;
      for (std::size_t k = 0; k < posed_.size(); ++k) mark_poses(rays.rays[i], array_.power_range()[i], k, near);
      if (!near) continue;
      const sim::PowerSteps step = power.power(i, radiance_);
      const std::uint32_t receiver = power.receiver_of(i);
      for_active([&](std::size_t pose) { exposures_[pose].powers[receiver] += step; });
    }
  }

  /// Calls `act` with every pose that is marked.
  template <typename Act>
  void for_active(const Act& act) {
    // Eight poses at a time: most rays come near a cross without hitting it.
    for (std::size_t first = 0; first < n_poses_; first += sizeof(std::uint64_t)) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, active_.data() + first, std::min(sizeof eight, n_poses_ - first));
      if (eight == 0) continue;
      exposed_ = true;
      for (std::size_t pose = first; pose < std::min(first + sizeof eight, n_poses_); ++pose) {
        if (active_[pose] != 0) act(pose);
      }
    }
  }

  /// Adds the poses in which the ray hits cross k to those marked; the first ray that comes near (`near`, which is
  /// then set) begins anew.
  void mark_poses(const Ray& ray, float range, std::size_t k, bool& near) {
    const TurningCross& cross = study_.target().crosses()[k];
    if (!may_hit(ray, range, foot_ + cross.middle, cross.reach_m)) return;
    if (!std::exchange(near, true)) std::ranges::fill(active_, 0);
    for (const BarPoses& bar : posed(k)) mark_active(ray, range, bar, active_);
  }

  const std::vector<BarPoses>& posed(std::size_t k) {
    Posed& posed = posed_[k];
    if (posed.up_to_date == 0) {
      const TurningCross& cross = study_.target().crosses()[k];
      for (std::size_t bar = 0; bar < posed.bars.size(); ++bar) {
        pose_bar(posed.half_axes[bar], foot_ + cross.middle, cross.bar.radius, posed.bars[bar]);
      }
      posed.up_to_date = 1;
    }
    return posed.bars;
  }

  [[nodiscard]] std::size_t after(std::size_t pose) const noexcept { return pose + 1 == n_poses_ ? 0 : pose + 1; }

  /// Every tick of every window through detector and logger.
  void count_windows(std::uint32_t square, std::span<MotionCount> counts) {
    std::ranges::fill(counts, MotionCount{0});
    detector_.begin_run(study_.survey().seed(), square, exposures_[0]);
    logger_.begin_run(study_.survey().seed(), square);
    std::size_t pose = 0;
    const auto sense = [&](std::int64_t) {
      const std::size_t before = std::exchange(pose, after(pose));
      detector_.tick(exposures_[before], exposures_[pose], triggers_);
    };
    const SensingSpec& sensing = study_.survey().sensing();
    for (int window = 1; window <= study_.n_windows(); ++window) {
      for (int i = 0; i < sensing.ticks_per_window; ++i) logger_.observe_tick(triggers_, sense);
      row_.time_s = static_cast<double>(std::int64_t{window} * sensing.ticks_per_window) / sensing.tick_rate_hz;
      logger_.complete(row_);
      for (std::size_t s = 0; s < counts.size(); ++s) counts[s] = static_cast<MotionCount>(counts[s] + row_.bits[s]);
    }
  }

  /// Counts where triggers repeat with the poses: one turn through the detector, then window by window.
  void count_periods(std::span<MotionCount> counts) {
    const std::size_t n_sensors = counts.size();
    std::ranges::fill(counts, MotionCount{0});
    any_.assign(n_sensors, 0);
    turn_.assign(n_sensors * n_poses_, 0);
    for (std::size_t pose = 0; pose < n_poses_; ++pose) {
      const std::size_t next = after(pose);
      detector_.tick(exposures_[pose], exposures_[next], triggers_);
      for (std::size_t s = 0; s < n_sensors; ++s) {
        turn_[s * n_poses_ + next] = triggers_[s];
        any_[s] |= triggers_[s];
      }
    }
    for (std::size_t s = 0; s < n_sensors; ++s) {
      if (any_[s] != 0) counts[s] = windows_with(std::span(turn_).subspan(s * n_poses_, n_poses_));
    }
  }

  /// turn: (n_poses) triggers of one sensor.
  [[nodiscard]] MotionCount windows_with(std::span<const std::uint8_t> turn) const {
    MotionCount count = 0;
    std::size_t pose = 0;
    for (int window = 0; window < study_.n_windows(); ++window) {
      std::uint8_t motion = 0;
      for (int tick = 0; tick < study_.survey().sensing().ticks_per_window; ++tick) {
        pose = after(pose);
        motion |= turn[pose];
      }
      count = static_cast<MotionCount>(count + motion);
    }
    return count;
  }

  const CoverageStudy& study_;
  const sim::SensorArray& array_;
  std::size_t n_poses_;
  sim::Detector detector_;
  sim::Logger logger_;
  bool repeats_;  ///< triggers do, with the poses
  Vec3 foot_{0.0};
  std::vector<Posed> posed_;
  std::vector<std::uint8_t> active_;      ///< (padded n_poses)
  std::vector<sim::Exposure> exposures_;  ///< (n_poses)
  bool exposed_ = false;                  ///< some exposure isn't that of an empty room
  std::vector<std::uint8_t> triggers_;    ///< (n_sensors) scratch
  std::vector<std::uint8_t> turn_;        ///< (n_sensors x n_poses) from the pose before to this one
  std::vector<std::uint8_t> any_;         ///< (n_sensors)
  Sample row_;
  double radiance_;                       ///< of the crosses, W m^-2 sr^-1
  std::vector<sim::ArrayWatch> watches_;  ///< (n_arrays)
};

ScriptSpec as_script(const CoverageSpec& spec) {
  ScriptSpec script;
  script.sensing = spec.sensing;
  script.seed = spec.seed;
  script.effects = spec.effects;
  return script;
}

/// Sums of the steps between neighbours.
struct NeighbourSteps {
  long long sum = 0;
  std::size_t pairs = 0;
  int greatest = 0;

  void add(int a, int b) {
    const int step = std::abs(a - b);
    greatest = std::max(greatest, step);
    if (a == 0 || b == 0) return;
    sum += step;
    ++pairs;
  }
  void add(const NeighbourSteps& other) {
    sum += other.sum;
    pairs += other.pairs;
    greatest = std::max(greatest, other.greatest);
  }
};

NeighbourSteps steps_of(const CoverageMap& map, std::size_t sensor) {
  const FloorGrid& grid = map.grid;
  NeighbourSteps steps;
  each_square(grid, [&](std::size_t column, std::size_t row) {
    const int here = map.count(column, row, sensor);
    if (column > 0 && grid.on_floor(column - 1, row)) steps.add(map.count(column - 1, row, sensor), here);
    if (row > 0 && grid.on_floor(column, row - 1)) steps.add(map.count(column, row - 1, sensor), here);
  });
  return steps;
}

/// Squares on the floor for which `seen(column, row)` holds.
template <typename Seen>
std::size_t count_squares(const FloorGrid& grid, Seen seen) {
  std::size_t count = 0;
  each_square(grid, [&](std::size_t column, std::size_t row) { count += seen(column, row) ? 1 : 0; });
  return count;
}

std::vector<std::size_t> all_sensors(const CoverageMap& map) {
  std::vector<std::size_t> all(map.sensors.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

bool is_seen(const CoverageMap& map, std::size_t column, std::size_t row, const std::vector<std::size_t>& by) {
  return std::ranges::any_of(by, [&](std::size_t sensor) { return map.count(column, row, sensor) > 0; });
}

MapFigures figures(const NeighbourSteps& steps, std::size_t seen, const FloorGrid& grid) {
  MapFigures result;
  result.pairs = steps.pairs;
  result.greatest_step = steps.greatest;
  if (steps.pairs > 0) result.mean_step = static_cast<double>(steps.sum) / static_cast<double>(steps.pairs);
  if (grid.n_squares() > 0) {
    result.blind_fraction = 1.0 - static_cast<double>(seen) / static_cast<double>(grid.n_squares());
  }
  result.seen_area_m2 = static_cast<double>(seen) * grid.spacing_m() * grid.spacing_m();
  return result;
}

}  // namespace

SurveyBase::SurveyBase(SceneSpec scene, const ScriptSpec& script)
    : study_(effects::in_force(without_noise(std::move(scene)), script)),
      array_(std::make_unique<const sim::SensorArray>(study_.scene, study_.sensing,
                                                      std::make_shared<const rt::Room>(study_.scene.meshes))),
      stages_(script.effects, {study_.scene, study_.sensing, array_->clipped()}) {
  for (std::size_t i = 0; i < study_.scene.arrays.size(); ++i) {
    arrays_.push_back(std::make_shared<const sim::ThermalArray>(study_.scene, i, study_.sensing, study_.seed,
                                                                array_->room(), array_->leaves()));
  }
}

std::vector<Issue> idle_effects(std::span<const EffectSpec> effects, const SurveyBase& survey, effects::Survey kind) {
  Diagnostics remarks;
  for (const Issue& issue : effects::idle(effects, survey.scene(), survey.sensing())) {
    remarks.warning(issue.where, issue.message);
  }
  for (const EffectSpec& effect : effects) {
    const std::vector<effects::Survey>& idle_in = effects::info(effect.name).idle_in;
    if (std::ranges::find(idle_in, kind) == idle_in.end()) continue;
    remarks.warning(effect.where, effect.name + " does nothing in a " + std::string(name(kind)));
  }
  return remarks.issues();
}

TurningTarget::TurningTarget(const XShapesSpec& spec, int tick_rate_hz, std::int64_t n_ticks) {
  std::int64_t period = 1;
  while (period <= n_ticks && !is_period(spec, tick_rate_hz, period)) ++period;
  n_poses_ = static_cast<std::size_t>(period);

  const double radius = spec.bar_width_m / 2, half_length = spec.bar_length_m / 2 - radius;
  for (const double height : spec.heights_m) {
    TurningCross& cross = crosses_.emplace_back();
    cross.middle = {0.0, height, 0.0};
    cross.reach_m = half_length + radius;
    cross.bar = {radius, half_length};
    for (const double lean_deg : {45.0, -45.0}) {
      const Quat leaning = glm::angleAxis(radians(lean_deg), Vec3(0, 0, 1));
      auto& rotations = cross.rotation.emplace_back();
      for (std::int64_t tick = 0; tick < period; ++tick) {
        rotations.push_back(orientation(spec, tick_rate_hz, tick) * leaning);
      }
    }
  }
}

std::vector<PosedShape> TurningTarget::solids(const Vec3& foot, std::int64_t tick) const {
  const std::size_t pose = static_cast<std::size_t>(tick) % n_poses_;
  std::vector<PosedShape> result;
  for (const TurningCross& cross : crosses_) {
    for (const auto& rotations : cross.rotation) {
      result.push_back(place(cross.bar, Frame{rotations[pose], foot + cross.middle}));
    }
  }
  return result;
}

using ray_tests::Lanes;
constexpr std::size_t width = ray_tests::n_lanes;

std::size_t padded(std::size_t n_poses) noexcept { return (n_poses + width - 1) / width * width; }

std::vector<Vec3> half_axes(const Capsule& bar, const std::vector<Quat>& rotation) {
  std::vector<Vec3> result;
  for (const Quat& world_from_bar : rotation) result.push_back(world_from_bar * Vec3(0.0, bar.half_length, 0.0));
  return result;
}

void pose_bar(const std::vector<Vec3>& half_axes, const Vec3& middle, double radius, BarPoses& poses) {
  const std::size_t n = half_axes.size(), n_padded = padded(n);
  for (auto* values : {&poses.ax, &poses.ay, &poses.az, &poses.bx, &poses.by, &poses.bz}) values->resize(n_padded);
  for (std::size_t i = 0; i < n_padded; ++i) {
    const Vec3& half_axis = half_axes[std::min(i, n - 1)];
    poses.ax[i] = static_cast<float>(middle.x - half_axis.x);
    poses.ay[i] = static_cast<float>(middle.y - half_axis.y);
    poses.az[i] = static_cast<float>(middle.z - half_axis.z);
    poses.bx[i] = static_cast<float>(middle.x + half_axis.x);
    poses.by[i] = static_cast<float>(middle.y + half_axis.y);
    poses.bz[i] = static_cast<float>(middle.z + half_axis.z);
  }
  poses.radius = static_cast<float>(radius);
}

void mark_active(const Ray& ray, float range, const BarPoses& poses, std::vector<std::uint8_t>& active) noexcept {
  using Vector = ray_tests::Vector<Lanes>;
  const auto all = [](const Vec3f& v) { return Vector{Lanes(v.x), Lanes(v.y), Lanes(v.z)}; };
  const Vector origin = all(ray.origin), direction = all(ray.direction);
  const Lanes radius(poses.radius), t_max(range);
  for (std::size_t i = 0; i < active.size(); i += width) {
    if (std::all_of(&active[i], &active[i] + width, [](std::uint8_t known) { return known != 0; })) continue;
    const Vector a{Lanes::at(&poses.ax[i]), Lanes::at(&poses.ay[i]), Lanes::at(&poses.az[i])};
    const Vector b{Lanes::at(&poses.bx[i]), Lanes::at(&poses.by[i]), Lanes::at(&poses.bz[i])};
    const auto bar = ray_tests::capsule(origin, direction, ray_tests::capsule_axis(a, b), radius);
    for (unsigned int hits = bits(ray_tests::is_hit(bar, t_max)); hits != 0; hits &= hits - 1) {
      active[i + static_cast<std::size_t>(std::countr_zero(hits))] = 1;
    }
  }
}

bool may_hit(const Ray& ray, float range, const Vec3& middle, double reach_m) noexcept {
  constexpr double safety_m = 1e-3;  // as the tracers' bounding boxes have it
  const Vec3 to_middle = middle - Vec3(ray.origin), direction(ray.direction);
  const double along = std::clamp(glm::dot(to_middle, direction), 0.0, static_cast<double>(range));
  return glm::length(to_middle - along * direction) <= reach_m + safety_m;
}

CoverageStudy::CoverageStudy(SceneSpec scene, CoverageSpec spec)
    : spec_(std::move(spec)),
      taken_out_(take_out(scene, spec_)),
      survey_(std::move(scene), as_script(spec_)),
      grid_(survey_.scene().floor, spec_.spacing_m),
      n_windows_(count_windows(spec_)),
      target_(spec_.target, spec_.sensing.tick_rate_hz, std::int64_t{n_windows_} * spec_.sensing.ticks_per_window),
      zone_cones_(rt::zone_cones(survey_.array().clipped())) {}

std::vector<Issue> CoverageStudy::warnings() const {
  return idle_effects(spec_.effects, survey_, effects::Survey::coverage);
}

std::vector<MotionCount> CoverageStudy::counts_at(const Vec2& point) const {
  std::vector<MotionCount> counts(n_counted());
  SquareCounter(*this).count(point, static_cast<std::uint32_t>(grid_.n_rows() * grid_.n_columns()), counts);
  return counts;
}

std::vector<MotionCount> CoverageStudy::counts_of_row(std::size_t row) const {
  const std::size_t n_sensors = n_counted();
  std::vector<MotionCount> counts(grid_.n_columns() * n_sensors, 0);
  SquareCounter counter(*this);
  for (std::size_t column = 0; column < grid_.n_columns(); ++column) {
    if (!grid_.on_floor(column, row)) continue;
    counter.count(grid_.centre(column, row), static_cast<std::uint32_t>(row * grid_.n_columns() + column),
                  std::span(counts).subspan(column * n_sensors, n_sensors));
  }
  return counts;
}

CoverageMap empty_map(const CoverageStudy& study) {
  CoverageMap map{study.grid(), {}, study.n_windows(), {}};
  for (const SensorSpec& sensor : study.scene().sensors) map.sensors.push_back(sensor.id);
  for (const SensorSpec& array : study.scene().arrays) map.sensors.push_back(array.id);
  return map;
}

CoverageMap run_coverage(const CoverageStudy& study, unsigned threads, const RowDone& row_done) {
  CoverageMap map = empty_map(study);
  map.counts = row_by_row<MotionCount>(study.grid(), threads, row_done,
                                       [&](std::size_t row) { return study.counts_of_row(row); });
  return map;
}

CoverageFigures figures_of(const CoverageMap& map) {
  CoverageFigures result;
  NeighbourSteps all;
  for (std::size_t sensor = 0; sensor < map.sensors.size(); ++sensor) {
    const NeighbourSteps steps = steps_of(map, sensor);
    all.add(steps);
    const std::size_t seen = count_squares(
        map.grid, [&](std::size_t column, std::size_t row) { return map.count(column, row, sensor) > 0; });
    result.sensors.push_back(figures(steps, seen, map.grid));
  }
  const std::vector<std::size_t> sensors = all_sensors(map);
  const std::size_t seen_by_any =
      count_squares(map.grid, [&](std::size_t column, std::size_t row) { return is_seen(map, column, row, sensors); });
  result.all = figures(all, seen_by_any, map.grid);
  return result;
}

std::vector<AreaCoverage> area_figures_of(const CoverageMap& map, const SceneSpec& scene) {
  const Areas areas(scene);
  std::vector<AreaCoverage> figures;
  for (std::size_t area = 0; area < areas.size(); ++area) {
    const auto is_here = [&](std::size_t column, std::size_t row) {
      return areas.at(map.grid.centre(column, row)) == area;
    };
    AreaCoverage& one = figures.emplace_back(AreaCoverage{with_sensors(scene, areas, area)});
    one.squares = count_squares(map.grid, is_here);
    if (one.squares == 0) continue;
    const auto blind_to = [&](const std::vector<std::size_t>& sensors) {
      const std::size_t n_blind = count_squares(map.grid, [&](std::size_t column, std::size_t row) {
        return is_here(column, row) && !is_seen(map, column, row, sensors);
      });
      return static_cast<double>(n_blind) / static_cast<double>(one.squares);
    };
    one.blind_fraction = blind_to(all_sensors(map));
    const std::vector<std::size_t> its_own = areas.sensors_of(area);
    if (!its_own.empty()) one.blind_to_its_own = blind_to(its_own);
  }
  return figures;
}

std::string to_csv(const CoverageMap& map) {
  std::ostringstream out;
  out << "x_m,z_m";
  for (const std::string& sensor : map.sensors) out << ',' << io::csv_field(sensor);
  out << '\n' << std::fixed;
  each_square(map.grid, [&](std::size_t column, std::size_t row) {
    const Vec2 centre = map.grid.centre(column, row);
    out << std::setprecision(4) << centre.x << ',' << centre.y;
    for (std::size_t sensor = 0; sensor < map.sensors.size(); ++sensor) out << ',' << map.count(column, row, sensor);
    out << '\n';
  });
  return out.str();
}

std::string to_text(const CoverageMap& map, const CoverageFigures& figures, const std::vector<AreaCoverage>& areas) {
  std::ostringstream out;
  const auto line = [&](const std::string& name, const MapFigures& f) {
    out << "  " << std::left << std::setw(10) << name << std::right << std::fixed << std::setprecision(2)
        << std::setw(9) << f.mean_step << std::setw(10) << f.greatest_step << std::setprecision(1) << std::setw(13)
        << 100.0 * f.blind_fraction << std::setprecision(2) << std::setw(12) << f.seen_area_m2 << '\n';
  };
  out << map.grid.n_squares() << " squares of " << map.grid.spacing_m() << " m, " << map.n_windows
      << " windows in each\n  sensor    mean step  greatest  not seen, %   seen, m2\n";
  for (std::size_t i = 0; i < map.sensors.size(); ++i) line(map.sensors[i], figures.sensors[i]);
  line("all", figures.all);
  if (!areas.empty()) out << "  not seen of each area by all sensors, and by its own:\n";
  for (const AreaCoverage& area : areas) {
    out << "    " << area.area << ": " << percent(area.blind_fraction, 1) << ", "
        << (area.blind_to_its_own ? percent(*area.blind_to_its_own, 1) : "no sensor") << '\n';
  }
  return out.str();
}

}  // namespace pirsim::studies

namespace pirsim {

CoverageMap run_coverage(SceneSpec scene, CoverageSpec spec, unsigned threads, const RowDone& row_done) {
  return studies::run_coverage(studies::CoverageStudy(std::move(scene), std::move(spec)), threads, row_done);
}

}  // namespace pirsim
