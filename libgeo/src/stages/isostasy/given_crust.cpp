#include "given_crust.hpp"

#include <algorithm>
#include <vector>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/remapping/cubic_rows.hpp"

namespace geo {

void take_given_crust(const Crust<float>& crust, const CoarseGrid& coarse,
                      const Tectonics<float>& tectonics) {
  const Grid& grid = crust.grid;
  const CubicRows rows(coarse.grid(), grid);
  const auto& densities = crust.parameters.density;
  ParallelErrors errors;
#pragma omp parallel
  {
    std::vector<float> scratch;
#pragma omp for schedule(static)
    for (int j = 0; j < grid.ny(); ++j) {
      errors.guard([&] {
        const Index first = grid.cell(0, j);
        const auto read = [&](const std::vector<float>& from, std::span<float> to) {
          const auto line = to.subspan(first, grid.nx());
          rows.read(from, j, line, scratch);
          for (float& value : line) value = std::clamp(value, 0.0F, 1.0F);
        };
        read(tectonics.thickening, crust.convergent);
        read(tectonics.divergent, crust.divergent);
        read(tectonics.transform, crust.transform);
        read(tectonics.weakness, crust.weakness);
        for (Index cell = first; cell < first + grid.nx(); ++cell) {
          crust.elevation_m[cell] = crust.in.made_elevation_m[cell];
          if (crust.in.has_density) continue;
          crust.density[cell] = static_cast<float>(
              densities.oceanic_crust +
              (densities.continental_crust - densities.oceanic_crust) * crust.fraction[cell]);
        }
      });
    }
  }
  errors.rethrow();
}

}  // namespace geo
