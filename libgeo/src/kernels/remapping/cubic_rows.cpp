#include "geo/kernels/remapping/cubic_rows.hpp"

#include <cmath>

#include "geo/core/error.hpp"
#include "geo/kernels/remapping/cubic_weights.hpp"

namespace geo {

CubicRows::CubicRows(const Grid& from, const Grid& to)
    : nx_(from.nx()),
      ny_(from.ny()),
      columns_(stencils(from.nx(), to.nx())),
      rows_(stencils(from.ny(), to.ny())) {
  if (from.topology() != Topology::sphere || to.topology() != Topology::sphere) {
    throw InputError("cubic rows: both grids must be whole spheres");
  }
}

std::vector<CubicRows::Stencil> CubicRows::stencils(int from, int to) {
  std::vector<Stencil> all(to);
  for (int k = 0; k < to; ++k) {
    const double position = (k + 0.5) * from / to - 0.5;
    const double floor = std::floor(position);
    const auto t = static_cast<float>(position - floor);
    all[k].first = static_cast<int>(floor) - 1;
    all[k].weight = cubic_weights(t);
  }
  return all;
}

}  // namespace geo
