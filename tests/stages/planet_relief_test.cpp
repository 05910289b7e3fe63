// Planets from plates to relief.
#include "geo/stages/isostasy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geo/kernels/quantiles.hpp"
#include "geo/stages/erosion.hpp"
#include "geo/stages/plates.hpp"

namespace geo {
namespace {

void run(const Stage& stage, State& state, Context& context) {
  StageIo io(state, stage.info());
  context.budget.clear();
  stage.run(io, context);
}

struct Made {
  State state;
  Context context;
};

Made planet(int nx, std::uint64_t seed, IsostasyParameters isostasy = {},
            PlatesParameters plates = {}, Planet body = {}) {
  Made made{State(std::make_shared<Grid>(Grid::sphere(nx, nx / 2))), {}};
  made.context.seed = seed;
  made.context.planet = body;
  run(*make_plates_stage(std::move(plates)), made.state, made.context);
  run(*make_isostasy_stage(std::move(isostasy)), made.state, made.context);
  return made;
}

IsostasyParameters blueprint() {
  IsostasyParameters p;
  p.crust = "blueprint";
  p.compensation = "airy-dry";
  p.continental_km = 43.0;
  p.thickness_noise_km = 10.0;
  p.collision_km = 22.0;
  p.deformation_smoothing_km = 90.0;
  return p;
}

PlatesParameters whole_plates() {
  PlatesParameters p;
  p.continents = "plates";
  return p;
}

void expect_in_range(const State& state) {
  const auto z = state.read(field::elevation), thick = state.read(field::crust_thickness);
  const auto density = state.read(field::crust_density), k = state.read(field::erodibility);
  const auto share = state.read(field::continental_fraction);
  const auto rock = state.read(field::rock_type);
  for (Index cell = 0; cell < state.grid().size(); ++cell) {
    ASSERT_TRUE(z[cell] > -14000.0F && z[cell] < 14000.0F) << z[cell];
    ASSERT_TRUE(thick[cell] >= 2900.0F && thick[cell] <= 80001.0F);
    ASSERT_TRUE(density[cell] > 2600.0F && density[cell] < 3000.0F);
    ASSERT_TRUE(k[cell] >= 4.9e-7F && k[cell] <= 4.6e-6F);
    ASSERT_TRUE(share[cell] >= 0.0F && share[cell] <= 1.0F);
    ASSERT_TRUE(rock[cell] >= 0 && rock[cell] <= 5);
    for (const auto* spec : {&field::convergent_deformation, &field::divergent_deformation,
                             &field::transform_deformation, &field::lithospheric_weakness}) {
      const float value = state.read(*spec)[cell];
      ASSERT_TRUE(value >= 0.0F && value <= 1.0F) << spec->name;
    }
  }
}

TEST(PlanetRelief, OfManySeedsStaysInRangeAndTheSeaCoversItsShare) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const bool by_blueprint = seed % 4 == 0;
    const Made made =
        by_blueprint ? planet(128, seed, blueprint(), whole_plates()) : planet(128, seed);
    expect_in_range(made.state);
    EXPECT_NEAR(fraction_below(made.state.grid(), made.state.read(field::elevation), 0.0F), 0.71,
                1e-4);
  }
}

TEST(PlanetRelief, BlueprintElevationIsThatOfAFloatingColumn) {
  IsostasyParameters p = blueprint();
  p.noise_factor = 0.0;
  const Made made = planet(256, 5, p, whole_plates());
  const auto z = made.state.read(field::elevation);
  const auto thick = made.state.read(field::crust_thickness);
  const auto density = made.state.read(field::crust_density);
  const double shift = made.context.budget.at("sea_level_shift_m");
  for (Index cell = 0; cell < made.state.grid().size(); ++cell) {
    ASSERT_NEAR(z[cell], thick[cell] * (3300.0 - density[cell]) / 3300.0 - shift, 0.5);
  }
}

