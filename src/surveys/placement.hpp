// What light goes by, row by row, as bits: who is where, and which sensor moved it. People don't depend on sensors, so
// what a set of sensors does to light follows from the columns of its sensors, whichever run they are from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/look.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/survey.hpp"
#include "surveys/coverage.hpp"
#include "surveys/light.hpp"
#include "surveys/sight.hpp"

namespace pirsim::studies {

/// Rows as bits, 64 a word; unused ones are 0.
using RowBits = std::vector<std::uint64_t>;

/// Of one run, which begins in the dark.
struct LightRun {
  std::size_t n_rows = 0;
  std::vector<RowBits> occupied;  ///< (n_areas)
  std::vector<RowBits> moved;     ///< (n_sensors)
};

struct LightRows {
  double window_s = 1.0;
  std::vector<std::string> areas;                   ///< without areas one, without a name
  std::vector<std::string> sensors;                 ///< ids
  std::vector<std::optional<std::size_t>> area_of;  ///< (n_sensors) that the sensor watches; none: none of them
  std::vector<LightRun> runs;
  std::vector<Issue> warnings;  ///< of runs that can't go on, which are left out
};

/// Called with the runs done and their number, from one thread at a time; what it throws ends the work.
using RunsDone = std::function<void(std::size_t n_done, std::size_t n_runs)>;

/// Runs all trials of the light's people in sight of the scene's sensors. sensing: of the study, whose response, if it
/// says one, replaces the script's. Throws Error as compile() and run_study() do.
[[nodiscard]] LightRows light_rows(
    const SceneSpec& scene, const PlacementLightSpec& light, const SensingSpec& sensing, unsigned threads = 0,
    const RunsDone& done = [](std::size_t, std::size_t) {});

/// What becomes of an area's light, in rows.
struct LightSums {
  std::int64_t occupied = 0, false_offs = 0, dark = 0, lit_empty = 0;
  LightSums& operator+=(const LightSums& other) noexcept;
  /// False-offs first, then time in the dark, then empty light. Occupied rows don't count: they are the same.
  [[nodiscard]] bool better_than(const LightSums& other) const noexcept;
  bool operator==(const LightSums&) const = default;
};

/// Switches an area's light by any of these sensors.
[[nodiscard]] LightSums switch_light(const LightRows& rows, std::size_t area, std::span<const std::size_t> sensors,
                                     const PlacementLightSpec& light);

/// Of all sensors: each area's light, and all together.
struct LightScore {
  PlacementLight all;
  std::vector<PlacementLight> areas;  ///< that have people or sensors
};
[[nodiscard]] LightScore score_light(const LightRows& rows, const PlacementLightSpec& light);

// Which set of sensors covers a room best, and could another one do better?

/// Of idle sensors, a warning for each reason; where the first hangs off the floor, how far.
[[nodiscard]] std::vector<Issue> warnings(std::span<const PlacementScore> scores, const FloorArea& floor);

/// Throws Error(input) as CoverageStudy does. The scene has every model that the set names.
[[nodiscard]] PlacementScore score(const SceneSpec& scene, const CoverageSpec& coverage, SensorSetSpec set,
                                   unsigned threads = 0);

/// The scene with the set's sensors; its own if the set has none.
[[nodiscard]] SceneSpec with_set(SceneSpec scene, const SensorSetSpec& set);
[[nodiscard]] CoverageStudy study_of(const SceneSpec& scene, const CoverageSpec& coverage, const SensorSetSpec& set);

/// (n_seats)(n_sensors) windows in which each sensor reports motion of a target that turns where the seat is.
[[nodiscard]] std::vector<std::vector<MotionCount>> counts_at_seats(const CoverageStudy& study);
/// Seats where no sensor does. counts: (n_seats)(n_sensors).
[[nodiscard]] std::vector<std::string> seats_without_target(const SceneSpec& scene,
                                                            const std::vector<std::vector<MotionCount>>& counts);

/// Somebody of natural style at work in each seat, in sight of the study's sensors.
[[nodiscard]] WorkReport watch_workers(const CoverageStudy& study, SeatsTried tried, unsigned threads = 0);
/// By seats all of them are tried. Throws as score() does.
[[nodiscard]] SeatsAtWork seats_at_work(const SceneSpec& scene, const PlacementSpec& spec, const SensorSetSpec& set,
                                        unsigned threads = 0);

/// Best first. By area: fewer blind seats decide among equals. By seats: those that are surely noticed, area, then
/// fewer blind seats. By false-offs: time in the dark, empty light, then as by area. Then the order given.
[[nodiscard]] std::vector<PlacementScore> ranked(std::vector<PlacementScore> scores,
                                                 PlacementAim by = PlacementAim::area);

/// What sets are ranked by, in words that follow "ranked by".
[[nodiscard]] std::string ranked_by(const PlacementSpec& spec);
/// A line that says what sets are ranked by, then one a set.
[[nodiscard]] std::string to_text(const std::vector<PlacementScore>& scores, const PlacementSpec& spec);
[[nodiscard]] std::string to_text(const PlacementSearch& search, PlacementAim by);
/// Which sensor hangs where.
[[nodiscard]] std::string to_text(const SensorSetSpec& set);

// Which few of many candidates do best together? A search knows how many there are, which one adds most to some, and
// which of two choices is better.

using Chosen = std::vector<std::size_t>;  ///< indices of candidates

/// Takes the candidate that is best with those before it, `n` times. n: at most as many as there are.
template <typename Search>
[[nodiscard]] Chosen greedy(Search& search, std::size_t n) {
  Chosen chosen;
  while (chosen.size() < n) chosen.push_back(search.best_addition(chosen));
  return chosen;
}

/// Exchanges one candidate after the other for the best other one, until no exchange gains anything.
template <typename Search>
[[nodiscard]] Chosen exchanged(Search& search, Chosen chosen) {
  for (bool gains = chosen.size() < search.n_candidates(); gains;) {
    gains = false;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      Chosen others = chosen, changed = chosen;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      changed[i] = search.best_addition(others);
      if (!search.is_better(changed, chosen)) continue;
      chosen = std::move(changed);
      gains = true;
    }
  }
  return chosen;
}

