#pragma once

#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/core/numeric.hpp"

namespace geo::calibration {

/// Cells in the order of a field, with the share of the area below each: what quantiles and their
/// derivatives are taken from.
class Ranking {
 public:
  /// `mask`: cells that take part, or empty for all.
  Ranking(const Grid& grid, std::span<const double> field, std::span<const std::uint8_t> mask = {});

  /// Value at a share of the area, linear between the middles of cells in order.
  [[nodiscard]] double quantile(double share) const;
  /// Means of `count` bins of equal area.
  [[nodiscard]] std::vector<double> bin_means(int count) const;

  /// A mean over the cells whose rank lies within a window of the area: weights sum to 1.
  struct Window {
    std::size_t first = 0;       ///< in the order
    std::vector<double> weight;  ///< of the cells from `first` on
  };
  [[nodiscard]] Window window(double share, double half_width) const;
  /// Weights of a kernel of fourth order in their place, K(u) = 15/32 (1 - u^2)(3 - 7 u^2), u the
  /// distance in share over the half width: the mean of the field itself is the quantile to the
  /// fourth power of the half width, and single cells hardly move it (Sheather & Marron 1990).
  /// Weights may be negative.
  [[nodiscard]] Window quantile_window(double share, double half_width) const;

  /// The mean of another field over a window: with the field's own derivatives, those of the
  /// quantile, dq/dtheta = E[dh/dtheta | h = q] (Hong 2009).
  template <class V>
  [[nodiscard]] Arithmetic<V> mean(const Window& window, std::span<const V> field) const {
    using Number = Arithmetic<V>;
    Number sum(0.0);
    for (std::size_t k = 0; k < window.weight.size(); ++k) {
      sum += window.weight[k] * Number(field[order_[window.first + k]]);
    }
    return sum;
  }
  /// The middle of the first gap of at least `width` between values in order, from `value` down;
  /// of the widest among the next `most` where none is as wide.
  [[nodiscard]] double gap_below(double value, double width, int most) const;
  /// Area per elevation about a share, as a share of the whole per metre.
  [[nodiscard]] double density(double share, double half_width) const;

 private:
  /// Weights by the share of `up_to(upper) - up_to(lower)` of each cell's part of the window.
  template <class UpTo>
  [[nodiscard]] Window weighted(double share, double half_width, UpTo&& up_to) const;

  std::vector<Index> order_;
  std::vector<double> value_;  ///< in order
  std::vector<double>
      below_;  ///< share of the area below each cell in order; one more, 1, at the end
};

}  // namespace geo::calibration
