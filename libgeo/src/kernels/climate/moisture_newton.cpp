#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geo/kernels/climate/moisture.hpp"

namespace geo {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

/// Factors of the first matrix that it is given: later ones differ little, and factors cost more
/// than the few iterations that better ones would save.
class FirstFactors : public Eigen::IncompleteLUT<double> {
 public:
  template <class Any>
  FirstFactors& compute(const Any& matrix) {
    if (!found_) Eigen::IncompleteLUT<double>::compute(matrix);
    found_ = true;
    return *this;
  }

 private:
  bool found_ = false;
};

/// Mean of |values| over the surface.
double mean_size(const Grid& grid, const Vector& values) {
  double sum = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    double row = 0.0;
    for (Index c = grid.cell(0, j); c < grid.cell(0, j) + grid.nx(); ++c)
      row += std::abs(values[c]);
    sum += grid.area_m2(j) * row;
  }
  return sum / grid.total_area_m2();
}

}  // namespace

void SteadyMoisture::close(std::size_t lane, double closed) const {
  constexpr double kLinear = 1e-4, kDropped = 1e-2;
  constexpr int kMostSteps = 60, kNeighbours = 4;
  const MoistureSeason& season = seasons_[lane];
  const Index size = grid_.size();
  std::array<std::vector<Index>, kNeighbours> from;
  for (Index c = 0; c < size; ++c) {
    for (int k = 0; k < kNeighbours; ++k) {
      constexpr std::array kSides{kEast, kWest, kNorth, kSouth};
      from[k].push_back(grid_.neighbour(c, kSides[k]));
    }
  }
  Vector excess(size), rain(size);
  std::vector<Eigen::Triplet<double>> entries;
  Matrix slope(size, size);
  Eigen::BiCGSTAB<Matrix, FirstFactors> solver;
  solver.preconditioner().setDroptol(kDropped);
  solver.setTolerance(kLinear);
  for (int step = 0; step < kMostSteps; ++step) {
    entries.clear();
    for (Index c = 0; c < size; ++c) {
      const Air& air = air_[c];
      const double w = season.column_mm[c], capacity = season.saturated_mm[c];
      const std::array rate{air.from_east[lane], air.from_west[lane], air.from_north[lane],
                            air.from_south[lane]};
      double arriving = 0.0;
      for (int k = 0; k < kNeighbours; ++k) {
        if (rate[k] == 0.0) continue;
        arriving += rate[k] * season.column_mm[from[k][c]];
        entries.emplace_back(c, from[k][c], -rate[k]);
      }
      rain[c] = rain_mm_d(model_, w, capacity, season.activity[c], season.eddies[c]);
      const double by_eddies = rain_mm_d(model_, w, capacity, 0.0, season.eddies[c]);
      const double open = season.open_water_1_d[c];
      excess[c] = arriving - air.out[lane] * w + season.land_evaporation[c] +
                  sea_evaporation_mm_d(w, capacity, open) - rain[c];
      const double drying =
          w > 0.0 ? ((model_.humidity_exponent + 1.0) * (rain[c] - by_eddies) + 2.0 * by_eddies) / w
                  : 0.0;
      entries.emplace_back(c, c, air.out[lane] + drying + (w < capacity ? open : 0.0));
    }
    if (mean_size(grid_, excess) <= closed * mean_size(grid_, rain)) return;
    slope.setFromTriplets(entries.begin(), entries.end());
    solver.compute(slope);
    const Vector change = solver.solve(excess);
    for (Index c = 0; c < size; ++c) {
      const double w = season.column_mm[c];
      season.column_mm[c] = std::max(0.01 * w, w + change[c]);
    }
  }
}

}  // namespace geo
