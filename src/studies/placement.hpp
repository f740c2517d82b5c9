// Which set of sensors covers a room best, and could another one do better?
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pirsim/look.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/survey.hpp"

namespace pirsim::studies {

/// Of idle sensors, a warning for each reason; where the first hangs off the floor, how far.
[[nodiscard]] std::vector<Issue> warnings(std::span<const PlacementScore> scores, const FloorArea& floor);

/// Throws Error(input) as CoverageStudy does. The scene has every model that the set names.
[[nodiscard]] PlacementScore score(const SceneSpec& scene, const CoverageSpec& coverage, SensorSetSpec set,
                                   unsigned threads = 0);

/// Somebody of natural style at work in each seat, in sight of the set. Throws as score() does.
[[nodiscard]] SeatsAtWork seats_at_work(const SceneSpec& scene, const CoverageSpec& coverage, const SensorSetSpec& set,
                                        unsigned threads = 0);

/// Greatest seen area first; ties: fewer blind seats, then the order given.
[[nodiscard]] std::vector<PlacementScore> ranked(std::vector<PlacementScore> scores);

/// Looks for the sensors' places along the lines that cover most: NLopt's DIRECT-L over all of them, then SBPLX from
/// the best. Both are deterministic. `set_done` is called after each set that was tried. Ref: [Gablonsky2001],
/// [Rowan1990].
[[nodiscard]] PlacementSearch search_placement(
    const SceneSpec& scene, const CoverageSpec& coverage, const PlacementSearchSpec& search, unsigned threads = 0,
    const std::function<void()>& set_done = [] {});

/// Sensors at these shares, in [0, 1], of the lines' joint length.
[[nodiscard]] SensorSetSpec sensors_along(const PlacementSearchSpec& search, const std::vector<double>& shares,
                                          std::string id);

[[nodiscard]] std::string to_text(const std::vector<PlacementScore>& scores);
[[nodiscard]] std::string to_text(const PlacementSearch& search);

}  // namespace pirsim::studies
