// People as the solids that sensors see, and the rays that end at them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/body/motion.hpp"
#include "engine/rt/tracer.hpp"
#include "engine/sim/actor.hpp"
#include "engine/sim/compiled_study.hpp"
#include "model/schema/door_leaf.hpp"
#include "pirsim/shapes.hpp"
#include "pirsim/state.hpp"

namespace pirsim::sim {

/// Appends the thirteen posed solids of a posture, or of a person if present, in the order of body::Part.
void append_solids(const body::Humanoid& humanoid, const body::Posture& posture, std::vector<PosedShape>& solids);
void append_solids(const Actor& actor, std::vector<PosedShape>& solids);

/// Keeps what doesn't change from one posture to the next.
class Mannequin {
 public:
  /// (n_parts) as append_solids() gives them; valid until the next call. humanoid: outlives this.
  [[nodiscard]] std::span<const PosedShape> pose(const body::Humanoid& humanoid, const body::Outline& outline) {
    if (!poser_ || &poser_->humanoid() != &humanoid) poser_.emplace(humanoid);
    const body::Posture& posture = poser_->posture(outline);
    for (std::size_t part = 0; part < body::n_parts; ++part) {
      if ((poser_->renewed() >> part & 1U) != 0) solids_[part] = place(humanoid.solids()[part], posture[part]);
    }
    return solids_;
  }

 private:
  std::optional<body::Poser> poser_;
  std::vector<PosedShape> solids_ = std::vector<PosedShape>(body::n_parts);
};

struct BeamSegment {
  Vec3 from{0.0};
  Vec3 to{0.0};  ///< where the ray ends: at a person, at the room, or at its rated range
  bool sees_person = false;
};

/// One segment a ray of the sensor (index into scene().sensors), people as they stand in `state`.
[[nodiscard]] std::vector<BeamSegment> beams_of(const Model& model, const State& state, std::size_t sensor);

// Numbers for the ways in which the leaves of doors stand.

/// What was seen is remembered under such a number. Belongs to one thread.
class LeafNumbers {
 public:
  /// Takes note of how leaves stand now; true if that isn't as they stood before.
  bool turn(std::span<const LeafStep> steps) {
    if (std::equal(steps.begin(), steps.end(), now_.begin(), now_.end())) return false;
    now_.assign(steps.begin(), steps.end());
    constexpr std::size_t most = 65536;
    if (numbers_.size() == most) numbers_.clear();  // no number is given twice
    const auto [known, is_new] = numbers_.try_emplace(now_, next_);
    if (is_new) ++next_;
    number_ = known->second;
    return true;
  }
  /// 0 without doors.
  [[nodiscard]] std::uint64_t number() const noexcept { return number_; }

 private:
  std::vector<LeafStep> now_;
  std::map<std::vector<LeafStep>, std::uint64_t> numbers_;
  std::uint64_t number_ = 0, next_ = 1;
};

// Postures by number, and what the sensors saw of them: a choreography repeats its postures, bit for bit.

/// A hash table from everything that a posture depends on to numbers 1, 2, 3, ... in the order of remembering.
class PostureIndex {
 public:
  using Number = std::uint32_t;  ///< 0: none
  using Word = std::uint64_t;

  /// Room for so many without allocating, if it is known.
  explicit PostureIndex(std::size_t n_expected = 0);
  /// 0 if the posture isn't known. body: whose measures, as a number or an address. person: counted from 0; what
  /// followed upon their last posture before is looked at first. doors: how they stand, as a number.
  [[nodiscard]] Number find(std::size_t person, std::uint64_t body, const body::Outline& outline,
                            std::uint64_t doors = 0) noexcept;
  /// Remembers what find() was last asked for in vain, for the same person.
  Number remember(std::size_t person);
  /// People are counted up to here.
  void make_room_for(std::size_t n_people);
  /// How many there are: the last number.
  [[nodiscard]] std::size_t size() const noexcept { return successors_.size() - 1; }
  [[nodiscard]] std::uint64_t body(Number number) const noexcept { return keys_[number - 1][n_outline_words]; }
  [[nodiscard]] body::Outline outline(Number number) const noexcept;
  /// Forgets all but the first n.
  void shrink(std::size_t n) noexcept;
  void forget_all() noexcept;  ///< but what find() was last asked for can still be remembered

