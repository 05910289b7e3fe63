#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"

namespace geo {

/// One axis of a raster: cell centres and the edges between them, ascending, in a coordinate of
/// the caller's choice. Cells need not be equal, nor centres in the middle of their cells (the pole
/// rows of a node-registered planet are half cells with their node at the pole).
struct Axis {
  std::vector<double> centres;
  std::vector<double> edges;  ///< one more than centres
  double period = 0.0;        ///< 360 for longitudes all round the planet, 0: does not wrap

  [[nodiscard]] int size() const noexcept { return static_cast<int>(centres.size()); }
  bool operator==(const Axis&) const = default;
};

/// Rows and columns of a raster. Geographic axes are in degrees, metric ones in m.
struct Raster {
  Axis rows, columns;
  bool geographic = true;

  bool operator==(const Raster&) const = default;
};

/// The raster of a grid: degrees where its cells are geographic, else m about its centre.
Raster raster_of(const Grid& grid);
/// The same in m, for planes and tori.
Raster metric_raster_of(const Grid& grid);

/// Values of a raster on another one that lies within it. Along each axis on its own:
/// where target cells are as large as source cells or larger, the mean over the overlap, exact and
/// conservative, with row weights of true area (authalic sine of latitude on `figure`); where they
/// are smaller, linear interpolation between source centres, towards the mean of the polar row at
/// a pole. `source` and `target` hold one value per cell, row by row. Cost: linear in the cells of
/// both. Throws InputError if the target reaches beyond the source.
void resample_raster(const Raster& source_raster, std::span<const float> source,
                     const Raster& target_raster, std::span<float> target,
                     const Ellipsoid& figure = {});

/// The same row by row, for who needs few rows at a time, and several fields between the same
/// rasters. What is done once for all fields is done when it is made. Throws InputError if the
/// target reaches beyond the source.
class RowResampling {
 public:
  RowResampling(const Raster& source, const Raster& target, const Ellipsoid& figure = {});

  [[nodiscard]] int rows() const noexcept { return static_cast<int>(row_shares_.size()); }
  [[nodiscard]] int columns() const noexcept { return static_cast<int>(columns_.size()); }
  /// Values of scratch that `row` needs, one thread's.
  [[nodiscard]] std::size_t scratch_size() const noexcept { return source_columns_; }
  /// Row j of the target into `out`, a value for each column. `source`: all of its values.
  void row(std::span<const float> source, int j, std::span<float> out,
           std::span<double> scratch) const;

 private:
  /// Which cells of a source axis make up one of the target's, and their shares, which add up to
  /// one. Cells are consecutive; those of a column go on at 0 where the source ends.
  struct Share {
    int first = 0, count = 0;
    std::size_t weights = 0;  ///< where they begin in `weights_`
  };
  /// Share of the mean of a polar row in one that lies beyond it.
  struct PoleBlend {
    double share = 0.0;
    int row = 0;
  };

  std::size_t source_columns_;
  std::vector<Share> row_shares_, columns_;
  std::vector<PoleBlend> poles_;
  std::vector<double> weights_;
};

}  // namespace geo
