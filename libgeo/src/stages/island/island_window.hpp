#pragma once

#include <memory>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/stages/island/island.hpp"

namespace geo {

/// The grid of an island, and the wider one that its surface is made on.
///
/// The edge of the wide one keeps the planet's heights, and detail fades in behind it: ground that
/// is even there, and a rim that holds water back as rivers behind it sink, would lead rivers along
/// it. All that lies in the margin, which is cropped away, so that at the island's own edge
/// detail, valleys and divides are those of the inside. No margin where edges sink below the sea.
class IslandWindow {
 public:
  IslandWindow(const IslandParameters& p, Centre centre, Ellipsoid figure);

  [[nodiscard]] const std::shared_ptr<const Grid>& island() const { return island_; }
  [[nodiscard]] const Grid& wide() const { return *wide_; }
  [[nodiscard]] int margin() const { return margin_; }

  /// Cell of the island at a cell of the wide grid; kNoCell in the margin.
  [[nodiscard]] Index in_island(Index wide_cell) const {
    const int i = wide_->column(wide_cell) - margin_, j = wide_->row(wide_cell) - margin_;
    const bool inside = i >= 0 && i < island_->nx() && j >= 0 && j < island_->ny();
    return inside ? island_->cell(i, j) : kNoCell;
  }
  /// Whether a cell of the wide grid is one of the island's at its edge.
  [[nodiscard]] bool on_islands_edge(Index wide_cell) const {
    const Index c = in_island(wide_cell);
    return c != kNoCell && island_->is_open_edge(island_->column(c), island_->row(c));
  }
  /// The island's part of an array with one value per cell of the wide grid.
  template <class T>
  [[nodiscard]] std::vector<T> crop(const std::vector<T>& wide) const {
    std::vector<T> cropped;
    cropped.reserve(island_->size());
    for (int j = 0; j < island_->ny(); ++j) {
      const auto row = wide.begin() + wide_->cell(margin_, j + margin_);
      cropped.insert(cropped.end(), row, row + island_->nx());
    }
    return cropped;
  }

 private:
  int margin_;  ///< cells on each side
  std::shared_ptr<const Grid> island_, wide_;
};

}  // namespace geo
