#include "engine/sim/recording_family.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/rt/tracer.hpp"
#include "engine/sim/actor.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/sim/observer.hpp"
#include "engine/sim/recording.hpp"
#include "engine/sim/run_state.hpp"

// What people do, apart from what any sensor sees of it.

namespace pirsim::sim {
namespace {

/// One run.
struct PeopleTrack {
  RecordedRun rows;  ///< all but what was shown
  std::size_t n_ticks = 0, n_people = 0;
  std::vector<PostureIndex::Number> postures;  ///< (1 + n_ticks x n_people) from before tick 1 on; 0: not there
};

/// All postures of some studies, each once, in the order in which they came.
class Postures {
 public:
  /// As far as the study's stages look ahead of the last row.
  [[nodiscard]] PeopleTrack follow(const CompiledStudy& study, std::uint32_t run) {
    RunState state(study, run);
    const std::vector<Actor>& actors = state.crowd.actors();
    PeopleTrack track{begun_run(study, run), 0, actors.size(), {}};
    std::vector<std::uint64_t> figures;
    for (const Actor& actor : actors) figures.push_back(number_of(actor.person()));
    index_.make_room_for(actors.size());
    const auto note_postures = [&] {
      for (std::uint32_t i = 0; i < actors.size(); ++i) track.postures.push_back(number_of(i, figures[i], actors[i]));
    };
    note_postures();
    for (std::optional<std::int64_t> end; !end || state.tick < *end;) {
      if (move_tick(study, state) && !end) track.rows.rows.samples.push_back(state.sample);
      if (state.finished && !end) end = study.stages().heard_by(state.tick);
      for (const std::size_t seat : state.crowd.seats_left()) track.rows.seats_left.push_back({state.tick, seat});
      note_postures();
    }
    track.n_ticks = static_cast<std::size_t>(state.tick);
    return track;
  }
  [[nodiscard]] std::size_t size() const noexcept { return index_.size(); }
  /// Forgets all but the first n.
  void shrink(std::size_t n) noexcept {
    index_.shrink(n);
    people_.resize(std::min(n, people_.size()));
  }
  /// Who stood so first, counted from 0: postures of one person follow upon one another.
  [[nodiscard]] std::uint32_t person(PostureIndex::Number number) const noexcept { return people_[number - 1]; }
  /// Lives as long as this.
  [[nodiscard]] const body::Humanoid& humanoid(PostureIndex::Number number) const {
    return figures_[figure(number)].humanoid;
  }
  /// Whose measures and warmth: a number.
  [[nodiscard]] std::uint64_t figure(PostureIndex::Number number) const noexcept { return index_.body(number); }
  [[nodiscard]] const BodyRadiance& radiance(PostureIndex::Number number) const {
    return figures_[figure(number)].radiance;
  }
  [[nodiscard]] body::Outline outline(PostureIndex::Number number) const noexcept { return index_.outline(number); }

 private:
  struct Figure {
    body::Humanoid humanoid;
    BodyRadiance radiance;
  };

  [[nodiscard]] std::uint64_t number_of(const PersonModel& person) {
    const auto known = std::ranges::find_if(figures_, [&](const Figure& figure) {
      return figure.humanoid == person.humanoid && figure.radiance == person.radiance;
    });
    if (known != figures_.end()) return static_cast<std::uint64_t>(known - figures_.begin());
    figures_.push_back({person.humanoid, person.radiance});
    return figures_.size() - 1;
  }
  [[nodiscard]] PostureIndex::Number number_of(std::uint32_t person, std::uint64_t figure, const Actor& actor) {
    if (!actor.present()) return 0;
    const PostureIndex::Number known = index_.find(person, figure, actor.motion().outline());
    if (known != 0) return known;
    people_.push_back(person);
    return index_.remember(person);
  }

