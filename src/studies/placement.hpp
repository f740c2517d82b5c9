// Which set of sensors covers a room best, and could another one do better?
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pirsim/look.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/survey.hpp"
#include "studies/coverage.hpp"
#include "studies/sitters.hpp"

namespace pirsim::studies {

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

}  // namespace pirsim::studies
