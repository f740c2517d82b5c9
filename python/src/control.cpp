// Light that sensors switch.
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <pirsim/control.hpp>

#include "arrays.hpp"
#include "attend.hpp"
#include "bindings.hpp"

namespace pirsim::python {
namespace {

namespace nb = nanobind;
template <typename T, int n>
using Array = nb::ndarray<const T, nb::ndim<n>, nb::c_contig, nb::device::cpu>;

template <typename To, typename From>
void copy_row(const Array<From, 2>& from, std::size_t row, std::vector<To>& to) {
  const From* begin = from.data() + row * from.shape(1);
  to.assign(begin, begin + from.shape(1));
}

/// file, text: of the rule; the text counts where there is no file. Columns of rows, one after the other; clock:
/// local time at each row's end, since 1970. Returns the costs as CSV, the lights, (row, light) 1 where it is
/// lit, and remarks.
nb::tuple control_light(const std::string& file, const std::string& text, std::vector<std::string> sensors,
                        std::vector<std::string> areas, std::vector<std::string> doors, double window_s,
                        Array<std::int32_t, 1> run, Array<double, 1> time_s, const std::vector<std::string>& clock,
                        Array<std::int32_t, 1> people, Array<std::int32_t, 2> people_of_areas,
                        Array<std::uint8_t, 2> door_open, Array<std::uint8_t, 2> bits) {
  std::vector<std::uint8_t> lit;
  std::vector<std::string> lights, remarks;
  std::string costs;
  attend(nb::none(), [&](Job&) {
    const control::RuleSpec spec = file.empty() ? control::parse_rule(text, "rule") : control::read_rule(file);
    for (const control::LightSpec& light : spec.lights) lights.push_back(light.id);
    control::Control control(spec, {std::move(sensors), std::move(areas), std::move(doors)}, window_s);
    Sample row;
    for (std::size_t i = 0; i < bits.shape(0); ++i) {
      row.replicate = run(i);
      row.time_s = time_s(i);
      if (!clock.empty()) row.clock = clock[i];
      row.people = people(i);
      copy_row(people_of_areas, i, row.people_of_areas);
      copy_row(door_open, i, row.doors);
      copy_row(bits, i, row.bits);
      const control::LitRow now = control.add(row);
      lit.insert(lit.end(), now.lit.begin(), now.lit.end());
    }
    const control::Costs finished = control.finish();
    for (const Issue& remark : finished.remarks) remarks.push_back(remark.message);
    costs = control::to_csv(finished);
  });
  const std::size_t n_lights = lights.size();
  return nb::make_tuple(costs, lights, to_numpy(std::move(lit), {bits.shape(0), n_lights}), remarks);
}

}  // namespace

void add_control(nb::module_& module) {
  using namespace nb::literals;
  module.def(
      "control_light", &control_light, nb::kw_only(), "file"_a, "text"_a, "sensors"_a, "areas"_a, "doors"_a,
      "window_s"_a, "run"_a, "time_s"_a, "clock"_a, "people"_a, "people_of_areas"_a, "door_open"_a, "bits"_a,
      "(costs as CSV, lights, lit [row, light], remarks) of a rule's file or else its text, by columns of rows.");
}

}  // namespace pirsim::python
