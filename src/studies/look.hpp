// What the functions of pirsim/look.hpp share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/range.hpp"
#include "pirsim/model.hpp"

namespace pirsim::studies {

/// Throws Error(usage).
void require_run(const Model& model, std::uint32_t run);
/// Throws Error(usage) that names the argument.
void require(const char* what, double value, const NumberRange& range);
/// Resolves "all", "none" and sensor names to indices. Throws Error(usage).
[[nodiscard]] std::vector<std::size_t> sensors_named(const Model& model, const std::vector<std::string>& names);

}  // namespace pirsim::studies
