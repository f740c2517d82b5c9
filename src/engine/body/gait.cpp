#include "engine/body/gait.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "pirsim/error.hpp"

namespace pirsim::body {
namespace {

constexpr double repeated_m = 1e-6;    ///< points closer than this are one point
constexpr double straight_rad = 1e-9;  ///< a smaller change of direction is no corner

/// A straight stretch between two points of the polyline.
struct Leg {
  Vec2 start;
  Vec2 direction;  ///< unit
  double length;
  double heading;  ///< differs from the previous leg's by at most half a turn
};

struct Corner {
  double turn = 0.0;       ///< change of heading, radians
  double radius = 0.0;     ///< of the arc
  double tangent_m = 0.0;  ///< from the corner to where the arc touches either leg
};

void require_usable(const std::vector<Vec2>& points, double corner_radius_m) {
  if (points.empty()) throw Error(ErrorCode::usage, "a route needs at least one point");
  if (!(corner_radius_m >= 0.0 && std::isfinite(corner_radius_m))) {
    throw Error(ErrorCode::usage, "the corner radius of a route must be finite and not negative");
  }
  for (const Vec2& p : points) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
      throw Error(ErrorCode::usage, "a point of a route must have finite coordinates");
    }
  }
}

std::vector<Leg> legs_between(const std::vector<Vec2>& points) {
  std::vector<Leg> legs;
  Vec2 start = points.front();
  for (const Vec2& end : points) {
    const double length = glm::distance(start, end);
    if (length < repeated_m) continue;
    const Vec2 direction = (end - start) / length;
    double heading = heading_of(direction);
    if (!legs.empty()) {
      const double before = legs.back().heading;
      heading = before + std::remainder(heading - before, 2.0 * std::numbers::pi);
    }
    legs.push_back({start, direction, length, heading});
    start = end;
  }
  return legs;
}

/// The arc between two legs; radius 0 where there is none.
Corner corner_between(const Leg& in, const Leg& out, double radius) {
  const double turn = out.heading - in.heading;
  const double half = 0.5 * std::abs(turn);
  if (std::abs(turn) < straight_rad || std::abs(turn) > Route::sharpest_arc_rad) return {turn};
  // The arc's middle is radius * (1 / cos(half) - 1) away from the corner, its ends radius * tan(half).
  const double cut_limit = Route::max_corner_cut_m / (1.0 / std::cos(half) - 1.0);
  const double leg_limit = 0.5 * std::min(in.length, out.length) / std::tan(half);
  radius = std::min({radius, cut_limit, leg_limit});
  return {turn, radius, radius * std::tan(half)};
}

constexpr int samples_per_step = 8;
// Within one step's way; assumed (90-120 degrees): beyond, the hips would pass their limits.
constexpr double sharpest_bend = 100.0 * pi / 180.0;

constexpr double rest_s = 0.5;  // assumed: who doesn't move for so long brings the feet together (0.2-1)

FollowedPath::Leg leg_of(std::span<const double> times_s, std::span<const Vec2> points,
                         std::span<const double> headings) {
  FollowedPath::Leg leg;
  leg.times_s.assign(times_s.begin(), times_s.end());
  leg.headings.assign(headings.begin(), headings.end());
  leg.route = Route(std::vector<Vec2>(points.begin(), points.end()), 0.0);
  double walked_m = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0) walked_m += glm::distance(points[i - 1], points[i]);
    leg.walked_m.push_back(walked_m);
  }
  return leg;
}

}  // namespace

Route::Route(const std::vector<Vec2>& points, double corner_radius_m) {
  require_usable(points, corner_radius_m);
  const std::vector<Leg> legs = legs_between(points);
  if (legs.empty()) pieces_.push_back({.start = points.front()});
  Corner before;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Leg& leg = legs[i];
    const bool last = i + 1 == legs.size();
    const Corner after = last ? Corner{} : corner_between(leg, legs[i + 1], corner_radius_m);
    const double straight_m = leg.length - before.tangent_m - after.tangent_m;
    add(leg.start + leg.direction * before.tangent_m, leg.heading, 0.0, straight_m);
    if (after.radius > 0.0) {
      const Vec2 touch = leg.start + leg.direction * (leg.length - after.tangent_m);
      add(touch, leg.heading, std::copysign(1.0 / after.radius, after.turn), after.radius * std::abs(after.turn));
    } else if (std::abs(after.turn) >= straight_rad) {
      sharp_turns_s_.push_back(length_m_);
    }
    before = after;
  }
}

