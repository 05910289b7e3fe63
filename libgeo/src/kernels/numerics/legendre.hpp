#pragma once

#include <cmath>
#include <vector>

namespace geo {

/// The normalised associated Legendre functions of one order, degree by degree from the order
/// upwards, at places given by the sine and cosine of their latitude (recursion in degree from the
/// sectoral one: Holmes & Featherstone 2002). Their squares integrate to 2 over the sine of
/// latitude. `sine` must live as long as this.
class LegendreOrder {
 public:
  LegendreOrder(int order, const std::vector<double>& sine, const std::vector<double>& cosine)
      : order_(order), degree_(order), sine_(sine), now_(sine.size()), before_(sine.size(), 0.0) {
    for (std::size_t j = 0; j < sine.size(); ++j) {
      double p = 1.0;
      for (int m = 1; m <= order; ++m) p *= std::sqrt((2.0 * m + 1.0) / (2.0 * m)) * cosine[j];
      now_[j] = p;
    }
  }
  [[nodiscard]] const std::vector<double>& values() const { return now_; }
  void next() {
    ++degree_;
    const double l = degree_, m = order_;
    const double a = std::sqrt((4.0 * l * l - 1.0) / (l * l - m * m));
    const double b =
        std::sqrt(((l - 1.0) * (l - 1.0) - m * m) / (4.0 * (l - 1.0) * (l - 1.0) - 1.0));
    for (std::size_t j = 0; j < now_.size(); ++j) {
      const double p = a * (sine_[j] * now_[j] - b * before_[j]);
      before_[j] = now_[j];
      now_[j] = p;
    }
  }

 private:
  int order_, degree_;
  const std::vector<double>& sine_;
  std::vector<double> now_, before_;
};

}  // namespace geo
