// What a person's tick costs on floors of all sizes, as CSV: an office of as many desks as people and half as many
// sensors under the ceiling, for three hours in the first of which people come. docs/performance.md has the table.
//   pirsim_large_floor PEOPLE...
#include <algorithm>
#include <cmath>
#include <ctime>
#include <iostream>
#include <string>

#include "pirsim/pirsim.hpp"
#include "support/paths.hpp"
#include "support/random_scene.hpp"

namespace {

using namespace pirsim;
using pirsim::testing::box_mesh;

constexpr double height_m = 2.8, bay_x_m = 2.4, bay_z_m = 2.6, edge_m = 2.0;

struct Size {
  double width_m, depth_m;
  int columns;
};

Size size_of(int n_people) {
  const int columns = int(std::ceil(std::sqrt(2.0 * n_people))), rows = (n_people + columns - 1) / columns;
  return {columns * bay_x_m + edge_m, rows * bay_z_m + edge_m, columns};
}

void add_shell(SceneSpec& scene, const Size& size) {
  const auto& [w, d, columns] = size;
  const double t = 0.1, h = height_m;
  scene.meshes = {box_mesh({0, -t, -d}, {w, 0, 0}),          box_mesh({0, h, -d}, {w, h + t, 0}),
                  box_mesh({-t, 0, -d}, {0, h, 0}),          box_mesh({w, 0, -d}, {w + t, h, 0}),
                  box_mesh({0, 0, -d - t}, {w, h, -d}),      box_mesh({0, 0, 0}, {0.5 * w - 1.0, h, t}),
                  box_mesh({0.5 * w + 1.0, 0, 0}, {w, h, t})};
  scene.floor = FloorArea({{{0, 0}, {w, 0}, {w, -d}, {0, -d}}}, 0.0);
  scene.entrances.push_back({"door", {{1, 0, 0, 0}, {0.5 * w, 0, 0}}});
}

SceneSpec office(int n_people) {
  SceneSpec scene;
  scene.name = "office";
  const Size size = size_of(n_people);
  add_shell(scene, size);
  for (int i = 0; i < n_people; ++i) {
    const double x = 1.4 + (i % size.columns) * bay_x_m, z = -(2.0 + (i / size.columns) * bay_z_m);
    scene.meshes.push_back(box_mesh({x, 0.70, z - 0.8}, {x + 1.6, 0.74, z}));
    scene.seats.push_back({"S" + std::to_string(i + 1), {{1, 0, 0, 0}, {x + 0.8, 0.53, z + 0.16}}});
  }
  const std::string make = "EKMC1604111";
  scene.sensor_models.emplace(make, io::read_sensor_model(test::data_dir() / "sensors" / (make + ".yaml")));
  const int n_sensors = n_people / 2 + 2;
  const int columns = std::max(1, int(std::lround(std::sqrt(n_sensors * size.width_m / size.depth_m))));
  const int rows = (n_sensors + columns - 1) / columns;
  const Quat down = glm::angleAxis(-0.5 * pi, Vec3(1, 0, 0));
  for (int i = 0; i < n_sensors; ++i) {
    const Vec3 place(size.width_m * (i % columns + 0.5) / columns, height_m - 0.02,
                     -size.depth_m * (i / columns + 0.5) / rows);
    scene.sensors.push_back({"PIR" + std::to_string(i + 1), make, {down, place}});
  }
  return scene;
}

ScriptSpec morning(int n_people) {
  ScriptSpec script;
  script.replicates = 1;
  script.sensing.response = Response::zones;
  ScheduleSpec schedule;
  schedule.from_h = 8.0;
  schedule.to_h = 11.0;
  schedule.arrival = {8.5, 15.0};
  constexpr int most_in_a_group = 100;
  for (int left = n_people; left > 0; left -= most_in_a_group) {
    schedule.staff.emplace_back().count = std::min(left, most_in_a_group);
  }
  TrialSpec trial;
  trial.id = "morning";
  trial.schedule = schedule;
  script.trials.push_back(trial);
  return script;
}

double cpu_s() { return double(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

int main(int argc, char** argv) {
  std::cout << "people,compile_s,first_hour_us,three_hours_us\n";
  for (int i = 1; i < argc; ++i) {
    const int n_people = std::stoi(argv[i]);
    const double began_s = cpu_s();
    const Model model = compile(office(n_people), morning(n_people));
    const double compiled_s = cpu_s();
    State state(model, 0);
    double person_ticks = 0.0, first_hour_us = 0.0;
    const auto cost_us = [&] { return 1e6 * (cpu_s() - compiled_s) / person_ticks; };
    while (step(model, state)) {
      person_ticks += 50.0 * state.sample().people;
      if (state.sample().time_s == 3600.0) first_hour_us = cost_us();
    }
    std::cout << n_people << ',' << compiled_s - began_s << ',' << first_hour_us << ',' << cost_us() << std::endl;
  }
}