void Route::add(const Vec2& start, double heading, double curvature, double length) {
  if (!(length > 0.0)) return;  // two arcs that meet in the middle of a leg leave nothing straight between them
  pieces_.push_back({length_m_, start, heading, curvature});
  length_m_ += length;
}

double Route::clamped(double s) const noexcept { return s > 0.0 ? std::min(s, length_m_) : 0.0; }

const Route::Piece& Route::piece_at(double s) const noexcept {
  const auto next = std::upper_bound(pieces_.begin(), pieces_.end(), s,
                                     [](double value, const Piece& piece) { return value < piece.begin_s; });
  return *std::prev(next);
}

Vec2 Route::position(double s) const noexcept {
  if (pieces_.empty()) return Vec2(0.0);
  s = clamped(s);
  const Piece& piece = piece_at(s);
  const double walked = s - piece.begin_s;
  // The chord of an arc points half its turn further and is sin(x) / x as long; exact for a leg too (x = 0).
  const double half_turn = 0.5 * piece.curvature * walked;
  const double chord = half_turn == 0.0 ? walked : walked * std::sin(half_turn) / half_turn;
  return piece.start + direction_of(piece.heading + half_turn) * chord;
}

double Route::heading(double s) const noexcept {
  if (pieces_.empty()) return 0.0;
  s = clamped(s);
  const Piece& piece = piece_at(s);
  return piece.heading + piece.curvature * (s - piece.begin_s);
}

double Route::curvature(double s) const noexcept {
  if (pieces_.empty()) return 0.0;
  return piece_at(clamped(s)).curvature;
}

