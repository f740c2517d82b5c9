#include "app/output_size.hpp"

#include <cmath>
#include <sstream>

#include "core/text.hpp"
#include "pirsim/error.hpp"
#include "studies/run_film.hpp"

namespace pirsim::app {

void offer_size(CLI::App& command, Size& size) {
  command.add_flag_callback(
      "--large", [&size] { size = Size::any; },
      "write it however large it gets (otherwise at most " + bytes_in_words(film_bytes) + ")");
}

std::string bytes_in_words(double bytes) {
  constexpr double giga = 1e9, mega = 1e6;
  std::ostringstream text;
  if (bytes >= giga) {
    text << std::round(bytes / giga * 10.0) / 10.0 << " GB";
  } else {
    text << std::ceil(bytes / mega) << " MB";
  }
  return text.str();
}

void require_usual(const FilmSize& film, double seconds, Size size) {
  const double bytes = film.bytes_a_byte * studies::expected_bytes(film.n_people, seconds, film.keys_per_s);
  if (size == Size::any || bytes <= film_bytes) return;
  std::ostringstream text;
  text << film.what << " would have about " << bytes_in_words(bytes) << " (" << std::llround(seconds) << " s, "
       << counted(static_cast<std::size_t>(film.n_people), "person", "people") << ", " << film.keys_per_s
       << " keys a second): take a part with --from and --to, fewer --keys-per-s, or give --large";
  throw Error(ErrorCode::usage, text.str());
}

}  // namespace pirsim::app
