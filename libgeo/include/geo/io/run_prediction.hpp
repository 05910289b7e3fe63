#pragma once

#include "geo/core/pipeline.hpp"

namespace geo::io {

/// What a run will take. Rough: within a factor of two on machines of today.
struct Prediction {
  double memory_bytes = 0.0;
  double seconds = 0.0;
  double disk_bytes = 0.0;
};

/// Predicts stages first..last of a pipeline on `cells` cells from costs per cell, one table in the
/// source. `vtk` as in RunSettings; `map_width_px` is 0 where no maps are drawn.
Prediction predict(const Pipeline& pipeline, int first, int last, double cells, int threads,
                   bool vtk, double map_width_px);

}  // namespace geo::io
