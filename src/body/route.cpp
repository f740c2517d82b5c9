#include "body/route.hpp"

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

}  // namespace pirsim::body
