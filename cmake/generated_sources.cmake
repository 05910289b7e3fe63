# Sources that the build makes: the presets of data/presets as strings, and the commit it is built
# from. Sets terrane_generated_sources and terrane_generated_folder.
set(terrane_generated_folder ${PROJECT_BINARY_DIR}/generated)
file(MAKE_DIRECTORY ${terrane_generated_folder})

file(GLOB terrane_presets CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/data/presets/*.toml)
list(JOIN terrane_presets "|" joined_presets)
add_custom_command(
  OUTPUT ${terrane_generated_folder}/embedded_presets.cpp
  COMMAND ${CMAKE_COMMAND} -DOUTPUT=${terrane_generated_folder}/embedded_presets.cpp
          "-DPRESETS=${joined_presets}" -P ${PROJECT_SOURCE_DIR}/cmake/embed_presets.cmake
  DEPENDS ${terrane_presets} ${PROJECT_SOURCE_DIR}/cmake/embed_presets.cmake
  COMMENT "Embedding presets" VERBATIM)

# Looked at on every build, written only when it changed.
add_custom_target(terrane_commit
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR}
          -DOUTPUT=${terrane_generated_folder}/terrane_commit.hpp -DVERSION=${PROJECT_VERSION}
          "-DCOMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
          -P ${PROJECT_SOURCE_DIR}/cmake/write_commit.cmake
  BYPRODUCTS ${terrane_generated_folder}/terrane_commit.hpp
  COMMENT "" VERBATIM)
set_source_files_properties(${CMAKE_CURRENT_SOURCE_DIR}/src/io/build_info.cpp PROPERTIES
  OBJECT_DEPENDS ${terrane_generated_folder}/terrane_commit.hpp)

set(terrane_generated_sources ${terrane_generated_folder}/embedded_presets.cpp)
