#include "geo/kernels/climate/stationary_wave.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geo/kernels/climate/soil_moisture.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kTurning = 7.292e-5;

const auto kNothing = [](double, double) { return 0.0; };

struct Response {
  Response(int nx, int ny, const StationaryWave& model, double wind_m_s, double turning,
           auto&& heating, auto&& height)
      : Response(nx, ny, model, wind_m_s, turning, heating, height, kNothing, kNothing) {}
  Response(int nx, int ny, const StationaryWave& model, double wind_m_s, double turning,
           auto&& heating, auto&& height, auto&& force_east, auto&& force_north)
      : grid(Grid::sphere(nx, ny)) {
    std::vector<double> latitude;
    for (int j = 0; j < ny; ++j) latitude.push_back(grid.latitude_deg(j));
    const auto size = static_cast<std::size_t>(grid.size());
    std::vector<float> warm(size), high(size), push_east(size), push_north(size);
    for (Index c = 0; c < grid.size(); ++c) {
      const double lat = grid.latitude_deg(grid.row(c)), lon = grid.longitude_deg(grid.column(c));
      warm[c] = static_cast<float>(heating(lat, lon));
      high[c] = static_cast<float>(height(lat, lon));
      push_east[c] = static_cast<float>(force_east(lat, lon));
      push_north[c] = static_cast<float>(force_north(lat, lon));
    }
    east.resize(size), north.resize(size), descent.resize(size);
    stationary_wave(grid, model, turning, latitude, std::vector<double>(ny, wind_m_s),
                    {warm, push_east, push_north, high}, {east, north, descent});
  }
  [[nodiscard]] Index at(double lat, double lon) const {
    const int i = static_cast<int>((lon + 180.0) / 360.0 * grid.nx());
    const int j = static_cast<int>((lat + 90.0) / 180.0 * grid.ny());
    return grid.cell(i, j);
  }
  Grid grid;
  std::vector<float> east, north, descent;
};

StationaryWave gill() {
  StationaryWave model;
  model.internal = {40.0, 3.0, 10.0, 0.0};
  model.smoothing_km = 0.0;
  model.mountain_share = 0.0;
  return model;
}

const auto kWarmPool = [](double lat, double lon) {
  return 200.0 * std::exp(-(lat * lat + lon * lon) / (2 * 10.0 * 10.0));
};

// Gill (1980): westerlies west of equatorial heating, easterlies (farther) east of it, air that
// comes in over the heating, and cyclones off the equator to its west.
TEST(StationaryWave, EquatorialHeatingIsThatOfGill) {
  const Response r(180, 90, gill(), 0.0, kTurning, kWarmPool, kNothing);
  EXPECT_GT(r.east[r.at(1, -25)], 0.3F);
  EXPECT_LT(r.east[r.at(1, 40)], -0.3F);
  EXPECT_LT(r.east[r.at(1, 70)], 0.0F) << "the Kelvin wave reaches farther than the Rossby wave";
  EXPECT_LT(r.north[r.at(15, -35)], 0.0F) << "equatorwards on the western side of the cyclone";
  EXPECT_GT(r.north[r.at(15, 5)], 0.0F) << "polewards on its eastern side";
}

TEST(StationaryWave, IsSymmetricAboutTheEquatorAndTurnsAboutWithThePlanet) {
  const Response r(120, 60, gill(), 0.0, kTurning, kWarmPool, kNothing);
  const Response back(120, 60, gill(), 0.0, -kTurning, kWarmPool, kNothing);
  double most = 0.0;
  for (int j = 0; j < 60; ++j) {
    for (int i = 0; i < 120; ++i) {
      const Index c = r.grid.cell(i, j), mirrored = r.grid.cell(i, 59 - j);
      most = std::max<double>(most, std::abs(r.east[c]));
      EXPECT_NEAR(r.east[c], r.east[mirrored], 1e-4);
      EXPECT_NEAR(r.north[c], -r.north[mirrored], 1e-4);
      // East and west change places where the planet turns the other way.
      EXPECT_NEAR(back.east[r.grid.cell(119 - i, j)], -r.east[c], 1e-4);
      EXPECT_NEAR(back.north[r.grid.cell(119 - i, j)], r.north[c], 1e-4);
    }
  }
  EXPECT_GT(most, 0.5);
}

