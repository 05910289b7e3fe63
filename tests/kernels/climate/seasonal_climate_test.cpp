#include "geo/kernels/climate/seasonal_climate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace geo {
namespace {

/// A low continent from 60 S to 70 N, 30 degrees wide, on a planet of sea: rain comes all the way
/// in.
struct Continent {
  Continent() : land(size()), height_m(size(), 0.0F) {
    for (int j = 0; j < grid.ny(); ++j) latitude_deg.push_back(grid.latitude_deg(j));
    for (Index c = 0; c < grid.size(); ++c) {
      const double latitude = latitude_deg[grid.row(c)];
      const bool inside =
          latitude > -60.0 && latitude < 70.0 && grid.column(c) >= kWest && grid.column(c) < kEast;
      land[c] = inside ? 1.0F : 0.0F;
      if (inside) height_m[c] = 200.0F;
    }
  }
  [[nodiscard]] SeasonalFields solve(const SeasonalClimate& model) const {
    return solve_seasonal_climate(grid, model, latitude_deg, land, height_m);
  }
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(grid.size()); }

  static constexpr int kWest = 33, kEast = 39;
  Grid grid = Grid::sphere(72, 36);
  std::vector<double> latitude_deg;
  std::vector<float> land, height_m;
};

// Soil that has dried out no longer cools the ground: the tropics are hottest before the rains.
TEST(SeasonalClimate, GroundIsWarmerWhileItsSoilIsDry) {
  const Continent continent;
  const SeasonalClimate model;
  SeasonalClimate without = model;
  without.energy.dry_warming_k_m2_w = 0.0;
  const SeasonalFields with = continent.solve(model), plain = continent.solve(without);
  double in_wettest_k = 0.0, in_driest_k = 0.0;
  for (Index c = 0; c < continent.grid.size(); ++c) {
    const double latitude = continent.latitude_deg[continent.grid.row(c)];
    if (continent.land[c] < 1.0F || std::abs(latitude) > 20.0) continue;
    int wettest = 0, driest = 0;
    for (int m = 1; m < kMonths; ++m) {
      if (with.precipitation_mm[m][c] > with.precipitation_mm[wettest][c]) wettest = m;
      if (with.precipitation_mm[m][c] < with.precipitation_mm[driest][c]) driest = m;
    }
    if (with.precipitation_mm[wettest][c] < 150.0F || with.precipitation_mm[driest][c] > 20.0F)
      continue;
    const auto warming_k = [&](int m) {
      return with.temperature_c[m][c] - plain.temperature_c[m][c];
    };
    in_wettest_k += warming_k(wettest);
    in_driest_k += warming_k(driest);
  }
  EXPECT_GT(in_driest_k, 0.0);
  EXPECT_LT(in_wettest_k, 0.4 * in_driest_k);
}

/// Latitude about which the rain of a month falls within the tropics.
double rain_belt_deg(const Continent& continent, const std::vector<float>& rain_mm) {
  double moment = 0.0, sum = 0.0;
  for (Index c = 0; c < continent.grid.size(); ++c) {
    const int row = continent.grid.row(c);
    if (std::abs(continent.latitude_deg[row]) > 25.0) continue;
    const double water = continent.grid.area_m2(row) * rain_mm[c];
    moment += water * continent.latitude_deg[row];
    sum += water;
  }
  return moment / sum;
}

TEST(SeasonalClimate, RainBeltComesLaterWhereTheTroughLags) {
  const Continent continent;
  SeasonalClimate model;
  model.itcz_lag_month = 0.0;
  const SeasonalFields prompt = continent.solve(model);
  model.itcz_lag_month = 1.0;
  const SeasonalFields late = continent.solve(model);
  constexpr int kMay = 4, kNovember = 10;
  EXPECT_LT(rain_belt_deg(continent, late.precipitation_mm[kMay]),
            rain_belt_deg(continent, prompt.precipitation_mm[kMay]) - 0.2);
  EXPECT_GT(rain_belt_deg(continent, late.precipitation_mm[kNovember]),
            rain_belt_deg(continent, prompt.precipitation_mm[kNovember]) + 0.2);
}

TEST(SeasonalClimate, MonsoonComesLaterWhereHeatLowsLag) {
  const Continent continent;
  SeasonalClimate model;
  model.heat_low_lag_month = 0.0;
  const SeasonalFields prompt = continent.solve(model);
  model.heat_low_lag_month = 1.0;
  const SeasonalFields late = continent.solve(model);
  // Of the rain that the northern subtropics of the continent have before and after midsummer.
  const auto early_share = [&](const SeasonalFields& fields) {
    double early = 0.0, all = 0.0;
    for (Index c = 0; c < continent.grid.size(); ++c) {
      const double latitude = continent.latitude_deg[continent.grid.row(c)];
      if (continent.land[c] < 1.0F || latitude < 10.0 || latitude > 35.0) continue;
      for (const int m : {3, 4, 5, 7, 8, 9}) {
        all += fields.precipitation_mm[m][c];
        if (m < 6) early += fields.precipitation_mm[m][c];
      }
    }
    return early / all;
  };
  EXPECT_LT(early_share(late), early_share(prompt) - 0.02);
}

