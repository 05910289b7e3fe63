#include "calibration/calibrate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "calibration/checkpoint.hpp"
#include "calibration/fit.hpp"
#include "calibration/report/report.hpp"
#include "calibration/session/comparison.hpp"
#include "calibration/session/fit_folder.hpp"
#include "calibration/session/starting_points.hpp"
#include "calibration/uncertainty.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config/run_settings.hpp"
#include "geo/io/run/run_folder.hpp"

namespace geo::calibration {
namespace {

namespace fs = std::filesystem;

class Calibration {
 public:
  Calibration(const Request& request, const Watch& watch)
      : request_(request),
        settings_(request.settings),
        watch_(watch),
        folder_(request.folder),
        size_(io::parse_grid_size(settings_.grid)),
        seeds_(read_seeds("calibration.seeds", settings_.seeds)),
        held_out_seeds_(read_seeds("calibration.held_out", settings_.held_out)),
        problem_(request.configuration, settings_, aims(size_)) {
    if (seeds_.empty()) throw ConfigurationError("calibration.seeds: must name a seed");
    for (const std::int64_t seed : held_out_seeds_) {
      if (std::find(seeds_.begin(), seeds_.end(), seed) == seeds_.end()) continue;
      throw ConfigurationError(
          fmt::format("calibration.held_out: {}: must not be one of calibration.seeds", seed));
    }
  }

  Result run() {
    checkpoint_ = begin_or_resume(request_, problem_.target, folder_);
    folder_.open();
    say(fmt::format("target {}; {} parameters; {} planets of {} x {}", problem_.target.name,
                    problem_.free.size(), seeds_.size(), size_.nx, size_.ny));
    Objective objective(problem_, request_.configuration, seeds_, size_.nx, size_.ny, watch_.stop);
    describe(objective);
    if (request_.overwrite) remove_results(folder_.path());
    fit_from_all_starts(objective);
    const Eigen::VectorXd best = choose_best();
    judge(objective, best);
    result_.held_out =
        misfits(held_out_seeds_, size_, best, "held-out seeds", result_.held_out_spread);
    say_of_collapse();
    if (!settings_.held_out_grid.empty()) {
      result_.held_out_resolution =
          misfits(seeds_, io::parse_grid_size(settings_.held_out_grid), best, "held-out grid",
                  result_.held_out_resolution_spread);
    }
    finish(best);
    return std::move(result_);
  }

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] Target aims(const io::GridSize& size) const {
    Planet planet;
    for (const Parameter& parameter : planet.parameters()) {
      parameter.set(find_parameter(request_.configuration, parameter.name)->value());
    }
    return read_target(request_.target, planet, Grid::sphere(size.nx, size.ny, planet.figure()),
                       {static_cast<int>(settings_.bins), settings_.deviation_m,
                        settings_.deviation_share, settings_.error_m});
  }
  void say(std::string_view message) const {
    if (watch_.info) watch_.info(message);
  }
  [[nodiscard]] fs::path state_file() const { return folder_.path() / kStateFile; }

  void describe(Objective& objective) {
    result_.target_name = problem_.target.name;
    result_.preset_or_config = request_.preset_or_config;
    result_.grid = settings_.grid;
    result_.held_out_grid = settings_.held_out_grid;
    result_.objective = settings_.objective;
    start_ = problem_.present();
    result_.cost_before = 0.5 * objective.evaluate(start_).squaredNorm();
    before_ = objective.statistics();
    result_.before = mean_curve(problem_.target, objective.fine_bins());
    before_bins_ = objective.fine_bins();
    result_.target = shown_curve(problem_.target, problem_.target.fine_bin_m);
    Eigen::MatrixXd rates;
    objective.linearise(start_, &rates);
    for (std::size_t i = 0; i < problem_.free.size(); ++i) {
      const FreeParameter& free = problem_.free[i];
      double most = 0.0;  // priors do not count: the planets must depend on it
      for (const auto& of_seed : objective.seed_jacobians()) {
        most = std::max(most, of_seed.col(Eigen::Index(i)).cwiseAbs().maxCoeff());
      }
      if (most == 0.0) {
        // Some processes are left out altogether where their amount is 0.
        throw ConfigurationError(fmt::format(
            "calibration.free: {}: the figures to match do not change with it, or not smoothly; {}",
            free.declaration.name,
            free.to_value(start_[Eigen::Index(i)]) == 0.0 ? "leave it out, or start above 0"
                                                          : "leave it out"));
      }
    }
  }

