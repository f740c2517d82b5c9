# `cpack --config build/release/CPackConfig.cmake` makes pirsim_*.deb (the command and its data) and pirsim-dev_*.deb
# (the libraries); CPackSourceConfig.cmake makes the source archive. tools/packaging/try_packages tries all three.
set(CPACK_PACKAGE_NAME pirsim)
set(CPACK_PACKAGE_VENDOR "The pirsim authors")
set(CPACK_PACKAGE_CONTACT "The pirsim authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "headless simulator of passive-infrared motion sensors")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_RESOURCE_FILE_README "${PROJECT_SOURCE_DIR}/README.md")
set(CPACK_PACKAGE_CHECKSUM SHA256)
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR DEB)

set(CPACK_COMPONENTS_ALL command development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_HOMEPAGE "${PROJECT_HOMEPAGE_URL}")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME pirsim)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)  # the shared libraries that the command is linked with
set(CPACK_COMPONENT_COMMAND_DESCRIPTION
  "Simulates a room, its motion sensors and what people do there.\nIt writes one row per second: a bit per sensor, and the true number of people.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME pirsim-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "Static libraries and headers of pirsim.\nCMake and pkg-config find them.")
# What pirsimConfig.cmake and pirsim.pc ask for.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "pirsim (= ${PROJECT_VERSION}), libembree-dev, libglm-dev, libopenmesh-dev, libtinygltf-dev, libyaml-cpp-dev, \
nlohmann-json3-dev, libnlopt-cxx-dev, zlib1g-dev, libzstd-dev, libssl-dev, pkg-config")

# The source archive: what a clone holds, and the revision that git told, for a build without git.
set(CPACK_SOURCE_GENERATOR TGZ)
set(CPACK_SOURCE_PACKAGE_FILE_NAME "pirsim-${PROJECT_VERSION}")
set(CPACK_VERBATIM_VARIABLES TRUE)
string(REGEX REPLACE [[([][+.*()^$?|])]] [[\\\1]] source_dir "${PROJECT_SOURCE_DIR}")
set(CPACK_SOURCE_IGNORE_FILES "^${source_dir}/(build|out|[.]git)(/|$)" /__pycache__/ [[[.]pyc$]])
set(CPACK_INSTALL_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/PirsimRevision.cmake")
set(CPACK_PIRSIM_REVISION "${PIRSIM_GIT_REVISION}")
include(CPack)
