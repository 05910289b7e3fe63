#pragma once

#include <Eigen/SparseCore>
#include <complex>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {
class RingEquations;
}

namespace Eigen::internal {
template <>
struct traits<geo::RingEquations> : traits<SparseMatrix<double>> {};
}  // namespace Eigen::internal

namespace geo {

/// Five-point equations of a field on rows that close on themselves,
///   own_c x_c + west_c x_west + east_c x_east + south_c x_south + north_c x_north = right_c,
/// with complex `own` and real couplings, as a matrix for Eigen's iterative solvers. These see real
/// vectors of twice the length, a real part before its imaginary one: their sums and products are
/// then those of real numbers, a third of the time of complex ones. A vector has column after
/// column, in each the even rows before the odd ones: what every other row has in one column lies
/// together, so that rows are worked at side by side. Over a pole nothing passes.
class RingEquations : public Eigen::EigenBase<RingEquations> {
 public:
  using Scalar = double;
  using Complex = std::complex<double>;
  using RealScalar = double;
  using StorageIndex = int;
  enum {
    ColsAtCompileTime = Eigen::Dynamic,
    MaxColsAtCompileTime = Eigen::Dynamic,
    IsRowMajor = 0
  };
  using Vector = Eigen::VectorXd;

  RingEquations() = default;
  /// Equations 0 x = 0 on a sphere or a torus.
  explicit RingEquations(const Grid& grid);

  /// Adds w to a cell's own coefficient.
  void add_own(Index cell, Complex w);
  /// Adds w (x_cell - x_there), `there` a side of kEast, kWest, kNorth and kSouth.
  void add_exchange(int i, int j, int side, double w);

  [[nodiscard]] Eigen::Index rows() const { return 2 * static_cast<Eigen::Index>(own_.size()); }
  [[nodiscard]] Eigen::Index cols() const { return rows(); }
  [[nodiscard]] Vector operator*(const Vector& x) const;

  /// Values of cells in a vector's order, and back.
  void gather(std::span<const Complex> of_cells, Vector& vector) const;
  void scatter(const Vector& vector, std::span<Complex> of_cells) const;

 private:
  friend class ZebraRows;
  [[nodiscard]] std::size_t place(int i, int j) const {
    return static_cast<std::size_t>(i) * ny_ + (j % 2 == 0 ? j / 2 : even_ + j / 2);
  }

  int nx_ = 0, ny_ = 0, even_ = 0;  ///< columns, rows, even rows
  std::vector<Complex> own_;
  std::vector<double> west_, east_, south_, north_;
};

/// Preconditioner for them: zebra line relaxation, all even rows, all odd ones and the even ones
/// again (Trottenberg et al. 2001, section 5.1), each row's own equations solved exactly (Thomas
/// algorithm; the corner entries split off as a rank-one term, Sherman-Morrison). So the narrow
/// cells near the poles, which exchange much along their rows, cost nothing more.
class ZebraRows {
 public:
  using Vector = RingEquations::Vector;

  ZebraRows& analyzePattern(const RingEquations& /*equations*/) { return *this; }
  ZebraRows& factorize(const RingEquations& equations) { return compute(equations); }
  ZebraRows& compute(const RingEquations& equations);
  [[nodiscard]] Vector solve(const Vector& right) const;
  [[nodiscard]] static Eigen::ComputationInfo info() { return Eigen::Success; }

 private:
  using Complex = RingEquations::Complex;
  const RingEquations* equations_ = nullptr;
  std::vector<Complex> upper_, inverse_, corner_;  ///< per unknown
  std::vector<Complex> last_share_, closing_;      ///< per row
};

}  // namespace geo
