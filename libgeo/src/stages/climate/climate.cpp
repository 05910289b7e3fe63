#include "geo/stages/climate/climate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "climate_events.hpp"
#include "climate_frame.hpp"
#include "climatology_rows.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/climate/circulation.hpp"
#include "geo/kernels/climate/distance_to_coast.hpp"
#include "geo/kernels/climate/evaporation.hpp"
#include "geo/kernels/climate/insolation.hpp"
#include "geo/kernels/life/koppen.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/kernels/remapping/conservative_remapping.hpp"
#include "geo/kernels/water/water_balance.hpp"
#include "orographic_ascent.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kDaysPerMonth = 365.25 / kMonths;

/// The outputs of the stage.
struct Outputs {
  std::span<float> temperature, temperature_range, precipitation, seasonality, wind_east,
      wind_north, coast, evaporation, sea_ice;
  std::span<std::int8_t> koppen;
};

/// Coherent noise on annual means; free where the amplitudes are 0. That of the blueprint is value
/// noise, which comes as far as its amplitudes.
class ClimateNoise {
 public:
  ClimateNoise(const ClimateParameters& p, const Grid& grid, std::uint64_t seed)
      : temperature_(seed, "climate.temperature"),
        rain_(seed, "climate.precipitation"),
        grid_(grid),
        frequency_(grid.figure().radius_m / (1000.0 * p.noise_wavelength_km)),
        fills_its_range_(p.model == "blueprint"),
        temperature_k_(p.temperature_noise_k),
        rain_mm_yr_(p.precipitation_noise_mm_yr) {}
  [[nodiscard]] double temperature_k(int i, int j) const {
    return temperature_k_ == 0.0 ? 0.0 : temperature_k_ * sample(temperature_, i, j);
  }
  [[nodiscard]] double rain_mm_yr(int i, int j) const {
    return rain_mm_yr_ == 0.0 ? 0.0 : rain_mm_yr_ * sample(rain_, i, j);
  }

 private:
  static constexpr int kOctaves = 4;
  [[nodiscard]] double sample(const Noise& noise, int i, int j) const {
    const auto at = grid_.unit_vector(i, j);
    if (!fills_its_range_) return noise.fbm(at, frequency_, kOctaves);
    return noise.value(static_cast<float>(at[0] * frequency_),
                       static_cast<float>(at[1] * frequency_),
                       static_cast<float>(at[2] * frequency_));
  }
  Noise temperature_, rain_;
  const Grid& grid_;
  double frequency_;
  bool fills_its_range_;
  double temperature_k_, rain_mm_yr_;
};

/// The model's constants on this planet: its sun's path, its air.
SeasonalClimate on_planet(SeasonalClimate model, const Planet& planet, double greenhouse_k) {
  model.energy.orbit = {planet.obliquity_deg, planet.eccentricity, planet.perihelion_deg};
  const double warming_k = greenhouse_k * (std::log1p(planet.pressure_bar) - std::log1p(1.0));
  model.energy.outgoing_w_m2 -= model.energy.outgoing_slope_w_m2_k * warming_k;
  model.energy.diffusivity_w_m2_k *= planet.pressure_bar;  // the mass that carries the heat
  return model;
}

/// Range of the blueprint's temperatures; of the energy balance's, wider where the air is much
/// thicker or thinner. What would leave it is held at its end, and counted.
struct TemperatureLimits {
  static TemperatureLimits of_air(double pressure_bar) {
    const double wider_k = 40.0 * std::abs(std::log(pressure_bar));
    return {static_cast<float>(std::max(-270.0, -70.0 - wider_k)),
            static_cast<float>(55.0 + wider_k)};
  }
  [[nodiscard]] bool hold(float& temperature_c) const {
    const float held_c = std::clamp(temperature_c, lowest_c, highest_c);
    const bool changed = held_c != temperature_c;
    temperature_c = held_c;
    return changed;
  }
  [[nodiscard]] bool is_end(float temperature_c) const {
    return temperature_c <= lowest_c || temperature_c >= highest_c;
  }
  float lowest_c = -70.0F, highest_c = 55.0F;
};

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

