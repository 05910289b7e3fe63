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
#include "calibration/uncertainty.hpp"
#include "geo/core/error.hpp"
#include "geo/core/random.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/config/run_settings.hpp"
#include "geo/io/files/digest.hpp"
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
    look_at_folder();
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

  /// What the answer depends on.
  [[nodiscard]] std::string question() const {
    Settings settings = settings_;
    settings.iterations = 0;  // a fit may be given more time
    settings.profiles = true;
    settings.error_m = 0.0;  // standard errors come after the fit
    settings.held_out.clear();
    settings.held_out_grid.clear();
    const auto own = settings.parameters();
    std::string text = io::write_config(request_.configuration, "", request_.events) +
                       io::write_config(own, "") + request_.target;
    const Target& target = problem_.target;
    text += fmt::format(" {} {}", fmt::join(target.elevation_m, " "),
                        fmt::join(target.deviation_m, " "));
    return io::digest_of(std::string_view(text));
  }

  void look_at_folder() {
    if (folder_.path().empty()) throw ConfigurationError("-o \"\": must name a folder");
    const std::string shown = folder_.path().string();
    const bool held = fs::exists(state_file()) || fs::exists(folder_.path() / kResultFile);
    if (folder_.holds_run()) {
      throw ConfigurationError(
          fmt::format("{} holds a run of terrane run: choose another folder", shown));
    }
    if (request_.resume && request_.overwrite) {
      throw ConfigurationError("--resume and --overwrite exclude each other: choose one");
    }
    if (held && !request_.resume && !request_.overwrite) {
      throw ConfigurationError(fmt::format(
          "{} already holds a calibration: --resume goes on with it, --overwrite replaces it",
          shown));
    }
    checkpoint_.question = question();
    checkpoint_.builders = {io::this_builder()};
    if (!request_.resume) return;
    if (!fs::exists(state_file())) {
      throw ConfigurationError(
          fmt::format("--resume: {} holds no calibration to go on with", shown));
    }
    Checkpoint before = read_checkpoint(state_file());
    if (before.question != checkpoint_.question) {
      throw ConfigurationError(
          fmt::format("--resume: the configuration or the target changed; --overwrite calibrates "
                      "{} again",
                      shown));
    }
    take_over(before.builders, shown);
    checkpoint_ = std::move(before);
    // One that ran out of iterations may have been given more.
    FitState& state = checkpoint_.state;
    if (state.ended && !state.converged && state.iteration < settings_.iterations) {
      state.ended = false;
      if (!checkpoint_.starts.empty()) checkpoint_.starts.pop_back();
    }
  }

  /// Another build may compute other planets: it goes on where that is asked for, and is listed.
  void take_over(std::vector<io::Builder>& builders, const std::string& shown) const {
    const io::Builder here = io::this_builder();
    const io::Builder last = builders.empty() ? io::Builder{} : builders.back();
    if (last == here) return;
    if (!request_.allow_other_build) {
      throw ConfigurationError(fmt::format(
          "--resume: {} was made by terrane {}, this is {}; --allow-other-build goes on "
          "nevertheless, --overwrite calibrates again",
          shown, builders.empty() ? "of an earlier version" : last.words_beside(here),
          here.words_beside(last)));
    }
    builders.push_back(here);
  }

  /// The configuration itself, then places within the bounds or within a factor 2.
  [[nodiscard]] std::vector<Eigen::VectorXd> starting_points() const {
    std::vector<Eigen::VectorXd> points{problem_.present()};
    const RandomStream random(0, "calibration.starts");
    for (std::int64_t n = 1; n < settings_.starts; ++n) {
      Eigen::VectorXd x = points.front();
      for (std::size_t i = 0; i < problem_.free.size(); ++i) {
        const FreeParameter& free = problem_.free[i];
        const double reach = free.logarithmic ? std::log(2.0) : 0.5;
        const double centre = points.front()[Eigen::Index(i)];
        const double low = std::max(centre - reach, free.to_x(free.low));
        const double high = std::min(centre + reach, free.to_x(free.high));
        x[Eigen::Index(i)] = random.uniform(std::uint64_t(n), i, low, high);
      }
      points.push_back(x);
    }
    return points;
  }

  void describe(Objective& objective) {
    result_.target_name = problem_.target.name;
    result_.preset_or_config = request_.preset_or_config;
    result_.grid = settings_.grid;
    result_.held_out_grid = settings_.held_out_grid;
    result_.objective = settings_.objective;
    start_ = problem_.present();
    result_.cost_before = 0.5 * objective.evaluate(start_).squaredNorm();
    before_ = objective.statistics();
    result_.before = mean_curve(objective.fine_bins());
    before_bins_ = objective.fine_bins();
    result_.target = shown_curve(problem_.target.fine_bin_m);
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

  /// A curve of fine bins by a hundred points, or as many as there are bins where the target tells
  /// of no more.
  [[nodiscard]] Curve shown_curve(const std::vector<double>& fine) const {
    const int first = problem_.target.first_bin(), end = problem_.target.end_bin();
    const int points = std::min(100, end - first);
    const double each = static_cast<double>(end - first) / points;
    Curve curve{std::vector<double>(points, 0.0), double(first) / kFineBins,
                double(end) / kFineBins};
    for (int k = 0; k < points; ++k) {
      const double from = first + k * each, to = first + (k + 1) * each;
      for (int bin = static_cast<int>(from); bin < end && bin < to; ++bin) {
        const double part = std::min(to, bin + 1.0) - std::max(from, double(bin));
        curve.elevation_m[k] += fine[bin] * part / each;
      }
    }
    return curve;
  }
  [[nodiscard]] Curve mean_curve(const std::vector<std::vector<double>>& fine) const {
    std::vector<double> mean(kFineBins, 0.0);
    for (const auto& of_seed : fine) {
      for (int k = 0; k < kFineBins; ++k) mean[k] += of_seed[k] / static_cast<double>(fine.size());
    }
    return shown_curve(mean);
  }

  void fit_from_all_starts(Objective& objective) {
    const auto points = starting_points();
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
      Start start{values_at(points[n]), values_at(state.x), state.cost,
                  state.converged,      state.iteration,    state.ending};
      checkpoint_.starts.push_back(start);
      write_checkpoint(checkpoint_, state_file());
    }
  }

  [[nodiscard]] std::vector<double> values_at(const Eigen::VectorXd& x) const {
    std::vector<double> values;
    for (std::size_t i = 0; i < problem_.free.size(); ++i) {
      values.push_back(problem_.free[i].to_value(x[Eigen::Index(i)]));
    }
    return values;
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
    if (checkpoint_.starts.size() > 1) compare_starts(*best);
    return x;
  }

  /// Other minima as good as the best one.
  void compare_starts(const Start& best) {
    constexpr double kAsGood = 1.05, kElsewhere = 0.1;
    int others = 0;
    for (const Start& start : checkpoint_.starts) {
      if (start.cost > kAsGood * best.cost + 1e-9) continue;
      for (std::size_t i = 0; i < problem_.free.size(); ++i) {
        const FreeParameter& free = problem_.free[i];
        if (std::abs(free.to_x(start.to[i]) - free.to_x(best.to[i])) > kElsewhere) {
          ++others;
          break;
        }
      }
    }
    if (others > 0) {
      result_.warnings.push_back(
          fmt::format("{} other starting points ended as well as the best one with other values: "
                      "the target does not single out one answer",
                      others));
    }
  }

  void judge(Objective& objective, const Eigen::VectorXd& x) {
    say("uncertainty");
    const Eigen::VectorXd residual = objective.evaluate(x);
    Eigen::MatrixXd rates;
    objective.linearise(x, &rates);
    result_.cost_after = 0.5 * residual.squaredNorm();
    result_.after = mean_curve(objective.fine_bins());
    for (std::size_t s = 0; s < seeds_.size(); ++s) {
      result_.fitted.push_back({seeds_[s], wasserstein_m(before_bins_[s], problem_.target),
                                wasserstein_m(objective.fine_bins()[s], problem_.target)});
    }
    result_.fitted_spread = {spread_m(before_bins_, problem_.target),
                             spread_m(objective.fine_bins(), problem_.target)};
    list_parameters(x);
    list_residuals(objective);
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

  void list_parameters(const Eigen::VectorXd& x) {
    const auto from = values_at(start_), to = values_at(x);
    std::vector<std::string_view> stopped;
    for (std::size_t i = 0; i < problem_.free.size(); ++i) {
      const FreeParameter& free = problem_.free[i];
      FittedParameter parameter;
      parameter.name = free.declaration.name;
      parameter.units = free.declaration.units;
      parameter.doc = free.declaration.doc;
      parameter.start = from[i];
      parameter.fitted = to[i];
      parameter.low = free.low;
      parameter.high = free.high;
      parameter.logarithmic = free.logarithmic;
      const double near = 1e-3 * std::max(std::abs(to[i]), 1e-3 * free.scale);
      parameter.at_bound = to[i] - free.low <= near || free.high - to[i] <= near;
      if (parameter.at_bound) stopped.push_back(free.declaration.name);
      if (free.prior) {
        parameter.prior_mean = free.prior->mean;
        parameter.prior_deviation = free.prior->deviation;
      }
      result_.parameters.push_back(parameter);
    }
    if (!stopped.empty()) {
      result_.warnings.push_back(fmt::format("ended at a bound: {}", fmt::join(stopped, ", ")));
    }
  }

  void list_residuals(const Objective& objective) {
    const auto mean = [](const std::vector<std::vector<double>>& all, std::size_t k) {
      double sum = 0.0;
      for (const auto& of_seed : all) sum += of_seed[k];
      return sum / static_cast<double>(all.size());
    };
    const std::size_t quantiles = problem_.target.share.size();
    for (std::size_t k = 0; k < problem_.statistics(); ++k) {
      Residual residual;
      const bool is_quantile = k < quantiles;
      residual.name = is_quantile ? fmt::format("quantile {:.4g}", problem_.target.share[k])
                                  : problem_.terms[k - quantiles].target.name;
      residual.units = is_quantile ? "m" : problem_.terms[k - quantiles].units;
      residual.share =
          is_quantile ? problem_.target.share[k] : std::numeric_limits<double>::quiet_NaN();
      residual.target = problem_.aim(k);
      residual.before = mean(before_, k);
      residual.after = mean(objective.statistics(), k);
      residual.deviation = problem_.deviation(k);
      result_.residuals.push_back(residual);
    }
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
