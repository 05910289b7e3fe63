#pragma once

#include <string>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/core/planet.hpp"

namespace geo::calibration {

/// A hypsometry to be matched: elevations by the share of the area that lies lower.
struct Target {
  std::string name;
  std::vector<double> share;        ///< ascending, within (0, 1)
  std::vector<double> elevation_m;  ///< of these quantiles
  std::vector<double> deviation_m;  ///< standard deviation of each; empty when not given
  std::vector<double> fine_bin_m;   ///< means of kFineBins bins of equal area, for distances
};

/// How finely and how exactly a curve is to be matched: at `bins` shares of the area, in height to
/// `deviation_m` and in area to `share` of the planet, whichever is coarser there: the few deepest
/// and highest places and the narrow continental slope say less about heights than plains do.
struct Accuracy {
  int bins = 100;
  double deviation_m = 50.0, share = 0.005;
};

inline constexpr int kFineBins = 1000;

/// Reads a target: "earth" (ETOPO5), "earth-statistical" (two normal distributions), a CSV file, or
/// FILE.nc[:VARIABLE], any relief that `terrane run --dem` reads, of any planet.
/// A CSV file begins with one of these lines:
///   quantile,elevation_m            shares strictly ascending within [0, 1]; all rows are matched
///   quantile,elevation_m,sigma_m    the same with a standard deviation each
///   lower_m,upper_m,fraction        bins side by side, upwards; fractions sum to 1
/// A relief is averaged onto `grid` by area when it is finer and covers the sphere, so that both
/// distributions are of cells of the same size. Other targets than rows of quantiles are matched
/// at the middles of `bins` equal parts of the area; extremes (0 and 1) are never.
/// Rows of a table without deviations have none; all others get those of `accuracy`.
/// Throws InputError that names file and line, IoError.
Target read_target(const std::string& name_or_file, const Planet& planet, const Grid& grid,
                   const Accuracy& accuracy);

}  // namespace geo::calibration
