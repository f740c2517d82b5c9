#include "rt/direct_tracer.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace pirsim::rt {
namespace {

template <typename Solid>
void copy_bits(const Solid& solid, std::uint32_t* to) noexcept {
  static_assert(sizeof(Solid) % sizeof(std::uint32_t) == 0);
  const auto words = std::bit_cast<std::array<std::uint32_t, sizeof(Solid) / sizeof(std::uint32_t)>>(solid);
  std::ranges::copy(words, to);
}

/// For solids that have no test of many rays at a time.
PackHits met_one_by_one(const RayPack& pack, const PosedShape& solid) noexcept {
  unsigned int hits = 0;
  for (unsigned int i = 0; i < pack_size; ++i) {
    const Ray ray{Vec3f(pack.origin_x[i], pack.origin_y[i], pack.origin_z[i]),
                  Vec3f(pack.direction_x[i], pack.direction_y[i], pack.direction_z[i])};
    if (entry_distance(ray, solid, pack.range[i])) hits |= 1U << i;
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
      zones_(setup.clipped->n_zones()) {
  near_person_cones_.reserve(cones_.size());
}

DirectTracer::Key DirectTracer::key_of(const PosedShape& solid) noexcept {
  Key key{};
  key.back() = static_cast<std::uint32_t>(solid.index()) + 1;  // never that of a slot without a solid
  std::visit([&](const auto& s) { copy_bits(s, key.data()); }, solid);
  return key;
}

void DirectTracer::find_moved(std::span<const PosedShape> solids, Memory& memory) {
  memory.slots.resize(solids.size());
  memory.hits.resize(solids.size() * n_words_);
  moved_.clear();
  moved_balls_.clear();
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const Key key = key_of(solids[i]);
    Slot& slot = memory.slots[i];
    if (std::memcmp(&slot.key, &key, sizeof key) == 0) continue;
    slot.key = key;
    slot.ball = ball_around(solids[i]);
    moved_.push_back(static_cast<std::uint32_t>(i));
    moved_balls_.push_back(slot.ball);
  }
}

void DirectTracer::add(std::size_t person, std::span<const PosedShape> solids, ZoneSet& zones) {
  if (people_.size() <= person) people_.resize(person + 1);
  Memory& memory = people_[person];
  find_moved(solids, memory);
  if (!moved_.empty()) {
    const Ball all = ball_around(moved_balls_);
    const std::size_t n = kernel_.cull(cones_.data(), cones_.size(), all, near_person_.data());
    pick(cones_, near_person_.data(), n, near_person_cones_);
    for (const std::uint32_t i : moved_) meet(solids[i], memory.slots[i].ball, &memory.hits[i * n_words_]);
  }
  for (std::size_t i = 0; i < solids.size(); ++i) zones.add({&memory.hits[i * n_words_], n_words_});
}

void DirectTracer::meet(const PosedShape& solid, const Ball& ball, ZoneSet::Word* zones) {
  std::fill_n(zones, n_words_, ZoneSet::Word{0});
  const std::size_t n = kernel_.cull(near_person_cones_.data(), near_person_cones_.size(), ball, near_solid_.data());
  for (std::size_t k = 0; k < n; ++k) near_solid_[k] = near_person_[near_solid_[k]];
  if (const auto* sphere = std::get_if<PosedSphere>(&solid)) {
    kernel_.meet_sphere(packs_.data(), near_solid_.data(), n, *sphere, ball, hits_.data());
  } else if (const auto* capsule = std::get_if<PosedCapsule>(&solid)) {
    kernel_.meet_capsule(packs_.data(), near_solid_.data(), n, *capsule, ball, hits_.data());
  } else if (const auto* box = std::get_if<PosedBox>(&solid)) {
    kernel_.meet_box(packs_.data(), near_solid_.data(), n, *box, ball, hits_.data());
  } else {
    for (std::size_t k = 0; k < n; ++k) hits_[k] = met_one_by_one(packs_[near_solid_[k]], solid);
  }
  for (std::size_t k = 0; k < n; ++k) {
    const RayPack& pack = packs_[near_solid_[k]];
    for (unsigned int hits = hits_[k]; hits != 0; hits &= hits - 1) {
      const std::uint32_t zone = pack.zone[std::countr_zero(hits)];
      zones[zone / ZoneSet::bits_per_word] |= ZoneSet::Word{1} << (zone % ZoneSet::bits_per_word);
    }
  }
}

void DirectTracer::trace(std::span<const PosedShape> solids, std::span<std::uint8_t> zones) {
  zones_.clear();
  add(0, solids, zones_);
  for (std::size_t i = 0; i < zones.size(); ++i) zones[i] = zones_.test(i) ? 1 : 0;
}

std::unique_ptr<Tracer> make_direct_tracer(const TracerSetup& setup) { return std::make_unique<DirectTracer>(setup); }

}  // namespace pirsim::rt
