// Exemplars of relief, and detail that is made like them.
#include "geo/kernels/exemplars/exemplar.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/core/error.hpp"
#include "geo/core/field.hpp"
#include "geo/kernels/exemplars/exemplar_detail.hpp"
#include "geo/kernels/noise/noise.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

/// Angle between directions without sign, radians.
double apart(double a, double b) {
  return 0.5 * std::abs(std::remainder(2.0 * (a - b), 2.0 * kPi));
}

const ExemplarLibrary& library() {
  static const ExemplarLibrary kLibrary = grow_exemplars();
  return kLibrary;
}

/// A planet of one terrain all over, with given folds.
struct Uniform {
  explicit Uniform(OrogenyType type, double fold_rad = 0.0)
      : grid(Grid::sphere(512, 256)),
        z(grid.size()),
        orogeny(grid.size(), static_cast<std::int8_t>(type)),
        east(grid.size(), static_cast<float>(std::cos(fold_rad))),
        north(grid.size(), static_cast<float>(std::sin(fold_rad))) {
    const Noise noise(5, "planet");
    for (Index c = 0; c < grid.size(); ++c) {
      const auto unit = grid.unit_vector(grid.column(c), grid.row(c));
      z[c] = 2000.0F + 4000.0F * noise.fbm(unit, 40.0, 3);
    }
  }
  [[nodiscard]] TerrainGuide guide() const {
    return {.elevation_m = z,
            .orogeny_type = orogeny,
            .orogeny_age_myr = {},
            .fold_east = east,
            .fold_north = north};
  }
  Grid grid;
  std::vector<float> z;
  std::vector<std::int8_t> orogeny;
  std::vector<float> east, north;
};

constexpr double kSpacing_m = 10e3;

std::vector<float> detail_of(const Uniform& planet, const Grid& fine, std::uint64_t seed = 1) {
  std::vector<float> detail(fine.size());
  exemplar_detail(planet.grid, planet.guide(), fine, library(),
                  exemplar_band(library(), kSpacing_m, fine.spacing_east_m(0)), seed, detail);
  return detail;
}

Grid fine_grid(Centre centre = {20.0, 30.0}) { return Grid::equal_area(384, 256, 800.0, centre); }

TEST(Exemplar, FoldsRunAlongTheCrestsOfAWave) {
  for (const double angle : {0.0, 0.4, 1.2, 0.5 * kPi, 2.5, 3.0}) {
    Exemplar e{.name = "wave", .nx = 120, .ny = 90, .cell_m = 100.0, .elevation_m = {}};
    for (int j = 0; j < e.ny; ++j) {
      for (int i = 0; i < e.nx; ++i) {
        const double across = -std::sin(angle) * i + std::cos(angle) * j;
        e.elevation_m.push_back(static_cast<float>(300.0 + 200.0 * std::sin(0.3 * across)));
      }
    }
    measure_exemplar(e);
    EXPECT_LT(apart(e.fold_rad, angle), 0.02) << angle;
    EXPECT_GT(e.fold_strength, 0.9);
    EXPECT_NEAR(e.highest_m, 500.0F, 2.0F);
    EXPECT_NEAR(e.local_relief_m, 400.0, 4.0);
    EXPECT_EQ(e.terrain, Terrain::old_mountains);
  }
}

TEST(Exemplar, OnesThatNothingCanBeMadeLikeAreRefused) {
  const auto refused = [](Exemplar e) { EXPECT_THROW(measure_exemplar(e), InputError); };
  const std::vector<float> level(64 * 64, 5.0F);
  std::vector<float> hole(64 * 64);
  for (std::size_t c = 0; c < hole.size(); ++c) hole[c] = static_cast<float>(c);
  Exemplar sound{.name = "sound", .nx = 64, .ny = 64, .cell_m = 100.0, .elevation_m = hole};
  EXPECT_NO_THROW(measure_exemplar(sound));
  const std::vector<float> slope = hole;
  hole[99] = std::nanf("");
  refused({.name = "level", .nx = 64, .ny = 64, .cell_m = 100.0, .elevation_m = level});
  refused({.name = "hole", .nx = 64, .ny = 64, .cell_m = 100.0, .elevation_m = hole});
  refused({.name = "small", .nx = 16, .ny = 256, .cell_m = 100.0, .elevation_m = hole});
  refused({.name = "vast", .nx = 64, .ny = 64, .cell_m = 100e3, .elevation_m = slope});
  refused({.name = "no size", .nx = 64, .ny = 64, .cell_m = 0.0, .elevation_m = hole});
}

TEST(Exemplar, GrownOnesHaveTheReliefOfTheirTerrainAndFoldsThatRunEast) {
  ASSERT_EQ(library().exemplars.size(), static_cast<std::size_t>(kTerrains));
  const auto& [andean, himalayan, old, plain] =
      std::tie(library().exemplars[0], library().exemplars[1], library().exemplars[2],
               library().exemplars[3]);
  EXPECT_GT(himalayan.local_relief_m, andean.local_relief_m);
  EXPECT_GT(andean.local_relief_m, 1.5 * old.local_relief_m);
  EXPECT_GT(old.local_relief_m, 2.0 * plain.local_relief_m);
  for (const Exemplar& e : library().exemplars) {
    EXPECT_LT(apart(e.fold_rad, 0.0), 0.2) << e.name;
    EXPECT_GT(e.fold_strength, 0.1) << e.name;
  }
}

