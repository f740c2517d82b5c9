// One thing that differs between the plain model and the world, switched on in a script.
#pragma once

#include <map>
#include <string>

#include "pirsim/core/error.hpp"

namespace pirsim {

/// An entry of `effects:`; names are those of the catalogue (pirsim/effects/catalogue.hpp), which checks them when a
/// Model is compiled.
struct EffectSpec {
  std::string name;
  std::map<std::string, double, std::less<>> parameters;  ///< by name with unit; missing: the catalogue's typical value
  std::map<std::string, std::string, std::less<>> choices;  ///< `sensor: PIR3`; missing: all, or the effect's own way
  Where where;                                              ///< for messages
};

}  // namespace pirsim
