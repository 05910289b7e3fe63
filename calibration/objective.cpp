#include "calibration/objective.hpp"

#include <ceres/jet.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/water/receiver_distance.hpp"

namespace geo::calibration {
namespace {

constexpr int kTogether = 8;  // derivatives carried at once
using Jet = ceres::Jet<double, kTogether>;

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Half the distance to the nearest other quantile, within limits that hold some cells and do not
/// blur the curve.
double half_width(std::span<const double> share, std::size_t k) {
  constexpr double kLeast = 0.0005, kMost = 0.005;
  double gap = 2.0 * std::min(share[k], 1.0 - share[k]);
  if (k > 0) gap = std::min(gap, share[k] - share[k - 1]);
  if (k + 1 < share.size()) gap = std::min(gap, share[k + 1] - share[k]);
  return std::clamp(0.5 * gap, kLeast, kMost);
}

}  // namespace

Objective::Objective(Problem& problem, std::span<const Parameter> configuration,
                     std::span<const std::int64_t> seeds, int nx, int ny,
                     const std::atomic<bool>* stop)
    : problem_(problem), stop_(stop), planets_(seeds.size()), held_(seeds.size()) {
  for_seeds([&](std::size_t s) {
    planets_[s] = std::make_unique<SeedPlanet>(configuration, seeds[s], nx, ny);
  });
}

/// Seeds side by side, each by one thread; a single one by all.
template <class Work>
void Objective::for_seeds(Work&& work) {
  const auto count = static_cast<std::ptrdiff_t>(planets_.size());
  std::vector<ParallelErrors> errors(planets_.size());
#pragma omp parallel for schedule(dynamic, 1) if (count > 1)
  for (std::ptrdiff_t s = 0; s < count; ++s) {
    errors[s].guard([&] {
      if (stop_ != nullptr && stop_->load(std::memory_order_relaxed)) throw Interrupted();
      work(static_cast<std::size_t>(s));
    });
  }
  // Whichever came first in time, it is the first seed's that is told.
  for (const ParallelErrors& of_seed : errors) of_seed.rethrow();
}

void Objective::hold(std::size_t s, const PlanetSurface<double>& surface) {
  const Grid& grid = planets_[s]->grid();
  const Target& target = problem_.target;
  Held& held = held_[s];
  held = {};
  held.elevation.emplace(grid, surface.elevation_m);
  for (std::size_t k = 0; k < target.share.size(); ++k) {
    held.windows.push_back(
        held.elevation->quantile_window(target.share[k], half_width(target.share, k)));
  }
  constexpr double kHalfWidth = 0.005;
  for (const Term& term : problem_.terms) {
    Held::OfTerm of;
    if (term.kind == Term::Kind::land_fraction) {
      const double sea =
          area_sum<double>(grid,
                           [&](Index c) { return surface.elevation_m[c] < 0.0 ? 1.0 : 0.0; }) /
          grid.total_area_m2();
      of.window = held.elevation->window(sea, kHalfWidth);
      of.mean = held.elevation->mean(of.window, std::span<const double>(surface.elevation_m));
      of.value = 1.0 - sea;
      of.rate = held.elevation->density(sea, kHalfWidth);
    } else if (term.kind == Term::Kind::crust_thickness) {
      if (!held.thickness) {
        std::vector<std::uint8_t> continental(grid.size());
        const auto fraction = planets_[s]->continental_fraction();
        for (Index c = 0; c < grid.size(); ++c) continental[c] = fraction[c] >= 0.5F;
        held.thickness.emplace(grid, surface.thickness_m, continental);
      }
      of.window = held.thickness->quantile_window(term.share, kHalfWidth);
    } else if (term.kind == Term::Kind::concavity && !planets_[s]->held().drainage.empty()) {
      constexpr double kCells = 10.0;  // that drain through a channel at least
      const Drainage& drainage = planets_[s]->held().drainage.back();
      for (Index c = 0; c < grid.size(); ++c) {
        const Index to = drainage.graph.receiver[c];
        if (planets_[s]->held().outlets[c] != 0 || to == c) continue;
        if (drainage.area_m2[c] < kCells * grid.area_m2(grid.ny() / 2)) continue;
        if (surface.elevation_m[c] - surface.elevation_m[to] > 1e-3) held.channels.push_back(c);
      }
    }
    held.terms.push_back(of);
  }
}

/// -d ln S / d ln A along the channels, by least squares.
template <class V>
V Objective::concavity(std::size_t s, const std::vector<V>& elevation_m) const {
  using std::log;
  const Held& held = held_[s];
  if (held.channels.size() < 2) return V(0.0);
  const Grid& grid = planets_[s]->grid();
  const Drainage& drainage = planets_[s]->held().drainage.back();
  double mean = 0.0;
  for (const Index c : held.channels) mean += std::log(drainage.area_m2[c]);
  mean /= static_cast<double>(held.channels.size());
  double variance = 0.0;
  V covariance(0.0);
  for (const Index c : held.channels) {
    const Index to = drainage.graph.receiver[c];
    const ReceiverDistance distance(grid, grid.row(c));
    const V slope = (elevation_m[c] - elevation_m[to]) / distance(c, grid.column(c), to);
    const double area = std::log(drainage.area_m2[c]) - mean;
    variance += area * area;
    if (value_of(slope) > 0.0) covariance += area * log(slope);
  }
  return -covariance / variance;
}

template <class V>
std::vector<V> Objective::statistics_of(std::size_t s, const PlanetSurface<V>& surface) const {
  const Held& held = held_[s];
  const std::span<const V> elevation_m(surface.elevation_m), thickness_m(surface.thickness_m);
  std::vector<V> all;
  all.reserve(problem_.statistics());
  for (const Ranking::Window& window : held.windows) {
    all.push_back(held.elevation->mean(window, elevation_m));
  }
  for (std::size_t t = 0; t < problem_.terms.size(); ++t) {
    const Held::OfTerm& of = held.terms[t];
    switch (problem_.terms[t].kind) {
      case Term::Kind::land_fraction:
        all.push_back(of.value +
                      of.rate * (held.elevation->mean(of.window, elevation_m) - of.mean));
        break;
      case Term::Kind::water_volume:
        all.push_back(1e-9 * surface.water_m3);
        break;
      case Term::Kind::erosion_rate:
        all.push_back(1e3 * surface.erosion_rate_m_yr);
        break;
      case Term::Kind::concavity:
        all.push_back(concavity(s, surface.elevation_m));
        break;
      case Term::Kind::crust_thickness:
        all.push_back(1e-3 * held.thickness->mean(of.window, thickness_m));
        break;
    }
  }
  return all;
}

Eigen::Index Objective::residuals() const {
  const auto quantiles = problem_.target.share.size();
  const auto priors = std::count_if(problem_.free.begin(), problem_.free.end(),
                                    [](const FreeParameter& p) { return p.prior.has_value(); });
  return static_cast<Eigen::Index>(quantiles * (problem_.every_seed ? planets_.size() : 1) +
                                   problem_.terms.size()) +
         priors;
}

Eigen::VectorXd Objective::known_variance() const {
  Eigen::VectorXd variance = Eigen::VectorXd::Ones(residuals());
  const auto each = static_cast<Eigen::Index>(problem_.every_seed ? planets_.size() : 1);
  Eigen::Index at = 0;
  for (std::size_t k = 0; k < problem_.target.share.size(); ++k) {
    const double error = problem_.error(k) / problem_.deviation(k);
    variance.segment(at, each).setConstant(error * error);
    at += each;
  }
  return variance;
}

double Objective::misfit_m(const Eigen::VectorXd& residual) const {
  const std::size_t quantiles = problem_.target.share.size();
  const auto each = static_cast<Eigen::Index>(problem_.every_seed ? planets_.size() : 1);
  double sum = 0.0;
  Eigen::Index at = 0;
  for (std::size_t k = 0; k < quantiles; ++k) {
    const double deviation_m = problem_.deviation(k);
    sum += residual.segment(at, each).squaredNorm() * deviation_m * deviation_m;
    at += each;
  }
  return std::sqrt(sum / static_cast<double>(quantiles));
}

Eigen::VectorXd Objective::residuals_of(const std::vector<std::vector<double>>& statistics,
                                        const Eigen::VectorXd& x) const {
  const std::size_t quantiles = problem_.target.share.size(), seeds = statistics.size();
  Eigen::VectorXd residual(residuals());
  Eigen::Index at = 0;
  const double share = 1.0 / std::sqrt(static_cast<double>(seeds));
  for (std::size_t k = 0; k < problem_.statistics(); ++k) {
    const double aim = problem_.aim(k), deviation = problem_.deviation(k);
    if (problem_.every_seed && k < quantiles) {
      for (const auto& of_seed : statistics) {
        residual[at++] = share * (of_seed[k] - aim) / deviation;
      }
      continue;
    }
    double sum = 0.0;
    for (const auto& of_seed : statistics) sum += of_seed[k];
    residual[at++] = (sum / static_cast<double>(seeds) - aim) / deviation;
  }
  for (std::size_t i = 0; i < problem_.free.size(); ++i) {
    const FreeParameter& free = problem_.free[i];
    if (!free.prior) continue;
    residual[at++] = (free.to_value(x[Eigen::Index(i)]) - free.prior->mean) / free.prior->deviation;
  }
  return residual;
}

Eigen::VectorXd Objective::evaluate(const Eigen::VectorXd& x) {
  const Stopwatch watch;
  problem_.set(x);
  statistics_.assign(planets_.size(), {});
  fine_bins_.assign(planets_.size(), {});
  for_seeds([&](std::size_t s) {
    const PlanetSurface<double> surface = planets_[s]->reroute(problem_.model);
    hold(s, surface);
    statistics_[s] = statistics_of(s, surface);
    fine_bins_[s] = held_[s].elevation->bin_means(kFineBins);
  });
  ++forward_runs_;
  forward_seconds_ += watch.seconds();
  return residuals_of(statistics_, x);
}

double Objective::distance_m() const {
  double sum = 0.0;
  for (const auto& bins : fine_bins_) sum += wasserstein_m(bins, problem_.target);
  return sum / static_cast<double>(fine_bins_.size());
}

Eigen::VectorXd Objective::linearise(const Eigen::VectorXd& x, Eigen::MatrixXd* jacobian) {
  const Stopwatch watch;
  problem_.set(x);
  const std::size_t count = problem_.free.size(), seeds = planets_.size();
  std::vector<std::vector<double>> statistics(seeds);
  if (jacobian == nullptr) {
    for_seeds([&](std::size_t s) {
      statistics[s] =
          statistics_of(s, planets_[s]->with_frozen_drainage<double>(problem_.model, {}));
    });
    return residuals_of(statistics, x);
  }
  rates_.assign(seeds,
                Eigen::MatrixXd::Zero(Eigen::Index(problem_.statistics()), Eigen::Index(count)));
  for (std::size_t first = 0; first < count; first += kTogether) {
    std::vector<ActiveVariables<Jet>::Variable> variables;
    for (std::size_t i = first; i < std::min(count, first + kTogether); ++i) {
      const auto member = std::get<double*>(problem_.free[i].declaration.storage);
      Jet number(*member, static_cast<int>(i - first));
      number.v *= problem_.free[i].rate(x[Eigen::Index(i)]);
      variables.push_back({member, number});
    }
    const ActiveVariables<Jet> active(variables);
    for_seeds([&](std::size_t s) {
      const std::vector<Jet> jets =
          statistics_of(s, planets_[s]->with_frozen_drainage<Jet>(problem_.model, active));
      statistics[s].resize(jets.size());
      for (std::size_t k = 0; k < jets.size(); ++k) {
        statistics[s][k] = jets[k].a;
        for (std::size_t i = 0; i < variables.size(); ++i) {
          rates_[s](Eigen::Index(k), Eigen::Index(first + i)) = jets[k].v[Eigen::Index(i)];
        }
      }
    });
  }
  jacobian->setZero(residuals(), Eigen::Index(count));
  const std::size_t quantiles = problem_.target.share.size();
  const double share = 1.0 / std::sqrt(static_cast<double>(seeds));
  Eigen::Index at = 0;
  for (std::size_t k = 0; k < problem_.statistics(); ++k) {
    const double deviation = problem_.deviation(k);
    if (problem_.every_seed && k < quantiles) {
      for (const auto& rate : rates_) {
        jacobian->row(at++) = share / deviation * rate.row(Eigen::Index(k));
      }
      continue;
    }
    for (const auto& rate : rates_) jacobian->row(at) += rate.row(Eigen::Index(k));
    jacobian->row(at++) /= static_cast<double>(seeds) * deviation;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const FreeParameter& free = problem_.free[i];
    if (!free.prior) continue;
    (*jacobian)(at++, Eigen::Index(i)) = free.rate(x[Eigen::Index(i)]) / free.prior->deviation;
  }
  ++jacobians_;
  jacobian_seconds_ += watch.seconds();
  return residuals_of(statistics, x);
}

}  // namespace geo::calibration
