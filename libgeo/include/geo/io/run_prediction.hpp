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
/// source. `vtk` and `maps` as in RunSettings.
Prediction predict(const Pipeline& pipeline, int first, int last, double cells, int threads,
                   bool vtk, bool maps);

}  // namespace geo::io
