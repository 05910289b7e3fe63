#include "climate_of_land.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "geo/kernels/remapping/resample.hpp"
#include "geo/stages/climate/climate.hpp"

namespace geo {
namespace {

constexpr int kMostColumns = 512;

/// The stage `climate` with the settings that it has in a run; currents of the sea are left out.
std::unique_ptr<Stage> climate_stage_of(std::span<const Parameter> configuration) {
  ClimateParameters land;
  land.solves_currents = false;
  auto stage = make_climate_stage(land);
  for (const Parameter& parameter : stage->parameters()) {
    if (const Parameter* outside = find_parameter(configuration, parameter.name)) {
      parameter.set(outside->value());
    }
  }
  return stage;
}

}  // namespace

bool has_climate(const Grid& grid, const Context& context) {
  return grid.topology() == Topology::sphere &&
         find_parameter(context.configuration, "climate.model") != nullptr;
}

LandClimate climate_of_land(const Grid& grid, std::span<const float> elevation_m,
                            std::span<const float> ice_m, Context& context) {
  const int nx = std::min(grid.nx(), kMostColumns);
  const int ny = std::min(grid.ny(), kMostColumns / 2);
  State scratch(std::make_shared<const Grid>(Grid::sphere(nx, ny, grid.figure())));
  const Raster fine = raster_of(grid), coarse = raster_of(scratch.grid());
  const std::span<float> height_m = scratch.update(field::elevation);
  resample_raster(fine, elevation_m, coarse, height_m, grid.figure());
  if (!ice_m.empty()) {
    resample_raster(fine, ice_m, coarse, scratch.update(field::ice_thickness), grid.figure());
  }

  const auto stage = climate_stage_of(context.configuration);
  Context inner;
  inner.planet = context.planet;
  inner.seed = context.seed;
  inner.stop = context.stop;
  StageIo io(scratch, stage->info());
  stage->run(io, inner);

  LandClimate climate;
  climate.between = std::make_shared<const RowResampling>(coarse, fine, grid.figure());
  const auto keep = [](std::span<const float> values) {
    return std::vector<float>(values.begin(), values.end());
  };
  climate.precipitation_mm_yr = keep(scratch.read(field::precipitation));
  climate.potential_mm_yr = keep(scratch.read(field::potential_evapotranspiration));
  climate.range_k = keep(scratch.read(field::temperature_range));
  climate.sea_level_temperature_c = keep(scratch.read(field::temperature));
  for (std::size_t c = 0; c < height_m.size(); ++c) {
    climate.sea_level_temperature_c[c] += kLapse_K_m * std::max(0.0F, height_m[c]);
  }
  return climate;
}

double climate_of_land_seconds(std::span<const Parameter> configuration) {
  return climate_stage_of(configuration)->cost(configuration).fixed_s;
}

}  // namespace geo
