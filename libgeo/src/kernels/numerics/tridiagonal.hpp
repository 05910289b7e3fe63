#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace geo {

/// Which couplings of a block differ from each other. The fewer, the less memory is passed over.
enum class Couplings : std::uint8_t {
  all,      // any
  lanes,    // from lane to lane only: uniform, periodic rows
  unknowns  // from unknown to unknown only: columns of one kind, not periodic
};

/// Tridiagonal systems (1 + lower_i + upper_i) x_i − lower_i x_{i−1} − upper_i x_{i+1} = d_i,
/// kLanes of them side by side so that each step of the recursion is a vector operation.
/// Non-negative couplings make it an M-matrix: no pivoting. A periodic system joins its ends by
/// lower_0 and upper_{n−1}, and is solved by the Sherman–Morrison formula. Values lie as
/// [n][kLanes]. What differs among the couplings changes the cost alone, no bit of the solution.
class TridiagonalBlock {
 public:
  static constexpr int kLanes = 8;

  /// Couplings::lanes are for periodic systems, Couplings::unknowns for others.
  TridiagonalBlock(int n, bool periodic, Couplings differ = Couplings::all);

  /// Couplings of unknown i, to be set before factorise(): one per lane, or a single one with
  /// Couplings::unknowns. Ends of a system that is not periodic must be 0.
  double* lower(int i) { return &lower_[i * stride_]; }
  double* upper(int i) { return &upper_[i * stride_]; }

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
  Couplings differ_;
  std::size_t stride_;  // of couplings, from unknown to unknown
  std::vector<double> lower_, upper_, inverse_, ring_;
  Lanes corner_{}, ring_weight_{};
};

}  // namespace geo
