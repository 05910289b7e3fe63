#pragma once

#include <span>

#include "geo/kernels/exemplars/exemplar.hpp"
#include "geo/kernels/landscape/surface_detail.hpp"
#include "geo/stages/erosion/erosion.hpp"
#include "geo/stages/island/island.hpp"

namespace geo {

/// The planet's fields that an island's surface is made from.
struct PlanetTerrain {
  std::span<const float> elevation_m;
  std::span<const std::int8_t> boundary_type;  ///< may be empty
  std::span<const float> erodibility;          ///< may be empty
  std::span<const std::int8_t> orogeny_type;   ///< may be empty, as all below
  std::span<const float> orogeny_age_myr, fold_east, fold_north;
};

/// Interpolated surface with detail, before any erosion.
/// @param exemplars what detail is made like; null unless `p.detail` asks for it
/// @param planet_m  out: the interpolated surface alone
void raise_island(const PlanetCells& cells, const PlanetTerrain& planet, const IslandParameters& p,
                  const ExemplarLibrary* exemplars, std::uint64_t seed, std::span<float> planet_m,
                  std::span<float> elevation_m);

}  // namespace geo
