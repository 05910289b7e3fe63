#pragma once

#include <algorithm>

#include "geo/kernels/raster_plate.hpp"

namespace geo {

template <class Place>
void RasterPlate::rearrange(int left, int top, int columns, int rows, Place&& place_of) {
  const std::size_t cells = static_cast<std::size_t>(columns) * rows;
  std::vector<Reach> reach(rows, {columns, 0});
  // One array after the other: the old one goes before the next new one comes.
  const auto move = [&](auto& values) {
    std::remove_reference_t<decltype(values)> moved(cells);
    for (int j = 0; j < rows_; ++j) {
      for (int i = reach_[j].begin; i < reach_[j].end; ++i) {
        const std::int32_t from = place(i, j);
        if (!(height_[from] > 0.0F)) continue;
        int column = 0, row = 0;
        place_of(i, j, column, row);
        column = world_.column(column - left);
        row = world_.row(row - top);
        moved[static_cast<std::size_t>(row) * columns + column] = values[from];
        reach[row].begin = std::min(reach[row].begin, column);
        reach[row].end = std::max(reach[row].end, column + 1);
      }
    }
    values = std::move(moved);
  };
  move(born_);
  move(folded_);
  move(height_);  // the last, since it tells where crust is
  reach_ = std::move(reach);
  left_ = left;
  top_ = top;
  columns_ = columns;
  rows_ = rows;
  filled_.assign(static_cast<std::size_t>(blocks()) * rows_, 0);
  for (int j = 0; j < rows_; ++j) {
    for (int i = reach_[j].begin; i < reach_[j].end; ++i) {
      if (height_[place(i, j)] > 0.0F) ++filled_[block_of(place(i, j))];
    }
  }
  continents_known_ = false;
}

}  // namespace geo
