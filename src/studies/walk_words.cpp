#include "studies/walk_words.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "core/text.hpp"
#include "pirsim/response.hpp"

namespace pirsim::studies {
namespace {

std::string plain(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}
std::string seconds(double value) { return plain(value) + " s"; }

/// "3 of 4"
std::string told(const PassCount& count) { return std::to_string(count.passed) + " of " + std::to_string(count.tried); }

/// Index of the square that holds the point; none beside the grid.
std::optional<std::size_t> square_at(const FloorGrid& grid, const Vec2& point) {
  const Vec2 from_corner = (point - grid.centre(0, 0)) / grid.spacing_m() + 0.5;
  const double column = std::floor(from_corner.x), row = std::floor(from_corner.y);
  if (column < 0.0 || row < 0.0 || column >= static_cast<double>(grid.n_columns()) ||
      row >= static_cast<double>(grid.n_rows()))
    return std::nullopt;
  return static_cast<std::size_t>(row) * grid.n_columns() + static_cast<std::size_t>(column);
}

}  // namespace

bool passes(const Tries& tries, const WalkRequirement& requirement) {
  return tries.made > 0 && *tries.probability() >= requirement.probability - 1e-12;
}

std::string WalkWords::time_of_major() const {
  return spec_.stop_s ? "before a stop of " + seconds(*spec_.stop_s) + " ends"
                      : "within " + seconds(spec_.major.within_s);
}

std::string WalkWords::time_of_minor() const { return "within " + seconds(spec_.minor.within_s); }

std::string WalkWords::required(const WalkRequirement& requirement) const {
  return "in at least " + percent(requirement.probability) + " of " + std::to_string(requirement.directions) +
         " directions";
}

std::string WalkWords::planes() const {
  std::vector<std::string> words;
  for (const ArmSwing plane : spec_.arm->swings)
    words.emplace_back(plane == ArmSwing::horizontal ? "horizontally" : "vertically");
  return joined(words, " and ");
}

std::string WalkWords::of_major(const PassCount& count) const {
  return "walker noticed " + time_of_major() + " " + required(spec_.major) + ": " + told(count) + " points pass";
}

std::string WalkWords::of_minor(const PassCount& count) const {
  const std::string arm = spec_.arm ? required(spec_.minor) + ", " + planes() : "";
  return (spec_.arm ? "swinging arm noticed " + time_of_minor() + " " + arm
                    : "sitter's arms noticed " + time_of_minor() + " " + required(spec_.minor)) +
         ": " + told(count) + " points pass";
}

std::string WalkWords::of_area(const std::string& area, const PassCount& major, const PassCount& minor) const {
  return area + ": walker " + told(major) + " points pass, " + (spec_.arm ? "arm " : "arms ") + told(minor);
}

std::string WalkWords::of_deafness(const WalkTestResult& result) const {
  int missed = 0, deaf = 0;
  for (const PointResult& point : result.points) {
    missed += point.minor.made - point.minor.noticed;
    deaf += point.minor.deaf;
  }
  return "of " + std::to_string(missed) + " tries without notice, sensors saw the " + (spec_.arm ? "arm" : "sitter") +
         " in " + std::to_string(deaf);
}

std::string WalkWords::of_seats(const WalkTestResult& result) const {
  const auto named = [](const std::string& seats) { return seats.empty() ? " none" : seats; };
  if (!spec_.arm) {
    std::string noticed, deaf, unseen;
    for (const SeatResult& seat : result.seats) {
      (seat.noticed ? noticed : seat.deaf ? deaf : unseen) += " " + seat.seat;
    }
    if (result.seats.empty()) return {};
    return "seats where a sitter's arms are noticed:" + named(noticed) + "; seen, but not noticed:" + named(deaf) +
           "; unseen:" + named(unseen);
  }
  std::string outside;
  for (const SeatSpec& seat : test_.scene().seats) {
    const std::optional<std::size_t> at = square_at(result.grid, floor_point(seat.world_from_seat.origin));
    if (!at || !passes(result.points[*at].minor, spec_.minor)) outside += " " + seat.id;
  }
  if (test_.scene().seats.empty()) return {};
  return "seats in squares that fail:" + named(outside);
}

std::string WalkWords::title() const { return spec_.name + ": walk test of " + test_.scene().name; }

std::string WalkWords::minor_heading() const {
  return spec_.arm ? "Minor motion: a swinging arm" : "Minor motion: arms of a sitter";
}

std::string WalkWords::method() const {
  const std::string response =
      ". A try counts as noticed if any sensor reports motion in time; the sensors' response is " +
      responses_in_words(test_.scene(), spec_.sensing) + ".";
  std::string text =
      "At every point of a grid a person of the study's measures walks across in several directions (major motion), "
      "and ";
  if (!spec_.arm) {
    return text + "sits there facing several ways and moves both forearms (minor motion)" + response +
           " In the manner of NEMA WD 7 and EN 50131-2-2; not a conformity test.";
  }
  const SwingingArmSpec& arm = *spec_.arm;
  text += "a box of " + plain(arm.width_m) + " x " + plain(arm.width_m) + " x " + plain(arm.length_m) +
          " m, whose axis is " + plain(arm.height_m) + " m above the floor, swings by " + plain(arm.swing_deg) +
          " degrees and back at " + plain(arm.deg_per_s) + " degrees a second, " + planes() + " (minor motion)";
  return text + response;
}

}  // namespace pirsim::studies
