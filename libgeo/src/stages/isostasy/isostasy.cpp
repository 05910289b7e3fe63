#include "geo/stages/isostasy/isostasy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>
#include <utility>

#include "blueprint_crust.hpp"
#include "geo/core/error.hpp"
#include "geo/stages/erosion/ground.hpp"
#include "geo/stages/isostasy/floating_crust.hpp"
#include "geo/stages/isostasy/freeboard.hpp"
#include "geo/stages/isostasy/rocks.hpp"
#include "geo/stages/isostasy/sea_level.hpp"
#include "given_crust.hpp"
#include "guided_by_folds.hpp"
#include "land_detail.hpp"
#include "sea_floor_fabric.hpp"
#include "torus_crust.hpp"

namespace geo {
namespace {

/// Whether margins and the sea floor have the sediment of their age.
bool knows_sediment(const IsostasyParameters& p) {
  return p.crust == "margins" || p.crust == "simulated";
}

bool keeps_made_crust(const IsostasyParameters& p) {
  return p.crust == "simulated" || p.crust == "given";
}

/// What floats on the mantle is lighter than it.
void check_densities(const ColumnDensities& density) {
  const std::pair<std::string_view, double> floating[] = {
      {"continental", density.continental_crust},
      {"oceanic", density.oceanic_crust},
      {"water", density.water}};
  for (const auto& [what, kg_m3] : floating) {
    if (kg_m3 < density.mantle) continue;
    throw ConfigurationError(
        fmt::format("isostasy.{}_density_kg_m3 = {:g}: must be less than "
                    "isostasy.mantle_density_kg_m3 = {:g}",
                    what, kg_m3, density.mantle));
  }
}

[[noreturn]] void refuse_crust(const IsostasyParameters& p) {
  throw ConfigurationError("isostasy.crust = \"" + p.crust +
                           "\" needs crust_elevation and crust_thickness, which plates.model = "
                           "\"sphere\", \"raster\" and \"hypsography\" write");
}

std::span<const float> made_by_plates(const IsostasyParameters& p, const StageIo& io) {
  const auto elevation_m = io.read_optional(field::crust_elevation);
  const auto thickness_m = io.read_optional(field::crust_thickness);
  if (elevation_m.empty() || thickness_m.empty()) refuse_crust(p);
  return elevation_m;
}

/// How long erosion lets belts grow in this configuration; by its defaults where it has none.
double growth_of_belts(const IsostasyParameters& p, std::span<const Parameter> configuration) {
  if (p.crust != "margins") return 0.0;
  ErosionParameters erosion;
  for (const Parameter& own : erosion.declarations()) {
    if (const Parameter* given = find_parameter(configuration, own.name)) own.set(given->value());
  }
  return geo::growth_of_belts_myr<float>(erosion, {});
}

Crust<float> open_crust(const IsostasyParameters& parameters, StageIo& io, const Context& context) {
  return {.parameters = parameters,
          .planet = context.planet,
          .seed = context.seed,
          .grid = io.grid(),
          .in = {.plate = io.read(field::plate_id),
                 .boundary_type = io.read(field::boundary_type),
                 .boundary_strength = io.read(field::boundary_strength),
                 .age_myr = io.read(field::crust_age),
                 .heat = io.read(field::heat_anomaly),
                 .velocity_east = io.read(field::plate_velocity_east),
                 .velocity_north = io.read(field::plate_velocity_north),
                 .made_elevation_m = keeps_made_crust(parameters) ? made_by_plates(parameters, io)
                                                                  : std::span<const float>{},
                 .has_density = !io.read_optional(field::crust_density).empty()},
          .fraction = io.write(field::continental_fraction),
          .convergent = io.write(field::convergent_deformation),
          .divergent = io.write(field::divergent_deformation),
          .transform = io.write(field::transform_deformation),
          .weakness = io.write(field::lithospheric_weakness),
          .thickness_m = io.write(field::crust_thickness),
          .density = io.write(field::crust_density),
          .rock = io.write(field::rock_type),
          .erodibility = io.write(field::erodibility),
          .elevation_m = io.write(field::elevation),
          .thickening_m_yr = io.write(field::thickening_rate),
          .sediment_m =
              knows_sediment(parameters) ? io.write(field::sediment_thickness) : std::span<float>{},
          .run_myr = growth_of_belts(parameters, context.configuration)};
}

void float_crust(const Crust<float>& crust, const CoarseGrid& coarse, const Context& context) {
  const TectonicFrame frame =
      tectonic_frame(crust.parameters, coarse, crust.in, crust.fraction, crust.seed);
  context.advance(0.3);
  if (crust.parameters.crust == "blueprint") {
    draw_blueprint_crust(crust, coarse, deform(crust, coarse, frame));
    stiffen_blueprint(crust, coarse);
  } else if (crust.parameters.crust == "given") {
    Tectonics<float> tectonics = deform(crust, coarse, frame);
    cut_sections(crust, coarse, frame, tectonics);
    take_given_crust(crust, coarse, tectonics);
  } else {
    float_margins_crust(crust, coarse, frame);
  }
}

float level_of_sea_m(const Crust<float>& crust) {
  return static_cast<float>(sea_level_m(crust.grid, crust.elevation_m, crust.planet));
}

void settle(const Crust<float>& crust, Budget& budget) {
  std::vector<std::uint8_t> wet(crust.grid.size());
  double& rise_m = budget["continental_rise_m"];
  for (int time = 0; time < kSettlings; ++time) {
    const float level_m = level_of_sea_m(crust);
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < crust.grid.size(); ++cell) {
      wet[cell] = crust.elevation_m[cell] < level_m;
    }
    rise_m += settle_continents(crust, level_m, wet);
  }
}

/// Whether continents settle about a floor that lies as deep as its age: plates that made the crust
/// have put it there, and the sea covers a share of the area.
bool settles_about_floor(const IsostasyParameters& p, const Planet& planet) {
  return p.crust == "simulated" && p.ocean_depth_m <= 0.0 && planet.sea_level == "fraction";
}

/// All continental crust rises or sinks until the sea that covers its share stands at the datum
/// from which the floor's depth counts.
void settle_about_floor(const Crust<float>& crust, Budget& budget) {
  constexpr int kMost = 8;
  constexpr float kMet_m = 1.0F;
  const auto density = crust.densities();
  const double thickening = 1.0 / (1.0 - density.continental_crust / density.mantle);
  double& all_m = budget["continental_rise_m"];
  for (int time = 0; time < kMost; ++time) {
    const float rise_m = -level_of_sea_m(crust);
    if (std::abs(rise_m) < kMet_m) break;
    all_m += rise_m;
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < crust.grid.size(); ++cell) {
      const float share = crust.fraction[cell];
      crust.elevation_m[cell] += rise_m * share;
      crust.thickness_m[cell] = static_cast<float>(
          std::clamp(crust.thickness_m[cell] + thickening * rise_m * share, 3e3, 80e3));
    }
  }
}

