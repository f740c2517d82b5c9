#include "engine/rt/ray_kernel.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "support/catch.hpp"
#include "support/random_shapes.hpp"

using namespace pirsim;
using namespace pirsim::rt;
using pirsim::testing::Draw;

namespace {

/// A ray aimed at, or close by, a sphere: half of the rays of a kernel test shall hit the solid.
Ray ray_near(Draw& draw, const BoundingSphere& sphere) {
  const Vec3 centre(sphere.centre);
  const double radius = sphere.radius;
  const Vec3 from = centre + draw.between(0.0, 9.0) * draw.direction();
  return testing::ray_through(from, centre + 0.9 * radius * draw.between(0.0, 1.0) * draw.direction());
}

void set(RayPacket& packet, std::size_t i, const Ray& ray, float range) {
  packet.origin_x[i] = ray.origin.x;
  packet.origin_y[i] = ray.origin.y;
  packet.origin_z[i] = ray.origin.z;
  packet.direction_x[i] = ray.direction.x;
  packet.direction_y[i] = ray.direction.y;
  packet.direction_z[i] = ray.direction.z;
  packet.range[i] = range;
}

struct Case {
  PosedShape solid;
  RayPacket packet{};
  PacketHits expected = 0;  ///< by entry_distance()
};

/// The range is drawn, or the entry distance itself, or the next float above it: ties are where bits would differ.
Case random_case(Draw& draw) {
  Case c;
  c.solid = place(draw.shape(), {draw.rotation(), draw.inside({-6, 0, -6}, {6, 3, 6})});
  const BoundingSphere sphere = bounding_sphere(c.solid);
  for (std::size_t i = 0; i < packet_size; ++i) {
    const Ray ray = ray_near(draw, sphere);
    float range = static_cast<float>(draw.between(0.0, 12.0));
    const auto distance = entry_distance(ray, c.solid, 1e9F);
    const std::uint32_t choice = draw.index(4);
    if (distance && choice == 0) range = *distance;
    if (distance && choice == 1) range = std::nextafter(*distance, 1e9F);
    set(c.packet, i, ray, range);
    if (entry_distance(ray, c.solid, range)) c.expected = static_cast<PacketHits>(c.expected | (1U << i));
  }
  return c;
}

PacketHits hits(const RayKernel& kernel, const Case& c) {
  const std::uint32_t first = 0;
  const BoundingSphere sphere = bounding_sphere(c.solid);
  PacketHits hits = 0;
  if (const auto* s = std::get_if<PosedSphere>(&c.solid))
    kernel.intersect_sphere(&c.packet, &first, 1, *s, sphere, &hits);
  if (const auto* s = std::get_if<PosedCapsule>(&c.solid))
    kernel.intersect_capsule(&c.packet, &first, 1, *s, sphere, &hits);
  if (const auto* s = std::get_if<PosedBox>(&c.solid)) kernel.intersect_box(&c.packet, &first, 1, *s, sphere, &hits);
  return hits;
}

std::vector<const RayKernel*> available_kernels() {
  std::vector<const RayKernel*> kernels;
  for (const RayKernel* kernel : all_ray_kernels()) {
    if (kernel->is_available()) kernels.push_back(kernel);
  }
  return kernels;
}

}  // namespace

TEST_CASE("every instruction set gives the bits of entry_distance for 1,000,000 rays, ties included", "[rt]") {
  Draw draw(77);
  const auto kernels = available_kernels();
  std::size_t n_hits = 0, n_wrong = 0;
  constexpr std::size_t n_packets = 62500;
  for (std::size_t i = 0; i < n_packets; ++i) {
    const Case c = random_case(draw);
    n_hits += static_cast<std::size_t>(std::popcount(c.expected));
    for (const RayKernel* kernel : kernels) n_wrong += hits(*kernel, c) == c.expected ? 0 : 1;
  }
  CHECK(n_wrong == 0);
  CHECK(n_hits > n_packets * packet_size / 5);
  CHECK(n_hits < n_packets * packet_size * 4 / 5);
  WARN(kernels.size() << " instruction sets, the widest " << kernels.front()->name << "; " << n_hits << " hits");
}

TEST_CASE("rays along a capsule's axis, from inside and grazing agree as well", "[rt]") {
  Draw draw(78);
  std::size_t n_wrong = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 at = draw.inside({-6, 0, -6}, {6, 3, 6});
    const Quat rotation = draw.rotation();
    const double radius = draw.between(0.03, 0.15), half_length = draw.between(0.0, 0.4);
    Case c;
    c.solid = place(Capsule{radius, half_length}, {rotation, at});
    for (std::size_t k = 0; k < packet_size; ++k) {
      const Vec3 along = rotation * Vec3(0, 1, 0), aside = rotation * Vec3(1, 0, 0);
      const double tilt = k % 4 == 0 ? 0.0 : draw.between(-0.02, 0.02);
      const double off = k % 2 == 0 ? radius * draw.between(0.9999, 1.0001) : radius * draw.between(0.0, 1.2);
      const Vec3 from = at + off * aside - draw.between(-0.2, 5.0) * along;
      const Ray ray = testing::ray_through(from, from + along + tilt * draw.direction());
      set(c.packet, k, ray, 12.0F);
      if (entry_distance(ray, c.solid, 12.0F)) c.expected = static_cast<PacketHits>(c.expected | (1U << k));
    }
    for (const RayKernel* kernel : available_kernels()) n_wrong += hits(*kernel, c) == c.expected ? 0 : 1;
  }
  CHECK(n_wrong == 0);
}

