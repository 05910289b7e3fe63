#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "geo/core/parallel_errors.hpp"
#include "geo/core/random.hpp"
#include "geo/kernels/exemplars/exemplar.hpp"
#include "geo/kernels/landscape/stream_power.hpp"
#include "geo/kernels/numerics/diffusion.hpp"
#include "geo/kernels/numerics/shapes.hpp"
#include "geo/kernels/water/depressions.hpp"

namespace geo {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr std::uint64_t kTurnOver = 1000;  // indices of random numbers from here on are cells

/// What a kind of terrain grows from. Rates suit a steady state of stream power with exponents 1/2
/// and 1; only their ratios shape the relief.
struct Recipe {
  double uplift_m_yr, erodibility_yr, diffusivity_m2_yr, step_yr;
  double rise_from, rise_to, fall_from, fall_to;  ///< of uplift across the belt, shares of it
  double folds;                                   ///< deviation of uplift over its mean
  double beds;                                    ///< deviation of the logarithm of erodibility
  double fold_waves;                              ///< folds across the torus
};

Recipe recipe_of(Terrain terrain) {
  switch (terrain) {
    case Terrain::andean:
      return {1.0e-3, 4.0e-6, 0.02, 150e3, 0.02, 0.30, 0.40, 1.0, 0.35, 0.30, 7.0};
    case Terrain::himalayan:
      return {2.0e-3, 5.0e-6, 0.03, 100e3, 0.0, 0.20, 0.75, 1.0, 0.35, 0.35, 7.0};
    case Terrain::old_mountains:
      return {4.0e-5, 4.0e-7, 0.02, 2e6, 0.0, 0.15, 0.85, 1.0, 0.10, 0.70, 8.0};
    case Terrain::plain:
      break;
  }
  return {1.0e-5, 6.0e-7, 0.04, 2e6, 0.0, 0.05, 0.95, 1.0, 0.20, 0.30, 5.0};
}

/// Waves that fit the torus, of unit variance together, about so many along each side of it.
class Waves {
 public:
  Waves(const RandomStream& random, std::uint64_t set, double along, double across) {
    for (std::uint64_t k = 0; k < kWaves; ++k) {
      const std::uint64_t index = set * kWaves + k;
      const double most = 1.0 + 0.4 * random.normal(index, 1);
      wave_[k] = {std::round(along * random.normal(index, 0)),
                  std::max(1.0, std::round(across * most)), random.uniform(index, 2)};
    }
  }
  /// At shares of the torus' width and height.
  [[nodiscard]] double operator()(double x, double y) const {
    double sum = 0.0;
    for (const auto& [kx, ky, phase] : wave_) sum += std::cos(kTurn * (kx * x + ky * y + phase));
    return sum * std::sqrt(2.0 / kWaves);
  }

 private:
  static constexpr std::size_t kWaves = 24;
  std::array<std::array<double, 3>, kWaves> wave_;
};

/// Uplift, rock and outlets of one terrain on a grid of any size.
struct Ground {
  std::vector<float> uplift_m_yr, erodibility_yr;
  std::vector<std::uint8_t> outlets;
};

/// Folds and beds bend together; rock differs from patch to patch and, as joints do, from place to
/// place.
Ground ground_of(const Grid& grid, const Recipe& recipe, double ranges,
                 const RandomStream& random) {
  constexpr double kBends = 0.02, kPatches = 0.4, kJoints = 0.35;
  const double n = recipe.fold_waves;
  const Waves folds(random, 0, 0.3 * n / ranges, n), beds(random, 1, 0.4 * n, 1.5 * n);
  const Waves patches(random, 2, 6.0, 6.0), bends(random, 3, 2.0, 1.0);
  Ground ground{std::vector<float>(grid.size()), std::vector<float>(grid.size()),
                std::vector<std::uint8_t>(grid.size())};
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const double x = (i + 0.5) / grid.nx(), straight = (j + 0.5) / grid.ny();
      const double y = straight + kBends * bends(x, straight);
      const double t = y - std::floor(y);
      const Index c = grid.cell(i, j);
      const double belt = smooth_step(recipe.rise_from, recipe.rise_to, t) *
                          (1.0 - smooth_step(recipe.fall_from, recipe.fall_to, t));
      const double fold = std::max(0.1, 1.0 + recipe.folds * folds(x, y));
      ground.uplift_m_yr[c] = static_cast<float>(recipe.uplift_m_yr * (0.15 + 0.85 * belt) * fold);
      const double joints = random.normal(kTurnOver + static_cast<std::uint64_t>(c),
                                          static_cast<std::uint64_t>(grid.nx()));
      const double rock = recipe.beds * beds(x, y) + kPatches * patches(x, y) + kJoints * joints;
      ground.erodibility_yr[c] = static_cast<float>(recipe.erodibility_yr * std::exp(rock));
      ground.outlets[c] = std::min(t, 1.0 - t) * grid.ny() < 0.75 ? 1 : 0;
    }
  }
  return ground;
}

