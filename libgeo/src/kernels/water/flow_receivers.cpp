// D8 receivers and the drainage of flats.
#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/kernels/water/flow_graph.hpp"
#include "kernels/numerics/wide.hpp"

namespace geo {
namespace {

using Weights = std::array<float, kDirections>;

/// Slopes are compared as drops times the ratio of the row's longest step to each step. Ratios of 1
/// and more cannot make a drop vanish in underflow, so only true pits are left without a receiver.
Weights slope_weights(const Grid& grid, int j) {
  const auto& distance = grid.distances_m(j);
  const double longest = *std::max_element(distance.begin(), distance.end());
  Weights weights{};
  for (int k = 0; k < kDirections; ++k) weights[k] = static_cast<float>(longest / distance[k]);
  return weights;
}

/// Receiver of one cell by the generic neighbour function: edges, poles, wraps.
Index receiver_at_edge(const Grid& grid, const float* z, const Weights& weights, int i, int j) {
  const Index cell = grid.cell(i, j);
  Index receiver = cell;
  float steepest = 0.0F;
  for (int k = 0; k < kDirections; ++k) {
    const Index to = grid.neighbour(i, j, k);
    if (to == kNoCell) continue;
    const float slope = (z[cell] - z[to]) * weights[k];
    if (slope > steepest) {
      steepest = slope;
      receiver = to;
    }
  }
  return receiver;
}

/// The interior of one row: constant offsets, no branches, so that the compiler vectorises it.
/// Eight comparisons a cell; the same multiplications as at the edges, hence the same bits.
TERRANE_WIDE void interior_receivers(const float* z, Index begin, Index end,
                                     const std::array<Index, kDirections>& offset,
                                     const Weights& weights, Index* receiver) {
  for (Index cell = begin; cell < end; ++cell) {
    const float here = z[cell];
    float steepest = 0.0F;
    Index step = 0;
#pragma GCC unroll 8
    for (int k = 0; k < kDirections; ++k) {
      const float slope = (here - z[cell + offset[k]]) * weights[k];
      const bool steeper = slope > steepest;
      steepest = steeper ? slope : steepest;
      step = steeper ? offset[k] : step;
    }
    receiver[cell] = cell + step;
  }
}

void row_receivers(const Grid& grid, const float* z, const std::uint8_t* outlets, int j,
                   Index* receiver) {
  const int nx = grid.nx();
  const Index row = grid.cell(0, j);
  const Weights weights = slope_weights(grid, j);
  if (j == 0 || j == grid.ny() - 1) {
    for (int i = 0; i < nx; ++i) receiver[row + i] = receiver_at_edge(grid, z, weights, i, j);
  } else {
    receiver[row] = receiver_at_edge(grid, z, weights, 0, j);
    interior_receivers(z, row + 1, row + nx - 1, grid.offsets(), weights, receiver);
    receiver[row + nx - 1] = receiver_at_edge(grid, z, weights, nx - 1, j);
  }
  for (Index cell = row; cell < row + nx; ++cell) {
    receiver[cell] = outlets[cell] != 0 ? cell : receiver[cell];
  }
}

/// Drains flats: cells without a lower neighbour but with an equal one. Breadth first from `seeds`,
/// each newly reached cell takes the one that reached it as its receiver.
class FlatDrainage {
 public:
  FlatDrainage(const Grid& grid, std::span<const float> z, std::span<const std::uint8_t> outlets,
               std::span<Index> receiver)
      : grid_(grid), z_(z), outlets_(outlets), receiver_(receiver) {}

  void run() {
    const std::vector<Index> flats = find_flats();
    if (flats.empty()) return;
    // Flats with a way out: start from the neighbours of equal height that have one.
    for (const Index cell : flats) {
      for_equal_neighbours(cell, [&](Index to) {
        if (!is_bottom(to)) queue_.push_back(to);
      });
    }
    spread();
    // Closed flats: the first cell is the one pit of each.
    for (const Index cell : flats) {
      if (!is_bottom(cell) || is_pit_of_flat(cell)) continue;
      queue_.push_back(cell);
      pits_.push_back(cell);
      spread();
    }
  }

