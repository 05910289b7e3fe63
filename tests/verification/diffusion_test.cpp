#include "geo/kernels/numerics/diffusion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<float> sample(const Grid& grid, const std::function<double(double, double)>& f) {
  std::vector<float> field(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    field[c] = static_cast<float>(f(grid.x_m(grid.column(c)), grid.y_m(grid.row(c))));
  }
  return field;
}

double largest_error(const Grid& grid, const std::vector<float>& field,
                     const std::function<double(double, double)>& exact) {
  double largest = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    const double e = exact(grid.x_m(grid.column(c)), grid.y_m(grid.row(c)));
    largest = std::max(largest, std::abs(field[c] - e));
  }
  return largest;
}

// A ridge between two base levels, uplifted until it stands still.
double steady_relief(bool along_rows, double dt_yr) {
  constexpr int kCells = 81;
  const Grid grid =
      along_rows ? Grid::plane(kCells, 3, 2.5, 7.0) : Grid::plane(4, kCells, 7.0, 2.5);
  std::vector<float> height(grid.size(), 0.0F);
  std::vector<std::uint8_t> base(grid.size(), 0);
  for (Index c = 0; c < grid.size(); ++c) {
    const int n = along_rows ? grid.column(c) : grid.row(c);
    base[c] = n == 0 || n == kCells - 1;
  }
  const auto uplift = [&](double time_yr) {
    for (Index c = 0; c < grid.size(); ++c) {
      if (base[c] == 0) height[c] += static_cast<float>(1e-4 * time_yr);
    }
  };
  for (double time = 0.0; time < 4e6; time += dt_yr) {
    uplift(0.5 * dt_yr);
    diffuse(grid, height, 0.01, dt_yr, {.fixed = base});
    uplift(0.5 * dt_yr);
  }
  return *std::max_element(height.begin(), height.end());
}

TEST(Diffusion, SteadyUpliftMakesTheParabola) {
  // U L² / (2 κ) = 1e-4 · 100² / 0.02 = 50 m. What is left is the splitting from uplift, O(dt²).
  EXPECT_NEAR(steady_relief(true, 1e4), 50.0, 0.05);
  EXPECT_NEAR(steady_relief(false, 1e4), 50.0, 0.05);
}

TEST(Diffusion, GaussianRidgeSinksAsItSpreads) {
  for (const bool along_rows : {true, false}) {
    const Grid grid = along_rows ? Grid::plane(401, 3, 5.0, 8.0) : Grid::plane(4, 401, 8.0, 5.0);
    const auto ridge = [&](double x, double y) {
      const double s = along_rows ? x : y;
      return 100.0 * std::exp(-s * s / (2.0 * 50.0 * 50.0));
    };
    auto field = sample(grid, ridge);
    for (int step = 0; step < 20; ++step) diffuse(grid, field, 0.01, 5e3);
    const double peak = *std::max_element(field.begin(), field.end()) / 100.0;
    EXPECT_NEAR(peak, 0.74536, 5e-4);  // s0 / sqrt(s0² + 2 κ t)
  }
}

TEST(Diffusion, GaussianHillSinksAsItSpreads) {
  const Grid grid = Grid::plane(201, 161, 5.0, 6.25);
  const auto hill = [](double variance, double amplitude) {
    return [=](double x, double y) {
      return amplitude * std::exp(-(x * x + y * y) / (2.0 * variance));
    };
  };
  auto field = sample(grid, hill(2500.0, 100.0));
  for (int step = 0; step < 20; ++step) diffuse(grid, field, 0.01, 5e3);
  const double peak = *std::max_element(field.begin(), field.end()) / 100.0;
  EXPECT_NEAR(peak, 0.55556, 7e-4);
  EXPECT_LT(largest_error(grid, field, hill(4500.0, 100.0 * 2500.0 / 4500.0)), 0.1);
}

// Amplitude of a wave of 1 km after 1e6 yr; λ along the columns.
double sine_amplitude(int cells, int steps, DiffusionScheme scheme) {
  const Grid grid = Grid::torus(4, cells, 10.0, 1000.0 / cells);
  const double k = 2.0 * kPi / 1000.0;
  auto field = sample(grid, [&](double, double y) { return 1000.0 * std::sin(k * y); });
  const auto before = field;
  for (int s = 0; s < steps; ++s) {
    diffuse(grid, field, 0.01, 1e6 / steps, {.scheme = scheme, .substeps = 1});
  }
  double product = 0.0, square = 0.0;
  for (std::size_t c = 0; c < field.size(); ++c) {
    product += double(field[c]) * before[c];
    square += double(before[c]) * before[c];
  }
  return product / square;
}

TEST(Diffusion, SineDecaysAtItsRate) {
  EXPECT_NEAR(sine_amplitude(512, 100, DiffusionScheme::second_order), 0.673825, 1e-5);
  EXPECT_NEAR(sine_amplitude(512, 100, DiffusionScheme::positive), 0.674349, 1e-5);
}

