#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "export_source.hpp"

namespace geo::io {

/// An 8-bit layer over the cells of the grid.
struct ExportMask {
  std::string name;
  std::vector<std::uint8_t> values;
  nlohmann::ordered_json meaning;  ///< as the JSON beside a height map has it
};

/// The layers that a request names. Throws ConfigurationError for an unknown name, or where a field
/// is not there.
[[nodiscard]] std::vector<ExportMask> masks_of(const ExportRequest& request,
                                               const ExportSource& source);

}  // namespace geo::io