  PostureIndex index_;
  std::vector<std::uint32_t> people_;  ///< (n_postures)
  std::deque<Figure> figures_;
};

// What analog sensors receive of people who are known by the numbers of their postures.

/// Follows the rays of some of a study's analog sensors, or of all. Belongs to one thread at a time; what it has
/// measured before changes no result.
class PosturePowers {
 public:
  /// left_out: (n_sensors) 1 for those whose rays aren't followed. study: with analog sensors; it outlives this.
  PosturePowers(const CompiledStudy& study, std::span<const std::uint8_t> left_out)
      : power_(study.array().analog()->power()),
        powers_(power_.n_receivers(), 0),
        n_hit_(power_.clipped().n_zones(), 0),
        touched_(power_.clipped().n_zones()) {
    const RayBundle& all = power_.clipped();
    ZoneSet unasked(all.n_zones());
    for (std::size_t sensor = 0; sensor < all.n_sensors(); ++sensor) {
      if (left_out[sensor] != 0) unasked.insert(all.first_zone(sensor), all.first_zone(sensor + 1));
    }
    rated_ = without(power_.rays().bundle, unasked);
    clipped_ = without(all, unasked);
    for (std::size_t zone = 0; zone < all.n_zones(); ++zone) {
      for (auto ray = all.zone_rays_begin[zone]; ray < all.zone_rays_begin[zone + 1] && !unasked.test(zone); ++ray) {
        rays_.push_back(ray);
        zone_of_.push_back(static_cast<std::uint32_t>(zone));
      }
    }
    tracer_ = rt::make_tracer(study.tracer(), {&study.array().room(), &rated_, &clipped_});
  }

  /// Of these people together, who hide one another. people: (n_people) 0: not there. powers: (n_receivers)
  /// overwritten; of sensors that are left out nothing.
  void measure(const Postures& postures, std::span<const PostureIndex::Number> people, std::span<PowerSteps> powers) {
    moved_.clear();
    for (std::size_t i = 0; i < figures_.size(); ++i) {
      const bool stays = i < people.size() && people[i] != 0 && figures_[i].figure == postures.figure(people[i]);
      if (figures_[i].posture != 0 && !stays) moved_.push_back({i, {}, {}});
    }
    follow();
    for (const rt::Moved& gone : moved_) figures_[gone.person].posture = 0;
    moved_.clear();
    if (figures_.size() < people.size()) figures_.resize(people.size());
    for (std::size_t i = 0; i < people.size(); ++i) {
      Figure& figure = figures_[i];
      if (people[i] == figure.posture) continue;
      if (figure.posture == 0) {
        figure.figure = postures.figure(people[i]);
        figure.radiance = postures.radiance(people[i]);
        figure.surfaces = surfaces_of(figure.radiance);
      }
      figure.posture = people[i];
      moved_.push_back(
          {i, figure.mannequin.pose(postures.humanoid(people[i]), postures.outline(people[i])), figure.surfaces});
    }
    follow();
    std::ranges::copy(powers_, powers.begin());
  }
  /// Zones of the power's rays that somebody was in then.
  [[nodiscard]] const ZoneSet& touched() const noexcept { return touched_; }
  /// The postures from n + 1 on have been forgotten: their numbers will stand for others.
  void shrink(std::size_t n) noexcept {
    for (Figure& figure : figures_) {
      if (figure.posture > n) figure.posture = forgotten;
    }
  }

 private:
  static constexpr PostureIndex::Number forgotten = 0xFFFFFFFFU;
  /// Who was followed last.
  struct Figure {
    PostureIndex::Number posture = 0;  ///< 0: nobody
    std::uint64_t figure = 0;
    BodyRadiance radiance{};
    std::array<std::uint8_t, body::n_parts> surfaces{};
    Mannequin mannequin{};
  };

  void follow() {
    if (moved_.empty() || rays_.empty()) return;
    tracer_->follow(moved_, changes_);
    for (const auto& [ray, before, after] : changes_) {
      const std::uint32_t of_study = rays_[ray];
      powers_[power_.receiver_of(of_study)] += power(of_study, after) - power(of_study, before);
      std::uint32_t& n = n_hit_[zone_of_[ray]];
      if (before == rt::no_solid && n++ == 0) touched_.insert(zone_of_[ray]);
      if (after == rt::no_solid && --n == 0) touched_.erase(zone_of_[ray]);
    }
  }
  [[nodiscard]] PowerSteps power(std::uint32_t ray, rt::SolidId solid) const noexcept {
    return solid == rt::no_solid ? 0 : power_.power(ray, figures_[solid.person].radiance[solid.solid]);
  }

