option(PIRSIM_UNITY_BUILD "compile the files of a folder together" OFF)

# Compiler settings of our own targets; never exported to users of the library.
add_library(pirsim_flags INTERFACE)
target_compile_features(pirsim_flags INTERFACE cxx_std_20)
# Contraction would let the compiler fuse a*b+c differently from build to build: results must be the same bytes.
target_compile_options(pirsim_flags INTERFACE
  -ffp-contract=off -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor)
if(PIRSIM_UNITY_BUILD)
  # Between files that are compiled together these would warn of a name and a type that are private to one of them.
  target_compile_options(pirsim_flags INTERFACE -Wno-subobject-linkage)
else()
  target_compile_options(pirsim_flags INTERFACE -Wshadow)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC 12 takes `"text" + std::string` for an overlapping copy (its bug 105651).
  target_compile_options(pirsim_flags INTERFACE -Wno-restrict)
endif()
if(PIRSIM_SANITIZE)
  target_compile_options(pirsim_flags INTERFACE -fsanitize=${PIRSIM_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(pirsim_flags INTERFACE -fsanitize=${PIRSIM_SANITIZE})
endif()

# Two ways to parse headers less often. A preset asks for them; without, each file compiles alone, as a package's build
# does, and finds that it forgets an include.
option(PIRSIM_PRECOMPILE_HEADERS "precompile the tests' commonest headers" OFF)
function(pirsim_precompile target)
  if(PIRSIM_PRECOMPILE_HEADERS)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory>
      <optional> <span> <sstream> <string> <vector> <glm/geometric.hpp> <glm/gtc/quaternion.hpp> ${ARGN})
  endif()
endfunction()

# The files of a folder are compiled together, `most` at a time: names in their anonymous namespaces mustn't clash.
function(pirsim_unity target most)
  if(NOT PIRSIM_UNITY_BUILD)
    return()
  endif()
  get_target_property(files ${target} SOURCES)
  foreach(file IN LISTS files)
    cmake_path(GET file PARENT_PATH at)
    if(NOT at STREQUAL folder OR n EQUAL most)
      set(folder "${at}")
      cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" OUTPUT_VARIABLE first)
      cmake_path(RELATIVE_PATH first BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
      string(MAKE_C_IDENTIFIER "${first}" group)
      set(n 0)
    endif()
    math(EXPR n "${n} + 1")
    set_source_files_properties("${file}" PROPERTIES UNITY_GROUP ${group})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# Tests are many programs: mold links each in a moment, where it is installed.
if(PROJECT_IS_TOP_LEVEL AND PIRSIM_BUILD_TESTS AND NOT "${CMAKE_EXE_LINKER_FLAGS}" MATCHES "-fuse-ld")
  find_program(PIRSIM_MOLD mold)
  if(PIRSIM_MOLD)
    add_link_options(-fuse-ld=mold)
  endif()
endif()

# What compiled before, here or in another clone, is taken from ccache where that is installed.
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(PIRSIM_CCACHE ccache)
  if(PIRSIM_CCACHE)
    # Precompiled headers don't change between two builds of the same sources.
    set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros
        "CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}" "${PIRSIM_CCACHE}")
  endif()
endif()
