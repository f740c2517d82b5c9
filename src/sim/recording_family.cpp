#include "sim/recording_family.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "rt/tracer.hpp"
#include "sim/people_tracks.hpp"
#include "sim/replay.hpp"
#include "sim/solids.hpp"

namespace pirsim::sim {
namespace {

using Number = PostureIndex::Number;

bool same_rays(const RayBundle& a, const RayBundle& b, std::size_t begin, std::size_t end) {
  static_assert(sizeof(Ray) == 6 * sizeof(float));  // nothing but numbers: equal bytes are equal rays
  return std::memcmp(a.rays.data() + begin, b.rays.data() + begin, (end - begin) * sizeof(Ray)) == 0 &&
         std::memcmp(a.range.data() + begin, b.range.data() + begin, (end - begin) * sizeof(float)) == 0;
}

struct Zones {
  std::uint32_t begin, end;
};
Zones zones_of(const RayBundle& bundle, std::size_t sensor) {
  return {bundle.cluster_zones_begin[bundle.sensor_clusters_begin[sensor]],
          bundle.cluster_zones_begin[bundle.sensor_clusters_begin[sensor + 1]]};
}

/// The zones of sensors whose rays are the same, and end alike, in both studies.
ZoneSet zones_in_common(const CompiledStudy& first, const CompiledStudy& other) {
  const RayBundle &a = first.array().clipped(), &b = other.array().clipped();
  ZoneSet zones(b.n_zones());
  if (a.zone_rays_begin != b.zone_rays_begin || a.cluster_zones_begin != b.cluster_zones_begin ||
      a.sensor_clusters_begin != b.sensor_clusters_begin) {
    return zones;
  }
  for (std::size_t sensor = 0; sensor < b.n_sensors(); ++sensor) {
    const auto [begin, end] = zones_of(b, sensor);
    const std::size_t first_ray = b.zone_rays_begin[begin], last_ray = b.zone_rays_begin[end];
    if (!same_rays(a, b, first_ray, last_ray)) continue;
    if (!same_rays(first.array().rated(), other.array().rated(), first_ray, last_ray)) continue;
    for (std::size_t zone = begin; zone < end; ++zone) zones.insert(zone);
  }
  return zones;
}

std::size_t count(const ZoneSet& zones) {
  std::size_t n = 0;
  for (const ZoneSet::Word word : zones.words()) n += static_cast<std::size_t>(std::popcount(word));
  return n;
}

/// Solids of postures. From keep() on it remembers those of the first postures, as many as the memory for them should
/// hold: 30 MB. Study A has some 30,000.
class Solids {
 public:
  [[nodiscard]] std::span<const PosedShape> of(const Postures& postures, Number number) {
    if (number <= n_kept_) return {&kept_[(number - 1) * body::n_parts], body::n_parts};
    const std::uint32_t person = postures.person(number);
    if (mannequins_.size() <= person) mannequins_.resize(person + 1);
    const auto solids = mannequins_[person].pose(postures.humanoid(number), postures.outline(number));
    if (number == n_kept_ + 1 && number <= n_to_keep_) {
      kept_.insert(kept_.end(), solids.begin(), solids.end());
      ++n_kept_;
    }
    return solids;
  }
  void keep() noexcept { n_to_keep_ = most_kept; }
  void shrink(std::size_t n) {
    n_kept_ = std::min(n_kept_, n);
    kept_.resize(n_kept_ * body::n_parts);
  }

 private:
  static constexpr std::size_t most_kept = 32768;

  std::size_t n_to_keep_ = 0, n_kept_ = 0;
  std::vector<PosedShape> kept_;       ///< (n_kept x n_parts)
  std::vector<Mannequin> mannequins_;  ///< (n_people)
};

/// What the rays of one study see of postures, as far as anybody asked.
class Sight {
 public:
  explicit Sight(const CompiledStudy& study) : Sight(study, ZoneSet(study.array().clipped().n_zones()), nullptr) {}
  /// Asks `other` about the zones in common, whose rays are the same in both.
  Sight(const CompiledStudy& study, const ZoneSet& in_common, Sight* other)
      : in_common_(in_common),
        other_(other),
        rated_(without(study.array().rated(), in_common)),
        clipped_(without(study.array().clipped(), in_common)),
        tracer_(rt::make_tracer(study.tracer(), {&study.array().room(), &rated_, &clipped_})),
        zones_(in_common.size()),
        n_words_(zones_.words().size()),
        rows_(n_words_, 0),
        known_(1, 1) {}

  /// As words.
  [[nodiscard]] std::span<const ZoneSet::Word> zones(const Postures& postures, Solids& solids, Number number) {
    if (known_.size() <= number) {
      known_.resize(postures.size() + 1, 0);
      rows_.resize(known_.size() * n_words_);
    }
    const std::span<ZoneSet::Word> row = std::span(rows_).subspan(number * n_words_, n_words_);
    if (known_[number] == 0) look(postures, solids, number, row);
    known_[number] = 1;
    return row;
  }
  [[nodiscard]] std::size_t n_zones() const noexcept { return zones_.size(); }
  void shrink(std::size_t n_postures) {
    if (known_.size() <= n_postures + 1) return;
    known_.resize(n_postures + 1);
    rows_.resize(known_.size() * n_words_);
  }

 private:
  void look(const Postures& postures, Solids& solids, Number number, std::span<ZoneSet::Word> row) {
    zones_.clear();
    if (!clipped_.rays.empty()) tracer_->add(postures.person(number), solids.of(postures, number), zones_);
    std::ranges::copy(zones_.words(), row.begin());
    if (other_ == nullptr) return;
    const auto seen = other_->zones(postures, solids, number);
    for (std::size_t i = 0; i < n_words_; ++i) row[i] |= in_common_.words()[i] & seen[i];
  }

