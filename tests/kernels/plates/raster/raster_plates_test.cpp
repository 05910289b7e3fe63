// Plates as height maps on a torus (Viitanen 2012, chapter 7).
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "geo/core/error.hpp"
#include "geo/kernels/plates/raster/raster_elevation.hpp"
#include "geo/kernels/plates/raster/raster_start.hpp"
#include "geo/kernels/plates/raster/raster_tectonics.hpp"

namespace geo {
namespace {

RasterSettings small(int columns = 96, int rows = 80) {
  RasterSettings settings;
  settings.world = {columns, rows};
  settings.plates = 8;
  settings.cycle_steps = 120;
  return settings;
}

/// Sums of all crust against the budget, relative.
double closing_error(const RasterTectonics& model) {
  return (model.mass() - model.budget().balance()) / model.mass();
}

std::vector<float> heights(const RasterTectonics& model) {
  std::vector<float> out;
  for (const RasterCrust& crust : model.map().crust) out.push_back(crust.height);
  return out;
}

TEST(RasterPlates, CrustIsConservedButForNewFloorAndSubduction) {
  for (const double spin : {0.0, 0.01}) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      RasterSettings settings = small();
      settings.spin = spin;
      RasterTectonics model(settings, seed);
      while (model.advance()) {
        if (model.steps() % 20 != 0) continue;
        ASSERT_LT(std::abs(closing_error(model)), 1e-12)
            << "seed " << seed << ", " << model.steps();
      }
      EXPECT_LT(std::abs(closing_error(model)), 1e-12) << "seed " << seed;
      // Crust that moves is rounded to single precision, up as often as down.
      EXPECT_LT(std::abs(model.budget().rounded), 1e-7 * model.mass()) << "seed " << seed;
      EXPECT_GT(model.budget().created, 0.0) << "seed " << seed;
      EXPECT_GT(model.budget().subducted, model.budget().melted) << "seed " << seed;
    }
  }
}

TEST(RasterPlates, PlatesKnowTheirMass) {
  RasterTectonics model(small(), 3);
  for (int k = 0; k < 100; ++k) model.advance();
  for (const RasterPlate& plate : model.plates()) {
    double sum = 0.0;
    for (int j = 0; j < plate.rows(); ++j) {
      for (const RasterCrust& cell : plate.row(j)) sum += cell.height;
    }
    EXPECT_NEAR(plate.mass, sum, 1e-6 * sum);
  }
}

TEST(RasterPlates, FillTheTorus) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    RasterTectonics model(small(), seed);
    for (int k = 0; k < 150 && model.advance(); ++k) {
    }
    const RasterMap map = model.map();
    for (std::size_t cell = 0; cell < map.crust.size(); ++cell) {
      ASSERT_GT(map.crust[cell].height, 0.0F) << "seed " << seed << ", cell " << cell;
      ASSERT_GE(map.plate[cell], 0) << "seed " << seed << ", cell " << cell;
    }
  }
}

TEST(RasterPlates, AreTheSameForAnyNumberOfThreads) {
  RasterSettings settings = small(1024, 1024);  // large enough for threads to share steps
  settings.cycle_steps = 5;
  settings.spin = 0.004;
  const auto run = [&](int threads) {
    omp_set_num_threads(threads);
    RasterTectonics model(settings, 5);
    while (model.advance()) {
    }
    return heights(model);
  };
  const int before = omp_get_max_threads();
  const auto one = run(1), three = run(3);
  omp_set_num_threads(before);
  EXPECT_EQ(one, three);
}

TEST(RasterPlates, RestInTheSameShapeWhenNothingMoves) {
  RasterSettings settings = small();
  settings.speed = 0.0;
  settings.restart_speed = settings.restart_momentum = 0.0;
  settings.erosion_steps = 0;
  settings.restart_quiet = 1000;
  RasterTectonics model(settings, 4);
  const RasterMap before = model.map();
  for (int k = 0; k < 40; ++k) ASSERT_TRUE(model.advance());
  const RasterMap after = model.map();
  for (std::size_t cell = 0; cell < before.crust.size(); ++cell) {
    ASSERT_EQ(before.crust[cell].height, after.crust[cell].height) << cell;
  }
  EXPECT_EQ(model.budget().created, 0.0);
}

