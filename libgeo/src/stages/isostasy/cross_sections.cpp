#include <algorithm>
#include <cmath>

#include "geo/kernels/shapes.hpp"
#include "geo/kernels/smoothing.hpp"
#include "swell.hpp"
#include "tectonics.hpp"

namespace geo {

void cut_sections(const Crust& crust, const CoarseGrid& coarse, Tectonics& t) {
  const IsostasyParameters& p = crust.parameters;
  const Grid& grid = coarse.grid();
  const auto swell_of = [&](std::string_view stream, double wavelength_km, int octaves,
                            double gain) {
    return Swell(crust.seed, stream, crust.radius_km, wavelength_km, octaves, gain);
  };
  const Swell along = swell_of("isostasy.belts", 1100.0, 3, 0.6);
  const Swell shift = swell_of("isostasy.belt_shift", 700.0, 3, 0.6);
  const Swell noise = swell_of("isostasy.thickness", 3200.0, 4, 0.55);
  const Swell swell = swell_of("isostasy.swells", 2600.0, 5, 0.6);
  const Swell floor = swell_of("isostasy.ocean_swells", 2800.0, 4, 0.55);
  const Swell suture = swell_of("isostasy.sutures", 4200.0, 4, 0.5);
  const Swell worn = swell_of("isostasy.worn", 2000.0, 3, 0.6);
  for (auto* field : {&t.thickening, &t.arc, &t.trench_m, &t.thickness_noise_km, &t.swell_m,
                      &t.ocean_swell, &t.relict}) {
    field->assign(grid.size(), 0.0F);
  }
#pragma omp parallel for schedule(dynamic, 8)
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const Index cell = grid.cell(i, j);
      const auto at = grid.unit_vector(i, j);
      t.ocean_swell[cell] = static_cast<float>(floor(at));
      t.thickness_noise_km[cell] = static_cast<float>(p.thickness_noise_km * noise(at));
      // Plateaus stand further above the middle of continents than basins lie below it.
      const double up = std::exp(0.6 * swell(at)) - std::exp(0.18);
      t.swell_m[cell] = static_cast<float>(p.swell_m * up / 0.8);
      const double age = smooth_step(-0.4, 1.2, worn(at));
      t.relict[cell] = static_cast<float>(age * bell(suture(at), 0.0, 0.16));
      const double straight_km = t.margins.across_km[cell], far = std::abs(straight_km);
      if (far > 2500.0) continue;
      const double across = straight_km + 55.0 * shift(at) * smooth_step(40, 200, far);
      const double strength =
          std::clamp(t.margins.strength[cell] * (1.0 + 0.35 * along(at)), 0.05, 1.3);
      switch (t.margins.kind[cell]) {
        case Convergence::oceans:
          t.arc[cell] = static_cast<float>(island_arc(across, strength));
          t.trench_m[cell] = static_cast<float>(trench_m(straight_km, strength));
          break;
        case Convergence::ocean_continent:
          t.thickening[cell] = static_cast<float>(andean_thickening(across, strength));
          t.trench_m[cell] = static_cast<float>(trench_m(straight_km, strength));
          break;
        case Convergence::continents:
          t.thickening[cell] = static_cast<float>(himalayan_thickening(across, strength));
          break;
        default:
          break;
      }
    }
  }
  smooth(grid, t.thickening, 2e3 * p.deformation_smoothing_km);
  smooth(grid, t.arc, 0.7e3 * p.deformation_smoothing_km);
  smooth(grid, t.trench_m, 0.6e3 * p.deformation_smoothing_km);
  t.convergent = t.thickening;
  for (Index cell = 0; cell < grid.size(); ++cell) t.convergent[cell] += t.arc[cell];
}

}  // namespace geo
