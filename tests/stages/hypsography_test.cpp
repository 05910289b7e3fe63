// Planets whose heights follow a given distribution.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "geo/core/error.hpp"
#include "geo/kernels/crust/crust_columns.hpp"
#include "geo/kernels/numerics/quantiles.hpp"
#include "geo/stages/isostasy/isostasy.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {
namespace {

/// 71 % sea floor about -4.2 km, a steep margin, low land, few mountains.
const Hypsography kCurve{
    {0.0, 0.01, 0.1, 0.45, 0.62, 0.68, 0.71, 0.8, 0.92, 0.99, 1.0},
    {-9000.0, -6200.0, -5500.0, -4300.0, -3200.0, -900.0, 0.0, 280.0, 1100.0, 3900.0, 7800.0}};

double wanted(double fraction) {
  std::size_t k = 1;
  while (kCurve.fraction[k] < fraction) ++k;
  return std::lerp(
      kCurve.elevation_m[k - 1], kCurve.elevation_m[k],
      (fraction - kCurve.fraction[k - 1]) / (kCurve.fraction[k] - kCurve.fraction[k - 1]));
}

PlatesParameters following() {
  PlatesParameters p;
  p.model = "hypsography";
  return p;
}

Context context_of(std::uint64_t seed) {
  Context context;
  context.seed = seed;
  context.hypsography = kCurve;
  return context;
}

void run(const Stage& stage, State& state, std::uint64_t seed) {
  Context context = context_of(seed);
  StageIo io(state, stage.info());
  stage.run(io, context);
}

State planet(int nx, std::uint64_t seed, const PlatesParameters& parameters = following()) {
  State state(std::make_shared<Grid>(Grid::sphere(nx, nx / 2)));
  run(*make_plates_stage(parameters), state, seed);
  return state;
}

void take_as_given(State& state, std::uint64_t seed) {
  IsostasyParameters parameters;
  parameters.crust = "given";
  run(*make_isostasy_stage(parameters), state, seed);
}

double correlation(std::span<const float> a, std::span<const float> b) {
  double aa = 0, bb = 0, ab = 0, sa = 0, sb = 0;
  const double n = static_cast<double>(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    sa += a[k];
    sb += b[k];
    aa += static_cast<double>(a[k]) * a[k];
    bb += static_cast<double>(b[k]) * b[k];
    ab += static_cast<double>(a[k]) * b[k];
  }
  return (ab / n - sa / n * sb / n) /
         std::sqrt((aa / n - sa / n * sa / n) * (bb / n - sb / n * sb / n));
}

void expect_the_curve(const Grid& grid, std::span<const float> elevation_m) {
  std::vector<double> fractions;
  for (int permille = 0; permille <= 1000; ++permille) fractions.push_back(permille / 1000.0);
  const auto found = quantiles(grid, elevation_m, fractions);
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_NEAR(found[k], wanted(fractions[k]), 1.0) << fractions[k];
  }
}

TEST(Hypsography, IsThatOfThePlanetThatFloats) {
  State state = planet(1024, 7);
  take_as_given(state, 7);
  expect_the_curve(state.grid(), state.read(field::elevation));
}

TEST(Hypsography, IsThatOfPlacesInAnyOrder) {
  PlatesParameters parameters = following();
  parameters.ranking.by = "fbm";
  const State state = planet(1024, 7, parameters);
  expect_the_curve(state.grid(), state.read(field::crust_elevation));
}

TEST(Hypsography, HoldsWhereStepsLeaveFlatsBetweenThem) {
  PlatesParameters parameters = following();
  parameters.ranking.cuts = {.circles = 12, .steepness = 5000.0, .offset = 0.3};
  const State state = planet(1024, 3, parameters);
  const auto z = state.read(field::crust_elevation);
  std::vector<double> fractions;
  for (int percent = 0; percent <= 100; ++percent) fractions.push_back(percent / 100.0);
  const auto found = quantiles(state.grid(), z, fractions);
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_NEAR(found[k], wanted(fractions[k]), 3.0) << fractions[k];
  }
}

