#pragma once

#include <span>
#include <string_view>

namespace geo::io {

/// A built-in configuration: a TOML file of data/presets that the build put into the library.
struct Preset {
  std::string_view name;
  std::string_view summary;  ///< the first comment line of the file
  std::string_view toml;
};

/// All presets, the default first.
std::span<const Preset> presets();
/// The preset of that name. ConfigurationError with the nearest name when there is none.
const Preset& find_preset(std::string_view name);

}  // namespace geo::io
