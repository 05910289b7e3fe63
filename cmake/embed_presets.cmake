# Writes OUTPUT, a C++ source that holds every file of PRESETS (a list joined with "|") as a string.
string(REPLACE "|" ";" presets "${PRESETS}")
set(rows "")
set(count 0)
foreach(preset IN LISTS presets)
  get_filename_component(name ${preset} NAME_WE)
  file(READ ${preset} text)
  string(APPEND rows "    {\"${name}\", R\"toml(${text})toml\"},\n")
  math(EXPR count "${count} + 1")
endforeach()
file(WRITE ${OUTPUT} "// Made from data/presets by cmake/embed_presets.cmake.
#include <span>
#include <string_view>
#include <utility>

namespace geo::io {
namespace {
constexpr std::pair<std::string_view, std::string_view> kRows[${count}] = {
${rows}};
}  // namespace
extern const std::span<const std::pair<std::string_view, std::string_view>> kEmbeddedPresets;
const std::span<const std::pair<std::string_view, std::string_view>> kEmbeddedPresets = kRows;
}  // namespace geo::io
")
