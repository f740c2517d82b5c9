#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <set>
#include <string>

#include "core/text.hpp"

namespace pirsim {
namespace {

// All assumed. Nobody runs faster (10-15); somebody who crosses a room is faster than the walk (0.2-0.4).
constexpr double fastest_m_s = 12.0, slowest_walk_m_s = 0.3, walk_m = 2.0;

/// How a file's numbers may be meant: scale times (x, z), or (z, x).
struct Reading {
  const char* name;
  double scale = 1.0;
  Vec2 signs{1.0};
  bool is_swapped = false;
  [[nodiscard]] Vec2 of(const Vec2& p) const { return scale * signs * (is_swapped ? Vec2(p.y, p.x) : p); }
};
const std::array readings{Reading{"z turned round", 1.0, {1.0, -1.0}},
                          Reading{"centimetres", 0.01},
                          Reading{"millimetres", 0.001},
                          Reading{"feet", 0.3048},
                          Reading{"inches", 0.0254},
                          Reading{"x and z exchanged", 1.0, {1.0, 1.0}, true},
                          Reading{"x turned round", 1.0, {-1.0, 1.0}},
                          Reading{"x and z turned round", 1.0, {-1.0, -1.0}},
                          Reading{"centimetres with z turned round", 0.01, {1.0, -1.0}},
                          Reading{"millimetres with z turned round", 0.001, {1.0, -1.0}}};

struct Step {
  double metres = 0.0, seconds = 0.0, at_s = 0.0;
  const TrackSpec* track = nullptr;
  [[nodiscard]] double speed() const { return metres / seconds; }
};

std::string in_metres(const Vec2& size) { return fixed(size.x, 2) + " m x " + fixed(size.y, 2) + " m"; }

class Doubts {
 public:
  Doubts(const FloorArea& floor, const PositionsSpec& positions) : floor_(floor), positions_(positions) {
    for (const TrackSpec& track : positions.tracks) {
      for (std::size_t i = 0; i < track.points.size(); ++i) add(track, i);
    }
  }

  [[nodiscard]] std::optional<std::string> text() const {
    if (n_ == 0 || floor_.empty()) return std::nullopt;
    if (auto told = off_the_floor()) return told;
    if (auto told = too_fast()) return told;
    if (auto told = too_slow()) return told;
    return in_a_corner();
  }

 private:
  void add(const TrackSpec& track, std::size_t i) {
    ++n_;
    lower_ = glm::min(lower_, track.points[i]);
    upper_ = glm::max(upper_, track.points[i]);
    if (i == 0) return;
    const double seconds = track.times_s[i] - track.times_s[i - 1];
    const Step step{glm::distance(track.points[i], track.points[i - 1]), seconds, track.times_s[i], &track};
    longest_step_s_ = std::max(longest_step_s_, seconds);
    shortest_step_s_ = std::min(shortest_step_s_, seconds);
    if (fastest_.track == nullptr || step.speed() > fastest_.speed()) fastest_ = step;
    farthest_m_ = std::max(farthest_m_, glm::distance(track.points[i], track.points.front()));
  }

  [[nodiscard]] double share_on_floor(const Reading& reading) const {
    std::size_t n = 0;
    for (const TrackSpec& track : positions_.tracks)
      n += static_cast<std::size_t>(
          std::ranges::count_if(track.points, [&](const Vec2& p) { return floor_.contains(reading.of(p)); }));
    return static_cast<double>(n) / static_cast<double>(n_);
  }

