// All rays of all sensors of a scene, and which zones they make active.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pirsim/shapes.hpp"

namespace pirsim {

// All rays of all sensors of a scene, compiled once and traced every tick.

/// Rays grouped by zone, zones by cluster, clusters by sensor, each group contiguous and in file order.
/// `zone_rays_begin` has n_zones + 1 entries: zone z owns rays [zone_rays_begin[z], zone_rays_begin[z + 1]);
/// likewise `cluster_zones_begin` (n_clusters + 1) and `sensor_clusters_begin` (n_sensors + 1).
struct RayBundle {
  std::vector<Ray> rays;     ///< (n_rays) world frame
  std::vector<float> range;  ///< (n_rays) metres; rated range, or less where the room cuts the ray
  std::vector<std::uint32_t> zone_rays_begin{0};
  std::vector<std::uint32_t> cluster_zones_begin{0};
  std::vector<std::uint32_t> sensor_clusters_begin{0};

  [[nodiscard]] std::size_t n_zones() const noexcept { return zone_rays_begin.size() - 1; }
  [[nodiscard]] std::size_t n_clusters() const noexcept { return cluster_zones_begin.size() - 1; }
  [[nodiscard]] std::size_t n_sensors() const noexcept { return sensor_clusters_begin.size() - 1; }
  /// Of a sensor; those of n_sensors() are where the last sensor's end.
  [[nodiscard]] std::uint32_t first_zone(std::size_t sensor) const noexcept {
    return cluster_zones_begin[sensor_clusters_begin[sensor]];
  }
  [[nodiscard]] std::uint32_t first_ray(std::size_t sensor) const noexcept {
    return zone_rays_begin[first_zone(sensor)];
  }
};

// Which zones are active at a tick, one bit a zone: those with a ray that hits a person.

/// A set of zones (or of other things counted from 0) as bits in 64-bit words. The unused bits of the last word are 0.
class ZoneSet {
 public:
  using Word = std::uint64_t;
  static constexpr std::size_t bits_per_word = 64;

  ZoneSet() = default;
  explicit ZoneSet(std::size_t n) : n_(n), words_((n + bits_per_word - 1) / bits_per_word, 0) {}

  [[nodiscard]] std::size_t size() const noexcept { return n_; }
  [[nodiscard]] bool test(std::size_t i) const noexcept {
    return ((words_[i / bits_per_word] >> (i % bits_per_word)) & 1U) != 0;
  }
  void insert(std::size_t i) noexcept { words_[i / bits_per_word] |= Word{1} << (i % bits_per_word); }
  /// All from `first` to `end` - 1.
  void insert(std::size_t first, std::size_t end) noexcept {
    for (; first < end; ++first) insert(first);
  }
  void erase(std::size_t i) noexcept { words_[i / bits_per_word] &= ~(Word{1} << (i % bits_per_word)); }
  void clear() noexcept { std::ranges::fill(words_, Word{0}); }
  /// Adds the members of a set of the same size, given as words.
  void add(std::span<const Word> words) noexcept {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= words[i];
  }
  /// Members that one word holds, out of many that hold none.
  struct Part {
    std::size_t at = 0;  ///< index of the word
    Word word = 0;
  };
  void add(std::span<const Part> parts) noexcept {
    for (const Part& part : parts) words_[part.at] |= part.word;
  }
  [[nodiscard]] std::span<const Word> words() const noexcept { return words_; }
  [[nodiscard]] std::span<Word> words() noexcept { return words_; }
  bool operator==(const ZoneSet&) const = default;

 private:
  std::size_t n_ = 0;
  std::vector<Word> words_;
};

/// How rays are traced; changes no bit of any result.
enum class TracerKind {
  reference,  ///< the plain way: whole scene rebuilt, closest hit of every ray at its full rated range
  embree,     ///< rays cut once at the room, one instance moved per body part, occlusion queries
  direct,     ///< rays cut once at the room, cones around rays, then every solid against many rays at a time
};
/// What --tracer auto stands for.
inline constexpr TracerKind fastest_tracer = TracerKind::direct;

}  // namespace pirsim
