// Coverage studies and walk tests.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "attend.hpp"
#include "bindings.hpp"
#include "convert.hpp"

namespace pirsim::python {
namespace {

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
                  std::vector<std::string> sensors, std::vector<std::string> data, unsigned threads,
                  nb::handle progress) {
  const CoverageSpec spec = io::read_coverage(script, overrides);
  const SceneSpec room = scene_of(scene, {std::move(sensors), std::move(data)});
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
                   std::vector<std::string> sensors, std::vector<std::string> data, unsigned threads,
                   nb::handle progress) {
  const WalkTestSpec spec = io::read_walk_test(script, overrides);
  const SceneSpec room = scene_of(scene, {std::move(sensors), std::move(data)});
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
  module.def("coverage", &coverage, nb::arg("scene"), nb::arg("script"), nb::arg("overrides"), nb::arg("sensors"),
             nb::arg("data"), nb::arg("threads"), nb::arg("progress").none(), "Arrays of pirsim.CoverageMap, by name.");
  module.def("walk_test", &walk_test, nb::arg("scene"), nb::arg("script"), nb::arg("overrides"), nb::arg("sensors"),
             nb::arg("data"), nb::arg("threads"), nb::arg("progress").none(), "Arrays of pirsim.WalkTest, by name.");
}

}  // namespace pirsim::python
