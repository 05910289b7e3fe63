#pragma once

#include <cstdint>

namespace geo {

/// Cells of a row that are looked at together: most of them are alike.
inline constexpr int kRasterBlock = 32;

/// How many of a block's heights are above a level, or at it.
inline int count_from(const float* heights, float level) {
  int count = 0;
  for (int k = 0; k < kRasterBlock; ++k) count += static_cast<int>(heights[k] >= level);
  return count;
}
/// How many of a block's cells have an owner.
inline int count_owned(const std::int16_t* owner) {
  std::int16_t count = 0;
  for (int k = 0; k < kRasterBlock; ++k) count += static_cast<std::int16_t>(owner[k] >= 0);
  return count;
}

}  // namespace geo