TEST(RasterPlates, ErosionOnlyLevelsLand) {
  RasterPlate plate({64, 64});
  plate.open(0, 0, 64, 64);
  double before = 0.0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const float height = x < 20 ? 0.3F : 1.2F + static_cast<float>((x * 7 + y * 13) % 11);
      plate.set(plate.claim(x, y), {height, 0, 0});
      before += height;
    }
  }
  plate.tighten();
  const double rounded = plate.erode(0.8);
  EXPECT_NEAR(plate.mass, before + rounded, 1e-12 * before);
  EXPECT_LT(std::abs(rounded), 1e-6 * before);
  float most = 0.0F;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const float height = plate.crust(plate.find(x, y)).height;
      most = std::max(most, height);
      if (x >= 2 && x < 18) {
        ASSERT_EQ(height, 0.3F) << "sea floor away from the shore changed";
      }
    }
  }
  EXPECT_LT(most, 12.2F);
}

TEST(RasterPlates, TurnsSendEachCellToOneCellAndBack) {
  const RasterWorld world{45, 32};
  for (const double angle : {0.03, -0.4, 1.0}) {
    const RasterTurn turn(world, angle);
    std::set<std::pair<int, int>> seen;
    double worst = 0.0;
    for (int y = -world.rows / 2; y < world.rows - world.rows / 2; ++y) {
      for (int x = -world.columns / 2; x < world.columns - world.columns / 2; ++x) {
        int u = x, v = y;
        turn.turn(u, v);
        seen.insert({u, v});
        if (std::hypot(x, y) < 8.0) {
          worst = std::max(worst, std::hypot(u - (std::cos(angle) * x - std::sin(angle) * y),
                                             v - (std::sin(angle) * x + std::cos(angle) * y)));
        }
        turn.turn_back(u, v);
        ASSERT_EQ(u, x);
        ASSERT_EQ(v, y);
      }
    }
    EXPECT_EQ(static_cast<std::int32_t>(seen.size()), world.size()) << angle;
    EXPECT_LT(worst, 1.5) << angle;  // three roundings of half a cell
  }
}

TEST(RasterPlates, ContinentsAreTheConnectedLandOfAPlateAcrossTheWrap) {
  const RasterWorld world{48, 40};
  RasterPlate plate(world);
  plate.open(0, 0, 48, 40);
  const auto land = [](int x, int y) {
    if (y >= 10 && y < 14) return x < 5 || x >= 44;  // across the side: one continent of 36
    return y == 20 && x > 20 && x < 31;              // a line of 10
  };
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 48; ++x) {
      plate.set(plate.claim(x, y), {land(x, y) ? 1.5F : 0.1F, 0, 0});
    }
  }
  plate.find_continents(1);
  const RasterContinents& found = plate.continents();
  ASSERT_EQ(found.area.size(), 2U);
  EXPECT_EQ(found.at(2, 11), found.at(46, 12));
  EXPECT_EQ(found.area[found.at(2, 11)], 36);
  EXPECT_EQ(found.area[found.at(25, 20)], 10);
  EXPECT_EQ(found.at(25, 21), -1);
}

TEST(RasterPlates, GrowAtRandomToConnectedPlatesOfSimilarSize) {
  const RasterWorld world{100, 70};
  const auto plate = grow_raster_plates(world, 10, 7, 0);
  std::vector<int> size(10, 0);
  for (const std::int16_t p : plate) {
    ASSERT_GE(p, 0);
    ++size[p];
  }
  EXPECT_GT(*std::min_element(size.begin(), size.end()), 50);
  EXPECT_NE(plate, grow_raster_plates(world, 10, 7, 1)) << "each cycle has plates of its own";
}

TEST(RasterPlates, FirstMapHasTheWantedSeaAndNoSeam) {
  const RasterWorld world{128, 64};
  for (const double sea : {0.2, 0.65, 0.9}) {
    const auto crust = start_raster(world, sea, 0.1, 4.0, 11);
    const auto below = std::count_if(crust.begin(), crust.end(),
                                     [](const RasterCrust& c) { return c.height < 1.0F; });
    EXPECT_NEAR(static_cast<double>(below) / world.size(), sea, 1e-3);
  }
  const auto noise = seamless_noise(world, 4.0, 0.55, 8, 11);
  const auto step = [&](int x) {  // mean difference of a column and the one before it
    double sum = 0.0;
    for (int y = 0; y < world.rows; ++y) {
      sum +=
          std::abs(noise[y * world.columns + x] - noise[y * world.columns + world.column(x - 1)]);
    }
    return sum / world.rows;
  };
  double inside = 0.0;
  for (int x = 1; x < world.columns; ++x) inside += step(x) / (world.columns - 1);
  EXPECT_LT(step(0), 2.0 * inside);
}

