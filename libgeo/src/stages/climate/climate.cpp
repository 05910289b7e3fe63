#include "geo/stages/climate/climate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "climate_events.hpp"
#include "fine_climate.hpp"
#include "geo/kernels/climate/circulation.hpp"
#include "geo/kernels/climate/distance_to_coast.hpp"
#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/kernels/remapping/conservative_remapping.hpp"
#include "geo/kernels/water/water_balance.hpp"
#include "orographic_ascent.hpp"

namespace geo {
namespace {

/// The model's constants on this planet: its sun's path, its air.
SeasonalClimate on_planet(SeasonalClimate model, const Planet& planet, double greenhouse_k,
                          double colder_k) {
  model.energy.orbit = {planet.obliquity_deg, planet.eccentricity, planet.perihelion_deg};
  const double warming_k = greenhouse_k * (std::log1p(planet.pressure_bar) - std::log1p(1.0));
  model.energy.outgoing_w_m2 -= model.energy.outgoing_slope_w_m2_k * (warming_k - colder_k);
  model.energy.diffusivity_w_m2_k *= planet.pressure_bar;  // the mass that carries the heat
  return model;
}

/// Tells how much of the surface was held at an end of the range; a warning unless the range is a
/// part of the model.
void report_limits(const Grid& grid, const TemperatureLimits& limits,
                   std::span<const std::int64_t> cells_of_row, bool part_of_model,
                   Context& context) {
  double held_m2 = 0.0;
  std::int64_t cells = 0;
  for (int j = 0; j < grid.ny(); ++j) {
    held_m2 += grid.area_m2(j) * static_cast<double>(cells_of_row[j]);
    cells += cells_of_row[j];
  }
  const double share = held_m2 / grid.total_area_m2();
  context.budget["temperature_held_share"] = share;
  if (cells == 0 || part_of_model) return;
  context.warnings.push_back(fmt::format(
      "climate: {:.3g} % of the area would be colder or warmer than the {:g} to {:g} degC "
      "that this air allows, and is held there",
      100.0 * share, limits.lowest_c, limits.highest_c));
}

/// Rain on the cells that `counts`.
template <class Counts>
double rain_m3_s(const Grid& grid, std::span<const float> rain_mm_yr, Counts&& counts) {
  return 1e-3 / kSecondsPerYear * area_sum<double>(grid, [&](Index cell) {
           return counts(cell) ? static_cast<double>(rain_mm_yr[cell]) : 0.0;
         });
}

double rain_m3_s(const Grid& grid, std::span<const float> rain_mm_yr) {
  return rain_m3_s(grid, rain_mm_yr, [](Index) { return true; });
}

/// Multiplies rain by one factor, so that the whole surface has as much of it as the air gives.
void close_rain(const Grid& grid, double precipitation_m3_s, std::span<float> rain_mm_yr) {
  const double spread_m3_s = rain_m3_s(grid, rain_mm_yr);
  if (!(spread_m3_s > 0.0)) return;
  const auto factor = static_cast<float>(precipitation_m3_s / spread_m3_s);
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) rain_mm_yr[cell] *= factor;
}

/// Months on the stage's grid, for who writes them.
MonthlyFields months_of(std::shared_ptr<const ClimateFrame> frame,
                        std::shared_ptr<const Climatology> year) {
  return
      [frame = std::move(frame), year = std::move(year)](
          const FieldSpec& field, int month, std::span<const float> annual, std::span<float> out) {
        const bool is_temperature = &field == &field::temperature_monthly;
        const bool is_rain = &field == &field::precipitation_monthly;
        const auto& coarse = is_temperature                        ? year->temperature_departure_k
                             : is_rain                             ? year->precipitation_share
                             : &field == &field::wind_east_monthly ? year->wind_east
                                                                   : year->wind_north;
        const Interpolator values(frame->on_planet(), coarse[month],
                                  is_temperature || is_rain ? Interpolator::Kind::scalar
                                                            : Interpolator::Kind::vector_component);
        const Grid& grid = frame->on_planet().fine();
        const auto nx = static_cast<std::size_t>(grid.nx());
        std::vector<float> scratch(values.scratch_size());
        for (int j = 0; j < grid.ny(); ++j) {
          const std::size_t begin = static_cast<std::size_t>(j) * nx;
          const auto row = out.subspan(begin, nx);
          values.row(j, row, scratch);
          for (std::size_t i = 0; i < nx; ++i) {
            if (is_temperature) row[i] += annual[begin + i];
            if (is_rain) row[i] *= annual[begin + i];
          }
        }
      };
}

/// The sun of the model is a mean over the day. Where a day is as long as air takes to cool, day
/// and night have climates of their own, and a planet that always shows its star the same face has
/// nothing else.
void warn_of_slow_rotation(const Circulation& circulation, Context& context) {
  constexpr double kRadiativeTime_h = 30.0 * 24.0;  // of the troposphere (Pierrehumbert 2010)
  if (circulation.rotation_period_h <= kRadiativeTime_h) return;
  context.warnings.push_back(
      fmt::format("climate.rotation_period_h = {:g}: days longer than {:g} h, let alone a tidally "
                  "locked planet, "
                  "have a day side and a night side, and this climate knows only the mean of both",
                  circulation.rotation_period_h, kRadiativeTime_h));
}

/// Time of one thread for the air on its own grid, as in StageCost.
double air_seconds(const ClimateParameters& p) {
  constexpr double kAtTwoDegrees_s = 2.4, kGrowth = 2.3;
  if (p.model == "blueprint") return 0.0;
  return kAtTwoDegrees_s * std::pow(2.0 / p.resolution_deg, kGrowth);
}

class ClimateStage final : public Stage {
 public:
  explicit ClimateStage(ClimateParameters parameters) : p_(std::move(parameters)) {}
  [[nodiscard]] const StageInfo& info() const override { return info_; }
  [[nodiscard]] std::vector<Parameter> parameters() override { return p_.declarations(); }
  [[nodiscard]] StageCost cost(std::span<const Parameter> /*configuration*/) const override {
    return {.per_cell_ns = 200.0, .fixed_s = air_seconds(p_), .cell_bytes = 112.0};
  }

