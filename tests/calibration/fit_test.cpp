// Twin experiments: targets made by the model itself, whose parameters are known.
#include "calibration/fit.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <cstdlib>

#include "calibration/uncertainty.hpp"
#include "geo/core/random.hpp"
#include "small_planets.hpp"

namespace geo::calibration {
namespace {

const std::vector<std::pair<std::string, double>> kTruth{
    {"isostasy.collision_km", 16.0},   {"isostasy.ocean_depth_m", 3500.0},
    {"isostasy.swell_m", 360.0},       {"isostasy.margin_tilt_m", 800.0},
    {"isostasy.ocean_swell_m", 380.0}, {"isostasy.trench_depth_m", 2400.0}};

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
      const auto residual = objective.route(answer.state.x);
      Eigen::MatrixXd rates;
      objective.follow(answer.state.x, &rates);
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
  // A few here; TERRANE_TWIN_RUNS=50 for the whole experiment.
  const char* const asked = std::getenv("TERRANE_TWIN_RUNS");
  const int runs = asked != nullptr ? std::atoi(asked) : 8;
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
  EXPECT_GE(covered, 0.9 * runs * double(kTruth.size()));
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
    const double cost = 0.5 * judge.route(now.x).squaredNorm();
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

TEST(Fit, WarnsInWordsOfWhatTheTargetDoesNotTell) {
  SmallRun run;
  // Thickness of continents and weight of their roots shift all land alike.
  run.settings.free = "isostasy.continental_km, isostasy.lithosphere, isostasy.collision_km";
  run.settings.deviation_m = 200.0;
  Problem problem(run.parameters, run.settings, run.earth());
  Objective objective(problem, run.parameters, std::vector<std::int64_t>{1}, 96, 48);
  const Eigen::VectorXd x = problem.present();
  const auto residual = objective.route(x);
  Eigen::MatrixXd rates;
  objective.follow(x, &rates);
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
