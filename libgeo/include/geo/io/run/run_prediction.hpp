#pragma once

#include "geo/core/pipeline.hpp"
#include "geo/io/run/machine_speed.hpp"
#include "geo/io/run/run_plan.hpp"

namespace geo::io {

/// What a run will take. Time holds for the machine as busy as it was when it was measured.
struct Prediction {
  double memory_bytes = 0.0;
  double seconds = 0.0;
  double disk_bytes = 0.0;
};

/// Predicts stages first..last of a pipeline on `cells` cells from what each says that it costs,
/// scaled to the speed of this machine. `vtk_share` is 0 where no VTK files are written,
/// else share_of_vtk; `map_width_px` is 0 where no maps are drawn.
Prediction predict(const Pipeline& pipeline, int first, int last, double cells,
                   const MachineSpeed& speed, double vtk_share, double map_width_px);
/// The stages of a plan that are still to be computed, with all files that the settings ask for.
Prediction predict(const RunConfiguration& run, const RunPlan& plan, double cells,
                   const MachineSpeed& speed);
/// What VTK files take of the bytes of their values, by RunSettings::vtk_compression.
double share_of_vtk(int compression);

}  // namespace geo::io
