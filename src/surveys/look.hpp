// One run followed for pictures: where people's limbs are, and what sensors see, at a few moments a second.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "files/write/gltf_writer.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/state.hpp"

namespace pirsim::studies {

struct FilmSpec {
  double from_s = 0.0;  ///< taken down to the end of a window
  double to_s = std::numeric_limits<double>::infinity();
  double keys_per_s = 10.0;
  std::vector<std::size_t> beams_of;                ///< sensors
  std::function<void(double seconds)> simulated{};  ///< after so much more, as far as from_s too
};

/// Frames of one thermal array, as many as are new at a key.
struct FilmFrames {
  int rows = 0, columns = 0;
  std::vector<std::vector<float>> celsius;  ///< (n_frames x rows * columns)
  std::vector<std::uint32_t> at_key;        ///< (n_keys) which of them
};

struct Film {
  io::ExportedRun run;
  std::vector<Sample> rows;  ///< of the windows from from_s to to_s
  /// (n_keys) zones of Model::rays() that see somebody at the key time.
  std::vector<std::vector<std::uint32_t>> active_zones;
  /// (n_sensors x n_keys) of each analog sensor: volts above the offset, the largest by amount since the key before.
  /// Empty for a sensor that answers by its zones.
  std::vector<std::vector<double>> signals_v;
  std::vector<FilmFrames> frames{};  ///< (n_arrays)
};

/// Bytes of the film's animation: of so many people for so long.
[[nodiscard]] double expected_bytes(std::size_t n_people, double seconds, double keys_per_s);

/// People and beams as the run shows them from from_s to to_s or to its end. Throws Error(infeasible) if the run can't
/// go on.
[[nodiscard]] Film film(const Model& model, std::uint32_t run, const FilmSpec& spec);

}  // namespace pirsim::studies
