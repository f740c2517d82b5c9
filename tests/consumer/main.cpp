// What a user of the installed library writes: read, compile, step, write rows.
#include <pirsim/pirsim.hpp>

#include <iostream>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    const pirsim::Model model = pirsim::compile(pirsim::io::read_scene(argv[1]), pirsim::io::read_script(argv[2]));
    pirsim::State state(model, /*run=*/7);
    pirsim::io::CsvWriter csv(std::cout, model.columns());
    while (pirsim::step(model, state)) csv.write(state.sample());
  } catch (const pirsim::Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.code());
  }
}
