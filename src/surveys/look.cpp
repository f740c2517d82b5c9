#include "surveys/look.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "engine/sim/compiled_study.hpp"
#include "engine/sim/observer.hpp"
#include "engine/sim/run_state.hpp"
#include "engine/sim/thermal_array.hpp"
#include "files/write/gltf_writer.hpp"
#include "model/core/range.hpp"
#include "model/core/text.hpp"
#include "model/geom/floor.hpp"
#include "pirsim/coverage.hpp"
#include "pirsim/look.hpp"
#include "pirsim/model.hpp"
#include "pirsim/response.hpp"
#include "pirsim/study.hpp"
#include "pirsim/version.hpp"
#include "show/png.hpp"
#include "show/run_page.hpp"
#include "surveys/picture.hpp"

namespace pirsim::studies {
namespace {

// What pictures, pages and films share.

/// Throws Error(usage).
void require_run(const Model& model, std::uint32_t run) {
  if (run < model.n_runs()) return;
  throw Error(ErrorCode::usage, "run " + std::to_string(run) + ": the study has " + std::to_string(model.n_runs()) +
                                    " runs, numbered from 0");
}

/// Throws Error(usage) that names the argument.
void require(const char* what, double value, const NumberRange& range) {
  if (range.holds(value)) return;
  std::ostringstream got;
  got << what << ": expected " << range.text() << ", got " << value;
  throw Error(ErrorCode::usage, got.str());
}

/// Resolves "all", "none" and sensor names to indices. Throws Error(usage).
std::vector<std::size_t> sensors_named(const Model& model, const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const SensorSpec& sensor : model.scene().sensors) known.push_back(sensor.id);
  const auto is_array = [&](const std::string& name) {
    return std::ranges::find(model.scene().arrays, name, &SensorSpec::id) != model.scene().arrays.end();
  };
  std::vector<std::size_t> indices;
  for (const std::string& name : names) {
    if (name == "none") continue;
    bool found = name == "all";
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (name != "all" && name != known[i]) continue;
      indices.push_back(i);
      found = true;
    }
    if (is_array(name))
      throw Error(ErrorCode::usage, "beams: '" + name +
                                        "' is a thermal array, which has no beams: `pirsim check` says " +
                                        "what it sees, --frames writes its frames");
    if (!found)
      throw Error(ErrorCode::usage, "beams: sensor '" + name + "' is not in the scene" + near_or_all(name, known));
  }
  return indices;
}

// Films.

io::ExportedPerson without_keys(const sim::Actor& actor) {
  io::ExportedPerson person{actor.person().spec.id, {}, {}};
  for (std::size_t i = 0; i < body::n_parts; ++i) {
    const auto part = static_cast<body::Part>(i);
    person.parts.push_back({person.id, std::string(body::name(part)), actor.person().humanoid.solids()[i], {}});
  }
  return person;
}

/// While away, a person's parts keep their last place (they are drawn at scale 0).
void add_key(const sim::Actor& actor, io::ExportedPerson& person) {
  person.present.push_back(actor.present() ? 1 : 0);
  const body::Posture posture = actor.present() ? actor.motion().posture() : body::Posture{};
  for (std::size_t i = 0; i < body::n_parts; ++i) {
    auto& keys = person.parts[i].world_from_part;
    keys.push_back(actor.present() || keys.empty() ? posture[i] : keys.back());
  }
}

io::ExportedBeams beams(const Model& model, const State& state, std::size_t sensor) {
  io::ExportedBeams result;
  result.sensor = model.scene().sensors[sensor].id;
  for (const sim::BeamSegment& beam : sim::beams_of(model, state, sensor))
    result.segments.emplace_back(beam.from, beam.to);
  return result;
}

std::vector<std::uint32_t> members(const ZoneSet& zones) {
  std::vector<std::uint32_t> result;
  for (std::size_t zone = 0; zone < zones.size(); ++zone) {
    if (zones.test(zone)) result.push_back(static_cast<std::uint32_t>(zone));
  }
  return result;
}

