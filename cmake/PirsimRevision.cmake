# CPack runs this for every package: the source archive gets the file that src/CMakeLists.txt reads where git can't tell.
if(NOT CPACK_INSTALL_CMAKE_PROJECTS)
  file(WRITE "${CMAKE_INSTALL_PREFIX}/REVISION" "${CPACK_PIRSIM_REVISION}\n")
endif()
