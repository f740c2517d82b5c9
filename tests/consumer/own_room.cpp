// A room, a sensor and a person made in memory: no file is read.
#include <pirsim/pirsim.hpp>

#include <iostream>

namespace {

/// Five metres by four, in its long wall a sensor that looks across the room with a grid of four by four zones.
pirsim::SceneSpec make_room() {
  using pirsim::Vec2;
  using pirsim::Vec3;
  pirsim::SceneSpec scene;
  scene.name = "own room";
  scene.floor = pirsim::FloorArea({{{0, 0}, {5, 0}, {5, 4}, {0, 4}}}, 0.0);
  scene.meshes.push_back({"wall", {{0, 0, 0}, {5, 0, 0}, {5, 2.5, 0}, {0, 2.5, 0}}, {{0, 1, 2}, {0, 2, 3}}});

  pirsim::SensorModelSpec model;
  model.id = "grid";
  for (int column = -2; column < 2; ++column) {
    pirsim::ClusterSpec& cluster = model.clusters.emplace_back();
    cluster.range_m = 8.0;
    for (int row = -2; row < 2; ++row) {
      const double x = 0.4 * column + 0.2, y = 0.2 * row + 0.1, half = 0.05;
      cluster.zones.push_back(
          {{Vec2(x - half, y - half), Vec2(x + half, y - half), Vec2(x + half, y + half), Vec2(x - half, y + half)},
           1});
    }
  }
  scene.sensor_models["grid"] = model;
  scene.sensors.push_back({"PIR", "grid", {pirsim::Quat(1, 0, 0, 0), Vec3(2.5, 1.2, 3.9)}});
  return scene;
}

pirsim::ScriptSpec make_script() {
  pirsim::PersonSpec walker;
  walker.id = "walker";
  const auto act = [&](pirsim::Action what) { walker.actions.push_back({std::move(what), {}, {}, {}}); };
  act(pirsim::action::Appear{{0.5, 2.0}, -90.0});
  act(pirsim::action::Walk{{{4.5, 2.0}, {0.5, 2.0}}});
  pirsim::ScriptSpec script;
  script.name = "own script";
  script.trials = {{"walk", {walker}}};
  return script;
}

}  // namespace

int main() {
  try {
    const pirsim::Model model = pirsim::compile(make_room(), make_script());
    pirsim::io::CsvWriter csv(std::cout, model.columns());
    pirsim::run_study(model, {}, [&](const pirsim::RunResult& run) {
      for (const pirsim::Sample& row : run.samples) csv.write(row);
    });
  } catch (const pirsim::Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.code());
  }
}
