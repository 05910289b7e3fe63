#include "land_detail.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/exemplars/exemplar_detail.hpp"
#include "geo/kernels/landscape/surface_detail.hpp"
#include "geo/kernels/numerics/shapes.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/kernels/remapping/cubic_rows.hpp"

namespace geo {
namespace {

/// A blur that halves the power of the band's longest waves.
double blur_of(const ExemplarBand& band) { return 0.25 * band.longest_m; }

std::vector<float> smoothed(const Grid& grid, std::vector<float> values, double length_m) {
  smooth(grid, std::span<float>(values), length_m);
  return values;
}

/// Heights of the land, the sea counting as level.
std::vector<float> heights_of(const Crust<float>& crust) {
  std::vector<float> heights(crust.elevation_m.begin(), crust.elevation_m.end());
  for (float& height : heights) height = std::max(height, 0.0F);
  return heights;
}

/// Where detail stands, 0 to 1: on land, and fully where there is little but land around.
std::vector<float> inland(const Crust<float>& crust, double length_m) {
  std::vector<float> share(crust.grid.size());
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < crust.grid.size(); ++cell) {
    share[cell] = crust.elevation_m[cell] >= 0.0F ? 1.0F : 0.0F;
  }
  smooth(crust.grid, std::span<float>(share), length_m);
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < crust.grid.size(); ++cell) {
    const double land = crust.elevation_m[cell] >= 0.0F ? 1.0 : 0.0;
    share[cell] =
        static_cast<float>(land * smooth_step(0.5, 0.85, static_cast<double>(share[cell])));
  }
  return share;
}

/// Squares of what the land has beside the longer waves, by weight.
std::vector<float> squares_of_own(const Crust<float>& crust, std::span<const float> base,
                                  std::span<const float> weight) {
  std::vector<float> squares(crust.grid.size());
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < crust.grid.size(); ++cell) {
    const float own = crust.elevation_m[cell] - base[cell];
    squares[cell] = weight[cell] * own * own;
  }
  return squares;
}

/// Standard deviation of the detail, on the grid of `heights`, which hold the longer waves alone:
/// so many times that of the waves it replaces, whose squares are `own`, or that of waves up to
/// twice as long gone on with by the law of the band, whichever is larger.
std::vector<float> deviation_of(const IsostasyParameters& p, const Grid& grid,
                                const ExemplarBand& band, const std::vector<float>& heights,
                                const std::vector<float>& own, const std::vector<float>& land) {
  // Of the octave of waves up to twice the longest; blurs add up by their squares.
  const std::vector<float> longer = smoothed(grid, heights, std::sqrt(3.0) * blur_of(band));
  std::vector<float> power(heights.size());
  for (std::size_t c = 0; c < power.size(); ++c) {
    power[c] = static_cast<float>(std::pow(heights[c] - longer[c], 2.0));
  }
  const double around_m = 0.5 * band.longest_m;
  smooth(grid, std::span<float>(power), around_m);
  const std::vector<float> replaced = smoothed(grid, own, around_m);
  const std::vector<float> whole = smoothed(grid, land, around_m);

  const double gain2 = std::exp2(-2.0 * band.hurst);
  const double amplitude2 = p.detail_amplitude * p.detail_amplitude;
  const double law2 = gain2 / (1.0 - gain2);
  constexpr double kOfHeight = 0.25;
  std::vector<float> deviation(heights.size());
  for (std::size_t c = 0; c < deviation.size(); ++c) {
    const double replaced2 = amplitude2 * std::max(0.0F, replaced[c]) / std::max(1e-3F, whole[c]);
    const double expected2 = law2 * std::max(0.0F, power[c]);
    const double wanted = std::sqrt(std::max(replaced2, expected2));
    const double most = kOfHeight * std::max(1.0F, heights[c]);
    deviation[c] = static_cast<float>(wanted / std::hypot(1.0, wanted / most));
  }
  return deviation;
}

std::vector<float> unit_detail(const Crust<float>& crust, const CoarseGrid& coarse,
                               const Orogens& orogens, const ExemplarLibrary& library,
                               const ExemplarBand& band, const std::vector<float>& heights,
                               std::span<const float> inland) {
  // Belts are seldom folded quite along themselves, but ranges are what makes a belt.
  constexpr double kLevelWeight = 2.0;
  const IsostasyParameters& p = crust.parameters;
  const auto seen = [&]<class T>(std::span<const T> field) {
    return field.empty() ? std::vector<T>{} : coarse.middle(field);
  };
  const auto type = seen(orogens.type);
  const auto age = seen(orogens.age_myr), east = seen(orogens.fold_east),
             north = seen(orogens.fold_north);
  std::vector<std::uint8_t> wanted(inland.size());
  std::transform(inland.begin(), inland.end(), wanted.begin(),
                 [](float weight) { return weight > 0.0F ? 1 : 0; });
  std::vector<float> detail(crust.grid.size());
  exemplar_detail_on_sphere(
      crust.grid, wanted, coarse.grid(),
      {heights, type, age, east, north, p.old_orogeny_myr, p.plain_slope, kLevelWeight}, library,
      band, crust.seed, detail);
  return detail;
}

}  // namespace

void detail_land(const Crust<float>& crust, const CoarseGrid& coarse, const Orogens& orogens,
                 const ExemplarLibrary& library) {
  const Grid& grid = crust.grid;
  const ExemplarBand band = planetary_band(library, 1e3 * crust.parameters.detail_longest_km);
  const std::vector<float> weight = inland(crust, 0.5 * blur_of(band));
  const std::vector<float> base = smoothed(grid, heights_of(crust), blur_of(band));
  const std::vector<float> seen = coarse.middle(std::span<const float>(base));
  std::vector<float> detail = unit_detail(crust, coarse, orogens, library, band, seen, weight);
  const std::vector<float> deviation =
      deviation_of(crust.parameters, coarse.grid(), band, seen,
                   coarse.middle(std::span<const float>(squares_of_own(crust, base, weight))),
                   coarse.middle(std::span<const float>(weight)));

  // What detail changes: the mean of it is taken out again.
  std::vector<float> change(grid.size());
  const CubicRows rows(coarse.grid(), grid);
  ParallelErrors errors;
#pragma omp parallel
  {
    auto line = errors.make<std::vector<float>>(grid.nx());
    std::vector<float> scratch;
#pragma omp for schedule(static)
    for (int j = 0; j < grid.ny(); ++j) {
      errors.guard([&] {
        rows.read(deviation, j, std::span<float>(line), scratch);
        for (int i = 0; i < grid.nx(); ++i) {
          const Index cell = grid.cell(i, j);
          detail[cell] *= std::max(0.0F, line[i]);
          const float own = crust.elevation_m[cell] - base[cell];
          change[cell] = weight[cell] * (detail[cell] - own);
        }
      });
    }
  }
  errors.rethrow();
  const std::vector<float> mean = smoothed(grid, std::move(change), 2.0 * blur_of(band));
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const double w = weight[cell];
    if (w <= 0.0) continue;
    float& z = crust.elevation_m[cell];
    const double smooth_m = z - w * (z - base[cell]);
    z = static_cast<float>(
        std::max(0.0, with_detail(smooth_m, w * (detail[cell] - mean[cell]), 1.0)));
  }
}

}  // namespace geo
