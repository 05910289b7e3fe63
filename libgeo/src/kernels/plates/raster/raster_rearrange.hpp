#pragma once

#include <algorithm>

#include "geo/kernels/plates/raster/raster_plate.hpp"

namespace geo {

template <class Place>
void RasterPlate::rearrange(int left, int top, int columns, int rows, Place&& place_of) {
  std::vector<RasterCrust> moved(static_cast<std::size_t>(columns) * rows);
  std::vector<Reach> reach(rows, {columns, 0});
  for (int j = 0; j < rows_; ++j) {
    for (int i = reach_[j].begin; i < reach_[j].end; ++i) {
      const RasterCrust& crust = crust_[place(i, j)];
      if (!(crust.height > 0.0F)) continue;
      int column = 0, row = 0;
      place_of(i, j, column, row);
      column = world_.column(column - left);
      row = world_.row(row - top);
      moved[static_cast<std::size_t>(row) * columns + column] = crust;
      reach[row].begin = std::min(reach[row].begin, column);
      reach[row].end = std::max(reach[row].end, column + 1);
    }
  }
  crust_ = std::move(moved);
  reach_ = std::move(reach);
  left_ = left;
  top_ = top;
  columns_ = columns;
  rows_ = rows;
  mark_blocks();
  continents_known_ = false;
}

}  // namespace geo
