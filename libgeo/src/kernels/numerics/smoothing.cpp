#include "geo/kernels/numerics/smoothing.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/numerics/diffusion.hpp"
#include "geo/kernels/remapping/conservative_remapping.hpp"

namespace geo {
namespace {

template <class Real>
void smooth_in(const Grid& grid, std::span<Real> field, double length_m,
               std::span<const std::uint8_t> mask) {
  if (!(length_m >= 0.0 && std::isfinite(length_m))) {
    throw InputError("smoothing: length of " + std::to_string(length_m) +
                     " m must be finite and not negative");
  }
  DiffusionOptions options;
  options.substeps = !mask.empty() && grid.is_latitude_longitude() ? 8 : 4;
  std::vector<std::uint8_t> excluded(mask.size());
  for (std::size_t c = 0; c < mask.size(); ++c) excluded[c] = mask[c] == 0;
  options.excluded = excluded;
  diffuse(grid, field, 0.5 * length_m * length_m, 1.0, options);
}

}  // namespace

void smooth(const Grid& grid, std::span<float> field, double length_m,
            std::span<const std::uint8_t> mask) {
  smooth_in(grid, field, length_m, mask);
}
void smooth(const Grid& grid, std::span<double> field, double length_m,
            std::span<const std::uint8_t> mask) {
  smooth_in(grid, field, length_m, mask);
}

void smooth_broadly(const Grid& grid, std::span<float> field, double length_m) {
  constexpr double kCellsPerLength = 5.0, kWorthwhile = 2.0;
  const double spacing_m = length_m / kCellsPerLength;
  if (spacing_m < kWorthwhile * grid.face_east_m(grid.ny() / 2)) {
    return smooth(grid, field, length_m);
  }
  const Grid coarse = coarser_grid(grid, spacing_m);
  const ConservativeRemapping remapping(grid, coarse);
  std::vector<float> mean(coarse.size());
  remapping.average(field, mean);
  // A box of one cell, and a spline of four.
  const double cell_m = coarse.face_east_m(coarse.ny() / 2);
  const double added_m2 = (1.0 + 4.0) / 12.0 * cell_m * cell_m;
  smooth(coarse, mean, std::sqrt(length_m * length_m - added_m2));
  const Interpolator smoothed(remapping, mean);
  ParallelErrors errors;
#pragma omp parallel
  {
    auto scratch = errors.make<std::vector<float>>(smoothed.scratch_size());
#pragma omp for schedule(static)
    for (int j = 0; j < grid.ny(); ++j) {
      if (errors.any()) continue;
      smoothed.row(j, field.subspan(grid.cell(0, j), grid.nx()), scratch);
    }
  }
  errors.rethrow();
}
void smooth_broadly(const Grid& grid, std::span<double> field, double length_m) {
  smooth(grid, field, length_m);
}

}  // namespace geo
