#include "geo/kernels/remapping/catmull_rom.hpp"

#include <algorithm>
#include <cmath>

#include "geo/core/error.hpp"
#include "geo/kernels/remapping/cubic_weights.hpp"

namespace geo {
CatmullRom::CatmullRom(const Grid& planet, Centre position)
    : columns(planet.nx()), half_round(planet.nx() / 2) {
  if (planet.topology() != Topology::sphere) {
    throw InputError("bicubic sampling needs a whole planet, this grid is a part of one");
  }
  const int nx = planet.nx(), ny = planet.ny();
  const double x = (position.longitude_deg + 180.0) / 360.0 * nx - 0.5;
  const double y = (position.latitude_deg + 90.0) / 180.0 * ny - 0.5;
  const double x0 = std::floor(x), y0 = std::floor(y);
  column_weight = cubic_weights(x - x0);
  row_weight = cubic_weights(y - y0);
  const int west = ((static_cast<int>(x0) - 1) % nx + nx) % nx;
  for (int k = 0; k < 4; ++k) {
    column[k] = west + k < nx ? west + k : west + k - nx;
    const int j = static_cast<int>(y0) - 1 + k;
    crossed[k] = j < 0 || j >= ny;
    row[k] = std::clamp(j < 0 ? -1 - j : j >= ny ? 2 * ny - 1 - j : j, 0, ny - 1);
  }
  const int nearest_row = std::clamp(static_cast<int>(std::floor(y + 0.5)), 0, ny - 1);
  nearest_ = planet.cell(column[std::floor(x + 0.5) == x0 ? 1 : 2], nearest_row);
}

}  // namespace geo
