#pragma once

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

}  // namespace geo