  void fit_from_all_starts(Objective& objective) {
    const auto points = starting_points(problem_, settings_.starts);
    const auto begin = Clock::now();
    const double earlier_s = checkpoint_.seconds;
    for (std::size_t n = checkpoint_.starts.size(); n < points.size(); ++n) {
      FitState& state = checkpoint_.state;
      const bool goes_on = state.begun && !state.ended;
      if (!goes_on) {
        state = {};
        state.x = points[n];
      }
      fit(objective, problem_, {static_cast<int>(settings_.iterations), settings_.tolerance}, state,
          [&](const FitState& now, Iteration iteration) {
            iteration.start = static_cast<int>(n);
            checkpoint_.iterations.push_back(iteration);
            checkpoint_.seconds =
                earlier_s + std::chrono::duration<double>(Clock::now() - begin).count();
            if (!now.ended) write_checkpoint(checkpoint_, state_file());
            if (watch_.iteration) watch_.iteration(iteration);
          });
      Start start{values_at(problem_, points[n]),
                  values_at(problem_, state.x),
                  state.cost,
                  state.converged,
                  state.iteration,
                  state.ending};
      checkpoint_.starts.push_back(start);
      write_checkpoint(checkpoint_, state_file());
    }
  }

  Eigen::VectorXd choose_best() {
    const auto best =
        std::min_element(checkpoint_.starts.begin(), checkpoint_.starts.end(),
                         [](const Start& a, const Start& b) { return a.cost < b.cost; });
    result_.converged = best->converged;
    result_.ending = best->ending;
    Eigen::VectorXd x(problem_.free.size());
    for (std::size_t i = 0; i < problem_.free.size(); ++i) {
      x[Eigen::Index(i)] = problem_.free[i].to_x(best->to[i]);
    }
    if (const int others = equally_good_elsewhere(problem_, checkpoint_.starts, *best)) {
      result_.warnings.push_back(
          fmt::format("{} other starting points ended as well as the best one with other values: "
                      "the target does not single out one answer",
                      others));
    }
    return x;
  }

  void judge(Objective& objective, const Eigen::VectorXd& x) {
    say("uncertainty");
    const Eigen::VectorXd residual = objective.evaluate(x);
    Eigen::MatrixXd rates;
    objective.linearise(x, &rates);
    result_.cost_after = 0.5 * residual.squaredNorm();
    result_.after = mean_curve(problem_.target, objective.fine_bins());
    for (std::size_t s = 0; s < seeds_.size(); ++s) {
      result_.fitted.push_back({seeds_[s], wasserstein_m(before_bins_[s], problem_.target),
                                wasserstein_m(objective.fine_bins()[s], problem_.target)});
    }
    result_.fitted_spread = {spread_m(before_bins_, problem_.target),
                             spread_m(objective.fine_bins(), problem_.target)};
    result_.parameters = fitted_parameters(problem_, start_, x);
    say_of_bounds();
    result_.residuals = residuals_of(problem_, before_, objective.statistics());
    assess(objective, problem_, x, residual, rates, result_);
    if (settings_.profiles) {
      say("profiles");
      const auto begin = Clock::now();
      add_profiles(objective, problem_, x, rates, result_);
      result_.profile_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    }
    result_.forward_runs = objective.forward_runs();
    result_.jacobians = objective.jacobians();
    result_.seconds_per_forward = objective.forward_seconds() / std::max(1, result_.forward_runs);
    result_.seconds_per_jacobian = objective.jacobian_seconds() / std::max(1, result_.jacobians);
  }

