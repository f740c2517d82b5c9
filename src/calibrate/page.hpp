// A calibration as a page for a reader.
#pragma once

#include "io/pages/report.hpp"
#include "pirsim/calibrate.hpp"

namespace pirsim::calibrate {

[[nodiscard]] io::Report page(const Calibration& calibration, const About& about);
[[nodiscard]] std::string word_of(Verdict verdict);  ///< "like-these"

}  // namespace pirsim::calibrate