// Snow in the polar night lies under air that is warmer; summers and the tropics know nothing of
// it.
TEST(SeasonalClimate, SnowOfThePolarNightIsColderThanItsAir) {
  const Continent continent;
  SeasonalClimate model, without = model;
  model.energy.inversion_k = 4.0;
  model.energy.inversion_growth = 0.2;
  without.energy.inversion_k = without.energy.inversion_growth = 0.0;
  const SeasonalFields with = continent.solve(model), plain = continent.solve(without);
  for (Index c = 0; c < continent.grid.size(); ++c) {
    const double latitude = continent.latitude_deg[continent.grid.row(c)];
    const auto colder_k = [&](int m) {
      return plain.temperature_c[m][c] - with.temperature_c[m][c];
    };
    if (continent.land[c] > 0.0F && latitude > 64.0) {
      EXPECT_GT(colder_k(0), 3.0) << latitude;
    }
    if (continent.land[c] == 0.0F || latitude > 50.0) {
      EXPECT_NEAR(colder_k(6), 0.0, 0.1);
    }
    if (std::abs(latitude) < 20.0) {
      EXPECT_NEAR(colder_k(0), 0.0, 0.01);
    }
  }
}

// Trades and westerlies lose their speed over rough land, and turn aside before they get there.
TEST(SeasonalClimate, RoughLandTurnsTheWindAside) {
  const Continent continent;
  SeasonalClimate model;
  model.land_drag = 0.0;
  const SeasonalFields smooth = continent.solve(model);
  model.land_drag = 10.0;
  const SeasonalFields rough = continent.solve(model);
  const auto mean = [&](int from, int to, auto&& of_cell) {
    double sum = 0.0, area = 0.0;
    for (Index c = 0; c < continent.grid.size(); ++c) {
      const int row = continent.grid.row(c), column = continent.grid.column(c);
      const double latitude = continent.latitude_deg[row];
      if (column < from || column >= to || latitude < 5.0 || latitude > 25.0) continue;
      sum += continent.grid.area_m2(row) * of_cell(c);
      area += continent.grid.area_m2(row);
    }
    return sum / area;
  };
  constexpr int kJanuary = 0, kHalf = Continent::kEast - Continent::kWest;
  const auto east_m_s = [&](const SeasonalFields& fields, int from, int to) {
    return mean(from, to, [&](Index c) { return fields.wind_east[kJanuary][c]; });
  };
  const double over_smooth_m_s = east_m_s(smooth, Continent::kWest, Continent::kEast);
  const double over_rough_m_s = east_m_s(rough, Continent::kWest, Continent::kEast);
  EXPECT_LT(over_smooth_m_s, -1.0) << "the trade wind";
  EXPECT_GT(over_rough_m_s, 0.8 * over_smooth_m_s);
  // Before it gets there, on its way along the eastern coast.
  const auto aside_m_s = mean(Continent::kEast, Continent::kEast + kHalf, [&](Index c) {
    return std::abs(rough.wind_north[kJanuary][c] - smooth.wind_north[kJanuary][c]);
  });
  EXPECT_GT(aside_m_s, 0.1);
}

// Without what ascent adds, where and how fast air rises makes no difference.
TEST(SeasonalClimate, AscentAddsNoMoreThanItsBound) {
  const Continent continent;
  const auto rain_mm = [&](double time_d, double bound) {
    SeasonalClimate model;
    model.ascent_time_d = time_d;
    model.ascent_bound = model.descent_bound = bound;
    return continent.solve(model).precipitation_mm[6];
  };
  const auto weak = rain_mm(2.0, 1e-9), strong = rain_mm(20.0, 1e-9);
  const auto weak_bounded = rain_mm(2.0, 2.0), strong_bounded = rain_mm(20.0, 2.0);
  double difference_mm = 0.0, bounded_mm = 0.0;
  for (std::size_t c = 0; c < continent.size(); ++c) {
    EXPECT_NEAR(strong[c], weak[c], 1e-4F * weak[c]) << c;
    difference_mm = std::max<double>(difference_mm, std::abs(strong[c] - weak[c]));
    bounded_mm = std::max<double>(bounded_mm, std::abs(strong_bounded[c] - weak_bounded[c]));
  }
  EXPECT_GT(bounded_mm, 50.0);
  EXPECT_GT(bounded_mm, 100.0 * difference_mm);
}