/// Between two keys: of each sensor's signal, what is farthest from its rest.
class Peaks {
 public:
  explicit Peaks(std::size_t n_sensors) : peaks_(n_sensors, 0.0) {}

  void look(const State& state) {
    const auto& signals = state.run_state().detector.analog();
    for (std::size_t i = 0; i < signals.size(); ++i) {
      if (signals[i] && std::abs(signals[i]->volts) >= std::abs(peaks_[i])) peaks_[i] = signals[i]->volts;
    }
  }
  void take(const State& state, std::vector<std::vector<double>>& signals_v) {
    const auto& signals = state.run_state().detector.analog();
    for (std::size_t i = 0; i < signals.size(); ++i) {
      if (signals[i]) signals_v[i].push_back(peaks_[i]);
      peaks_[i] = 0.0;
    }
  }

 private:
  std::vector<double> peaks_;
};

/// What arrays have read last.
class FilmCameras {
 public:
  FilmCameras(const Model& model, std::uint32_t run) {
    for (const auto& array : model.compiled().arrays()) cameras_.emplace_back(*array, model.compiled().tracer(), run);
    n_read_.resize(cameras_.size());
  }

  void look(const State& state) {
    for (sim::Camera& camera : cameras_) camera.look(state.run_state());
  }
  void take(std::vector<FilmFrames>& frames) {
    frames.resize(cameras_.size());
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      const FrameStack& stack = cameras_[i].frames();
      if (frames[i].celsius.empty() || stack.times_s.size() != n_read_[i])
        frames[i].celsius.emplace_back(cameras_[i].last().begin(), cameras_[i].last().end());
      n_read_[i] = stack.times_s.size();
      frames[i].rows = stack.rows, frames[i].columns = stack.columns;
      frames[i].at_key.push_back(static_cast<std::uint32_t>(frames[i].celsius.size() - 1));
    }
  }

 private:
  std::vector<sim::Camera> cameras_;
  std::vector<std::size_t> n_read_;  ///< (n_arrays) at the last key
};

// The page that plays a run.

/// Of a longer run a page shows a part, unless its user asks for more: it would be large and take long to load.
constexpr double longest_unasked_s = 1200.0;

struct ShownPart {
  double from_s = 0.0, to_s = 0.0;
  double run_s = 0.0;  ///< of the whole run
};

int bits_set(const Sample& row) { return std::accumulate(row.bits.begin(), row.bits.end(), 0); }

/// That in which sensors see motion most often, the earliest of equals.
ShownPart busiest(const std::vector<Sample>& rows, double window_s) {
  const auto length = std::clamp<std::size_t>(static_cast<std::size_t>(longest_unasked_s / window_s), 1, rows.size());
  int motion = 0, most = -1;
  std::size_t best_end = length;
  for (std::size_t end = 1; end <= rows.size(); ++end) {
    motion += bits_set(rows[end - 1]);
    if (end > length) motion -= bits_set(rows[end - 1 - length]);
    if (end >= length && motion > most) {
      most = motion;
      best_end = end;
    }
  }
  return {rows[best_end - length].time_s - window_s, rows[best_end - 1].time_s};
}

bool wants_busiest(const PageRequest& request, double end_s) {
  return !request.from_s && !request.to_s && end_s > longest_unasked_s;
}

/// When the run ends, where that is known before it is simulated: at the end of a window.
std::optional<double> known_end_s(const Model& model, std::uint32_t run) {
  const auto& duration_s = model.compiled().trial_of(run).duration_s;
  if (!duration_s) return std::nullopt;
  const SensingInForce& sensing = model.compiled().sensing();
  const auto end_of = [&](std::int64_t window) {
    return static_cast<double>(window * sensing.ticks_per_window) / sensing.tick_rate_hz;
  };
  auto window = std::max<std::int64_t>(1, std::llround(std::floor(*duration_s / end_of(1))) - 1);
  while (end_of(window) < *duration_s) ++window;
  return end_of(window);
}

