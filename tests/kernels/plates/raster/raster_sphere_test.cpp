// Plates as height maps on a sphere.
#include "geo/kernels/plates/raster/raster_sphere.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "geo/core/error.hpp"

namespace geo {
namespace {

RasterSettings small(int columns = 96) {
  RasterSettings settings;
  settings.world = {columns, columns};
  settings.plates = 8;
  settings.cycle_steps = 80;
  settings.speed = columns / 192.0;
  settings.arc_cells = 4.0;
  settings.arc_scatter_cells = 1.2;
  settings.erosion_steps = 15;
  settings.curve = 0.006;
  return settings;
}

/// A model with its lattice.
struct World {
  World(const RasterSettings& settings, std::uint64_t seed)
      : samples(raster_samples(settings.world.columns)),
        mesh(samples),
        model(mesh, settings, seed) {}
  void run() {
    while (model.advance()) {
    }
  }
  FibonacciSphere samples;
  SphereMesh mesh;
  RasterSphere model;
};

double closing_error(const RasterSphere& model) {
  return (model.mass() - model.budget().balance()) / model.mass();
}

std::vector<float> heights(const RasterSphere& model) {
  std::vector<float> out;
  for (const RasterCrust& crust : model.map().crust) out.push_back(crust.height);
  return out;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double n = static_cast<double>(a.size());
  const double ma = std::accumulate(a.begin(), a.end(), 0.0) / n;
  const double mb = std::accumulate(b.begin(), b.end(), 0.0) / n;
  double aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    aa += (a[k] - ma) * (a[k] - ma);
    bb += (b[k] - mb) * (b[k] - mb);
    ab += (a[k] - ma) * (b[k] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

TEST(RasterSphere, HasCellsAsLargeAsATilesOfThatWidth) {
  // A tile of n columns round the equator of a unit sphere: cells of (2 pi / n)^2.
  const double cell = 2.0 * 3.141592653589793 / 512.0;
  EXPECT_NEAR(4.0 * 3.141592653589793 / raster_samples(512), cell * cell, 1e-5 * cell * cell);
}

TEST(RasterSphere, CrustIsConservedButForWhatTheBudgetSays) {
  for (const double spin : {0.0, 0.01}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      RasterSettings settings = small();
      settings.spin = spin;
      World world(settings, seed);
      const RasterSphere& model = world.model;
      while (world.model.advance()) {
        if (model.steps() % 20 != 0) continue;
        ASSERT_LT(std::abs(closing_error(model)), 1e-12)
            << "seed " << seed << ", " << model.steps();
      }
      EXPECT_EQ(model.budget().cycles, 2) << "seed " << seed;
      EXPECT_LT(std::abs(closing_error(model)), 1e-12) << "seed " << seed;
      // Crust that moves is rounded to single precision, up as often as down.
      EXPECT_LT(std::abs(model.budget().rounded), 1e-7 * model.mass()) << "seed " << seed;
      EXPECT_GT(model.budget().created, 0.0) << "seed " << seed;
      EXPECT_GT(model.budget().subducted, model.budget().melted) << "seed " << seed;
      // Reading crust at turned samples is a sum over some thousands of them.
      EXPECT_LT(std::abs(model.budget().resampled), 0.02 * model.mass()) << "seed " << seed;
    }
  }
}

TEST(RasterSphere, PlatesKnowTheirMass) {
  World world(small(), 3);
  for (int k = 0; k < 70; ++k) world.model.advance();
  for (const RasterSpherePlate& plate : world.model.plates()) {
    double sum = 0.0;
    for (const std::int32_t page : plate.open_pages()) {
      for (const auto& cell : plate.cells(page)) sum += cell.crust.height;
    }
    EXPECT_NEAR(plate.mass, sum, 1e-6 * sum);
  }
}

TEST(RasterSphere, PlatesFillTheSphere) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    World world(small(), seed);
    for (int k = 0; k < 100; ++k) world.model.advance();
    const RasterMap map = world.model.map();
    for (std::size_t cell = 0; cell < map.crust.size(); ++cell) {
      ASSERT_GT(map.crust[cell].height, 0.0F) << "seed " << seed << ", cell " << cell;
      ASSERT_GE(map.plate[cell], 0) << "seed " << seed << ", cell " << cell;
    }
  }
}

TEST(RasterSphere, IsTheSameForAnyNumberOfThreads) {
  const auto run = [](int threads) {
    omp_set_num_threads(threads);
    RasterSettings settings = small(400);  // large enough for threads to share steps
    settings.cycle_steps = 12;
    World world(settings, 5);
    world.run();
    return heights(world.model);
  };
  const int before = omp_get_max_threads();
  const auto one = run(1), three = run(3);
  omp_set_num_threads(before);
  EXPECT_EQ(one, three);
}

TEST(RasterSphere, RestsInTheSameShapeWhenNothingMoves) {
  RasterSettings settings = small();
  settings.speed = 0.0;
  settings.restart_speed = settings.restart_momentum = 0.0;
  settings.erosion_steps = 0;
  settings.restart_quiet = 1000;
  World world(settings, 4);
  const auto before = heights(world.model);
  for (int k = 0; k < 40; ++k) ASSERT_TRUE(world.model.advance());
  EXPECT_EQ(heights(world.model), before);
  EXPECT_EQ(world.model.budget().created, 0.0);
  EXPECT_EQ(world.model.budget().subducted, 0.0);
}

TEST(RasterSphere, OfFlatFloorAsMuchClosesAsOpens) {
  RasterSettings settings = small();
  settings.sea_share = 1.1;  // floor alone: it parts and sinks
  settings.melting_ratio = 0.0;
  World world(settings, 2);
  for (int k = 0; k < 40; ++k) world.model.advance();
  const RasterBudget& budget = world.model.budget();
  EXPECT_GT(budget.created, 0.1 * budget.start);
  // What lies doubly where plates overlap is about a row of cells along the trenches.
  EXPECT_NEAR(budget.created, budget.subducted, 0.1 * budget.start);
}

TEST(RasterSphere, HasTheSameStartOnAFinerLattice) {
  const FibonacciSphere coarse(raster_samples(96)), fine(raster_samples(288));
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const auto a = start_raster_sphere(coarse, 0.65, 0.1, 6.0, seed);
    const auto b = start_raster_sphere(fine, 0.65, 0.1, 6.0, seed);
    const auto p = grow_raster_sphere_plates(coarse, 10, seed, 0);
    const auto q = grow_raster_sphere_plates(fine, 10, seed, 0);
    std::vector<double> x, y;
    int same = 0;
    for (std::int32_t i = 0; i < coarse.size(); ++i) {
      const std::int32_t j = fine.nearest(coarse.position(i));
      x.push_back(a[i].height);
      y.push_back(b[j].height);
      same += p[i] == q[j] ? 1 : 0;
    }
    EXPECT_GT(correlation(x, y), 0.95) << "seed " << seed;
    EXPECT_GT(same, 0.95 * coarse.size()) << "seed " << seed;
  }
}

