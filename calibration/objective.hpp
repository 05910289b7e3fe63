#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/model.hpp"
#include "calibration/ranking.hpp"
#include "calibration/seed_planet.hpp"
#include "calibration/settings.hpp"
#include "calibration/target.hpp"

namespace geo::calibration {

/// One free parameter and the scale on which it is fitted: x = ln(value) where its range is
/// positive, else x = value / scale.
struct FreeParameter {
  Parameter declaration;  ///< bound to the model
  double low = 0.0, high = 0.0;
  bool logarithmic = false;
  double scale = 1.0;
  std::optional<Estimate> prior{};

  [[nodiscard]] double to_x(double value) const;
  [[nodiscard]] double to_value(double x) const;
  /// d value / d x.
  [[nodiscard]] double rate(double x) const;
};

/// A further figure to match.
struct Term {
  enum class Kind { land_fraction, water_volume, erosion_rate, concavity, crust_thickness };
  Kind kind;
  double share = 0.0;  ///< of crust_thickness
  Estimate target;
  std::string units;
};

/// What is to be fitted to what.
struct Problem {
  Model model;
  std::vector<FreeParameter> free;
  std::vector<Term> terms;
  Target target;
  bool every_seed = false;

  /// Reads free parameters, bounds, priors and terms. Throws ConfigurationError.
  Problem(std::span<const Parameter> configuration, const Settings& settings, Target target);
  Problem(const Problem&) = delete;
  Problem& operator=(const Problem&) = delete;

  void set(const Eigen::VectorXd& x);
  [[nodiscard]] Eigen::VectorXd present() const;
  /// Quantiles and terms of one planet.
  [[nodiscard]] std::size_t statistics() const { return target.share.size() + terms.size(); }
  [[nodiscard]] double deviation(std::size_t statistic) const;
  /// Standard deviation to which it is known; 0 where the target does not say.
  [[nodiscard]] double error(std::size_t statistic) const;
  [[nodiscard]] double aim(std::size_t statistic) const;
};

/// Planets of several seeds and how far they are from the target.
class Objective {
 public:
  /// Grows the plates of all seeds.
  Objective(Problem& problem, std::span<const Parameter> configuration,
            std::span<const std::int64_t> seeds, int nx, int ny,
            const std::atomic<bool>* stop = nullptr);

  [[nodiscard]] Eigen::Index residuals() const;
  /// Variance of each residual that what is known of errors gives: of the target's quantiles where
  /// it says, of terms and of priors. All planets share the error of a quantile.
  [[nodiscard]] Eigen::VectorXd known_variance() const;
  /// Root mean square misfit of the quantiles, m, of residuals.
  [[nodiscard]] double misfit_m(const Eigen::VectorXd& residual) const;
  /// Residuals with everything rerouted, which is then frozen.
  Eigen::VectorXd evaluate(const Eigen::VectorXd& x);
  /// Residuals with drainage frozen as the last `evaluate` left it, and their derivatives if asked
  /// for.
  Eigen::VectorXd linearise(const Eigen::VectorXd& x, Eigen::MatrixXd* jacobian = nullptr);

  /// Of the last `evaluate`, for each seed: statistics, and means of kFineBins bins.
  [[nodiscard]] const std::vector<std::vector<double>>& statistics() const { return statistics_; }
  [[nodiscard]] const std::vector<std::vector<double>>& fine_bins() const { return fine_bins_; }
  /// Mean Wasserstein-1 distance from the target of the last `evaluate`, m.
  [[nodiscard]] double distance_m() const;
  /// Derivatives of each seed's statistics by x, of the last `linearise` with a Jacobian.
  [[nodiscard]] const std::vector<Eigen::MatrixXd>& seed_jacobians() const { return rates_; }
  [[nodiscard]] const std::vector<std::unique_ptr<SeedPlanet>>& planets() const { return planets_; }

  [[nodiscard]] int forward_runs() const { return forward_runs_; }
  [[nodiscard]] int jacobians() const { return jacobians_; }
  [[nodiscard]] double forward_seconds() const { return forward_seconds_; }
  [[nodiscard]] double jacobian_seconds() const { return jacobian_seconds_; }

 private:
  /// What the statistics of one planet are taken from between two routings.
  struct Held {
    std::optional<Ranking> elevation, thickness;
    std::vector<Ranking::Window> windows;  ///< one for each quantile
    struct OfTerm {
      Ranking::Window window;
      double value = 0.0, mean = 0.0, rate = 0.0;
    };
    std::vector<OfTerm> terms;
    std::vector<Index> channels;
  };
  template <class Work>
  void for_seeds(Work&& work);
  void hold(std::size_t seed, const PlanetSurface<double>& surface);
  template <class V>
  [[nodiscard]] std::vector<V> statistics_of(std::size_t seed,
                                             const PlanetSurface<V>& surface) const;
  template <class V>
  [[nodiscard]] V concavity(std::size_t seed, const std::vector<V>& elevation_m) const;
  [[nodiscard]] Eigen::VectorXd residuals_of(const std::vector<std::vector<double>>& statistics,
                                             const Eigen::VectorXd& x) const;

  Problem& problem_;
  const std::atomic<bool>* stop_;
  std::vector<std::unique_ptr<SeedPlanet>> planets_;
  std::vector<Held> held_;
  std::vector<std::vector<double>> statistics_, fine_bins_;
  std::vector<Eigen::MatrixXd> rates_;
  int forward_runs_ = 0, jacobians_ = 0;
  double forward_seconds_ = 0.0, jacobian_seconds_ = 0.0;
};

}  // namespace geo::calibration