 private:
  /// In ascending order: rows are counted first, so that each knows where its own begin.
  [[nodiscard]] std::vector<Index> find_flats() const {
    std::vector<Index> begins(static_cast<std::size_t>(grid_.ny()) + 1, 0);
#pragma omp parallel for schedule(static)
    for (int j = 0; j < grid_.ny(); ++j) {
      visit_flats(j, [&](Index) { ++begins[j + 1]; });
    }
    std::partial_sum(begins.begin(), begins.end(), begins.begin());
    std::vector<Index> flats(static_cast<std::size_t>(begins.back()));
#pragma omp parallel for schedule(static)
    for (int j = 0; j < grid_.ny(); ++j) {
      if (begins[j] == begins[j + 1]) continue;
      Index at = begins[j];
      visit_flats(j, [&](Index cell) { flats[at++] = cell; });
    }
    return flats;
  }
  template <class Visit>
  void visit_flats(int j, Visit&& visit) const {
    for (Index cell = grid_.cell(0, j); cell < grid_.cell(0, j) + grid_.nx(); ++cell) {
      if (is_bottom(cell) && has_equal_neighbour(cell)) visit(cell);
    }
  }
  [[nodiscard]] bool is_bottom(Index cell) const {
    return receiver_[cell] == cell && outlets_[cell] == 0;
  }
  [[nodiscard]] bool is_pit_of_flat(Index cell) const {
    return std::binary_search(pits_.begin(), pits_.end(), cell);
  }
  template <class Visit>
  void for_equal_neighbours(Index cell, Visit&& visit) const {
    const int i = grid_.column(cell), j = grid_.row(cell);
    for (int k = 0; k < kDirections; ++k) {
      const Index to = grid_.neighbour(i, j, k);
      if (to != kNoCell && z_[to] == z_[cell]) visit(to);
    }
  }
  [[nodiscard]] bool has_equal_neighbour(Index cell) const {
    bool found = false;
    for_equal_neighbours(cell, [&](Index) { found = true; });
    return found;
  }
  void spread() {
    const Index source_pit = queue_.size() == 1 && is_bottom(queue_[0]) ? queue_[0] : kNoCell;
    for (std::size_t head = 0; head < queue_.size(); ++head) {
      const Index from = queue_[head];
      for_equal_neighbours(from, [&](Index to) {
        if (!is_bottom(to) || to == source_pit) return;
        receiver_[to] = from;
        queue_.push_back(to);
      });
    }
    queue_.clear();
  }

  const Grid& grid_;
  std::span<const float> z_;
  std::span<const std::uint8_t> outlets_;
  std::span<Index> receiver_;
  std::vector<Index> queue_;
  std::vector<Index> pits_;  // ascending, since flats are visited in order
};

}  // namespace

void steepest_receivers(const Grid& grid, std::span<const float> elevation_m,
                        std::span<const std::uint8_t> outlets, std::span<Index> receiver) {
  check_sizes("steepest_receivers", grid.size(),
              {{"elevation_m", elevation_m.size()},
               {"outlets", outlets.size()},
               {"receiver", receiver.size()}});
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    row_receivers(grid, elevation_m.data(), outlets.data(), j, receiver.data());
  }
  FlatDrainage(grid, elevation_m, outlets, receiver).run();
}

std::vector<std::uint8_t> find_outlets(const Grid& grid, std::span<const float> elevation_m,
                                       float sea_level_m) {
  check_sizes("find_outlets", grid.size(), {{"elevation_m", elevation_m.size()}});
  std::vector<std::uint8_t> outlets(grid.size());
  const bool open = grid.topology() == Topology::plane && grid.edges() == Edges::open;
  int any = open ? 1 : 0;
#pragma omp parallel for schedule(static) reduction(| : any)
  for (int j = 0; j < grid.ny(); ++j) {
    int below = 0;
    for (Index cell = grid.cell(0, j); cell < grid.cell(0, j) + grid.nx(); ++cell) {
      outlets[cell] = elevation_m[cell] < sea_level_m ? 1 : 0;
      below |= outlets[cell];
    }
    any |= below;
    if (!open) continue;
    outlets[grid.cell(0, j)] = outlets[grid.cell(grid.nx() - 1, j)] = 1;
    if (j == 0 || j == grid.ny() - 1) {
      std::fill_n(outlets.begin() + grid.cell(0, j), grid.nx(), std::uint8_t{1});
    }
  }
  if (any == 0) {
    outlets[std::min_element(elevation_m.begin(), elevation_m.end()) - elevation_m.begin()] = 1;
  }
  return outlets;
}

}  // namespace geo
