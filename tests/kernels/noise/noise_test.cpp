#include "geo/kernels/noise/noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/core/random.hpp"
#include "geo/kernels/noise/noise_row.hpp"

namespace geo {
namespace {

struct Moments {
  double mean = 0.0, deviation = 0.0, largest = 0.0;
};

template <class Function>
Moments sample(Function noise, int n = 200000) {
  const RandomStream random(11, "noise_test");
  double sum = 0.0, squares = 0.0, largest = 0.0;
  for (int i = 0; i < n; ++i) {
    const auto coordinate = [&](int k) { return random.uniform(i, k, -500.0, 500.0); };
    const double v = noise(coordinate(0), coordinate(1), coordinate(2));
    sum += v;
    squares += v * v;
    largest = std::max(largest, std::abs(v));
  }
  return {sum / n, std::sqrt(squares / n - sum / n * sum / n), largest};
}

// Integrals over a cell edge of w^2 and w^2 t^2, where w = 1 - fade(t) is the weight of a corner:
// they give the exact variance of the interpolant of independent corners.
struct FadeMoments {
  double plain = 0.0, distant = 0.0;
};

FadeMoments fade_moments() {
  FadeMoments moments;
  constexpr int kSteps = 10000;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 0.5) / kSteps;
    const double w = 1.0 - t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    moments.plain += w * w / kSteps;
    moments.distant += w * w * t * t / kSteps;
  }
  return moments;
}

TEST(Noise, ManyPositionsGiveTheSameBitsAsOne) {
  const RandomStream random(5, "noise_test.many");
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Noise noise(seed, "many");
    for (const int count : {0, 1, 63, 64, 65, 1000}) {
      std::vector<std::array<double, 3>> positions(count);
      for (int k = 0; k < count; ++k) {
        // Also far out, where nodes of the lattice no longer fit 32 bits.
        const double scale = k % 5 == 0 ? 1e9 : 1.0;
        for (int c = 0; c < 3; ++c) positions[k][c] = scale * random.uniform(k, c, -1.0, 1.0);
      }
      std::vector<float> values(count, -9.0F);
      noise.fbm(positions, 37.5, 9, 0.55, values);
      for (int k = 0; k < count; ++k) {
        ASSERT_EQ(values[k], noise.fbm(positions[k], 37.5, 9, 0.55))
            << "seed " << seed << ", position " << k << " of " << count;
      }
    }
  }
}

TEST(NoiseRow, WritesChosenColumnsAlone) {
  const Grid grid = Grid::sphere(128, 64);
  const Noise noise(4, "row");
  NoiseRow row(grid);
  std::vector<float> line(grid.nx(), -9.0F);
  const auto wanted = [](int i) { return i % 3 == 1; };
  row.choose(20, wanted);
  row.fbm(noise, 12.0, 4, 0.5, line);
  for (int i = 0; i < grid.nx(); ++i) {
    EXPECT_EQ(line[i], wanted(i) ? noise.fbm(grid.unit_vector(i, 20), 12.0, 4) : -9.0F) << i;
  }
}