TEST(Exemplar, GrownOnesHaveTheSameBitsForAnyNumberOfThreads) {
  omp_set_num_threads(1);
  const Exemplar one = grow_exemplar(Terrain::andean);
  omp_set_num_threads(4);
  const Exemplar four = grow_exemplar(Terrain::andean);
  omp_set_num_threads(omp_get_num_procs());
  EXPECT_TRUE(one.elevation_m == four.elevation_m);
}

TEST(ExemplarDetail, HasUnitVarianceAndNoMean) {
  for (const OrogenyType type : {OrogenyType::andean, OrogenyType::himalayan, OrogenyType::none}) {
    const Uniform planet(type, 0.3);
    const auto detail = detail_of(planet, fine_grid());
    double sum = 0.0, squares = 0.0;
    for (const float value : detail) {
      sum += value;
      squares += static_cast<double>(value) * value;
    }
    const auto count = static_cast<double>(detail.size());
    EXPECT_NEAR(sum / count, 0.0, 0.1);
    EXPECT_NEAR(std::sqrt(squares / count), 1.0, 0.1);  // blending keeps it
  }
}

/// Power of rows within wavelengths from half a length to that length, with a window that keeps the
/// edges out.
double octave_power(const Grid& grid, std::span<const float> z, double longest_m) {
  const double extent_m = grid.nx() * grid.spacing_east_m(0);
  const int first = static_cast<int>(std::ceil(extent_m / longest_m));
  double sum = 0.0;
  for (int k = first; k < 2 * first; ++k) {
    for (int j = 0; j < grid.ny(); j += 4) {
      double real = 0.0, imaginary = 0.0;
      for (int i = 0; i < grid.nx(); ++i) {
        const double x = (i + 0.5) / grid.nx(), window = 1.0 - std::cos(2.0 * kPi * x);
        real += window * z[grid.cell(i, j)] * std::cos(2.0 * kPi * k * x);
        imaginary += window * z[grid.cell(i, j)] * std::sin(2.0 * kPi * k * x);
      }
      sum += (real * real + imaginary * imaginary) / first;
    }
  }
  return sum;
}

TEST(ExemplarDetail, SpectrumHasNeitherGapNorHump) {
  // From the waves that planet cells of 10 km end with down to three of the fine cells.
  constexpr double kHurst = 0.75;
  for (const OrogenyType type : {OrogenyType::andean, OrogenyType::himalayan, OrogenyType::none}) {
    const Grid fine = fine_grid();
    const auto detail = detail_of(Uniform(type, 0.3), fine);
    std::vector<double> ratio;
    double mean = 0.0;
    for (double wave_m = 20e3; wave_m > 4e3; wave_m *= 0.5) {
      const double power = octave_power(fine, detail, wave_m);
      ratio.push_back(std::log(power / std::pow(wave_m, 2.0 * kHurst + 1.0)));
      mean += ratio.back();
    }
    for (const double value : ratio) {
      const double over = std::exp(value - mean / static_cast<double>(ratio.size()));
      EXPECT_GT(over, 0.5) << static_cast<int>(type);
      EXPECT_LT(over, 2.0) << static_cast<int>(type);
    }
  }
}

TEST(ExemplarDetail, RidgesFollowTheFoldsOfThePlace) {
  for (const double fold : {0.0, 0.9, 1.9}) {
    const Uniform planet(OrogenyType::andean, fold);
    const Grid fine = fine_grid();
    const auto [angle, strength] = ridge_direction(fine, detail_of(planet, fine));
    EXPECT_LT(apart(angle, fold), 10.0 * kPi / 180.0) << fold << " " << angle;
    EXPECT_GT(strength, 0.1);
  }
}

TEST(ExemplarDetail, WithoutGivenFoldsRidgesFollowThePlanetsRelief) {
  const Grid planet = Grid::sphere(720, 360);
  std::vector<float> z(planet.size());
  for (Index c = 0; c < planet.size(); ++c) {
    const Centre at = planet.position(planet.column(c), planet.row(c));
    z[c] =
        static_cast<float>(2000.0 + 1000.0 * std::sin(2.0 * (at.latitude_deg + at.longitude_deg)));
  }
  const std::array<double, 3> unit{1.0, 0.0, 0.0};  // on the equator
  const LocalTerrain local = look_around(planet,
                                         {.elevation_m = z,
                                          .orogeny_type = {},
                                          .orogeny_age_myr = {},
                                          .fold_east = {},
                                          .fold_north = {}},
                                         unit, 55e3);
  EXPECT_LT(apart(local.fold_rad, -0.25 * kPi), 0.05);
  EXPECT_NEAR(local.share[static_cast<std::size_t>(Terrain::old_mountains)], 1.0, 1e-9);
}

