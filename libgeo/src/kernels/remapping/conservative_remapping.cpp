#include "geo/kernels/remapping/conservative_remapping.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"

namespace geo {
namespace {

std::vector<double> even_edges(int fine_count, int coarse_count) {
  std::vector<double> edges(fine_count + 1);
  for (int k = 0; k <= fine_count; ++k) {
    edges[k] = static_cast<double>(k) * coarse_count / fine_count;
  }
  return edges;
}

int wrapped(int index, int count) {
  const int rest = index % count;
  return rest < 0 ? rest + count : rest;
}

int even(double count) { return 2 * static_cast<int>(std::lround(0.5 * count)); }

}  // namespace

Grid coarser_grid(const Grid& fine, double spacing_m) {
  const double middle_dx_m = fine.spacing_east_m(fine.ny() / 2), dy_m = fine.face_east_m(0);
  const auto fewer = [&](int cells, double size_m) {
    const int wanted = static_cast<int>(std::lround(cells * size_m / spacing_m));
    return std::min(std::max(wanted, 4), cells);
  };
  const int nx = fewer(fine.nx(), middle_dx_m);
  const int ny = std::min(fine.ny(), std::max(3, fewer(fine.ny(), dy_m)));
  switch (fine.topology()) {
    case Topology::sphere: {
      const int rows = std::max(
          3,
          std::min(fine.ny(), static_cast<int>(std::lround(180.0 * std::numbers::pi / 180.0 *
                                                           fine.figure().radius_m / spacing_m))));
      return Grid::sphere(std::min(even(2.0 * rows), fine.nx()), rows, fine.figure(), fine.turn());
    }
    case Topology::torus:
      return Grid::torus(nx, ny, middle_dx_m * fine.nx() / nx, dy_m * fine.ny() / ny);
    case Topology::plane:
      break;
  }
  if (fine.is_latitude_longitude()) {
    return Grid::window(nx, ny, fine.window(), fine.figure(), fine.edges());
  }
  return Grid::plane(nx, ny, middle_dx_m * fine.nx() / nx, dy_m * fine.ny() / ny, fine.edges());
}

ConservativeRemapping::ConservativeRemapping(const Grid& fine, const Grid& coarse)
    : fine_(fine),
      coarse_(coarse),
      column_edge_(even_edges(fine.nx(), coarse.nx())),
      row_edge_(even_edges(fine.ny(), coarse.ny())) {
  if (fine.topology() != coarse.topology()) throw Bug("conservative remapping: topologies differ");
  overlap_columns();
}

ConservativeRemapping::ConservativeRemapping(const Grid& fine, const Grid& coarse_sphere,
                                             std::span<const double> row_edge_deg,
                                             std::span<const double> column_edge_deg)
    : fine_(fine), coarse_(coarse_sphere) {
  if (coarse_sphere.topology() != Topology::sphere)
    throw Bug("conservative remapping: coarse grid is no sphere");
  for (const double edge : row_edge_deg) {
    row_edge_.push_back((std::clamp(edge, -90.0, 90.0) + 90.0) / 180.0 * coarse_.ny());
  }
  for (const double edge : column_edge_deg) {
    column_edge_.push_back((edge + 180.0) / 360.0 * coarse_.nx());
  }
  overlap_columns();
}

void ConservativeRemapping::overlap_columns() {
  const int coarse_nx = coarse_.nx();
  const bool wraps = coarse_.topology() != Topology::plane;
  for (int i = 0; i < fine_.nx(); ++i) {
    const double from = column_edge_[i], to = column_edge_[i + 1];
    for (int column = static_cast<int>(std::floor(from)); column < to; ++column) {
      if (!wraps && column >= coarse_nx) break;
      column_overlaps_.push_back({wraps ? wrapped(column, coarse_nx) : column, i,
                                  std::min(to, column + 1.0) - std::max(from, double(column))});
    }
  }
}

template <class Visit>
void ConservativeRemapping::for_overlaps(int coarse_row, Visit&& visit) const {
  const auto after = std::upper_bound(row_edge_.begin(), row_edge_.end(), double(coarse_row));
  int j = std::max(0, static_cast<int>(after - row_edge_.begin()) - 1);
  for (; j < fine_.ny() && row_edge_[j] < coarse_row + 1.0; ++j) {
    const double share =
        std::min(row_edge_[j + 1], coarse_row + 1.0) - std::max(row_edge_[j], double(coarse_row));
    if (share <= 0.0) continue;
    for (const ColumnOverlap& columns : column_overlaps_) {
      visit(columns.coarse, columns.fine, j, share * columns.width);
    }
  }
}

void ConservativeRemapping::average(std::span<const float> values, std::span<float> mean) const {
  check_sizes("ConservativeRemapping", fine_.size(), {{"values", values.size()}});
  check_sizes("ConservativeRemapping", coarse_.size(), {{"mean", mean.size()}});
  ParallelErrors errors;
#pragma omp parallel
  {
    auto sum = errors.make<std::vector<double>>(coarse_.nx());
    auto weight = errors.make<std::vector<double>>(coarse_.nx());
#pragma omp for schedule(static)
    for (int row = 0; row < coarse_.ny(); ++row) {
      if (errors.any()) continue;
      std::fill(sum.begin(), sum.end(), 0.0);
      std::fill(weight.begin(), weight.end(), 0.0);
      for_overlaps(row, [&](int at, int i, int j, double overlap) {
        const double area = overlap * fine_.area_m2(j);
        weight[at] += area;
        sum[at] += area * values[fine_.cell(i, j)];
      });
      for (int column = 0; column < coarse_.nx(); ++column) {
        mean[coarse_.cell(column, row)] =
            weight[column] > 0.0 ? static_cast<float>(sum[column] / weight[column]) : 0.0F;
      }
    }
  }
  errors.rethrow();
}

void ConservativeRemapping::average_elevation(std::span<const float> elevation,
                                              std::span<float> land_fraction,
                                              std::span<float> height_m,
                                              std::span<float> coverage) const {
  check_sizes("ConservativeRemapping", fine_.size(), {{"elevation", elevation.size()}});
  check_sizes("ConservativeRemapping", coarse_.size(),
              {{"land_fraction", land_fraction.size()},
               {"height_m", height_m.size()},
               {"coverage", coverage.size()}});
  ParallelErrors errors;
#pragma omp parallel
  {
    auto land = errors.make<std::vector<double>>(coarse_.nx());
    auto height = errors.make<std::vector<double>>(coarse_.nx());
    auto weight = errors.make<std::vector<double>>(coarse_.nx());
#pragma omp for schedule(static)
    for (int row = 0; row < coarse_.ny(); ++row) {
      if (errors.any()) continue;
      std::fill(land.begin(), land.end(), 0.0);
      std::fill(height.begin(), height.end(), 0.0);
      std::fill(weight.begin(), weight.end(), 0.0);
      for_overlaps(row, [&](int at, int i, int j, double overlap) {
        const float h = elevation[fine_.cell(i, j)];
        weight[at] += overlap;
        land[at] += overlap * (h >= 0.0F ? 1.0 : 0.0);
        height[at] += overlap * (h > 0.0F ? h : 0.0);
      });
      for (int column = 0; column < coarse_.nx(); ++column) {
        const Index cell = coarse_.cell(column, row);
        const double w = weight[column];
        coverage[cell] = static_cast<float>(std::min(1.0, w));
        land_fraction[cell] = w > 0.0 ? static_cast<float>(land[column] / w) : 0.0F;
        height_m[cell] = w > 0.0 ? static_cast<float>(height[column] / w) : 0.0F;
      }
    }
  }
  errors.rethrow();
}

Interpolator::Taps Interpolator::taps(double position, int count, bool wraps) {
  const double centred = position - 0.5;
  double base = std::floor(centred);
  const double f = centred - base;
  int first = static_cast<int>(base) - 1;
  if (wraps) first = wrapped(first + 1, count) - 1;
  // Padding reaches kPad cells beyond each end.
  first = std::clamp(first, -kPad, count + kPad - 4) + kPad;
  const double g = 1.0 - f;
  return {first,
          {static_cast<float>(g * g * g / 6.0),
           static_cast<float>((4.0 - 6.0 * f * f + 3.0 * f * f * f) / 6.0),
           static_cast<float>((4.0 - 6.0 * g * g + 3.0 * g * g * g) / 6.0),
           static_cast<float>(f * f * f / 6.0)}};
}

Interpolator::Interpolator(const ConservativeRemapping& remapping,
                           std::span<const float> coarse_values, Kind kind) {
  check_sizes("Interpolator", remapping.coarse_.size(), {{"coarse_values", coarse_values.size()}});
  const Grid& coarse = remapping.coarse_;
  const int nx = coarse.nx(), ny = coarse.ny();
  const Topology topology = coarse.topology();
  padded_nx_ = nx + 2 * kPad;
  padded_ny_ = ny + 2 * kPad;
  padded_.resize(static_cast<std::size_t>(padded_nx_) * padded_ny_);
  for (int j = -kPad; j < ny + kPad; ++j) {
    int row = j, turn = 0;
    float sign = 1.0F;
    if (topology == Topology::torus) {
      row = wrapped(j, ny);
    } else if (topology == Topology::plane) {
      row = std::clamp(j, 0, ny - 1);
    } else if (j < 0 || j >= ny) {
      row = j < 0 ? -1 - j : 2 * ny - 1 - j;
      turn = nx / 2;
      if (kind == Kind::vector_component) sign = -1.0F;
    }
    for (int i = -kPad; i < nx + kPad; ++i) {
      const int column =
          topology == Topology::plane ? std::clamp(i, 0, nx - 1) : wrapped(i + turn, nx);
      padded_[static_cast<std::size_t>(j + kPad) * padded_nx_ + i + kPad] =
          sign * coarse_values[coarse.cell(column, row)];
    }
  }
  const bool wraps_x = topology != Topology::plane, wraps_y = topology == Topology::torus;
  const auto fill = [](std::span<const double> edges, int count, bool wraps,
                       std::vector<Taps>& out) {
    for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
      out.push_back(taps(0.5 * (edges[k] + edges[k + 1]), count, wraps));
    }
  };
  fill(remapping.column_edge_, nx, wraps_x, column_taps_);
  fill(remapping.row_edge_, ny, wraps_y, row_taps_);
}

void Interpolator::row(int fine_row, std::span<float> out, std::span<float> scratch) const {
  const Taps& rows = row_taps_[fine_row];
  const float* from = padded_.data() + static_cast<std::size_t>(rows.first) * padded_nx_;
  for (int i = 0; i < padded_nx_; ++i) {
    scratch[i] = rows.weight[0] * from[i] + rows.weight[1] * from[i + padded_nx_] +
                 rows.weight[2] * from[i + 2 * padded_nx_] +
                 rows.weight[3] * from[i + 3 * padded_nx_];
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Taps& t = column_taps_[i];
    const float* at = scratch.data() + t.first;
    out[i] = t.weight[0] * at[0] + t.weight[1] * at[1] + t.weight[2] * at[2] + t.weight[3] * at[3];
  }
}

}  // namespace geo
