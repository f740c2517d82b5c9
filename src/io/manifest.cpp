#include "pirsim/io/manifest.hpp"

#include <nlohmann/json.hpp>

#include "pirsim/io/atomic_file.hpp"

namespace pirsim::io {

void write_manifest(const std::filesystem::path& file, const Manifest& manifest) {
  const nlohmann::ordered_json json = {{"pirsim_manifest", 1},      {"program", manifest.program},
                                       {"embree", manifest.embree}, {"tracer", manifest.tracer},
                                       {"scene", manifest.scene},   {"script", manifest.script},
                                       {"seed", manifest.seed},     {"runs", manifest.runs},
                                       {"rows", manifest.rows},     {"resolved_script", manifest.resolved_script}};
  AtomicFile out(file);
  out.stream() << json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  out.commit();
}

}  // namespace pirsim::io