TEST(RasterSphere, GrowsPlatesOfSimilarSize) {
  const FibonacciSphere samples(raster_samples(96));
  const auto plate = grow_raster_sphere_plates(samples, 10, 7, 0);
  std::vector<int> size(10, 0);
  for (const std::int16_t p : plate) ++size[p];
  EXPECT_GT(*std::min_element(size.begin(), size.end()), 20);
  EXPECT_NE(plate, grow_raster_sphere_plates(samples, 10, 7, 1)) << "each cycle has its own";
}

TEST(RasterSphere, MountainsRiseWhereContinentsMeet) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    World world(small(), seed);
    world.run();
    const auto map = heights(world.model);
    EXPECT_GT(*std::max_element(map.begin(), map.end()), 3.0) << "seed " << seed;
    EXPECT_GT(world.model.budget().folded, 0.0);
  }
}

TEST(RasterSphere, SmallOverlapsMergeContinentsAndLargeOnesDoNot) {
  RasterSettings settings = small();
  settings.cycles = 1;
  const auto mergers = [&](double relative) {
    settings.overlap_relative = relative;
    int sum = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      World world(settings, seed);
      world.run();
      sum += world.model.budget().mergers;
    }
    return sum;
  };
  EXPECT_GT(mergers(0.05), 0);
  EXPECT_EQ(mergers(10.0), 0);
}

/// Boundaries of plates and coasts, in neighbours that differ, over all neighbours, by six belts of
/// equal area from the equator to the poles.
struct Belts {
  std::array<double, 6> plates{}, coasts{};
};
Belts belts_of(const World& world) {
  const RasterMap map = world.model.map();
  Belts belts;
  std::array<double, 6> all{};
  for (std::int32_t i = 0; i < world.mesh.size(); ++i) {
    const double z = std::abs(world.samples.position(i)[2]);
    const auto belt = static_cast<std::size_t>(std::min(5.0, std::floor(6.0 * z)));
    for (const std::int32_t j : world.mesh.neighbours(i)) {
      all[belt] += 1.0;
      belts.plates[belt] += map.plate[i] != map.plate[j] ? 1.0 : 0.0;
      belts.coasts[belt] +=
          (map.crust[i].height < 1.0F) != (map.crust[j].height < 1.0F) ? 1.0 : 0.0;
    }
  }
  for (std::size_t belt = 0; belt < 6; ++belt) {
    belts.plates[belt] /= all[belt];
    belts.coasts[belt] /= all[belt];
  }
  return belts;
}

TEST(RasterSphere, BoundariesAndCoastsHaveNoLatitude) {
  constexpr int kSeeds = 24;
  std::vector<Belts> found;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    World world(small(64), seed);
    world.run();
    found.push_back(belts_of(world));
  }
  for (auto member : {&Belts::plates, &Belts::coasts}) {
    double mean = 0.0;
    for (const Belts& one : found) {
      for (const double share : one.*member) mean += share / (6.0 * kSeeds);
    }
    for (std::size_t belt = 0; belt < 6; ++belt) {
      double sum = 0.0, square = 0.0;
      for (const Belts& one : found) {
        const double ratio = (one.*member)[belt] / mean;
        sum += ratio;
        square += ratio * ratio;
      }
      const double ratio = sum / kSeeds;
      const double error = std::sqrt((square / kSeeds - ratio * ratio) / (kSeeds - 1));
      // Twelve figures: one beyond 3.5 of its standard errors comes by chance in 180 tests.
      EXPECT_NEAR(ratio, 1.0, 3.5 * error) << "belt " << belt;
      EXPECT_LT(error, 0.15) << "too few seeds to tell, belt " << belt;
    }
  }
}

TEST(RasterSphere, RefusesAWorldTooSmall) {
  const FibonacciSphere samples(32);
  const SphereMesh mesh(samples);
  EXPECT_THROW(RasterSphere(mesh, small(8), 1), ConfigurationError);
  EXPECT_THROW(grow_raster_sphere_plates(samples, 0, 1, 0), ConfigurationError);
}

}  // namespace
}  // namespace geo
