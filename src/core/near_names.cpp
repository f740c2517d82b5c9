#include "core/near_names.hpp"

#include "core/text.hpp"
#include "pirsim/error.hpp"

namespace pirsim {

std::string near_or_all(std::string_view name, const std::vector<std::string>& known) {
  constexpr std::size_t most = 20;  // assumed: of more, as of meshes, nobody reads the list (tried 10-50)
  if (known.empty()) return "; there are none";
  std::string text = did_you_mean(name, known);
  if (!text.empty()) return text;
  for (std::size_t i = 0; i < known.size() && i < most; ++i)
    text += (i == 0 ? "; there are " : ", ") + shortened(known[i]);
  if (known.size() > most) text += " and " + std::to_string(known.size() - most) + " more";
  return text;
}

}  // namespace pirsim
