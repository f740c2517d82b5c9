// Looking at a study: a picture of a moment, a page that plays a run, an animated glTF, what sensors can see, and which
// places for sensors are better.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pirsim/io.hpp"
#include "pirsim/model.hpp"
#include "pirsim/survey.hpp"

namespace pirsim {

/// Called whenever so many more seconds of the run are simulated, so that a caller can tell how far it is. May throw,
/// which ends the work.
using Simulated = std::function<void(double seconds)>;

/// "1280 x 720 pixels of run 0 at 20 s, with the first sensor's beams."
struct PictureRequest {
  std::uint32_t run = 0;
  std::optional<double> time_s;           ///< none: 10 s into desk work, or the end of a run without any
  std::vector<std::string> beams;         ///< sensors whose beams are drawn, or "all" or "none"; empty: the first one's
  std::vector<std::string> marks{"all"};  ///< seats, doors, sensors, people, scale, key; or "all" or "none"
  std::optional<Vec3> camera, look_at;    ///< none: from above and beside, the whole floor in view
  double field_of_view_deg = 45.0;        ///< vertical, 1 to 170
  int width = 1280, height = 720;         ///< pixels: 16 to 7680, 16 to 4320
  Simulated simulated{};
};

struct Picture {
  std::string png;      ///< the bytes of a file
  double time_s = 0.0;  ///< of the run
};

/// Throws Error(usage) for names and numbers that aren't accepted and a moment that never comes, Error(infeasible) for
/// a run that can't go on.
[[nodiscard]] Picture picture_of(const Model& model, const PictureRequest& request);

struct PageRequest {
  std::uint32_t run = 0;
  /// Seconds of the run. Neither: all of it, or of a longer run than 1200 s those 1200 s with most motion; one of them:
  /// at most 1200 s.
  std::optional<double> from_s, to_s;
  double keys_per_s = 10.0;              ///< pictures a second, between which the page interpolates: 0.1 to 100
  std::optional<CoverageSpec> coverage;  ///< whose map is laid on the floor
  std::string scene, script;             ///< names that the page gives; empty: those of the specs
  Simulated simulated{};
};

struct Page {
  std::string html;  ///< one file that works without a network
  std::string about;
  double from_s = 0.0, to_s = 0.0, run_s = 0.0;
  bool is_busiest_part = false;  ///< of a run that is too long to be shown as a whole
};

/// Throws as picture_of() and run_coverage() do.
[[nodiscard]] Page page_of(const Model& model, const PageRequest& request);

struct FilmRequest {
  std::uint32_t run = 0;
  std::vector<std::string> beams{"all"};  ///< as of a picture
  double keys_per_s = 10.0;               ///< 0.001 to 10000
  std::optional<double> from_s, to_s;     ///< seconds of the run; none: its beginning, its end
  Simulated simulated{};
};

/// Writes the run as an animated glTF (docs/formats/view.md): .glb, or by any other extension .gltf. Its
/// animation begins at 0, however late in the run. Returns how long it is, seconds. Throws as picture_of() does, and
/// Error(io).
double export_run(const std::filesystem::path& file, const Model& model, const FilmRequest& request = {});

/// What a sensor sees of a person who stands or sits still; an array in one frame, three times above its noise.
struct SensorSight {
  std::string sensor;
  std::size_t rays = 0;
  std::size_t rays_cut = 0;        ///< rays that end at the room before their rated range
  double longest_m = 0.0;          ///< of the rays as cut
  std::string outside;             ///< how far outside of the room it hangs, in words; empty: it doesn't
  std::size_t places = 0;          ///< places of the floor where a zone sees a standing person
  std::string area;                ///< that it watches, or no text
  std::size_t area_places = 0;     ///< of that area
  std::size_t area_seen = 0;       ///< of these, where a zone sees a standing person
  bool is_beam = false;            ///< it crosses a door, not the floor
  std::vector<std::string> seats;  ///< seats where a zone sees a sitter at rest
  std::string about{};             ///< of an array: pixels, noise and contrasts, in words
  [[nodiscard]] bool sees_nothing() const noexcept { return places == 0 && seats.empty(); }
};

struct SightReport {
  double spacing_m = 0.25;  ///< of the places tried
  std::size_t places = 0;   ///< walkable places of the floor area
  std::size_t places_seen_by_any = 0;
  std::vector<SensorSight> sensors;  ///< in the scene's order, then its arrays
};

/// What one sensor makes of somebody who works in a seat.
struct WorkNotice {
  int seconds = 0;           ///< with motion
  std::size_t channels = 0;  ///< clusters (with `change_per: beam`, zones) that see the person at some moment
  std::size_t for_good = 0;  ///< of those, that see the person at every moment: what moves there is no change
  /// Sees the person and never reports motion.
  [[nodiscard]] bool is_deaf() const noexcept { return channels > 0 && seconds == 0; }
  /// In a single second motion may be luck: at another quarter of an hour there may be none (10 s: `assumed`; 1 and 10
  /// tried: docs/formats/coverage.md).
  [[nodiscard]] bool is_sure() const noexcept { return seconds >= 10; }
  bool operator==(const WorkNotice&) const = default;
};

/// Seats by what becomes of somebody who works there.
struct SeatsAtWork {
  std::vector<std::string> noticed;  ///< some sensor reports motion
  std::vector<std::string> deaf;     ///< sensors see the person, and none ever reports motion
  std::vector<std::string> unseen;
  std::vector<std::string> surely;  ///< of `noticed`: some sensor reports motion in 10 s or more
};

/// Somebody at work in one seat after the other, alone.
struct WorkReport {
  int seconds = 0;                  ///< in each seat
  std::vector<std::string> seats;   ///< that were tried: of very many some
  std::vector<WorkNotice> notices;  ///< (n_seats x n_sensors)
  [[nodiscard]] const WorkNotice& notice(std::size_t seat, std::size_t sensor) const {
    return notices[seat * (notices.size() / seats.size()) + sensor];
  }
  /// What becomes of the seats in sight of all sensors together.
  [[nodiscard]] SeatsAtWork by_any() const;
  /// Seats where the sensor is deaf.
  [[nodiscard]] std::vector<std::string> deaf_seats(std::size_t sensor) const;
};

struct CheckReport {
  SightReport sight;
  WorkReport work;
  std::string text;             ///< for a reader, as `pirsim check` prints it
  std::vector<Issue> warnings;  ///< of sensors that see nothing
};

/// What `pirsim check` tells of a study, without running it.
[[nodiscard]] CheckReport check_study(const Model& model);

/// What becomes of the light of an area, or of all areas together.
struct PlacementLight {
  std::string area{};                  ///< empty: all, or a scene without areas
  std::vector<std::string> sensors{};  ///< that switch it; none: it is counted as if a sensor saw nobody
  double occupied_h = 0.0;
  std::int64_t false_offs = 0;  ///< it went off while somebody was there
  double dark_h = 0.0;          ///< while somebody was there
  double lit_empty_h = 0.0;     ///< while nobody was there
  [[nodiscard]] double false_offs_an_hour() const noexcept {
    return occupied_h > 0.0 ? static_cast<double>(false_offs) / occupied_h : 0.0;
  }
  [[nodiscard]] double dark_share() const noexcept { return occupied_h > 0.0 ? dark_h / occupied_h : 0.0; }
  bool operator==(const PlacementLight&) const = default;
};

/// How one set of sensors does. The target stands still at a square or seat as in a coverage study.
struct PlacementScore {
  SensorSetSpec set;
  double seen_area_m2 = 0.0;  ///< by at least one sensor
  double blind_fraction = 0.0;
  double overlap = 0.0;                  ///< share of the seen area that two sensors or more see
  std::vector<std::string> blind_seats;  ///< where no sensor sees the target
  SeatsAtWork at_work{};                 ///< of somebody of natural style who types
  std::vector<std::size_t> idle{};       ///< sensors of the set that see the target nowhere
  PlacementLight light{};                ///< by `false_off`: of all areas together
  std::vector<PlacementLight> areas{};   ///< by `false_off`: of each area that has people
};

struct PlacementSearch {
  PlacementScore even;   ///< spaced evenly along the lines
  PlacementScore found;  ///< never worse than `even`
  int evaluations = 0;   ///< sets that were tried; by seats: places
  bool gained = true;    ///< `found` is better than `even`
};

struct PlacementReport {
  std::vector<PlacementScore> ranked;  ///< best first, with those of the search
  std::optional<PlacementSearch> search;
  std::string text;             ///< for a reader, as `pirsim placements` prints it
  std::vector<Issue> warnings;  ///< of sensors that see nothing
  SceneSpec best;               ///< the scene with the best set's sensors in place of its own
};

struct PlacementOptions {
  unsigned threads = 0;                ///< 0: all cores; changes no number
  std::filesystem::path scene_file{};  ///< beside which models of sensors are looked for
  io::SceneOptions scenes{};
  std::function<void()> set_done{};  ///< after each set of the study, and each set or place that the search has tried
  /// Names of models: besides the sets, one sensor in each area is looked for, in its corners and below its ceiling.
  std::vector<std::string> each_area{};
};

/// Compares a placement study's sets of sensors, and looks for a better one if it asks for that. Throws Error(input)
/// for a spec that the scene can't serve and a model that isn't known.
[[nodiscard]] PlacementReport run_placements(SceneSpec scene, const PlacementSpec& spec,
                                             const PlacementOptions& options = {});

}  // namespace pirsim