ShownPart chosen_stretch(const PageRequest& request, const std::optional<RunClock>& clock, double end_s,
                         double window_s) {
  ShownPart stretch{request.from_s.value_or(0.0), end_s};
  if (request.to_s) {
    stretch.to_s = std::min(end_s, *request.to_s);
    if (!request.from_s) stretch.from_s = std::max(0.0, stretch.to_s - longest_unasked_s);
  } else {
    stretch.to_s = std::min(end_s, stretch.from_s + longest_unasked_s);
  }
  if (!(stretch.from_s >= 0.0 && stretch.from_s < end_s))
    throw Error(ErrorCode::usage, "from: the run lasts from " + span_text(clock, 0.0, end_s));
  if (!(stretch.to_s > stretch.from_s)) {
    throw Error(ErrorCode::usage, "to: the page would begin at " + moment_text(clock, stretch.from_s) + " and end at " +
                                      moment_text(clock, stretch.to_s));
  }
  // Whole windows, so that rows and pictures begin together.
  stretch.from_s = std::floor(stretch.from_s / window_s + 1e-9) * window_s;
  stretch.to_s = std::min(end_s, std::ceil(stretch.to_s / window_s - 1e-9) * window_s);
  return stretch;
}

std::vector<io::PageSensor> page_sensors(const Model& model, Film& film) {
  const sim::CompiledStudy& study = model.compiled();
  const RayBundle& rays = model.rays();
  std::vector<io::PageSensor> result;
  for (std::size_t i = 0; i < rays.n_sensors(); ++i) {
    const SensorSpec& spec = study.scene().sensors[i];
    io::PageSensor& sensor = result.emplace_back();
    sensor.id = spec.id;
    sensor.model = spec.model;
    sensor.world_from_sensor = spec.world_from_sensor;
    sensor.first_zone = rays.cluster_zones_begin[rays.sensor_clusters_begin[i]];
    for (auto zone = sensor.first_zone; zone < rays.cluster_zones_begin[rays.sensor_clusters_begin[i + 1]]; ++zone)
      sensor.zone_rays.push_back(rays.zone_rays_begin[zone + 1] - rays.zone_rays_begin[zone]);
    sensor.signal_v = std::move(film.signals_v[i]);
    if (sensor.signal_v.empty()) continue;
    const ComparatorSpec& comparator = study.scene().sensor_models.at(spec.model).detector.comparator;
    sensor.positive_v = comparator.positive_v;
    sensor.negative_v = comparator.negative_v;
  }
  return result;
}

void drop_absent_people(io::ExportedRun& run) {
  std::erase_if(run.people, [](const io::ExportedPerson& person) {
    return std::ranges::none_of(person.present, [](std::uint8_t present) { return present != 0; });
  });
}

/// Where each of the room's sensors sees the study's target.
io::PageMap page_map(const SceneSpec& scene, const CoverageSpec& spec) {
  const CoverageMap map = run_coverage(scene, spec);
  const FloorGrid& grid = map.grid;
  io::PageMap page{spec.name,
                   grid.centre(0, 0) - 0.5 * Vec2(grid.spacing_m()),
                   scene.floor.height_m(),
                   grid.spacing_m(),
                   grid.n_columns(),
                   grid.n_rows(),
                   {}};
  for (std::size_t sensor = 0; sensor < map.sensors.size(); ++sensor) {
    std::vector<double>& shares = page.shares.emplace_back();
    for (std::size_t row = 0; row < grid.n_rows(); ++row) {
      for (std::size_t column = 0; column < grid.n_columns(); ++column) {
        const double share = static_cast<double>(map.count(column, row, sensor)) / map.n_windows;
        shares.push_back(grid.on_floor(column, row) ? share : -1.0);
      }
    }
  }
  return page;
}

