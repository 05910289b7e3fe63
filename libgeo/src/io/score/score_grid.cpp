#include "score_grid.hpp"

#include <cmath>

#include "geo/kernels/remapping/resample.hpp"

namespace geo::io {

CoarseField coarsen(const State& state, const Field<float>& spec, double step_deg) {
  const auto values = state.read(spec);
  const Grid& own = state.grid();
  const int ny = static_cast<int>(std::lround(180.0 / step_deg));
  if (own.ny() <= ny || own.nx() <= 2 * ny) {
    return {state.shared_grid(), {values.begin(), values.end()}};
  }
  CoarseField coarse{std::make_shared<const Grid>(Grid::sphere(2 * ny, ny, own.figure())), {}};
  coarse.values.resize(coarse.grid->size());
  resample_raster(raster_of(own), values, raster_of(*coarse.grid), coarse.values, own.figure());
  return coarse;
}

}  // namespace geo::io