TEST(RasterPlates, OwnSettingsActOnTheirPlateAlone) {
  RasterSettings settings = small();
  settings.speed_spread = 0.0;
  settings.own.resize(3);
  settings.own[2].speed = 3.0;
  const RasterTectonics model(settings, 2);
  for (std::size_t p = 0; p < model.plates().size(); ++p) {
    const RasterPlate& plate = model.plates()[p];
    EXPECT_NEAR(std::hypot(plate.east, plate.north), p == 2 ? 3.0 : 1.0, 1e-12) << p;
  }
}

TEST(RasterPlates, SmallOverlapsMergeContinentsAndLargeOnesDoNot) {
  RasterSettings settings = small();
  settings.cycles = 1;
  const auto mergers = [&](double relative) {
    settings.overlap_relative = relative;
    int sum = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      RasterTectonics model(settings, seed);
      while (model.advance()) {
      }
      sum += model.budget().mergers;
    }
    return sum;
  };
  EXPECT_GT(mergers(0.05), 0);
  EXPECT_EQ(mergers(10.0), 0);
}

TEST(RasterPlates, AMergerHandsItsMomentumOn) {
  RasterSettings settings = small();
  settings.friction = 0.0;
  settings.erosion = 0.0;
  settings.cycles = 1;
  settings.overlap_relative = 0.05;
  int checked = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    RasterTectonics model(settings, seed);
    for (bool goes_on = true; goes_on;) {
      const std::vector<RasterPlate> before = model.plates();
      const RasterBudget earlier = model.budget();
      goes_on = model.advance();
      const auto& plates = model.plates();
      const int mergers = model.budget().mergers - earlier.mergers;
      const double moved = model.budget().merged - earlier.merged;
      // New floor, on any plate, comes after a merger.
      const double floor = model.budget().created - earlier.created;
      for (std::size_t p = 0; p < plates.size(); ++p) {
        const double east = plates[p].east - before[p].east,
                     north = plates[p].north - before[p].north;
        if (mergers == 0) EXPECT_EQ(std::hypot(east, north), 0.0) << "seed " << seed;
        if (mergers != 1 || std::hypot(east, north) == 0.0) continue;
        double missing = std::numeric_limits<double>::infinity();
        for (std::size_t from = 0; from < plates.size(); ++from) {
          if (from == p) continue;
          missing = std::min(
              missing,
              std::hypot(plates[p].mass * east - moved * (before[from].east - before[p].east),
                         plates[p].mass * north - moved * (before[from].north - before[p].north)));
        }
        EXPECT_LE(missing, (floor + 1e-6 * plates[p].mass) * std::hypot(east, north))
            << "seed " << seed << ", plate " << p;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 3);
}

TEST(RasterPlates, MountainsRiseWhereContinentsMeet) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    RasterTectonics model(small(), seed);
    const double first = 2.0;  // highest land of the first map
    while (model.advance()) {
    }
    const auto map = heights(model);
    EXPECT_GT(*std::max_element(map.begin(), map.end()), 1.5 * first) << "seed " << seed;
  }
}

TEST(RasterPlates, HeightsBecomeMetresWithTheWantedSeaAndPlains) {
  std::vector<float> heights;
  for (int k = 0; k < 1000; ++k) heights.push_back(k < 600 ? 0.1F : 0.01F * static_cast<float>(k));
  RasterScale scale;
  fit_scale(heights, 0.7, 300.0, scale);
  EXPECT_NEAR(scale.sea_height, 7.0, 0.02);
  EXPECT_NEAR(raster_elevation_m(8.5, 0.0, 0.1, scale), 300.0, 5.0);
  EXPECT_NEAR(raster_elevation_m(7.0, 50.0, 0.1, scale), 0.0, 1.0);
  EXPECT_LT(raster_elevation_m(1e6, 0.0, 0.1, scale), 1e3 * scale.summit_km);
  EXPECT_NEAR(raster_elevation_m(0.1, 0.0, 0.1, scale), -2600.0, 1e-9);
  EXPECT_NEAR(raster_thickness_m(0.1, 0.1, scale), 7000.0, 1e-6);
}

TEST(RasterPlates, RefuseAWorldTooSmall) {
  RasterSettings settings = small(8, 40);
  EXPECT_THROW(RasterTectonics(settings, 1), ConfigurationError);
  EXPECT_THROW(grow_raster_plates({20, 20}, 0, 1, 0), ConfigurationError);
}

}  // namespace
}  // namespace geo