  void run(StageIo& io, Context& context) const override {
    const auto elevation = io.read(field::elevation);
    const ClimateOutputs out{io.write(field::temperature),
                             io.write(field::temperature_range),
                             io.write(field::precipitation),
                             io.write(field::precipitation_seasonality),
                             io.write(field::wind_east),
                             io.write(field::wind_north),
                             io.write(field::distance_to_coast),
                             io.write(field::potential_evapotranspiration),
                             io.write(field::sea_ice_area_fraction),
                             io.write(field::ocean_current_east),
                             io.write(field::ocean_current_north),
                             io.write(field::koppen_class)};
    warn_of_slow_rotation(p_.seasonal.circulation, context);
    distance_to_coast(io.grid(), elevation, out.coast);
    context.advance(0.2);

    const auto shared_frame = std::make_shared<const ClimateFrame>(io.grid(), p_, context.planet);
    const ClimateFrame& frame = *shared_frame;
    const auto size = static_cast<std::size_t>(frame.planet().size());
    std::vector<float> land(size), height_m(size);
    frame.planet_topography(elevation, land, height_m);
    const auto ice_m = io.read_optional(field::ice_thickness);
    std::vector<float> glaciers;
    if (!ice_m.empty()) glaciers = frame.planet_glaciers(ice_m, land);
    const auto model =
        on_planet(p_.seasonal, context.planet, p_.blueprint.greenhouse_k, p_.colder_k);
    const auto topography_size = static_cast<std::size_t>(frame.topography().size());
    std::vector<float> topography_land(topography_size), topography_height(topography_size),
        coverage(topography_size);
    frame.on_topography().average_elevation(elevation, topography_land, topography_height,
                                            coverage);
    const bool closed_formulas = p_.model == "blueprint";
    std::vector<float> ascent, planet_ascent;
    TerrainAscent ascent_of;  // the blueprint has its own
    if (!closed_formulas) {
      ascent_of = [&](std::span<const float> wind_east, std::span<const float> wind_north) {
        ascent = orographic_ascent(frame, wind_east, wind_north, topography_height, p_);
        planet_ascent = mean_ascent(frame, ascent);
        return planet_ascent;
      };
    }
    const SeasonalFields fields = solve_seasonal_climate(
        frame.planet(), model, frame.planet_latitudes_deg(), land, height_m, ascent_of, glaciers);
    context.advance(0.5);
    const DimmedSun dimmed =
        dim_the_sun(model.energy, closed_formulas ? &p_.blueprint : nullptr, context);
    if (closed_formulas) {
      ascent.resize(topography_size);
      blueprint_orographic_precipitation(frame.topography(), p_.blueprint,
                                         frame.topography_latitudes_deg(), topography_land,
                                         topography_height, ascent);
      planet_ascent.assign(size, 1.0F);
    }
    const FineClimate fine(frame, p_, model, fields, land, planet_ascent, ascent, dimmed, context);
    const std::vector<std::int64_t> held = fine.fill(elevation, out);
    report_limits(io.grid(), fine.limits(), held, /*part_of_model=*/closed_formulas, context);
    if (!closed_formulas) {
      // A part of a planet has no budget of its own: its air goes on beyond the edge.
      if (io.grid().topology() != Topology::plane) {
        close_rain(io.grid(), dimmed.rain_left * fields.water.precipitation_m3_s,
                   out.precipitation);
      }
      context.monthly_fields = months_of(shared_frame, fine.year());
      report_water(io.grid(), fields.water, dimmed.rain_left, elevation, out, context.budget);
    }
    context.advance(1.0);
  }

