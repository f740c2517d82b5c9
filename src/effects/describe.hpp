// The catalogue in words.
#pragma once

#include <string>

#include "effects/catalogue.hpp"

namespace pirsim::effects {

/// A line an effect: name, family, the parameters that are its strength with their range, what it does.
[[nodiscard]] std::string list_text();
/// All that is known of one effect, for a terminal.
[[nodiscard]] std::string to_text(const Effect& effect);
/// The same of all effects as Markdown: what docs/effects.md holds.
[[nodiscard]] std::string list_markdown();

}  // namespace pirsim::effects
