#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geo/core/random.hpp"

namespace geo {

/// Grows plates over `count` places, each from a random one: a plate in turn gives up a random
/// place of its border and takes what is free around that. `each_neighbour(place, take)` calls
/// `take` for the places next to one. Returns the plate of each place.
template <class EachNeighbour>
std::vector<std::int16_t> grow_over(std::size_t count, int plates, std::uint64_t seed,
                                    std::uint64_t round, EachNeighbour&& each_neighbour) {
  const RandomStream random(seed, "raster.growth");
  std::uint64_t draw = 0;
  const auto below = [&](std::size_t limit) {
    return static_cast<std::size_t>((std::uint64_t{random.words(draw++, round)[0]} * limit) >> 32);
  };
  std::vector<std::int16_t> plate(count, -1);
  std::vector<std::vector<std::int32_t>> border(plates);
  for (int p = 0; p < plates; ++p) {
    std::int32_t place = 0;
    do {
      place = static_cast<std::int32_t>(below(plate.size()));
    } while (plate[place] >= 0);
    plate[place] = static_cast<std::int16_t>(p);
    border[p].push_back(place);
  }
  for (bool grows = true; grows;) {
    grows = false;
    for (int p = 0; p < plates; ++p) {
      if (border[p].empty()) continue;
      grows = true;
      const std::size_t pick = below(border[p].size());
      const std::int32_t place = border[p][pick];
      border[p][pick] = border[p].back();
      border[p].pop_back();
      each_neighbour(place, [&](std::int32_t next) {
        if (plate[next] >= 0) return;
        plate[next] = static_cast<std::int16_t>(p);
        border[p].push_back(next);
      });
    }
  }
  return plate;
}

}  // namespace geo
