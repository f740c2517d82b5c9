#include "body/foot_plan.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace pirsim::body {

namespace {
constexpr int samples_per_step = 8;
// Within one step's way; assumed (90-120 degrees): beyond, the hips would pass their limits.
constexpr double sharpest_bend = 100.0 * pi / 180.0;
}  // namespace

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

}  // namespace pirsim::body
