#include "geo/io/files/embedded_data.hpp"

#include <algorithm>
#include <string>

#include "geo/core/error.hpp"

namespace geo::io {

std::string_view embedded_file(std::string_view name) {
  const auto& files = embedded_files();
  const auto at = std::find_if(files.begin(), files.end(),
                               [&](const EmbeddedFile& file) { return file.name == name; });
  if (at == files.end()) throw Bug("data file " + std::string(name) + " is not in the program");
  return at->text;
}

Table embedded_table(std::string_view name) { return {embedded_file(name), std::string(name)}; }

}  // namespace geo::io
