# Compiler settings of our own targets; never exported to users of the library.
add_library(pirsim_flags INTERFACE)
target_compile_features(pirsim_flags INTERFACE cxx_std_20)
# Contraction would let the compiler fuse a*b+c differently from build to build: results must be the same bytes.
target_compile_options(pirsim_flags INTERFACE
  -ffp-contract=off -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC 12 takes `"text" + std::string` for an overlapping copy (its bug 105651).
  target_compile_options(pirsim_flags INTERFACE -Wno-restrict)
endif()
if(PIRSIM_SANITIZE)
  target_compile_options(pirsim_flags INTERFACE -fsanitize=${PIRSIM_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(pirsim_flags INTERFACE -fsanitize=${PIRSIM_SANITIZE})
endif()

# Parses headers that nearly every file includes once a target instead of once a file. Off unless a preset asks for it, so
# that the release build finds a file that forgets an include.
option(PIRSIM_PRECOMPILE_HEADERS "precompile the commonest headers" OFF)
function(pirsim_precompile target)
  if(PIRSIM_PRECOMPILE_HEADERS)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory>
      <optional> <span> <sstream> <string> <vector> <glm/geometric.hpp> <glm/gtc/quaternion.hpp> ${ARGN})
  endif()
endfunction()

# Compiles the files of a folder together, a dozen at a time, so that headers are parsed once a dozen. Off unless a preset
# asks for it: while writing, a file alone compiles sooner. Names of anonymous namespaces must be unlike within a layer.
option(PIRSIM_UNITY_BUILD "compile files together" OFF)
function(pirsim_unity target)
  if(NOT PIRSIM_UNITY_BUILD)
    return()
  endif()
  get_target_property(files ${target} SOURCES)
  set(folder "")
  foreach(file IN LISTS files)
    get_filename_component(at "${file}" DIRECTORY)
    if(NOT at STREQUAL folder OR n EQUAL 12)
      set(folder "${at}")
      string(MAKE_C_IDENTIFIER "${file}" group)
      set(n 0)
    endif()
    math(EXPR n "${n} + 1")
    set_source_files_properties("${file}" PROPERTIES UNITY_GROUP "${group}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
