// A study compiled for running: everything immutable, shared by all threads.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "pirsim/rays.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim {
namespace sim {
class CompiledStudy;
}

class Model;

struct CompileOptions {
  TracerKind tracer = fastest_tracer;
  /// What is the same in this Model (the room, where people can go and what they do) is shared with the new one instead
  /// of made anew, which changes nothing but the time it takes.
  const Model* like = nullptr;
};

/// Copies share what they hold.
class Model {
 public:
  /// As they were given to compile(), before effects.
  [[nodiscard]] const SceneSpec& scene() const noexcept;
  [[nodiscard]] const ScriptSpec& script() const noexcept;

  /// Runs are numbered replicate by replicate, trials in order within each.
  [[nodiscard]] std::uint32_t n_runs() const noexcept;
  [[nodiscard]] const std::string& trial_of(std::uint32_t run) const noexcept;
  [[nodiscard]] int replicate_of(std::uint32_t run) const noexcept;  ///< counts from 1
  [[nodiscard]] double tick_s() const noexcept;
  /// Of the rows: replicate, trial, time_s, `time` if runs have a clock, phase, people, then one an area and one a
  /// sensor.
  [[nodiscard]] std::vector<std::string> columns() const;
  /// Whose people are counted by themselves: the ids of the scene's areas, then "elsewhere" if some of the floor is in
  /// none. Empty without areas.
  [[nodiscard]] const std::vector<std::string>& areas() const noexcept;
  /// Of all sensors with every effect applied, world frame, cut at the room.
  [[nodiscard]] const RayBundle& rays() const noexcept;

  /// What is behind it, for pirsim's own sources: its header isn't installed.
  [[nodiscard]] const sim::CompiledStudy& compiled() const noexcept { return *compiled_; }

 private:
  friend Model compile(SceneSpec scene, ScriptSpec script, const CompileOptions& options);
  friend class State;
  explicit Model(std::shared_ptr<const sim::CompiledStudy> compiled) : compiled_(std::move(compiled)) {}

  std::shared_ptr<const sim::CompiledStudy> compiled_;
};

/// The only door from Spec to Model; script.effects are applied here, so that whoever uses a Model has them. Throws
/// Error(input) for what a file's reader would refuse as well (see check()), names that the scene or the catalogue
/// lacks or actions in an impossible order, Error(infeasible) for a seat or point that can't be reached.
[[nodiscard]] Model compile(SceneSpec scene, ScriptSpec script, const CompileOptions& options = {});

}  // namespace pirsim
