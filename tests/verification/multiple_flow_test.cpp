#include "geo/kernels/water/multiple_flow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "geo/kernels/water/flow_graph.hpp"

namespace geo {
namespace {

// Surfaces whose specific catchment area is known, on 121 x 121 cells of 1 m.
constexpr int kCells = 121;
constexpr double kHalf_m = 0.5 * kCells;
// Cells this near an edge feel that the outermost row of cells passes nothing on.
constexpr int kBorder = 20;

struct Surface {
  std::string name;
  std::function<double(double, double)> height, exact;
  std::function<bool(double, double)> judged;
};

Surface cone() {
  return {"cone", [](double x, double y) { return -std::hypot(x, y); },
          [](double x, double y) { return 0.5 * std::hypot(x, y); },
          [](double x, double y) { return std::hypot(x, y) > 1.5; }};
}

Surface plane(double angle_deg) {
  const double c = std::cos(angle_deg * std::numbers::pi / 180.0);
  const double s = std::sin(angle_deg * std::numbers::pi / 180.0);
  return {"plane", [=](double x, double y) { return -(c * x + s * y); },
          [=](double x, double y) { return std::min((x + kHalf_m) / c, (y + kHalf_m) / s); },
          [](double, double) { return true; }};
}

Surface saddle() {
  return {"saddle", [](double x, double y) { return x * x - y * y; },
          [](double x, double y) { return std::hypot(x, y) * std::log(kHalf_m / std::abs(x)); },
          // Near the divide x = 0 the exact value grows without bound.
          [](double x, double y) { return std::hypot(x, y) >= 20.0 && std::abs(x) >= 10.0; }};
}

struct Errors {
  double naive, corrected;  // relative, root mean square
};

Errors measure(const Surface& surface, const FlowPartition& partition) {
  const Grid grid = Grid::plane(kCells, kCells, 1.0, 1.0);
  std::vector<float> z(grid.size()), area(grid.size());
  std::vector<std::uint8_t> outlets(grid.size());
  for (Index c = 0; c < grid.size(); ++c) {
    z[c] = static_cast<float>(surface.height(grid.x_m(grid.column(c)), grid.y_m(grid.row(c))));
    outlets[c] = grid.is_open_edge(grid.column(c), grid.row(c));
  }
  std::vector<Index> receiver(grid.size());
  steepest_receivers(grid, z, outlets, receiver);
  std::vector<double> drainage(grid.size(), 1.0);
  accumulate_flow(grid, z, receiver, partition, drainage);
  specific_catchment_area(grid, z, receiver, partition, drainage, area);
  double naive = 0.0, corrected = 0.0;
  int count = 0;
  for (int j = kBorder; j < kCells - kBorder; ++j) {
    for (int i = kBorder; i < kCells - kBorder; ++i) {
      const double x = grid.x_m(i), y = grid.y_m(j);
      if (!surface.judged(x, y)) continue;
      const double exact = surface.exact(x, y);
      naive += std::pow(drainage[grid.cell(i, j)] / exact - 1.0, 2);
      corrected += std::pow(area[grid.cell(i, j)] / exact - 1.0, 2);
      ++count;
    }
  }
  return {std::sqrt(naive / count), std::sqrt(corrected / count)};
}

const FlowPartition kD8{FlowMethod::steepest}, kInfinity{FlowMethod::d_infinity},
    kLinear{FlowMethod::multiple, 1.0}, kQuinn{FlowMethod::multiple, 1.0, true},
    kFreeman{FlowMethod::multiple, 1.1}, kSharp{FlowMethod::multiple, 4.0};

// The error that each method is known to make, to a tenth of it and a hundredth.
void expect_errors(const Surface& surface, const FlowPartition& partition, double naive,
                   double corrected) {
  const Errors errors = measure(surface, partition);
  EXPECT_NEAR(errors.naive, naive, 0.1 * naive + 0.01) << surface.name;
  EXPECT_NEAR(errors.corrected, corrected, 0.1 * corrected + 0.01) << surface.name;
}

TEST(SpecificCatchmentArea, ErrorsOnTheCone) {
  expect_errors(cone(), kD8, 0.51, 0.59);
  expect_errors(cone(), kInfinity, 0.12, 0.15);
  expect_errors(cone(), kLinear, 0.093, 0.037);
  expect_errors(cone(), kQuinn, 0.13, 0.036);
  expect_errors(cone(), kFreeman, 0.081, 0.042);
  expect_errors(cone(), kSharp, 0.056, 0.10);
}

TEST(SpecificCatchmentArea, ErrorsOnThePlaneAt30Degrees) {
  expect_errors(plane(30.0), kD8, 0.31, 0.21);
  expect_errors(plane(30.0), kInfinity, 0.18, 0.058);
  expect_errors(plane(30.0), kLinear, 0.056, 0.024);
  expect_errors(plane(30.0), kQuinn, 0.097, 0.024);
  expect_errors(plane(30.0), kFreeman, 0.046, 0.025);
  expect_errors(plane(30.0), kSharp, 0.135, 0.047);
}

TEST(SpecificCatchmentArea, ErrorsOnThePlaneAt45Degrees) {
  expect_errors(plane(45.0), kD8, 0.30, 0.013);
  expect_errors(plane(45.0), kInfinity, 0.30, 0.013);
  expect_errors(plane(45.0), kLinear, 0.020, 0.020);
  expect_errors(plane(45.0), kQuinn, 0.043, 0.021);
  expect_errors(plane(45.0), kFreeman, 0.025, 0.020);
  expect_errors(plane(45.0), kSharp, 0.164, 0.016);
}

TEST(SpecificCatchmentArea, ErrorsOnTheSaddle) {
  expect_errors(saddle(), kD8, 0.54, 0.53);
  expect_errors(saddle(), kLinear, 0.060, 0.010);
  expect_errors(saddle(), kQuinn, 0.098, 0.010);
  expect_errors(saddle(), kFreeman, 0.046, 0.011);
  // What these two leave after the correction depends much on how near the divide one looks.
  const Errors infinity = measure(saddle(), kInfinity), sharp = measure(saddle(), kSharp);
  EXPECT_NEAR(infinity.naive, 0.19, 0.02);
  EXPECT_LT(infinity.corrected, 0.3 * infinity.naive);
  EXPECT_NEAR(sharp.naive, 0.12, 0.02);
  EXPECT_LT(sharp.corrected, 0.4 * sharp.naive);
}

}  // namespace
}  // namespace geo