TEST(ExemplarDetail, LevelLinesMayCountBesideGivenFolds) {
  Uniform planet(OrogenyType::andean, 0.9);
  for (Index c = 0; c < planet.grid.size(); ++c) {  // level from west to east
    planet.z[c] = static_cast<float>(3e3 + 20.0 * planet.grid.latitude_deg(planet.grid.row(c)));
  }
  TerrainGuide guide = planet.guide();
  const std::array<double, 3> unit{1.0, 0.0, 0.0};
  const auto fold = [&](double weight) {
    guide.level_weight = weight;
    return look_around(planet.grid, guide, unit, 78e3).fold_rad;
  };
  EXPECT_LT(apart(fold(0.0), 0.9), 0.01);
  EXPECT_LT(apart(fold(1.0), 0.45), 0.01);
  EXPECT_LT(apart(fold(1e6), 0.0), 0.01);
}

TEST(ExemplarDetail, TerrainIsThatOfTheOrogenyItsAgeAndTheSlope) {
  Uniform planet(OrogenyType::himalayan);
  std::vector<float> age(planet.grid.size(), 20.0F);
  TerrainGuide guide = planet.guide();
  guide.orogeny_age_myr = age;
  const std::array<double, 3> unit{0.6, 0.0, 0.8};
  const auto share = [&](Terrain terrain) {
    return look_around(planet.grid, guide, unit, 78e3).share[static_cast<std::size_t>(terrain)];
  };
  guide.plain_slope = 0.0;
  EXPECT_NEAR(share(Terrain::himalayan), 1.0, 1e-9);
  std::fill(age.begin(), age.end(), 300.0F);
  EXPECT_NEAR(share(Terrain::old_mountains), 1.0, 1e-9);
  std::fill(age.begin(), age.end(), std::nanf(""));
  EXPECT_NEAR(share(Terrain::old_mountains), 1.0, 1e-9);
  guide.plain_slope = 1.0;
  EXPECT_NEAR(share(Terrain::plain), 1.0, 1e-9);
}

TEST(ExemplarDetail, BelongsToPlacesWhateverGridLooksAtThem) {
  const Uniform planet(OrogenyType::andean, 0.5);
  const double apart_deg = 40.0 * 800.0 / 6371e3 * 180.0 / kPi;  // 40 cells
  const Grid south = fine_grid({0.0, 30.0}), north = fine_grid({apart_deg, 30.0});
  const auto a = detail_of(planet, south), b = detail_of(planet, north);
  double squares = 0.0;
  int count = 0;
  for (int j = 60; j < 180; ++j) {
    for (int i = 60; i < 320; ++i) {
      const double off = a[south.cell(i, j + 40)] - b[north.cell(i, j)];
      squares += off * off;
      ++count;
    }
  }
  // The maps differ by less than a tenth of a cell.
  EXPECT_LT(std::sqrt(squares / count), 0.05);
}

/// The largest correlation of a field with itself shifted by more than `least` cells.
double largest_repetition(const Grid& grid, const std::vector<float>& values, int least) {
  const int nx = grid.nx(), ny = grid.ny();
  double largest = 0.0;
#pragma omp parallel for schedule(dynamic, 1) reduction(max : largest)
  for (int dy = 0; dy < ny / 2; dy += 2) {
    for (int dx = -nx / 2; dx < nx / 2; dx += 2) {
      if (dx * dx + dy * dy < least * least) continue;
      double ab = 0.0, aa = 0.0, bb = 0.0;
      for (int j = 0; j + dy < ny; j += 3) {
        for (int i = std::max(0, -dx); i < std::min(nx, nx - dx); i += 3) {
          const double a = values[grid.cell(i, j)], b = values[grid.cell(i + dx, j + dy)];
          ab += a * b;
          aa += a * a;
          bb += b * b;
        }
      }
      largest = std::max(largest, ab / std::sqrt(aa * bb));
    }
  }
  return largest;
}

TEST(ExemplarDetail, NothingIsSeenTwice) {
  const Uniform planet(OrogenyType::himalayan, 0.2);
  const Grid fine = Grid::equal_area(320, 256, 1200.0, {20.0, 30.0});
  constexpr int kLongest = 25;  // cells: beyond the longest wave, 2.5 cells of the planet
  EXPECT_LT(largest_repetition(fine, detail_of(planet, fine), kLongest), 0.3);
}

TEST(ExemplarDetail, SameBitsForAnyNumberOfThreads) {
  const Uniform planet(OrogenyType::andean, 0.5);
  omp_set_num_threads(1);
  const auto one = detail_of(planet, fine_grid());
  omp_set_num_threads(4);
  const auto four = detail_of(planet, fine_grid());
  omp_set_num_threads(omp_get_num_procs());
  EXPECT_TRUE(one == four);
}

TEST(ExemplarDetail, AnEmptyLibraryIsRefused) {
  const Uniform planet(OrogenyType::andean);
  const Grid fine = fine_grid();
  std::vector<float> detail(fine.size());
  EXPECT_THROW((void)exemplar_band({}, kSpacing_m, 800.0), InputError);
  EXPECT_THROW(exemplar_detail(planet.grid, planet.guide(), fine, {}, {}, 1, detail), InputError);
}

}  // namespace
}  // namespace geo