io::RunPage run_page(const Model& model, const PageRequest& request, const ShownPart& stretch) {
  std::vector<std::size_t> all_sensors(model.scene().sensors.size());
  std::iota(all_sensors.begin(), all_sensors.end(), 0);
  Film film =
      studies::film(model, request.run,
                    {stretch.from_s, stretch.to_s, request.keys_per_s, std::move(all_sensors), request.simulated});
  const auto or_else = [](const std::string& given, const std::string& own) { return given.empty() ? own : given; };
  io::RunPage page;
  page.title = model.script().name + ", " + model.trial_of(request.run);
  page.about = "trial " + model.trial_of(request.run) + ", replicate " +
               std::to_string(model.replicate_of(request.run)) + ", " + or_else(request.scene, model.scene().name) +
               ", " + or_else(request.script, model.script().name) +
               ", response of the sensors: " + responses_in_words(model.scene(), model.script().sensing);
  const TrialSpec& trial = model.script().trials[request.run % model.script().trials.size()];
  if (!trial.schedule && !trial.occupancy && !trial.people.empty()) page.first_person = trial.people.front().id;
  page.made_by = program();
  page.sensors = page_sensors(model, film);
  page.run = std::move(film.run);
  page.rows = std::move(film.rows);
  drop_absent_people(page.run);
  page.active_zones = std::move(film.active_zones);
  for (std::size_t i = 0; i < film.frames.size(); ++i) {
    const SensorSpec& array = model.compiled().scene().arrays[i];
    FilmFrames& frames = film.frames[i];
    page.arrays.push_back({array.id, array.model, array.world_from_sensor, frames.rows, frames.columns,
                           std::move(frames.celsius), std::move(frames.at_key)});
  }
  for (const SeatSpec& seat : model.compiled().scene().seats)
    page.seats.push_back({seat.id, seat.world_from_seat.origin});
  for (const EntranceSpec& door : model.compiled().scene().entrances)
    page.doors.push_back({door.id, door.world_from_entrance.origin});
  for (const AreaSpec& area : model.compiled().scene().areas) {
    const Vec2 middle = roomiest_point(area.outline);
    const double floor_y = model.compiled().scene().floor.height_m();
    page.areas.push_back({area.id, Vec3(middle.x, floor_y, middle.y), area.outline.loops()});
  }
  page.counted = model.areas();
  return page;
}

std::vector<Sample> rows_of(const Model& model, const PageRequest& request) {
  const double window_s = model.tick_s() * model.compiled().sensing().ticks_per_window;
  StudyOptions study;
  study.threads = 1;
  study.runs = RunRange{request.run, request.run + 1};
  if (request.simulated) study.window_done = [&] { request.simulated(window_s); };
  std::vector<Sample> rows;
  run_study(model, study, [&](const RunResult& result) {
    if (result.fault) throw Error(ErrorCode::infeasible, result.fault->message);
    rows = result.samples;
  });
  return rows;
}

/// A whole run is simulated beforehand only where that tells what to show.
ShownPart find_stretch(const Model& model, const PageRequest& request, double window_s) {
  const std::optional<double> known_s = known_end_s(model, request.run);
  std::vector<Sample> rows;
  if (!known_s || wants_busiest(request, *known_s)) rows = rows_of(model, request);
  const double end_s = known_s ? *known_s : rows.back().time_s;
  ShownPart stretch = wants_busiest(request, end_s)
                          ? busiest(rows, window_s)
                          : chosen_stretch(request, model.compiled().clock_of(request.run), end_s, window_s);
  stretch.run_s = end_s;
  return stretch;
}

// Pictures.

double time_s(const Model& model, const State& state) { return static_cast<double>(state.tick()) * model.tick_s(); }

bool reached_default_time(const State& state, std::int64_t& work_began, const Model& model) {
  constexpr double into_work_s = 10.0;
  const sim::Crowd& crowd = state.run_state().crowd;
  if (work_began < 0 && !crowd.actors().empty() && crowd.actors().front().phase() == "working")
    work_began = state.tick();
  return work_began >= 0 && static_cast<double>(state.tick() - work_began) * model.tick_s() >= into_work_s;
}

