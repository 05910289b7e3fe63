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

/// Predicts the stages of a plan that are still to be computed on `cells` cells, with all files
/// that the settings ask for, from what each stage says that it costs (StageCost), scaled to the
/// speed of this machine.
Prediction predict(const RunConfiguration& run, const RunPlan& plan, double cells,
                   const MachineSpeed& speed);
/// What VTK files take of the bytes of their values, by RunSettings::vtk_compression.
double share_of_vtk(int compression);

}  // namespace geo::io
