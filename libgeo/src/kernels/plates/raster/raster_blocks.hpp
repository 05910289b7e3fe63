#pragma once

#include <cstdint>
#include <cstring>

#include "geo/kernels/plates/raster/raster_plate.hpp"

namespace geo {

/// Owners of a block's cells, four to a word; a free cell has all its bits set, -1.
struct BlockOwners {
  explicit BlockOwners(const std::int16_t* owner) {
    static_assert(RasterPlate::kBlock == 16);
    std::memcpy(word, owner, sizeof word);
  }
  [[nodiscard]] bool all_free() const {
    return (word[0] & word[1] & word[2] & word[3]) == ~std::uint64_t{0};
  }
  [[nodiscard]] bool none_free() const {
    return ((word[0] | word[1] | word[2] | word[3]) & 0x8000'8000'8000'8000U) == 0;
  }
  std::uint64_t word[4];
};

}  // namespace geo
