#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// HEALPix (Gorski et al. 2005): 12 nside² pixels of the same area over a planet, in nested order.
/// On an ellipsoid pixels lie by authalic latitude, so that their areas are the same there too.
class Healpix {
 public:
  static constexpr int kLargestSide = 8192;

  /// `nside` is a power of two up to kLargestSide, else ConfigurationError.
  explicit Healpix(int nside);

  [[nodiscard]] int nside() const noexcept { return nside_; }
  [[nodiscard]] std::int32_t size() const noexcept { return 12 * nside_ * nside_; }
  /// Centre of a pixel on the unit sphere: sine of its (authalic) latitude, longitude within
  /// 0 and 2 pi.
  struct Position {
    double sine, longitude_rad;
  };
  [[nodiscard]] Position centre(std::int32_t pixel) const;

  /// The largest nside whose pixels are not smaller than the cells of a planet's equator.
  static int side_like(const Grid& planet);

 private:
  int nside_;
};

/// Fields of a planet's grid on the pixels of HEALPix. What each pixel has of each cell is exact:
/// edges of pixels are curves of longitude by sine of latitude whose integrals are known, so sums
/// of value times area are those of the grid (conservative to round-off). Cost: linear in cells and
/// pixels.
class HealpixRemapping {
 public:
  /// Throws InputError unless `planet` is a sphere.
  HealpixRemapping(const Grid& planet, const Healpix& pixels);

  /// Mean by area; cells that are NaN have no say, pixels without any other are NaN. `mean` holds
  /// one value per pixel.
  void mean(std::span<const float> values, std::span<float> mean) const;
  /// The value that covers most of each pixel, of equals the smallest.
  void dominant(std::span<const std::int32_t> values, std::span<std::int32_t> result) const;

 private:
  template <class Visit>
  void for_overlaps(std::int32_t pixel, const Visit& visit) const;

  Healpix pixels_;
  int nx_, ny_;
  std::vector<double> row_edge_;  ///< sines of authalic latitude, ny + 1
};

}  // namespace geo