State state_at(const Model& model, std::uint32_t run, const std::optional<double>& asked_s,
               const Simulated& simulated) {
  require_run(model, run);
  State state(model, run);
  std::int64_t work_began = -1;
  while (!state.finished()) {
    if (asked_s ? time_s(model, state) >= *asked_s : reached_default_time(state, work_began, model)) break;
    if (step_tick(model, state) && simulated) simulated(model.tick_s() * model.compiled().sensing().ticks_per_window);
  }
  // Where somebody asks for a moment that never comes, a picture of another one would mislead.
  if (asked_s && !(*asked_s >= 0.0 && time_s(model, state) >= *asked_s)) {
    const std::optional<RunClock> clock = model.compiled().clock_of(run);
    throw Error(ErrorCode::usage, "time: " + moment_text(clock, *asked_s) + " isn't in the run: trial " +
                                      model.trial_of(run) + " lasts from " +
                                      span_text(clock, 0.0, time_s(model, state)));
  }
  return state;
}

std::vector<Mark> marks_named(const std::vector<std::string>& words) {
  std::vector<std::string> known{"all", "none"};
  for (const Mark mark : all_marks) known.emplace_back(name(mark));
  for (const std::string& word : words) {
    if (std::ranges::find(known, word) == known.end())
      throw Error(ErrorCode::usage, "marks: '" + word + "' can't be marked" + near_or_all(word, known));
  }
  std::vector<Mark> marks;
  const bool all = std::ranges::find(words, "all") != words.end();
  for (const Mark mark : all_marks) {
    if (all || std::ranges::find(words, name(mark)) != words.end()) marks.push_back(mark);
  }
  return marks;
}

}  // namespace

double expected_bytes(std::size_t n_people, double seconds, double keys_per_s) {
  // As the glTF has them: a time; of each person a scale, of each part a place and a rotation, in single precision.
  constexpr double time_bytes = 4.0, person_bytes = 12.0, part_bytes = 12.0 + 16.0;
  return seconds * keys_per_s *
         (time_bytes + static_cast<double>(n_people) * (person_bytes + body::n_parts * part_bytes));
}

Film film(const Model& model, std::uint32_t run, const FilmSpec& spec) {
  const SensingInForce& sensing = model.compiled().sensing();
  const int rate = sensing.tick_rate_hz;
  const auto ticks_per_key = std::max<std::int64_t>(1, std::llround(rate / spec.keys_per_s));
  const double window_s = model.tick_s() * sensing.ticks_per_window;
  const auto time_s = [&](const State& state) { return static_cast<double>(state.tick()) / rate; };

  State state(model, run);
  Film result;
  result.run.title = model.script().name + ", trial " + model.trial_of(run);
  result.run.meshes = model.compiled().scene().meshes;
  for (const std::size_t sensor : spec.beams_of) result.run.beams.push_back(beams(model, state, sensor));
  const auto end_window = [&] {
    if (spec.simulated) spec.simulated(window_s);
  };
  while (!state.finished() && time_s(state) + window_s <= spec.from_s) {
    // As in a run without a film, what nobody is in is passed over.
    if (!sim::pass_empty_window(model.compiled(), state.run_state())) step(model, state);
    end_window();
  }

  const std::vector<sim::Actor>& actors = state.run_state().crowd.actors();
  for (const sim::Actor& actor : actors) {
    result.run.people.push_back(without_keys(actor));
    result.run.people.back().number = result.run.people.size() - 1;
  }
  const std::vector<DoorLeaf>& leaves = model.compiled().array().leaves();
  for (std::size_t i = 0; i < leaves.size(); ++i)
    result.run.leaves.push_back({model.scene().doors[i].id, leaves[i].box(), {}});
  result.signals_v.resize(model.scene().sensors.size());
  Peaks peaks(result.signals_v.size());
  FilmCameras cameras(model, run);
  const std::int64_t first_tick = state.tick();
  while (true) {
    peaks.look(state);
    cameras.look(state);
    const bool ends = state.finished() || time_s(state) >= spec.to_s;
    if ((state.tick() - first_tick) % ticks_per_key == 0 || ends) {
      result.run.key_times_s.push_back(time_s(state));
      for (std::size_t i = 0; i < actors.size(); ++i) add_key(actors[i], result.run.people[i]);
      for (std::size_t i = 0; i < leaves.size(); ++i)
        result.run.leaves[i].world_from_leaf.push_back(leaves[i].frame_at(state.run_state().crowd.doors().steps()[i]));
      result.active_zones.push_back(members(state.zones()));
      peaks.take(state, result.signals_v);
      cameras.take(result.frames);
    }
    if (ends) return result;
    if (!step_tick(model, state)) continue;
    result.rows.push_back(state.sample());
    end_window();
  }
}

}  // namespace pirsim::studies

