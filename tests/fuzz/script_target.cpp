// Scripts of studies. What is accepted is written back as a script that is accepted and written the same.
#include "fuzz_target.hpp"
#include "pirsim/io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pirsim::test::read_as_file(data, size, ".yaml", [](const std::filesystem::path& file) {
    const pirsim::ScriptSpec script = pirsim::io::read_script(file);
    const std::string resolved = pirsim::io::to_yaml(script);
    std::ofstream(file, std::ios::binary | std::ios::trunc) << resolved;
    try {
      if (pirsim::io::to_yaml(pirsim::io::read_script(file)) != resolved) std::abort();
    } catch (const pirsim::Error&) {
      std::abort();
    }
  });
}
