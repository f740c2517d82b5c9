// A lens of which nobody has a drawing: small lenses on a dome, told by what data sheets say.
#pragma once

#include <optional>
#include <tuple>
#include <vector>

#include "model/schema/field.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim {

/// Small lenses on a dome before a dual element: two strips side by side, wired in opposition. How facets are laid out:
/// docs/formats/sensor.md.
struct DomeSpec {
  int lenses = 29;                 ///< small ones, the facets; each throws two zones (`assumed`; 10 to 40)
  double wide_deg = 110.0;         ///< field of view from the left edge to the right (`assumed`; 60 to 170)
  std::optional<double> tall_deg;  ///< from the lower edge to the upper; none: as wide_deg
  double focal_mm = 12.0;          ///< from the element to each facet (`assumed`; 8 to 25)
  double strip_width_mm = 1.0;     ///< of one half of the element (`assumed`: as usual dual elements)
  double strip_height_mm = 2.0;    ///< the same
  double gap_mm = 1.0;             ///< between the halves (the same)
};

template <>
struct Fields<DomeSpec> {
  using S = DomeSpec;
  static constexpr NumberRange view_deg{.above = 0.0, .max = 170.0};  // wider, the plane has no room for the zones
  static constexpr NumberRange size_mm{.above = 0.0, .max = 100.0};
  static constexpr std::tuple all{
      field("lenses", &S::lenses, IntegerRange{.min = 1, .max = 200}, "small lenses on the dome, of two zones each"),
      field("wide_deg", &S::wide_deg, view_deg, "field of view from the left edge to the right"),
      field("tall_deg", &S::tall_deg, view_deg, "field of view from the lower edge to the upper; by default as wide"),
      field("focal_mm", &S::focal_mm, size_mm, "from the element to the dome"),
      field("strip_width_mm", &S::strip_width_mm, size_mm, "width of each of the element's two halves"),
      field("strip_height_mm", &S::strip_height_mm, size_mm, "their height"),
      field("gap_mm", &S::gap_mm, NumberRange{.min = 0.0, .max = 100.0}, "between them")};
};

/// A cluster of two zones of opposite sign for each lens. An odd one looks ahead; the others lie in rings, in pairs to
/// the left and right, with about as much room round a ring as between rings. The outermost zones end where the field
/// of view does.
[[nodiscard]] std::vector<ClusterSpec> clusters_of(const DomeSpec& dome, double plane_m, double range_m);

}  // namespace pirsim
