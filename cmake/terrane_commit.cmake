# The header with version, commit and compiler, looked at on every build and written only when it
# changed. Sets terrane_generated_folder.
set(terrane_generated_folder ${PROJECT_BINARY_DIR}/generated)
file(MAKE_DIRECTORY ${terrane_generated_folder})
add_custom_target(terrane_commit
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR}
          -DOUTPUT=${terrane_generated_folder}/terrane_commit.hpp -DVERSION=${PROJECT_VERSION}
          "-DCOMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
          -P ${PROJECT_SOURCE_DIR}/cmake/write_commit.cmake
  BYPRODUCTS ${terrane_generated_folder}/terrane_commit.hpp
  COMMENT "Looking up the commit" VERBATIM)
