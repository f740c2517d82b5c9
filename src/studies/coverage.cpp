#include "studies/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/parallel.hpp"
#include "pir/optics.hpp"
#include "pir/planck.hpp"
#include "studies/cross_tracer.hpp"

namespace pirsim::studies {
namespace {

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
  for (std::size_t i = 0; i < spec.without.size(); ++i) {
    const std::string& name = spec.without[i];
    if (std::ranges::any_of(scene.meshes, [&](const TriMesh& mesh) { return is_called(mesh, name); })) continue;
    const Where where = i < spec.without_where.size() ? spec.without_where[i] : Where{};
    faults.error(where, "without: " + scene.name + " has no mesh '" + name + "'" + did_you_mean(name, known));
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
        rays_(study.clipped_rays()),
        n_poses_(study.target().n_poses()),
        active_(padded(n_poses_)),
        changed_(n_poses_),
        powers_(n_poses_),
        radiance_(pir::band_radiance(pir::kelvin(study.spec().target.temperature_c))) {
    for (const TurningCross& cross : study.target().crosses()) {
      Posed& posed = posed_.emplace_back();
      for (const auto& rotation : cross.rotation) posed.half_axes.push_back(half_axes(cross.bar, rotation));
      posed.bars.resize(posed.half_axes.size());
    }
  }

  /// counts: (n_sensors)
  void count(const Vec2& point, std::span<MotionCount> counts) {
    foot_ = {point.x, study_.scene().floor.height_m(), point.y};
    for (Posed& posed : posed_) posed.up_to_date = 0;
    for (std::size_t sensor = 0; sensor < counts.size(); ++sensor) {
      const bool is_analog = study_.analog() != nullptr && study_.analog()->sensors()[sensor];
      counts[sensor] = is_analog ? count_outputs(sensor) : count_motion(sensor);
    }
  }

 private:
  /// A cross at the present square; posed when the first ray comes near.
  struct Posed {
    std::vector<std::vector<Vec3>> half_axes;
    std::vector<BarPoses> bars;
    std::uint8_t up_to_date = 0;
  };

  MotionCount count_motion(std::size_t sensor) {
    std::ranges::fill(changed_, std::uint8_t{0});
    bool any = false;
    for (auto c = rays_.sensor_clusters_begin[sensor]; c < rays_.sensor_clusters_begin[sensor + 1]; ++c) {
      const auto first = rays_.cluster_zones_begin[c], last = rays_.cluster_zones_begin[c + 1];
      if (study_.spec().sensing.change_per == ChangePer::cluster) {
        any |= mark_changes(first, last);
      } else {
        for (auto zone = first; zone < last; ++zone) any |= mark_changes(zone, zone + 1);
      }
    }
    return any ? count_windows_with_change() : MotionCount{0};
  }

  /// Where the activity of zones [first, last), taken as one, changes; false if no ray of theirs comes near.
  bool mark_changes(std::uint32_t first, std::uint32_t last) {
    bool near = false;
    for (auto i = rays_.zone_rays_begin[first]; i < rays_.zone_rays_begin[last]; ++i) {
      mark_poses(rays_.rays[i], rays_.range[i], near);
    }
    if (!near) return false;
    for (std::size_t pose = 0; pose < n_poses_; ++pose) {
      const std::size_t before = pose == 0 ? n_poses_ - 1 : pose - 1;
      if (active_[pose] != active_[before]) changed_[pose] = 1;
    }
    return true;
  }

  /// Adds the poses in which the ray meets a cross to those marked; the first ray that comes near (`near`, which is
  /// then set) begins anew.
  void mark_poses(const Ray& ray, float range, bool& near) {
    for (std::size_t k = 0; k < posed_.size(); ++k) {
      const TurningCross& cross = study_.target().crosses()[k];
      if (!may_meet(ray, range, foot_ + cross.middle, cross.reach_m)) continue;
      if (!std::exchange(near, true)) std::ranges::fill(active_, 0);
      for (const BarPoses& bar : posed(k)) mark_active(ray, range, bar, active_);
    }
  }

  /// Windows in which an analog sensor's output was on. All crosses are equally warm, so that it doesn't matter which
  /// of them a ray meets first.
  MotionCount count_outputs(std::size_t sensor) {
    const sim::PowerModel& power = study_.analog()->power();
    const RayBundle& rays = power.clipped();
    const auto first_ray = [&](std::size_t s) {
      return rays.zone_rays_begin[rays.cluster_zones_begin[rays.sensor_clusters_begin[s]]];
    };
    std::ranges::fill(powers_, sim::PowerSteps{0});
    bool any = false;
    for (auto i = first_ray(sensor); i < first_ray(sensor + 1); ++i) {
      bool near = false;
      mark_poses(rays.rays[i], rays.range[i], near);
      if (!near) continue;
      any = true;
      const sim::PowerSteps step = power.power(i, radiance_);
      for (std::size_t pose = 0; pose < n_poses_; ++pose) powers_[pose] += active_[pose] != 0 ? step : 0;
    }
    return any ? count_windows_with_output(sensor) : MotionCount{0};
  }

  MotionCount count_windows_with_output(std::size_t sensor) const {
    const SensingSpec& sensing = study_.spec().sensing;
    const SceneSpec& scene = study_.scene();
    const pir::AnalogFilter& filter = study_.analog()->sensors()[sensor]->silent_filter;
    const pir::Comparator comparator(scene.sensor_models.at(scene.sensors[sensor].model).detector.comparator,
                                     1.0 / sensing.tick_rate_hz);
    const auto watts = [&](std::size_t pose) { return static_cast<double>(powers_[pose]) * sim::watts_per_step; };
    pir::AnalogFilter::Sections sections = filter.at_rest(watts(0));
    pir::Comparator::State state;
    MotionCount count = 0;
    std::size_t pose = 0;
    for (int window = 0; window < study_.n_windows(); ++window) {
      bool motion = false;
      for (int tick = 0; tick < sensing.ticks_per_window; ++tick) {
        const double before_w = watts(pose);
        if (++pose == n_poses_) pose = 0;
        filter.advance(sections, before_w, watts(pose), 0.0);
        comparator.advance(state, filter.output(sections));
        motion |= state.on;
      }
      count = static_cast<MotionCount>(count + (motion ? 1 : 0));
    }
    return count;
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

  MotionCount count_windows_with_change() const {
    MotionCount count = 0;
    std::size_t pose = 0;
    for (int window = 0; window < study_.n_windows(); ++window) {
      std::uint8_t motion = 0;
      for (int tick = 0; tick < study_.spec().sensing.ticks_per_window; ++tick) {
        if (++pose == n_poses_) pose = 0;
        motion |= changed_[pose];
      }
      count = static_cast<MotionCount>(count + motion);
    }
    return count;
  }

  const CoverageStudy& study_;
  const RayBundle& rays_;
  std::size_t n_poses_;
  Vec3 foot_{0.0};
  std::vector<Posed> posed_;
  std::vector<std::uint8_t> active_;     ///< (padded n_poses)
  std::vector<std::uint8_t> changed_;    ///< (n_poses) from the pose before to this one
  std::vector<sim::PowerSteps> powers_;  ///< (n_poses)
  double radiance_;                      ///< of the crosses, W m^-2 sr^-1
};

}  // namespace

CoverageStudy::CoverageStudy(SceneSpec scene, CoverageSpec spec)
    : scene_(std::move(scene)),
      spec_(std::move(spec)),
      taken_out_(take_out(scene_, spec_)),
      grid_(scene_.floor, spec_.spacing_m),
      n_windows_(count_windows(spec_)),
      target_(spec_.target, spec_.sensing.tick_rate_hz, std::int64_t{n_windows_} * spec_.sensing.ticks_per_window),
      room_(std::make_unique<rt::Room>(scene_.meshes)) {
  for (const SensorSpec& sensor : scene_.sensors) {
    pir::append(rated_, sensor, scene_.sensor_models.at(sensor.model), spec_.sensing.rays_per_zone);
  }
  clipped_ = rated_;
  room_->clip(clipped_);
  if (sim::AnalogModel::is_needed(scene_, spec_.sensing)) {
    analog_ = std::make_unique<sim::AnalogModel>(scene_, spec_.sensing, *room_);
  }
}

std::vector<MotionCount> CoverageStudy::counts_at(const Vec2& point) const {
  std::vector<MotionCount> counts(scene_.sensors.size());
  SquareCounter(*this).count(point, counts);
  return counts;
}

std::vector<MotionCount> CoverageStudy::counts_of_row(std::size_t row) const {
  const std::size_t n_sensors = scene_.sensors.size();
  std::vector<MotionCount> counts(grid_.n_columns() * n_sensors, 0);
  SquareCounter counter(*this);
  for (std::size_t column = 0; column < grid_.n_columns(); ++column) {
    if (!grid_.on_floor(column, row)) continue;
    counter.count(grid_.centre(column, row), std::span(counts).subspan(column * n_sensors, n_sensors));
  }
  return counts;
}

CoverageMap empty_map(const CoverageStudy& study) {
  CoverageMap map{study.grid(), {}, study.n_windows(), {}};
  for (const SensorSpec& sensor : study.scene().sensors) map.sensors.push_back(sensor.id);
  return map;
}

void run_rows(const CoverageStudy& study, std::size_t first_row, unsigned threads,
              const std::function<void(std::size_t row, const std::vector<MotionCount>& counts)>& consume) {
  const std::size_t n_rows = study.grid().n_rows();
  std::size_t row = first_row;
  ordered_parallel<std::vector<MotionCount>>(
      n_rows - std::min(first_row, n_rows), threads, [&](std::size_t i) { return study.counts_of_row(first_row + i); },
      [&](std::vector<MotionCount>& counts) { consume(row++, counts); });
}

CoverageMap run_coverage(const CoverageStudy& study, unsigned threads) {
  CoverageMap map = empty_map(study);
  run_rows(study, 0, threads, [&](std::size_t, const std::vector<MotionCount>& counts) {
    map.counts.insert(map.counts.end(), counts.begin(), counts.end());
  });
  return map;
}

}  // namespace pirsim::studies
