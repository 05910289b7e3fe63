#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/remapping/cubic_rows.hpp"
#include "grown_plates.hpp"

namespace geo {

/// Fields of the mesh that are smooth, on a grid of rows and columns: reading them row by row is
/// cheaper than asking the mesh for every cell. The same coarse grid serves all finer ones.
class SmoothFields {
 public:
  SmoothFields(const GrownPlates& grown, const Grid& grid)
      : coarse_(grid.nx() <= kColumns
                    ? grid
                    : Grid::sphere(kColumns, kColumns / 2, grid.figure(), grid.turn())),
        rows_(coarse_, grid) {
    for (auto* field : {&potential_, &heat_, &convergent_km_}) field->resize(coarse_.size());
    const bool cratons = !grown.potential().empty();
#pragma omp parallel for schedule(dynamic, 4)
    for (int j = 0; j < coarse_.ny(); ++j) {
      for (int i = 0; i < coarse_.nx(); ++i) {
        const Index cell = coarse_.cell(i, j);
        const auto stencil = stencil_at(grown.mesh(), coarse_.unit_vector(i, j));
        if (cratons) potential_[cell] = static_cast<float>(read(stencil, grown.potential()));
        heat_[cell] = static_cast<float>(read(stencil, grown.heat_anomaly()));
        convergent_km_[cell] = static_cast<float>(grown.convergent_km(stencil));
      }
    }
  }
  /// One row of the grid; `line` has one value per column.
  void potential(int row, std::span<float> line, std::vector<float>& scratch) const {
    rows_.read(potential_, row, line, scratch);
  }
  void heat(int row, std::span<float> line, std::vector<float>& scratch) const {
    rows_.read(heat_, row, line, scratch);
    for (float& value : line) value = std::clamp(value, 0.0F, 1.0F);
  }
  void convergent_km(int row, std::span<float> line, std::vector<float>& scratch) const {
    rows_.read(convergent_km_, row, line, scratch);
  }

 private:
  static constexpr int kColumns = 1024;
  Grid coarse_;
  CubicRows rows_;
  std::vector<float> potential_, heat_, convergent_km_;
};

}  // namespace geo
