#include "island_erosion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geo/kernels/remapping/catmull_rom.hpp"
#include "geo/stages/erosion/drainage.hpp"
#include "geo/stages/erosion/ground.hpp"
#include "geo/stages/erosion/landscape.hpp"
#include "geo/stages/erosion/wear_down.hpp"
#include "island_cells.hpp"

namespace geo {
namespace {

/// Raises land so that its mean over each planet cell is `target` again.
void restore_means(const PlanetCells& cells, std::span<const float> target,
                   std::span<const std::uint8_t> land, std::span<const std::uint8_t> held,
                   std::span<float> z, std::span<float> raised_m) {
  constexpr float kLow_m = 1.0F, kMost = 1.1F;
  std::vector<float> factor = cells.means(z, land, 0.0F);
  for (std::size_t k = 0; k < factor.size(); ++k) {
    factor[k] = factor[k] > kLow_m ? std::clamp(target[k] / factor[k], 1.0F, kMost) : 1.0F;
  }
  on_cells(cells.fine(), [&](int i, int j, Index c) {
    if (land[c] == 0 || held[c] != 0) return;
    const double ramp = edge_ramp(cells.fine(), i, j, seam_m(cells));
    const double rise = std::max(0.0, cells.interpolate(factor, i, j) - 1.0);
    const auto higher = static_cast<float>(z[c] * ramp * rise);
    z[c] += higher;
    raised_m[c] += higher;
  });
}

/// The planet's law of rivers and hillslopes for the steps of an island. Rivers deposit as they do
/// on the planet: without what they lay down the lowlands' would cut to the level of the sea, far
/// below the planet's own. What reaches the sea is gone, since the planet has laid it there
/// already, and what the crust gives back is what `keep_means` says.
ErosionParameters fine_law(const IslandParameters& p, ErosionParameters law) {
  constexpr double kBelowAnySea_m = 1e5;
  law.steps = p.erosion_steps;
  law.time_step_yr = p.time_step_yr;
  law.route_every = 1;
  law.dispersal_km = 0.0;
  law.wave_base_m = kBelowAnySea_m;
  law.highstand_yr = 0.0;
  law.flow_routing = "d8";
  law.depressions = "fill";
  law.uplift_mm_yr = 0.0;
  law.rebound_fraction = 0.0;
  return law;
}

}  // namespace

void add_ways_out(const Grid& fine, std::span<const float> z, std::span<std::uint8_t> outlets) {
  const std::vector<std::uint8_t> edges(outlets.begin(), outlets.end());
  for (Index c = 0; c < fine.size(); ++c) {
    const int i = fine.column(c), j = fine.row(c);
    if (std::min({i, fine.nx() - 1 - i, j, fine.ny() - 1 - j}) != 1) continue;
    const std::array<Index, kDirections> offsets = fine.offsets();
    const Index lowest =
        c + *std::min_element(offsets.begin(), offsets.end(),
                              [&](Index a, Index b) { return z[c + a] < z[c + b]; });
    if (edges[lowest] != 0 && fine.is_open_edge(fine.column(lowest), fine.row(lowest)) &&
        z[lowest] < z[c]) {
      outlets[c] = 1;
    }
  }
}

std::vector<float> island_erodibility(const PlanetCells& cells, const PlanetTerrain& planet,
                                      const IslandParameters& p, const ErosionParameters& law) {
  const bool by_boundary = p.erodibility == "boundary";
  if (by_boundary && planet.boundary_type.empty()) {
    return {static_cast<float>(p.interior_erodibility_yr)};
  }
  if (!by_boundary && planet.erodibility.empty()) {
    return resolved_erodibility<float>(law, {}, cells.fine(), {});
  }
  const auto of_type = [&](std::int8_t type) {
    switch (static_cast<BoundaryType>(type)) {
      case BoundaryType::interior:
        return p.interior_erodibility_yr;
      case BoundaryType::divergent:
        return p.divergent_erodibility_yr;
      default:
        return p.convergent_erodibility_yr;
    }
  };
  // Cubics swing beyond what they pass through; nothing is weaker or stronger than the table has
  // it.
  const auto range = std::minmax(
      {p.convergent_erodibility_yr, p.divergent_erodibility_yr, p.interior_erodibility_yr});
  std::vector<float> erodibility(cells.fine().size());
  on_cells(cells.fine(), [&](int i, int j, Index c) {
    const CatmullRom stencil(cells.planet(), cells.fine().position(i, j));
    const auto at = [&](int column, int row) {
      const Index cell = cells.planet().cell(column, row);
      return by_boundary ? of_type(planet.boundary_type[cell])
                         : static_cast<double>(planet.erodibility[cell]);
    };
    const double worn = std::max(0.0, stencil.of(at));
    erodibility[c] =
        static_cast<float>(by_boundary ? std::clamp(worn, range.first, range.second) : worn);
  });
  if (by_boundary) return erodibility;
  return resolved_erodibility<float>(law, {}, cells.fine(), erodibility);
}

IslandErosion wear_island(const PlanetCells& cells, const IslandParameters& p,
                          const ErosionParameters& planets, const IslandGround& ground,
                          const std::function<void(double)>& advance,
                          std::span<float> elevation_m) {
  const Grid& fine = cells.fine();
  const ErosionParameters law = fine_law(p, planets);
  IslandErosion done{{}, std::vector<float>(fine.size())};
  std::vector<std::uint8_t> land(fine.size());
  std::transform(elevation_m.begin(), elevation_m.end(), land.begin(),
                 [](float z) { return static_cast<std::uint8_t>(z >= 0.0F); });
  const std::vector<float> target = cells.means(elevation_m, land, 0.0F);
  Landscape<float> landscape(law, {}, fine, elevation_m, {}, {}, ground.erodibility,
                             {ground.held.begin(), ground.held.end()});
  Drainage drainage;
  const auto route = [&](std::int64_t) -> const Drainage& {
    drain(law, fine, elevation_m, ground.outlets, drainage, nullptr, ground.inflow_area_m2);
    return drainage;
  };
  const auto restore = [&](std::int64_t step) {
    if (p.keep_means) {
      landscape.reshape([&] {
        restore_means(cells, target, land, ground.held, elevation_m, done.raised_m);
        return true;
      });
    }
    advance(static_cast<double>(step + 1) / static_cast<double>(law.steps));
  };
  wear_down(law, {.route = route, .after = restore}, landscape);
  done.lowered_m = landscape.take_records().lowered_m;
  return done;
}

}  // namespace geo
