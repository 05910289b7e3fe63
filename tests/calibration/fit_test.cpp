// Twin experiments: targets made by the model itself, whose parameters are known.
#include "calibration/fit.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <tuple>

#include "calibration/uncertainty.hpp"
#include "geo/core/error.hpp"
#include "geo/core/random.hpp"
#include "io/temporary_folder.hpp"
#include "small_planets.hpp"

namespace geo::calibration {
namespace {

const std::vector<std::pair<std::string, double>> kTruth{
    {"isostasy.collision_km", 16.0},   {"isostasy.ocean_depth_m", 3500.0},
    {"isostasy.swell_m", 360.0},       {"isostasy.margin_tilt_m", 800.0},
    {"isostasy.ocean_swell_m", 380.0}, {"isostasy.slab_trench_m", 5900.0}};

class Twin {
 public:
  explicit Twin(std::vector<std::int64_t> of_seeds = {1, 2}, int of_rows = 48)
      : seeds(std::move(of_seeds)), rows(of_rows) {
    run.settings.free.clear();
    for (const auto& [name, value] : kTruth) {
      run.settings.free += (run.settings.free.empty() ? "" : ", ") + name;
      set(name, value);
    }
    target = own_target(run, seeds, rows);
  }
  void set(const std::string& name, double value) {
    find_parameter(run.parameters, name)->set(value);
  }
  struct Answer {
    FitState state;
    Result result;
  };
  /// From the truth times the given factors.
  Answer fit_from(const std::vector<double>& factor, const Target& aim, bool assesses) {
    for (std::size_t i = 0; i < kTruth.size(); ++i) {
      set(kTruth[i].first, kTruth[i].second * factor[i]);
    }
    Problem problem(run.parameters, run.settings, aim);
    Objective objective(problem, run.parameters, seeds, 2 * rows, rows);
    Answer answer;
    answer.state.x = problem.present();
    fit(objective, problem, {40, 1e-4}, answer.state, [](const auto&, const auto&) {});
    for (std::size_t i = 0; i < kTruth.size(); ++i) {
      FittedParameter parameter;
      parameter.name = kTruth[i].first;
      parameter.fitted = problem.free[i].to_value(answer.state.x[Eigen::Index(i)]);
      answer.result.parameters.push_back(parameter);
    }
    if (assesses) {
      const auto residual = objective.evaluate(answer.state.x);
      Eigen::MatrixXd rates;
      objective.linearise(answer.state.x, &rates);
      assess(objective, problem, answer.state.x, residual, rates, answer.result);
    }
    return answer;
  }

