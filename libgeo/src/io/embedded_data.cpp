#include "geo/io/embedded_data.hpp"

#include <algorithm>
#include <charconv>
#include <string>

#include "geo/core/error.hpp"

namespace geo::io {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

}  // namespace

std::string_view embedded_file(std::string_view name) {
  const auto& files = embedded_files();
  const auto at = std::find_if(files.begin(), files.end(),
                               [&](const EmbeddedFile& file) { return file.name == name; });
  if (at == files.end()) throw Bug("data file " + std::string(name) + " is not in the program");
  return at->text;
}

std::vector<std::vector<std::string_view>> table_rows(std::string_view text) {
  std::vector<std::vector<std::string_view>> rows;
  for (const auto line : split(text, '\n')) {
    if (!line.empty()) rows.push_back(split(line, ','));
  }
  if (!rows.empty()) rows.erase(rows.begin());
  return rows;
}

double number(std::string_view cell) {
  double value = 0.0;
  const auto result = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (result.ec != std::errc() || result.ptr != cell.data() + cell.size()) {
    throw Bug("data table: \"" + std::string(cell) + "\" is not a number");
  }
  return value;
}

}  // namespace geo::io
