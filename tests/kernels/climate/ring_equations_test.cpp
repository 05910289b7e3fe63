#include "kernels/climate/ring_equations.hpp"

#include <gtest/gtest.h>

#include <Eigen/IterativeLinearSolvers>
#include <cmath>
#include <complex>
#include <vector>

namespace geo {
namespace {

using Complex = RingEquations::Complex;

/// A coupling of a cell with its side, none over a pole.
double coupling(const Grid& grid, int i, int j, int side) {
  const bool over_pole = grid.topology() == Topology::sphere &&
                         ((side == kSouth && j == 0) || (side == kNorth && j == grid.ny() - 1));
  return over_pole ? 0.0 : 1.5 + std::sin(1.0 + 3.0 * i + 5.0 * j + 7.0 * side);
}

Complex loss(int i, int j) { return {0.2 + 0.01 * i, 0.3 * std::cos(2.0 * i + j)}; }

RingEquations equations_on(const Grid& grid) {
  RingEquations equations(grid);
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      equations.add_own(grid.cell(i, j), loss(i, j));
      for (const int side : {kEast, kWest, kNorth, kSouth}) {
        equations.add_exchange(i, j, side, coupling(grid, i, j, side));
      }
    }
  }
  return equations;
}

std::vector<Complex> some_values(const Grid& grid) {
  std::vector<Complex> values;
  for (Index c = 0; c < grid.size(); ++c) values.emplace_back(std::sin(1.3 * c), std::cos(0.7 * c));
  return values;
}

/// loss x + sum of w (x - x of the side), cell by cell.
std::vector<Complex> product(const Grid& grid, const std::vector<Complex>& x) {
  std::vector<Complex> y;
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const Complex own = x[grid.cell(i, j)];
      Complex sum = loss(i, j) * own;
      for (const int side : {kEast, kWest, kNorth, kSouth}) {
        sum += coupling(grid, i, j, side) * (own - x[grid.neighbour(i, j, side)]);
      }
      y.push_back(sum);
    }
  }
  return y;
}

std::vector<Grid> grids() {
  return {Grid::sphere(12, 7), Grid::sphere(12, 6), Grid::torus(9, 7, 1.0, 1.0),
          Grid::torus(10, 6, 1.0, 1.0)};
}

TEST(RingEquations, AreTheSumsOverTheirSides) {
  for (const Grid& grid : grids()) {
    const std::vector<Complex> x = some_values(grid), expected = product(grid, x);
    const RingEquations equations = equations_on(grid);
    RingEquations::Vector of_solver;
    equations.gather(x, of_solver);
    std::vector<Complex> made(x.size());
    equations.scatter(equations * of_solver, made);
    for (std::size_t c = 0; c < x.size(); ++c) {
      EXPECT_NEAR(std::abs(made[c] - expected[c]), 0.0, 1e-13) << c;
    }
  }
}

TEST(RingEquations, AreSolvedFromRowToRow) {
  for (const Grid& grid : grids()) {
    const std::vector<Complex> x = some_values(grid);
    const RingEquations equations = equations_on(grid);
    RingEquations::Vector right;
    equations.gather(product(grid, x), right);
    Eigen::BiCGSTAB<RingEquations, ZebraRows> solver;
    solver.setTolerance(1e-13);
    solver.compute(equations);
    std::vector<Complex> found(x.size());
    equations.scatter(solver.solve(right), found);
    EXPECT_EQ(solver.info(), Eigen::Success);
    for (std::size_t c = 0; c < x.size(); ++c) {
      EXPECT_NEAR(std::abs(found[c] - x[c]), 0.0, 1e-10) << c;
    }
  }
}

// Without couplings from row to row the preconditioner alone is the inverse.
TEST(RingEquations, OfRowsOnTheirOwnAreSolvedAtOnce) {
  const Grid grid = Grid::sphere(12, 7);
  RingEquations equations(grid);
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      equations.add_own(grid.cell(i, j), loss(i, j));
      for (const int side : {kEast, kWest}) {
        equations.add_exchange(i, j, side, coupling(grid, i, j, side));
      }
    }
  }
  RingEquations::Vector x;
  equations.gather(some_values(grid), x);
  ZebraRows rows;
  rows.compute(equations);
  const RingEquations::Vector found = rows.solve(equations * x);
  EXPECT_LE((found - x).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace geo
