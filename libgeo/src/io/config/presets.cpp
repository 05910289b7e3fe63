#include "geo/io/config/presets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/files/embedded_data.hpp"

namespace geo::io {

namespace {

std::string_view summary_of(std::string_view toml) {
  const auto line = toml.substr(0, toml.find('\n'));
  const auto first = line.find_first_not_of("# ");
  return first == std::string_view::npos ? std::string_view() : line.substr(first);
}

}  // namespace

std::span<const Preset> presets() {
  static const std::vector<Preset> kPresets = [] {
    std::vector<Preset> all;
    constexpr std::string_view kFolder = "presets/";
    for (const auto& [path, toml] : embedded_files()) {
      if (!path.starts_with(kFolder)) continue;
      const auto file = path.substr(kFolder.size());
      all.push_back({file.substr(0, file.rfind('.')), summary_of(toml), toml});
    }
    std::stable_partition(all.begin(), all.end(),
                          [](const Preset& preset) { return preset.name == "earth"; });
    return all;
  }();
  return kPresets;
}

const Preset& find_preset(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Preset& preset : presets()) {
    if (preset.name == name) return preset;
    names.push_back(preset.name);
  }
  throw ConfigurationError(fmt::format("unknown preset {}: must be one of {}{}", name,
                                       fmt::join(names, ", "), suggestion(name, names)));
}

}  // namespace geo::io