  SmallRun run;
  std::vector<std::int64_t> seeds;
  int rows;
  Target target;
};

class RandomStart : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomStart, SixParametersComeBackWithinAPercent) {
  Twin twin({1, 2, 3, 4}, 64);
  const RandomStream random(3, "test.twin");
  std::vector<double> factor;
  for (std::size_t i = 0; i < kTruth.size(); ++i) {
    factor.push_back(std::exp(random.uniform(GetParam(), i, -0.4, 0.4)));
  }
  const auto answer = twin.fit_from(factor, twin.target, false);
  EXPECT_TRUE(answer.state.converged);
  for (std::size_t i = 0; i < kTruth.size(); ++i) {
    EXPECT_NEAR(answer.result.parameters[i].fitted / kTruth[i].second, 1.0, 0.01)
        << kTruth[i].first << ", cost " << answer.state.cost;
  }
}
INSTANTIATE_TEST_SUITE_P(Twin, RandomStart, testing::Range<std::uint64_t>(0, 5));

TEST(Twin, StandardErrorsCoverTheTruthUnderNoise) {
  Twin twin({1});
  // Enough to know the share within 2 %; TERRANE_TWIN_RUNS for fewer.
  const char* const asked = std::getenv("TERRANE_TWIN_RUNS");
  const int runs = asked != nullptr ? std::atoi(asked) : 50;
  const RandomStream random(5, "test.noise");
  int covered = 0;
  for (int run = 0; run < runs; ++run) {
    Target noisy = twin.target;
    for (std::size_t k = 0; k < noisy.share.size(); ++k) {
      noisy.elevation_m[k] += 10.0 * random.normal(std::uint64_t(run), k);
    }
    const auto answer = twin.fit_from(std::vector<double>(kTruth.size(), 1.05), noisy, true);
    for (std::size_t i = 0; i < kTruth.size(); ++i) {
      const FittedParameter& parameter = answer.result.parameters[i];
      covered += std::abs(parameter.fitted - kTruth[i].second) <= 2.0 * parameter.standard_error;
    }
  }
  RecordProperty("covered", covered);
  EXPECT_GE(covered, 0.92 * runs * double(kTruth.size()));  // of 0.95
}

TEST(Fit, GivesTheSameBitsForAnyNumberOfThreads) {
  const int before = omp_get_max_threads();
  std::vector<Eigen::VectorXd> x;
  for (const int threads : {1, 3}) {
    omp_set_num_threads(threads);
    Twin twin;
    x.push_back(twin.fit_from({1.1, 0.95, 1.2, 0.9, 1.1, 1.2}, twin.target, false).state.x);
  }
  omp_set_num_threads(before);
  EXPECT_EQ(x[0], x[1]);
}

TEST(Fit, RecordsTheDistanceOfTheBestPlaceNotOfTheLastTried) {
  Twin twin;
  for (const auto& [name, value] : kTruth) twin.set(name, 1.15 * value);
  Problem problem(twin.run.parameters, twin.run.settings, twin.run.earth());
  Objective objective(problem, twin.run.parameters, twin.seeds, 96, 48);
  Objective judge(problem, twin.run.parameters, twin.seeds, 96, 48);
  FitState state;
  state.x = problem.present();
  int rejected = 0;
  fit(objective, problem, {12, 1e-4}, state, [&](const FitState& now, const Iteration& record) {
    rejected += record.accepted ? 0 : 1;
    const double cost = 0.5 * judge.evaluate(now.x).squaredNorm();
    EXPECT_EQ(record.cost, cost) << "iteration " << record.number;
    EXPECT_EQ(record.wasserstein_m, judge.distance_m()) << "iteration " << record.number;
  });
  EXPECT_GT(rejected, 0);
}

TEST(Fit, FreesTheDepthOfTheSeaOnlyWhereItReachesContinents) {
  for (const auto& [setting, first] :
       {std::pair{"planet.ocean_fraction=0.71", "isostasy.ocean_depth_m"},
        {"planet.ocean_fraction=0.4", "isostasy.continental_km"},
        {"planet.ocean_fraction=0", "isostasy.continental_km"},
        {"isostasy.ocean_depth_m=0", "isostasy.continental_km"}}) {
    const SmallRun run(setting);
    const Problem problem(run.parameters, run.settings, run.earth());
    ASSERT_EQ(problem.free.size(), 6U);
    EXPECT_EQ(problem.free.front().declaration.name, first) << setting;
  }
}

TEST(Fit, HasConvergedWhereTheTargetIsMetWithinItsDeviations) {
  for (const auto& [factor, iterations, met] :
       {std::tuple{1.02, 3, true}, std::tuple{1.5, 1, false}}) {
    Twin twin;
    for (const auto& [name, value] : kTruth) twin.set(name, factor * value);
    Problem problem(twin.run.parameters, twin.run.settings, twin.target);
    Objective objective(problem, twin.run.parameters, twin.seeds, 96, 48);
    FitState state;
    state.x = problem.present();
    fit(objective, problem, {iterations, 1e-9}, state, [](const auto&, const auto&) {});
    EXPECT_EQ(state.iteration, iterations);
    EXPECT_EQ(state.converged, met) << state.cost << ", " << state.distance_m << " m";
    EXPECT_EQ(state.ending.starts_with("the target is met to"), met) << state.ending;
  }
}

/// The same planets as a target of each kind, and how sure each makes the parameters.
class Uncertainty : public testing::Test {
 protected:
  Uncertainty() { run_.settings.free = "isostasy.collision_km, isostasy.swell_m"; }
  Target read(const std::string& text) {
    std::ofstream(folder_ / "target.csv") << text;
    return read_target((folder_ / "target.csv").string(), run_.planet, run_.grid(),
                       {.error_m = error_m_});
  }
  Target rows(const Target& curve, const std::string& sigma = "") {
    std::string text = sigma.empty() ? "quantile,elevation_m\n" : "quantile,elevation_m,sigma_m\n";
    for (std::size_t k = 0; k < curve.share.size(); ++k) {
      text += fmt::format("{},{}{}\n", curve.share[k], curve.elevation_m[k],
                          sigma.empty() ? "" : "," + sigma);
    }
    return read(text);
  }
  /// The way that reliefs and curves go, too.
  Target bins(const Target& curve) {
    std::string text = "lower_m,upper_m,fraction\n";
    for (int k = 0; k + 1 < kFineBins; ++k) {
      text += fmt::format("{},{},{}\n", curve.fine_bin_m[k] + 1e-4 * k,
                          curve.fine_bin_m[k + 1] + 1e-4 * (k + 1), 1.0 / (kFineBins - 1));
    }
    return read(text);
  }
  std::vector<double> errors(Target target) {
    Problem problem(run_.parameters, run_.settings, std::move(target));
    Objective objective(problem, run_.parameters, seeds_, 2 * kRows, kRows);
    // A little beside the minimum, so that something is left over.
    const Eigen::VectorXd x = problem.present().array() + 0.02;
    const auto residual = objective.evaluate(x);
    Eigen::MatrixXd rates;
    objective.linearise(x, &rates);
    Result result;
    result.parameters.resize(problem.free.size());
    assess(objective, problem, x, residual, rates, result);
    return {result.parameters[0].standard_error, result.parameters[1].standard_error};
  }

