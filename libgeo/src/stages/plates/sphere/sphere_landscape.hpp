#pragma once

#include <memory>
#include <span>
#include <vector>

#include "geo/core/stage.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "geo/stages/erosion/drainage.hpp"
#include "geo/stages/erosion/erosion.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {

/// plates.landscape = "full": the climate that rivers of drifting plates live in, the water of
/// their sea, and what frames show of both. Every `plates.sphere.climate_myr` the surface, as
/// plates lie, has its climate and ice (icy_climate) computed anew on a grid of one degree; rivers
/// run on its runoff until the next. The volume of sea water and land ice stays what it was at time
/// 0.
class DriftLandscape {
 public:
  /// What frames have because of it.
  static std::vector<const FieldSpec*> fields();

  /// What one climate takes, as in StageCost, with the climate's settings in `configuration`.
  static double climate_seconds(std::span<const Parameter> configuration);

  /// `grid`: that of the run, whose frame the climate's shares.
  DriftLandscape(const PlatesParameters& parameters, const Grid& grid, Context& context);

  /// Whether a climate is due between two numbers of steps, the first exclusively.
  [[nodiscard]] bool is_due(std::int64_t before, std::int64_t after, double step_myr) const;
  /// Hands rivers of a model, and of the one that leads it, the climate of the surface as it is.
  void turn_climate(SphereTectonics& crust, SphereTectonics* leader);
  /// Fields of a frame: of `seen`, which is `model` as a resampling shows it.
  void draw(const SphereTectonics& model, const SphereTectonics& seen, StageIo& io);

 private:
  void fill_sea(SphereTectonics& model) const;
  [[nodiscard]] std::vector<float> surface_m(const SphereTectonics& model) const;
  [[nodiscard]] LandClimate climate_of(const SphereTectonics& model);
  [[nodiscard]] std::vector<float> runoff_at(const SphereMesh& mesh,
                                             const std::vector<float>& of_cells) const;
  [[nodiscard]] double ice_km3() const;

  double interval_myr_;
  Context& context_;
  ErosionParameters land_;  ///< how ice and runoff are told, without cold times
  std::shared_ptr<const Grid> grid_;
  LandClimate climate_;  ///< computed last
  double climate_myr_;   ///< when
};

}  // namespace geo