/// How the coarse year goes, and what of it is the same in every month.
Climatology shape_of_year(const std::shared_ptr<const Grid>& grid, const SeasonalFields& fields,
                          std::vector<float>& mean_temperature_c,
                          std::vector<float>& precipitation_mm_yr) {
  const auto size = static_cast<std::size_t>(grid->size());
  mean_temperature_c.assign(size, 0.0F);
  precipitation_mm_yr.assign(size, 0.0F);
  Climatology year{grid, fields.temperature_c, fields.precipitation_mm, fields.wind_east,
                   fields.wind_north};
  for (std::size_t cell = 0; cell < size; ++cell) {
    double temperature_c = 0.0, rain_mm = 0.0;
    for (int m = 0; m < kMonths; ++m) {
      temperature_c += fields.temperature_c[m][cell] / kMonths;
      rain_mm += fields.precipitation_mm[m][cell];
    }
    mean_temperature_c[cell] = static_cast<float>(temperature_c);
    precipitation_mm_yr[cell] = static_cast<float>(rain_mm);
    for (int m = 0; m < kMonths; ++m) {
      year.temperature_departure_k[m][cell] -= mean_temperature_c[cell];
      year.precipitation_share[m][cell] =
          rain_mm > 0.0 ? static_cast<float>(fields.precipitation_mm[m][cell] / rain_mm)
                        : 1.0F / kMonths;
    }
  }
  return year;
}

std::vector<float> annual_mean(const Climatology::Monthly& months) {
  std::vector<float> mean(months[0].size());
  for (std::size_t cell = 0; cell < mean.size(); ++cell) {
    double sum = 0.0;
    for (const auto& month : months) sum += month[cell];
    mean[cell] = static_cast<float>(sum / kMonths);
  }
  return mean;
}

/// How much more sun than on average reaches the ground under a column of this humidity
/// (Angstrom-Prescott, sunshine falling with humidity).
float clearness(float humidity) {
  const float sunshine = std::clamp(1.1F - humidity, 0.1F, 0.9F);
  return (0.25F + 0.5F * sunshine) / 0.5F;
}

/// What the months make of one row: evaporation (Oudin et al. 2005), the range of temperature, how
/// far rain keeps to the summer of the hemisphere, and classes after Köppen and Geiger.
class SeasonsOfRows {
 public:
  SeasonsOfRows(const ClimateFrame& frame, const SeasonalClimate& model, const Climatology& year)
      : frame_(frame), model_(model), rows_(frame.on_planet(), year) {}
  [[nodiscard]] std::size_t scratch_size() const { return rows_.scratch_size(); }

