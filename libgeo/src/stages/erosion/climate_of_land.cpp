#include "climate_of_land.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "geo/kernels/remapping/resample.hpp"
#include "geo/stages/climate/climate.hpp"

namespace geo {
namespace {

constexpr int kMostColumns = 512;

/// The stage `climate` with the settings that it has in a run, in the air of another time; currents
/// of the sea are left out.
std::unique_ptr<Stage> climate_stage_of(std::span<const Parameter> configuration,
                                        const AirOfTime& air) {
  ClimateParameters land;
  land.solves_currents = false;
  land.colder_k = air.colder_k;
  auto stage = make_climate_stage(land);
  const std::vector<Parameter> settings = stage->parameters();
  take_values(settings, configuration);
  const Parameter* spacing = find_parameter(settings, "climate.resolution_deg");
  spacing->set(std::min(spacing->max, air.coarser * std::get<double>(spacing->value())));
  return stage;
}

}  // namespace

bool has_climate(const Grid& grid, const Context& context) {
  return grid.topology() == Topology::sphere &&
         find_parameter(context.configuration, "climate.model") != nullptr;
}

Grid climate_grid(const Grid& grid) {
  return Grid::sphere(std::min(grid.nx(), kMostColumns), std::min(grid.ny(), kMostColumns / 2),
                      grid.figure());
}

LandClimate climate_of_surface(const std::shared_ptr<const Grid>& grid,
                               std::span<const float> surface_m, std::span<const float> ice_m,
                               const AirOfTime& air, Context& context) {
  State scratch(grid);
  const std::span<float> height_m = scratch.update(field::elevation);
  std::copy(surface_m.begin(), surface_m.end(), height_m.begin());
  if (!ice_m.empty()) {
    std::copy(ice_m.begin(), ice_m.end(), scratch.update(field::ice_thickness).begin());
  }
  const auto stage = climate_stage_of(context.configuration, air);
  Context inner;
  inner.planet = context.planet;
  inner.seed = context.seed;
  inner.stop = context.stop;
  StageIo io(scratch, stage->info());
  stage->run(io, inner);

  LandClimate climate;
  const auto keep = [](std::span<const float> values) {
    return std::vector<float>(values.begin(), values.end());
  };
  climate.precipitation_mm_yr = keep(scratch.read(field::precipitation));
  climate.potential_mm_yr = keep(scratch.read(field::potential_evapotranspiration));
  climate.range_k = keep(scratch.read(field::temperature_range));
  climate.summer_rain = keep(scratch.read(field::precipitation_seasonality));
  climate.sea_level_temperature_c = keep(scratch.read(field::temperature));
  for (std::size_t c = 0; c < height_m.size(); ++c) {
    climate.sea_level_temperature_c[c] += kLapse_K_m * std::max(0.0F, height_m[c]);
  }
  climate.ice_m = keep(ice_m);
  return climate;
}

LandClimate climate_of_land(const Grid& grid, std::span<const float> elevation_m,
                            Context& context) {
  const auto coarse = std::make_shared<const Grid>(climate_grid(grid));
  std::vector<float> height_m(static_cast<std::size_t>(coarse->size()));
  const Raster fine = raster_of(grid), raster = raster_of(*coarse);
  resample_raster(fine, elevation_m, raster, height_m, grid.figure());
  LandClimate climate = climate_of_surface(coarse, height_m, {}, {}, context);
  climate.between = std::make_shared<const RowResampling>(raster, fine, grid.figure());
  return climate;
}

double climate_of_land_seconds(std::span<const Parameter> configuration, const AirOfTime& air) {
  return climate_stage_of(configuration, air)->cost(configuration).fixed_s;
}

}  // namespace geo
