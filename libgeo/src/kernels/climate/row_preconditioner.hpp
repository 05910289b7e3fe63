#pragma once

#include <Eigen/SparseCore>
#include <complex>
#include <span>
#include <vector>

namespace geo {

/// Preconditioner of Eigen's iterative solvers for fields on rows that close on themselves: block
/// Gauss-Seidel from the first row to the last and back, each row's own equations solved exactly
/// (Thomas algorithm; the corner entries split off as a rank-one term, Sherman-Morrison). So the
/// narrow cells near the poles, which exchange much along their rows, cost nothing more.
class RowPreconditioner {
 public:
  using Complex = std::complex<double>;
  using Matrix = Eigen::SparseMatrix<Complex, Eigen::RowMajor>;
  using Vector = Eigen::VectorXcd;

  /// The matrix has `nx` unknowns a row.
  void set_row_length(int nx) { nx_ = nx; }
  RowPreconditioner& analyzePattern(const Matrix& /*matrix*/) { return *this; }
  RowPreconditioner& factorize(const Matrix& matrix) { return compute(matrix); }
  RowPreconditioner& compute(const Matrix& matrix);
  [[nodiscard]] Vector solve(const Vector& right) const;
  [[nodiscard]] static Eigen::ComputationInfo info() { return Eigen::Success; }

 private:
  struct Entry {
    Eigen::Index column;
    Complex value;
  };
  void factor_row(int row, const std::vector<Complex>& west, const std::vector<Complex>& own,
                  const std::vector<Complex>& east);
  void solve_row(int row, std::span<Complex> values) const;
  /// Takes from `values` of a row what other rows give it.
  void take_others(int row, const Vector& solution, std::span<Complex> values) const;
  template <class Values>
  [[nodiscard]] auto part(Values& of_all, int row) const {
    return std::span(of_all).subspan(static_cast<std::size_t>(row) * nx_, nx_);
  }

  int nx_ = 0, ny_ = 0;
  std::vector<Complex> west_, upper_, inverse_, corner_;  ///< per unknown
  std::vector<Complex> last_share_, closing_;             ///< per row
  std::vector<Entry> others_;                             ///< couplings with other rows
  std::vector<std::size_t> others_begin_;                 ///< of each unknown
};

}  // namespace geo
