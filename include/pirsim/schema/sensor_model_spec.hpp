// A sensor's optics as plain data: which zones its lens throws into the room.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "pirsim/geom/frame.hpp"
#include "pirsim/schema/detector_spec.hpp"
#include "pirsim/schema/response_spec.hpp"

namespace pirsim {

/// One detection zone: the image of one pyroelectric element through one lens facet, drawn on the plane
/// `plane_m` ahead of the sensor (x to the right, y up, metres). The direction of a point is
/// normalise(x, y, -plane_m) in the sensor's frame.
struct ZoneSpec {
  std::array<Vec2, 4> corners{};  ///< in order round the zone, convex
  int polarity = 1;               ///< +1 or -1, sign of the element (`assumed`: checkerboard on the quad)
};

/// The zones of one facet: what the paper calls a cluster of beams.
struct ClusterSpec {
  Vec2 centre{0.0};      ///< on the plane, metres
  double range_m = 0.0;  ///< rated detection distance of the facet's lens step
  int lens_step = 0;     ///< 1 for the farthest-reaching row
  std::vector<ZoneSpec> zones;
};

struct SensorModelSpec {
  std::string id;  ///< as scenes name it, "EKMC1604111"
  std::string description;
  double plane_m = 1.0;  ///< distance of the plane on which the zones are drawn
  std::vector<ClusterSpec> clusters;
  Response response = Response::zones;
  OpticsSpec optics;
  DetectorSpec detector;  ///< electronics, for the physical response
};

}  // namespace pirsim
