// Pictures and films of a run for who asks by name and number.
#include <algorithm>
#include <sstream>

#include "core/range.hpp"
#include "core/text.hpp"
#include "io/pages/png.hpp"
#include "io/write/gltf_writer.hpp"
#include "pirsim/look.hpp"
#include "sim/compiled_study.hpp"
#include "sim/run_state.hpp"
#include "studies/look.hpp"
#include "studies/picture.hpp"
#include "studies/run_film.hpp"

namespace pirsim {
namespace studies {
namespace {

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

void require_run(const Model& model, std::uint32_t run) {
  if (run < model.n_runs()) return;
  throw Error(ErrorCode::usage, "run " + std::to_string(run) + ": the study has " + std::to_string(model.n_runs()) +
                                    " runs, numbered from 0");
}

void require(const char* what, double value, const NumberRange& range) {
  if (range.holds(value)) return;
  std::ostringstream got;
  got << what << ": expected " << range.text() << ", got " << value;
  throw Error(ErrorCode::usage, got.str());
}

std::vector<std::size_t> sensors_named(const Model& model, const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const SensorSpec& sensor : model.scene().sensors) known.push_back(sensor.id);
  std::vector<std::size_t> indices;
  for (const std::string& name : names) {
    if (name == "none") continue;
    bool found = name == "all";
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (name != "all" && name != known[i]) continue;
      indices.push_back(i);
      found = true;
    }
    if (!found)
      throw Error(ErrorCode::usage, "beams: sensor '" + name + "' is not in the scene" + near_or_all(name, known));
  }
  return indices;
}

}  // namespace studies

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