  /// `months` holds twice twelve rows.
  void row(int j, std::span<const float> elevation, std::span<const float> humidity,
           const Outputs& out, std::span<float> months, std::span<float> scratch) const {
    const std::size_t nx = humidity.size(), begin = static_cast<std::size_t>(j) * nx;
    const auto row_of = [&](std::span<float> field) { return field.subspan(begin, nx); };
    const auto temperature = row_of(out.temperature), rain = row_of(out.precipitation);
    const auto month_c = [&](int m) { return months.subspan(m * nx, nx); };
    const auto month_mm = [&](int m) { return months.subspan((kMonths + m) * nx, nx); };
    const auto seasonality = row_of(out.seasonality), evaporation = row_of(out.evaporation);
    std::fill(evaporation.begin(), evaporation.end(), 0.0F);
    std::fill(seasonality.begin(), seasonality.end(), 0.0F);
    const double latitude = frame_.latitudes_deg()[j];
    const auto sun_w_m2 =
        monthly_insolation_w_m2(latitude, model_.energy.orbit, model_.energy.solar_constant_w_m2);
    for (int m = 0; m < kMonths; ++m) {
      const auto degrees = month_c(m), share = month_mm(m);
      rows_.temperature_departure(m, j, degrees, scratch);
      rows_.precipitation_share(m, j, share, scratch);
      // Oudin's formula is linear in T + 5 degC above its threshold.
      const auto per_kelvin =
          static_cast<float>(oudin_evaporation_mm_d(sun_w_m2[m], -4.0) * kDaysPerMonth);
      const auto summer =
          static_cast<float>((latitude < 0.0 ? -2.0 : 2.0) * std::cos((m - 6) * 30.0 * kRadians));
      for (std::size_t i = 0; i < nx; ++i) {
        degrees[i] += temperature[i];
        evaporation[i] += per_kelvin * std::max(0.0F, degrees[i] + 5.0F);
        seasonality[i] += summer * share[i];
        share[i] *= rain[i];
      }
    }
    const auto range = row_of(out.temperature_range);
    for (std::size_t i = 0; i < nx; ++i) {
      float warmest = month_c(0)[i], coldest = warmest;
      for (int m = 1; m < kMonths; ++m) {
        warmest = std::max(warmest, month_c(m)[i]);
        coldest = std::min(coldest, month_c(m)[i]);
      }
      range[i] = warmest - coldest;
      seasonality[i] = std::clamp(seasonality[i], -1.0F, 1.0F);
      evaporation[i] *= clearness(humidity[i]);
    }
    for (std::size_t i = 0; i < nx; ++i) {
      out.koppen[begin + i] = 0;
      if (elevation[begin + i] < 0.0F) continue;
      std::array<double, kMonths> degrees{}, millimetres{};
      for (int m = 0; m < kMonths; ++m) {
        degrees[m] = month_c(m)[i];
        millimetres[m] = month_mm(m)[i];
      }
      out.koppen[begin + i] = koppen_class(monthly_indices(degrees, millimetres, latitude < 0.0));
    }
  }

 private:
  const ClimateFrame& frame_;
  const SeasonalClimate& model_;
  ClimatologyRows rows_;
};

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
  constexpr double kAtTwoDegrees_s = 2.0, kGrowth = 2.3;
  if (p.model == "blueprint") return 0.0;
  return kAtTwoDegrees_s * std::pow(2.0 / p.resolution_deg, kGrowth);
}

class ClimateStage final : public Stage {
 public:
  explicit ClimateStage(ClimateParameters parameters) : p_(std::move(parameters)) {}
  [[nodiscard]] const StageInfo& info() const override { return info_; }
  [[nodiscard]] std::vector<Parameter> parameters() override { return p_.declarations(); }
  [[nodiscard]] StageCost cost(std::span<const Parameter> /*configuration*/) const override {
    return {.per_cell_ns = 300.0, .fixed_s = air_seconds(p_), .cell_bytes = 110.0};
  }