 private:
  /// Evaporation as the air got it, rain as the fields have it.
  static void report_water(const Grid& grid, const AirWater& air, double rain_left,
                           std::span<const float> elevation, const ClimateOutputs& out,
                           Budget& budget) {
    const bool whole = grid.topology() != Topology::plane;
    const double evaporation = rain_left * (air.sea_evaporation_m3_s + air.land_evaporation_m3_s);
    const double precipitation =
        whole ? rain_m3_s(grid, out.precipitation) : rain_left * air.precipitation_m3_s;
    budget["sea_evaporation_m3_s"] = rain_left * air.sea_evaporation_m3_s;
    budget["land_evaporation_m3_s"] = rain_left * air.land_evaporation_m3_s;
    budget["precipitation_m3_s"] = precipitation;
    if (whole) {
      budget["land_precipitation_m3_s"] =
          rain_m3_s(grid, out.precipitation, [&](Index c) { return elevation[c] >= 0.0F; });
    }
    budget["air_water_closing_error"] =
        std::abs(evaporation - precipitation) / std::max({evaporation, precipitation, 1e-30});
  }

  ClimateParameters p_;
  StageInfo info_{"climate",
                  "temperature, winds and rain from insolation, topography and the sea",
                  {&field::elevation},
                  {&field::ice_thickness},
                  {&field::temperature, &field::temperature_range, &field::precipitation,
                   &field::precipitation_seasonality, &field::wind_east, &field::wind_north,
                   &field::distance_to_coast, &field::potential_evapotranspiration,
                   &field::sea_ice_area_fraction, &field::ocean_current_east,
                   &field::ocean_current_north, &field::koppen_class},
                  /*own_grid=*/false,
                  /*feels_events=*/true};
};

}  // namespace

std::unique_ptr<Stage> make_climate_stage(ClimateParameters parameters) {
  return std::make_unique<ClimateStage>(std::move(parameters));
}

}  // namespace geo