TEST_CASE("single rays that pass, begin or end within micrometres of a capsule's surface agree as well", "[rt]") {
  Draw draw(80);
  const auto kernels = available_kernels();
  const auto tiny = [&] { return (draw.index(2) == 0 ? 1.0 : -1.0) * std::pow(10.0, draw.between(-7.0, -1.5)); };
  std::size_t n_wrong = 0, n_hits = 0;
  constexpr std::size_t n = 200000;
  for (std::size_t i = 0; i < n; ++i) {
    const double reach = draw.index(4) == 0 ? 1000.0 : 6.0;
    const Vec3 at = draw.inside(Vec3(-reach), Vec3(reach));
    const Quat rotation = draw.rotation();
    const double radius = draw.between(0.02, 0.15), half_length = draw.index(8) == 0 ? 0.0 : draw.between(0.0, 0.4);
    const Vec3 bone = rotation * Vec3(0, 1, 0), aside = rotation * Vec3(1, 0, 0), normal = rotation * Vec3(0, 0, 1);
    const double angle = draw.index(2) == 0 ? draw.between(0.0, 3.14) : std::pow(10.0, draw.between(-4.0, 0.0));
    const Vec3 direction = std::cos(angle) * bone + std::sin(angle) * aside;
    const Vec3 nearest = at + half_length * std::clamp(draw.between(-1.5, 1.5), -1.0, 1.0) * bone;
    const double before = draw.index(3) == 0 ? tiny() : draw.between(-0.5, 15.0);
    const Vec3 from = nearest + (radius + tiny()) * normal - before * direction;
    const Ray ray = testing::ray_through(from, from + direction);
    Case c;
    c.solid = place(Capsule{radius, half_length}, {rotation, at});
    const double range = draw.index(3) == 0 ? before + tiny() : draw.between(0.0, 20.0);
    for (std::size_t k = 0; k < packet_size; ++k) set(c.packet, k, ray, k == 0 ? static_cast<float>(range) : -1.0F);
    if (entry_distance(ray, c.solid, c.packet.range[0])) c.expected = 1;
    n_hits += c.expected;
    for (const RayKernel* kernel : kernels) n_wrong += hits(*kernel, c) == c.expected ? 0 : 1;
  }
  CHECK(n_wrong == 0);
  CHECK(n_hits > n / 5);
  CHECK(n_hits < n * 4 / 5);
}

TEST_CASE("no cone that is culled has a ray that hits the sphere, whatever the instruction set", "[rt]") {
  Draw draw(79);
  std::size_t n_left_out = 0, n_faults = 0, n_cones = 0;
  for (int i = 0; i < 300; ++i) {
    RayBundle bundle;
    const Vec3 eye = draw.inside({-3, 1, -3}, {3, 3, 3});
    for (int k = 0; k < 340; ++k) {
      bundle.rays.push_back(testing::ray_through(eye, eye + Vec3(0, 0, -1) + 0.7 * draw.direction()));
      bundle.range.push_back(static_cast<float>(draw.between(0.5, 12.0)));
    }
    bundle.zone_rays_begin = {0, 340};
    bundle.cluster_zones_begin = {0, 1};
    bundle.sensor_clusters_begin = {0, 1};
    const auto packets = packet_of_rays(bundle);
    const auto cones = cones_around(packets);
    const BoundingSphere sphere{Vec3f(draw.inside({-4, 0, -8}, {4, 3, 0})),
                                static_cast<float>(draw.between(0.05, 0.9))};
    for (const RayKernel* kernel : available_kernels()) {
      std::vector<std::uint32_t> kept(cones.size() * packet_size);
      kept.resize(kernel->cull(cones.data(), cones.size(), sphere, kept.data()));
      n_cones += packets.size();
      for (std::uint32_t p = 0; p < packets.size(); ++p) {
        if (std::ranges::binary_search(kept, p)) continue;
        ++n_left_out;
        for (std::size_t k = 0; k < packet_size; ++k) {
          const RayPacket& packet = packets[p];
          const Ray ray{Vec3f(packet.origin_x[k], packet.origin_y[k], packet.origin_z[k]),
                        Vec3f(packet.direction_x[k], packet.direction_y[k], packet.direction_z[k])};
          n_faults += entry_distance(ray, PosedSphere{sphere.centre, sphere.radius}, packet.range[k]) ? 1 : 0;
        }
      }
    }
  }
  CHECK(n_faults == 0);
  CHECK(n_left_out > n_cones / 2);  // and it is worth while
}
