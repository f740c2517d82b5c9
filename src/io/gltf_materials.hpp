// What materials say about heat: `extras.pirsim.temperature_c`. Private to io.
#pragma once

#include <optional>
#include <vector>

#include "io/gltf_document.hpp"

namespace pirsim::io::detail {

/// Degrees Celsius, within what surfaces in rooms may have.
inline constexpr double coldest_surface_c = -50.0, hottest_surface_c = 200.0;

/// (n_materials) nothing for those that say nothing, or something faulty (the faults are added).
[[nodiscard]] std::vector<std::optional<double>> material_temperatures_c(const GltfDocument& document,
                                                                         Diagnostics& remarks);

}  // namespace pirsim::io::detail
