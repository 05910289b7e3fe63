#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace geo {

/// Tridiagonal systems (1 + lower_i + upper_i) x_i − lower_i x_{i−1} − upper_i x_{i+1} = d_i,
/// kLanes of them side by side so that each step of the recursion is a vector operation.
/// Non-negative couplings make it an M-matrix: no pivoting. A periodic system joins its ends by
/// lower_0 and upper_{n−1}, and is solved by the Sherman–Morrison formula. Values lie as
/// [n][kLanes].
class TridiagonalBlock {
 public:
  static constexpr int kLanes = 8;

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
  void factorise();

  /// x holds d before and the solution afterwards.
  void solve(double* x) const { solve(x, x); }
  /// The same from `d`, which stays as it is, into `x`.
  void solve(const double* d, double* x) const;

 private:
  using Lanes = std::array<double, kLanes>;

  int n_;
  bool periodic_;
  std::vector<double> lower_, upper_, inverse_, ring_;
  Lanes corner_{}, ring_weight_{};
};

}  // namespace geo
