// Pictures, pages, exports, checks and placements.
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
    sensors.append(nb::make_tuple(to_python(sight.sensor), sight.rays, sight.rays_cut, sight.longest_m, sight.places,
                                  nb::tuple(to_python(sight.seats)), nb::tuple(to_python(report.work.deaf_seats(i)))));
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
                    std::vector<std::string> sensors, std::vector<std::string> data, unsigned threads,
                    nb::handle progress) {
  const PlacementSpec spec = io::read_placements(script, overrides, folders_of(data));
  const Folders folders{std::move(sensors), std::move(data)};
  const SceneSpec room = scene_of(scene, folders);
  PlacementOptions options;
  options.threads = threads;
  options.scenes = options_of(folders);
  if (nb::isinstance<nb::str>(scene)) options.scene_file = nb::cast<std::string>(scene);
  PlacementReport report;
  attend(progress, [&](Job& job) {
    job.n_all = spec.search ? static_cast<std::size_t>(spec.search->evaluations) : 0;
    options.set_done = [&] { job.step_or_stop(); };
    report = run_placements(room, spec, options);
  });
  nb::list ranked;
  for (const PlacementScore& score : report.ranked) {
    nb::object light = nb::none();
    if (spec.light) {
      light =
          nb::make_tuple(score.light.occupied_h, score.light.false_offs, score.light.dark_h, score.light.lit_empty_h);
    }
    ranked.append(nb::make_tuple(to_python(score.set.id), to_python(score.set.sensors), score.seen_area_m2,
                                 score.blind_fraction, score.overlap, nb::tuple(to_python(score.blind_seats)),
                                 nb::tuple(to_python(score.at_work.noticed)), nb::tuple(to_python(score.at_work.deaf)),
                                 nb::tuple(to_python(score.at_work.unseen)), nb::tuple(to_python(score.at_work.surely)),
                                 light));
  }
  std::vector<Issue> told = room.warnings;
  told.insert(told.end(), report.warnings.begin(), report.warnings.end());
  nb::dict result;
  result["ranked"] = ranked;
  result["evaluations"] = report.search ? report.search->evaluations : 0;
  result["text"] = to_python(report.text);
  result["warnings"] = to_python(told);
  return result;
}

}  // namespace

void add_look(nb::module_& module) {
  module.def("picture", &picture, nb::arg("model"), nb::arg("run"), nb::arg("time_s").none(), nb::arg("beams"),
             nb::arg("marks"), nb::arg("camera").none(), nb::arg("look_at").none(), nb::arg("field_of_view_deg"),
             nb::arg("width"), nb::arg("height"), "The bytes of a PNG file, and the moment.");
  module.def("page", &page, nb::arg("model"), nb::arg("run"), nb::arg("from_s").none(), nb::arg("to_s").none(),
             nb::arg("keys_per_s"), nb::arg("coverage"), "Parts of pirsim.Page, by name.");
  module.def("export_run", &export_to, nb::arg("model"), nb::arg("file"), nb::arg("run"), nb::arg("beams"),
             nb::arg("keys_per_s"), "Seconds that were written.");
  module.def("check", &check_model, nb::arg("model"), "Parts of pirsim.Findings, by name.");
  module.def("placements", &placements, nb::arg("scene"), nb::arg("script"), nb::arg("overrides"), nb::arg("sensors"),
             nb::arg("data"), nb::arg("threads"), nb::arg("progress").none(), "Parts of pirsim.Placements, by name.");
}

}  // namespace pirsim::python
