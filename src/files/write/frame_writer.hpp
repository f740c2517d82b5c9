// Frames of thermal arrays as files.
#pragma once

#include <string>
#include <string_view>

#include "pirsim/sample.hpp"

namespace pirsim::io {

/// A name as a part of a file's name: what a file can't have in it, and `also`, in hexadecimal, "%2F"; of a very long
/// one the beginning and a digest. Different names stay different.
[[nodiscard]] std::string file_part(const std::string& name, std::string_view also = "");
/// "A1_S3_2.npy": of the array, whose own underscores become "%5F", the trial and the replicate.
[[nodiscard]] std::string frame_file(const std::string& array, const std::string& trial, int replicate);
/// The bytes of a NumPy file, version 1.0: single precision, little-endian, in C order, (frame, y, x).
[[nodiscard]] std::string to_npy(const FrameStack& frames);
/// The latest frame that is read by this second: a line a row of pixels, without a heading; empty: none was read yet. A
/// dead pixel is an empty field.
[[nodiscard]] std::string frame_to_csv(const FrameStack& frames, double time_s);

}  // namespace pirsim::io
