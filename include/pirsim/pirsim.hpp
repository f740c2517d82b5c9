// All that most users of the library need.
#pragma once

#include "pirsim/csv.hpp"
#include "pirsim/error.hpp"
#include "pirsim/io.hpp"
#include "sim/model.hpp"
#include "sim/state.hpp"
#include "sim/study.hpp"