  void run(StageIo& io, Context& context) const override {
    const auto elevation = io.read(field::elevation);
    const Outputs out{io.write(field::temperature),
                      io.write(field::temperature_range),
                      io.write(field::precipitation),
                      io.write(field::precipitation_seasonality),
                      io.write(field::wind_east),
                      io.write(field::wind_north),
                      io.write(field::distance_to_coast),
                      io.write(field::potential_evapotranspiration),
                      io.write(field::sea_ice_area_fraction),
                      io.write(field::koppen_class)};
    warn_of_slow_rotation(p_.seasonal.circulation, context);
    distance_to_coast(io.grid(), elevation, out.coast);
    context.advance(0.2);

    const auto shared_frame = std::make_shared<const ClimateFrame>(io.grid(), p_, context.planet);
    const ClimateFrame& frame = *shared_frame;
    const auto size = static_cast<std::size_t>(frame.planet().size());
    std::vector<float> land(size), height_m(size);
    frame.planet_relief(elevation, land, height_m);
    const auto model = on_planet(p_.seasonal, context.planet, p_.blueprint.greenhouse_k);
    const auto relief_size = static_cast<std::size_t>(frame.relief().size());
    std::vector<float> relief_land(relief_size), relief_height(relief_size), coverage(relief_size);
    frame.on_relief().average_elevation(elevation, relief_land, relief_height, coverage);
    const bool closed_formulas = p_.model == "blueprint";
    std::vector<float> ascent, planet_ascent;
    TerrainAscent ascent_of;  // the blueprint has its own
    if (!closed_formulas) {
      ascent_of = [&](std::span<const float> wind_east, std::span<const float> wind_north) {
        ascent = orographic_ascent(frame, wind_east, wind_north, relief_height, p_);
        planet_ascent = mean_ascent(frame, ascent);
        return planet_ascent;
      };
    }
    const SeasonalFields fields = solve_seasonal_climate(
        frame.planet(), model, frame.planet_latitudes_deg(), land, height_m, ascent_of);
    context.advance(0.5);
    const DimmedSun dimmed =
        dim_the_sun(model.energy, closed_formulas ? &p_.blueprint : nullptr, context);
    if (closed_formulas) {
      ascent.resize(relief_size);
      blueprint_orographic_precipitation(frame.relief(), p_.blueprint, frame.relief_latitudes_deg(),
                                         relief_land, relief_height, ascent);
      planet_ascent.assign(size, 1.0F);
    }
    finish(shared_frame, model, fields, planet_ascent, ascent, elevation, dimmed, context, out);
    if (!closed_formulas) {
      report_water(io.grid(), fields.water, dimmed.rain_left, elevation, out, context.budget);
    }
    context.advance(1.0);
  }

