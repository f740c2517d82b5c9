// All that most users of the library need.
#pragma once

#include "pirsim/coverage.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/error.hpp"
#include "pirsim/io.hpp"
#include "pirsim/log.hpp"
#include "pirsim/look.hpp"
#include "pirsim/model.hpp"
#include "pirsim/recording.hpp"
#include "pirsim/state.hpp"
#include "pirsim/study.hpp"