// Heating of one spherical harmonic on a planet that does not turn: with P = p Y the equations
// give u = -grad P / e and (e_T + c^2 l(l+1) / (e a^2)) p = -q Q exactly.
TEST(StationaryWave, WithoutRotationIsTheExactAnswer) {
  const StationaryWave model = gill();
  constexpr double kRadius_m = 6371000.0;
  const auto harmonic = [](double lat, double lon) {
    return 100.0 * std::cos(lat * kRadians) * std::cos(lon * kRadians);  // l = m = 1
  };
  double before = 0.0;
  for (const int ny : {30, 60, 120}) {
    const Response r(2 * ny, ny, model, 0.0, 0.0, harmonic, kNothing);
    const double e = 1.0 / (3.0 * 86400), e_t = 1.0 / (10.0 * 86400);
    const double p =
        -model.heating_m4_s3_w * 100.0 / (e_t + 40.0 * 40.0 * 2.0 / (e * kRadius_m * kRadius_m));
    // By area: winds in the rows next to the poles, where P nears 0 with the cosine, are first
    // order.
    double squares = 0.0;
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < 2 * ny; ++i) {
        const double lat = r.grid.latitude_deg(j) * kRadians,
                     lon = r.grid.longitude_deg(i) * kRadians;
        const Index c = r.grid.cell(i, j);
        squares += r.grid.area_m2(j) *
                   (std::pow(r.east[c] - p * std::sin(lon) / kRadius_m / e, 2) +
                    std::pow(r.north[c] - p * std::sin(lat) * std::cos(lon) / kRadius_m / e, 2));
      }
    }
    const double error =
        std::sqrt(squares / r.grid.total_area_m2()) / (std::abs(p) / kRadius_m / e);
    EXPECT_LT(error, 0.02 * (30.0 / ny) * (30.0 / ny) + 1e-5) << ny;
    if (before > 0.0) {
      EXPECT_LT(error, 0.3 * before) << "second order";
    }
    before = error;
  }
}

// Forces of one spherical harmonic Y on a planet that does not turn. Along a gradient, X = -grad Y,
// pressure takes up what would make air pile up: with P = p Y
//   p = -k / (e_T + k), k = c^2 l(l+1) / (e a^2), u = -(1 + p) grad Y / e.
// Along the lines of Y nothing piles up, and u = X / e.
TEST(StationaryWave, ForceWithoutRotationIsTheExactAnswer) {
  constexpr double kRadius_m = 6371000.0, kStrength = 400.0, kTurned = 300.0;  // m2 s-2
  const StationaryWave model = gill();
  const double e = 1.0 / (3.0 * 86400), e_t = 1.0 / (10.0 * 86400);
  const double k = 40.0 * 40.0 * 2.0 / (e * kRadius_m * kRadius_m), left = e_t / (e_t + k);
  // grad(cos(lat) cos(lon)) = (-sin(lon), -sin(lat) cos(lon)) / a.
  const auto slope_east = [](double /*lat*/, double lon) {
    return -std::sin(lon * kRadians) / kRadius_m;
  };
  const auto slope_north = [](double lat, double lon) {
    return -std::sin(lat * kRadians) * std::cos(lon * kRadians) / kRadius_m;
  };
  double before = 0.0;
  for (const int ny : {30, 60, 120}) {
    const Response r(
        2 * ny, ny, model, 0.0, 0.0, kNothing, kNothing,
        [&](double lat, double lon) {
          return -kStrength * slope_east(lat, lon) - kTurned * slope_north(lat, lon);
        },
        [&](double lat, double lon) {
          return -kStrength * slope_north(lat, lon) + kTurned * slope_east(lat, lon);
        });
    double squares = 0.0;
    for (Index c = 0; c < r.grid.size(); ++c) {
      const double lat = r.grid.latitude_deg(r.grid.row(c));
      const double lon = r.grid.longitude_deg(r.grid.column(c));
      const double along = slope_east(lat, lon), across = slope_north(lat, lon);
      squares += r.grid.area_m2(r.grid.row(c)) *
                 (std::pow(e * r.east[c] + kStrength * left * along + kTurned * across, 2) +
                  std::pow(e * r.north[c] + kStrength * left * across - kTurned * along, 2));
    }
    const double error = std::sqrt(squares / r.grid.total_area_m2()) * kRadius_m / kTurned;
    EXPECT_LT(error, 0.03 * (30.0 / ny) * (30.0 / ny) + 1e-5) << ny;
    if (before > 0.0) {
      EXPECT_LT(error, 0.3 * before) << "second order";
    }
    before = error;
  }
}