TEST(Diffusion, SecondOrderInTimeFirstOrderWherePositive) {
  const double exact = std::exp(-0.01 * std::pow(2.0 * kPi / 1000.0, 2) * 1e6);
  const auto error = [&](int steps, DiffusionScheme scheme) {
    return std::abs(sine_amplitude(1024, steps, scheme) - exact);
  };
  constexpr auto kSecond = DiffusionScheme::second_order, kPositive = DiffusionScheme::positive;
  EXPECT_NEAR(std::log2(error(1, kSecond) / error(2, kSecond)), 2.0, 0.3);
  EXPECT_NEAR(std::log2(error(2, kSecond) / error(4, kSecond)), 2.0, 0.2);
  EXPECT_NEAR(std::log2(error(4, kPositive) / error(8, kPositive)), 1.0, 0.1);
}

TEST(Diffusion, SecondOrderInSpace) {
  const double exact = std::exp(-0.01 * std::pow(2.0 * kPi / 1000.0, 2) * 1e6);
  const auto error = [&](int cells) {
    return std::abs(sine_amplitude(cells, 200, DiffusionScheme::second_order) - exact);
  };
  EXPECT_NEAR(std::log2(error(16) / error(32)), 2.0, 0.1);
  EXPECT_NEAR(std::log2(error(32) / error(64)), 2.0, 0.1);
}

TEST(Diffusion, GaussianInOneStepOfAnyLength) {
  // Mean squared error of one step from t0 = 2e3 yr, peaks from 0.027 down to 8e-5.
  const Grid grid = Grid::plane(51, 101, 0.8, 0.4);
  const auto gaussian = [](double t) {
    return [t](double x, double y) {
      const double variance = 4.0 * 1e-3 * t;
      return std::exp(-(x * x + y * y) / variance) / (variance * kPi);
    };
  };
  for (const auto& [dt_yr, bound] : {std::pair{1e3, 1e-9}, {1e4, 1e-6}, {1e5, 1e-5}, {1e6, 1e-5}}) {
    auto field = sample(grid, gaussian(2e3));
    diffuse(grid, field, 1e-3, dt_yr);
    const auto exact = sample(grid, gaussian(2e3 + dt_yr));
    double sum = 0.0;
    for (std::size_t c = 0; c < field.size(); ++c) sum += std::pow(field[c] - exact[c], 2);
    EXPECT_LT(sum / static_cast<double>(field.size()), bound) << "dt " << dt_yr;
  }
}

struct SphereError {
  double rms, largest;  // relative to the exact amplitude
};

// Y_lm over half an e-folding time, tilted by `turn` of longitude.
SphereError harmonic_error(int ny, int l, int m, int steps) {
  const Grid grid = Grid::sphere(2 * ny, ny);
  const double radius_m = grid.figure().radius_m;
  std::vector<float> field(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    const double colatitude = (90.0 - grid.latitude_deg(grid.row(c))) * kPi / 180.0;
    const double longitude = (grid.longitude_deg(grid.column(c)) - 20.0) * kPi / 180.0;
    field[c] =
        static_cast<float>(1000.0 * std::sph_legendre(l, m, colatitude) * std::cos(m * longitude));
  }
  const auto before = field;
  const double time_yr = 0.5 * radius_m * radius_m / (l * (l + 1));  // κ = 1
  for (int s = 0; s < steps; ++s) diffuse(grid, field, 1.0, time_yr / steps, {.substeps = 1});
  const double decay = std::exp(-0.5);
  double squares = 0.0, scale = 0.0, largest = 0.0, peak = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    const double exact = decay * before[c], area = grid.area_m2(grid.row(c));
    squares += std::pow(field[c] - exact, 2) * area;
    scale += exact * exact * area;
    largest = std::max(largest, std::abs(field[c] - exact));
    peak = std::max(peak, std::abs(exact));
  }
  return {std::sqrt(squares / scale), largest / peak};
}

TEST(Diffusion, SphericalHarmonicsDecayAtTheirRate) {
  for (const auto& [l, m] :
       std::vector<std::pair<int, int>>{{1, 0}, {1, 1}, {2, 1}, {3, 2}, {4, 1}, {6, 5}, {8, 4}}) {
    const SphereError error = harmonic_error(80, l, m, 6);
    EXPECT_LT(error.rms, 2.5e-3) << "l " << l << " m " << m;
    EXPECT_LT(error.largest, 3e-3) << "l " << l << " m " << m;
  }
}

TEST(Diffusion, SlopesAcrossThePoleSurviveLongSteps) {
  // m = 1 is a slope over the pole: a plain split step of this length levels 30 % of it there.
  for (const int l : {1, 4, 8}) {
    EXPECT_LT(harmonic_error(80, l, 1, 1).largest, 7e-3) << "l " << l;
  }
}

TEST(Diffusion, SecondOrderOnTheSphere) {
  for (const auto& [l, m] : std::vector<std::pair<int, int>>{{3, 1}, {4, 2}, {6, 3}}) {
    const double coarse = harmonic_error(24, l, m, 16).rms, fine = harmonic_error(48, l, m, 32).rms;
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.25) << "l " << l << " m " << m;
  }
}

}  // namespace
}  // namespace geo
