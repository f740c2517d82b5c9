#include "rt/direct_tracer.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <glm/geometric.hpp>
#include <numeric>
#include <type_traits>

#include "rt/device.hpp"

namespace pirsim::rt {
namespace {

/// By bytes, so that 0 and -0 count as different and no number as itself.
bool is_same(const PosedShape& a, const PosedShape& b) noexcept {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&b](const auto& solid) {
        using Solid = std::remove_cvref_t<decltype(solid)>;
        static_assert(std::is_trivially_copyable_v<Solid>);
        return std::memcmp(&solid, std::get_if<Solid>(&b), sizeof solid) == 0;
      },
      a);
}

/// For solids that have no test of many rays at a time.
PackHits enter_one_by_one(const RayPack& pack, const PosedShape& solid, float* distances) noexcept {
  unsigned int hits = 0;
  for (unsigned int i = 0; i < pack_size; ++i) {
    const Ray ray{Vec3f(pack.origin_x[i], pack.origin_y[i], pack.origin_z[i]),
                  Vec3f(pack.direction_x[i], pack.direction_y[i], pack.direction_z[i])};
    const auto distance = entry_distance(ray, solid, pack.range[i]);
    if (!distance) continue;
    hits |= 1U << i;
    distances[i] = *distance;
  }
  return static_cast<PackHits>(hits);
}

}  // namespace

DirectTracer::DirectTracer(const TracerSetup& setup, const RayKernel& kernel)
    : kernel_(kernel),
      n_words_(ZoneSet(setup.clipped->n_zones()).words().size()),
      packs_(pack_rays(*setup.clipped)),
      cones_(cones_around(packs_)),
      near_person_(packs_.size()),
      near_solid_(packs_.size()),
      hits_(packs_.size()),
      all_(packs_.size()),
      distances_(packs_.size() * pack_size),
      nearest_(setup.clipped->rays.size(), unlimited),
      first_met_(setup.clipped->rays.size()),
      zones_(setup.clipped->n_zones()) {
  std::iota(all_.begin(), all_.end(), 0U);
  for (const Ray& ray : setup.clipped->rays) farthest_m_ = std::max(farthest_m_, glm::length(ray.origin));
  near_person_cones_.reserve(cones_.size());
}

void DirectTracer::find_moved(std::span<const PosedShape> solids, Memory& memory) {
  memory.slots.resize(solids.size());
  moved_.clear();
  left_.clear();
  for (std::size_t i = 0; i < solids.size(); ++i) {
    Slot& slot = memory.slots[i];
    if (slot.solid && is_same(*slot.solid, solids[i])) continue;
    slot.solid = solids[i];
    moved_.push_back(static_cast<std::uint32_t>(i));
    if (!slot.near.cover(solids[i])) left_.push_back(static_cast<std::uint32_t>(i));
  }
}

void DirectTracer::add(std::size_t person, std::span<const PosedShape> solids, ZoneSet& zones) {
  if (people_.size() <= person) people_.resize(person + 1);
  Memory& memory = people_[person];
  find_moved(solids, memory);
  memory.hits.resize(solids.size() * n_words_);
  if (!left_.empty()) gather(solids, memory);
  for (const std::uint32_t i : moved_) find_zones(solids[i], memory.slots[i].near, &memory.hits[i * n_words_]);
  for (std::size_t i = 0; i < solids.size(); ++i) zones.add({&memory.hits[i * n_words_], n_words_});
}

/// A millimetre, and far above single precision's rounding wherever the ray starts.
float DirectTracer::slack_m(const PosedShape& solid) const noexcept {
  const Ball ball = ball_around(solid);
  return 1e-3F + 1e-5F * (farthest_m_ + glm::length(ball.centre) + ball.radius);
}

void DirectTracer::gather(std::span<const PosedShape> solids, Memory& memory) {
  grown_.clear();
  balls_.clear();
  for (const std::uint32_t i : left_) {
    grown_.push_back(memory.slots[i].near.begin(solids[i], slack_m(solids[i])));
    balls_.push_back(ball_around(grown_.back()));
  }
  const std::size_t n = kernel_.cull(cones_.data(), cones_.size(), ball_around(balls_), near_person_.data());
  pick(cones_, near_person_.data(), n, near_person_cones_);
  for (std::size_t k = 0; k < left_.size(); ++k) {
    gather_one(grown_[k], balls_[k], memory.slots[left_[k]].near);
  }
}

