# Compiler settings shared by everything that is ours.
# -ffp-contract=off: the same source gives the same bits whatever the optimiser would like to fuse.
# -fno-math-errno: lets square roots become one instruction; results stay the same.
# -fno-trapping-math: loops may choose between values, several at once; nobody looks at the flags that
# the value not chosen raises, and results stay the same.
add_library(terrane_options INTERFACE)
target_compile_features(terrane_options INTERFACE cxx_std_20)
target_compile_options(terrane_options INTERFACE -Wall -Wextra -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(TERRANE_NATIVE)
  target_compile_options(terrane_options INTERFACE -march=native)
elseif(CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
  target_compile_options(terrane_options INTERFACE -march=x86-64-v2)
endif()
# g++ says itself when it builds with a sanitizer, clang otherwise.
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=[^ ]*(address|thread)")
  target_compile_definitions(terrane_options INTERFACE TERRANE_SANITIZED)
endif()
set(CMAKE_CXX_EXTENSIONS OFF)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
find_program(TERRANE_CCACHE ccache)
if(TERRANE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${TERRANE_CCACHE})
endif()
