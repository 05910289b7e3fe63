#include "island_climate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/climate/blueprint_climate.hpp"
#include "geo/kernels/climate/distance_to_coast.hpp"
#include "geo/kernels/climate/orography.hpp"
#include "geo/kernels/landscape/surface_detail.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/kernels/remapping/catmull_rom.hpp"
#include "geo/kernels/remapping/conservative_remapping.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

/// Sum over the year of the warmth that potential evapotranspiration grows with, T + 5 degC where
/// positive, for a harmonic year.
double evaporating_warmth(double mean_c, double range_k) {
  constexpr int kSteps = 12;
  static const std::array<double, kSteps> kPhase = [] {
    std::array<double, kSteps> phase{};
    for (int m = 0; m < kSteps; ++m) {
      phase[m] = 0.5 * std::cos(2.0 * std::numbers::pi * (m + 0.5) / kSteps);
    }
    return phase;
  }();
  double sum = 0.0;
  for (const double phase : kPhase) sum += std::max(0.0, mean_c + 5.0 + range_k * phase);
  return sum / kSteps;
}

/// Direction of true north against the grid's, as its components along the grid's axes.
std::array<double, 2> north_on_grid(const Grid& grid, int i, int j) {
  const int below = std::max(0, j - 1), above = std::min(grid.ny() - 1, j + 1);
  const auto from = grid.unit_vector(i, below), to = grid.unit_vector(i, above);
  const auto here = grid.unit_vector(i, j);
  // Local east and north of the planet, against the step along a column of the grid.
  const double ring = std::hypot(here[0], here[1]);
  if (ring < 1e-9) return {0.0, 1.0};
  const std::array<double, 3> east{-here[1] / ring, here[0] / ring, 0.0};
  const std::array<double, 3> north{-here[2] * here[0] / ring, -here[2] * here[1] / ring, ring};
  double along_east = 0.0, along_north = 0.0;
  for (int k = 0; k < 3; ++k) {
    along_east += east[k] * (to[k] - from[k]);
    along_north += north[k] * (to[k] - from[k]);
  }
  const double length = std::hypot(along_east, along_north);
  if (length == 0.0) return {0.0, 1.0};
  return {-along_east / length, along_north / length};
}

/// A coarser plane over the same area, for what the air does not feel in more detail.
Grid air_grid(const Grid& fine, double spacing_m) {
  const double width_m = fine.nx() * fine.spacing_east_m(0);
  const double height_m = fine.ny() * fine.step_north_m();
  const int nx = std::clamp(static_cast<int>(std::lround(width_m / spacing_m)), 8, fine.nx());
  const int ny = std::clamp(static_cast<int>(std::lround(height_m / spacing_m)), 8, fine.ny());
  return Grid::plane(nx, ny, width_m / nx, height_m / ny, Edges::open);
}

/// How much higher the fine surface lifts the air than the interpolated one, m, on the air grid.
std::vector<float> extra_lift(const Grid& fine, const ConservativeRemapping& remapping,
                              const IslandHeights& heights, std::span<const float> wind_east,
                              std::span<const float> wind_north, double reach_m) {
  const Grid& air = remapping.coarse();
  const auto size = static_cast<std::size_t>(air.size());
  std::vector<float> land(size), coverage(size), own(size), planets(size);
  remapping.average_elevation(heights.elevation_m, land, own, coverage);
  remapping.average_elevation(heights.interpolated_m, land, planets, coverage);
  std::vector<float> east(size), north(size);
  for (Index c = 0; c < air.size(); ++c) {
    const int i =
        std::min(fine.nx() - 1, static_cast<int>((air.column(c) + 0.5) * fine.nx() / air.nx()));
    const int j =
        std::min(fine.ny() - 1, static_cast<int>((air.row(c) + 0.5) * fine.ny() / air.ny()));
    const Index at = fine.cell(i, j);
    const auto up = north_on_grid(fine, i, j);
    east[c] = static_cast<float>(wind_east[at] * up[1] + wind_north[at] * up[0]);
    north[c] = static_cast<float>(wind_north[at] * up[1] - wind_east[at] * up[0]);
  }
  std::vector<float> lift(size), smooth_lift(size);
  upwind_lift(air, own, east, north, reach_m, lift);
  upwind_lift(air, planets, east, north, reach_m, smooth_lift);
  for (std::size_t c = 0; c < size; ++c) lift[c] -= smooth_lift[c];
  return lift;
}