 private:
  static constexpr std::size_t n_outline_words = sizeof(body::Outline) / sizeof(Word);
  using Key = std::array<Word, n_outline_words + 2>;  ///< then whose body, and the doors
  [[nodiscard]] static std::size_t hash(const Key& key) noexcept;
  /// Where the key is, or would be.
  [[nodiscard]] std::size_t bucket_of(const Key& key) const noexcept;
  void spread() noexcept;  ///< over twice as many buckets
  void follow(std::size_t person, Number number) noexcept;

  std::vector<Number> buckets_;  ///< probed one after the other
  std::vector<Key> keys_;
  std::vector<Number> successors_;  ///< (1 + n) what came after a posture the last time
  std::vector<Number> last_;        ///< (n_people)
  Key wanted_{};
  std::size_t free_bucket_ = 0;  ///< for wanted_
};

/// A row of items for each of a bounded number of postures. When it is full it starts anew. A capacity of 0 remembers
/// nothing.
template <class Item>
class PostureMemory {
 public:
  /// items_per_row: in most rows at most; longer ones take more memory when they come.
  PostureMemory(std::size_t items_per_row, std::size_t capacity) : capacity_(capacity), index_(capacity) {
    rows_.reserve(capacity * items_per_row);
    begins_.reserve(capacity + 1);
    begins_.push_back(0);
  }
  /// None if the posture isn't known; see PostureIndex::find.
  [[nodiscard]] std::optional<std::span<const Item>> find(std::size_t person, const void* humanoid,
                                                          const body::Outline& outline,
                                                          std::uint64_t doors = 0) noexcept {
    const auto body = reinterpret_cast<std::uintptr_t>(humanoid);
    const PostureIndex::Number known = index_.find(person, body, outline, doors);
    if (known == 0) return std::nullopt;
    return std::span(rows_).subspan(begins_[known - 1], begins_[known] - begins_[known - 1]);
  }
  /// Remembers the row under what find() was last asked for in vain, for the same person.
  void remember(std::size_t person, std::span<const Item> row) {
    if (capacity_ == 0) return;
    if (index_.size() == capacity_) {
      index_.forget_all();
      rows_.clear();
      begins_.assign(1, 0);
    }
    (void)index_.remember(person);
    rows_.insert(rows_.end(), row.begin(), row.end());
    begins_.push_back(rows_.size());
  }
  void make_room_for(std::size_t n_people) { index_.make_room_for(n_people); }

 private:
  std::size_t capacity_;
  PostureIndex index_;
  std::vector<Item> rows_;
  std::vector<std::size_t> begins_;  ///< (n_postures + 1) of rows, in rows_
};

/// Study A has some 30,000 different postures; with its 250 bytes each this bounds the memory to 16 MB a thread.
inline constexpr std::size_t most_postures = 65536;

// What analog sensors receive of people, who hide one another.

/// Part of the power of one sensor, as far as one zone and one person's part bring it.
struct PowerShare {
  std::uint32_t ray = 0;
  std::uint32_t person = 0;  ///< index of the actor
  body::Part part = body::Part::pelvis;
  PowerSteps power = 0;
};

/// (n_parts) those of equal radiance have the same number: which of them a ray hits makes no difference.
[[nodiscard]] std::array<std::uint8_t, body::n_parts> surfaces_of(const BodyRadiance& radiance) noexcept;

/// The power that each analog sensor receives. Belongs to one thread at a time and to one array, which has analog();
/// what it has measured before changes no result.
class PowerMeter {
 public:
  PowerMeter(const SensorArray& array, TracerKind kind);
  /// tracer: of these rays; n_remembered: postures of somebody alone.
  PowerMeter(const PowerModel& power, std::unique_ptr<rt::Tracer> tracer, std::size_t n_remembered);
  /// leaves: (n_doors) as they stand; powers: (n_receivers) overwritten.
  void measure(const std::vector<Actor>& actors, std::span<const LeafStep> leaves, std::span<PowerSteps> powers);
  /// The same of one body alone, with leaves as before a run. solids: at most n_parts, as warm as the parts in their
  /// order.
  void measure(std::span<const PosedShape> solids, const BodyRadiance& radiance, std::span<PowerSteps> powers);
  /// The same without a copy and without memory: whether powers() are others than before.
  bool follow(const std::vector<Actor>& actors, std::span<const LeafStep> leaves);
  [[nodiscard]] std::span<const PowerSteps> powers() const noexcept { return powers_; }
  /// Ray by ray.
  void explain(const std::vector<Actor>& actors, std::span<const LeafStep> leaves, std::vector<PowerShare>& shares);

