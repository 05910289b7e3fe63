// Columns that float, the floor of oceans, and distances from plate boundaries.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geo/core/error.hpp"
#include "geo/core/field.hpp"
#include "geo/kernels/crust/airy.hpp"
#include "geo/kernels/crust/ocean_depth.hpp"
#include "geo/kernels/numerics/nearest_source.hpp"
#include "geo/kernels/plates/growth/convergent_margins.hpp"
#include "geo/kernels/remapping/cubic_rows.hpp"
#include "support/terrain.hpp"

namespace geo {
namespace {

constexpr double kRadius_km = 6371.0;

TEST(Airy, FreeboardOfTheBlueprint) {
  EXPECT_NEAR(airy_freeboard_m(43e3, 2800.0, 3300.0), 43000.0 * 5.0 / 33.0, 1e-9);
  EXPECT_NEAR(airy_freeboard_m(7e3, 2900.0, 3300.0), 848.4848, 1e-3);
}

TEST(Airy, ElevationsAgainstTheRidge) {
  const AiryDatum datum;
  EXPECT_NEAR(datum.water_load_factor(), 1.4537, 1e-4);
  const auto elevation = [&](double thickness_km, double lithosphere) {
    return datum.loaded(datum.dry_elevation_m(1e3 * thickness_km, 2800.0, lithosphere));
  };
  EXPECT_NEAR(elevation(36.4, 1.0), 750.0, 5.0);
  EXPECT_NEAR(elevation(30.0, 1.0), -320.0, 5.0);
  EXPECT_NEAR(elevation(70.0, 1.0), 5840.0, 5.0);
  EXPECT_NEAR(elevation(36.0, 0.0), 2820.0, 10.0);
}

TEST(Airy, OceanFloorStandsAtTheDepthThatItsLithosphereGives) {
  const AiryDatum datum;
  for (const double depth_m : {2600.0, 4000.0, 5651.0}) {
    const double lithosphere = datum.lithosphere_of_depth(depth_m);
    EXPECT_NEAR(datum.loaded(datum.dry_elevation_m(7e3, 2900.0, lithosphere)), -depth_m, 1e-6);
  }
  EXPECT_NEAR(datum.lithosphere_of_depth(2600.0), 0.0, 1e-12);
}

TEST(OceanDepth, ValuesOfBothModels) {
  const std::array<double, 7> age{1, 10, 20, 40, 60, 100, 150};
  const std::array<double, 7> depth{2965, 3754, 4233, 4838, 5185, 5498, 5613};
  for (std::size_t k = 0; k < age.size(); ++k) {
    // At 20 Myr the two branches of the fit meet within 2 m; the table has the square root's.
    EXPECT_NEAR(ocean_depth_m(age[k]), depth[k], age[k] == 20.0 ? 2.0 : 0.6) << age[k] << " Myr";
  }
  EXPECT_DOUBLE_EQ(ocean_depth_m(-3.0), 2600.0);
  EXPECT_NEAR(ocean_depth_m(49.0, DepthModel::ps77), 4950.0, 1e-9);
  EXPECT_NEAR(ocean_depth_m(125.6, DepthModel::ps77), 6400.0 - 3200.0 * std::exp(-2.0), 1e-9);
  EXPECT_NEAR(ocean_heat_flow_mw_m2(25.0), 102.0, 1e-9);
  EXPECT_NEAR(ocean_heat_flow_mw_m2(1e4), 48.0, 1e-9);
}

TEST(OceanDepth, FarFromLandSedimentGivesEarthsMedians) {
  // Median depths of Earth's floor by age; a fifth of a kilometre is what plateaus leave open.
  const AiryDatum datum;
  const std::array<std::pair<double, double>, 5> median{
      {{1, 2979}, {15, 3757}, {50, 4639}, {90, 4922}, {130, 4870}}};
  for (const auto& [age_myr, depth_m] : median) {
    const double floor =
        ocean_depth_m(age_myr) -
        datum.rise_per_sediment() * deep_sediment_m(DeepSediment{}, age_myr, 700.0);
    EXPECT_NEAR(floor, depth_m, 230.0) << age_myr << " Myr";
  }
}

TEST(OceanDepth, SedimentGrowsWithAgeAndThinsAwayFromLand) {
  const DeepSediment sediment;
  for (double age = 0.0; age < 180.0; age += 10.0) {
    EXPECT_LT(deep_sediment_m(sediment, age, 500.0), deep_sediment_m(sediment, age + 10.0, 500.0));
    EXPECT_GE(deep_sediment_m(sediment, age, 100.0), deep_sediment_m(sediment, age, 900.0));
  }
  EXPECT_EQ(deep_sediment_m(sediment, 0.0, 0.0), 0.0);
}

// More than 800 km from continents [laske2013, muller2008].
TEST(OceanDepth, FarFromLandSedimentIsAsThickAsTheEarths) {
  const std::array<std::pair<double, double>, 3> thickness{{{5, 60}, {45, 175}, {110, 280}}};
  for (const auto& [age_myr, thick_m] : thickness) {
    EXPECT_NEAR(deep_sediment_thickness_m(DeepSediment{}, age_myr, 1e5), thick_m, 0.15 * thick_m);
  }
}

TEST(OceanDepth, SedimentHasFewerPoresTheDeeperItLies) {
  EXPECT_EQ(solid_thickness_m(0.0), 0.0);
  EXPECT_NEAR(solid_thickness_m(1.0), 0.37, 1e-3);  // 0.63 of it is water
  // Against a sum over thin layers.
  double solid_m = 0.0;
  for (double top_m = 0.0; top_m < 3000.0; top_m += 1.0) {
    solid_m += 1.0 - 0.63 * std::exp(-(top_m + 0.5) / 1961.0);
    if (top_m == 499.0) EXPECT_NEAR(solid_thickness_m(500.0), solid_m, 0.01);
  }
  EXPECT_NEAR(solid_thickness_m(3000.0), solid_m, 0.01);
}

std::vector<std::uint8_t> scattered(const Grid& grid, std::uint64_t seed, double share) {
  const RandomStream random(seed, "marks");
  std::vector<std::uint8_t> marked(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) marked[cell] = random.uniform(cell) < share;
  return marked;
}

TEST(NearestSource, DistancesAreThoseOfBruteForce) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const double share : {0.0005, 0.01, 0.2}) {
      const Grid grid = Grid::sphere(96, 48);
      auto marked = scattered(grid, seed, share);
      marked[grid.cell(7, 47)] = 1;  // beside a pole
      const auto found = distance_to_marked_km(grid, marked);
      for (Index cell = 0; cell < grid.size(); ++cell) {
        const auto at = grid.unit_vector(grid.column(cell), grid.row(cell));
        double least = 1e9;
        for (Index other = 0; other < grid.size(); ++other) {
          if (marked[other] == 0) continue;
          const auto p = grid.unit_vector(grid.column(other), grid.row(other));
          least = std::min(
              least, std::acos(std::clamp(at[0] * p[0] + at[1] * p[1] + at[2] * p[2], -1.0, 1.0)));
        }
        // Handing on from cell to cell may miss the nearest by a fraction of a cell (208 km).
        ASSERT_NEAR(found[cell], kRadius_km * least, 40.0) << "seed " << seed << " cell " << cell;
        ASSERT_GE(found[cell], kRadius_km * least - 1.0);
      }
    }
  }
}

