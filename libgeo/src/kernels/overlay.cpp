#include "geo/kernels/overlay.hpp"

#include <algorithm>
#include <cmath>

#include "geo/core/error.hpp"

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

}  // namespace

Overlay::Overlay(const Grid& fine, const Grid& coarse)
    : fine_(fine),
      coarse_(coarse),
      column_edge_(even_edges(fine.nx(), coarse.nx())),
      row_edge_(even_edges(fine.ny(), coarse.ny())) {
  if (fine.topology() != coarse.topology()) throw Bug("overlay: topologies differ");
}

Overlay::Overlay(const Grid& fine, const Grid& coarse_sphere, std::span<const double> row_edge_deg,
                 std::span<const double> column_edge_deg)
    : fine_(fine), coarse_(coarse_sphere) {
  if (coarse_sphere.topology() != Topology::sphere) throw Bug("overlay: coarse grid is no sphere");
  for (const double edge : row_edge_deg) {
    row_edge_.push_back((std::clamp(edge, -90.0, 90.0) + 90.0) / 180.0 * coarse_.ny());
  }
  for (const double edge : column_edge_deg) {
    column_edge_.push_back((edge + 180.0) / 360.0 * coarse_.nx());
  }
}

void Overlay::average_relief(std::span<const float> elevation, std::span<float> land_fraction,
                             std::span<float> height_m, std::span<float> coverage) const {
  const int coarse_nx = coarse_.nx(), coarse_ny = coarse_.ny();
  const int fine_nx = fine_.nx(), fine_ny = fine_.ny();
  const bool wraps = coarse_.topology() != Topology::plane;
#pragma omp parallel
  {
    std::vector<double> land(coarse_nx), height(coarse_nx), weight(coarse_nx);
#pragma omp for schedule(static)
    for (int row = 0; row < coarse_ny; ++row) {
      std::fill(land.begin(), land.end(), 0.0);
      std::fill(height.begin(), height.end(), 0.0);
      std::fill(weight.begin(), weight.end(), 0.0);
      const auto after = std::upper_bound(row_edge_.begin(), row_edge_.end(), double(row));
      int j = std::max(0, static_cast<int>(after - row_edge_.begin()) - 1);
      for (; j < fine_ny && row_edge_[j] < row + 1.0; ++j) {
        const double share =
            std::min(row_edge_[j + 1], row + 1.0) - std::max(row_edge_[j], double(row));
        if (share <= 0.0) continue;
        const std::size_t begin = static_cast<std::size_t>(j) * fine_nx;
        for (int i = 0; i < fine_nx; ++i) {
          const float h = elevation[begin + i];
          const double is_land = h >= 0.0F ? 1.0 : 0.0;
          const double above = h > 0.0F ? h : 0.0;
          const double from = column_edge_[i], to = column_edge_[i + 1];
          for (int column = static_cast<int>(std::floor(from)); column < to; ++column) {
            const double overlap =
                share * (std::min(to, column + 1.0) - std::max(from, double(column)));
            if (!wraps && column >= coarse_nx) break;
            const int at = wraps ? wrapped(column, coarse_nx) : column;
            weight[at] += overlap;
            land[at] += overlap * is_land;
            height[at] += overlap * above;
          }
        }
      }
      for (int column = 0; column < coarse_nx; ++column) {
        const Index cell = coarse_.cell(column, row);
        const double w = weight[column];
        coverage[cell] = static_cast<float>(std::min(1.0, w));
        land_fraction[cell] = w > 0.0 ? static_cast<float>(land[column] / w) : 0.0F;
        height_m[cell] = w > 0.0 ? static_cast<float>(height[column] / w) : 0.0F;
      }
    }
  }
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

Interpolator::Interpolator(const Overlay& overlay, std::span<const float> coarse_values,
                           Kind kind) {
  const Grid& coarse = overlay.coarse_;
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
  fill(overlay.column_edge_, nx, wraps_x, column_taps_);
  fill(overlay.row_edge_, ny, wraps_y, row_taps_);
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