TEST(PlanetRelief, SeaLevelCanFollowAVolumeOfWater) {
  Planet body;
  body.sea_level = "volume";
  IsostasyParameters p;
  p.shelf_depth_m = 0.0;
  const Made made = planet(256, 3, p, {}, body);
  const Grid& grid = made.state.grid();
  const auto z = made.state.read(field::elevation);
  double volume = 0.0;
  for (Index cell = 0; cell < grid.size(); ++cell) {
    volume += grid.area_m2(grid.row(cell)) * std::max(0.0F, -z[cell]);
  }
  EXPECT_NEAR(volume, 1.334e18, 1e-5 * 1.334e18);
}

TEST(PlanetRelief, ReliefHasTwoModesAndShelves) {
  const Made made = planet(512, 2);
  const auto share = [&](float low, float high) {
    const auto z = made.state.read(field::elevation);
    return fraction_below(made.state.grid(), z, high) - fraction_below(made.state.grid(), z, low);
  };
  EXPECT_GT(share(-5500, -4000), 0.25);
  EXPECT_GT(share(-200, 800), 0.20);
  EXPECT_LT(share(-2500, -1500), 0.07);
  EXPECT_GT(share(-200, 0), 0.03);
}

TEST(PlanetRelief, IsTheSameReliefAtEveryResolution) {
  const Made coarse = planet(256, 4), fine = planet(1024, 4);
  const auto few = coarse.state.read(field::elevation);
  const auto many = fine.state.read(field::elevation);
  const Grid& grid = coarse.state.grid();
  double same = 0.0;
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const int i = grid.column(cell), j = grid.row(cell);
    int land = 0;
    for (int v = 0; v < 4; ++v) {
      for (int u = 0; u < 4; ++u)
        land += many[fine.state.grid().cell(4 * i + u, 4 * j + v)] >= 0.0F;
    }
    if ((few[cell] >= 0.0F) == (land >= 8)) same += grid.area_m2(j) / grid.total_area_m2();
  }
  EXPECT_GT(same, 0.95);
}

// What a row holds must not depend on how near to a pole it lies.
TEST(PlanetRelief, PolarRowsAreNoRougherThanOthers) {
  double polar = 0.0, middle = 0.0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Made made = planet(512, seed);
    const Grid& grid = made.state.grid();
    const auto z = made.state.read(field::elevation);
    const auto slope2 = [&](double from_deg, double to_deg) {
      double sum = 0.0, area = 0.0;
      for (int j = 1; j + 1 < grid.ny(); ++j) {
        const double latitude = std::abs(grid.latitude_deg(j));
        if (latitude < from_deg || latitude > to_deg) continue;
        // East-west slope over a constant distance of about 160 km.
        const int step = std::max(1, static_cast<int>(160e3 / grid.spacing_east_m(j)));
        if (step * grid.spacing_east_m(j) > 400e3) continue;
        for (int i = 0; i < grid.nx(); ++i) {
          const double rise = z[grid.cell((i + step) % grid.nx(), j)] - z[grid.cell(i, j)];
          const double slope = rise / (step * grid.spacing_east_m(j));
          sum += slope * slope * grid.area_m2(j);
          area += grid.area_m2(j);
        }
      }
      return sum / area;
    };
    polar += slope2(72.0, 86.0);
    middle += slope2(0.0, 72.0);
  }
  EXPECT_LT(polar / middle, 2.0);
  EXPECT_GT(polar / middle, 0.4);
}

TEST(PlanetErosion, KeepsTheSeaAndClosesItsBudget) {
  Made made = planet(256, 9);
  run(*make_erosion_stage(), made.state, made.context);
  EXPECT_NEAR(fraction_below(made.state.grid(), made.state.read(field::elevation), 0.0F), 0.71,
              1e-4);
  EXPECT_LT(std::abs(made.context.budget.at("rock_closing_error")), 1e-6);
  EXPECT_GT(made.context.budget.at("rock_eroded_m3"), 1e15);
  EXPECT_GT(made.context.budget.at("rock_uplifted_m3"), 1e15);
}

}  // namespace
}  // namespace geo
