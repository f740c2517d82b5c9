// What all fuzz targets share: input as a file, and the only exception that may leave a reader.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "pirsim/error.hpp"

// libFuzzer's entry, also called by replay.cpp.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace pirsim::test {

/// Writes the input to a file of this process's own, hands it to the reader, and lets nothing but Error pass.
template <typename Read>
int read_as_file(const std::uint8_t* data, std::size_t size, const std::string& ending, const Read& read) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "pirsim_fuzz";
  std::filesystem::create_directories(folder);
  const std::filesystem::path file = folder / (std::to_string(getpid()) + ending);
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    read(file);
  } catch (const Error& error) {
    if (error.issues().empty() || error.code() == ErrorCode::internal) std::abort();
  }
  std::filesystem::remove(file);
  return 0;
}

}  // namespace pirsim::test
