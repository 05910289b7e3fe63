#include "geo/stages/hydrology/hydrology.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "support/terrain.hpp"

namespace geo {
namespace {

State run(State state, Context& context, HydrologyParameters parameters = {}) {
  const auto stage = make_hydrology_stage(parameters);
  StageIo io(state, stage->info());
  stage->run(io, context);
  return state;
}

State random_planet(const Grid& grid, std::uint64_t seed) {
  State state(std::make_shared<Grid>(grid));
  state.set(field::elevation, test::random_terrain(grid, seed));
  const RandomStream random(seed, "climate");
  const auto t = state.update(field::temperature), p = state.update(field::precipitation);
  const auto e = state.update(field::potential_evapotranspiration);
  for (Index c = 0; c < grid.size(); ++c) {
    t[c] = 10;
    p[c] = static_cast<float>(random.uniform(c, 0, 0, 1500));
    e[c] = static_cast<float>(random.uniform(c, 1, 0, 2500));
  }
  return state;
}

TEST(Hydrology, WaterBudgetClosesOnAHundredTerrains) {
  for (std::uint64_t seed = 0; seed < 25; ++seed) {
    for (const Grid& grid : test::small_grids()) {
      SCOPED_TRACE(seed);
      Context context;
      run(random_planet(grid, seed), context);
      ASSERT_LT(std::abs(context.budget.at("water_closing_error")), 1e-9);
      ASSERT_GT(context.budget.at("runoff_to_sea_m3_s"), 0);
    }
  }
}

TEST(Hydrology, EveryLandCellReachesTheSeaOrAnEndorheicBottomWithoutClimbingTheWater) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    for (const Grid& grid : test::small_grids()) {
      SCOPED_TRACE(seed);
      Context context;
      const State state = run(random_planet(grid, seed), context);
      const auto z = state.read(field::elevation), depth = state.read(field::lake_depth);
      const auto receiver = state.read(field::flow_receiver);
      const auto outlets = find_outlets(grid, z);
      std::vector<float> filled(grid.size());
      fill_depressions(grid, z, outlets, filled);
      const auto basin = state.read(field::basin_id), lake = state.read(field::lake_id);
      double area = 0;
      for (Index c = 0; c < grid.size(); ++c) {
        ASSERT_LE(filled[receiver[c]], std::max(filled[c], z[c]));
        ASSERT_EQ(basin[c] > 0, z[c] >= 0);
        ASSERT_EQ(lake[c] > 0, depth[c] > 0);
        if (receiver[c] == c) area += state.read(field::drainage_area)[c];
        ASSERT_GE(state.read(field::discharge)[c], 0);
      }
      EXPECT_NEAR(area / grid.total_area_m2(), 1.0, 1e-12);
    }
  }
}

TEST(Hydrology, DamsAreCutUnlessTheBasinBehindKeepsItsWater) {
  // A plateau around a bowl, with a dam of 60 m and one cell to the sea.
  const Grid grid = Grid::plane(60, 30, 1e4, 1e4);
  const auto level = [&](double rain_mm_yr, double potential_mm_yr, double closed_km2) {
    State state(std::make_shared<Grid>(grid));
    const auto z = state.update(field::elevation);
    for (Index c = 0; c < grid.size(); ++c) {
      const int i = grid.column(c), j = grid.row(c);
      const double r = std::hypot(i - 20.0, j - 15.0);
      z[c] = static_cast<float>(r < 12.5 ? 100.0 + 5.0 * r
                                : i < 33 ? 220.0
                                : i < 34 ? 160.0
                                : i < 50 ? 90.0 - i
                                         : -100.0);
    }
    for (float& t : state.update(field::temperature)) t = 15.0F;
    for (float& p : state.update(field::precipitation)) p = static_cast<float>(rain_mm_yr);
    for (float& e : state.update(field::potential_evapotranspiration)) {
      e = static_cast<float>(potential_mm_yr);
    }
    Context context;
    HydrologyParameters parameters;
    parameters.closed_basin_km2 = closed_km2;
    const State after = run(std::move(state), context, parameters);
    EXPECT_LT(std::abs(context.budget.at("water_closing_error")), 1e-9);
    double ends_on_land = 0.0;
    const auto receiver = after.read(field::flow_receiver);
    for (Index c = 0; c < grid.size(); ++c) {
      const bool inland = grid.column(c) > 5 && grid.column(c) < 34 && grid.row(c) > 0 &&
                          grid.row(c) < grid.ny() - 1;
      if (receiver[c] == c && inland) {
        ends_on_land += after.read(field::drainage_area)[c];
      }
    }
    return ends_on_land / grid.area_m2(0);
  };
  EXPECT_GT(level(150.0, 2500.0, 5000.0), 300.0);
  EXPECT_EQ(level(150.0, 2500.0, 1e9), 0.0);
  EXPECT_EQ(level(1500.0, 800.0, 5000.0), 0.0);
}

