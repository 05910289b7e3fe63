#include "geo/kernels/cubic_rows.hpp"

#include <cmath>

#include "geo/core/error.hpp"

namespace geo {

CubicRows::CubicRows(const Grid& from, const Grid& to)
    : nx_(from.nx()),
      ny_(from.ny()),
      columns_(stencils(from.nx(), to.nx())),
      rows_(stencils(from.ny(), to.ny())) {
  if (from.topology() != Topology::sphere || to.topology() != Topology::sphere) {
    throw InputError("cubic rows: both grids must be whole spheres");
  }
}

std::vector<CubicRows::Stencil> CubicRows::stencils(int from, int to) {
  std::vector<Stencil> all(to);
  for (int k = 0; k < to; ++k) {
    const double position = (k + 0.5) * from / to - 0.5;
    const double floor = std::floor(position);
    const auto t = static_cast<float>(position - floor);
    all[k].first = static_cast<int>(floor) - 1;
    all[k].weight = {0.5F * t * (-1.0F + t * (2.0F - t)), 1.0F + 0.5F * t * t * (3.0F * t - 5.0F),
                     0.5F * t * (1.0F + t * (4.0F - 3.0F * t)), 0.5F * t * t * (t - 1.0F)};
  }
  return all;
}

void CubicRows::read(std::span<const float> field, int row, std::span<float> out,
                     std::vector<float>& scratch) const {
  constexpr int kMargin = 2;
  scratch.assign(nx_ + 2 * kMargin, 0.0F);
  const Stencil& meridian = rows_[row];
  for (int k = 0; k < 4; ++k) {
    if (meridian.weight[k] == 0.0F) continue;
    int j = meridian.first + k, shift = 0;
    if (j < 0) j = -1 - j, shift = nx_ / 2;
    if (j >= ny_) j = 2 * ny_ - 1 - j, shift = nx_ / 2;
    const float* values = field.data() + static_cast<std::size_t>(j) * nx_;
    float* to = scratch.data() + kMargin;
    for (int i = 0; i < nx_ - shift; ++i) to[i] += meridian.weight[k] * values[i + shift];
    for (int i = nx_ - shift; i < nx_; ++i) to[i] += meridian.weight[k] * values[i + shift - nx_];
  }
  for (int i = 0; i < kMargin; ++i) {
    scratch[i] = scratch[nx_ + i];
    scratch[nx_ + kMargin + i] = scratch[kMargin + i];
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Stencil& s = columns_[i];
    const float* v = scratch.data() + kMargin + s.first;
    out[i] = s.weight[0] * v[0] + s.weight[1] * v[1] + s.weight[2] * v[2] + s.weight[3] * v[3];
  }
}

}  // namespace geo
