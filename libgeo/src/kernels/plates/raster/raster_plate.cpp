#include "geo/kernels/plates/raster/raster_plate.hpp"

#include <algorithm>
#include <cmath>

#include "raster_rearrange.hpp"

namespace geo {

void RasterPlate::open(int world_column, int world_row, int columns, int rows) {
  left_ = world_.column(world_column - shift_x_);
  top_ = world_.row(world_row - shift_y_);
  columns_ = std::min(columns, world_.columns);
  rows_ = std::min(rows, world_.rows);
  crust_.assign(static_cast<std::size_t>(columns_) * rows_, {});
  blocks_.assign(static_cast<std::size_t>(blocks()) * rows_, {});
  reach_.assign(rows_, {columns_, 0});
  continents_known_ = false;
}

void RasterPlate::mark_blocks() {
  blocks_.assign(static_cast<std::size_t>(blocks()) * rows_, {});
  for (int j = 0; j < rows_; ++j) {
    for (int i = reach_[j].begin; i < reach_[j].end; ++i) {
      const float height = crust_[place(i, j)].height;
      Block& block = blocks_[static_cast<std::size_t>(j) * blocks() + i / kBlock];
      const auto bit = static_cast<std::uint16_t>(1U << (i % kBlock));
      if (height > 0.0F) block.crust |= bit;
      if (height >= 1.0F) block.land |= bit;
    }
  }
}

std::int32_t RasterPlate::claim(int world_column, int world_row) {
  // A share of the world, so that finer maps do not grow more often.
  const int margin = std::max(16, std::max(world_.columns, world_.rows) / 24);
  int column = local_column(world_column), row = world_.row(world_row - shift_y_ - top_);
  if (column >= columns_ || row >= rows_) {
    int left = left_, top = top_, columns = columns_, rows = rows_;
    if (column >= columns_) {
      const int beyond = column - columns_ + 1, before = world_.columns - column;
      columns = std::min(world_.columns, columns_ + margin + std::min(beyond, before));
      if (before < beyond) left = world_.column(left_ - (columns - columns_));
    }
    if (row >= rows_) {
      const int beyond = row - rows_ + 1, before = world_.rows - row;
      rows = std::min(world_.rows, rows_ + margin + std::min(beyond, before));
      if (before < beyond) top = world_.row(top_ - (rows - rows_));
    }
    resize(left, top, columns, rows);
    column = local_column(world_column);
    row = world_.row(world_row - shift_y_ - top_);
  }
  Reach& reach = reach_[row];
  reach.begin = std::min(reach.begin, column);
  reach.end = std::max(reach.end, column + 1);
  return place(column, row);
}

/// The same crust in another rectangle of the frame that holds all of it; a map as wide as the
/// world may be cut elsewhere.
void RasterPlate::resize(int left, int top, int columns, int rows) {
  rearrange(left, top, columns, rows, [&](int i, int j, int& column, int& row) {
    column = left_ + i;
    row = top_ + j;
  });
}

void RasterPlate::tighten() {
  int first_row = rows_, last_row = -1, first_column = columns_, last_column = -1;
  double sum = 0.0;
  for (int j = 0; j < rows_; ++j) {
    const auto cells = row(j);
    Reach& reach = reach_[j];
    int begin = reach.begin, end = reach.end;
    while (begin < end && !(cells[begin].height > 0.0F)) ++begin;
    while (end > begin && !(cells[end - 1].height > 0.0F)) --end;
    reach = begin < end ? Reach{begin, end} : Reach{columns_, 0};
    if (begin >= end) continue;
    for (int i = begin; i < end; ++i) sum += cells[i].height;
    first_row = std::min(first_row, j);
    last_row = j;
    first_column = std::min(first_column, begin);
    last_column = std::max(last_column, end - 1);
  }
  mass = sum;
  if (last_row < 0) {
    alive = false;
    crust_ = {};
    blocks_ = {};
    reach_ = {};
    columns_ = rows_ = 0;
    return;
  }
  const int columns = last_column - first_column + 1, rows = last_row - first_row + 1;
  // Moving the map costs as much as a few steps save.
  if (static_cast<double>(columns) * rows > 0.8 * columns_ * rows_) return;
  resize(world_.column(left_ + first_column), world_.row(top_ + first_row), columns, rows);
}

double RasterPlate::erode(double strength) {
  if (columns_ == 0) return 0.0;
  std::vector<float> change(crust_.size(), 0.0F);
  const bool round_x = columns_ == world_.columns, round_y = rows_ == world_.rows;
  const auto share = static_cast<float>(0.25 * strength);
  for (int j = 0; j < rows_; ++j) {
    const Reach reach = reach_[j];
    for (int i = reach.begin; i < reach.end; ++i) {
      const std::size_t at = static_cast<std::size_t>(j) * columns_ + i;
      const float height = crust_[at].height;
      if (!(height > 1.0F)) continue;
      std::size_t below[4];
      float flux[4], all = 0.0F;
      int count = 0;
      const auto look = [&](int column, int row, bool there) {
        if (!there) return;
        const std::size_t next = static_cast<std::size_t>((row + rows_) % rows_) * columns_ +
                                 (column + columns_) % columns_;
        const float other = crust_[next].height;
        if (!(other > 0.0F) || other >= height) return;
        below[count] = next;
        flux[count] = share * (height - other);
        all += flux[count++];
      };
      look(i, j - 1, round_y || j > 0);
      look(i - 1, j, round_x || i > 0);
      look(i + 1, j, round_x || i + 1 < columns_);
      look(i, j + 1, round_y || j + 1 < rows_);
      if (count == 0) continue;
      const float scale = std::min(1.0F, (height - 1.0F) / all);
      for (int k = 0; k < count; ++k) {
        change[below[k]] += scale * flux[k];
        change[at] -= scale * flux[k];
      }
    }
  }
  double sum = 0.0, rounded = 0.0;
  for (std::size_t k = 0; k < crust_.size(); ++k) {
    const float before = crust_[k].height, after = std::max(0.0F, before + change[k]);
    crust_[k].height = after;
    sum += after;
    rounded += static_cast<double>(after) - before;
  }
  mass = sum;
  mark_blocks();
  continents_known_ = false;
  return rounded;
}

}  // namespace geo
