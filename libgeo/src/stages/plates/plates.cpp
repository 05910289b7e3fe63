#include "geo/stages/plates/plates.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geo/core/error.hpp"
#include "hypsography.hpp"
#include "stages/plates/growth/growth.hpp"
#include "stages/plates/raster/raster.hpp"
#include "stages/plates/sphere/sphere.hpp"
#include "stages/plates/sphere/sphere_landscape.hpp"

namespace geo {
namespace {

class PlatesStage final : public Stage {
 public:
  explicit PlatesStage(PlatesParameters parameters) : parameters_(std::move(parameters)) {}

  [[nodiscard]] const StageInfo& info() const override {
    static const StageInfo kSeen = described({});
    static const StageInfo kDrifting = with_crust(true), kRaster = with_crust(false);
    static const StageInfo kStarting = with_ranking(kDrifting);
    static const StageInfo kFollowing = of_hypsography(kRaster);
    if (parameters_.model == "growth") return kSeen;
    if (parameters_.model == "raster") return kRaster;
    if (parameters_.model == "hypsography") return kFollowing;
    return parameters_.initial_elevation == "hypsography" ? kStarting : kDrifting;
  }
  [[nodiscard]] std::vector<Parameter> parameters() override { return parameters_.declarations(); }
  [[nodiscard]] StageCost cost(std::span<const Parameter> configuration) const override {
    constexpr double kMesh_s = 0.33;     // plates that grow, on a mesh of their own
    constexpr double kDrift_ns = 100.0;  // per sample and million years
    constexpr double kRivers_ns = 165.0;
    // 1200 steps of maps of 512 columns: on a torus, and on a lattice of samples on the sphere,
    // which outgrows the processor's caches.
    constexpr double kTorus_s = 0.96, kRaster_s = 11.0, kColumns = 512.0, kSteps = 1200.0;
    constexpr double kMoreColumns = 2.5;
    constexpr double kSample_bytes = 290.0;
    const std::string& model = parameters_.model;
    const bool is_full = parameters_.landscape == "full";
    const double step_ns =
        kDrift_ns + (is_full || parameters_.erosion == "rivers" ? kRivers_ns : 0.0);
    const double climates = is_full && find_parameter(configuration, "climate.model") != nullptr
                                ? 1.0 + parameters_.time_myr / parameters_.climate_myr
                                : 0.0;
    const double drift_s =
        1e-9 * step_ns * static_cast<double>(parameters_.samples) *
            (parameters_.time_myr + parameters_.spin_up_myr) +
        (climates > 0.0 ? climates * DriftLandscape::climate_seconds(configuration) : 0.0);
    const RasterParameters& raster = parameters_.raster;
    const double steps = static_cast<double>(raster.cycles * raster.cycle_steps) / kSteps;
    const double wider = static_cast<double>(raster.columns) / kColumns;
    const double torus_s = steps * wider * wider * kTorus_s;
    return {.per_cell_ns = 420.0,
            .fixed_s = model == "sphere"   ? drift_s
                       : model == "raster" ? torus_s
                       : model == "growth" ? kMesh_s
                                           : 0.0,
            .on_sphere_s = model == "raster"
                               ? steps * std::pow(wider, kMoreColumns) * kRaster_s - torus_s
                               : 0.0,
            .cell_bytes = 55.0,
            .fixed_bytes =
                model == "sphere" ? kSample_bytes * static_cast<double>(parameters_.samples) : 0.0};
  }

  void check(const Grid& grid,
             const std::function<bool(const FieldSpec&)>& /*has*/) const override {
    if (parameters_.landscape == "full" && parameters_.model != "sphere") {
      throw ConfigurationError(
          "plates.landscape = \"full\" is of plates that drift: plates.model must be \"sphere\"");
    }
    if (parameters_.model == "raster") check_rasters(parameters_, grid);
  }

  void run(StageIo& io, Context& context) const override {
    if (parameters_.model == "sphere") return drift(parameters_, info(), io, context);
    if (!context.plates.empty() || context.initial_elevation) {
      context.warnings.push_back(
          "fields.plates and fields.initial_elevation are for plates.model = sphere: not used");
    }
    if (parameters_.model == "hypsography") return draw_hypsography(parameters_, io, context);
    if (parameters_.model == "raster") return collide_rasters(parameters_, io, context);
    grow(parameters_, io, context);
  }

 private:
  /// Models with a history also write the crust that it made.
  static StageInfo with_crust(bool drifts) {
    StageInfo info =
        described({&field::crust_elevation, &field::crust_thickness, &field::orogeny_age,
                   &field::fold_direction_east, &field::fold_direction_north,
                   &field::ridge_direction_east, &field::ridge_direction_north});
    info.feels_events = drifts;
    if (drifts) info.writes.push_back(&field::subduction_polarity);
    return info;
  }
  static StageInfo described(std::initializer_list<const FieldSpec*> crust) {
    StageInfo info{"plates",
                   "tectonic plates, their motion, boundaries, sea floor and continents",
                   {},
                   {},
                   {&field::plate_id, &field::continental_fraction, &field::plate_velocity_east,
                    &field::plate_velocity_north, &field::boundary_type, &field::boundary_strength,
                    &field::crust_age, &field::orogeny_type, &field::heat_anomaly}};
    info.writes.insert(info.writes.end(), crust);
    return info;
  }
  static StageInfo with_ranking(StageInfo info) {
    info.optional.push_back(&field::ranking);
    return info;
  }
  /// Densities come with the heights; nothing moves that an event could turn.
  static StageInfo of_hypsography(StageInfo info) {
    info.writes.push_back(&field::crust_density);
    return with_ranking(std::move(info));
  }

  PlatesParameters parameters_;
};

}  // namespace

std::unique_ptr<Stage> make_plates_stage(PlatesParameters parameters) {
  return std::make_unique<PlatesStage>(std::move(parameters));
}

}  // namespace geo
