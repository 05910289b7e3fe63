#include "kernels/numerics/tridiagonal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "geo/core/random.hpp"
#include "kernels/numerics/thomas.hpp"

namespace geo {
namespace {

using Complex = std::complex<double>;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <class Number>
struct System {
  std::vector<Number> lower, diagonal, upper;

  [[nodiscard]] std::vector<Number> solution(std::vector<Number> values) const {
    std::vector<Number> shares = upper, inverse = diagonal;
    factor_tridiagonal<Number>(lower, shares, inverse);
    solve_tridiagonal<Number>(lower, shares, inverse, values);
    return values;
  }
  /// Row i of the matrix times x, and the same of all magnitudes.
  [[nodiscard]] std::pair<Number, double> row(std::size_t i, const std::vector<Number>& x) const {
    Number sum = diagonal[i] * x[i];
    double magnitude = std::abs(diagonal[i]) * std::abs(x[i]);
    if (i > 0) {
      sum += lower[i] * x[i - 1];
      magnitude += std::abs(lower[i]) * std::abs(x[i - 1]);
    }
    if (i + 1 < x.size()) {
      sum += upper[i] * x[i + 1];
      magnitude += std::abs(upper[i]) * std::abs(x[i + 1]);
    }
    return {sum, magnitude};
  }
};

TEST(Thomas, SolvesPoissonsEquationToItsParabola) {
  for (const int n : {1, 2, 3, 50, 400}) {
    const System<double> second_difference{
        std::vector<double>(n, -1.0), std::vector<double>(n, 2.0), std::vector<double>(n, -1.0)};
    const auto x = second_difference.solution(std::vector<double>(n, 1.0));
    // As far off as the condition of the matrix, 4 (n + 1)^2 / pi^2, times a few roundings.
    const double tolerance = 4.0 * kEpsilon * (n + 1) * (n + 1);
    for (int i = 0; i < n; ++i) {
      const double exact = 0.5 * (i + 1) * (n - i);
      EXPECT_NEAR(x[i], exact, tolerance * exact) << "unknown " << i << " of " << n;
    }
  }
}

TEST(Thomas, SolvesDominantSystemsOfComplexNumbersToRounding) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const RandomStream random(seed, "tridiagonal_test");
    const auto n = static_cast<std::size_t>(1 + seed * 7 % 60);
    std::uint64_t at = 0;
    const auto number = [&] {
      const double real_part = random.normal(at++);
      return Complex(real_part, random.normal(at++));
    };
    System<Complex> system;
    std::vector<Complex> given;
    for (std::size_t i = 0; i < n; ++i) {
      system.lower.push_back(number());
      system.upper.push_back(number());
      const double least = std::abs(system.lower[i]) + std::abs(system.upper[i]);
      system.diagonal.push_back(std::polar(1.01 * least, static_cast<double>(i)));
      given.push_back(number());
    }
    const auto x = system.solution(given);
    for (std::size_t i = 0; i < n; ++i) {
      const auto [sum, magnitude] = system.row(i, x);
      // Of matrices whose diagonal dominates the factors are at most three times as large, and each
      // value takes four roundings (Higham 2002, section 9.6); of complex numbers four times that.
      EXPECT_LE(std::abs(sum - given[i]), 48.0 * kEpsilon * (magnitude + std::abs(given[i])))
          << "seed " << seed << ", row " << i << " of " << n;
    }
  }
}

TEST(Thomas, UsesNoNumberBeyondTheEnds) {
  const System<double> system{{kNan, 1.0, 1.0}, {4.0, 4.0, 4.0}, {1.0, 1.0, kNan}};
  const auto x = system.solution({5.0, 6.0, 5.0});
  for (const double value : x) EXPECT_NEAR(value, 1.0, 4.0 * kEpsilon);
}

/// Every coupling of all lanes.
void couple(TridiagonalBlock& block, int n, double coupling, bool periodic) {
  for (int i = 0; i < n; ++i) {
    for (int lane = 0; lane < TridiagonalBlock::kLanes; ++lane) {
      block.lower(i)[lane] = periodic || i > 0 ? coupling : 0.0;
      block.upper(i)[lane] = periodic || i + 1 < n ? coupling : 0.0;
    }
  }
  block.factorise();
}

TEST(TridiagonalBlock, DampsEachWaveOfARingByItsOwnFactor) {
  constexpr int kSize = 24, kLanes = TridiagonalBlock::kLanes;
  for (const Couplings differ : {Couplings::all, Couplings::lanes}) {
    for (const double coupling : {0.0, 0.3, 10.0, 1000.0}) {
      TridiagonalBlock block(kSize, true, differ);
      couple(block, kSize, coupling, true);
      std::vector<double> values(kSize * kLanes);
      const auto wave = [](int i, int lane) {
        return std::cos(2.0 * std::numbers::pi * lane * i / kSize + 0.1 * lane);
      };
      for (int i = 0; i < kSize; ++i) {
        for (int lane = 0; lane < kLanes; ++lane) values[i * kLanes + lane] = wave(i, lane);
      }
      block.solve(values.data());
      // The condition of the matrix is 1 + 4 coupling; the sums take a few roundings each.
      const double tolerance = 16.0 * kEpsilon * (1.0 + 4.0 * coupling);
      for (int i = 0; i < kSize; ++i) {
        for (int lane = 0; lane < kLanes; ++lane) {
          const double factor =
              1.0 + 2.0 * coupling * (1.0 - std::cos(2.0 * std::numbers::pi * lane / kSize));
          EXPECT_NEAR(values[i * kLanes + lane], wave(i, lane) / factor, tolerance)
              << "coupling " << coupling << ", wave " << lane << ", unknown " << i;
        }
      }
    }
  }
}

TEST(TridiagonalBlock, BetweenEndsAgreesWithThomas) {
  constexpr int kSize = 17, kLanes = TridiagonalBlock::kLanes;
  const RandomStream random(5, "tridiagonal_block_test");
  TridiagonalBlock block(kSize, false);
  std::vector<System<double>> systems(kLanes);
  std::vector<std::vector<double>> given(kLanes);
  std::vector<double> values(kSize * kLanes);
  for (int i = 0; i < kSize; ++i) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto at = static_cast<std::uint64_t>(3 * (i * kLanes + lane));
      const double lower = i > 0 ? std::abs(random.normal(at)) : 0.0;
      const double upper = i + 1 < kSize ? std::abs(random.normal(at + 1)) : 0.0;
      block.lower(i)[lane] = lower;
      block.upper(i)[lane] = upper;
      systems[lane].lower.push_back(-lower);
      systems[lane].diagonal.push_back(1.0 + lower + upper);
      systems[lane].upper.push_back(-upper);
      given[lane].push_back(random.normal(at + 2));
      values[i * kLanes + lane] = given[lane].back();
    }
  }
  block.factorise();
  block.solve(values.data());
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto x = systems[lane].solution(given[lane]);
    // Either way rounds otherwise; the inverse of such a matrix has no row whose sum is above 1.
    for (int i = 0; i < kSize; ++i) EXPECT_NEAR(values[i * kLanes + lane], x[i], 1e-14);
  }
}

}  // namespace
}  // namespace geo