/// The better of two starts, after exchanges: the greedy one and `start`. Never worse than either.
template <typename Search>
[[nodiscard]] Chosen best_of(Search& search, const Chosen& start) {
  Chosen from_greed = exchanged(search, greedy(search, start.size())), from_start = exchanged(search, start);
  return search.is_better(from_start, from_greed) ? from_start : from_greed;
}

/// Things that candidates cover. What a thing is worth counts once, however many cover it, so that the greedy choice is
/// worth at least 1 - 1/e of the best. Ref: [NemhauserWolseyFisher1978].
struct Cover {
  std::vector<std::uint64_t> worth;                 ///< (n_things)
  std::vector<std::vector<std::uint32_t>> covered;  ///< (n_candidates) things of each

  [[nodiscard]] std::size_t n_candidates() const noexcept { return covered.size(); }
  [[nodiscard]] std::uint64_t worth_of(const Chosen& chosen) const;
  /// Of those that aren't chosen; the first of several.
  [[nodiscard]] std::size_t best_addition(const Chosen& chosen) const;
  [[nodiscard]] bool is_better(const Chosen& a, const Chosen& b) const { return worth_of(a) > worth_of(b); }
};

/// Sensors that make light go off on somebody seldom. Areas don't depend on each other: what an area's sensors do is
/// worked out once.
class LightSearch {
 public:
  /// Both outlive it.
  LightSearch(const LightRows& rows, const PlacementLightSpec& light)
      : rows_(rows), light_(light), known_(rows.areas.size()) {}

  [[nodiscard]] std::size_t n_candidates() const noexcept { return rows_.sensors.size(); }
  /// Of all areas together.
  [[nodiscard]] LightSums of(const Chosen& chosen);
  /// Of those that aren't chosen; the first of several.
  [[nodiscard]] std::size_t best_addition(const Chosen& chosen);
  [[nodiscard]] bool is_better(const Chosen& a, const Chosen& b) { return of(a).better_than(of(b)); }

 private:
  [[nodiscard]] const LightSums& of_area(std::size_t area, const Chosen& chosen);

  const LightRows& rows_;
  const PlacementLightSpec& light_;
  std::vector<std::map<Chosen, LightSums>> known_;  ///< (n_areas) by the sensors that watch it, in order
};

// A better set of sensors, looked for along mounting lines.

/// Called after each set that is tried; by seats, after each place.
using Tried = std::function<void()>;

/// By area: seen area, by NLopt's DIRECT-L and then SBPLX. By seats: judges single places, evenly along the lines and
/// those of even spacing, and covers seats, then seats that are surely noticed, then area, with the best of them. By
/// false-offs: the same places, in sight of the light's people. Starts from even spacing. Throws as score() does. Sets
/// at_work and light of neither.
[[nodiscard]] PlacementSearch search_placement(
    const SceneSpec& scene, const PlacementSpec& spec, const PlacementSearchSpec& search, unsigned threads = 0,
    const Tried& tried = [] {});

/// In each area one of these models, where it alone does best in that area by what the study ranks by (not false-offs):
/// in a corner, tilted down by 20 degrees, or in the middle of the ceiling. Throws Error(input) without areas.
[[nodiscard]] SensorSetSpec best_in_each_area(
    const SceneSpec& scene, const PlacementSpec& spec, const std::vector<std::string>& models, unsigned threads = 0,
    const Tried& tried = [] {});

/// Sensors at these shares, in [0, 1], of the lines' joint length.
[[nodiscard]] SensorSetSpec sensors_along(const PlacementSearchSpec& search, const std::vector<double>& shares,
                                          std::string id);

/// What sensors at these shares notice, each by itself: all seats, then the same seats if they are surely noticed, then
/// all squares of the floor. A seat is worth more than all that comes after.
[[nodiscard]] Cover cover_of(const SceneSpec& scene, const PlacementSpec& spec, const PlacementSearchSpec& search,
                             const std::vector<double>& shares, unsigned threads, const Tried& tried);

}  // namespace pirsim::studies
