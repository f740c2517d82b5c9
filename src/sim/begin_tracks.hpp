// What all ways of tracing a Model's zones begin with.
#pragma once

#include "sim/zone_tracks.hpp"

namespace pirsim::sim {

/// Without runs yet. Throws Error(usage) for sensors that zones alone don't explain.
[[nodiscard]] inline ZoneTracks begin_tracks(const Model& model) {
  if (model.analog() != nullptr) {
    throw Error(ErrorCode::usage, "zones alone don't tell what sensors with an analog response do");
  }
  ZoneTracks tracks;
  tracks.n_sensors = model.scene().sensors.size();
  tracks.ticks_per_window = model.script().sensing.ticks_per_window;
  tracks.reader = model.script().sensing.reader;
  return tracks;
}

}  // namespace pirsim::sim