/// What the run's model of climate makes of a place itself, where it is and how high; all else is
/// the planet's and is interpolated.
class PlaceLaw {
 public:
  PlaceLaw(const PlanetCells& cells, const ClimateParameters& climate, const IslandAir& air,
           std::span<const float> planet_elevation_m, const ClimateFields<const float>& from)
      : model_(climate.blueprint),
        closed_(climate.model == "blueprint"),
        lapse_k_m_(climate.seasonal.energy.lapse_k_m),
        air_(air),
        warmth_(cells.size()),
        moisture_(cells.size()) {
    const Grid& planet = cells.planet();
    for (int j = cells.first_row(); j < cells.first_row() + cells.rows(); ++j) {
      for (int i = 0; i < planet.nx(); ++i) {
        const Index c = planet.cell(i, j);
        const Place place{planet.latitude_deg(j), planet_elevation_m[c], from.distance_to_coast[c]};
        warmth_[cells.at(i, j)] = static_cast<float>(from.temperature[c] - temperature_c(place));
        moisture_[cells.at(i, j)] = moisture_mm_yr(place, from.precipitation[c]);
      }
    }
  }

  struct Place {
    double latitude_deg, elevation_m, coast_m;
  };
  /// Temperature of the place, up to what is interpolated.
  [[nodiscard]] double temperature_c(const Place& at) const {
    if (!closed_) return -lapse_k_m_ * std::max(0.0, at.elevation_m);
    return blueprint_temperature_c(model_, at.latitude_deg, at.elevation_m, 1e-3 * at.coast_m,
                                   air_.pressure_bar);
  }
  /// Precipitation of the place with the interpolated moisture and lift over the planet's surface.
  [[nodiscard]] double precipitation_mm_yr(const Place& at, double moisture_mm_yr, double lift_m,
                                           double lift_height_m) const {
    if (!closed_) return moisture_mm_yr * std::exp(std::clamp(lift_m / lift_height_m, -1.0, 1.0));
    return blueprint_precipitation_mm_yr(model_, hadley_precipitation_mm_yr(at.latitude_deg),
                                         moisture_mm_yr + model_.lift_mm_yr_m * lift_m,
                                         at.elevation_m, 1e-3 * at.coast_m, air_.pressure_bar, 0.0,
                                         air_.aerosol);
  }
  /// What is to be interpolated, on the covered cells of the planet.
  [[nodiscard]] std::span<const float> warmth() const { return warmth_; }
  [[nodiscard]] std::span<const float> moisture() const { return moisture_; }
  [[nodiscard]] double least_moisture_mm_yr() const { return closed_ ? -1e9 : 0.0; }

 private:
  /// Rain, or what wind and topography add to the blueprint's (5.5-5.8): eq. 5.10 backwards.
  [[nodiscard]] float moisture_mm_yr(const Place& at, double rain_mm_yr) const {
    if (!closed_) return static_cast<float>(rain_mm_yr);
    if (at.elevation_m < 0.0)
      return static_cast<float>(model_.windward_mm_yr + model_.coastal_mm_yr);
    const double altitude = std::max(0.1, std::exp(-at.elevation_m * model_.altitude_decay_1_m));
    const double inland = std::exp(-1e-3 * at.coast_m / model_.continental_decay_km);
    const double all = (rain_mm_yr + air_.aerosol * model_.aerosol_mm_yr) /
                       (std::sqrt(air_.pressure_bar) * altitude);
    return static_cast<float>(all - inland * hadley_precipitation_mm_yr(at.latitude_deg));
  }

  const BlueprintClimate& model_;
  bool closed_;
  double lapse_k_m_;
  IslandAir air_;
  std::vector<float> warmth_, moisture_;
};

/// Everything but lift. Precipitation is the interpolated moisture still.
void interpolate_climate(const PlanetCells& cells, const PlaceLaw& law,
                         const IslandHeights& heights, const ClimateFields<const float>& from,
                         const ClimateFields<float>& to) {
  const Grid& fine = cells.fine();
#pragma omp parallel for schedule(static)
  for (int j = 0; j < fine.ny(); ++j) {
    for (int i = 0; i < fine.nx(); ++i) {
      const Index c = fine.cell(i, j);
      const Centre position = fine.position(i, j);
      const CatmullRom stencil(cells.planet(), position);
      const auto take = [&](std::span<const float> values) {
        return static_cast<float>(stencil.of(values));
      };
      const auto covered = [&](std::span<const float> values) {
        return stencil.of([&](int column, int row) { return values[cells.at(column, row)]; });
      };
      const double warmth = covered(law.warmth());
      const auto temperature_at = [&](double height_m, double coast_m) {
        return warmth + law.temperature_c({position.latitude_deg, height_m, coast_m});
      };
      to.temperature[c] =
          static_cast<float>(temperature_at(heights.elevation_m[c], to.distance_to_coast[c]));
      to.temperature_range[c] = std::max(0.0F, take(from.temperature_range));
      to.precipitation[c] =
          static_cast<float>(std::max(law.least_moisture_mm_yr(), covered(law.moisture())));
      to.precipitation_seasonality[c] =
          std::clamp(take(from.precipitation_seasonality), -1.0F, 1.0F);
      to.wind_east[c] = static_cast<float>(stencil.of(from.wind_east, -1.0));
      to.wind_north[c] = static_cast<float>(stencil.of(from.wind_north, -1.0));
      const double planets_c =
          temperature_at(heights.interpolated_m[c], std::max(0.0F, take(from.distance_to_coast)));
      const double usual = evaporating_warmth(planets_c, to.temperature_range[c]);
      const double here = evaporating_warmth(to.temperature[c], to.temperature_range[c]);
      constexpr double kMost = 3.0;
      const double ratio = usual > 0.1 ? std::min(here / usual, kMost) : 1.0;
      to.potential_evapotranspiration[c] =
          static_cast<float>(std::max(0.0F, take(from.potential_evapotranspiration)) * ratio);
    }
  }
}

