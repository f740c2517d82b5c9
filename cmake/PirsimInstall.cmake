# `cmake --install` gives static libraries that find_package(pirsim) and pkg-config find, the command, and the data.
include(CMakePackageConfigHelpers)

set(PIRSIM_DATA_INSTALL_DIR "${CMAKE_INSTALL_DATADIR}/pirsim")
install(TARGETS pirsim pirsim_reconcile EXPORT pirsimTargets
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT library
  FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT library)
if(TARGET pirsim_app)
  install(TARGETS pirsim_app RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT command)
endif()
install(DIRECTORY "${PROJECT_SOURCE_DIR}/data/" DESTINATION "${PIRSIM_DATA_INSTALL_DIR}" COMPONENT command)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}" RENAME copyright COMPONENT command)
# What it carries of others, and their licences.
install(DIRECTORY "${PROJECT_SOURCE_DIR}/third_party" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT command
  FILES_MATCHING PATTERN licences.toml PATTERN "licences/*.txt" PATTERN LICENSE)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/pirsim")
install(EXPORT pirsimTargets NAMESPACE pirsim:: DESTINATION "${package_dir}" COMPONENT library)
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/pirsimConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/pirsimConfig.cmake" INSTALL_DESTINATION "${package_dir}"
  PATH_VARS CMAKE_INSTALL_BINDIR)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/pirsimConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/pirsimConfig.cmake" "${PROJECT_BINARY_DIR}/pirsimConfigVersion.cmake"
  DESTINATION "${package_dir}" COMPONENT library)

# Relative to the .pc file itself, so that an installation can be moved.
file(RELATIVE_PATH PIRSIM_PC_TO_PREFIX "/prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/prefix")
foreach(package IN ITEMS pirsim pirsim-reconcile)
  configure_file("${CMAKE_CURRENT_LIST_DIR}/${package}.pc.in" "${PROJECT_BINARY_DIR}/${package}.pc" @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/${package}.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig" COMPONENT library)
endforeach()
