#include "body/body_part.hpp"

#include "schema/body_part_names.hpp"

namespace pirsim::body {

static_assert(body_part_names.size() == n_parts);

std::string_view name(Part part) noexcept { return body_part_names[static_cast<std::size_t>(part)]; }

}  // namespace pirsim::body
