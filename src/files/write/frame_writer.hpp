// Frames of thermal arrays as files.
#pragma once

#include <string>

#include "pirsim/sample.hpp"

namespace pirsim::io {

/// "A1_S3_2.npy": of the array, the trial and the replicate.
[[nodiscard]] std::string frame_file(const std::string& array, const std::string& trial, int replicate);
/// The bytes of a NumPy file, version 1.0: single precision, little-endian, in C order, (frame, y, x).
[[nodiscard]] std::string to_npy(const FrameStack& frames);
/// The latest frame that is read by this second: a line a row of pixels, without a heading; empty: none was read yet. A
/// dead pixel is an empty field.
[[nodiscard]] std::string frame_to_csv(const FrameStack& frames, double time_s);

}  // namespace pirsim::io
