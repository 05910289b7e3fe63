#include "geo/kernels/climate/moisture.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"
#include "kernels/numerics/wide.hpp"

namespace geo {
namespace {

constexpr double kSecondsPerDay = 86400.0;

double integer_power(double base, std::int64_t exponent) {
  double power = 1.0;
  for (std::int64_t k = 0; k < exponent; ++k) power *= base;
  return power;
}

/// A value of each season in a register, or in two.
using Quad = double __attribute__((vector_size(32), aligned(32), may_alias));
using FloatQuad = float __attribute__((vector_size(16), aligned(16), may_alias));

template <class Array>
const Quad& quad(const Array& lanes) {
  return reinterpret_cast<const Quad&>(lanes);
}
// Through a reference: a vector as a result would depend on the processor that it is made for.
[[gnu::always_inline]] inline void widen(const std::array<float, 4>& lanes, Quad& wide) {
  wide = __builtin_convertvector(reinterpret_cast<const FloatQuad&>(lanes), Quad);
}

}  // namespace

double rain_mm_d(const MoistureBudget& model, double column_mm, double saturated_mm,
                 double activity, double eddies) {
  const double humidity = column_mm / saturated_mm;
  return column_mm / model.rain_time_d *
         (activity * integer_power(humidity, model.humidity_exponent) + eddies * humidity);
}

double sea_evaporation_mm_d(double column_mm, double saturated_mm, double open_water_1_d) {
  return open_water_1_d * std::max(0.0, saturated_mm - column_mm);
}

SteadyMoisture::SteadyMoisture(const Grid& grid, const MoistureBudget& model,
                               std::span<const MoistureSeason> seasons)
    : grid_(grid),
      model_(model),
      seasons_(seasons.begin(), seasons.end()),
      air_(grid.size()),
      land_evaporation_(grid.size()),
      column_(grid.size()) {
  if (grid.topology() == Topology::plane) throw Bug("moisture: the grid has edges");
  if (seasons.empty() || seasons.size() > kSeasons) throw Bug("moisture: too many seasons");
  for (const MoistureSeason& season : seasons) {
    check_sizes("moisture", grid.size(),
                {{"wind_east", season.wind_east.size()},
                 {"wind_north", season.wind_north.size()},
                 {"diffusivity", season.diffusivity.size()},
                 {"activity", season.activity.size()},
                 {"eddies", season.eddies.size()},
                 {"saturated_mm", season.saturated_mm.size()},
                 {"open_water_1_d", season.open_water_1_d.size()},
                 {"land_evaporation", season.land_evaporation.size()},
                 {"column_mm", season.column_mm.size()}});
  }
  for (int lane = 0; lane < kSeasons; ++lane) take_exchange(lane);
}

/// Lanes to spare take the first season.
const MoistureSeason& SteadyMoisture::season(int lane) const {
  return seasons_[lane < static_cast<int>(seasons_.size()) ? lane : 0];
}

void SteadyMoisture::take_exchange(int lane) {
  const MoistureSeason& season = this->season(lane);
  std::vector<double> out(air_.size(), 0.0);
  for (int j = 0; j < grid_.ny(); ++j) {
    const double area_m2 = grid_.area_m2(j);
    const double face_m = grid_.face_north_m(j);
    const bool pole = grid_.topology() == Topology::sphere && j == grid_.ny() - 1;
    for (int i = 0; i < grid_.nx(); ++i) {
      const Index here = grid_.cell(i, j);
      {
        const Index east = grid_.neighbour(i, j, kEast);
        const double speed = 0.5 * (season.wind_east[here] + season.wind_east[east]);
        const double mixing =
            0.5 * (season.diffusivity[here] + season.diffusivity[east]) / grid_.spacing_east_m(j);
        const double rate = grid_.face_east_m(j) / area_m2 * kSecondsPerDay;
        const double leaving = rate * (std::max(speed, 0.0) + mixing);
        const double arriving = rate * (std::max(-speed, 0.0) + mixing);
        out[here] += leaving;
        air_[here].from_east[lane] = arriving;
        out[east] += arriving;
        air_[east].from_west[lane] = leaving;
      }
      if (pole) continue;
      const Index north = grid_.neighbour(i, j, kNorth);
      const double speed = 0.5 * (season.wind_north[here] + season.wind_north[north]);
      const double mixing =
          0.5 * (season.diffusivity[here] + season.diffusivity[north]) / grid_.spacing_north_m(j);
      const double leaving = face_m * kSecondsPerDay * (std::max(speed, 0.0) + mixing);
      const double arriving = face_m * kSecondsPerDay * (std::max(-speed, 0.0) + mixing);
      const double north_area_m2 = grid_.area_m2(grid_.row(north));
      out[here] += leaving / area_m2;
      air_[here].from_north[lane] = arriving / area_m2;
      out[north] += arriving / north_area_m2;
      air_[north].from_south[lane] = leaving / north_area_m2;
    }
  }
  for (std::size_t cell = 0; cell < out.size(); ++cell) {
    Air& air = air_[cell];
    air.out[lane] = out[cell];
    air.saturated_mm[lane] = season.saturated_mm[cell];
    air.open_water_1_d[lane] = season.open_water_1_d[cell];
    air.rain_rate_1_d[lane] = season.activity[cell] / model_.rain_time_d;
    air.eddy_rate_1_d[lane] = season.eddies[cell] / model_.rain_time_d;
  }
}

/// What a sweep goes over: the lanes of every cell, and the cells beyond the first and last row.
struct SteadyMoisture::Field {
  int nx, ny;
  std::int64_t exponent;
  const Air* air;
  const DoubleLanes* land_evaporation;
  DoubleLanes* column;
  std::vector<Index> beyond_south, beyond_north;
};

TERRANE_WIDE void SteadyMoisture::sweep(const Field& field, bool northward, bool eastward) {
  const int nx = field.nx, ny = field.ny;
  const Quad next_power = Quad{} + (static_cast<double>(field.exponent) + 1.0);
  // Some rows at once, each a column behind the one before: every cell still meets the neighbours
  // that it would meet row by row, but the processor need not wait for one cell after the other.
  constexpr int kTogether = 4;
  for (int first = 0; first < ny; first += kTogether) {
    const int rows = std::min(kTogether, ny - first);
    for (int step = 0; step < nx + rows - 1; ++step) {
      for (int k = std::max(0, step - nx + 1); k < std::min(rows, step + 1); ++k) {
        const int i = eastward ? step - k : nx - 1 - (step - k);
        const int j = northward ? first + k : ny - 1 - (first + k);
        const Index row = static_cast<Index>(j) * nx, here = row + i;
        const Index east = row + (i + 1 == nx ? 0 : i + 1), west = row + (i == 0 ? nx - 1 : i - 1);
        const Index north = j + 1 < ny ? here + nx : field.beyond_north[i];
        const Index south = j > 0 ? here - nx : field.beyond_south[i];
        const Air& air = field.air[here];
        Quad capacity, open;
        widen(air.saturated_mm, capacity);
        widen(air.open_water_1_d, open);
        const Quad &out = quad(air.out), &rain_rate = quad(air.rain_rate_1_d),
                   &eddy_rate = quad(air.eddy_rate_1_d);
        const Quad supply = quad(air.from_east) * quad(field.column[east]) +
                            quad(air.from_west) * quad(field.column[west]) +
                            quad(air.from_north) * quad(field.column[north]) +
                            quad(air.from_south) * quad(field.column[south]) +
                            quad(field.land_evaporation[here]);
        // supply + open (W_s - w)+ = out w + c w (w/W_s)^n + e w w/W_s: two Newton steps from the
        // present value, which lies on the convex side after the first.
        Quad w = quad(field.column[here]);
        for (int newton = 0; newton < 2; ++newton) {
          const Quad humidity = w / capacity;
          Quad power = Quad{} + 1.0;
          for (std::int64_t n = 0; n < field.exponent; ++n) power *= humidity;
          const auto unsaturated = w < capacity;
          const Quad none{};
          const Quad value = out * w + (rain_rate * power + eddy_rate * humidity) * w - supply -
                             (unsaturated ? open * (capacity - w) : none);
          const Quad slope = out + rain_rate * power * next_power + 2.0 * eddy_rate * humidity +
                             (unsaturated ? open : none);
          const Quad better = w - value / slope, least = 0.01 * w;
          w = better < least ? least : better;
        }
        reinterpret_cast<Quad&>(field.column[here]) = w;
      }
    }
  }
}

void SteadyMoisture::solve() {
  Field field{grid_.nx(),
              grid_.ny(),
              model_.humidity_exponent,
              air_.data(),
              land_evaporation_.data(),
              column_.data(),
              {},
              {}};
  for (int i = 0; i < grid_.nx(); ++i) {
    field.beyond_south.push_back(grid_.neighbour(i, 0, kSouth));
    field.beyond_north.push_back(grid_.neighbour(i, grid_.ny() - 1, kNorth));
  }
  for (int lane = 0; lane < kSeasons; ++lane) {
    const MoistureSeason& season = this->season(lane);
    for (std::size_t cell = 0; cell < air_.size(); ++cell) {
      land_evaporation_[cell][lane] = season.land_evaporation[cell];
      column_[cell][lane] = season.column_mm[cell];
    }
  }
  for (int number = 0; number < model_.sweeps; ++number) {
    sweep(field, number % 2 == 0, number % 4 < 2);
  }
  for (std::size_t lane = 0; lane < seasons_.size(); ++lane) {
    for (std::size_t cell = 0; cell < air_.size(); ++cell) {
      seasons_[lane].column_mm[cell] = column_[cell][lane];
    }
  }
}

}  // namespace geo
