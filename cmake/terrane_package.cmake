# `cpack -G DEB` makes the program, the library to build against, and the Python module where it is built.
# Packs what is built; tests need not be.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)
set(package_work ${PROJECT_BINARY_DIR}/package)
find_program(TERRANE_GZIP gzip REQUIRED)
set(CPACK_PACKAGE_NAME terrane)
set(CPACK_PACKAGE_VENDOR "The terrane authors")
set(CPACK_PACKAGE_CONTACT "The terrane authors <terrane@terrane.example>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
if(TARGET terrane_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
# Folders as Debian has them, whatever the umask of whoever packs.
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
  GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME terrane)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "fonts-dejavu-core")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "paraview, ferret-datasets")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "whole planet's surface from physics")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "Grows plates, floats the crust, wears it down with rivers, gives it
a climate, rivers and lakes and biomes, and refines islands. Every stage
leaves CF-NetCDF and VTK files; a fit calibrates parameters against a
target hypsometry.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libterrane-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libgeographiclib-dev")
# What the component `io` links to.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "libnetcdf-dev, libhdf5-dev, libvtk9-dev, libtiff-dev, libgeotiff-dev, \
libpng-dev, libcairo2-dev, libproj-dev, libxxhash-dev, libudunits2-dev, libdeflate-dev, libisal-dev, libpugixml-dev, libtinygltf-dev, \
libtomlplusplus-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Grids, fields, kernels and stages of a planet's surface as functions over
spans: headers, a static library and the package that find_package(terrane)
reads.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-terrane)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy, python3-xarray, python3-netcdf4")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Runs planets in memory and hands their stages over as xarray Datasets; reads
runs back, scores, refines islands, fits parameters; single kernels on
numpy arrays.")
file(WRITE ${package_work}/changelog "terrane (${PROJECT_VERSION}) unstable; urgency=medium

  * See https://keepachangelog.com: CHANGELOG.md of the source.

 -- The terrane authors <terrane@terrane.example>  Thu, 01 Jan 2026 00:00:00 +0000
")
execute_process(COMMAND ${TERRANE_GZIP} -9nkf ${package_work}/changelog)
file(WRITE ${package_work}/copyright "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: terrane

Files: *
Copyright: 2026 The terrane authors
License: Apache-2.0
 On Debian systems the full text of the Apache License, version 2.0, is in
 /usr/share/common-licenses/Apache-2.0.
")
set(packages terrane libterrane-dev)
if(TARGET terrane_python)
  list(APPEND packages python3-terrane)
endif()
foreach(package ${packages})
  set(component program)
  if(package STREQUAL python3-terrane)
    set(component python)
  endif()
  if(package STREQUAL libterrane-dev)
    set(component development)
  endif()
  install(FILES ${package_work}/changelog.gz ${package_work}/copyright
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()
include(CPack)
