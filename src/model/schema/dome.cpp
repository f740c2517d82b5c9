#include "model/schema/dome.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace pirsim {
namespace {

/// Where a facet is off the lens axis, in degrees to the right and up.
struct OffAxis {
  double right_deg, up_deg;
};

/// A facet at this angle lets the element's far edge look out at the edge of the field of view.
double outermost_deg(double view_deg, double edge_mm, double focal_mm) {
  const double edge = radians(0.5 * view_deg);
  const double sine = edge_mm / focal_mm * std::cos(edge);
  return std::max(0.0, degrees(edge - std::asin(std::min(sine, 1.0))));
}

/// About a facet in the middle; full rings have 6, 12, 18, ... facets.
int rings_of(int facets) {
  int rings = 1;
  const auto full = [](int n) { return 1 + 3 * n * (n + 1); };
  while (facets - full(rings) > full(rings + 1) - facets) ++rings;
  return rings;
}

std::vector<OffAxis> facets_of(const DomeSpec& dome) {
  const double widest = outermost_deg(dome.wide_deg, 0.5 * dome.gap_mm + dome.strip_width_mm, dome.focal_mm);
  const double tallest =
      outermost_deg(dome.tall_deg.value_or(dome.wide_deg), 0.5 * dome.strip_height_mm, dome.focal_mm);
  const int rings = rings_of(dome.lenses);
  std::vector<OffAxis> facets;
  if (dome.lenses % 2 == 1) facets.push_back({0.0, 0.0});
  const int pairs = dome.lenses / 2;  // each ring has some, so that left and right are alike
  for (int ring = 1, placed = 0; ring <= rings; ++ring) {
    const int up_to_here = pairs * ring * (ring + 1) / (rings * (rings + 1));
    const int n = 2 * (up_to_here - placed);
    placed = up_to_here;
    for (int i = 0; i < n; ++i) {
      const double turn = radians(i * 360.0 / n);
      facets.push_back({widest * ring / rings * std::cos(turn), tallest * ring / rings * std::sin(turn)});
    }
  }
  return facets;
}

}  // namespace

std::vector<ClusterSpec> clusters_of(const DomeSpec& dome, double plane_m, double range_m) {
  std::vector<ClusterSpec> clusters;
  for (const OffAxis& facet : facets_of(dome)) {
    const double off_axis = radians(std::sqrt(facet.right_deg * facet.right_deg + facet.up_deg * facet.up_deg));
    const double turn = std::atan2(facet.up_deg, facet.right_deg);
    const Vec3 middle = dome.focal_mm * Vec3(std::sin(off_axis) * std::cos(turn), std::sin(off_axis) * std::sin(turn),
                                             std::cos(off_axis));
    ClusterSpec cluster;
    cluster.range_m = range_m;
    const double inner = 0.5 * dome.gap_mm, outer = inner + dome.strip_width_mm, high = 0.5 * dome.strip_height_mm;
    for (const int sign : {1, -1}) {  // of the right strip, and of the left one
      ZoneSpec zone{.polarity = sign};
      const std::array<Vec2, 4> strip{Vec2(inner, -high), Vec2(outer, -high), Vec2(outer, high), Vec2(inner, high)};
      for (std::size_t i = 0; i < strip.size(); ++i) {  // each point looks out through the facet's middle
        const Vec2 out(middle.x - sign * strip[i].x, middle.y - strip[i].y);
        zone.corners[i] = out * (plane_m / middle.z);
        cluster.centre += zone.corners[i] / 8.0;
      }
      cluster.zones.push_back(zone);
    }
    clusters.push_back(std::move(cluster));
  }
  return clusters;
}

}  // namespace pirsim