  static constexpr int kRows = 32;
  SmallRun run_;
  std::vector<std::int64_t> seeds_{1};
  double error_m_ = 0.0;
  TemporaryFolder folder_;
};

TEST_F(Uncertainty, IsTheSameForEveryKindOfTarget) {
  const Target histogram = bins(own_target(run_, seeds_, kRows));
  const auto of_bins = errors(histogram), of_rows = errors(rows(histogram));
  for (std::size_t i = 0; i < of_rows.size(); ++i) {
    EXPECT_GT(of_rows[i], 0.0);
    EXPECT_NEAR(of_rows[i], of_bins[i], 0.1 * of_bins[i]);
  }
}

TEST_F(Uncertainty, IsNotLessThanWhatTheTargetIsKnownTo) {
  const Target curve = own_target(run_, seeds_, kRows);
  const auto of_scatter = errors(rows(curve));
  error_m_ = 300.0;
  const Target histogram = bins(curve);
  const auto of_rows = errors(rows(histogram)), of_bins = errors(histogram);
  for (std::size_t i = 0; i < of_rows.size(); ++i) {
    EXPECT_GT(of_rows[i], 5.0 * of_scatter[i]);
    EXPECT_NEAR(of_rows[i], of_bins[i], 0.1 * of_bins[i]);
  }
  const auto of_column = errors(rows(curve, "300")), of_wider_column = errors(rows(curve, "600"));
  for (std::size_t i = 0; i < of_rows.size(); ++i) {
    EXPECT_NEAR(of_wider_column[i], 2.0 * of_column[i], 1e-6 * of_column[i]);
  }
}

/// Erodibility and the area exponent do nearly the same to rivers, along a line that is bent.
TEST(Profile, OthersAreFittedAgainAtEveryPoint) {
  SmallRun run;
  run.settings.free = "erosion.erodibility_factor, erosion.area_exponent";
  run.settings.deviation_m = 5.0;
  const std::vector<std::int64_t> seeds{1};
  Problem problem(run.parameters, run.settings, own_target(run, seeds, 32));
  Objective objective(problem, run.parameters, seeds, 64, 32);
  const Eigen::VectorXd x = problem.present();
  objective.evaluate(x);
  Eigen::MatrixXd rates;
  objective.linearise(x, &rates);
  const auto cost_at = [&](const Eigen::VectorXd& at) {
    return 0.5 * objective.linearise(at).squaredNorm();
  };
  constexpr double kReach = 0.3;
  const Profile profile = profile_of(objective, problem, x, rates, 1, kReach);
  ASSERT_EQ(profile.value.size(), 7U);
  for (std::size_t k = 0; k < profile.value.size(); ++k) {
    const double move = kReach * (double(k) - 3.0) / 3.0;
    EXPECT_NEAR(std::log(profile.value[k]), x[1] + move, 1e-12);
    EXPECT_EQ(profile.fitted[k][1], profile.value[k]);
    Eigen::VectorXd at(2);
    at << problem.free[0].to_x(profile.fitted[k][0]), problem.free[1].to_x(profile.fitted[k][1]);
    EXPECT_NEAR(cost_at(at), profile.cost[k], 1e-9 + 1e-6 * profile.cost[k]);
    double least = profile.cost[k];
    for (double beside = -1.0; beside <= 1.0; beside += 0.05) {
      Eigen::VectorXd other = at;
      other[0] += beside;
      least = std::min(least, cost_at(other));
    }
    EXPECT_LE(profile.cost[k], 1.01 * least + 1e-6) << "at " << profile.value[k];
    // The straight line of the linear optimum leaves the valley of the cost.
    Eigen::VectorXd straight = x;
    straight[1] += move;
    straight[0] -= move * rates.col(0).dot(rates.col(1)) / rates.col(0).squaredNorm();
    if (k == 0 || k == 6) {
      EXPECT_GT(cost_at(straight), 3.0 * profile.cost[k]);
    }
  }
}

TEST(Profile, EndsAtTheBounds) {
  SmallRun run;
  run.settings.free = "erosion.erodibility_factor, erosion.area_exponent";
  run.settings.bounds = "erosion.area_exponent = 0.45 .. 0.52";
  const std::vector<std::int64_t> seeds{1};
  Problem problem(run.parameters, run.settings, own_target(run, seeds, 32));
  Objective objective(problem, run.parameters, seeds, 64, 32);
  const Eigen::VectorXd x = problem.present();
  objective.evaluate(x);
  Eigen::MatrixXd rates;
  objective.linearise(x, &rates);
  const Profile profile = profile_of(objective, problem, x, rates, 1, 0.3);
  ASSERT_EQ(profile.value.size(), 4U);
  EXPECT_NEAR(profile.value.front(), 0.45, 1e-9);
  EXPECT_NEAR(profile.value.back(), 0.52, 1e-9);
  const Profile alone = profile_of(objective, problem, x, rates, 0, 1e-3);
  EXPECT_EQ(alone.value.size(), 7U);
}

TEST(Fit, FreesNothingThatMovesThePlates) {
  for (const auto& [setting, name] : {std::pair{"erosion.steps=4", "planet.radius_km"},
                                      {"erosion.steps=4", "planet.flattening"},
                                      {"plates.model=sphere", "planet.gravity_m_s2"},
                                      {"plates.continents=plates", "planet.ocean_fraction"}}) {
    SmallRun run(setting);
    run.settings.free = name;
    EXPECT_THROW((Problem(run.parameters, run.settings, run.earth())), ConfigurationError) << name;
  }
  SmallRun run;
  run.settings.free = "planet.gravity_m_s2, planet.ocean_fraction";
  EXPECT_NO_THROW((Problem(run.parameters, run.settings, run.earth())));
}

TEST(Fit, WarnsInWordsOfWhatTheTargetDoesNotTell) {
  SmallRun run;
  for (const auto& [name, value] : {std::pair{"erosion.uplift_from", "deformation"},
                                    std::pair{"erosion.model", "detachment"}}) {
    find_parameter(run.parameters, name)->set_text(value);  // what shortens crust tells them apart
  }
  // Thickness of continents and weight of their roots shift all land alike.
  run.settings.free = "isostasy.continental_km, isostasy.lithosphere, isostasy.collision_km";
  run.settings.deviation_m = 200.0;
  Problem problem(run.parameters, run.settings, run.earth());
  Objective objective(problem, run.parameters, std::vector<std::int64_t>{1}, 96, 48);
  const Eigen::VectorXd x = problem.present();
  const auto residual = objective.evaluate(x);
  Eigen::MatrixXd rates;
  objective.linearise(x, &rates);
  Result result;
  result.parameters.resize(3);
  assess(objective, problem, x, residual, rates, result);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_NE(result.warnings.front().find("ln(isostasy.continental_km)"), std::string::npos)
      << result.warnings.front();
  EXPECT_GT(std::abs(result.correlation[0][1]), 0.9);
}

}  // namespace
}  // namespace geo::calibration
