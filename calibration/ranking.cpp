#include "calibration/ranking.hpp"

#include <algorithm>
#include <numeric>

#include "geo/core/error.hpp"

namespace geo::calibration {

Ranking::Ranking(const Grid& grid, std::span<const double> field,
                 std::span<const std::uint8_t> mask) {
  order_.reserve(field.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (mask.empty() || mask[cell] != 0) order_.push_back(cell);
  }
  if (order_.empty()) throw InputError("calibration: no cell takes part in a statistic");
  std::sort(order_.begin(), order_.end(),
            [&](Index a, Index b) { return field[a] != field[b] ? field[a] < field[b] : a < b; });
  value_.reserve(order_.size());
  below_.reserve(order_.size() + 1);
  double area = 0.0;
  for (const Index cell : order_) {
    value_.push_back(field[cell]);
    below_.push_back(area);
    area += grid.area_m2(grid.row(cell));
  }
  below_.push_back(area);
  for (double& share : below_) share /= area;
}

double Ranking::quantile(double share) const {
  const auto middle = [&](std::size_t k) { return 0.5 * (below_[k] + below_[k + 1]); };
  const auto at = std::upper_bound(below_.begin(), below_.end(), share) - below_.begin();
  std::size_t k = std::clamp<std::ptrdiff_t>(at - 1, 0, std::ptrdiff_t(value_.size()) - 1);
  if (share < middle(k)) {
    if (k == 0) return value_.front();
    --k;
  }
  if (k + 1 >= value_.size()) return value_.back();
  const double t = (share - middle(k)) / (middle(k + 1) - middle(k));
  return value_[k] + t * (value_[k + 1] - value_[k]);
}

std::vector<double> Ranking::bin_means(int count) const {
  std::vector<double> means(count, 0.0);
  int bin = 0;
  for (std::size_t k = 0; k < value_.size(); ++k) {
    double from = below_[k];
    while (bin < count) {
      const double edge = bin + 1 == count ? 2.0 : (bin + 1.0) / count;
      means[bin] += value_[k] * (std::min(below_[k + 1], edge) - from);
      if (below_[k + 1] < edge) break;
      from = edge;
      ++bin;
    }
  }
  for (double& mean : means) mean *= count;
  return means;
}

template <class UpTo>
Ranking::Window Ranking::weighted(double share, double half_width, UpTo&& up_to) const {
  const double from = std::max(0.0, share - half_width), to = std::min(1.0, share + half_width);
  Window window;
  const auto first = std::upper_bound(below_.begin(), below_.end(), from) - below_.begin() - 1;
  window.first = std::clamp<std::ptrdiff_t>(first, 0, std::ptrdiff_t(value_.size()) - 1);
  double sum = 0.0;
  for (std::size_t k = window.first; k < value_.size() && (below_[k] < to || k == window.first);
       ++k) {
    const double lower = std::max(from, below_[k]), upper = std::min(to, below_[k + 1]);
    window.weight.push_back(up_to(upper) - up_to(lower));
    sum += window.weight.back();
  }
  for (double& weight : window.weight) weight /= sum;
  return window;
}

Ranking::Window Ranking::window(double share, double half_width) const {
  return weighted(share, half_width, [](double at) { return at; });
}

Ranking::Window Ranking::quantile_window(double share, double half_width) const {
  return weighted(share, half_width, [=](double at) {
    const double u = (at - share) / half_width, square = u * u;
    return 15.0 / 32.0 * u * (3.0 + square * (-10.0 / 3.0 + square * 7.0 / 5.0));
  });
}

double Ranking::gap_below(double value, double width, int most) const {
  const auto above = std::lower_bound(value_.begin(), value_.end(), value) - value_.begin();
  double widest = 0.0, middle = value;
  for (auto k = above; k > 0 && above - k < most && widest < width; --k) {
    const double top = k == above ? value : value_[k], gap = top - value_[k - 1];
    if (gap <= widest) continue;
    widest = gap;
    middle = top - 0.5 * gap;
  }
  return middle;
}

double Ranking::density(double share, double half_width) const {
  const double from = std::max(0.0, share - half_width), to = std::min(1.0, share + half_width);
  return (to - from) / std::max(quantile(to) - quantile(from), 1e-6);
}

}  // namespace geo::calibration