void DirectTracer::gather_one(const PosedShape& grown, const Ball& ball, NearRays& near) {
  const std::size_t n = kernel_.cull(near_person_cones_.data(), near_person_cones_.size(), ball, near_solid_.data());
  for (std::size_t k = 0; k < n; ++k) near_solid_[k] = near_person_[near_solid_[k]];
  meet(grown, ball, packs_, {near_solid_.data(), n});
  for (std::size_t k = 0; k < n; ++k) near.add(packs_[near_solid_[k]], hits_[k]);
  near.end();
}

void DirectTracer::find_zones(const PosedShape& solid, const NearRays& near, ZoneSet::Word* zones) {
  std::fill_n(zones, n_words_, ZoneSet::Word{0});
  const std::span<const RayPack> packs = near.packs();
  if (packs.empty()) return;
  meet(solid, ball_around(solid), packs, {all_.data(), packs.size()});
  for (std::size_t k = 0; k < packs.size(); ++k) {
    for (unsigned int hits = hits_[k]; hits != 0; hits &= hits - 1) {
      const std::uint32_t zone = packs[k].zone[std::countr_zero(hits)];
      zones[zone / ZoneSet::bits_per_word] |= ZoneSet::Word{1} << (zone % ZoneSet::bits_per_word);
    }
  }
}

void DirectTracer::meet(const PosedShape& solid, const Ball& ball, std::span<const RayPack> packs,
                        std::span<const std::uint32_t> picked) noexcept {
  const auto n = picked.size();
  if (const auto* sphere = std::get_if<PosedSphere>(&solid)) {
    kernel_.meet_sphere(packs.data(), picked.data(), n, *sphere, ball, hits_.data());
  } else if (const auto* capsule = std::get_if<PosedCapsule>(&solid)) {
    kernel_.meet_capsule(packs.data(), picked.data(), n, *capsule, ball, hits_.data());
  } else if (const auto* box = std::get_if<PosedBox>(&solid)) {
    kernel_.meet_box(packs.data(), picked.data(), n, *box, ball, hits_.data());
  } else {
    for (std::size_t k = 0; k < n; ++k) hits_[k] = enter_one_by_one(packs[picked[k]], solid, distances_.data());
  }
}

void DirectTracer::enter(const PosedShape& solid, const NearRays& near, std::vector<Entry>& entries) {
  entries.clear();
  const std::span<const RayPack> packs = near.packs();
  if (packs.empty()) return;
  const Ball ball = ball_around(solid);
  const std::size_t n = packs.size();
  float* const distances = distances_.data();
  if (const auto* sphere = std::get_if<PosedSphere>(&solid)) {
    kernel_.enter_sphere(packs.data(), all_.data(), n, *sphere, ball, hits_.data(), distances);
  } else if (const auto* capsule = std::get_if<PosedCapsule>(&solid)) {
    kernel_.enter_capsule(packs.data(), all_.data(), n, *capsule, ball, hits_.data(), distances);
  } else if (const auto* box = std::get_if<PosedBox>(&solid)) {
    kernel_.enter_box(packs.data(), all_.data(), n, *box, ball, hits_.data(), distances);
  } else {
    for (std::size_t k = 0; k < n; ++k) hits_[k] = enter_one_by_one(packs[k], solid, distances + k * pack_size);
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (unsigned int hits = hits_[k]; hits != 0; hits &= hits - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(hits));
      entries.push_back({packs[k].ray[i], distances[k * pack_size + i]});
    }
  }
}

void DirectTracer::find_first(std::span<const PosedShape> solids, std::vector<Meeting>& met) {
  find_moved(solids, everybody_);
  if (entries_.size() < solids.size()) entries_.resize(solids.size());
  if (!left_.empty()) gather(solids, everybody_);
  for (const std::uint32_t i : moved_) enter(solids[i], everybody_.slots[i].near, entries_[i]);
  met_rays_.clear();
  for (std::uint32_t i = 0; i < solids.size(); ++i) {
    for (const auto& [ray, distance] : entries_[i]) {
      if (distance >= nearest_[ray]) continue;  // in a tie the lower index stays
      if (nearest_[ray] == unlimited) met_rays_.push_back(ray);
      nearest_[ray] = distance;
      first_met_[ray] = i;
    }
  }
  met.clear();
  for (const std::uint32_t ray : met_rays_) {
    met.push_back({ray, first_met_[ray]});
    nearest_[ray] = unlimited;
  }
}

void DirectTracer::trace(std::span<const PosedShape> solids, std::span<std::uint8_t> zones) {
  zones_.clear();
  add(0, solids, zones_);
  for (std::size_t i = 0; i < zones.size(); ++i) zones[i] = zones_.test(i) ? 1 : 0;
}

std::unique_ptr<Tracer> make_direct_tracer(const TracerSetup& setup) { return std::make_unique<DirectTracer>(setup); }

}  // namespace pirsim::rt
