// Rivers of a map across the date line and over a pole.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "geo/io/maps/maps.hpp"
#include "io/maps/picture.hpp"
#include "io/maps/sample_planet.hpp"
#include "io/temporary_folder.hpp"

namespace geo::io {
namespace {

// A river along the equator that crosses the date line from 170°E to 170°W.
State date_line_river(bool flows) {
  State state(small_sphere());
  const Grid& grid = state.grid();
  std::vector<Index> receiver(grid.size());
  std::vector<float> discharge(grid.size(), 0.0F);
  for (Index i = 0; i < grid.size(); ++i) receiver[i] = i;
  for (int column = 350; column < 370 && flows; ++column) {
    const Index cell = grid.cell(column % 360, 90);
    receiver[cell] = grid.cell((column + 1) % 360, 90);
    discharge[cell] = 5000.0F;
  }
  state.set(field::elevation, std::vector<float>(grid.size(), 300.0F));
  state.set(field::flow_receiver, receiver);
  state.set(field::discharge, discharge);
  return state;
}

TEST(Maps, ARiverAcrossTheDateLineIsDrawnAtBothEdgesAndNotAcrossTheMap) {
  const TemporaryFolder folder;
  draw_maps(date_line_river(true), folder / "with", kWidth);
  draw_maps(date_line_river(false), folder / "without", kWidth);
  const MapLayout layout = map_layout(*small_sphere(), kWidth);
  const Picture with(folder / "with/rivers.png", layout);
  const Picture without(folder / "without/rivers.png", layout);
  int west = 0, middle = 0, east = 0;
  for (int y = 0; y < layout.map_height; ++y) {
    for (int x = 2; x < layout.map_width - 2; ++x) {
      if (with.map(x, y) == without.map(x, y)) continue;
      ++(x < 30 ? west : x > layout.map_width - 30 ? east : middle);
    }
  }
  EXPECT_GT(west, 15);
  EXPECT_GT(east, 15);
  EXPECT_EQ(middle, 0);
}

TEST(Maps, ARiverOverThePoleIsNotDrawnHalfRoundTheMap) {
  const TemporaryFolder folder;
  State state = date_line_river(false);
  const Grid& grid = state.grid();
  auto receiver = state.update(field::flow_receiver);
  auto discharge = state.update(field::discharge);
  for (int row = 150; row < 180; ++row) {
    const Index up = grid.cell(40, row), down = grid.cell(220, row);
    receiver[up] = grid.neighbour(up, kNorth);
    receiver[down] = grid.cell(220, row - 1);
    discharge[up] = discharge[down] = 5000.0F;
  }
  draw_maps(state, folder / "with", kWidth);
  draw_maps(date_line_river(false), folder / "without", kWidth);
  const MapLayout layout = map_layout(grid, kWidth);
  const Picture with(folder / "with/rivers.png", layout);
  const Picture without(folder / "without/rivers.png", layout);
  int rivers = 0;
  for (int y = 0; y < layout.map_height; ++y) {
    for (int x = 0; x < layout.map_width; ++x) {
      if (with.map(x, y) == without.map(x, y)) continue;
      const bool at_one = std::abs(x - 81) < 6, at_other = std::abs(x - 441) < 6;
      EXPECT_TRUE(at_one || at_other) << x << " " << y;
      ++rivers;
    }
  }
  EXPECT_GT(rivers, 100);
}

}  // namespace
}  // namespace geo::io
