#include "kernels/climate/row_preconditioner.hpp"

#include <algorithm>

#include "kernels/numerics/thomas.hpp"

namespace geo {

RowPreconditioner& RowPreconditioner::compute(const Matrix& matrix) {
  const auto size = static_cast<std::size_t>(matrix.rows());
  ny_ = static_cast<int>(size) / nx_;
  for (auto* values : {&west_, &upper_, &inverse_, &corner_}) values->assign(size, 0.0);
  last_share_.assign(ny_, 0.0);
  closing_.assign(ny_, 0.0);
  others_.clear();
  others_begin_.assign(1, 0);
  std::vector<Complex> west(nx_), own(nx_), east(nx_);
  for (int row = 0; row < ny_; ++row) {
    for (int i = 0; i < nx_; ++i) {
      west[i] = own[i] = east[i] = 0.0;
      const Eigen::Index here = static_cast<Eigen::Index>(row) * nx_ + i;
      for (Matrix::InnerIterator entry(matrix, here); entry; ++entry) {
        const Eigen::Index column = entry.col();
        if (column / nx_ != row) {
          others_.push_back({column, entry.value()});
        } else if (column == here) {
          own[i] = entry.value();
        } else if (column % nx_ == (i + 1) % nx_) {
          east[i] = entry.value();
        } else {
          west[i] = entry.value();
        }
      }
      others_begin_.push_back(others_.size());
    }
    factor_row(row, west, own, east);
  }
  return *this;
}

void RowPreconditioner::factor_row(int row, const std::vector<Complex>& west,
                                   const std::vector<Complex>& own,
                                   const std::vector<Complex>& east) {
  const std::span<Complex> lower = part(west_, row), upper = part(upper_, row),
                           inverse = part(inverse_, row), corner = part(corner_, row);
  std::copy(west.begin(), west.end(), lower.begin());
  std::copy(east.begin(), east.end(), upper.begin());
  std::copy(own.begin(), own.end(), inverse.begin());
  // The matrix without its corners west[0] and east[n-1] is that plus u v^T,
  // u = (gamma, 0 ... east[n-1]), v = (1, 0 ... west[0] / gamma).
  const Complex gamma = -own[0];
  last_share_[row] = west[0] / gamma;
  inverse.front() = own[0] - gamma;
  inverse.back() -= east.back() * west[0] / gamma;
  factor_tridiagonal<Complex>(lower, upper, inverse);
  std::fill(corner.begin(), corner.end(), Complex(0.0));
  corner.front() = gamma;
  corner.back() = east.back();
  solve_tridiagonal<Complex>(lower, upper, inverse, corner);
  closing_[row] = 1.0 / (1.0 + corner.front() + last_share_[row] * corner.back());
}

void RowPreconditioner::solve_row(int row, std::span<Complex> values) const {
  solve_tridiagonal<Complex>(part(west_, row), part(upper_, row), part(inverse_, row), values);
  const std::span<const Complex> corner = part(corner_, row);
  const Complex share = (values.front() + last_share_[row] * values.back()) * closing_[row];
  for (int i = 0; i < nx_; ++i) values[i] -= share * corner[i];
}

void RowPreconditioner::take_others(int row, const Vector& solution,
                                    std::span<Complex> values) const {
  const std::size_t begin = static_cast<std::size_t>(row) * nx_;
  for (int i = 0; i < nx_; ++i) {
    for (std::size_t k = others_begin_[begin + i]; k < others_begin_[begin + i + 1]; ++k) {
      values[i] -= others_[k].value * solution[others_[k].column];
    }
  }
}

RowPreconditioner::Vector RowPreconditioner::solve(const Vector& right) const {
  Vector solution = Vector::Zero(right.size());
  std::vector<Complex> values(nx_);
  const auto relax = [&](int row) {
    const Eigen::Index begin = static_cast<Eigen::Index>(row) * nx_;
    std::copy_n(right.data() + begin, nx_, values.begin());
    take_others(row, solution, values);
    solve_row(row, values);
    std::copy(values.begin(), values.end(), solution.data() + begin);
  };
  for (int row = 0; row < ny_; ++row) relax(row);
  for (int row = ny_ - 2; row >= 0; --row) relax(row);
  return solution;
}

}  // namespace geo
