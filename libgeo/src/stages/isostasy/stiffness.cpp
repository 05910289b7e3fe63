#include "geo/stages/isostasy/stiffness.hpp"

#include "blueprint_crust.hpp"
#include "geo/kernels/remapping/cubic_rows.hpp"

namespace geo {

void stiffen_blueprint(const Crust<float>& crust, const CoarseGrid& coarse) {
  if (!is_stiff(crust.parameters)) return;
  auto local = coarse.middle(std::span<const float>(crust.thickness_m));
  const auto density = coarse.middle(std::span<const float>(crust.density));
  for (std::size_t cell = 0; cell < local.size(); ++cell) {
    local[cell] *= density[cell] / static_cast<float>(crust.parameters.density.mantle);
  }
  const std::vector<float> held = held_up_m(crust, coarse.grid(), local, /*infill=*/0.0);
  const Grid& grid = crust.grid;
  const CubicRows rows(coarse.grid(), grid);
  std::vector<float> line(grid.nx()), scratch;
  for (int j = 0; j < grid.ny(); ++j) {
    rows.read(held, j, std::span<float>(line), scratch);
    for (int i = 0; i < grid.nx(); ++i) crust.elevation_m[grid.cell(i, j)] += line[i];
  }
}

}  // namespace geo
