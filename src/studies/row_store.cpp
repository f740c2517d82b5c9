#include "studies/coverage.hpp"

#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

#include "pirsim/error.hpp"
#include "pirsim/version.hpp"
#include "schema/fingerprint.hpp"

namespace pirsim::studies {
namespace {

// Structured bindings name every field, so that a new one doesn't compile until it stands here.

void add(Fingerprint& print, const TurnSpec& turn) {
  const auto& [axis, deg_per_s] = turn;
  print.add_each(axis, deg_per_s);
}

void add(Fingerprint& print, const XShapesSpec& target) {
  const auto& [heights_m, bar_length_m, bar_width_m, temperature_c, turns] = target;
  print.add_each(heights_m, bar_length_m, bar_width_m, temperature_c, turns.size());
  for (const TurnSpec& turn : turns) add(print, turn);
}

void add(Fingerprint& print, const CoverageSpec& spec) {
  const auto& [name, sensing, spacing_m, duration_s, without, without_where, target, seed, effects] = spec;
  print.add_each(sensing, spacing_m, duration_s, without, seed, effects);
  add(print, target);
}

std::string text_of(const std::vector<MotionCount>& counts) {
  std::string text;
  for (const MotionCount count : counts) text += std::to_string(count) + ' ';
  return text;
}

/// Counts of a line as append() writes it; none if they aren't those of a row.
std::vector<MotionCount> parse(const std::string& line, std::size_t n_counts, int n_windows) {
  std::vector<MotionCount> counts;
  std::istringstream text(line);
  for (int count = 0; text >> count && count >= 0 && count <= n_windows;)
    counts.push_back(static_cast<MotionCount>(count));
  return counts.size() == n_counts && text.eof() ? counts : std::vector<MotionCount>{};
}

std::string header(const CoverageStudy& study) { return "pirsim coverage rows of study " + fingerprint(study); }

/// What surfaces radiate, where a sensor has the physical response.
void add_background(Fingerprint& print, const CoverageStudy& study) {
  if (study.survey().array().analog() == nullptr) return;
  const sim::PowerModel& power = study.survey().array().analog()->power();
  for (std::uint32_t i = 0; i < power.clipped().rays.size(); ++i) {
    print.add_each(power.clipped().rays[i].direction, power.clipped().range[i], power.rays().weights[i],
                   power.background(i));
  }
}

}  // namespace

std::string fingerprint(const CoverageStudy& study) {
  Fingerprint print;
  print.add_each(version(), git_revision());
  add(print, study.spec());
  print.add_each(study.scene().sensors, study.scene().sensor_models);
  const RayBundle& rays = study.survey().array().clipped();
  for (const Ray& ray : rays.rays) print.add_each(ray.origin, ray.direction);
  print.add_each(rays.range, rays.zone_rays_begin, rays.cluster_zones_begin, rays.sensor_clusters_begin);
  print.add(study.scene().floor);
  add_background(print, study);
  return print.digest();
}

RowStore::RowStore(std::filesystem::path path, const CoverageStudy& study)
    : path_(std::move(path)), file_(path_, io::PosixFile::Mode::append) {
  file_.lock();
  const std::size_t n_counts = study.grid().n_columns() * study.scene().sensors.size();
  const std::string first_line = header(study);
  std::uint64_t sound_bytes = 0;
  io::SealedLines read;
  std::ifstream old(path_, std::ios::binary);
  std::string line;
  if (std::getline(old, line) && !old.eof() && read.opened(line) == first_line) {
    sound_bytes = line.size() + 1;
    lines_ = read;
    while (n_found_rows_ < study.grid().n_rows() && std::getline(old, line) && !old.eof()) {
      const std::optional<std::string> text = read.opened(line);
      if (!text) break;
      const std::vector<MotionCount> counts = parse(*text, n_counts, study.n_windows());
      if (counts.empty()) break;
      found_.insert(found_.end(), counts.begin(), counts.end());
      ++n_found_rows_;
      sound_bytes += line.size() + 1;
      lines_ = read;
    }
  }
  file_.truncate(sound_bytes);
  if (sound_bytes == 0) file_.append(lines_.sealed(first_line));
}

void RowStore::append(const std::vector<MotionCount>& counts) { file_.append(lines_.sealed(text_of(counts))); }

void RowStore::remove() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace pirsim::studies
