// What the readers of surveys have in common. Private to io.
#pragma once

#include <vector>

#include "io/read/reader_parts.hpp"
#include "pirsim/script.hpp"

namespace pirsim::io {

/// `effects` of any survey.
[[nodiscard]] std::vector<EffectSpec> read_survey_effects(YamlMap& map);

/// A file of format version 1; all its faults are told at once.
template <typename Fill>
auto read_versioned(const YamlNode& root, const char* what, const char* version_key, Fill fill) {
  Diagnostics faults;
  YamlMap map(root, faults, what);
  check_version(map, version_key);
  auto spec = fill(map);
  map.finish();
  faults.throw_if_errors();
  return spec;
}

}  // namespace pirsim::io
