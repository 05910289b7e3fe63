#include "geo/kernels/moisture.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geo/core/error.hpp"

namespace geo {
namespace {

constexpr double kSecondsPerDay = 86400.0;

/// Exchange of one cell: out W_here - sum in_k W_k, per day.
struct Exchange {
  float out;
  float from_east, from_west, from_north, from_south;
};

std::vector<Exchange> build_exchange(const Grid& grid, const MoistureSeason& season) {
  std::vector<Exchange> exchange(static_cast<std::size_t>(grid.size()));
  std::vector<double> out(static_cast<std::size_t>(grid.size()), 0.0);
  for (int j = 0; j < grid.ny(); ++j) {
    const double area_m2 = grid.area_m2(j);
    for (int i = 0; i < grid.nx(); ++i) {
      const Index here = grid.cell(i, j);
      {
        const Index east = grid.neighbour(i, j, kEast);
        const double speed = 0.5 * (season.wind_east[here] + season.wind_east[east]);
        const double mixing =
            0.5 * (season.diffusivity[here] + season.diffusivity[east]) / grid.spacing_east_m(j);
        const double rate = grid.face_east_m(j) / area_m2 * kSecondsPerDay;
        const double leaving = rate * (std::max(speed, 0.0) + mixing);
        const double arriving = rate * (std::max(-speed, 0.0) + mixing);
        out[here] += leaving;
        exchange[here].from_east = static_cast<float>(arriving);
        out[east] += arriving;
        exchange[east].from_west = static_cast<float>(leaving);
      }
      const double face_m = grid.face_north_m(j);
      const bool pole = grid.topology() == Topology::sphere && j == grid.ny() - 1;
      if (!pole) {
        const Index north = grid.neighbour(i, j, kNorth);
        const double speed = 0.5 * (season.wind_north[here] + season.wind_north[north]);
        const double mixing =
            0.5 * (season.diffusivity[here] + season.diffusivity[north]) / grid.spacing_north_m(j);
        const double leaving = face_m * kSecondsPerDay * (std::max(speed, 0.0) + mixing);
        const double arriving = face_m * kSecondsPerDay * (std::max(-speed, 0.0) + mixing);
        const double north_area_m2 = grid.area_m2(grid.row(north));
        out[here] += leaving / area_m2;
        exchange[here].from_north = static_cast<float>(arriving / area_m2);
        out[north] += arriving / north_area_m2;
        exchange[north].from_south = static_cast<float>(leaving / north_area_m2);
      }
    }
  }
  for (std::size_t cell = 0; cell < out.size(); ++cell) {
    exchange[cell].out = static_cast<float>(out[cell]);
  }
  return exchange;
}

double integer_power(double base, std::int64_t exponent) {
  double power = 1.0;
  for (std::int64_t k = 0; k < exponent; ++k) power *= base;
  return power;
}

}  // namespace

double rain_mm_d(const MoistureBudget& model, double column_mm, double saturated_mm,
                 double eddy_activity) {
  return eddy_activity * column_mm / model.rain_time_d *
         integer_power(column_mm / saturated_mm, model.humidity_exponent);
}

void solve_moisture(const Grid& grid, const MoistureBudget& model, const MoistureSeason& season,
                    std::span<double> column_mm) {
  if (grid.topology() == Topology::plane) throw Bug("solve_moisture: the grid has edges");
  const int nx = grid.nx(), ny = grid.ny();
  const auto exchange = build_exchange(grid, season);
  const std::int64_t n = model.humidity_exponent;
  const auto relax_cell = [&](int i, int j) {
    const Index here = grid.cell(i, j);
    const Exchange& x = exchange[here];
    const Index east = grid.cell(i + 1 == nx ? 0 : i + 1, j);
    const Index west = grid.cell(i == 0 ? nx - 1 : i - 1, j);
    const Index north = j + 1 < ny ? here + nx : grid.neighbour(i, j, kNorth);
    const Index south = j > 0 ? here - nx : grid.neighbour(i, j, kSouth);
    const double capacity = season.saturated_mm[here];
    const double open = season.open_water_1_d[here];
    const double supply = x.from_east * column_mm[east] + x.from_west * column_mm[west] +
                          x.from_north * column_mm[north] + x.from_south * column_mm[south] +
                          season.land_evaporation[here];
    // supply + open (W_s - w)+ = out w + c w (w/W_s)^n: one Newton step from the present value,
    // which lies on the convex side after the first.
    const double rain_rate = season.eddy_activity[here] / model.rain_time_d;
    double w = column_mm[here];
    for (int step = 0; step < 2; ++step) {
      const double humidity = w / capacity;
      const double power = integer_power(humidity, n);
      const bool unsaturated = w < capacity;
      const double value =
          x.out * w + rain_rate * power * w - supply - (unsaturated ? open * (capacity - w) : 0.0);
      const double slope =
          x.out + rain_rate * power * (static_cast<double>(n) + 1.0) + (unsaturated ? open : 0.0);
      w = std::max(w - value / slope, 0.01 * w);
    }
    column_mm[here] = w;
  };
  for (int sweep = 0; sweep < model.sweeps; ++sweep) {
    const bool northward = sweep % 2 == 0, eastward = sweep % 4 < 2;
    // Some rows at once, each a column behind the one before: every cell still meets the neighbours
    // that it would meet row by row, but the processor need not wait for one cell after the other.
    constexpr int kTogether = 4;
    for (int first = 0; first < ny; first += kTogether) {
      const int rows = std::min(kTogether, ny - first);
      for (int step = 0; step < nx + rows - 1; ++step) {
        for (int k = std::max(0, step - nx + 1); k < std::min(rows, step + 1); ++k) {
          const int column = step - k, row = first + k;
          relax_cell(eastward ? column : nx - 1 - column, northward ? row : ny - 1 - row);
        }
      }
    }
  }
}

}  // namespace geo
