// All that most users of the library need.
#pragma once

#include "pirsim/core/error.hpp"
#include "pirsim/io/csv_writer.hpp"
#include "pirsim/io/scene_reader.hpp"
#include "pirsim/io/script_reader.hpp"
#include "pirsim/sim/model.hpp"
#include "pirsim/sim/state.hpp"
#include "pirsim/sim/study.hpp"