 private:
  /// Brings the coarse year to the stage's own cells. `on_relief` is the ascent over single ranges,
  /// or, with closed formulas, their rain.
  void finish(const std::shared_ptr<const ClimateFrame>& shared_frame, const SeasonalClimate& model,
              const SeasonalFields& fields, std::span<const float> planet_ascent,
              std::span<const float> on_relief, std::span<const float> elevation,
              const DimmedSun& dimmed, Context& context, const Outputs& out) const {
    const ClimateFrame& frame = *shared_frame;
    const Grid& grid = frame.on_planet().fine();
    const bool closed_formulas = p_.model == "blueprint";
    std::vector<float> mean_c, rain_mm_yr;
    auto year = std::make_shared<Climatology>(
        shape_of_year(frame.shared_planet(), fields, mean_c, rain_mm_yr));
    // What a cell rains is spread over its ranges as they lift the air.
    for (std::size_t cell = 0; cell < rain_mm_yr.size(); ++cell) {
      rain_mm_yr[cell] /= planet_ascent[cell];
    }
    const Interpolator mean_of(frame.on_planet(), mean_c), rain_of(frame.on_planet(), rain_mm_yr),
        humidity_of(frame.on_planet(), fields.humidity),
        east_of(frame.on_planet(), annual_mean(year->wind_east),
                Interpolator::Kind::vector_component),
        north_of(frame.on_planet(), annual_mean(year->wind_north),
                 Interpolator::Kind::vector_component),
        relief_of(frame.on_relief(), on_relief);
    const SeasonsOfRows seasons(frame, model, *year);
    const ClimateNoise noise(p_, grid, context.seed);
    const double pressure_bar = context.planet.pressure_bar;
    const TemperatureLimits limits =
        closed_formulas ? TemperatureLimits{} : TemperatureLimits::of_air(pressure_bar);
    std::vector<std::int64_t> held(grid.ny());
    const auto lapse = static_cast<float>(model.energy.lapse_k_m);
    const auto cooling = static_cast<float>(dimmed.cooling_k);
    const auto rain_left = static_cast<float>(dimmed.rain_left);
    ParallelErrors errors;
#pragma omp parallel
    {
      const auto nx = static_cast<std::size_t>(grid.nx());
      auto scratch = errors.make<std::vector<float>>(
          std::max(seasons.scratch_size(), relief_of.scratch_size()));
      auto over_relief = errors.make<std::vector<float>>(nx);
      auto humidity = errors.make<std::vector<float>>(nx);
      auto months = errors.make<std::vector<float>>(2 * kMonths * nx);
#pragma omp for schedule(static)
      for (int j = 0; j < grid.ny(); ++j) {
        if (errors.any()) continue;
        const std::size_t begin = static_cast<std::size_t>(j) * nx;
        const auto row = [&](std::span<float> field) { return field.subspan(begin, nx); };
        const auto temperature = row(out.temperature), rain = row(out.precipitation);
        relief_of.row(j, over_relief, scratch);
        humidity_of.row(j, humidity, scratch);
        const double latitude = frame.latitudes_deg()[j];
        if (closed_formulas) {
          const double hadley = hadley_precipitation_mm_yr(latitude);
          const WindDirection wind = three_cell_wind(latitude);
          for (std::size_t i = 0; i < nx; ++i) {
            const double h = elevation[begin + i], coast_km = 1.0e-3 * out.coast[begin + i];
            const int column = static_cast<int>(i);
            temperature[i] = static_cast<float>(
                blueprint_temperature_c(p_.blueprint, latitude, h, coast_km, pressure_bar,
                                        noise.temperature_k(column, j), dimmed.cooling_k));
            held[j] += limits.is_end(temperature[i]) ? 1 : 0;
            rain[i] = static_cast<float>(blueprint_precipitation_mm_yr(
                p_.blueprint, hadley, over_relief[i], h, coast_km, pressure_bar,
                noise.rain_mm_yr(column, j), dimmed.aerosol));
            out.wind_east[begin + i] = static_cast<float>(p_.wind_speed_m_s * wind.east);
            out.wind_north[begin + i] = static_cast<float>(p_.wind_speed_m_s * wind.north);
          }
        } else {
          mean_of.row(j, temperature, scratch);
          rain_of.row(j, rain, scratch);
          east_of.row(j, row(out.wind_east), scratch);
          north_of.row(j, row(out.wind_north), scratch);
          for (std::size_t i = 0; i < nx; ++i) {
            const float above = std::max(0.0F, elevation[begin + i]);
            const auto shake = static_cast<float>(noise.temperature_k(static_cast<int>(i), j));
            temperature[i] += shake - cooling - lapse * above;
            held[j] += limits.hold(temperature[i]) ? 1 : 0;
            const auto stray = static_cast<float>(noise.rain_mm_yr(static_cast<int>(i), j));
            rain[i] = rain_left * std::max(0.0F, rain[i] * over_relief[i] + stray);
          }
        }
        seasons.row(j, elevation, humidity, out, months, scratch);
        for (std::size_t i = 0; i < nx; ++i) {
          const bool at_sea = elevation[begin + i] < 0.0F;
          out.sea_ice[begin + i] =
              at_sea ? static_cast<float>(sea_ice_share(model.energy, temperature[i])) : 0.0F;
        }
      }
    }
    errors.rethrow();
    // A part of a planet has no budget of its own: its air goes on beyond the edge.
    if (!closed_formulas && grid.topology() != Topology::plane) {
      close_rain(grid, dimmed.rain_left * fields.water.precipitation_m3_s, out.precipitation);
    }
    report_limits(grid, limits, held, /*part_of_model=*/closed_formulas, context);
    if (!closed_formulas) context.monthly_fields = months_of(shared_frame, year);
  }

  /// Evaporation as the air got it, rain as the fields have it.
  static void report_water(const Grid& grid, const AirWater& air, double rain_left,
                           std::span<const float> elevation, const Outputs& out, Budget& budget) {
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
                  {},
                  {&field::temperature, &field::temperature_range, &field::precipitation,
                   &field::precipitation_seasonality, &field::wind_east, &field::wind_north,
                   &field::distance_to_coast, &field::potential_evapotranspiration,
                   &field::sea_ice_area_fraction, &field::koppen_class},
                  /*own_grid=*/false,
                  /*feels_events=*/true};
};

}  // namespace

std::unique_ptr<Stage> make_climate_stage(ClimateParameters parameters) {
  return std::make_unique<ClimateStage>(std::move(parameters));
}

}  // namespace geo
