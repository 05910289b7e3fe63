#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// Which of many caps on the sphere may touch each band of a grid's rows, in their order.
class RowBands {
 public:
  /// `latitude(k)` of the centre of cap k, and `reach` of all of them, radians.
  template <class Latitude>
  RowBands(const Grid& grid, std::size_t caps, double reach, Latitude&& latitude)
      : rows_(grid.ny()), lists_((grid.ny() + kRows - 1) / kRows) {
    const auto row = [&](double y) {
      return std::clamp(static_cast<int>((y / std::numbers::pi + 0.5) * grid.ny()), 0,
                        grid.ny() - 1);
    };
    for (std::size_t k = 0; k < caps; ++k) {
      const double middle = latitude(k);
      for (int b = row(middle - reach) / kRows; b <= row(middle + reach) / kRows; ++b) {
        lists_[b].push_back(static_cast<std::int32_t>(k));
      }
    }
  }
  [[nodiscard]] std::size_t size() const { return lists_.size(); }
  [[nodiscard]] std::span<const std::int32_t> operator[](std::size_t band) const {
    return lists_[band];
  }
  [[nodiscard]] int begin(std::size_t band) const { return static_cast<int>(band) * kRows; }
  [[nodiscard]] int end(std::size_t band) const { return std::min(rows_, begin(band) + kRows); }

 private:
  static constexpr int kRows = 8;
  int rows_;
  std::vector<std::vector<std::int32_t>> lists_;
};

/// A row of a sphere's grid, to find the columns that lie near a place.
struct Parallel {
  Parallel(const Grid& grid, int row)
      : columns(grid.nx()),
        sine(std::sin(((row + 0.5) / grid.ny() - 0.5) * std::numbers::pi)),
        cosine(std::cos(((row + 0.5) / grid.ny() - 0.5) * std::numbers::pi)) {}
  int columns;
  double sine, cosine;

  struct Place {
    double longitude, ring, z;  ///< ring: the distance from the axis
  };

  /// Calls with the columns between two longitudes, radians from a third.
  template <class Action>
  void between(double longitude, double west, double east, Action&& action) const {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    const double per_radian = columns / kTurn;
    const double middle = (longitude / kTurn + 0.5) * columns - 0.5;
    const int first = static_cast<int>(std::floor(middle + west * per_radian));
    const int last = static_cast<int>(std::ceil(middle + east * per_radian)) + 1;
    if (last - first >= columns) return action(0, columns);
    if (first < 0) action(first + columns, columns);
    action(std::max(first, 0), std::min(last, columns));
    if (last > columns) action(0, last - columns);
  }
  /// Calls with the columns within an angle, radians, of a place.
  template <class Action>
  void within(const Place& place, double reach, Action&& action) const {
    const double down = cosine * place.ring;
    const double least = std::cos(reach) - sine * place.z;
    if (least >= down) return;
    const double half = least <= -down ? std::numbers::pi : std::acos(least / down);
    between(place.longitude, -half, half, action);
  }
};

}  // namespace geo
