#pragma once

#include <span>
#include <string>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/core/planet.hpp"

namespace geo::calibration {

inline constexpr int kFineBins = 1000;

/// A hypsometry to be matched: elevations by the share of the area that lies lower.
struct Target {
  std::string name;
  std::vector<double> share;        ///< ascending, within (0, 1)
  std::vector<double> elevation_m;  ///< of these quantiles
  /// Standard deviation of each that the fit asks for: residuals are counted in it.
  std::vector<double> deviation_m;
  /// Standard deviation that each is known to; empty where the target does not say.
  std::vector<double> error_m;
  std::vector<double> fine_bin_m;  ///< means of kFineBins bins of equal area, for distances
  /// The part of the area that the target tells of: nothing is compared beyond.
  double share_from = 0.0, share_to = 1.0;

  /// The fine bins within that part; those that it touches where it holds none.
  [[nodiscard]] int first_bin() const;
  [[nodiscard]] int end_bin() const;
};

/// How finely and how exactly a curve is to be matched: at `bins` shares of the area, in height to
/// `deviation_m` and in area to `share` of the planet, whichever is coarser there: the few deepest
/// and highest places and the narrow continental slope say less about heights than plains do.
struct Accuracy {
  int bins = 100;
  double deviation_m = 50.0, share = 0.005;
  double error_m = 0.0;  ///< that all quantiles are known to; 0: not known
};

/// Reads a target: "earth" (ETOPO5), "earth-statistical" (two normal distributions), a CSV file, or
/// FILE.nc[:VARIABLE], any elevation model that `terrane run --dem` reads, of any planet.
/// A CSV file (geo/io/input/table.hpp) has one of these headers:
///   quantile,elevation_m            shares strictly ascending within [0, 1]; elevations must not
///                                   fall; all rows are matched, and nothing beyond them
///   quantile,elevation_m,sigma_m    the same with the error of each, to which it is matched
///   lower_m,upper_m,fraction        bins side by side, upwards; fractions sum to 1
/// An elevation model is averaged onto `grid` by area when it is finer and covers the sphere, so
/// that both distributions are of cells of the same size. Other targets than rows of quantiles are
/// matched at the middles of `bins` equal parts of the area; extremes (0 and 1) are never.
/// Deviations and errors are those of `accuracy` for every kind of target but a table with sigma_m.
/// Throws InputError that names file and line, IoError.
Target read_target(const std::string& name_or_file, const Planet& planet, const Grid& grid,
                   const Accuracy& accuracy);

/// Wasserstein-1 distance from a target of a distribution by its fine bins, m, over the part of the
/// area that the target tells of.
[[nodiscard]] double wasserstein_m(std::span<const double> fine_bins, const Target& target);
/// How far apart the distributions of several planets lie there, m: the standard deviation over
/// planets of each bin's elevation, mean over the bins. NaN for fewer than two planets.
[[nodiscard]] double spread_m(const std::vector<std::vector<double>>& fine_bins,
                              const Target& target);

}  // namespace geo::calibration
