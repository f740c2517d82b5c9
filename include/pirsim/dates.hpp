// Dates whose order doesn't show in themselves.
#pragma once

namespace pirsim {

/// Of 12/01/2017, 12-01-17.
enum class Dates { found, month_first, day_first, year_first };

}  // namespace pirsim