  const PowerModel& power_;
  RayBundle rated_, clipped_;        ///< of the sensors that aren't left out
  std::vector<std::uint32_t> rays_;  ///< (n of their rays) each one's number in the study
  std::unique_ptr<rt::Tracer> tracer_;
  std::vector<Figure> figures_;         ///< (n_people)
  std::vector<PowerSteps> powers_;      ///< (n_receivers) of figures_
  std::vector<std::uint32_t> zone_of_;  ///< (n of rays_)
  std::vector<std::uint32_t> n_hit_;    ///< (n_zones) rays that end at somebody
  ZoneSet touched_;
  // Scratch.
  std::vector<rt::Moved> moved_;
  std::vector<rt::FirstHitChange> changes_;
};

// What the sensors of a study see of postures that are known by number, each looked at once.

/// Solids of postures. From keep() on it remembers those of the first postures, as many as the memory for them should
/// hold: 30 MB. Study A has some 30,000.
class PostureSolids {
 public:
  using Number = PostureIndex::Number;

  /// Valid until the next call.
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

/// What looks alike in two studies: the same rays, which end alike and bring as much.
struct InCommon {
  ZoneSet zones;                      ///< of sensors that answer by them
  std::vector<std::uint8_t> sensors;  ///< (n_sensors) 1: an analog one whose power is the same

  /// Of all sensors.
  bool everything = false;
};

/// Of one sensor, in bundles of one shape.
bool same_rays(const RayBundle& a, const RayBundle& b, std::size_t sensor) {
  static_assert(sizeof(Ray) == 6 * sizeof(float));  // nothing but numbers: equal bytes are equal rays
  const std::size_t begin = b.first_ray(sensor), n = b.first_ray(sensor + 1) - begin;
  return std::memcmp(a.rays.data() + begin, b.rays.data() + begin, n * sizeof(Ray)) == 0 &&
         std::memcmp(a.range.data() + begin, b.range.data() + begin, n * sizeof(float)) == 0;
}

bool same_shape(const RayBundle& a, const RayBundle& b) {
  return a.zone_rays_begin == b.zone_rays_begin && a.cluster_zones_begin == b.cluster_zones_begin &&
         a.sensor_clusters_begin == b.sensor_clusters_begin;
}

bool same_zones(const SensorArray& a, const SensorArray& b, std::size_t sensor) {
  return same_shape(a.clipped(), b.clipped()) && same_rays(a.clipped(), b.clipped(), sensor) &&
         same_rays(a.rated(), b.rated(), sensor);
}

bool same_power(const PowerModel& a, const PowerModel& b, std::size_t sensor) {
  if (!same_shape(a.clipped(), b.clipped()) || a.receivers_begin() != b.receivers_begin()) return false;
  if (!same_rays(a.clipped(), b.clipped(), sensor)) return false;
  for (std::uint32_t ray = b.clipped().first_ray(sensor); ray < b.clipped().first_ray(sensor + 1); ++ray) {
    if (a.receiver_of(ray) != b.receiver_of(ray) || a.background(ray) != b.background(ray) ||
        a.rays().weights[ray] != b.rays().weights[ray]) {
      return false;
    }
  }
  return true;
}

InCommon in_common(const CompiledStudy& first, const CompiledStudy& other) {
  const SensorArray &a = first.array(), &b = other.array();
  InCommon common{ZoneSet(b.clipped().n_zones()), std::vector<std::uint8_t>(b.n_sensors(), 0), true};
  for (std::size_t sensor = 0; sensor < b.n_sensors(); ++sensor) {
    bool is_same = a.n_sensors() == b.n_sensors() && a.is_analog(sensor) == b.is_analog(sensor);
    if (b.is_analog(sensor)) {
      is_same = is_same && same_power(a.analog()->power(), b.analog()->power(), sensor);
      common.sensors[sensor] = is_same ? 1 : 0;
    } else {
      is_same = is_same && same_zones(a, b, sensor);
      if (is_same) common.zones.insert(b.clipped().first_zone(sensor), b.clipped().first_zone(sensor + 1));
    }
    common.everything = common.everything && is_same;
  }
  return common;
}

InCommon nothing_in_common(const SensorArray& array) {
  return {ZoneSet(array.clipped().n_zones()), std::vector<std::uint8_t>(array.n_sensors(), 0), false};
}

using Number = PostureIndex::Number;

/// What the rays of one study see of postures, as far as anybody asked.
class PostureSight {
 public:
  using Number = PostureIndex::Number;