TEST(NearestSource, OnePointMakesCirclesAtAnyLatitude) {
  const Grid grid = Grid::sphere(180, 90);
  for (const int row : {0, 44, 70, 88}) {
    std::vector<std::uint8_t> marked(grid.size());
    marked[grid.cell(3, row)] = 1;
    const auto distance = distance_to_marked_km(grid, marked);
    const auto p = grid.unit_vector(3, row);
    for (Index cell = 0; cell < grid.size(); ++cell) {
      const auto q = grid.unit_vector(grid.column(cell), grid.row(cell));
      const double chord = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
      // Chords in single precision tell little of distances near the antipode.
      const double expected = 2.0 * kRadius_km * std::asin(std::min(1.0, 0.5 * chord));
      ASSERT_NEAR(distance[cell], expected, expected < 19'500.0 ? 0.05 : 5.0);
    }
  }
}

TEST(NearestSource, NothingMarkedIsFarFromEverything) {
  const Grid grid = Grid::sphere(16, 8);
  const auto distance = distance_to_marked_km(grid, std::vector<std::uint8_t>(grid.size()));
  EXPECT_EQ(*std::min_element(distance.begin(), distance.end()), 1e9F);
}

TEST(Deformation, IsTheLargestOfDecayingStrengths) {
  const Grid grid = Grid::sphere(128, 64);
  constexpr std::int8_t kType = static_cast<std::int8_t>(BoundaryType::convergent);
  const double length_km = 900.0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const RandomStream random(seed, "strengths");
    std::vector<std::int8_t> type(grid.size());
    std::vector<float> strength(grid.size());
    std::vector<Index> sources;
    for (Index cell = 0; cell < grid.size(); ++cell) {
      if (random.uniform(cell, 1) > 0.01) continue;
      type[cell] = static_cast<std::int8_t>(1 + static_cast<int>(3 * random.uniform(cell, 2)));
      strength[cell] = static_cast<float>(random.uniform(cell, 3));
      if (type[cell] == kType) sources.push_back(cell);
    }
    const auto found = propagated_deformation(grid, type, strength, kType, length_km);
    for (Index cell = 0; cell < grid.size(); ++cell) {
      const auto p = grid.unit_vector(grid.column(cell), grid.row(cell));
      double largest = 0.0;
      for (const Index source : sources) {
        const auto q = grid.unit_vector(grid.column(source), grid.row(source));
        const double chord = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
        const double km = 2.0 * kRadius_km * std::asin(std::min(1.0, 0.5 * chord));
        largest = std::max(largest, strength[source] * std::exp(-km / length_km));
      }
      ASSERT_NEAR(found[cell], largest, 0.02 * largest + 1e-6) << "seed " << seed;
    }
  }
}

