#include "calibration/target.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "calibration/ranking.hpp"
#include "calibration/settings.hpp"
#include "geo/core/error.hpp"
#include "geo/core/random.hpp"
#include "geo/io/input/hypsography.hpp"

namespace geo::calibration {
namespace {

using testing::HasSubstr;

class TargetFile : public testing::Test {
 protected:
  Target read(const std::string& text, const Accuracy& accuracy = {}) {
    std::ofstream(path_) << text;
    return read_name(path_.string(), accuracy);
  }
  static Target read_name(const std::string& name, const Accuracy& accuracy = {}) {
    const Planet planet;
    return read_target(name, planet, Grid::sphere(64, 32, planet.figure()), accuracy);
  }
  std::string message(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  void TearDown() override { std::filesystem::remove(path_); }

 private:
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() /
      (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".csv");
};

TEST_F(TargetFile, QuantilesAreMatchedRowByRowWithoutTheExtremes) {
  const Target target = read("quantile,elevation_m\n0,-5000\n0.25,-4000\n0.75,100\n1,3000\n");
  EXPECT_EQ(target.share, (std::vector<double>{0.25, 0.75}));
  EXPECT_EQ(target.elevation_m, (std::vector<double>{-4000, 100}));
  EXPECT_EQ(target.deviation_m.size(), 2U);
  EXPECT_TRUE(target.error_m.empty());
  EXPECT_NEAR(target.fine_bin_m[500], -4000 + 0.5 * 4100, 5.0);
}

TEST_F(TargetFile, DeviationsMayStandBesideQuantiles) {
  const Target target = read("quantile,elevation_m,sigma_m\n0.1,-4000,20\n0.9,500,30\n");
  EXPECT_EQ(target.deviation_m, (std::vector<double>{20, 30}));
  EXPECT_EQ(target.error_m, (std::vector<double>{20, 30}));
}

TEST_F(TargetFile, RowsOfACurveAreAskedForAsExactlyAsTheCurve) {
  const Target curve = read_name("earth");
  std::string rows = "quantile,elevation_m\n";
  for (std::size_t k = 0; k < curve.share.size(); ++k) {
    rows += fmt::format("{},{}\n", curve.share[k], curve.elevation_m[k]);
  }
  const Target table = read(rows);
  ASSERT_EQ(table.share.size(), curve.share.size());
  // 50 m in height, and the rise over 0.5 % of the area along the line through the rows.
  for (std::size_t k = 1; k + 1 < curve.share.size(); ++k) {
    const double rise_m = 0.25 * (curve.elevation_m[k + 1] - curve.elevation_m[k - 1]);
    EXPECT_NEAR(table.deviation_m[k], std::hypot(50.0, rise_m), 1e-6) << k;
  }
  for (const double error_m : {0.0, 7.0}) {
    const std::size_t known = error_m > 0.0 ? curve.share.size() : 0;
    EXPECT_EQ(read_name("earth", {.error_m = error_m}).error_m,
              std::vector<double>(known, error_m));
    EXPECT_EQ(read(rows, {.error_m = error_m}).error_m, std::vector<double>(known, error_m));
  }
}

TEST_F(TargetFile, APartOfTheCurveIsComparedThereAlone) {
  const Target target = read("quantile,elevation_m\n0.2,-4000\n0.4,-3000\n0.6,-1000\n");
  EXPECT_EQ(target.share_from, 0.2);
  EXPECT_EQ(target.share_to, 0.6);
  EXPECT_EQ(target.first_bin(), 200);
  EXPECT_EQ(target.end_bin(), 600);
  std::vector<double> planet = target.fine_bin_m;
  for (int k = 0; k < 200; ++k) planet[k] = -9000.0;
  for (int k = 600; k < kFineBins; ++k) planet[k] = 9000.0;
  EXPECT_EQ(wasserstein_m(planet, target), 0.0);
  for (int k = 200; k < 600; ++k) planet[k] += 30.0;
  EXPECT_NEAR(wasserstein_m(planet, target), 30.0, 1e-9);
  EXPECT_NEAR(spread_m({planet, target.fine_bin_m}, target), 30.0 / std::sqrt(2.0), 1e-9);
  const Target narrow = read("quantile,elevation_m\n0.5001,10\n0.5002,11\n");
  EXPECT_EQ(narrow.first_bin(), 500);
  EXPECT_EQ(narrow.end_bin(), 501);
}

TEST_F(TargetFile, BinsAreAHistogram) {
  const Target target =
      read("lower_m,upper_m,fraction\n-5000,-3000,0.5\n-3000,0,0\n0,1000,0.3\n1000,2000,0.2\n");
  double mean = 0.0;
  for (const double bin : target.fine_bin_m) mean += bin / kFineBins;
  EXPECT_NEAR(mean, 0.5 * -4000 + 0.3 * 500 + 0.2 * 1500, 1.0);
  EXPECT_EQ(target.share.size(), 100U);
}

TEST_F(TargetFile, BadOnesAreRefusedWithTheirLine) {
  EXPECT_THAT(message("height\n1\n2\n"), HasSubstr(":1: must be quantile,elevation_m"));
  EXPECT_THAT(message("quantile,elevation_m\n0.1,5\n0.1,6\n"), HasSubstr(":3: quantiles must"));
  EXPECT_THAT(message("quantile,elevation_m\n0.1,5\n1.1,6\n"), HasSubstr(":3: a quantile must"));
  EXPECT_THAT(message("quantile,elevation_m\n0.1,x\n0.2,5\n"),
              HasSubstr(":2: elevation_m: must be a number"));
  EXPECT_THAT(message("quantile,elevation_m\n0.1,5\n0.2,\n"),
              HasSubstr(":3: elevation_m: must be a number"));
  EXPECT_THAT(message("quantile,elevation_m\n0.1,5\n0.2,1,5\n"),
              HasSubstr(":3: must have 2 cells"));
  EXPECT_THAT(message("# x\nquantile,elevation_m\n0,-5000\n0.4,100\n0.6,50\n1,3000\n"),
              HasSubstr(":5: elevations must not fall"));
  EXPECT_THAT(message("quantile,elevation_m\n0.1,5\n"), HasSubstr("two rows"));
  EXPECT_THAT(message("lower_m,upper_m,fraction\n0,1,0.5\n2,3,0.5\n"), HasSubstr(":3: a bin"));
  EXPECT_THAT(message("lower_m,upper_m,fraction\n0,1,0.5\n1,3,0.2\n"), HasSubstr("sum to 0.7"));
}

TEST(Ranking, QuantilesAndBinsAreThoseOfTheArea) {
  const Grid grid = Grid::sphere(64, 32, {6371e3, 0.0});
  // The sine of latitude is spread evenly over the sphere.
  std::vector<double> field(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    field[c] = grid.unit_vector(grid.column(c), grid.row(c))[2];
  }
  const Ranking ranking(grid, field);
  for (const double share : {0.1, 0.37, 0.5, 0.93}) {
    EXPECT_NEAR(ranking.quantile(share), 2.0 * share - 1.0, 0.06);
    EXPECT_NEAR(ranking.density(share, 0.1), 0.5, 0.1);
    const auto window = ranking.window(share, 0.05);
    EXPECT_NEAR(ranking.mean(window, std::span<const double>(field)), 2.0 * share - 1.0, 0.06);
  }
  const auto bins = ranking.bin_means(10);
  double mean = 0.0;
  for (const double bin : bins) mean += bin / 10;
  EXPECT_NEAR(mean, 0.0, 1e-12);
  EXPECT_NEAR(bins[9], 0.9, 0.01);
}

/// Of cells drawn at random from a curve that bends, where a plain mean over the window is off.
TEST(Ranking, WindowsOfQuantilesKeepTheirPlaceAndAreSmoother) {
  const Grid grid = Grid::sphere(128, 64, {6371e3, 0.0});
  const RandomStream random(1, "test.quantiles");
  constexpr double kShare = 0.02, kHalfWidth = 0.01;
  const double truth = std::log(kShare);
  double of_window = 0.0, of_mean = 0.0, scatter_of_window = 0.0, scatter_of_cells = 0.0;
  constexpr int kDraws = 200;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<double> field(grid.size());
    for (Index c = 0; c < grid.size(); ++c) {
      field[c] = std::log(random.uniform(std::uint64_t(draw), std::uint64_t(c), 0.0, 1.0));
    }
    const Ranking ranking(grid, field);
    const auto mean = [&](const Ranking::Window& window) {
      return ranking.mean(window, std::span<const double>(field)) - truth;
    };
    const double smooth = mean(ranking.quantile_window(kShare, kHalfWidth));
    const double of_cells = ranking.quantile(kShare) - truth;
    of_window += smooth / kDraws;
    of_mean += mean(ranking.window(kShare, kHalfWidth)) / kDraws;
    scatter_of_window += smooth * smooth / kDraws;
    scatter_of_cells += of_cells * of_cells / kDraws;
  }
  // Four standard errors of the mean of the draws.
  EXPECT_NEAR(of_window, 0.0, 4.0 * std::sqrt(scatter_of_window / kDraws));
  EXPECT_LT(of_mean, -0.03);
  EXPECT_LT(scatter_of_window, scatter_of_cells);
}

TEST(CalibrationSettings, ListsAreRead) {
  EXPECT_EQ(read_seeds("s", "1-3, 7"), (std::vector<std::int64_t>{1, 2, 3, 7}));
  EXPECT_TRUE(read_seeds("s", "").empty());
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(read_seeds("s", fmt::format("{}", kLast)), (std::vector<std::int64_t>{kLast}));
  EXPECT_EQ(read_seeds("s", fmt::format("{}-{}", kLast - 1, kLast)),
            (std::vector<std::int64_t>{kLast - 1, kLast}));
  EXPECT_THROW((void)read_seeds("s", "9223372036854775808"), ConfigurationError);
  EXPECT_THROW((void)read_seeds("s", fmt::format("0-{}", kLast)), ConfigurationError);
  EXPECT_THROW((void)read_seeds("s", "3-1"), ConfigurationError);
  EXPECT_THROW((void)read_seeds("s", "1, 1"), ConfigurationError);
  EXPECT_THROW((void)read_seeds("s", "one"), ConfigurationError);
  const auto priors = read_estimates("p", "a.b = 1.5 +- 0.25, c.d = -2e3+-1");
  ASSERT_EQ(priors.size(), 2U);
  EXPECT_EQ(priors[1].mean, -2000.0);
  EXPECT_THROW((void)read_estimates("p", "a.b = 1"), ConfigurationError);
  EXPECT_THROW((void)read_estimates("p", "a.b = 1 +- 0"), ConfigurationError);
  EXPECT_EQ(read_ranges("b", "a.b = -1 .. 0.5").front().high, 0.5);
  EXPECT_THROW((void)read_ranges("b", "a.b = 2 .. 1"), ConfigurationError);
  EXPECT_THROW((void)read_names("f", "a, a"), ConfigurationError);
}

}  // namespace
}  // namespace geo::calibration