  /// Asks `other` about what looks the same in both; it may be null if nothing does.
  PostureSight(const CompiledStudy& study, const InCommon& common, PostureSight* other)
      : study_(study),
        common_(common),
        other_(other),
        zones_(common.zones.size()),
        n_zone_words_(zones_.words().size()),
        n_words_(n_zone_words_),
        known_(1, 1) {
    const SensorArray& array = study.array();
    ZoneSet unasked = common.zones;  // and those of analog sensors
    for (std::size_t i = 0; i < array.n_sensors(); ++i) {
      if (array.is_analog(i)) unasked.insert(array.clipped().first_zone(i), array.clipped().first_zone(i + 1));
    }
    rated_ = without(array.rated(), unasked);
    clipped_ = without(array.clipped(), unasked);
    if (!clipped_.rays.empty()) tracer_ = rt::make_tracer(study.tracer(), {&array.room(), &rated_, &clipped_});
    if (array.analog() != nullptr) {
      const PowerModel& power = array.analog()->power();
      for (std::size_t i = 0; i < array.n_sensors(); ++i) {
        Analog& analog = analog_.emplace_back(
            Analog{power.receivers_begin()[i], power.receivers_begin()[i + 1], ZoneSet(power.clipped().n_zones())});
        analog.zones.insert(power.clipped().first_zone(i), power.clipped().first_zone(i + 1));
      }
      n_touched_words_ = ZoneSet(power.clipped().n_zones()).words().size();
      powers_.resize(power.n_receivers());
      together_.resize(power.n_receivers());
      n_words_ += n_touched_words_ + powers_.size();
    }
    rows_.resize(n_words_, 0);
  }

  /// Of one person alone.
  [[nodiscard]] std::span<const ZoneSet::Word> zones(const Postures& postures, PostureSolids& solids, Number number) {
    return row(postures, solids, number).first(n_zone_words_);
  }
  [[nodiscard]] std::span<const PowerSteps> powers(const Postures& postures, PostureSolids& solids, Number number) {
    if (analog_.empty()) return {};
    const std::span<const Word> words = row(postures, solids, number).subspan(n_zone_words_ + n_touched_words_);
    std::ranges::transform(words, powers_.begin(), [](Word word) { return std::bit_cast<PowerSteps>(word); });
    return powers_;
  }
  /// Of several people, who hide one another; nothing without analog sensors. Where the other study's people are the
  /// same at that moment, `there` has what its sensors received.
  [[nodiscard]] std::span<const PowerSteps> powers(const Postures& postures, PostureSolids& solids,
                                                   std::span<const Number> people, std::span<const PowerSteps> there) {
    if (analog_.empty()) return {};
    for (const Number number : people) (void)row(postures, solids, number);  // uses powers_
    std::ranges::fill(powers_, 0);
    const std::size_t first_power = n_zone_words_ + n_touched_words_;
    for (std::size_t sensor = 0; sensor < analog_.size(); ++sensor) {
      const Analog& analog = analog_[sensor];
      if (analog.begin == analog.end) continue;
      if (common_.sensors[sensor] != 0 && !there.empty()) {
        for (std::uint32_t i = analog.begin; i < analog.end; ++i) powers_[i] = there[i];
      } else if (!apart(postures, solids, people, analog.zones)) {
        measure_together(postures, people, sensor, powers_);
      } else {
        for (const Number number : people) {
          const std::span<const Word> words = row(postures, solids, number).subspan(first_power);
          for (std::uint32_t i = analog.begin; i < analog.end; ++i) powers_[i] += std::bit_cast<PowerSteps>(words[i]);
        }
      }
    }
    return powers_;
  }
  [[nodiscard]] std::size_t n_zones() const noexcept { return zones_.size(); }
  void shrink(std::size_t n_postures) {
    for (const auto& meter : meters_) {
      if (meter) meter->shrink(n_postures);
    }
    for (Analog& analog : analog_) {
      if (analog.crowd) analog.crowd->shrink(n_postures);
    }
    if (known_.size() <= n_postures + 1) return;
    known_.resize(n_postures + 1);
    rows_.resize(known_.size() * n_words_);
  }

