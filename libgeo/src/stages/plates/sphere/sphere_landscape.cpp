#include "sphere_landscape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/kernels/plates/sphere/surface/sphere_water.hpp"
#include "geo/kernels/remapping/resample.hpp"
#include "geo/kernels/water/water_balance.hpp"
#include "stages/erosion/climate_of_land.hpp"
#include "stages/erosion/icy_climate.hpp"

namespace geo {
namespace {

constexpr int kColumns = 360, kRows = 180;
/// Air of ages, over that of today.
constexpr double kCoarser = 1.5;
/// Of sea water that as much ice leaves.
constexpr double kWaterOfIce = 0.9;

/// As the stage erosion has them, in a time that no cold one came before.
ErosionParameters land_of(const Context& context) {
  ErosionParameters land;
  take_values(land.declarations(), context.configuration);
  land.glacial_share = 0.0;
  return land;
}

/// The cell of a whole planet that holds a place (unit vector in the frame of its noise).
Index cell_at(const Grid& grid, const Vector3& place) {
  constexpr double kDegrees = 57.29577951308232;
  const Vector3 at = grid.to_axis(place);
  const double latitude = kDegrees * std::asin(std::clamp(at[2], -1.0, 1.0));
  const double longitude = kDegrees * std::atan2(at[1], at[0]);
  const auto row = static_cast<int>(std::floor((latitude + 90.0) / 180.0 * grid.ny()));
  const double east = (longitude - grid.window().west_deg) / 360.0;
  const auto column = static_cast<int>(std::floor((east - std::floor(east)) * grid.nx()));
  return grid.cell(std::clamp(column, 0, grid.nx() - 1), std::clamp(row, 0, grid.ny() - 1));
}

}  // namespace

std::vector<const FieldSpec*> DriftLandscape::fields() {
  return {&field::elevation,     &field::sediment_thickness, &field::discharge,
          &field::precipitation, &field::temperature,        &field::ice_thickness};
}

double DriftLandscape::climate_seconds(std::span<const Parameter> configuration) {
  return warm_ice_seconds(configuration) +
         climate_of_land_seconds(configuration, {.coarser = kCoarser});
}

DriftLandscape::DriftLandscape(const PlatesParameters& parameters, const Grid& grid,
                               Context& context)
    : interval_myr_(parameters.climate_myr),
      context_(context),
      land_(land_of(context)),
      grid_(
          std::make_shared<const Grid>(Grid::sphere(kColumns, kRows, grid.figure(), grid.turn()))),
      climate_myr_(std::numeric_limits<double>::quiet_NaN()) {
  if (!has_climate(grid, context)) {
    throw ConfigurationError(
        "plates.landscape = \"full\" needs a run that has the stage climate, on a whole sphere");
  }
}

bool DriftLandscape::is_due(std::int64_t before, std::int64_t after, double step_myr) const {
  const auto turns = [&](std::int64_t steps) {
    return std::floor(static_cast<double>(steps) * step_myr / interval_myr_ + 1e-9);
  };
  return turns(after) > turns(before);
}

/// Above the sea, m, of what lies on top in each cell.
std::vector<float> DriftLandscape::surface_m(const SphereTectonics& model) const {
  constexpr float kGap_m = -2600.0F;  // new floor
  const SphereCrust& crust = model.state.crust;
  const auto sea_level_m = static_cast<float>(model.state.sea_level_m);
  std::vector<float> height_m(static_cast<std::size_t>(grid_->size()), kGap_m);
  const auto height_at = [&](const Vector3& place) {
    const int plate = plate_at(model, place);
    if (plate < 0) return kGap_m;
    const SphereMesh::Place at = model.mesh->locate(back(model.frame[plate], place));
    double sum = 0.0, weights = 0.0;
    for (int k = 0; k < 3; ++k) {
      if (crust.plate[at.corner[k]] != plate) continue;
      sum += at.weight[k] * crust.elevation_m[at.corner[k]];
      weights += at.weight[k];
    }
    return weights > 0.0 ? static_cast<float>(sum / weights) - sea_level_m : kGap_m;
  };
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 4)
  for (int j = 0; j < kRows; ++j) {
    errors.guard([&] {
      for (int i = 0; i < kColumns; ++i) {
        height_m[grid_->cell(i, j)] = height_at(grid_->unit_vector(i, j));
      }
    });
  }
  errors.rethrow();
  return height_m;
}

/// With ice, which has the climate of its coarse air; rain and warmth are those of the run's own.
LandClimate DriftLandscape::climate_of(const SphereTectonics& model) {
  const std::vector<float> ground_m = surface_m(model);
  std::vector<float> ice_m;
  if (land_.freezes()) ice_m = living_ice_m(land_, *grid_, ground_m, context_);
  std::vector<float> top_m = ground_m;
  for (std::size_t c = 0; c < ice_m.size(); ++c) top_m[c] += ice_m[c];
  LandClimate climate = climate_of_surface(grid_, top_m, ice_m, {kCoarser}, context_);
  climate.ice_m.resize(ground_m.size(), 0.0F);
  return climate;
}

