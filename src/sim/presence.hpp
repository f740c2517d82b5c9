// What people know of each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "body/walkable_floor.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/sample.hpp"

namespace pirsim::sim {

/// Who goes first where two people are in each other's way: who has been held up since earlier, then who comes first
/// in the script. Ref: priority inheritance as in [Okumura2022].
struct Precedence {
  std::int64_t held_up_since = 0;  ///< tick
  std::uint32_t person = 0;
  auto operator<=>(const Precedence&) const = default;  ///< the lesser goes first
};

/// What a body takes up of the floor: everything within radius_m of the segment ab.
struct Stadium {
  Vec2 a{0.0}, b{0.0};
  double radius_m = 0.0;
};

/// Negative inside.
[[nodiscard]] double distance(const Vec2& point, const Stadium& stadium);
/// Discs that cover it, `more_m` larger, but for a centimetre between them.
void append_discs(const Stadium& stadium, double more_m, std::vector<body::Disc>& discs);

/// What others need to know to keep out of a person's way.
struct Presence {
  std::uint32_t person = 0;  ///< index in the trial
  Vec2 position{0.0};
  Vec2 velocity{0.0};     ///< m/s
  Vec2 destination{0.0};  ///< where the current walk leads; the position of who isn't walking
  std::string_view seat;  ///< taken: from setting out for it to walking away from it; or empty
  enum class Script { going_on, carried_out } script = Script::going_on;
  enum class Posture { on_feet, on_chair } posture = Posture::on_feet;  ///< on_chair: also on the way onto it or off it
  enum class Solidity { solid, passing_through } solidity = Solidity::solid;
  /// What others keep clear of: with arms and, of a sitter, leaning back; all the way between sitting and standing.
  Stadium room;
  Stadium trunk;       ///< instead of room, of who squeezes past: the trunk as it is now
  double gap_m = 0.0;  ///< what others keep beside `room` where they plan their way
  /// Of somebody who is held up: the way that they would go if nobody were there; others leave it if they can.
  std::shared_ptr<const std::vector<Vec2>> wished_way;
  Precedence precedence;  ///< of that wish
  /// Sitters who block the way even for somebody who squeezes past: this person asks them to get up.
  std::shared_ptr<const std::vector<std::uint32_t>> asks_up;
  // A sitter who got up for somebody goes back to the place where they sat, once that person has passed.
  std::optional<Vec2> got_up_from;
  std::optional<std::uint32_t> got_up_for;
};

[[nodiscard]] inline bool is_solid(const Presence& other) noexcept {
  return other.solidity == Presence::Solidity::solid;
}

/// Everybody in the scene but one, in the order of the script: a view.
class Others {
 public:
  class Iterator {
   public:
    using value_type = Presence;
    using difference_type = std::ptrdiff_t;
    Iterator() = default;
    Iterator(const Presence* at, const Presence* me) : at_(at), me_(me) {}
    const Presence& operator*() const noexcept { return *at_; }
    const Presence* operator->() const noexcept { return at_; }
    Iterator& operator++() noexcept {
      if (++at_ == me_) ++at_;
      return *this;
    }
    Iterator operator++(int) noexcept {
      const Iterator before = *this;
      ++*this;
      return before;
    }
    bool operator==(const Iterator& other) const noexcept { return at_ == other.at_; }

   private:
    const Presence* at_ = nullptr;
    const Presence* me_ = nullptr;  ///< is passed over, if not null
  };

  enum class Me { among_them, not_there };
  Others() = default;
  /// in_scene: outlives the view; n_before: how many of them come before me in the script.
  Others(std::span<const Presence> in_scene, std::size_t n_before, Me me)
      : in_scene_(in_scene), n_before_(n_before), me_(me == Me::among_them ? &in_scene[n_before] : nullptr) {}

  [[nodiscard]] Iterator begin() const noexcept {
    return {in_scene_.data() + (me_ != nullptr && n_before_ == 0 ? 1 : 0), me_};
  }
  [[nodiscard]] Iterator end() const noexcept { return {in_scene_.data() + in_scene_.size(), nullptr}; }
  [[nodiscard]] bool empty() const noexcept { return begin() == end(); }
  /// Those who go first where ways cross.
  [[nodiscard]] std::span<const Presence> before_me() const noexcept { return in_scene_.first(n_before_); }

 private:
  std::span<const Presence> in_scene_;
  std::size_t n_before_ = 0;
  const Presence* me_ = nullptr;
};

/// See RunIncident.
struct Incident {
  IncidentKind kind = IncidentKind::passed_through;
  std::int64_t tick = 0;
  std::uint32_t person = 0;
  Vec2 place{0.0};
};

}  // namespace pirsim::sim
