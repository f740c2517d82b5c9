#include "sim/recording_family.hpp"

#include <algorithm>
#include <utility>

#include "sim/people_tracks.hpp"
#include "sim/posture_sight.hpp"
#include "sim/replay.hpp"

namespace pirsim::sim {
namespace {

using Number = PostureIndex::Number;

/// A run of the first study that has been painted, in which the same people do the same.
struct PaintedRun {
  const Recording* recording = nullptr;
  const RecordedRun* run = nullptr;

  /// (n_receivers) at a moment, number of the run's; overwrites `powers`.
  std::span<const PowerSteps> powers(std::uint32_t moment, std::vector<PowerSteps>& powers) const {
    powers.clear();
    if (run == nullptr || recording->moments.empty()) return {};
    for (std::size_t sensor = 0; sensor < recording->n_sensors; ++sensor) {
      const auto row = recording->powers_of(moment, sensor);
      powers.insert(powers.end(), row.begin(), row.end());
    }
    return powers;
  }
};

/// The moments of runs, tick by tick.
class Painter {
 public:
  /// Adds to this recording, which is empty.
  Painter(const Postures& postures, PostureSolids& solids, PostureSight& sight, Recording& recording)
      : postures_(postures),
        solids_(solids),
        sight_(sight),
        numbering_(recording, sight.n_zones()),
        all_(sight.n_zones()) {
    moments_.resize(postures.size() + 1, unknown);
  }
  [[nodiscard]] RecordedRun paint(const PeopleTrack& people, const PaintedRun& same) {
    RecordedRun track = people.rows;
    const std::size_t n = people.n_people;
    track.rest = moment_of(std::span(people.postures).first(n), same, same.run == nullptr ? 0 : same.run->rest);
    for (std::size_t tick = 1; tick <= people.n_ticks; ++tick) {
      const std::span<const Number> now = std::span(people.postures).subspan(tick * n, n);
      const bool stays = std::ranges::equal(now, std::span(people.postures).subspan((tick - 1) * n, n));
      const std::uint32_t before = track.moments.empty() ? track.rest : track.moments.back();
      track.moments.push_back(stays ? before
                                    : moment_of(now, same, same.run == nullptr ? 0 : same.run->moments[tick - 1]));
    }
    return track;
  }

 private:
  static constexpr std::uint32_t unknown = 0xFFFFFFFFU;

  std::uint32_t moment_of(std::span<const Number> people, const PaintedRun& same, std::uint32_t there) {
    const auto is_there = [](Number number) { return number != 0; };
    const auto n_there = std::ranges::count_if(people, is_there);
    if (n_there > 1) {
      add_zones(people);
      return numbering_.number(all_.words(), sight_.powers(postures_, solids_, people, same.powers(there, there_)));
    }
    const Number alone = n_there == 0 ? 0 : *std::ranges::find_if(people, is_there);
    std::uint32_t& moment = moments_[alone];
    if (moment == unknown) {
      add_zones({&alone, 1});
      moment = numbering_.number(all_.words(), sight_.powers(postures_, solids_, alone));
    }
    return moment;
  }
  void add_zones(std::span<const Number> people) {
    all_.clear();
    for (const Number number : people) all_.add(sight_.zones(postures_, solids_, number));
  }

  const Postures& postures_;
  PostureSolids& solids_;
  PostureSight& sight_;
  MomentNumbering numbering_;
  std::vector<std::uint32_t> moments_;  ///< (1 + n_postures) of who is alone, where they have been asked for
  ZoneSet all_;
  std::vector<PowerSteps> there_;  ///< scratch
};

/// What a posture shows hangs on leaves then: each study is recorded by itself.
bool has_doors(const CompiledStudy& study) { return !study.scene().doors.empty(); }

}  // namespace

struct RecordingFamily::Impl {
  Impl(const Model& model, std::span<const std::uint32_t> runs) : first(model.compiled()), sight(first) {
    const CompiledStudy& study = first;
    if (has_doors(study)) {
      tracks = pirsim::record(model, runs, 1, {});
      return;
    }
    tracks = empty_recording(study);
    for (const std::uint32_t run : runs) people.push_back(postures.follow(study, run));
    n_postures = postures.size();
    Painter painter(postures, solids, sight, tracks);
    for (const PeopleTrack& one : people) tracks.runs.push_back(painter.paint(one, {}));
  }

  /// The place of a run that people go through in the other study as they do in the first, as far as it needs.
  [[nodiscard]] std::optional<std::size_t> known(const CompiledStudy& other, std::uint32_t run) const {
    const auto known = std::ranges::find(people, run, [](const PeopleTrack& track) { return track.rows.rows.run; });
    if (known == people.end() || !other.moves_people_as(first)) return std::nullopt;
    const auto last_row = static_cast<std::int64_t>(known->rows.rows.samples.size()) * other.sensing().ticks_per_window;
    if (static_cast<std::int64_t>(known->n_ticks) < other.stages().heard_by(last_row)) return std::nullopt;
    return static_cast<std::size_t>(known - people.begin());
  }

  [[nodiscard]] Recording record(const CompiledStudy& other, std::span<const std::uint32_t> runs) {
    postures.shrink(n_postures);
    solids.shrink(n_postures);
    solids.keep();  // only now: many a family has but its first study
    sight.shrink(n_postures);
    Recording result = empty_recording(other);
    const InCommon common = in_common(first, other);
    std::vector<std::optional<std::size_t>> places;
    for (const std::uint32_t run : runs) places.push_back(known(other, run));
    if (common.everything && std::ranges::all_of(places, [](const auto& place) { return place.has_value(); })) {
      result.sets = tracks.sets;
      result.powers = tracks.powers;
      result.moments = tracks.moments;
      for (const auto& place : places) result.runs.push_back(tracks.runs[*place]);
      return result;
    }
    std::vector<PeopleTrack> others;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (!places[i]) others.push_back(postures.follow(other, runs[i]));
    }
    std::optional<PostureSight> own;
    if (!common.everything) own.emplace(other, common, &sight);
    Painter painter(postures, solids, own ? *own : sight, result);
    auto next = others.begin();
    for (const auto& place : places) {
      const PaintedRun same = place ? PaintedRun{&tracks, &tracks.runs[*place]} : PaintedRun{};
      result.runs.push_back(painter.paint(place ? people[*place] : *next++, same));
    }
    return result;
  }

  const CompiledStudy& first;
  Postures postures;
  PostureSolids solids;
  PostureSight sight;
  std::size_t n_postures = 0;  ///< of the first study
  std::vector<PeopleTrack> people;
  Recording tracks;
};

RecordingFamily::RecordingFamily(const Model& first, std::span<const std::uint32_t> runs)
    : impl_(std::make_unique<Impl>(first, runs)) {}
RecordingFamily::~RecordingFamily() = default;
RecordingFamily::RecordingFamily(RecordingFamily&&) noexcept = default;
RecordingFamily& RecordingFamily::operator=(RecordingFamily&&) noexcept = default;

const Recording& RecordingFamily::first() const noexcept { return impl_->tracks; }

Recording RecordingFamily::record(const Model& other, std::span<const std::uint32_t> runs) {
  if (has_doors(impl_->first) || has_doors(other.compiled())) return pirsim::record(other, runs, 1, {});
  return impl_->record(other.compiled(), runs);
}

}  // namespace pirsim::sim