void report(const Crust<float>& crust, Budget& budget) {
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

const StageInfo& stage_info() {
  static const StageInfo kInfo{
      "isostasy",
      "crust, rock and the height at which they float",
      {&field::plate_id, &field::continental_fraction, &field::boundary_type,
       &field::boundary_strength, &field::crust_age, &field::heat_anomaly,
       &field::plate_velocity_east, &field::plate_velocity_north},
      {&field::crust_elevation, &field::crust_thickness, &field::crust_density,
       &field::ridge_direction_east, &field::ridge_direction_north},
      {&field::convergent_deformation, &field::divergent_deformation, &field::transform_deformation,
       &field::lithospheric_weakness, &field::continental_fraction, &field::crust_thickness,
       &field::crust_density, &field::rock_type, &field::erodibility, &field::elevation,
       &field::thickening_rate}};
  return kInfo;
}

StageInfo covered_by_sediment(StageInfo info) {
  info.writes.push_back(&field::sediment_thickness);
  return info;
}

class IsostasyStage final : public Stage {
 public:
  explicit IsostasyStage(IsostasyParameters parameters) : parameters_(std::move(parameters)) {}

  [[nodiscard]] const StageInfo& info() const override {
    static const StageInfo kCovered = covered_by_sediment(stage_info());
    static const StageInfo kGuided = guided_by_folds(stage_info());
    static const StageInfo kGuidedCovered = guided_by_folds(kCovered);
    if (knows_sediment(parameters_)) return follows_exemplars() ? kGuidedCovered : kCovered;
    return follows_exemplars() ? kGuided : stage_info();
  }
  [[nodiscard]] std::vector<Parameter> parameters() override { return parameters_.declarations(); }
  [[nodiscard]] StageCost cost(std::span<const Parameter> /*configuration*/) const override {
    return {.per_cell_ns = 650.0, .cell_bytes = 117.0};
  }

  void check(const Grid& /*grid*/,
             const std::function<bool(const FieldSpec&)>& has) const override {
    check_densities(parameters_.density);
    const bool has_crust = has(field::crust_elevation) && has(field::crust_thickness);
    if (keeps_made_crust(parameters_) && !has_crust) refuse_crust(parameters_);
  }

  void run(StageIo& io, Context& context) const override {
    const bool on_torus = io.grid().topology() == Topology::torus;
    if (io.grid().topology() == Topology::plane) {
      throw InputError("isostasy: the grid must be a whole sphere or a torus");
    }
    const Crust<float> crust = open_crust(parameters_, io, context);
    std::fill(crust.sediment_m.begin(), crust.sediment_m.end(), 0.0F);
    if (on_torus) return settle_torus(crust, context);
    const CoarseGrid coarse(crust.grid);
    float_crust(crust, coarse, context);
    context.advance(0.8);
    if (settles_continents(parameters_, crust.planet)) settle(crust, context.budget);
    if (settles_about_floor(parameters_, crust.planet)) settle_about_floor(crust, context.budget);
    const float level_m = level_of_sea_m(crust);
    fill_sea(crust, level_m);
    context.budget["sea_level_shift_m"] = level_m;
    engrave_sea_floor(crust, coarse, io.read_optional(field::ridge_direction_east),
                      io.read_optional(field::ridge_direction_north));
    if (follows_exemplars()) detail_land_like_exemplars(crust, coarse, io, context);
    classify_rock(crust);
    report(crust, context.budget);
  }

 private:
  static void settle_torus(const Crust<float>& crust, Context& context) {
    take_torus_crust(crust);
    context.advance(0.8);
    const float level_m = level_of_sea_m(crust);
    fill_sea(crust, level_m);
    context.budget["sea_level_shift_m"] = level_m;
    classify_rock(crust);
    report(crust, context.budget);
  }
  [[nodiscard]] bool follows_exemplars() const { return parameters_.detail == "exemplars"; }

  static void detail_land_like_exemplars(const Crust<float>& crust, const CoarseGrid& coarse,
                                         const StageIo& io, const Context& context) {
    auto library = context.planet_exemplars;
    if (!library) {
      library = std::make_shared<const ExemplarLibrary>(grow_exemplars(kGrownForPlanets));
    }
    detail_land(crust, coarse,
                {.type = io.read_optional(field::orogeny_type),
                 .age_myr = io.read_optional(field::orogeny_age),
                 .fold_east = io.read_optional(field::fold_direction_east),
                 .fold_north = io.read_optional(field::fold_direction_north)},
                *library);
  }

  IsostasyParameters parameters_;
};

}  // namespace

std::unique_ptr<Stage> make_isostasy_stage(IsostasyParameters parameters) {
  return std::make_unique<IsostasyStage>(std::move(parameters));
}

}  // namespace geo
