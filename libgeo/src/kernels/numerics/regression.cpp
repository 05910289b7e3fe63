#include "geo/kernels/numerics/regression.hpp"

#include <cmath>
#include <limits>

#include "geo/core/error.hpp"

namespace geo {
namespace {

/// Weighted sums of a straight line, about the first point so that large offsets cancel nothing.
class Line {
 public:
  void add(double x, double y, double weight) {
    if (weight_ == 0.0) {
      x0_ = x;
      y0_ = y;
    }
    const double dx = x - x0_, dy = y - y0_;
    weight_ += weight;
    x_ += weight * dx;
    y_ += weight * dy;
    xx_ += weight * dx * dx;
    xy_ += weight * dx * dy;
  }
  [[nodiscard]] double slope() const {
    const double spread = xx_ * weight_ - x_ * x_;
    if (!(spread > 1e-14 * xx_ * weight_)) return std::numeric_limits<double>::quiet_NaN();
    return (xy_ * weight_ - x_ * y_) / spread;
  }

 private:
  double x0_ = 0.0, y0_ = 0.0, weight_ = 0.0, x_ = 0.0, y_ = 0.0, xx_ = 0.0, xy_ = 0.0;
};

}  // namespace

double regression_slope(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size()) throw InputError("regression: as many x as y are needed");
  Line line;
  for (std::size_t i = 0; i < x.size(); ++i) line.add(x[i], y[i], 1.0);
  return line.slope();
}

double area_regression_slope(const Grid& grid, std::span<const float> x, std::span<const float> y,
                             std::span<const std::uint8_t> mask) {
  const auto cells = static_cast<std::size_t>(grid.size());
  if (x.size() != cells || y.size() != cells || (!mask.empty() && mask.size() != cells)) {
    throw InputError("regression: fields do not fit the grid");
  }
  Line line;
  for (std::size_t c = 0; c < cells; ++c) {
    if ((!mask.empty() && mask[c] == 0) || std::isnan(x[c]) || std::isnan(y[c])) continue;
    line.add(x[c], y[c], grid.area_m2(grid.row(static_cast<Index>(c))));
  }
  return line.slope();
}

}  // namespace geo
