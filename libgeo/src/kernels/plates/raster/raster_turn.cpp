#include <cmath>
#include <limits>

#include "geo/kernels/plates/raster/raster_plate.hpp"
#include "raster_rearrange.hpp"

namespace geo {

RasterTurn::RasterTurn(const RasterWorld& world, double angle_rad) : world_(world) {
  along_x_.resize(world.rows);
  along_y_.resize(world.columns);
  const double shear = -std::tan(0.5 * angle_rad), lift = std::sin(angle_rad);
  for (int k = 0; k < world.rows; ++k) {
    along_x_[k] = static_cast<int>(std::lround(shear * (k - world.rows / 2)));
  }
  for (int k = 0; k < world.columns; ++k) {
    along_y_[k] = static_cast<int>(std::lround(lift * (k - world.columns / 2)));
  }
}

int RasterTurn::wrapped_x(int x) const {
  return world_.column(x + world_.columns / 2) - world_.columns / 2;
}
int RasterTurn::wrapped_y(int y) const { return world_.row(y + world_.rows / 2) - world_.rows / 2; }

void RasterTurn::turn(int& x, int& y) const {
  x = wrapped_x(x + along_x_[y + world_.rows / 2]);
  y = wrapped_y(y + along_y_[x + world_.columns / 2]);
  x = wrapped_x(x + along_x_[y + world_.rows / 2]);
}

void RasterTurn::turn_back(int& x, int& y) const {
  x = wrapped_x(x - along_x_[y + world_.rows / 2]);
  y = wrapped_y(y - along_y_[x + world_.columns / 2]);
  x = wrapped_x(x - along_x_[y + world_.rows / 2]);
}

void RasterPlate::settle() {
  x -= world_.columns * std::floor(x / world_.columns);
  y -= world_.rows * std::floor(y / world_.rows);
  shift_x_ = world_.column(static_cast<int>(x));
  shift_y_ = world_.row(static_cast<int>(y));
  if (std::abs(angle - map_angle_) * 0.5 * std::hypot(columns_, rows_) >= 1.0) turn_map();
}

/// Each cell goes back to where it was as the map was made and from there to its place at the new
/// angle, so that turning in many small parts leaves no more traces than turning once.
void RasterPlate::turn_map() {
  constexpr double kMost_rad = 1.0;  // shears grow with the angle
  if (std::abs(angle - base_angle_) > kMost_rad) base_angle_ = map_angle_;
  const RasterTurn back(world_, map_angle_ - base_angle_), on(world_, angle - base_angle_);
  const int cx = static_cast<int>(std::lround(centre_x)),
            cy = static_cast<int>(std::lround(centre_y));
  const auto place_of = [&](int i, int j, int& column, int& row) {
    int dx = world_.column(left_ + i - cx + world_.columns / 2) - world_.columns / 2;
    int dy = world_.row(top_ + j - cy + world_.rows / 2) - world_.rows / 2;
    back.turn_back(dx, dy);
    on.turn(dx, dy);
    column = cx + dx;
    row = cy + dy;
  };
  int least_x = std::numeric_limits<int>::max(), least_y = least_x;
  int most_x = std::numeric_limits<int>::min(), most_y = most_x;
  for (int j = 0; j < rows_; ++j) {
    for (int i = reach_[j].begin; i < reach_[j].end; ++i) {
      if (!(crust_[place(i, j)].height > 0.0F)) continue;
      int column = 0, row = 0;
      place_of(i, j, column, row);
      least_x = std::min(least_x, column);
      most_x = std::max(most_x, column);
      least_y = std::min(least_y, row);
      most_y = std::max(most_y, row);
    }
  }
  map_angle_ = angle;
  if (most_x < least_x) return;
  const int left = world_.column(least_x), top = world_.row(least_y);
  const int columns = std::min(world_.columns, most_x - least_x + 1);
  const int rows = std::min(world_.rows, most_y - least_y + 1);
  rearrange(left, top, columns, rows, place_of);
}

}  // namespace geo