TEST(Hypsography, BringsTheCrustThatBelongsToHeights) {
  State state = planet(128, 5);
  const std::vector<float> made(state.read(field::crust_elevation).begin(),
                                state.read(field::crust_elevation).end());
  take_as_given(state, 5);
  const auto thickness = state.read(field::crust_thickness);
  const auto density = state.read(field::crust_density);
  const auto share = state.read(field::continental_fraction);
  const auto age = state.read(field::crust_age);
  for (Index c = 0; c < state.grid().size(); ++c) {
    const CrustColumn column = crust_column(made[c]);
    EXPECT_FLOAT_EQ(thickness[c], static_cast<float>(column.thickness_m));
    EXPECT_FLOAT_EQ(density[c], static_cast<float>(column.density_kg_m3));
    if (made[c] >= 0.0F) {
      EXPECT_EQ(share[c], 1.0F);
    }
    if (made[c] < -3680.0F) {
      EXPECT_EQ(share[c], 0.0F);
    }
    if (share[c] < 0.5F) {
      EXPECT_LE(age[c], 150.0F);
    }
  }
}

TEST(Hypsography, IsOnePlateAtRest) {
  const State state = planet(64, 2);
  const auto all = [&](const auto& spec, auto value) {
    const auto values = state.read(spec);
    return std::all_of(values.begin(), values.end(), [&](auto v) { return v == value; });
  };
  EXPECT_TRUE(all(field::plate_id, 0));
  EXPECT_TRUE(all(field::boundary_type, 0));
  EXPECT_TRUE(all(field::orogeny_type, 0));
  EXPECT_TRUE(all(field::plate_velocity_east, 0.0F));
  EXPECT_TRUE(all(field::plate_velocity_north, 0.0F));
  EXPECT_TRUE(all(field::boundary_strength, 0.0F));
}

TEST(Hypsography, IsTheSamePlanetOnEveryGrid) {
  const State fine = planet(288, 6), coarse = planet(96, 6);
  std::vector<float> seen(coarse.grid().size());
  for (Index c = 0; c < coarse.grid().size(); ++c) {
    seen[c] = fine.read(field::crust_elevation)[fine.grid().cell(3 * coarse.grid().column(c) + 1,
                                                                 3 * coarse.grid().row(c) + 1)];
  }
  EXPECT_GT(correlation(seen, coarse.read(field::crust_elevation)), 0.999);
}

TEST(Hypsography, FollowsARankingThatIsGiven) {
  // A mask: land in one band of longitudes that covers 29 %.
  State state(std::make_shared<Grid>(Grid::sphere(200, 100)));
  const Grid& grid = state.grid();
  std::vector<float> mask(grid.size());
  for (Index c = 0; c < grid.size(); ++c) mask[c] = grid.column(c) < 58 ? 1.0F : 0.0F;
  state.set(field::ranking, mask);
  run(*make_plates_stage(following()), state, 1);
  const auto z = state.read(field::crust_elevation);
  for (Index c = 0; c < grid.size(); ++c) {
    EXPECT_EQ(z[c] > 0.0F, mask[c] > 0.5F) << c;
  }
  EXPECT_LT(quantile(grid, z, 0.3), -4000.0F);  // ties are settled: the floor is no plain
}

TEST(Hypsography, RefusesARankingWithoutOrder) {
  State state(std::make_shared<Grid>(Grid::sphere(16, 8)));
  state.set(field::ranking, std::vector<float>(128, 4.0F));
  EXPECT_THROW(run(*make_plates_stage(following()), state, 1), InputError);
}

TEST(Hypsography, IsWhatDriftingPlatesStartFrom) {
  PlatesParameters parameters;
  parameters.model = "sphere";
  parameters.initial_elevation = "hypsography";
  parameters.growth.count = 12;
  parameters.samples = 6000;
  parameters.ocean_floor = "age";
  parameters.time_myr = 0.0;
  const State start = planet(128, 4, parameters), still = planet(128, 4);
  // Samples are 330 km apart: finer relief is not theirs.
  EXPECT_GT(correlation(start.read(field::crust_elevation), still.read(field::crust_elevation)),
            0.9);
  // What is given lies there at time 0, with no spin-up before.
  parameters.spin_up_myr = 60.0;
  EXPECT_EQ(*planet(128, 4, parameters).values(field::crust_elevation),
            *start.values(field::crust_elevation));
  parameters.time_myr = 20.0;
  const State moved = planet(128, 4, parameters);
  for (const float z : moved.read(field::crust_elevation)) ASSERT_TRUE(std::isfinite(z));
}

TEST(Hypsography, NeedsACurve) {
  State state(std::make_shared<Grid>(Grid::sphere(16, 8)));
  const auto stage = make_plates_stage(following());
  StageIo io(state, stage->info());
  Context context;
  EXPECT_THROW(stage->run(io, context), ConfigurationError);
}

}  // namespace
}  // namespace geo
