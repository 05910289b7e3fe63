#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "geo/io/run/manifest.hpp"

namespace geo::calibration {

/// A hypsometric curve by its K equal-area bins: `elevation_m[k]` is the mean elevation of the
/// cells whose share of the area below lies within the kth part of `share_from` to `share_to`.
struct Curve {
  std::vector<double> elevation_m;
  double share_from = 0.0, share_to = 1.0;  ///< the part of the area that the bins share out

  /// Share of the area below the middle of bin k.
  [[nodiscard]] double share(std::size_t k) const {
    return share_from + (static_cast<double>(k) + 0.5) / static_cast<double>(elevation_m.size()) *
                            (share_to - share_from);
  }
  [[nodiscard]] bool is_whole() const { return share_from <= 0.0 && share_to >= 1.0; }
};

/// One free parameter, before and after.
struct FittedParameter {
  std::string name, units, doc;
  double start = 0.0, fitted = 0.0;
  double low = 0.0, high = 0.0;  ///< bounds of the fit
  bool logarithmic = false;      ///< fitted on a log scale
  bool at_bound = false;
  double prior_mean = 0.0, prior_deviation = 0.0;  ///< deviation 0: no prior
  double standard_error = 0.0;                     ///< from the residuals; NaN where not determined
  double seed_error = 0.0;  ///< from the spread of the seeds; NaN with fewer than three seeds
};

/// One statistic that the fit aims at.
struct Residual {
  std::string name;  ///< "hypsometry 37", or the name of a further term
  std::string units;
  double share = 0.0;  ///< middle of the bin, 0 to 1; NaN for further terms
  double target = 0.0, before = 0.0, after = 0.0;
  double deviation = 0.0;  ///< what one unit of misfit is, in these units
};

/// How one planet compares with the target.
struct SeedMisfit {
  std::int64_t seed = 0;
  double before_m = 0.0, after_m = 0.0;  ///< Wasserstein-1 distance of the elevations
};

/// One outer step: drainage rerouted, a few steps with it frozen, judged rerouted.
struct Iteration {
  int start = 0;  ///< which starting point
  int number = 0;
  double cost = 0.0;  ///< half the sum of squares, of what is kept after this step
  double wasserstein_m = 0.0;
  double step = 0.0;  ///< largest change of a parameter, in units of its scale
  bool accepted = false;
  double seconds = 0.0;
  std::vector<double> values;  ///< of the parameters, at the end of the step
};

/// A combination of parameters (on their scales) and how well the data determine it.
struct Direction {
  double singular_value = 0.0;
  std::vector<double> weights;  ///< one for each parameter, of unit length
};

/// The cost at values of one parameter, at each of which all others were fitted again.
struct Profile {
  std::string name;
  std::vector<double> value, cost;
  std::vector<std::vector<double>> fitted;  ///< values of all parameters at each
};

/// How far apart the curves of planets of several seeds lie, m; NaN for a single one.
struct SeedSpread {
  double before_m = std::numeric_limits<double>::quiet_NaN();
  double after_m = std::numeric_limits<double>::quiet_NaN();
};

/// The result of one starting point.
struct Start {
  std::vector<double> from, to;
  double cost = 0.0;
  bool converged = false;
  int iterations = 0;
  std::string ending;  ///< why it ended
};

/// All that a calibration found.
struct Result {
  std::string target_name, preset_or_config, grid, held_out_grid;
  std::string objective;  ///< "mean": curve of the mean over seeds; "each": every seed's own
  bool converged = false;
  std::string ending;  ///< why it ended, one sentence
  std::vector<std::string> warnings;

  std::vector<FittedParameter> parameters;
  std::vector<std::vector<double>> correlation;
  std::vector<Residual> residuals;
  std::vector<Iteration> iterations;
  std::vector<Start> starts;
  std::vector<Direction> directions;  ///< stiffest first
  double condition = 0.0;             ///< of the scaled Jacobian
  std::vector<Profile> profiles;

  Curve target, before, after;  ///< means over the fitted seeds
  std::vector<SeedMisfit> fitted, held_out, held_out_resolution;
  SeedSpread fitted_spread, held_out_spread, held_out_resolution_spread;
  double cost_before = 0.0, cost_after = 0.0;
  double noise_m = 0.0;  ///< deviation of one quantile as the residuals show it
  double seconds = 0.0;
  std::vector<io::Builder> builders;  ///< of terrane, that made it, the last one last
  int forward_runs = 0, jacobians = 0;
  double seconds_per_forward = 0.0, seconds_per_jacobian = 0.0, profile_seconds = 0.0;
};

/// Whether planets of different seeds have become alike: their curves lie less than half as far
/// apart as before.
[[nodiscard]] bool has_collapsed(const SeedSpread& spread);

[[nodiscard]] double mean_before_m(const std::vector<SeedMisfit>& seeds);
[[nodiscard]] double mean_after_m(const std::vector<SeedMisfit>& seeds);

}  // namespace geo::calibration
