#pragma once

#include <string_view>
#include <vector>

#include "geo/io/input/table.hpp"

namespace geo::io {

/// A file of `data/` that the build put into the program.
struct EmbeddedFile {
  std::string_view name;  ///< path below `data/`
  std::string_view text;
};

/// All of them; the build writes this function.
const std::vector<EmbeddedFile>& embedded_files();

/// Text of one; throws Bug when the build left it out.
std::string_view embedded_file(std::string_view name);

/// One that is a table. Throws Bug when the build left it out.
Table embedded_table(std::string_view name);

}  // namespace geo::io