namespace pirsim {

Page page_of(const Model& model, const PageRequest& request) {
  using namespace studies;
  require_run(model, request.run);
  require("keys_per_s", request.keys_per_s, {.min = 0.1, .max = 100.0});
  const double window_s = model.tick_s() * model.compiled().sensing().ticks_per_window;
  const ShownPart stretch = find_stretch(model, request, window_s);
  io::RunPage page = run_page(model, request, stretch);
  page.run_s = stretch.run_s;
  page.window_s = window_s;
  if (request.coverage) page.map = page_map(model.compiled().scene(), *request.coverage);
  std::ostringstream text;
  io::write_run_page(text, page);
  const auto& keys = page.run.key_times_s;
  const bool is_busiest_part = page.run_s > longest_unasked_s && !request.from_s && !request.to_s;
  return {std::move(text).str(), page.about, keys.front(), keys.back(), page.run_s, is_busiest_part};
}

Picture picture_of(const Model& model, const PictureRequest& request) {
  studies::require("field_of_view_deg", request.field_of_view_deg, {.min = 1.0, .max = 170.0});
  studies::require("width", request.width, {.min = 16, .max = 7680});
  studies::require("height", request.height, {.min = 16, .max = 4320});
  std::vector<std::string> beams = request.beams;
  if (beams.empty() && !model.scene().sensors.empty()) beams.push_back(model.scene().sensors.front().id);
  const studies::PictureSpec spec{studies::sensors_named(model, beams),
                                  studies::marks_named(request.marks),
                                  request.camera,
                                  request.look_at,
                                  request.field_of_view_deg,
                                  request.width,
                                  request.height};
  const State state = studies::state_at(model, request.run, request.time_s, request.simulated);
  const io::Pixels image = studies::picture(model, state, spec);
  return {io::to_png(image.width, image.height, image.rgb), studies::time_s(model, state)};
}

double export_run(const std::filesystem::path& file, const Model& model, const FilmRequest& request) {
  studies::require("keys_per_s", request.keys_per_s, {.min = 0.001, .max = 10000.0});
  studies::require_run(model, request.run);
  const std::optional<RunClock> clock = model.compiled().clock_of(request.run);
  studies::FilmSpec spec{.keys_per_s = request.keys_per_s,
                         .beams_of = studies::sensors_named(model, request.beams),
                         .simulated = request.simulated};
  spec.from_s = request.from_s.value_or(spec.from_s);
  spec.to_s = request.to_s.value_or(spec.to_s);
  if (!(spec.to_s > spec.from_s)) {
    throw Error(ErrorCode::usage, "to: the film would begin at " + moment_text(clock, spec.from_s) + " and end at " +
                                      moment_text(clock, spec.to_s));
  }
  io::ExportedRun film = studies::film(model, request.run, spec).run;
  const double end_s = film.key_times_s.back(), begin_s = film.key_times_s.front();
  if (request.from_s && !(spec.from_s >= 0.0 && spec.from_s < end_s))
    throw Error(ErrorCode::usage, "from: the run lasts from " + span_text(clock, 0.0, end_s));
  for (double& time_s : film.key_times_s) time_s -= begin_s;
  io::write_gltf(file, film);
  return end_s - begin_s;
}

}  // namespace pirsim
