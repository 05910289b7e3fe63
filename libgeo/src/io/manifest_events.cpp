#include "manifest_events.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "geo/core/error.hpp"
#include "geo/io/config.hpp"

namespace geo::io {
namespace {

using Json = nlohmann::ordered_json;

std::string in_words(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  return value.dump();
}

/// "type impact, latitude_deg 12.5" of an object; other values as they are.
std::string line_of(const Json& event) {
  if (!event.is_object()) return in_words(event);
  std::string line;
  for (const auto& [key, value] : event.items()) {
    if (value.is_null()) continue;
    line += fmt::format("{}{} {}", line.empty() ? "" : ", ", key, in_words(value));
  }
  return line;
}

void add_events(const Json& owner, std::vector<std::string>& lines) {
  const auto events = owner.find("events");
  if (events == owner.end() || !events->is_array()) return;
  for (const Json& event : *events) lines.push_back(line_of(event));
}

}  // namespace

std::vector<std::string> read_events(const std::filesystem::path& manifest) {
  std::vector<std::string> lines;
  try {
    const Json json = Json::parse(read_text(manifest));
    add_events(json, lines);
    for (const Json& stage : json.at("stages")) add_events(stage, lines);
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: no manifest of this version of terrane ({})",
                                 manifest.string(), error.what()));
  }
  return lines;
}

}  // namespace geo::io
