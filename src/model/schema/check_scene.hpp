// The areas of a scene: which one somebody is in, and which one a sensor watches.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/geom/floor.hpp"
#include "pirsim/scene.hpp"

namespace pirsim {

/// Where those are who are in no area: no area has this id.
inline constexpr std::string_view elsewhere = "elsewhere";

/// A value; empty for a scene without areas.
class Areas {
 public:
  Areas() = default;
  explicit Areas(const SceneSpec& scene);

  /// The ids, and `elsewhere` if some of the floor is in no area. Their people sum to those on the floor.
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
  [[nodiscard]] std::size_t size() const noexcept { return names_.size(); }
  [[nodiscard]] bool empty() const noexcept { return names_.empty(); }

  /// Index into names() for a point on the floor; call only if there are areas.
  [[nodiscard]] std::size_t at(const Vec2& place) const noexcept { return parts_.at(place); }
  /// The name, or no text without areas.
  [[nodiscard]] std::string_view name_at(const Vec2& place) const noexcept {
    return empty() ? std::string_view() : std::string_view(names_[at(place)]);
  }
  /// (n_sensors) index into names() of the area that each sensor watches: the one that its mark says, or the one below
  /// it. A sensor on a wall, beside the area, watches the one that it faces. None: it is over no area.
  [[nodiscard]] const std::vector<std::optional<std::size_t>>& of_sensors() const noexcept { return of_sensors_; }
  /// The same as a name; `elsewhere` or no text (without areas) for none.
  [[nodiscard]] std::string_view name_of_sensor(std::size_t sensor) const noexcept;
  /// (n_areas) indices of sensors that watch the area.
  [[nodiscard]] std::vector<std::size_t> sensors_of(std::size_t area) const;

  /// (size()) of the floor.
  [[nodiscard]] const std::vector<double>& areas_m2() const noexcept { return parts_.areas_m2(); }

 private:
  FloorParts parts_;
  std::vector<std::string> names_;
  std::vector<std::optional<std::size_t>> of_sensors_;
};

/// The ids of a scene's areas, seats or entrances.
template <typename Spec>
[[nodiscard]] std::vector<std::string> ids_of(const std::vector<Spec>& specs) {
  std::vector<std::string> names;
  for (const Spec& spec : specs) names.push_back(spec.id);
  return names;
}

// Thermopile arrays among the sensors.

/// Takes those sensors whose models are arrays into scene.arrays. All models are known.
void move_arrays(SceneSpec& scene);
/// Throws Error(input) if the scene has any: "reconcile takes no thermal array, and the scene has 'A1': ...".
void refuse_arrays(const SceneSpec& scene, const std::string& who);

// Whether a scene is measured in metres.

/// What its sizes say if they are hardly metres: which unit makes a plausible room of them, and of what size. Nothing
/// for a scene that may be in metres.
[[nodiscard]] std::optional<std::string> doubt_of_unit(const SceneSpec& scene);

}  // namespace pirsim
