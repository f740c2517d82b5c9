// Outputs that may get larger than anybody expects: what is said before they are made.
#pragma once

#include <functional>
#include <string>

#include "app/options.hpp"

namespace pirsim::app {

// Limits, assumed; docs/formats/inputs.md tells them.
inline constexpr double film_bytes = 200e6;  ///< unless a user asks for more; what viewers and browsers open in seconds
inline constexpr double run_bytes = 4e9;     ///< in memory, of what is recorded at every tick of a run

/// Does a user want what is written however large it gets?
enum class Size { usual, any };

/// --large
void offer_size(CLI::App& command, Size& size);

/// A film of one run, as glTF or in a page.
struct FilmSize {
  std::string what;  ///< "the film"
  std::size_t n_people = 0;
  double keys_per_s = 10.0;
  double bytes_a_byte = 1.0;  ///< of the file, of the animation
};
/// Throws Error(usage) for more than a film may usually have (docs/formats/inputs.md).
void require_usual(const FilmSize& film, double seconds, Size size);

/// "1.2 GB", "340 MB"
[[nodiscard]] std::string bytes_in_words(double bytes);

}  // namespace pirsim::app
