#include "geo/kernels/smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/kernels/diffusion.hpp"
#include "geo/kernels/overlay.hpp"
#include "tridiagonal.hpp"

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

template <class Real>
void smooth_slivers_in(const Grid& grid, std::span<Real> field,
                       std::span<const std::uint8_t> fixed) {
  if (grid.topology() != Topology::sphere) return;
  constexpr double kShare = 0.3;
  constexpr int kLanes = TridiagonalBlock::kLanes;
  struct Sliver {
    Index begin;
    double exchange;
  };
  std::vector<Sliver> slivers;
  for (int j = 0; j < grid.ny(); ++j) {
    const double width = grid.spacing_east_m(j), height = grid.face_east_m(j);
    const double variance_m2 = kShare * (height * height - 4.0 * width * width);
    if (variance_m2 > 0.0)
      slivers.push_back({grid.cell(0, j), 0.5 * variance_m2 / (width * width)});
  }
  const int nx = grid.nx(), count = static_cast<int>(slivers.size());
#pragma omp parallel
  {
    TridiagonalBlock system(nx, /*periodic=*/true);
    std::vector<double> value(std::size_t(nx) * kLanes);
#pragma omp for schedule(static)
    for (int first = 0; first < count; first += kLanes) {
      const int width = std::min(kLanes, count - first);
      for (int k = 0; k < kLanes; ++k) {
        // Lanes beyond the last row repeat it.
        const auto [begin, exchange] = slivers[first + std::min(k, width - 1)];
        const auto wall = [&](int i) { return fixed[begin + i] != 0; };
        for (int i = 0; i < nx; ++i) {
          const int west = i > 0 ? i - 1 : nx - 1, east = i + 1 < nx ? i + 1 : 0;
          system.lower(i)[k] = wall(i) || wall(west) ? 0.0 : exchange;
          system.upper(i)[k] = wall(i) || wall(east) ? 0.0 : exchange;
          value[std::size_t(i) * kLanes + k] = field[begin + i];
        }
      }
      system.factorise();
      system.solve(value.data());
      for (int k = 0; k < width; ++k) {
        const Index begin = slivers[first + k].begin;
        for (int i = 0; i < nx; ++i) {
          if (fixed[begin + i] != 0) continue;
          field[begin + i] = static_cast<Real>(value[std::size_t(i) * kLanes + k]);
        }
      }
    }
  }
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
  const Overlay overlay(grid, coarse);
  std::vector<float> mean(coarse.size());
  overlay.average(field, mean);
  // A box of one cell, and a spline of four.
  const double cell_m = coarse.face_east_m(coarse.ny() / 2);
  const double added_m2 = (1.0 + 4.0) / 12.0 * cell_m * cell_m;
  smooth(coarse, mean, std::sqrt(length_m * length_m - added_m2));
  const Interpolator smoothed(overlay, mean);
#pragma omp parallel
  {
    std::vector<float> scratch(smoothed.scratch_size());
#pragma omp for schedule(static)
    for (int j = 0; j < grid.ny(); ++j) {
      smoothed.row(j, field.subspan(grid.cell(0, j), grid.nx()), scratch);
    }
  }
}
void smooth_broadly(const Grid& grid, std::span<double> field, double length_m) {
  smooth(grid, field, length_m);
}

void smooth_slivers(const Grid& grid, std::span<float> field, std::span<const std::uint8_t> fixed) {
  smooth_slivers_in(grid, field, fixed);
}
void smooth_slivers(const Grid& grid, std::span<double> field,
                    std::span<const std::uint8_t> fixed) {
  smooth_slivers_in(grid, field, fixed);
}

}  // namespace geo