/// Fine distances are right as far as the edge; a coast beyond it only the planet knows.
void measure_coast(const PlanetCells& cells, std::span<const float> elevation_m,
                   std::span<const float> planets_m, std::span<float> distance_m) {
  const Grid& fine = cells.fine();
  distance_to_coast(fine, elevation_m, distance_m);
#pragma omp parallel for schedule(static)
  for (int j = 0; j < fine.ny(); ++j) {
    for (int i = 0; i < fine.nx(); ++i) {
      const Index c = fine.cell(i, j);
      const double to_edge_m =
          std::min((std::min(i, fine.nx() - 1 - i) + 0.5) * fine.spacing_east_m(j),
                   (std::min(j, fine.ny() - 1 - j) + 0.5) * fine.step_north_m());
      if (distance_m[c] <= to_edge_m) continue;
      const double beyond_m =
          std::max(to_edge_m, CatmullRom(cells.planet(), fine.position(i, j)).of(planets_m));
      distance_m[c] = static_cast<float>(std::min<double>(distance_m[c], beyond_m));
    }
  }
}

/// Divides rain by the mean of its factors over each planet cell.
void share_out(const PlanetCells& cells, std::span<const float> factor, std::span<float> rain) {
  const Grid& fine = cells.fine();
  const std::vector<float> mean = cells.means(factor, {}, 1.0F);
#pragma omp parallel for schedule(static)
  for (int j = 0; j < fine.ny(); ++j) {
    for (int i = 0; i < fine.nx(); ++i) {
      const double ramp = edge_ramp(fine, i, j, cells.planet().face_east_m(0));
      const double shared = std::max(0.1, cells.interpolate(mean, i, j));
      rain[fine.cell(i, j)] /= static_cast<float>(std::lerp(1.0, shared, ramp));
    }
  }
}

}  // namespace

void island_climate(const PlanetCells& cells, const ClimateParameters& climate,
                    const IslandAir& air_above, const IslandParameters& p,
                    const IslandHeights& heights, const ClimateFields<const float>& from,
                    const ClimateFields<float>& to) {
  const Grid& fine = cells.fine();
  measure_coast(cells, heights.elevation_m, from.distance_to_coast, to.distance_to_coast);
  const PlaceLaw law(cells, climate, air_above, heights.planet_elevation_m, from);
  interpolate_climate(cells, law, heights, from, to);

  const double reach_m = 1000.0 * p.lift_reach_km;
  const Grid air = air_grid(fine, std::max(0.2 * reach_m, p.cell_m));
  const ConservativeRemapping remapping(fine, air);
  const auto lift = extra_lift(fine, remapping, heights, to.wind_east, to.wind_north, reach_m);
  const Interpolator lift_of(remapping, lift);
  ParallelErrors errors;
  // What the air loses over one part of a planet cell the rest lacks: the mean is the planet's.
  std::vector<float> ascent(to.precipitation.size());
#pragma omp parallel
  {
    auto scratch = errors.make<std::vector<float>>(lift_of.scratch_size());
    auto lifted = errors.make<std::vector<float>>(fine.nx());
#pragma omp for schedule(static)
    for (int j = 0; j < fine.ny(); ++j) {
      if (errors.any()) continue;
      lift_of.row(j, lifted, scratch);
      for (int i = 0; i < fine.nx(); ++i) {
        const double ramp = edge_ramp(fine, i, j, cells.planet().face_east_m(0));
        const Index c = fine.cell(i, j);
        float& rain = to.precipitation[c];
        const float level_rain = rain;
        rain = static_cast<float>(law.precipitation_mm_yr(
            {fine.position(i, j).latitude_deg, heights.elevation_m[c], to.distance_to_coast[c]},
            rain, ramp * lifted[i], climate.lift_height_m));
        ascent[c] = level_rain > 0.0F ? rain / level_rain : 1.0F;
      }
    }
  }
  errors.rethrow();
  if (climate.model != "blueprint") share_out(cells, ascent, to.precipitation);
  smooth(fine, to.temperature, 1000.0 * p.climate_smoothing_km);
  smooth(fine, to.precipitation, 1000.0 * p.climate_smoothing_km);
}

}  // namespace geo
