#pragma once

#include <string>
#include <vector>

#include "geo/core/stage.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"

namespace geo {

/// Areas and volumes of crust and sediment over a whole drift, summed up step by step, and whether
/// they close: what there is in the end is what there was and what has come and gone.
class SphereMassBalance {
 public:
  void enter(const SphereBudget& step);
  /// Sums of all steps that were entered, for the manifest.
  void close(Budget& budget) const;

 private:
  double created_ = 0.0, consumed_ = 0.0, buried_ = 0.0, emerged_ = 0.0;
  double deposited_ = 0.0, sea_floor_ = 0.0, scraped_ = 0.0;
  double laid_ = 0.0, reworked_ = 0.0, subducted_ = 0.0, sediment_resampling_ = 0.0;
  double raised_ = 0.0, eroded_ = 0.0, emerged_km3_ = 0.0, changed_ = 0.0, lost_ = 0.0;
  double resampling_ = 0.0;
  double first_km3_ = -1.0, first_sediment_km3_ = 0.0;
  int collisions_ = 0, rifts_ = 0, subduction_initiations_ = 0;
  SphereBudget last_;
};

/// What a step is told by, before the areas of its plates.
[[nodiscard]] std::vector<std::string> step_columns();
/// The step that a model has made, with the area of each plate that there has been behind it.
[[nodiscard]] std::vector<double> step_row(const SphereTectonics& model);
/// Columns for the areas of all plates there have been.
void name_plates(StepTable& steps);

}  // namespace geo