 private:
  /// What was followed last of a person.
  struct Figure {
    bool is_there = false;
    const body::Humanoid* humanoid = nullptr;  ///< null: of a body that isn't an actor's
    std::size_t n_solids = 0;
    BodyRadiance radiance{};
    std::array<std::uint8_t, body::n_parts> surfaces{};  ///< parts of equal radiance
    body::Outline outline;
  };

  void turn(std::span<const LeafStep> leaves);
  /// Of those in moved_ nothing stays.
  void take_away();
  /// Takes the tracer to where people are now.
  void follow(const std::vector<Actor>& actors);
  void follow(std::span<const rt::Moved> moved);
  [[nodiscard]] PowerSteps power(std::uint32_t ray, rt::SolidId solid) const noexcept {
    return solid == rt::no_solid ? 0 : power_.power(ray, figures_[solid.person].radiance[solid.solid]);
  }

  const PowerModel& power_;
  std::unique_ptr<rt::Tracer> tracer_;
  LeafNumbers leaves_;
  PostureMemory<PowerSteps> alone_;  ///< powers of postures of who was alone
  std::vector<Figure> figures_;      ///< (n_people)
  std::vector<PowerSteps> powers_;   ///< (n_receivers) of figures_
  bool has_changed_ = false;         ///< powers_, since this was set
  // Scratch.
  std::vector<Mannequin> mannequins_;  ///< (n_people)
  std::vector<rt::Moved> moved_;
  std::vector<rt::FirstHitChange> changes_;
};

// What the sensors' optics show of people at a tick: the one way to look, with the memory that makes it fast.

/// Belongs to one thread at a time and to one array; what it has seen before changes no result.
class Observer {
 public:
  Observer(const SensorArray& array, TracerKind kind, ZonesOf whose);
  /// leaves: (n_doors) as they stand; exposure: of the array, overwritten.
  void look(const std::vector<Actor>& actors, std::span<const LeafStep> leaves, Exposure& exposure);
  /// At zones alone, which there are.
  void look_at_zones(const std::vector<Actor>& actors, std::span<const LeafStep> leaves, Exposure& exposure);
  /// As look(), at one body alone, in any posture, with leaves as before a run. solids: at most n_parts, as warm as the
  /// parts in their order.
  void look(std::span<const PosedShape> solids, const BodyRadiance& radiance, Exposure& exposure);

 private:
  /// Of a set of zones and of one of channels, its words counted on from those of the zones.
  using Parts = std::span<const ZoneSet::Part>;
  Parts seen_of(std::size_t person, const Actor& actor);

  const SensorArray& array_;
  std::unique_ptr<rt::Tracer> tracer_;  ///< null: no zones are wanted
  LeafNumbers leaves_;
  std::vector<std::uint32_t> broken_;  ///< zones of beams, by leaves as they stand
  PostureMemory<ZoneSet::Part> memory_;
  std::unique_ptr<PowerMeter> power_meter_;  ///< null: no sensor is analog
  // Scratch.
  std::vector<Mannequin> mannequins_;  ///< (n_people)
  ZoneSet person_zones_, person_channels_;
  std::vector<ZoneSet::Part> parts_;
};

/// As many observers as there were runs at a time. Safe to use from any thread; study and pool outlive what is
/// borrowed.
class ObserverPool {
 public:
  ObserverPool(const CompiledStudy& study, ZonesOf whose) : study_(study), whose_(whose) {}

  /// Comes back, with what it remembers, when the last pointer to it goes.
  [[nodiscard]] std::shared_ptr<Observer> borrow() {
    std::unique_ptr<Observer> observer = take();
    if (!observer) observer = std::make_unique<Observer>(study_.array(), study_.tracer(), whose_);
    return {observer.release(), [this](Observer* used) { put_back(std::unique_ptr<Observer>(used)); }};
  }

 private:
  std::unique_ptr<Observer> take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return nullptr;
    std::unique_ptr<Observer> observer = std::move(idle_.back());
    idle_.pop_back();
    return observer;
  }
  void put_back(std::unique_ptr<Observer> observer) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(observer));
  }

  const CompiledStudy& study_;
  ZonesOf whose_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Observer>> idle_;
};

}  // namespace pirsim::sim
