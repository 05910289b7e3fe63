#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "geo/core/field.hpp"
#include "geo/core/grid.hpp"

namespace geo {

/// How the year of a planet's climate goes, on a coarse grid of its own: what its months add to the
/// annual means of finer grids. One value per cell of `grid`, for each month from January.
struct Climatology {
  static constexpr int kMonths = 12;
  using Monthly = std::array<std::vector<float>, kMonths>;
  std::shared_ptr<const Grid> grid;
  Monthly temperature_departure_k;  ///< from the annual mean
  Monthly precipitation_share;      ///< of the year's; the months' sum is 1
  Monthly wind_east, wind_north;    ///< m s-1
};

/// Makes one of `field::monthly()` for one month on the grid of the state, from the annual values
/// that it belongs to (of temperature or precipitation; of winds none), as long as that grid lives.
using MonthlyFields = std::function<void(const FieldSpec& field, int month,
                                         std::span<const float> annual, std::span<float> out)>;

}  // namespace geo
