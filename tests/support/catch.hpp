// Catch2 version 3 and version 2 under one name.
#pragma once

#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;
#else
#include <catch2/catch.hpp>
#endif

#include <string>

/// Matches a text that holds the fragment; Catch2 version 3 has another name for it.
inline auto contains(const std::string& fragment) {
#if __has_include(<catch2/catch_all.hpp>)
  return Catch::Matchers::ContainsSubstring(fragment);
#else
  return Catch::Matchers::Contains(fragment);
#endif
}
