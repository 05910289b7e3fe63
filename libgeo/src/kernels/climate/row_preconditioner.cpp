#include "kernels/climate/row_preconditioner.hpp"

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
  const std::size_t begin = static_cast<std::size_t>(row) * nx_;
  Complex *upper = &upper_[begin], *inverse = &inverse_[begin], *corner = &corner_[begin];
  std::copy(west.begin(), west.end(), west_.begin() + static_cast<std::ptrdiff_t>(begin));
  // The matrix without its corners west[0] and east[n-1] is that plus u v^T,
  // u = (gamma, 0 ... east[n-1]), v = (1, 0 ... west[0] / gamma).
  const Complex gamma = -own[0];
  const int last = nx_ - 1;
  last_share_[row] = west[0] / gamma;
  inverse[0] = 1.0 / (own[0] - gamma);
  corner[0] = gamma * inverse[0];
  for (int i = 1; i < nx_; ++i) {
    upper[i - 1] = east[i - 1] * inverse[i - 1];
    const Complex diagonal = i == last ? own[i] - east[last] * west[0] / gamma : own[i];
    inverse[i] = 1.0 / (diagonal - west[i] * upper[i - 1]);
    const Complex edge = i == last ? east[last] : Complex(0.0);
    corner[i] = (edge - west[i] * corner[i - 1]) * inverse[i];
  }
  for (int i = last - 1; i >= 0; --i) corner[i] -= upper[i] * corner[i + 1];
  closing_[row] = 1.0 / (1.0 + corner[0] + last_share_[row] * corner[last]);
}

void RowPreconditioner::solve_row(int row, Complex* values) const {
  const std::size_t begin = static_cast<std::size_t>(row) * nx_;
  const Complex *west = &west_[begin], *upper = &upper_[begin], *inverse = &inverse_[begin],
                *corner = &corner_[begin];
  values[0] *= inverse[0];
  for (int i = 1; i < nx_; ++i) values[i] = (values[i] - west[i] * values[i - 1]) * inverse[i];
  for (int i = nx_ - 2; i >= 0; --i) values[i] -= upper[i] * values[i + 1];
  const Complex share = (values[0] + last_share_[row] * values[nx_ - 1]) * closing_[row];
  for (int i = 0; i < nx_; ++i) values[i] -= share * corner[i];
}

void RowPreconditioner::take_others(int row, const Vector& solution, Complex* values) const {
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
    take_others(row, solution, values.data());
    solve_row(row, values.data());
    std::copy(values.begin(), values.end(), solution.data() + begin);
  };
  for (int row = 0; row < ny_; ++row) relax(row);
  for (int row = ny_ - 2; row >= 0; --row) relax(row);
  return solution;
}

}  // namespace geo