double smoothstep(double x) noexcept {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

double wrapped(double angle) noexcept {
  const double turns = std::remainder(angle, 2.0 * pi);
  return turns <= -pi ? pi : turns;
}

Placement Placement::shifted(double forward, double right) const noexcept {
  const Vec2 ahead = direction_of(heading);
  const Vec2 sideways(-ahead.y, ahead.x);
  return {position + forward * ahead + right * sideways, heading};
}

Track::Track(const Route& route, double from_s, double to_s, const Placement& start, double step_m)
    : start_(start), length_(to_s - from_s), route_(route), from_s_(from_s), blend_length_(step_m) {
  const int n = std::max(1, static_cast<int>(std::ceil(length_ * samples_per_step / step_m)));
  spacing_ = length_ / n;
  std::vector<double> raw(static_cast<std::size_t>(n) + 1);
  raw[0] = start.heading + wrapped(route.heading(from_s) - start.heading);
  for (int i = 1; i <= n; ++i) {
    // At to_s itself the route may already head for what comes after a sharp turn.
    const double s = i < n ? from_s + i * spacing_ : to_s - 1e-9;
    const double before = raw[static_cast<std::size_t>(i) - 1];
    raw[static_cast<std::size_t>(i)] = before + wrapped(route.heading(s) - before);
  }
  headings_.resize(raw.size());
  for (int i = 0; i <= n; ++i) {
    double sum = 0.0;
    for (int k = i - samples_per_step / 2; k <= i + samples_per_step / 2; ++k) {
      sum += raw[static_cast<std::size_t>(std::clamp(k, 0, n))];
    }
    headings_[static_cast<std::size_t>(i)] = sum / (samples_per_step + 1);
  }
}

void Track::face(std::span<const double> at, std::span<const double> headings) {
  double heading = start_.heading;
  std::size_t next = 1;
  for (std::size_t i = 0; i < headings_.size(); ++i) {
    const double s = static_cast<double>(i) * spacing_;
    while (next + 1 < at.size() && at[next] < s) ++next;
    const std::size_t before = std::min(next, at.size() - 1) - (at.size() > 1 ? 1 : 0),
                      after = std::min(next, at.size() - 1);
    const double length = at[after] - at[before];
    const double share = length > 0.0 ? std::clamp((s - at[before]) / length, 0.0, 1.0) : 0.0;
    const double wanted = headings[before] + share * wrapped(headings[after] - headings[before]);
    heading += wrapped(wanted - heading);
    headings_[i] = heading;
  }
}

Track Track::turn(const Placement& start, double angle) {
  Track track;
  track.start_ = start;
  track.length_ = std::abs(angle);
  track.turn_per_length_ = angle < 0.0 ? -1.0 : 1.0;
  return track;
}

Track Track::stay(const Placement& start, double length) {
  Track track;
  track.start_ = start;
  track.length_ = length;
  return track;
}

Track Track::slide(const Placement& start, double direction, double distance_m) {
  Track track;
  track.start_ = start;
  track.length_ = std::abs(distance_m);
  track.slide_direction_ = direction_of(direction) * (distance_m < 0.0 ? -1.0 : 1.0);
  return track;
}

double Track::mean_heading(double s) const noexcept {
  const double x = spacing_ > 0.0 ? s / spacing_ : 0.0;
  const std::size_t i = std::min(static_cast<std::size_t>(std::max(x, 0.0)), headings_.size() - 2);
  const double t = std::clamp(x - static_cast<double>(i), 0.0, 1.0);
  return headings_[i] + t * (headings_[i + 1] - headings_[i]);
}

Placement Track::at(double s) const noexcept {
  if (!route_) return {start_.position + s * slide_direction_, start_.heading + turn_per_length_ * s};
  Placement place{route_->position(from_s_ + s), mean_heading(s)};
  const double fading = 1.0 - smoothstep(s / blend_length_);
  if (fading > 0.0) {
    place.position += fading * (start_.position - route_->position(from_s_));
    place.heading += fading * (start_.heading - headings_.front());
  }
  return place;
}

double next_pivot(const Route& route, double from_s, double step_m) noexcept {
  double end = route.length_m();
  for (const double turn_s : route.sharp_turns_s()) {
    if (turn_s > from_s) end = std::min(end, turn_s);
  }
  const auto bend_around = [&](double s) {
    const double before = route.heading(std::max(from_s, s - 0.5 * step_m));
    return std::abs(route.heading(std::min(end - 1e-9, s + 0.5 * step_m)) - before);
  };
  double sharpest = sharpest_bend;
  double first = end;  // of the places with the sharpest bend around them; the pivot is midway between first and last
  double last = end;
  const double spacing = step_m / samples_per_step;
  for (int i = 1; from_s + i * spacing < end; ++i) {
    const double s = from_s + i * spacing;
    const double bend = bend_around(s);
    if (bend > sharpest + 1e-9) {
      sharpest = bend;
      first = s;
    }
    if (first < end && bend > sharpest - 1e-9) last = s;
    if (first < end && bend < sharpest_bend) break;
  }
  return first < end ? 0.5 * (first + last) : end;
}

FootPlan::FootPlan(const Feet& start, double length, const StepStyle& style, double half_stance_m)
    : start_(start),
      length_(length),
      // A step longer by rounding alone must not cost a step more.
      steps_(std::max(1, static_cast<int>(std::ceil(length / style.step - 1e-9)))),
      half_stance_m_(half_stance_m),
      lift_per_stride_(style.lift_m / (2.0 * style.step)),
      pitch_per_lift_(style.pitch_per_lift),
      first_foot_(style.first_foot) {
  step_ = length_ / steps_;
}

int FootPlan::interval(double s) const noexcept {
  return step_ > 0.0 ? std::clamp(static_cast<int>(std::floor(s / step_ + 0.5)), 0, steps_) : steps_;
}

void FootPlan::shorten(double s, double braking) noexcept {
  int steps = interval(s) + 1;
  while (steps < steps_ && steps * step_ < s + braking) ++steps;
  if (steps >= steps_) return;
  steps_ = steps;
  length_ = steps * step_;
}

Placement FootPlan::print(const Track& track, std::size_t foot, double s) const noexcept {
  return s > 0.0 ? track.at(s).shifted(0.0, foot == 0 ? -half_stance_m_ : half_stance_m_) : start_[foot].print;
}

Feet FootPlan::feet(const Track& track, double s) const noexcept {
  const int j = interval(s);
  const auto swinging = static_cast<std::size_t>((j + first_foot_) % 2);
  const double begin = j == 0 ? 0.0 : (j - 0.5) * step_;
  const double end = j == steps_ ? length_ : (j + 0.5) * step_;
  const double p = end > begin ? std::clamp((s - begin) / (end - begin), 0.0, 1.0) : 1.0;
  const double from_s = std::max(0.0, (j - 1) * step_);
  const double to_s = std::min((j + 1) * step_, length_);

  Feet feet;
  feet[1 - swinging].print = print(track, 1 - swinging, std::min(j * step_, length_));
  const Placement from = print(track, swinging, from_s);
  const Placement to = print(track, swinging, to_s);
  // Seen from a body that moves on evenly this is the upper half of an ellipse.
  const double u = 0.5 * p + 0.25 * (1.0 - std::cos(pi * p));
  Footstep& foot = feet[swinging];
  foot.print.position = from.position + u * (to.position - from.position);
  foot.print.heading = from.heading + u * wrapped(to.heading - from.heading);
  const double highest = lift_per_stride_ * (to_s - from_s);
  foot.lift_m = highest * std::sin(pi * p);
  // The heel leaves the floor first, the toes come up before it lands. Toes 0.11 H ahead of the ankle clear the floor
  // for pitch_per_lift up to about 2.9 rad/m (H = 1.86 m).
  foot.pitch = -pitch_per_lift_ * highest * std::sin(pi * p) * (std::cos(pi * p) + 0.6);
  if (j == 0) {
    foot.lift_m += start_[swinging].lift_m * (1.0 - smoothstep(p));
    foot.pitch += start_[swinging].pitch * (1.0 - smoothstep(p));
  }
  return feet;
}

double FollowedPath::Leg::walked_at(double time_s) const noexcept {
  const auto later = std::ranges::upper_bound(times_s, time_s);
  if (later == times_s.begin()) return 0.0;
  if (later == times_s.end()) return route.length_m();
  const auto i = static_cast<std::size_t>(later - times_s.begin());
  const double share = (time_s - times_s[i - 1]) / (times_s[i] - times_s[i - 1]);
  return walked_m[i - 1] + share * (walked_m[i] - walked_m[i - 1]);
}

FollowedPath::FollowedPath(std::span<const double> times_s, std::span<const Vec2> points,
                           std::span<const double> headings)
    : first_s_(times_s.front()), last_s_(times_s.back()), start_{points.front(), 0.0} {
  const auto moves = [&](std::size_t i) { return points[i] != points[i + 1]; };  // to the next
  const std::size_t n = points.size();
  for (std::size_t begin = 0; begin + 1 < n;) {
    if (!moves(begin)) {
      ++begin;
      continue;
    }
    std::size_t end = begin + 1;  // of the last move so far
    for (std::size_t i = end; i + 1 < n && times_s[i] - times_s[end] < rest_s; ++i) {
      if (moves(i)) end = i + 1;
    }
    const std::size_t length = end - begin + 1;
    legs_.push_back(leg_of(times_s.subspan(begin, length), points.subspan(begin, length),
                           headings.empty() ? headings : headings.subspan(begin, length)));
    begin = end;
  }
  if (!headings.empty()) {
    start_.heading = headings.front();
  } else if (!legs_.empty()) {
    start_.heading = legs_.front().route.heading(0.0);
  }
}

std::size_t FollowedPath::n_begun(double time_s) const noexcept {
  const auto later = std::ranges::lower_bound(legs_, time_s, {}, [](const Leg& leg) { return leg.times_s.front(); });
  return static_cast<std::size_t>(later - legs_.begin());
}

}  // namespace pirsim::body
