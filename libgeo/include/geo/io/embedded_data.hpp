#pragma once

#include <string_view>
#include <vector>

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

/// Rows of a comma-separated table without its header line. Cells have no quotes in our files.
std::vector<std::vector<std::string_view>> table_rows(std::string_view text);
/// A cell as a number; throws Bug when it is none.
double number(std::string_view cell);

}  // namespace geo::io