/// Each cell of a torus cut into four, bilinear.
std::vector<float> refined(std::span<const float> coarse, int n) {
  std::vector<float> fine(4 * coarse.size());
  for (int j = 0; j < 2 * n; ++j) {
    for (int i = 0; i < 2 * n; ++i) {
      const int a = i / 2, b = j / 2;
      const int a2 = (a + (i % 2 == 0 ? n - 1 : 1)) % n, b2 = (b + (j % 2 == 0 ? n - 1 : 1)) % n;
      const auto at = [&](int column, int row) {
        return coarse[static_cast<std::size_t>(row) * n + column];
      };
      fine[static_cast<std::size_t>(j) * 2 * n + i] =
          0.5625F * at(a, b) + 0.1875F * at(a2, b) + 0.1875F * at(a, b2) + 0.0625F * at(a2, b2);
    }
  }
  return fine;
}

void wear(const Grid& grid, const Recipe& recipe, const Ground& ground, int steps,
          std::vector<float>& z) {
  std::vector<double> area(grid.size());
  const StreamPower law{.dt_yr = recipe.step_yr};
  for (int step = 0; step < steps; ++step) {
    for (std::size_t c = 0; c < z.size(); ++c) {
      z[c] = ground.outlets[c] != 0
                 ? 0.0F
                 : z[c] + static_cast<float>(ground.uplift_m_yr[c] * recipe.step_yr);
    }
    const FlowGraph graph = route_water(grid, z, ground.outlets).graph;
    std::fill(area.begin(), area.end(), grid.area_m2(0));
    graph.accumulate(area);
    incise<float, float>(grid, graph, area, ground.erodibility_yr, law, z);
    diffuse(grid, std::span<float>(z), recipe.diffusivity_m2_yr, recipe.step_yr,
            {.fixed = ground.outlets, .scheme = DiffusionScheme::positive});
  }
}

}  // namespace

Exemplar grow_exemplar(Terrain terrain, const GrownSize& size) {
  constexpr int kCells = 256, kCoarsest = 64;
  Recipe recipe = recipe_of(terrain);
  recipe.fold_waves *= size.folds;
  recipe.folds *= size.ranges;
  const RandomStream random(1, "exemplar." + std::string(name_of(terrain)));
  std::vector<float> z(kCoarsest * kCoarsest);
  for (std::size_t c = 0; c < z.size(); ++c) {
    z[c] = static_cast<float>(random.uniform(kTurnOver + c));
  }
  int steps = 80;
  for (int n = kCoarsest; n <= kCells; n *= 2, steps /= 2) {
    const double cell_m = size.cell_m * kCells / n;
    const Grid grid = Grid::torus(n, n, cell_m, cell_m);
    wear(grid, recipe, ground_of(grid, recipe, size.ranges, random), steps, z);
    if (n < kCells) z = refined(z, n);
  }
  Exemplar exemplar{.name = std::string(name_of(terrain)),
                    .terrain = terrain,
                    .nx = kCells,
                    .ny = kCells,
                    .cell_m = size.cell_m,
                    .periodic = true,
                    .elevation_m = std::move(z)};
  measure_exemplar(exemplar, terrain);
  return exemplar;
}

ExemplarLibrary grow_exemplars(const GrownSize& size) {
  // One thread each: their grids are too small to share.
  ExemplarLibrary library;
  library.exemplars.resize(kTerrains);
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (int t = 0; t < kTerrains; ++t) {
    errors.guard([&] { library.exemplars[t] = grow_exemplar(static_cast<Terrain>(t), size); });
  }
  errors.rethrow();
  return library;
}

}  // namespace geo
