// The floor area of a scene, joined from all nodes that are marked as floor. Private to io.
#pragma once

#include <string>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::io::detail {

class FloorBuilder {
 public:
  explicit FloorBuilder(Diagnostics& faults) : faults_(faults) {}

  /// Outline of a flat horizontal mesh, world frame.
  void add_mesh(const TriMesh& mesh, const Where& where, const std::string& label);
  /// Corners in the world.
  void add_polygon(const std::vector<Vec3>& corners, const Where& where, const std::string& label);

  /// Adds a fault if parts overlap or differ in height.
  [[nodiscard]] FloorArea build();

 private:
  struct Part {
    std::vector<std::vector<Vec2>> loops;
    double height_m = 0.0;
    Where where;
    std::string label;
  };
  void add(Part part);
  [[nodiscard]] bool flat(const std::vector<Vec3>& points, const Where& where, const std::string& label);

  Diagnostics& faults_;
  std::vector<Part> parts_;
  std::size_t n_corners_ = 0;
};

}  // namespace pirsim::io::detail