double DriftLandscape::ice_km3() const {
  return 1e-9 * area_sum<double>(*grid_, [&](Index c) { return climate_.ice_m[c]; });
}

std::vector<float> DriftLandscape::runoff_at(const SphereMesh& mesh,
                                             const std::vector<float>& of_cells) const {
  std::vector<float> values(static_cast<std::size_t>(mesh.size()));
#pragma omp parallel for schedule(static)
  for (std::int32_t i = 0; i < mesh.size(); ++i) {
    values[i] = of_cells[cell_at(*grid_, mesh.samples().position(i))];
  }
  return values;
}

/// At time 0 the sea covers the planet's share of oceans; from then on its water is kept.
void DriftLandscape::fill_sea(SphereTectonics& model) const {
  SphereState& state = model.state;
  state.sea_level_m = level_above(model, 1.0 - context_.planet.ocean_fraction);
  state.water_km3 = sea_volume_km3(model, state.sea_level_m);
}

void DriftLandscape::turn_climate(SphereTectonics& crust, SphereTectonics* leader) {
  const bool is_first = crust.state.water_km3 <= 0.0;
  for (SphereTectonics* model : {&crust, leader}) {
    if (model != nullptr && is_first) fill_sea(*model);
  }
  climate_ = climate_of(crust);
  climate_myr_ = crust.state.time_myr;
  std::vector<float> runoff(static_cast<std::size_t>(grid_->size()));
#pragma omp parallel for schedule(static)
  for (std::size_t c = 0; c < runoff.size(); ++c) {
    const double rain = climate_.precipitation_mm_yr[c];
    const double shed = rain - land_evaporation(rain, climate_.potential_mm_yr[c]);
    runoff[c] =
        static_cast<float>(std::max(shed, land_.least_runoff_mm_yr) / land_.reference_runoff_mm_yr);
  }
  for (SphereTectonics* model : {&crust, leader}) {
    if (model == nullptr) continue;
    SphereState& state = model->state;
    state.runoff = runoff_at(*model->mesh, runoff);
    state.ice_km3 = kWaterOfIce * ice_km3();
    if (is_first) state.water_km3 += state.ice_km3;
  }
}

void DriftLandscape::draw(const SphereTectonics& model, const SphereTectonics& seen, StageIo& io) {
  if (!(climate_myr_ == model.state.time_myr)) {
    climate_ = climate_of(model);
    climate_myr_ = model.state.time_myr;
  }
  const Grid& grid = io.grid();
  const Raster from = raster_of(*grid_), to = raster_of(grid);
  const auto resample = [&](std::span<const float> values, std::span<float> out) {
    resample_raster(from, values, to, out, grid.figure());
  };
  const auto elevation_m = io.write(field::elevation);
  const auto sediment_m = io.write(field::sediment_thickness);
  const auto discharge_m3_s = io.write(field::discharge);
  const auto temperature_c = io.write(field::temperature);
  const auto ice_m = io.write(field::ice_thickness);
  resample(climate_.precipitation_mm_yr, io.write(field::precipitation));
  resample(climate_.sea_level_temperature_c, temperature_c);
  resample(climate_.ice_m, ice_m);
  const auto crust_m = io.write(field::crust_elevation);  // of this frame
  const std::vector<double> drained = drained_km2(seen);
  const double m3_s_per_km2 = 1e3 * land_.reference_runoff_mm_yr / kSecondsPerYear;
  const auto sea_level_m = static_cast<float>(seen.state.sea_level_m);
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 4)
  for (int j = 0; j < grid.ny(); ++j) {
    errors.guard([&] {
      for (int i = 0; i < grid.nx(); ++i) {
        const Index c = grid.cell(i, j);
        const Vector3 place = grid.unit_vector(i, j);
        const std::int32_t nearest = seen.mesh->samples().nearest(place);
        const SphereMesh::Place at = seen.mesh->locate(place, nearest);
        double thick_m = 0.0;
        for (int k = 0; k < 3; ++k) {
          thick_m += at.weight[k] * seen.state.crust.sediment_m[at.corner[k]];
        }
        sediment_m[c] = static_cast<float>(std::max(0.0, thick_m));
        const float ground_m = crust_m[c] - sea_level_m;
        const bool is_land = ground_m >= 0.0F;
        discharge_m3_s[c] = is_land ? static_cast<float>(m3_s_per_km2 * drained[nearest]) : 0.0F;
        if (!is_land) ice_m[c] = 0.0F;
        elevation_m[c] = ground_m + ice_m[c];
        temperature_c[c] -= kLapse_K_m * std::max(0.0F, elevation_m[c]);
      }
    });
  }
  errors.rethrow();
}

}  // namespace geo