  std::vector<SeedMisfit> misfits(const std::vector<std::int64_t>& seeds, const io::GridSize& size,
                                  const Eigen::VectorXd& x, std::string_view what,
                                  SeedSpread& spread) {
    std::vector<SeedMisfit> all;
    if (seeds.empty()) return all;
    say(what);
    // A target of cells is averaged onto cells of this size.
    const Target target = size.nx == size_.nx && size.ny == size_.ny ? problem_.target : aims(size);
    Objective judge(problem_, request_.configuration, seeds, size.nx, size.ny, watch_.stop);
    for (const std::int64_t seed : seeds) all.push_back({seed, 0.0, 0.0});
    judge.evaluate(start_);
    for (std::size_t s = 0; s < seeds.size(); ++s) {
      all[s].before_m = wasserstein_m(judge.fine_bins()[s], target);
    }
    spread.before_m = spread_m(judge.fine_bins(), target);
    judge.evaluate(x);
    spread.after_m = spread_m(judge.fine_bins(), target);
    for (std::size_t s = 0; s < seeds.size(); ++s) {
      all[s].after_m = wasserstein_m(judge.fine_bins()[s], target);
    }
    return all;
  }

  void say_of_bounds() {
    std::vector<std::string_view> stopped;
    for (const FittedParameter& parameter : result_.parameters) {
      if (parameter.at_bound) stopped.push_back(parameter.name);
    }
    if (!stopped.empty()) {
      result_.warnings.push_back(fmt::format("ended at a bound: {}", fmt::join(stopped, ", ")));
    }
  }

  void say_of_collapse() {
    const SeedSpread& spread = result_.held_out_spread;
    if (!has_collapsed(spread)) return;
    result_.warnings.push_back(fmt::format(
        "held-out planets have become alike: the curves of different seeds lie {:.3g} m apart, "
        "{:.3g} m before the fit, so that their misfits and the spread of seeds say less than they "
        "seem to",
        spread.after_m, spread.before_m));
  }

  void finish(const Eigen::VectorXd& x) {
    problem_.set(x);
    for (const FreeParameter& free : problem_.free) {
      find_parameter(request_.configuration, free.declaration.name)
          ->set(*std::get<double*>(free.declaration.storage));
    }
    result_.iterations = checkpoint_.iterations;
    result_.starts = checkpoint_.starts;
    result_.seconds = checkpoint_.seconds;
    result_.builders = checkpoint_.builders;
    if (!request_.events.empty()) {
      result_.warnings.push_back("events were left out of the fit; fitted.toml holds them");
    }
    if (const std::string failure = failure_of(result_); !failure.empty()) {
      result_.warnings.insert(result_.warnings.begin(), failure);
    }
    write_results(result_, request_.configuration, request_.events, folder_.path());
  }

  const Request& request_;
  Settings settings_;
  const Watch& watch_;
  io::RunFolder folder_;
  io::GridSize size_;
  std::vector<std::int64_t> seeds_, held_out_seeds_;
  Problem problem_;
  Checkpoint checkpoint_;
  Eigen::VectorXd start_;
  std::vector<std::vector<double>> before_, before_bins_;
  Result result_;
};

}  // namespace

Result calibrate(const Request& request, const Watch& watch) {
  return Calibration(request, watch).run();
}

std::string failure_of(const Result& result) {
  // Of the target's own spread: what a fitted planet may miss it by.
  constexpr double kShare = 0.15, kLeast_m = 100.0;
  const auto& target = result.target.elevation_m;
  const double count = static_cast<double>(target.size());
  const double mean = std::accumulate(target.begin(), target.end(), 0.0) / count;
  double spread = 0.0;
  for (const double elevation_m : target) spread += std::abs(elevation_m - mean) / count;
  const double misfit_m = mean_after_m(result.fitted);
  if (misfit_m > std::max(kShare * spread, kLeast_m)) {
    return fmt::format(
        "the target is out of reach: the best planets miss it by {:.0f} m on "
        "average (they began at {:.0f} m)",
        misfit_m, mean_before_m(result.fitted));
  }
  if (!result.converged) return fmt::format("the fit did not converge: {}", result.ending);
  return {};
}

}  // namespace geo::calibration