TEST(Hydrology, SameBitsForAnyNumberOfThreads) {
  const Grid grid = Grid::sphere(120, 60);
  Context context;
  omp_set_num_threads(1);
  const State one = run(random_planet(grid, 5), context);
  omp_set_num_threads(4);
  const State four = run(random_planet(grid, 5), context);
  omp_set_num_threads(omp_get_num_procs());
  for (const FieldSpec* spec : one.present()) {
    EXPECT_EQ(*one.values(*spec), *four.values(*spec)) << spec->name;
  }
}

// Where meridians converge a river along one of them cuts a valley and no slot.
TEST(Hydrology, RiversOverThePoleCutNoSlots) {
  const Grid grid = Grid::sphere(1024, 512);
  State state(std::make_shared<Grid>(grid));
  const Noise noise(11, "relief");
  const auto z = state.update(field::elevation);
  const auto t = state.update(field::temperature), p = state.update(field::precipitation);
  const auto e = state.update(field::potential_evapotranspiration);
  for (Index c = 0; c < grid.size(); ++c) {
    const auto at = grid.unit_vector(grid.column(c), grid.row(c));
    z[c] = static_cast<float>(2500 * noise.fbm(at, 6.0, 3, 0.4) + 1500 * at[0] +
                              8000 * (std::abs(at[2]) - 0.9));
    t[c] = 10;
    p[c] = 2000;
    e[c] = 200;
  }
  const std::vector<float> before(z.begin(), z.end());
  Context context;
  const State done = run(std::move(state), context);
  const auto after = done.read(field::elevation);
  int valleys = 0, slots = 0;
  for (Index c = 0; c < grid.size(); ++c) {
    const int i = grid.column(c), j = grid.row(c), nx = grid.nx();
    const float cut = before[c] - after[c];
    if (4 * grid.spacing_east_m(j) > grid.face_east_m(j) || cut < 5.0F) continue;
    ++valleys;
    const float west = after[grid.cell((i + nx - 1) % nx, j)];
    const float east = after[grid.cell((i + 1) % nx, j)];
    if (std::min(west, east) > after[c] + 0.5F * cut) ++slots;
  }
  EXPECT_GT(valleys, 1000);
  EXPECT_EQ(slots, 0);
}

// Two continents, one of them where the poles of the turned planet lie.
std::vector<double> largest_basins(bool turned) {
  const Grid grid = Grid::sphere(720, 360);
  State state(std::make_shared<Grid>(grid));
  const Noise noise(7, "relief");
  const auto z = state.update(field::elevation);
  const auto t = state.update(field::temperature), p = state.update(field::precipitation);
  const auto e = state.update(field::potential_evapotranspiration);
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      auto [x, y, up] = grid.unit_vector(i, j);
      if (turned) std::tie(x, up) = std::pair{up, -x};
      const double height =
          3000 * noise.fbm({x, y, up}, 1.2, 3, 0.4) + 900 * x * x * (1 + 0.3 * y) - 300;
      const Index c = grid.cell(i, j);
      z[c] = static_cast<float>(height);
      t[c] = 10;
      p[c] = 1000;
      e[c] = 300;
    }
  }
  Context context;
  HydrologyParameters parameters;
  parameters.carving = 0;
  const State done = run(std::move(state), context, parameters);
  std::vector<double> area;
  const auto basin = done.read(field::basin_id);
  for (Index c = 0; c < grid.size(); ++c) {
    if (basin[c] == 0) continue;
    area.resize(std::max<std::size_t>(area.size(), basin[c]), 0.0);
    area[basin[c] - 1] += grid.area_m2(grid.row(c)) / grid.total_area_m2();
  }
  area.resize(4);
  return area;
}

TEST(Hydrology, TurningThePlanetKeepsItsLargestBasins) {
  const auto upright = largest_basins(false), turned = largest_basins(true);
  for (std::size_t n = 0; n < upright.size(); ++n) {
    EXPECT_NEAR(turned[n] / upright[n], 1.0, 0.05)
        << "basin " << n + 1 << ": " << upright[n] << " of the planet";
  }
}

}  // namespace
}  // namespace geo
