// The digest of what results were made from, by which kept results are known as those of a study or refused.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/digest.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim {

/// Everything that is added, one after the other; every list and text with its length. Of a spec that is all of its
/// fields, but for what only messages say (names, descriptions, places in files).
class Fingerprint {
 public:
  template <typename Number>
  requires(std::is_arithmetic_v<Number> || std::is_enum_v<Number>) void add(Number value) {
    digest_.add({reinterpret_cast<const char*>(&value), sizeof value});
  }
  void add(std::string_view text);
  void add(const std::string& text) { add(std::string_view(text)); }
  void add(const Vec2& p) { add_each(p.x, p.y); }
  void add(const Vec3& p) { add_each(p.x, p.y, p.z); }
  void add(const Vec3f& p) { add_each(p.x, p.y, p.z); }
  void add(const Frame& frame);
  template <typename Value>
  void add(const std::optional<Value>& value) {
    add(value.has_value());
    if (value) add(*value);
  }
  template <typename Value>
  void add(const std::vector<Value>& values) {
    add(values.size());
    for (const Value& value : values) add(value);
  }
  template <typename Value, typename Order>
  void add(const std::map<std::string, Value, Order>& values) {
    add(values.size());
    for (const auto& [name, value] : values) add_each(name, value);
  }
  void add(const DetectorSpec& detector);
  void add(const ZoneSpec& zone);
  void add(const ClusterSpec& cluster);
  void add(const SensorModelSpec& model);
  void add(const TriMesh& mesh);
  void add(const SensorSpec& sensor);
  void add(const SeatSpec& seat);
  void add(const EntranceSpec& entrance);
  void add(const FloorArea& floor);
  void add(const SceneSpec& scene);
  void add(const SensingSpec& sensing);
  void add(const EffectSpec& effect);

  template <typename... Values>
  void add_each(const Values&... values) {
    (add(values), ...);
  }

  [[nodiscard]] std::string digest() const { return digest_.hex(); }

 private:
  Sha256 digest_;
};

}  // namespace pirsim
