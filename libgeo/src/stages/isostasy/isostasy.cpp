#include "geo/stages/isostasy.hpp"

#include <algorithm>
#include <cmath>

#include "blueprint_crust.hpp"
#include "coarse_grid.hpp"
#include "crust.hpp"
#include "geo/core/error.hpp"
#include "geo/kernels/shapes.hpp"
#include "geo/stages/sea_level.hpp"
#include "margins_crust.hpp"
#include "rocks.hpp"
#include "stiffness.hpp"
#include "tectonics.hpp"

namespace geo {
namespace {

void float_crust(const Crust& crust, const Context& context) {
  const CoarseGrid coarse(crust.grid);
  Tectonics tectonics = deform(crust, coarse);
  context.advance(0.3);
  if (crust.parameters.crust == "blueprint") {
    draw_blueprint_crust(crust, coarse, tectonics);
    stiffen_blueprint(crust, coarse);
  } else {
    cut_sections(crust, coarse, tectonics);
    tectonics.flexure_m = flexure_of_belts_m(crust, coarse.grid(), tectonics);
    context.advance(0.4);
    draw_margins_crust(crust, coarse, tectonics);
  }
}

/// The sea covers its share; sediment builds its margins up towards its level. Returns the level
/// that became 0, m.
double fill_sea(const Crust& crust) {
  const IsostasyParameters& p = crust.parameters;
  const auto level = static_cast<float>(sea_level_m(crust.grid, crust.elevation_m, crust.planet));
  const bool shelves = p.crust != "blueprint" && p.shelf_depth_m > 0.0;
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < crust.grid.size(); ++cell) {
    float& z = crust.elevation_m[cell];
    z -= level;
    if (!shelves || z >= 0.0F) continue;
    const double on_shelf = smooth_step(0.7, 0.95, crust.fraction[cell]);
    if (on_shelf <= 0.0) continue;
    const double filled = -p.shelf_depth_m * -std::expm1(z / p.shelf_depth_m);
    z = std::min(-1e-3F, static_cast<float>(z + on_shelf * (filled - z)));
  }
  return level;
}

void report(const Crust& crust, Budget& budget) {
  const Grid& grid = crust.grid;
  double continental = 0.0, volume = 0.0, all_crust = 0.0;
  for (int j = 0; j < grid.ny(); ++j) {
    double area = 0.0, cubic = 0.0, all = 0.0;
    for (Index cell = grid.cell(0, j); cell < grid.cell(0, j) + grid.nx(); ++cell) {
      area += crust.fraction[cell];
      cubic += static_cast<double>(crust.fraction[cell]) * crust.thickness_m[cell];
      all += crust.thickness_m[cell];
    }
    continental += area * grid.area_m2(j);
    volume += cubic * grid.area_m2(j);
    all_crust += all * grid.area_m2(j);
  }
  budget["continental_area_m2"] = continental;
  budget["continental_crust_m3"] = volume;
  budget["crust_m3"] = all_crust;
}

class IsostasyStage final : public Stage {
 public:
  explicit IsostasyStage(IsostasyParameters parameters) : parameters_(std::move(parameters)) {}

  [[nodiscard]] const StageInfo& info() const override {
    static const StageInfo kInfo{
        "isostasy",
        "crust, rock and the height at which they float",
        {&field::plate_id, &field::continental_fraction, &field::boundary_type,
         &field::boundary_strength, &field::crust_age, &field::heat_anomaly,
         &field::plate_velocity_east, &field::plate_velocity_north},
        {&field::crust_elevation, &field::crust_thickness},
        {&field::convergent_deformation, &field::divergent_deformation,
         &field::transform_deformation, &field::lithospheric_weakness, &field::continental_fraction,
         &field::crust_thickness, &field::crust_density, &field::rock_type, &field::erodibility,
         &field::elevation}};
    return kInfo;
  }
  [[nodiscard]] std::vector<Parameter> parameters() override { return parameters_.declarations(); }

  void run(StageIo& io, Context& context) const override {
    if (io.grid().topology() != Topology::sphere) {
      throw InputError("isostasy: the grid must be a whole sphere");
    }
    const Crust crust(parameters_, io, context);
    float_crust(crust, context);
    context.advance(0.8);
    context.budget["sea_level_shift_m"] = fill_sea(crust);
    classify_rock(crust);
    report(crust, context.budget);
  }

 private:
  IsostasyParameters parameters_;
};

}  // namespace

std::unique_ptr<Stage> make_isostasy_stage(IsostasyParameters parameters) {
  return std::make_unique<IsostasyStage>(std::move(parameters));
}

}  // namespace geo
