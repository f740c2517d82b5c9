// Drawing until something usable comes out: what rooms and flats have in common.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pirsim/io.hpp"
#include "pirsim/scene.hpp"

namespace pirsim::dataset {

/// Why an attempt failed, in words that fit behind "n times".
struct NoPlace {
  std::string reason;
};

/// What a scene must allow besides: its seats, places and entrances are reached, and its sensors see somebody.
struct Demands {
  std::vector<std::string> shared_beds{};  ///< places to lie that must be got onto from their own side
  std::size_t least_places = 0;            ///< of a grid of 0.25 m, where each sensor must see who stands there
};

/// Why nobody could use what was drawn, or nothing: what the largest person can't reach from the entrances, a sensor
/// that sees nobody.
[[nodiscard]] std::string fault_of(const SceneSpec& scene, const Demands& demands = {});

/// Finds each model once, however many attempts there are. Throws Error(input) where it was named.
class ModelFinder {
 public:
  struct Named {
    std::vector<std::string> models;
    Where where;
  };
  ModelFinder(std::vector<Named> named, Where otherwise, const io::SceneOptions& options)
      : named_(std::move(named)), otherwise_(std::move(otherwise)), options_(options) {}
  /// Of all sensors of the scene.
  void add_to(SceneSpec& scene);

 private:
  std::vector<Named> named_;
  Where otherwise_;
  const io::SceneOptions& options_;
  std::map<std::string, SensorModelSpec> known_;
};

/// Why attempts failed, and how often.
class Failures {
 public:
  void add(const std::string& reason) { ++reasons_[reason]; }
  /// "room 3: none of 300 rooms drawn ..."; what: "room".
  [[noreturn]] void give_up(const std::string& what, int number, const Where& where) const;

 private:
  std::map<std::string, int> reasons_;
};

}  // namespace pirsim::dataset
