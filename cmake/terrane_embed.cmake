# terrane_embed(TARGET FOLDER FILE...): puts data files into the program, under their path relative
# to FOLDER, so that an installed binary needs no path. Read back with geo::io::embedded_file.
function(terrane_embed target folder)
  set(entries "")
  foreach(file ${ARGN})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(RELATIVE_PATH name ${folder} ${file})
    file(READ ${file} text)
    string(APPEND entries "    {\"${name}\", R\"terrane_data(${text})terrane_data\"},\n")
  endforeach()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${target}_embedded_data.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT [[
#include "geo/io/files/embedded_data.hpp"

namespace geo::io {
const std::vector<EmbeddedFile>& embedded_files() {
  static const std::vector<EmbeddedFile> kFiles{
@entries@  };
  return kFiles;
}
}  // namespace geo::io
]] @ONLY)
  target_sources(${target} PRIVATE ${source})
endfunction()