/// Share of July's rain on the tropical sea that falls where that is warmer than on the mean.
double share_of_warm_seas(const Continent& continent, const SeasonalFields& fields) {
  constexpr int kJuly = 6;
  const auto sum_up = [&](auto&& of_cell) {
    double sum = 0.0;
    for (Index c = 0; c < continent.grid.size(); ++c) {
      const int row = continent.grid.row(c);
      const bool counts = continent.land[c] == 0.0F && std::abs(continent.latitude_deg[row]) < 25.0;
      if (counts) sum += continent.grid.area_m2(row) * of_cell(c);
    }
    return sum;
  };
  const double mean_c = sum_up([&](Index c) { return fields.temperature_c[kJuly][c]; }) /
                        sum_up([](Index) { return 1.0; });
  const auto& rain_mm = fields.precipitation_mm[kJuly];
  return sum_up(
             [&](Index c) { return fields.temperature_c[kJuly][c] > mean_c ? rain_mm[c] : 0.0; }) /
         sum_up([&](Index c) { return rain_mm[c]; });
}

TEST(SeasonalClimate, ConvectionRainsOverTheWarmestSeas) {
  const Continent continent;
  SeasonalClimate model;
  model.convection_latitude_deg = 25.0;
  model.ascent_bound = model.descent_bound = 0.5;  // so that ascent does not decide alone
  model.convection_1_k = 0.0;
  const double without = share_of_warm_seas(continent, continent.solve(model));
  model.convection_1_k = 0.2;
  const double with = share_of_warm_seas(continent, continent.solve(model));
  EXPECT_GT(with, without + 0.01) << without;
}

// Gyres make the west of the sea warmer than its air and the east colder. Where water and air
// hardly differ, as they exchange all heat at once, only the temperature of the air tells them
// apart.
TEST(SeasonalClimate, SeaThatIsWarmerThanTheAirHasMoreRainAboveIt) {
  const Continent continent;
  const auto west_over_east = [&](double exchange_w_m2_k) {
    SeasonalClimate model;
    model.energy.sea_exchange_w_m2_k = exchange_w_m2_k;
    const SeasonalFields fields = continent.solve(model);
    const auto rain_mm = [&](int first, int end) {
      double sum = 0.0;
      for (Index c = 0; c < continent.grid.size(); ++c) {
        const int i = continent.grid.column(c), j = continent.grid.row(c);
        const double latitude = std::abs(continent.latitude_deg[j]);
        if (i < first || i >= end || latitude < 10.0 || latitude > 40.0) continue;
        for (const auto& month : fields.precipitation_mm)
          sum += continent.grid.area_m2(j) * month[c];
      }
      return sum;
    };
    constexpr int kWide = 12;
    return rain_mm(Continent::kEast, Continent::kEast + kWide) /
           rain_mm(Continent::kWest - kWide, Continent::kWest);
  };
  EXPECT_GT(west_over_east(20.0), 1.05 * west_over_east(200.0));
}

TEST(SeasonalClimate, EddiesRainLessUnderSinkingAir) {
  const Continent continent;
  SeasonalClimate model;
  model.ascent_bound = 1e-9;  // so that ascent alone makes no difference
  model.eddy_rain = 1.0;
  model.circulation.overturning_share = 1.0;  // so that highs sink fast
  const auto rain_mm = [&](double share) {
    model.eddy_descent_share = share;
    return continent.solve(model).precipitation_mm[0];
  };
  const auto untouched = rain_mm(0.0), lessened = rain_mm(1.0);
  double before = 0.0, after = 0.0;  // in the winter's subtropics
  for (Index c = 0; c < continent.grid.size(); ++c) {
    const int row = continent.grid.row(c);
    if (std::abs(continent.latitude_deg[row] - 22.5) > 10.0) continue;
    before += continent.grid.area_m2(row) * untouched[c];
    after += continent.grid.area_m2(row) * lessened[c];
  }
  EXPECT_LT(after, 0.9 * before);
}

// Where a planet hardly turns all of it is as its tropics.
TEST(SeasonalClimate, SlowRotationMakesTropicsOfAllLatitudes) {
  const Continent continent;
  const auto edge_matters_mm = [&](double rotation_period_h) {
    const auto rain_mm = [&](double edge_deg) {
      SeasonalClimate model;
      model.circulation.rotation_period_h = rotation_period_h;
      model.ascent_latitude_deg = edge_deg;
      return continent.solve(model).precipitation_mm[0];
    };
    const auto narrow = rain_mm(20.0), wide = rain_mm(60.0);
    double sum_mm = 0.0;
    for (std::size_t c = 0; c < continent.size(); ++c) sum_mm += std::abs(narrow[c] - wide[c]);
    return sum_mm / static_cast<double>(continent.size());
  };
  EXPECT_LT(edge_matters_mm(480.0), 0.1 * edge_matters_mm(23.934));
}

}  // namespace
}  // namespace geo
