// Catch2 version 3 and version 2 under one name.
// This header is precompiled. GCC knows a header by `#pragma once` from its time as well, which another checkout
// changes while ccache still has what was precompiled: then it would be there twice.
#ifndef PIRSIM_TESTS_CATCH_HPP
#define PIRSIM_TESTS_CATCH_HPP

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

#endif
