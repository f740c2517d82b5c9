# Every third-party library in one place. Only GLM shows in public headers.
find_package(glm REQUIRED)
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()
find_package(OpenMesh REQUIRED)
find_package(TinyGLTF REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Threads REQUIRED)
find_package(date REQUIRED)  # time zones of logs, by the system's data base (tzdata)
find_package(NLopt REQUIRED)
find_package(ZLIB REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)  # SHA-256 of data and inputs
find_package(PkgConfig REQUIRED)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)  # Debian's package has no CMake file
find_package(SQLite3 REQUIRED)  # Home Assistant's database
find_package(Eigen3 REQUIRED)
find_package(Boost REQUIRED CONFIG)  # headers of Boost.Math
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
# Vega draws the charts of reports: its script is built into the library.
find_path(VEGA_DIR NAMES vega-parser.min.js vega.min.js PATHS /usr/share/javascript/vega NO_DEFAULT_PATH REQUIRED)
find_path(RANDOM123_INCLUDE_DIR Random123/philox.h REQUIRED)
find_path(STB_INCLUDE_DIR stb/stb_image_write.h REQUIRED)
if(PIRSIM_BUILD_PYTHON)
  find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module ${SKBUILD_SABI_COMPONENT})
endif()
if(PIRSIM_BUILD_APP)
  find_package(CLI11 REQUIRED)
endif()
