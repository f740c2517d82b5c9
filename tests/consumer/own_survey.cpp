// Coverage and a walk test from a program: how often each sensor saw the target, and how many points passed.
#include <pirsim/coverage.hpp>
#include <pirsim/io.hpp>

#include <cstdint>
#include <iostream>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    const pirsim::SceneSpec scene = pirsim::io::read_scene(argv[1]);
    pirsim::CoverageSpec spec = pirsim::io::read_coverage(argv[2]);
    spec.spacing_m = 0.5;
    const pirsim::CoverageMap map = pirsim::run_coverage(scene, spec);
    std::uint64_t windows = 0;
    for (const pirsim::MotionCount count : map.counts) windows += count;
    std::cout << map.grid.n_squares() << ' ' << windows << '\n';

    pirsim::WalkTestSpec walks;
    walks.spacing_m = 1.0;
    const pirsim::WalkTestResult result = pirsim::run_walk_test(scene, walks);
    int tried = 0;
    for (const pirsim::PointResult& point : result.points) tried += point.minor.made;
    std::cout << tried << ' ' << result.seats.size() << '\n';
  } catch (const pirsim::Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.code());
  }
}
