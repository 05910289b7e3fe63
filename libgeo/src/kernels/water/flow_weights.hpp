#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "geo/core/grid.hpp"
#include "geo/kernels/water/multiple_flow.hpp"

namespace geo {

/// Indices of the eight neighbours of a cell; kNoCell beyond an edge.
using Neighbours = std::array<Index, kDirections>;
using Weights = std::array<float, kDirections>;

/// How one cell shares what it holds among its neighbours.
class FlowWeights {
 public:
  FlowWeights(const Grid& grid, std::span<const float> surface_m, std::span<const Index> receiver,
              const FlowPartition& partition)
      : grid_(grid),
        surface_(surface_m),
        receiver_(receiver),
        partition_(partition),
        offset_(grid.offsets()) {}

  [[nodiscard]] Neighbours neighbours(int column, int row) const {
    Neighbours cells{};
    if (grid_.is_interior(column, row)) {
      const Index cell = grid_.cell(column, row);
      for (int k = 0; k < kDirections; ++k) cells[k] = cell + offset_[k];
    } else {
      for (int k = 0; k < kDirections; ++k) cells[k] = grid_.neighbour(column, row, k);
    }
    return cells;
  }

  /// Bit k is set where neighbour k receives something; 0 at roots.
  [[nodiscard]] std::uint8_t receivers(int column, int row) const;

  /// Shares, not normalised, of the neighbours that are set in `receivers`; 0 for the others.
  [[nodiscard]] Weights weights(int row, Index cell, const Neighbours& cells,
                                std::uint8_t receivers) const;

  /// Receivers of the cells from here eastwards that are best worked out together, a byte each.
  /// Returns how many cells these are.
  int receivers_of_run(int column, int row, std::uint8_t* receivers) const;
  /// The weights of the same cells, given their receivers: those of a cell in the order of the bits
  /// of its receivers, as many as there are, and then those of the next. A single receiver's is 1.
  int weights_of_run(int column, int row, const std::uint8_t* receivers, float* weights) const;

 private:
  /// Whether cells from here eastwards are worked out together.
  [[nodiscard]] bool begins_run(int column, int row) const {
    return partition_.method == FlowMethod::multiple && grid_.is_interior(column, row);
  }
  [[nodiscard]] Weights slope_weights(int row, Index cell, const Neighbours& cells,
                                      std::uint8_t receivers) const;
  /// Times the length of contour towards each neighbour.
  void face_contours(int row, Weights& weight) const;
  [[nodiscard]] Weights facet_weights(int row, Index cell, const Neighbours& cells) const;

  const Grid& grid_;
  std::span<const float> surface_;
  std::span<const Index> receiver_;
  FlowPartition partition_;
  std::array<Index, kDirections> offset_;
};

}  // namespace geo
