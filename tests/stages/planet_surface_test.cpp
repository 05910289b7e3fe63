// Planets from plates to relief.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geo/kernels/crust/ocean_depth.hpp"
#include "geo/kernels/numerics/quantiles.hpp"
#include "geo/stages/erosion/erosion.hpp"
#include "geo/stages/isostasy/isostasy.hpp"
#include "geo/stages/plates/plates.hpp"

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

TEST(PlanetSurface, SeaLevelCanFollowAVolumeOfWater) {
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

TEST(PlanetSurface, ReliefHasTwoModesAndShelves) {
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

// The choice matters for either crust, and stiffness moves no weight of the whole planet.
TEST(PlanetSurface, EachCompensationMakesAnotherRelief) {
  for (const std::string crust : {"margins", "blueprint"}) {
    std::vector<std::vector<float>> reliefs;
    for (const std::string compensation : {"airy-dry", "airy", "flexural"}) {
      IsostasyParameters p;
      p.crust = crust;
      p.compensation = compensation;
      const Made made = planet(128, 3, p);
      const auto z = made.state.read(field::elevation);
      EXPECT_NEAR(fraction_below(made.state.grid(), z, 0.0F), 0.71, 1e-4);
      reliefs.emplace_back(z.begin(), z.end());
    }
    EXPECT_NE(reliefs[0], reliefs[1]) << crust;
    EXPECT_NE(reliefs[1], reliefs[2]) << crust;
  }
}

/// Thickness with its pores of sediment that is so thick without them.
double with_pores_m(double solid_m) {
  double low = solid_m, high = 1e5;
  while (high - low > 1e-6)
    (solid_thickness_m(0.5 * (low + high)) < solid_m ? low : high) = 0.5 * (low + high);
  return low;
}

// A sag that is seen to lie lower by w has subsided by w / (1 - f), and the share f of that is
// filled: three times as much sediment for f = 3/4 as for 1/2.
TEST(PlanetSurface, SedimentFillsItsShareOfOldBasins) {
  const auto filled = [](double share) {
    IsostasyParameters p;
    p.basin_fill = share;
    p.shelf_depth_m = 0.0;  // shelves have sediment of their own
    return planet(256, 4, p);
  };
  const Made bare = filled(0.0), half = filled(0.5), most = filled(0.75);
  const auto fraction = bare.state.read(field::continental_fraction);
  const auto none_m = bare.state.read(field::sediment_thickness);
  const auto half_m = half.state.read(field::sediment_thickness);
  const auto most_m = most.state.read(field::sediment_thickness);
  Index in_basins = 0, on_shields = 0;
  for (Index c = 0; c < static_cast<Index>(fraction.size()); ++c) {
    if (fraction[c] < 1.0F) continue;
    EXPECT_EQ(none_m[c], 0.0F);
    if (half_m[c] == 0.0F) {
      EXPECT_EQ(most_m[c], 0.0F);
      ++on_shields;
    } else if (half_m[c] > 10.0F && bare.state.read(field::convergent_deformation)[c] == 0.0F) {
      EXPECT_NEAR(with_pores_m(most_m[c]) / with_pores_m(half_m[c]), 3.0, 1e-3);
      ++in_basins;
    }
  }
  EXPECT_GT(in_basins, 200);
  EXPECT_GT(on_shields, 1000);
  EXPECT_TRUE(
      std::ranges::equal(half.state.read(field::elevation), most.state.read(field::elevation)))
      << "basins are not filled higher than they are seen";
}

// The Earth's land has 935 m of sediment as rock without pores, a quarter of it none [laske2013].
TEST(PlanetSurface, BasinsHaveTheEarthsSedimentAndShieldsNone) {
  double sum = 0.0, bare = 0.0, all = 0.0;
  for (const std::uint64_t seed : {21, 22, 23, 24}) {
    const Made made = planet(256, seed);
    const Grid& grid = made.state.grid();
    const auto z = made.state.read(field::elevation);
    const auto sediment_m = made.state.read(field::sediment_thickness);
    for (Index c = 0; c < grid.size(); ++c) {
      if (z[c] < 0.0F) continue;
      const double area_m2 = grid.area_m2(grid.row(c));
      all += area_m2;
      sum += area_m2 * sediment_m[c];
      if (sediment_m[c] < 100.0F) bare += area_m2;
    }
  }
  EXPECT_NEAR(sum / all, 935.0, 470.0);
  EXPECT_GT(bare / all, 0.15);
  EXPECT_LT(bare / all, 0.60);
}

// Old floor has more sediment than young floor, and rivers add to what lies there.
TEST(PlanetErosion, AddsToTheSedimentOfTheSeaFloor) {
  Made made = planet(256, 9);
  const Grid& grid = made.state.grid();
  const auto age_myr = made.state.read(field::crust_age);
  const auto fraction = made.state.read(field::continental_fraction);
  const auto thickness_m = made.state.read(field::sediment_thickness);
  const std::vector<float> before_m(thickness_m.begin(), thickness_m.end());
  const auto z = made.state.read(field::elevation);
  const auto mean_m = [&](auto&& counts) {
    double sum = 0.0, area_m2 = 0.0;
    for (Index c = 0; c < grid.size(); ++c) {
      if (!counts(c)) continue;
      sum += grid.area_m2(grid.row(c)) * before_m[c];
      area_m2 += grid.area_m2(grid.row(c));
    }
    return sum / area_m2;
  };
  const double young_m = mean_m([&](Index c) { return fraction[c] < 0.01F && age_myr[c] < 10.0F; });
  const double old_m = mean_m([&](Index c) { return fraction[c] < 0.01F && age_myr[c] > 80.0F; });
  EXPECT_LT(young_m, 150.0);
  EXPECT_GT(old_m, 250.0);

  run(*make_erosion_stage(), made.state, made.context);
  const auto after_m = made.state.read(field::sediment_thickness);
  const auto laid_m_yr = made.state.read(field::deposition_rate);
  const ErosionParameters p;
  const double years = static_cast<double>(p.steps) * p.time_step_yr;
  double added_m = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    if (fraction[c] > 0.01F || z[c] > -3000.0F) continue;
    EXPECT_NEAR(after_m[c] - before_m[c], years * laid_m_yr[c], 0.01 + 1e-5 * after_m[c]);
    added_m += after_m[c] - before_m[c];
  }
  EXPECT_GT(added_m, 0.0);
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
