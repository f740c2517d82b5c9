#include "studies/coverage.hpp"

#include <span>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

#include "core/digest.hpp"
#include "pirsim/error.hpp"
#include "pirsim/version.hpp"

namespace pirsim::studies {
namespace {

/// The digest of values as they lie in memory.
class Hash {
 public:
  template <typename Value>
  void add(const Value& value) {
    static_assert(std::has_unique_object_representations_v<Value> || std::is_floating_point_v<Value>);
    digest_.add({reinterpret_cast<const char*>(&value), sizeof value});
  }
  template <typename Value>
  void add(const std::vector<Value>& values) {
    add(values.size());
    for (const Value& value : values) add(value);
  }
  void add(const Vec3f& v) {
    for (const float coordinate : {v.x, v.y, v.z}) add(coordinate);
  }
  /// With its end, so that no two lists of texts are alike.
  void add_text(const std::string& text) { digest_.add({text.c_str(), text.size() + 1}); }
  [[nodiscard]] std::string value() const { return digest_.hex(); }

 private:
  Sha256 digest_;
};

std::string text_of(const std::vector<MotionCount>& counts) {
  std::string text;
  for (const MotionCount count : counts) text += std::to_string(count) + ' ';
  return text;
}

std::string checksum(const std::string& text) { return sha256(text).substr(0, 16); }

/// Counts of a line as append() writes it; none if it is damaged.
std::vector<MotionCount> parse(const std::string& line, std::size_t n_counts) {
  const std::size_t mark = line.rfind('#');
  if (mark == std::string::npos || checksum(line.substr(0, mark)) != line.substr(mark + 1)) return {};
  std::vector<MotionCount> counts;
  std::istringstream text(line.substr(0, mark));
  for (unsigned count = 0; text >> count;) counts.push_back(static_cast<MotionCount>(count));
  return counts.size() == n_counts ? counts : std::vector<MotionCount>{};
}

std::string header(const CoverageStudy& study) { return "pirsim coverage rows of study " + fingerprint(study); }

void add_detector(Hash& hash, const DetectorSpec& detector) {
  const auto& [element, amplifier, comparator] = detector;
  for (const double value : {element.thermal_s, element.electrical_s, amplifier.low_hz, amplifier.high_hz,
                             amplifier.volts_per_watt.value_or(0.0), comparator.positive_v, comparator.negative_v,
                             comparator.pulse_window_s, comparator.hold_s, comparator.blind_s}) {
    hash.add(value);
  }
  hash.add(amplifier.order);
  hash.add(comparator.pulse_count);
  hash.add(comparator.pulse_signs);
}

/// What only the physical response depends on.
void add_analog(Hash& hash, const CoverageStudy& study) {
  if (study.survey().array().analog() == nullptr) return;
  const sim::PowerModel& power = study.survey().array().analog()->power();
  for (std::uint32_t i = 0; i < power.clipped().rays.size(); ++i) {
    hash.add(power.clipped().rays[i].direction);
    hash.add(power.clipped().range[i]);
    hash.add(power.rays().weights[i]);
    hash.add(power.background(i));
  }
  for (std::size_t i = 0; i < power.n_sensors(); ++i) {
    if (!study.survey().array().analog()->sensors()[i]) continue;
    hash.add(i);
    add_detector(hash, study.scene().sensor_models.at(study.scene().sensors[i].model).detector);
  }
  hash.add(study.spec().target.temperature_c);
  hash.add(study.spec().sensing.tick_rate_hz);
}

/// What rays don't show of them: how detectors and electronics are changed.
void add_effects(Hash& hash, const CoverageSpec& spec) {
  hash.add(spec.seed);
  hash.add(spec.sensing.reader);
  for (const EffectSpec& effect : spec.effects) {
    hash.add_text(effect.name);
    for (const auto& [name, value] : effect.parameters) {
      hash.add_text(name);
      hash.add(value);
    }
    for (const auto& [name, value] : effect.choices) {
      hash.add_text(name);
      hash.add_text(value);
    }
  }
}

}  // namespace

std::string fingerprint(const CoverageStudy& study) {
  Hash hash;
  hash.add_text(version() + git_revision());
  const RayBundle& rays = study.survey().array().clipped();
  for (const Ray& ray : rays.rays) {
    hash.add(ray.origin);
    hash.add(ray.direction);
  }
  hash.add(rays.range);
  hash.add(rays.zone_rays_begin);
  hash.add(rays.cluster_zones_begin);
  hash.add(rays.sensor_clusters_begin);
  const FloorGrid& grid = study.grid();
  hash.add(study.scene().floor.height_m());
  for (std::size_t row = 0; row < grid.n_rows(); ++row) {
    for (std::size_t column = 0; column < grid.n_columns(); ++column) {
      const Vec2 centre = grid.centre(column, row);
      hash.add(centre.x);
      hash.add(centre.y);
      hash.add(grid.on_floor(column, row));
    }
  }
  for (std::size_t pose = 0; pose < study.target().n_poses(); ++pose) {
    for (const PosedShape& solid : study.target().solids(Vec3(0.0), static_cast<std::int64_t>(pose))) {
      const auto& bar = std::get<PosedCapsule>(solid);
      hash.add(bar.a);
      hash.add(bar.b);
      hash.add(bar.radius);
    }
  }
  hash.add(study.n_windows());
  hash.add(study.spec().sensing.ticks_per_window);
  hash.add(study.spec().sensing.change_per);
  add_analog(hash, study);
  add_effects(hash, study.spec());
  return hash.value();
}

RowStore::RowStore(std::filesystem::path file, const CoverageStudy& study) : file_(std::move(file)) {
  const std::size_t n_counts = study.grid().n_columns() * study.scene().sensors.size();
  const std::string first_line = header(study);
  std::uintmax_t sound_bytes = 0;
  {
    std::ifstream old(file_, std::ios::binary);
    std::string line;
    if (std::getline(old, line) && !old.eof() && line == first_line) {
      sound_bytes = line.size() + 1;
      while (n_found_rows_ < study.grid().n_rows() && std::getline(old, line) && !old.eof()) {
        const std::vector<MotionCount> counts = parse(line, n_counts);
        if (counts.empty()) break;
        found_.insert(found_.end(), counts.begin(), counts.end());
        ++n_found_rows_;
        sound_bytes += line.size() + 1;
      }
    }
  }
  std::error_code ignored;
  if (sound_bytes > 0) std::filesystem::resize_file(file_, sound_bytes, ignored);
  stream_.open(file_, std::ios::binary | (sound_bytes > 0 ? std::ios::app : std::ios::trunc));
  if (sound_bytes == 0) stream_ << first_line << '\n' << std::flush;
  if (!stream_) throw Error(ErrorCode::io, Where{file_.string()}, "can't write");
}

void RowStore::append(const std::vector<MotionCount>& counts) {
  const std::string text = text_of(counts);
  stream_ << text << '#' << checksum(text) << '\n' << std::flush;
  if (!stream_) throw Error(ErrorCode::io, Where{file_.string()}, "can't write: is the disk full?");
}

void RowStore::remove() {
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

}  // namespace pirsim::studies
