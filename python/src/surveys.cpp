// Looking at a study: pictures, pages, exports, checks; coverage studies, walk tests and placements.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <pirsim/look.hpp>

#include "attend.hpp"
#include "bindings.hpp"
#include "convert.hpp"

namespace pirsim::python {
namespace {

/// What a picture shows, as pirsim.preview() is asked for it.
nb::tuple picture(const Model& model, std::uint32_t run, std::optional<double> time_s, std::vector<std::string> beams,
                  std::vector<std::string> marks, nb::handle camera, nb::handle look_at, double field_of_view_deg,
                  int width, int height) {
  const PictureRequest request{run,
                               time_s,
                               std::move(beams),
                               std::move(marks),
                               from_python<std::optional<Vec3>>(camera, "camera"),
                               from_python<std::optional<Vec3>>(look_at, "look_at"),
                               field_of_view_deg,
                               width,
                               height};
  Picture made;
  attend(nb::none(), [&](Job&) { made = picture_of(model, request); });
  return nb::make_tuple(nb::bytes(made.png.data(), made.png.size()), made.time_s);
}

nb::dict page(const Model& model, std::uint32_t run, std::optional<double> from_s, std::optional<double> to_s,
              double keys_per_s, const std::string& coverage) {
  PageRequest request;
  request.run = run;
  request.from_s = from_s;
  request.to_s = to_s;
  request.keys_per_s = keys_per_s;
  if (!coverage.empty()) request.coverage = io::read_coverage(coverage);
  Page made;
  attend(nb::none(), [&](Job&) { made = page_of(model, request); });
  nb::dict result;
  result["html"] = to_python(made.html);
  result["about"] = to_python(made.about);
  result["from_s"] = made.from_s;
  result["to_s"] = made.to_s;
  result["run_s"] = made.run_s;
  return result;
}

double export_to(const Model& model, const std::string& file, std::uint32_t run, const std::vector<std::string>& beams,
                 double keys_per_s) {
  for (const auto* read : {&model.scene().files, &model.script().files}) {
    for (const InputFile& input : *read) {
      std::error_code unknown;
      if (std::filesystem::equivalent(file, input.path, unknown))
        throw Error(ErrorCode::usage, "file: '" + file + "' is one that the model was read from");
    }
  }
  double length_s = 0.0;
  attend(nb::none(), [&](Job&) { length_s = export_run(file, model, {run, beams, keys_per_s, {}, {}}); });
  return length_s;
}

nb::dict check_model(const Model& model) {
  CheckReport report;
  attend(nb::none(), [&](Job&) { report = check_study(model); });
  nb::list sensors;
  for (std::size_t i = 0; i < report.sight.sensors.size(); ++i) {
    const SensorSight& sight = report.sight.sensors[i];
    sensors.append(nb::make_tuple(
        to_python(sight.sensor), sight.rays, sight.rays_cut, sight.longest_m, sight.places,
        nb::tuple(to_python(sight.seats)),
        i < model.scene().sensors.size() ? nb::tuple(to_python(report.work.deaf_seats(i))) : nb::tuple()));
  }
  nb::dict result;
  result["sensors"] = sensors;
  result["places"] = report.sight.places;
  result["places_seen_by_any"] = report.sight.places_seen_by_any;
  result["text"] = to_python(report.text);
  result["warnings"] = to_python(report.warnings);
  return result;
}

nb::dict placements(nb::handle scene, const std::string& script, const std::vector<std::string>& overrides,
                    const Folders& folders, unsigned threads, nb::handle progress) {
  const PlacementSpec spec = io::read_placements(script, overrides, folders.data_directories);
  const SceneSpec room = scene_of(scene, folders);
  PlacementOptions options;
  options.threads = threads;
  options.scenes = folders;
  if (nb::isinstance<nb::str>(scene)) options.scene_file = nb::cast<std::string>(scene);
  PlacementReport report;
  attend(progress, [&](Job& job) {
    job.n_all = spec.search ? static_cast<std::size_t>(spec.search->evaluations) : 0;
    options.set_done = [&] { job.step_or_stop(); };
    report = run_placements(room, spec, options);
  });
  std::vector<Issue> told = room.warnings;
  told.insert(told.end(), report.warnings.begin(), report.warnings.end());
  nb::dict result;
  result["ranked"] = listed(report.ranked, [&](const PlacementScore& score) {
    const auto& light = score.light;
    return nb::make_tuple(
        to_python(score.set.id), to_python(score.set.sensors), score.seen_area_m2, score.blind_fraction, score.overlap,
        nb::tuple(to_python(score.blind_seats)), nb::tuple(to_python(score.at_work.noticed)),
        nb::tuple(to_python(score.at_work.deaf)), nb::tuple(to_python(score.at_work.unseen)),
        nb::tuple(to_python(score.at_work.surely)),
        spec.light ? nb::object(nb::make_tuple(light.occupied_h, light.false_offs, light.dark_h, light.lit_empty_h))
                   : nb::none());
  });
  result["evaluations"] = report.search ? report.search->evaluations : 0;
  result["text"] = to_python(report.text);
  result["warnings"] = to_python(told);
  return result;
}

/// Places of columns and rows, and which squares are on the floor.
void add_grid(const FloorGrid& grid, nb::dict& map) {
  std::vector<double> x, z;
  std::vector<std::uint8_t> on_floor;
  for (std::size_t column = 0; column < grid.n_columns(); ++column) x.push_back(grid.centre(column, 0).x);
  for (std::size_t row = 0; row < grid.n_rows(); ++row) {
    z.push_back(grid.centre(0, row).y);
    for (std::size_t column = 0; column < grid.n_columns(); ++column) {
      on_floor.push_back(grid.on_floor(column, row) ? 1 : 0);
    }
  }
  map["spacing_m"] = nb::float_(grid.spacing_m());
  map["x"] = to_numpy(std::move(x), {grid.n_columns()});
  map["z"] = to_numpy(std::move(z), {grid.n_rows()});
  map["on_floor"] = to_numpy_as<bool>(std::move(on_floor), {grid.n_rows(), grid.n_columns()});
}

template <typename Survey>
auto surveyed(nb::handle progress, const Survey& survey) {
  decltype(survey(RowDone{})) result;
  attend(progress, [&](Job& job) {
    result = survey([&](std::size_t, std::size_t n_rows) {
      job.n_all = n_rows;
      job.step_or_stop();
    });
  });
  return result;
}

nb::dict coverage(nb::handle scene, const std::string& script, const std::vector<std::string>& overrides,
                  const Folders& folders, unsigned threads, nb::handle progress) {
  const CoverageSpec spec = io::read_coverage(script, overrides);
  const SceneSpec room = scene_of(scene, folders);
  CoverageMap map =
      surveyed(progress, [&](const RowDone& row_done) { return run_coverage(room, spec, threads, row_done); });
  nb::dict result;
  result["warnings"] = to_python(room.warnings);
  add_grid(map.grid, result);
  result["sensors"] = nb::tuple(to_python(map.sensors));
  result["n_windows"] = nb::int_(map.n_windows);
  result["counts"] = to_numpy(std::move(map.counts), {map.grid.n_rows(), map.grid.n_columns(), map.sensors.size()});
  return result;
}

nb::object column_of(const WalkTestResult& test, Tries PointResult::*motion, int Tries::*number) {
  std::vector<std::int32_t> values;
  for (const PointResult& point : test.points) values.push_back(point.*motion.*number);
  return to_numpy(std::move(values), {test.grid.n_rows(), test.grid.n_columns()});
}

nb::dict walk_test(nb::handle scene, const std::string& script, const std::vector<std::string>& overrides,
                   const Folders& folders, unsigned threads, nb::handle progress) {
  const WalkTestSpec spec = io::read_walk_test(script, overrides);
  const SceneSpec room = scene_of(scene, folders);
  const WalkTestResult test =
      surveyed(progress, [&](const RowDone& row_done) { return run_walk_test(room, spec, threads, row_done); });
  nb::dict result, seats;
  result["warnings"] = to_python(room.warnings);
  add_grid(test.grid, result);
  result["major_made"] = column_of(test, &PointResult::major, &Tries::made);
  result["major_noticed"] = column_of(test, &PointResult::major, &Tries::noticed);
  result["minor_made"] = column_of(test, &PointResult::minor, &Tries::made);
  result["minor_noticed"] = column_of(test, &PointResult::minor, &Tries::noticed);
  result["minor_deaf"] = column_of(test, &PointResult::minor, &Tries::deaf);
  for (const SeatResult& seat : test.seats) seats[to_python(seat.seat)] = nb::bool_(seat.noticed);
  result["seats"] = seats;
  return result;
}

}  // namespace

void add_surveys(nb::module_& module) {
  module.def("picture", &picture, "model"_a, "run"_a, "time_s"_a.none(), "beams"_a, "marks"_a, "camera"_a.none(),
             "look_at"_a.none(), "field_of_view_deg"_a, "width"_a, "height"_a,
             "The bytes of a PNG file, and the moment.");
  module.def("page", &page, "model"_a, "run"_a, "from_s"_a.none(), "to_s"_a.none(), "keys_per_s"_a, "coverage"_a,
             "Parts of pirsim.Page, by name.");
  module.def("export_run", &export_to, "model"_a, "file"_a, "run"_a, "beams"_a, "keys_per_s"_a,
             "Seconds that were written.");
  module.def("check", &check_model, "model"_a, "Parts of pirsim.Findings, by name.");
  module.def("placements", &placements, "scene"_a, "script"_a, "overrides"_a, "folders"_a, "threads"_a,
             "progress"_a.none(), "Parts of pirsim.Placements, by name.");
  module.def("coverage", &coverage, "scene"_a, "script"_a, "overrides"_a, "folders"_a, "threads"_a, "progress"_a.none(),
             "Arrays of pirsim.CoverageMap, by name.");
  module.def("walk_test", &walk_test, "scene"_a, "script"_a, "overrides"_a, "folders"_a, "threads"_a,
             "progress"_a.none(), "Arrays of pirsim.WalkTest, by name.");
}

}  // namespace pirsim::python
