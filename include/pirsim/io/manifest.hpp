// The side-car of a data file: what made it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace pirsim::io {

struct Manifest {
  std::string program;  ///< version, revision, compiler
  std::string embree;   ///< version and instruction set
  std::string tracer;
  std::string scene;  ///< file names as given
  std::string script;
  std::string resolved_script;  ///< YAML, after overrides
  std::uint64_t seed = 0;
  std::uint32_t runs = 0;
  std::uint64_t rows = 0;
};

/// Written last, so that a data file with a manifest is complete. JSON; throws Error(io).
void write_manifest(const std::filesystem::path& file, const Manifest& manifest);

}  // namespace pirsim::io
