// The digest of what results were made from, by which kept results are known as those of a study or refused.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "model/core/random.hpp"
#include "model/schema/fields.hpp"

namespace pirsim {

/// Everything that is added, one after the other; every list and text with its length. Of a spec that is all of its
/// fields but those that only messages say.
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
  template <typename Value, std::size_t n>
  void add(const std::array<Value, n>& values) {
    for (const Value& value : values) add(value);
  }
  template <typename... Values>
  void add(const std::variant<Values...>& value) {
    add(value.index());
    std::visit([&](const auto& one) { add(one); }, value);
  }
  void add(const FloorArea& floor);
  void add(const MeshSolid& solid);
  template <Described Spec>
  void add(const Spec& spec) {
    each_field<Spec>([&](const auto& field) {
      if (field.use == Use::study) add(spec.*field.member);
    });
  }

  template <typename... Values>
  void add_each(const Values&... values) {
    (add(values), ...);
  }

  [[nodiscard]] std::string digest() const { return digest_.hex(); }

 private:
  Sha256 digest_;
};

}  // namespace pirsim
