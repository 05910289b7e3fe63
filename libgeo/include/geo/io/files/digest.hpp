#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "geo/core/state.hpp"

namespace geo::io {

/// XXH3-128 of a text, 32 hexadecimal digits.
std::string digest_of(std::string_view text);
/// XXH3-128 of the values' bytes as they lie in memory (little-endian), 32 hexadecimal digits.
std::string digest_of(const Values& values);

/// XXH3-128 of the bytes of a file, 32 hexadecimal digits. Throws IoError.
std::string digest_of_file(const std::filesystem::path& path);

/// One field in figures. `min`, `mean` and `max` leave missing cells out, and are NaN if all are.
struct FieldRecord {
  std::string name;
  std::string units;
  double min = 0.0;
  double mean = 0.0;  ///< weighted by cell area
  double max = 0.0;
  std::int64_t missing = 0;  ///< cells
  std::string digest;
};

/// The same bits for any number of threads.
FieldRecord summarise(const FieldSpec& spec, const Values& values, const Grid& grid);

}  // namespace geo::io