  [[nodiscard]] std::optional<std::string> off_the_floor() const {
    constexpr double few = 0.5, most = 0.9;  // assumed: people wait behind doors, and trackers see beyond walls
    const double on = share_on_floor({"as they are"});
    if (on >= few) return std::nullopt;
    const auto* meant = std::ranges::find_if(readings, [&](const Reading& one) { return share_on_floor(one) >= most; });
    if (on > 0.0 && meant == readings.end()) return std::nullopt;
    return (on > 0.0 ? "only " + percent(on) + " of the positions are over the floor"
                     : std::string("nobody is ever over the floor")) +
           ": they span x " + fixed(lower_.x, 2) + " to " + fixed(upper_.x, 2) + ", z " + fixed(lower_.y, 2) + " to " +
           fixed(upper_.y, 2) + ", the floor x " + fixed(floor_.lower().x, 2) + " to " + fixed(floor_.upper().x, 2) +
           ", z " + fixed(floor_.lower().y, 2) + " to " + fixed(floor_.upper().y, 2) +
           (meant == readings.end() ? "" : std::string(". They look like ") + meant->name) +
           "; metres of the scene are expected";
  }

  [[nodiscard]] std::optional<std::string> too_fast() const {
    if (fastest_.track == nullptr || fastest_.speed() <= fastest_m_s) return std::nullopt;
    return "'" + fastest_.track->person + "' goes " + fixed(fastest_.metres, 2) + " m in " +
           fixed(fastest_.seconds, 2) + " s, until second " + fixed(fastest_.at_s, 1) + ": " +
           fixed(fastest_.speed(), 0) + " m/s. Are places metres and times seconds, and is it one person throughout?";
  }

  /// Frames, as 0, 1, 2, ... of a camera, are far longer when they are taken for seconds, and milliseconds are.
  [[nodiscard]] std::optional<std::string> too_slow() const {
    constexpr double frame_s = 1.5, rare_s = 100.0,
                     slowest_m_s = 0.03;  // assumed: of rows far apart people rest between
    const bool are_frames = longest_step_s_ <= frame_s && fastest_.speed() < slowest_walk_m_s;
    const bool are_ms = shortest_step_s_ >= rare_s && fastest_.speed() < slowest_m_s;
    if (farthest_m_ < walk_m || !(are_frames || are_ms)) return std::nullopt;
    return "people cross " + fixed(farthest_m_, 1) + " m of the room, and nobody is faster than " +
           fixed(fastest_.speed(), 3) + " m/s: the times look like " + (are_frames ? "frames" : "milliseconds") +
           " rather than seconds";
  }

  [[nodiscard]] std::optional<std::string> in_a_corner() const {
    constexpr double of_several = 0.2, of_one = 0.1;  // assumed (0.1-0.3, 0.05-0.2), of the floor's sides
    const double share = positions_.tracks.size() > 1 ? of_several : of_one;
    const Vec2 size = upper_ - lower_, floor = floor_.upper() - floor_.lower();
    if (n_ < 3 || size.x > share * floor.x || size.y > share * floor.y || size == Vec2(0.0)) return std::nullopt;
    return "all positions lie within " + in_metres(size) + " of a floor of " + in_metres(floor) +
           ": metres of the scene are expected";
  }

  const FloorArea& floor_;
  const PositionsSpec& positions_;
  std::size_t n_ = 0;
  Vec2 lower_{std::numeric_limits<double>::max()}, upper_{std::numeric_limits<double>::lowest()};
  Step fastest_{};
  double longest_step_s_ = 0.0, shortest_step_s_ = std::numeric_limits<double>::max(), farthest_m_ = 0.0;
};

}  // namespace

std::vector<Issue> doubts_of_positions(const SceneSpec& scene, const ScriptSpec& script) {
  Diagnostics remarks;
  std::set<std::string> told;
  for (const TrialSpec& trial : script.trials) {
    if (!trial.occupancy || !trial.occupancy->positions || trial.occupancy->positions->tracks.empty()) continue;
    const PositionsSpec& positions = *trial.occupancy->positions;
    const std::optional<std::string> text = Doubts(scene.floor, positions).text();
    if (text && told.insert(*text).second) remarks.warning(positions.tracks.front().where, "positions: " + *text);
  }
  return remarks.issues();
}

}  // namespace pirsim