 private:
  using Word = ZoneSet::Word;
  /// Of one analog sensor.
  struct Analog {
    std::uint32_t begin = 0, end = 0;      ///< receivers
    ZoneSet zones;                         ///< of its power's rays
    std::optional<PosturePowers> crowd{};  ///< measures people together, once somebody asked
  };

  std::span<Word> row(const Postures& postures, PostureSolids& solids, Number number) {
    if (known_.size() <= number) {
      known_.resize(postures.size() + 1, 0);
      rows_.resize(known_.size() * n_words_);
    }
    const std::span<Word> row = std::span(rows_).subspan(number * n_words_, n_words_);
    if (known_[number] == 0) look(postures, solids, number, row);
    known_[number] = 1;
    return row;
  }
  void look(const Postures& postures, PostureSolids& solids, Number number, std::span<Word> row) {
    zones_.clear();
    if (tracer_) tracer_->add(postures.person(number), solids.of(postures, number), zones_);
    std::ranges::copy(zones_.words(), row.begin());
    const std::span<Word> touched = row.subspan(n_zone_words_, n_touched_words_);
    const std::span<Word> powers = row.subspan(n_zone_words_ + n_touched_words_);
    if (!analog_.empty()) {
      PosturePowers& meter = meter_of(postures.person(number));
      meter.measure(postures, {&number, 1}, powers_);
      std::ranges::copy(meter.touched().words(), touched.begin());
      std::ranges::transform(powers_, powers.begin(), [](PowerSteps power) { return std::bit_cast<Word>(power); });
    }
    if (other_ == nullptr) return;
    const std::span<const Word> seen = other_->row(postures, solids, number);
    for (std::size_t i = 0; i < n_zone_words_; ++i) row[i] |= common_.zones.words()[i] & seen[i];
    for (std::size_t sensor = 0; sensor < analog_.size(); ++sensor) {
      if (common_.sensors[sensor] == 0) continue;
      const auto& [begin, end, zones, crowd] = analog_[sensor];
      for (std::size_t i = 0; i < n_touched_words_; ++i) touched[i] |= zones.words()[i] & seen[n_zone_words_ + i];
      for (std::uint32_t i = begin; i < end; ++i) powers[i] = seen[n_zone_words_ + n_touched_words_ + i];
    }
  }
  [[nodiscard]] PosturePowers& meter_of(std::uint32_t person) {
    if (meters_.size() <= person) meters_.resize(person + 1);
    if (!meters_[person]) meters_[person] = std::make_unique<PosturePowers>(study_, common_.sensors);
    return *meters_[person];
  }
  /// True if no two of them are in one of the sensor's zones: then none hides another, and their powers add up.
  [[nodiscard]] bool apart(const Postures& postures, PostureSolids& solids, std::span<const Number> people,
                           const ZoneSet& zones) {
    occupied_.assign(n_touched_words_, 0);
    for (const Number number : people) {
      const std::span<const Word> touched = row(postures, solids, number).subspan(n_zone_words_, n_touched_words_);
      for (std::size_t i = 0; i < n_touched_words_; ++i) {
        const Word here = touched[i] & zones.words()[i];
        if ((occupied_[i] & here) != 0) return false;
        occupied_[i] |= here;
      }
    }
    return true;
  }
  /// What one sensor receives of people together; powers: (n_receivers) only that sensor's are set.
  void measure_together(const Postures& postures, std::span<const Number> people, std::size_t sensor,
                        std::span<PowerSteps> powers) {
    if (other_ != nullptr && common_.sensors[sensor] != 0)
      return other_->measure_together(postures, people, sensor, powers);
    auto& [begin, end, zones, crowd] = analog_[sensor];
    if (!crowd) {
      std::vector<std::uint8_t> others(analog_.size(), 1);
      others[sensor] = 0;
      crowd.emplace(study_, others);
    }
    crowd->measure(postures, people, together_);
    for (std::uint32_t i = begin; i < end; ++i) powers[i] = together_[i];
  }

