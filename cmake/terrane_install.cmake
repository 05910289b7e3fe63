# What `cmake --install` puts in place besides the program: the library, its headers, and the
# package that find_package(terrane) reads: terrane::geo, and terrane::io as its component `io`.
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/terrane)

install(TARGETS terrane_geo EXPORT terraneTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/libgeo/include/geo DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  COMPONENT development
  FILES_MATCHING PATTERN "*.hpp")
install(EXPORT terraneTargets NAMESPACE terrane:: DESTINATION ${package_folder}
  COMPONENT development)
if(TARGET terrane_io)
  install(TARGETS terrane_io EXPORT terraneIoTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(EXPORT terraneIoTargets NAMESPACE terrane:: DESTINATION ${package_folder}
    COMPONENT development)
endif()
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/terraneConfig.cmake.in
  ${PROJECT_BINARY_DIR}/terraneConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/terraneConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/terraneConfig.cmake
  ${PROJECT_BINARY_DIR}/terraneConfigVersion.cmake DESTINATION ${package_folder}
  COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/paraview DESTINATION ${CMAKE_INSTALL_DATADIR}/terrane
  COMPONENT program
  PATTERN __pycache__ EXCLUDE PATTERN make_colour_maps.py EXCLUDE)