  ZoneSet in_common_;
  Sight* other_;
  RayBundle rated_, clipped_;
  std::unique_ptr<rt::Tracer> tracer_;
  ZoneSet zones_;  ///< scratch
  std::size_t n_words_;
  std::vector<ZoneSet::Word> rows_;  ///< (1 + n_postures x n_words); 0: nobody
  std::vector<std::uint8_t> known_;  ///< (1 + n_postures) 1 where somebody asked
};

Recording empty_recording_of_zones(const CompiledStudy& study) {
  if (study.array().analog() != nullptr) {
    throw Error(
        ErrorCode::usage,
        "a family of recordings shares what zones see of postures, which analog sensors make no use of: record() "
        "each study by itself");
  }
  return empty_recording(study);
}

/// The sets of zones of runs, tick by tick.
class Painter {
 public:
  /// Adds to this recording, which is empty.
  Painter(const Postures& postures, Solids& solids, Sight& sight, Recording& recording)
      : postures_(postures),
        solids_(solids),
        sight_(sight),
        numbering_(recording, sight.n_zones()),
        all_(sight.n_zones()) {
    sets_.resize(postures.size() + 1, unknown);
  }
  [[nodiscard]] RecordedRun paint(const PeopleTrack& people) {
    RecordedRun track = people.rows;
    const std::size_t n = people.n_people;
    track.rest = set_of(std::span(people.postures).first(n));
    for (std::size_t tick = 1; tick <= people.n_ticks; ++tick) {
      track.moments.push_back(set_of(std::span(people.postures).subspan(tick * n, n)));
    }
    return track;
  }

 private:
  static constexpr std::uint32_t unknown = 0xFFFFFFFFU;

  std::uint32_t set_of(std::span<const Number> people) {
    if (people.size() != 1) return number_anew(people);
    std::uint32_t& set = sets_[people.front()];
    if (set == unknown) set = number_anew(people);
    return set;
  }
  std::uint32_t number_anew(std::span<const Number> people) {
    all_.clear();
    for (const Number number : people) all_.add(sight_.zones(postures_, solids_, number));
    return numbering_.number(all_.words(), {});
  }

  const Postures& postures_;
  Solids& solids_;
  Sight& sight_;
  MomentNumbering numbering_;
  std::vector<std::uint32_t> sets_;  ///< (1 + n_postures) of who is alone, where they have been asked for
  ZoneSet all_;
};

}  // namespace

struct RecordingFamily::Impl {
  Impl(const CompiledStudy& study, std::span<const std::uint32_t> runs) : first(study), sight(study) {
    tracks = empty_recording_of_zones(study);
    for (const std::uint32_t run : runs) people.push_back(postures.follow(study, run));
    n_postures = postures.size();
    paint(people, sight, tracks);
  }

  void paint(std::span<const PeopleTrack> who, Sight& from, Recording& to) {
    Painter painter(postures, solids, from, to);
    for (const PeopleTrack& one : who) to.runs.push_back(painter.paint(one));
  }

  [[nodiscard]] PeopleTrack follow(const CompiledStudy& other, std::uint32_t run) {
    const auto known = std::ranges::find(people, run, [](const PeopleTrack& track) { return track.rows.rows.run; });
    const auto goes_far_enough = [&](const PeopleTrack& track) {
      const auto last_row =
          static_cast<std::int64_t>(track.rows.rows.samples.size()) * other.sensing().ticks_per_window;
      return static_cast<std::int64_t>(track.n_ticks) >= other.stages().heard_by(last_row);
    };
    const bool knows = other.moves_people_as(first) && known != people.end() && goes_far_enough(*known);
    return knows ? *known : postures.follow(other, run);
  }

  [[nodiscard]] Recording record(const CompiledStudy& other, std::span<const std::uint32_t> runs) {
    postures.shrink(n_postures);
    solids.shrink(n_postures);
    solids.keep();  // only now: many a family has but its first study
    sight.shrink(n_postures);
    Recording result = empty_recording_of_zones(other);
    std::vector<PeopleTrack> who;
    for (const std::uint32_t run : runs) who.push_back(follow(other, run));
    const ZoneSet in_common = zones_in_common(first, other);
    const std::size_t n_in_common = count(in_common);
    if (n_in_common == in_common.size()) {
      paint(who, sight, result);
    } else {
      Sight own(other, in_common, n_in_common == 0 ? nullptr : &sight);
      paint(who, own, result);
    }
    return result;
  }

  const CompiledStudy& first;
  Postures postures;
  Solids solids;
  Sight sight;
  std::size_t n_postures = 0;  ///< of the first study
  std::vector<PeopleTrack> people;
  Recording tracks;
};

RecordingFamily::RecordingFamily(const Model& first, std::span<const std::uint32_t> runs)
    : impl_(std::make_unique<Impl>(first.compiled(), runs)) {}
RecordingFamily::~RecordingFamily() = default;
RecordingFamily::RecordingFamily(RecordingFamily&&) noexcept = default;
RecordingFamily& RecordingFamily::operator=(RecordingFamily&&) noexcept = default;

const Recording& RecordingFamily::first() const noexcept { return impl_->tracks; }

Recording RecordingFamily::record(const Model& other, std::span<const std::uint32_t> runs) {
  return impl_->record(other.compiled(), runs);
}

}  // namespace pirsim::sim