// A force that holds back a trade wind: drag, rotation and pressure balance it, and air goes round.
TEST(StationaryWave, ForceIsBalancedAndAirGoesRound) {
  constexpr int kColumns = 180, kRows = 90;
  constexpr double kRadius_m = 6371000.0, kStep_rad = 2.0 * kRadians;
  const StationaryWave model = gill();
  const auto force = [](double lat, double lon) {
    return 2e-5 * std::exp(-(std::pow((lat - 15) / 10, 2) + std::pow(lon / 20, 2)));
  };
  const Response r(kColumns, kRows, model, 0.0, kTurning, kNothing, kNothing, force, kNothing);
  EXPECT_GT(r.east[r.at(15, 0)], 0.5F) << "the easterly is slower there";
  EXPECT_LT(r.east[r.at(40, 0)], -0.02F) << "and faster beside it";
  const double e = 1.0 / (3.0 * 86400), e_t = 1.0 / (10.0 * 86400);
  const auto geopotential = [&](Index c) { return -40.0 * 40.0 / e_t * r.descent[c]; };
  double left = 0.0, all = 0.0;
  for (int j = 15; j < kRows - 15; ++j) {
    const double lat = r.grid.latitude_deg(j), f = 2.0 * kTurning * std::sin(lat * kRadians);
    double mean = 0.0;  // which is left out
    for (int i = 0; i < kColumns; ++i) mean += force(lat, r.grid.longitude_deg(i)) / kColumns;
    for (int i = 0; i < kColumns; ++i) {
      const Index c = r.grid.cell(i, j);
      const auto slope = [&](int to, int from, double step_m) {
        return (geopotential(r.grid.neighbour(i, j, to)) -
                geopotential(r.grid.neighbour(i, j, from))) /
               (2.0 * step_m);
      };
      const double step_m = kRadius_m * kStep_rad;
      const double push = force(lat, r.grid.longitude_deg(i)) - mean;
      const double east = e * r.east[c] - f * r.north[c] +
                          slope(kEast, kWest, step_m * std::cos(lat * kRadians)) - push;
      const double north = e * r.north[c] + f * r.east[c] + slope(kNorth, kSouth, step_m);
      left += r.grid.area_m2(j) * (east * east + north * north);
      all += r.grid.area_m2(j) * push * push;
    }
  }
  EXPECT_LT(std::sqrt(left / all), 0.03);
}

TEST(StationaryWave, WesterliesOverMountainsLeaveATroughBehind) {
  StationaryWave model = gill();
  model.mountain_share = 0.5;
  const auto range = [](double lat, double lon) {
    return 2000.0 * std::exp(-(std::pow((lat - 45) / 12, 2) + std::pow(lon / 8, 2)));
  };
  const Response r(180, 90, model, 15.0, kTurning, kNothing, range);
  EXPECT_GT(r.north[r.at(45, -15)], r.north[r.at(45, 12)])
      << "polewards before the ridge on the crest, equatorwards behind it";
}

TEST(SoilMoisture, EvaporatesNoMoreThanFallsOrThanTheSunAllows) {
  const SoilMoisture model;
  for (int k = 0; k < 200; ++k) {
    std::array<double, kMonths> t{}, p{}, e{};
    double rain = 0.0, back = 0.0;
    for (int m = 0; m < kMonths; ++m) {
      t[m] = 10.0 + (k % 30 - 20) * std::cos(2 * std::numbers::pi * m / 12);
      p[m] = (k % 7) * 20.0 * (1.0 + 0.9 * std::sin(k + m));
      e[m] = std::max(0.0, 3.0 * (t[m] + 5.0));
      rain += p[m];
    }
    const auto evaporation = soil_evaporation_mm(model, t, p, e);
    for (int m = 0; m < kMonths; ++m) {
      EXPECT_GE(evaporation[m], 0.0);
      EXPECT_LE(evaporation[m], e[m] + 1e-9);
      back += evaporation[m];
    }
    EXPECT_LE(back, rain * 1.001 + 0.2) << k;
  }
}

TEST(SoilMoisture, ServesTheDrySeasonFromTheWetOne) {
  const SoilMoisture model;
  std::array<double, kMonths> t{}, p{}, e{};
  t.fill(25.0), e.fill(120.0);
  for (int m = 0; m < 6; ++m) p[m] = 200.0;
  const auto evaporation = soil_evaporation_mm(model, t, p, e);
  EXPECT_NEAR(evaporation[3], 120.0, 1e-9) << "wet season";
  EXPECT_GT(evaporation[6], 60.0) << "soon after";
  EXPECT_LT(evaporation[11], 0.3 * evaporation[6]) << "long after";
}

// Soil that loses little fills for decades.
TEST(SoilMoisture, OfAClimateWithoutSeasonsHasNone) {
  SoilMoisture model;
  model.capacity_mm = 500.0;
  std::array<double, kMonths> t{}, p{}, e{};
  t.fill(10.0), p.fill(5.0), e.fill(10.0);
  for (const double evaporation : soil_evaporation_mm(model, t, p, e)) {
    EXPECT_NEAR(evaporation, 5.0, 1e-3);
  }
}

}  // namespace
}  // namespace geo
