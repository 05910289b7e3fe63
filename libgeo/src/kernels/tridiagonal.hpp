#pragma once

#include <cstddef>
#include <vector>

namespace geo {

/// Tridiagonal systems (1 + lower_i + upper_i) x_i − lower_i x_{i−1} − upper_i x_{i+1} = d_i,
/// kLanes of them side by side so that each step of the recursion is a vector operation.
/// Non-negative couplings make it an M-matrix: no pivoting. A periodic system joins its ends by
/// lower_0 and upper_{n−1}, and is solved by the Sherman–Morrison formula. Values lie as
/// [n][kLanes].
template <int kLanes>
class TridiagonalBlock {
 public:
  TridiagonalBlock(int n, bool periodic)
      : n_(n),
        periodic_(periodic),
        lower_(std::size_t(n) * kLanes),
        upper_(std::size_t(n) * kLanes),
        inverse_(std::size_t(n) * kLanes),
        ring_(periodic ? std::size_t(n) * kLanes : 0) {}

  /// Couplings, to be set before factorise(). Ends of a system that is not periodic must be 0.
  double* lower(int i) { return &lower_[std::size_t(i) * kLanes]; }
  double* upper(int i) { return &upper_[std::size_t(i) * kLanes]; }

  /// Destroys the couplings.
  void factorise() {
    double first[kLanes], corner_lower[kLanes], corner_upper[kLanes];
    for (int k = 0; k < kLanes; ++k) {
      corner_lower[k] = lower(0)[k];
      corner_upper[k] = upper(n_ - 1)[k];
      first[k] = 1.0 + corner_lower[k] + upper(0)[k];
    }
    for (int i = 0; i < n_; ++i) {
      const double* low = lower(i);
      double* up = upper(i);
      double* inverse = &inverse_[std::size_t(i) * kLanes];
      for (int k = 0; k < kLanes; ++k) {
        double diagonal = 1.0 + low[k] + up[k];
        if (i > 0) diagonal -= low[k] * up[k - kLanes];
        if (periodic_ && i == 0) diagonal += first[k];
        if (periodic_ && i == n_ - 1) diagonal += corner_upper[k] * corner_lower[k] / first[k];
        inverse[k] = 1.0 / diagonal;
        up[k] *= inverse[k];
      }
    }
    if (periodic_) factorise_ring(first, corner_lower, corner_upper);
  }

  /// x holds d before and the solution afterwards.
  void solve(double* x) const { solve(x, x); }
  /// The same from `d`, which stays as it is, into `x`.
  void solve(const double* d, double* x) const {
    solve_open(d, x);
    if (!periodic_) return;
    double share[kLanes];
    const double* last = x + std::size_t(n_ - 1) * kLanes;
    for (int k = 0; k < kLanes; ++k) {
      share[k] = (x[k] + corner_[k] * last[k]) * ring_weight_[k];
    }
    for (int i = 0; i < n_; ++i) {
      const double* ring = &ring_[std::size_t(i) * kLanes];
      double* here = x + std::size_t(i) * kLanes;
      for (int k = 0; k < kLanes; ++k) here[k] -= ring[k] * share[k];
    }
  }

 private:
  void factorise_ring(const double* first, const double* corner_lower, const double* corner_upper) {
    double* last = &ring_[std::size_t(n_ - 1) * kLanes];
    for (double& value : ring_) value = 0.0;
    for (int k = 0; k < kLanes; ++k) {
      ring_[k] = -first[k];
      last[k] = -corner_upper[k];
      corner_[k] = corner_lower[k] / first[k];
    }
    solve_open(ring_.data(), ring_.data());
    for (int k = 0; k < kLanes; ++k) {
      ring_weight_[k] = 1.0 / (1.0 + ring_[k] + corner_[k] * last[k]);
    }
  }

  void solve_open(const double* d, double* x) const {
    for (int k = 0; k < kLanes; ++k) x[k] = d[k] * inverse_[k];
    for (int i = 1; i < n_; ++i) {
      const std::size_t at = std::size_t(i) * kLanes;
      const double* low = &lower_[at];
      const double* inverse = &inverse_[at];
      const double* right = d + at;
      double* here = x + at;
      for (int k = 0; k < kLanes; ++k) {
        here[k] = (right[k] + low[k] * here[k - kLanes]) * inverse[k];
      }
    }
    for (int i = n_ - 2; i >= 0; --i) {
      const std::size_t at = std::size_t(i) * kLanes;
      const double* up = &upper_[at];
      double* here = x + at;
      for (int k = 0; k < kLanes; ++k) here[k] += up[k] * here[k + kLanes];
    }
  }

  int n_;
  bool periodic_;
  std::vector<double> lower_, upper_, inverse_, ring_;
  double corner_[kLanes] = {}, ring_weight_[kLanes] = {};
};

}  // namespace geo