TEST(ConvergentMargins, SmallPlatesAndPolesKeepTheirSides) {
  // A cap of ocean about an axis subducts under a continent all round it.
  const Grid grid = Grid::sphere(256, 128);
  constexpr auto kConvergent = static_cast<std::int8_t>(BoundaryType::convergent);
  for (const auto& axis :
       {std::array{0.0, 0.0, 1.0}, std::array{0.6, 0.0, 0.8}, std::array{-1.0, 0.0, 0.0}}) {
    std::vector<std::int16_t> plate(grid.size());
    std::vector<std::int8_t> type(grid.size());
    std::vector<float> strength(grid.size()), fraction(grid.size()), age(grid.size(), 50.0F),
        still(grid.size(), 0.0F), angle_km(grid.size());
    for (Index cell = 0; cell < grid.size(); ++cell) {
      const auto p = grid.unit_vector(grid.column(cell), grid.row(cell));
      const double cosine = p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2];
      angle_km[cell] = static_cast<float>(kRadius_km * std::acos(std::clamp(cosine, -1.0, 1.0)));
      plate[cell] = angle_km[cell] < 3000.0F ? 1 : 0;
      fraction[cell] = plate[cell] == 0 ? 1.0F : 0.0F;
      if (std::abs(angle_km[cell] - 3000.0F) < 160.0F) {
        type[cell] = kConvergent;
        strength[cell] = 0.5F;
      }
    }
    const auto margins =
        convergent_margins(grid, plate, type, strength, fraction, age, still, still);
    for (Index cell = 0; cell < grid.size(); ++cell) {
      ASSERT_EQ(margins.kind[cell], Convergence::ocean_continent);
      ASSERT_EQ(margins.strength[cell], 0.5F);
      if (std::abs(angle_km[cell] - 3000.0F) < 400.0F) continue;
      const double beyond = angle_km[cell] - 3000.0;
      ASSERT_NEAR(margins.across_km[cell], beyond, 200.0) << "cell " << cell;
    }
  }
}

TEST(ConvergentMargins, ProfilesStandOnTheirSide) {
  for (const double strength : {0.1, 0.5, 1.0}) {
    EXPECT_EQ(andean_thickening(-100.0, strength), 0.0);
    EXPECT_GT(andean_thickening(220.0, strength), 0.9 * std::pow(strength, 0.6));
    EXPECT_EQ(andean_thickening(2000.0, strength), 0.0);
    EXPECT_GT(himalayan_thickening(200.0, strength), himalayan_thickening(-50.0, strength));
    EXPECT_LT(trench_m(-5.0, strength), -900.0);
    EXPECT_GT(trench_m(-170.0, strength), 150.0);  // outer rise
    EXPECT_NEAR(trench_m(400.0, strength), 0.0, 1.0);
    EXPECT_GT(island_arc(165.0, strength), 5.0 * island_arc(0.0, strength));
  }
}

TEST(CubicRows, EqualGridsGiveTheValuesBack) {
  const Grid grid = Grid::sphere(60, 30);
  const auto field = test::random_terrain(grid, 3);
  const CubicRows rows(grid, grid);
  std::vector<float> row(grid.nx()), scratch;
  for (int j = 0; j < grid.ny(); ++j) {
    rows.read(field, j, std::span<float>(row), scratch);
    for (int i = 0; i < grid.nx(); ++i) ASSERT_EQ(row[i], field[grid.cell(i, j)]);
  }
}

TEST(CubicRows, SmoothFieldsAreReadToThirdOrderAlsoAtPolesAndSeam) {
  const auto wave = [](const std::array<double, 3>& p) {
    return std::sin(3.0 * p[0] + 1.0) + std::cos(2.0 * p[1] - p[2]);
  };
  const Grid fine = Grid::sphere(400, 200);
  const auto greatest_error = [&](int nx) {
    const Grid coarse = Grid::sphere(nx, nx / 2);
    std::vector<float> field(coarse.size()), row(fine.nx()), scratch;
    for (Index c = 0; c < coarse.size(); ++c) {
      field[c] = static_cast<float>(wave(coarse.unit_vector(coarse.column(c), coarse.row(c))));
    }
    const CubicRows rows(coarse, fine);
    double greatest = 0.0;
    for (int j = 0; j < fine.ny(); ++j) {
      rows.read(field, j, std::span<float>(row), scratch);
      for (int i = 0; i < fine.nx(); ++i) {
        greatest = std::max(greatest, std::abs(row[i] - wave(fine.unit_vector(i, j))));
      }
    }
    return greatest;
  };
  const double at_50 = greatest_error(50), at_100 = greatest_error(100);
  EXPECT_LT(at_50, 0.01);
  EXPECT_LT(at_100, at_50 / 6.0);
}

}  // namespace
}  // namespace geo
