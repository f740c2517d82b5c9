#include "body/followed_path.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace pirsim::body {
namespace {

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