  const CompiledStudy& study_;
  InCommon common_;
  PostureSight* other_ = nullptr;
  RayBundle rated_, clipped_;                           ///< of zones that nobody else looks at
  std::unique_ptr<rt::Tracer> tracer_;                  ///< null: no zones are to be looked at
  std::vector<std::unique_ptr<PosturePowers>> meters_;  ///< (n_people) of each alone, of sensors that aren't in common
  std::vector<Analog> analog_;                          ///< (n_sensors) or empty: none is analog
  ZoneSet zones_;                                       ///< scratch
  std::size_t n_zone_words_, n_touched_words_ = 0, n_words_;
  std::vector<Word> rows_;                     ///< (1 + n_postures x n_words) zones, zones touched, powers; 0: nobody
  std::vector<std::uint8_t> known_;            ///< (1 + n_postures) 1 where somebody asked
  std::vector<PowerSteps> powers_, together_;  ///< (n_receivers) scratch
  std::vector<Word> occupied_;                 ///< scratch
};

/// A run of the first study that has been painted, in which the same people do the same.
struct PaintedRun {
  const Recording* recording = nullptr;
  const RecordedRun* run = nullptr;

  /// (n_receivers) at a moment, number of the run's; overwrites `powers`.
  std::span<const PowerSteps> powers(std::uint32_t moment, std::vector<PowerSteps>& powers) const {
    powers.clear();
    if (run != nullptr) add_powers(*recording, moment, powers);
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

constexpr std::size_t bits_per_word = 64;

/// Remembers what a sensor says at a tick; what was never said takes no memory.
void note(std::span<std::vector<std::uint64_t>> told, std::size_t tick, std::uint8_t trigger) {
  for (std::size_t i = 0; i < told.size(); ++i) {
    if ((trigger >> i & 1U) == 0) continue;
    if (told[i].size() <= tick / bits_per_word) told[i].resize(tick / bits_per_word + 1, 0);
    told[i][tick / bits_per_word] |= std::uint64_t{1} << (tick % bits_per_word);
  }
}

/// Of a moment, as detectors take it.
void show(const SensorArray& array, const Recording& recording, std::uint32_t moment, Exposure& exposure) {
  exposure.zones = recording.zones(moment);
  array.expose(exposure);
}

}  // namespace

struct RecordingFamily::Impl {
  Impl(const Model& model, std::span<const std::uint32_t> runs)
      : first(model.compiled()), sight(first, nothing_in_common(first.array()), nullptr) {
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

std::span<const double> NoiseMemory::normals(const Stream& from, std::size_t n) {
  auto known = std::ranges::find(drawn_, from, &Drawn::from);
  if (known == drawn_.end()) {
    if (n_kept_ + n > most_kept) {
      Stream stream = from;
      beyond_.resize(n);
      std::ranges::generate(beyond_, [&] { return stream.normal(); });
      return beyond_;
    }
    known = drawn_.insert(drawn_.end(), Drawn{from, from, {}});
  }
  auto& [begin, next, numbers] = *known;
  n_kept_ += std::max(n, numbers.size()) - numbers.size();
  while (numbers.size() < n) numbers.push_back(next.normal());
  return std::span(numbers).first(n);
}

RememberedTriggers::RememberedTriggers(const CompiledStudy& study, const Recording& recording, NoiseMemory& noise,
                                       const RememberedTriggers* like)
    : study_(study), recording_(recording), noise_(noise), like_(like) {}

void RememberedTriggers::prepare(const Recording& recording) {
  if (&recording != &recording_) throw Error(ErrorCode::usage, "triggers are remembered of one recording only");
}

void RememberedTriggers::begin_run(std::uint64_t seed, std::uint32_t run) {
  tick_ = 0;
  const auto known = runs_.find(run);
  if (known != runs_.end() && known->second.seed == seed) {
    now_ = &known->second;
    return;
  }
  const auto number = [](const RecordedRun& track) { return track.rows.run; };
  const auto track = std::ranges::find(recording_.runs, run, number);
  if (track == recording_.runs.end()) throw Error(ErrorCode::usage, "a run that isn't recorded has no triggers");
  now_ = &(runs_[run] = find_triggers(*track, seed));
}

void RememberedTriggers::tick(std::uint32_t, std::uint32_t, std::span<std::uint8_t> triggers) noexcept {
  const std::size_t word = tick_ / bits_per_word, bit = tick_ % bits_per_word;
  for (std::size_t sensor = 0; sensor < triggers.size(); ++sensor) {
    const Told& told = now_->triggers[sensor];
    for (std::size_t i = 0; i < told.size(); ++i) {
      if (word < told[i].size()) triggers[sensor] |= static_cast<std::uint8_t>((told[i][word] >> bit & 1U) << i);
    }
  }
  ++tick_;
}

RememberedTriggers::Run RememberedTriggers::find_triggers(const RecordedRun& track, std::uint64_t seed) {
  const SensorArray& array = study_.array();
  Run run{seed, &track, {}};
  run.triggers.resize(array.n_sensors());
  find_zone_triggers(run);
  for (std::uint32_t sensor = 0; sensor < array.n_sensors(); ++sensor) {
    if (!array.is_analog(sensor)) continue;
    const Told* known = known_triggers(run, sensor);
    run.triggers[sensor] = known != nullptr ? *known : analog_triggers(run, sensor);
  }
  return run;
}

void RememberedTriggers::find_zone_triggers(Run& run) const {
  const SensorArray& array = study_.array();
  bool any = false;
  for (std::size_t sensor = 0; sensor < array.n_sensors(); ++sensor) any = any || !array.is_analog(sensor);
  if (!any) return;
  Exposure before = array.unexposed(), after = before;
  show(array, recording_, run.track->rest, before);
  Detector detector(array);
  detector.begin_run(run.seed, run.track->rows.run, before);
  std::vector<std::uint8_t> triggers(array.n_sensors());
  std::uint32_t number = run.track->rest;
  for (std::size_t tick = 0; tick < run.track->moments.size(); ++tick) {
    const std::uint32_t now = run.track->moments[tick];
    if (now == number) {
      detector.tick_zones_unchanged(before, triggers);
    } else {
      show(array, recording_, now, after);
      detector.tick_zones(before, after, triggers);
      std::swap(before, after);
      number = now;
    }
    for (std::size_t sensor = 0; sensor < triggers.size(); ++sensor) note(run.triggers[sensor], tick, triggers[sensor]);
  }
}

RememberedTriggers::Told RememberedTriggers::analog_triggers(const Run& run, std::uint32_t sensor) {
  const CalibratedSensor& made = *study_.array().analog()->sensors()[sensor];
  const RecordedRun& track = *run.track;
  const auto watts = [&](std::uint32_t moment) { return made.watts(recording_.powers_of(moment, sensor)); };
  pir::AnalogCircuit::State state =
      made.detector.start(watts(track.rest), {run.seed, track.rows.run, sensor, Purpose::detector_noise});
  std::span<const double> normals;
  if (made.detector.noisy()) normals = noise_.normals(state.noise, track.moments.size());
  Told told;
  for (std::size_t tick = 0; tick < track.moments.size(); ++tick) {
    made.detector.advance(state, watts(track.moments[tick]), normals.empty() ? 0.0 : normals[tick]);
    note(told, tick, state.comparator.trigger());
  }
  return told;
}

const RememberedTriggers::Told* RememberedTriggers::known_triggers(const Run& run, std::uint32_t sensor) const {
  if (like_ == nullptr || like_->study_.array().analog() == nullptr) return nullptr;
  const auto& others = like_->study_.array().analog()->sensors();
  if (sensor >= others.size() || others[sensor] != study_.array().analog()->sensors()[sensor]) return nullptr;
  const auto known = like_->runs_.find(run.track->rows.run);
  if (known == like_->runs_.end() || known->second.seed != run.seed) return nullptr;
  const RecordedRun &track = *run.track, &other = *known->second.track;
  if (track.moments.size() != other.moments.size()) return nullptr;
  const auto receives_the_same = [&](std::uint32_t moment, std::uint32_t there) {
    return std::ranges::equal(recording_.powers_of(moment, sensor), like_->recording_.powers_of(there, sensor));
  };
  if (!receives_the_same(track.rest, other.rest)) return nullptr;
  for (std::size_t tick = 0; tick < track.moments.size(); ++tick) {
    if (!receives_the_same(track.moments[tick], other.moments[tick])) return nullptr;
  }
  return &known->second.triggers[sensor];
}

}  // namespace pirsim::sim