TEST(Noise, GradientHasZeroMeanAndTheStatedSpread) {
  const Noise noise(1, "a");
  const Moments m = sample([&](double x, double y, double z) {
    return noise.gradient(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  });
  EXPECT_NEAR(m.mean, 0.0, 0.003);  // 5 standard errors of 200000 samples
  const auto [plain, distant] = fade_moments();
  const double exact = 1.5 * std::sqrt(8.0 * plain * plain * distant);  // 0.2877
  EXPECT_NEAR(m.deviation, exact, 0.003);
  EXPECT_LE(m.largest, 1.05);
  EXPECT_GE(m.largest, 0.8);
}

TEST(Noise, ValueHasZeroMeanAndTheStatedSpread) {
  const Noise noise(1, "a");
  const Moments m = sample([&](double x, double y, double z) {
    return noise.value(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  });
  EXPECT_NEAR(m.mean, 0.0, 0.004);
  const double exact = std::sqrt(8.0 * std::pow(fade_moments().plain, 3) / 3.0);  // 0.4004
  EXPECT_NEAR(m.deviation, exact, 0.004);
  EXPECT_LE(m.largest, 1.0);
}

TEST(Noise, IsContinuousAcrossLatticePlanes) {
  const Noise noise(2, "b");
  const RandomStream random(5, "directions");
  constexpr double kStep = 1e-3;
  for (int line = 0; line < 20; ++line) {
    const auto d = random.direction(line);
    const auto at = [&](int i) {
      return std::array<double, 3>{i * kStep * d[0], i * kStep * d[1], i * kStep * d[2]};
    };
    // Lipschitz: no gradient exceeds 4 per wavelength, so neither does the change per step.
    for (int i = -3000; i < 3000; ++i) {
      const double change = noise.fbm(at(i + 1), 1.0, 1) - noise.fbm(at(i), 1.0, 1);
      ASSERT_LE(std::abs(change), 4.0 * kStep) << "line " << line << " step " << i;
    }
  }
}

TEST(Noise, SameSeedSameBitsOtherSeedOrStreamUnrelated) {
  const Noise a(42, "relief"), again(42, "relief"), seed(43, "relief"), stream(42, "warp");
  double with_seed = 0.0, with_stream = 0.0, own = 0.0;
  const RandomStream random(1, "points");
  for (int i = 0; i < 20000; ++i) {
    const auto p = random.direction(i);
    const float v = a.fbm(p, 40.0, 6);
    ASSERT_EQ(v, again.fbm(p, 40.0, 6));
    own += v * v;
    with_seed += v * seed.fbm(p, 40.0, 6);
    with_stream += v * stream.fbm(p, 40.0, 6);
  }
  EXPECT_LT(std::abs(with_seed / own), 0.05);
  EXPECT_LT(std::abs(with_stream / own), 0.05);
}

TEST(Noise, IsAFunctionOfPositionNotOfResolution) {
  const Noise noise(3, "c");
  // Every third cell of the fine grid has the centre of a coarse cell.
  const Grid coarse = Grid::sphere(64, 32), fine = Grid::sphere(192, 96);
  for (int j = 0; j < 32; ++j) {
    for (int i = 0; i < 64; ++i) {
      const float here = noise.fbm(coarse.unit_vector(i, j), 100.0, 5);
      const float there = noise.fbm(fine.unit_vector(3 * i + 1, 3 * j + 1), 100.0, 5);
      ASSERT_NEAR(here, there, 1e-5);
    }
  }
}

TEST(Noise, KeepsDetailAtFrequenciesBeyondFloat) {
  // Steps of 1e-3 wavelengths at a frequency where a float position would move by 0.06 or not.
  const Noise noise(4, "d");
  constexpr double kFrequency = 1e6;
  float previous = noise.fbm({0.6, 0.64, 0.48}, kFrequency, 1);
  int equal = 0;
  for (int i = 1; i < 2000; ++i) {
    const float v = noise.fbm({0.6 + i * 1e-3 / kFrequency, 0.64, 0.48}, kFrequency, 1);
    EXPECT_LE(std::abs(v - previous), 4e-3);
    if (v == previous) ++equal;
    previous = v;
  }
  EXPECT_LE(equal, 20);
}

// Mean square change along a direction over the sphere of that many points.
double roughness(const Noise& noise, const std::array<double, 3>& along, int octaves) {
  const RandomStream random(8, "isotropy");
  constexpr double kLag = 0.25;
  double sum = 0.0;
  constexpr int kPoints = 60000;
  for (int i = 0; i < kPoints; ++i) {
    std::array<double, 3> p{}, q{};
    for (int k = 0; k < 3; ++k) {
      p[k] = random.uniform(i, k, -300.0, 300.0);
      q[k] = p[k] + kLag * along[k];
    }
    const double change = noise.fbm(q, 1.0, octaves) - noise.fbm(p, 1.0, octaves);
    sum += change * change;
  }
  return sum / kPoints;
}

TEST(Noise, HasNoPreferredAxis) {
  const Noise noise(6, "e");
  const double s = std::sqrt(0.5), t = std::sqrt(1.0 / 3.0);
  const std::vector<std::array<double, 3>> directions{{1, 0, 0}, {0, 1, 0},  {0, 0, 1}, {s, s, 0},
                                                      {0, s, s}, {s, 0, -s}, {t, t, t}, {t, -t, t}};
  std::vector<double> values;
  for (const auto& d : directions) values.push_back(roughness(noise, d, 5));
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  EXPECT_LT(*high / *low, 1.06);  // sampling noise alone gives about 1.02
}

TEST(Noise, LooksAlikeAtPolesAndEquator) {
  // Spread of the noise over caps about the six axis points and six oblique ones.
  const RandomStream random(9, "caps");
  std::vector<double> spread(12, 0.0);
  for (int seed = 0; seed < 40; ++seed) {
    const Noise noise(seed, "f");
    for (int cap = 0; cap < 12; ++cap) {
      std::array<double, 3> axis{};
      if (cap < 6) {
        axis[cap / 2] = cap % 2 == 0 ? 1.0 : -1.0;
      } else {
        axis = random.direction(1000 + cap);
      }
      for (int i = 0; i < 600; ++i) {
        auto p = random.direction(std::uint64_t{100000} * cap + i);
        double length = 0.0;
        for (int k = 0; k < 3; ++k) p[k] = axis[k] + 0.1 * p[k];
        for (int k = 0; k < 3; ++k) length += p[k] * p[k];
        for (double& c : p) c /= std::sqrt(length);
        const double v = noise.fbm(p, 30.0, 4);
        spread[cap] += v * v / (600.0 * 40.0);
      }
    }
  }
  const auto [low, high] = std::minmax_element(spread.begin(), spread.end());
  EXPECT_LT(*high / *low, 1.25);
}

TEST(Noise, FbmOfNoOctavesIsZero) { EXPECT_EQ(Noise(1, "a").fbm({0.1, 0.2, 0.3}, 10.0, 0), 0.0F); }

}  // namespace
}  // namespace geo
