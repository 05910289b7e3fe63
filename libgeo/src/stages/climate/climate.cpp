#include "geo/stages/climate/climate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "climate_events.hpp"
#include "climate_frame.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/climate/circulation.hpp"
#include "geo/kernels/climate/distance_to_coast.hpp"
#include "geo/kernels/climate/evaporation.hpp"
#include "geo/kernels/climate/insolation.hpp"
#include "geo/kernels/climate/orography.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/kernels/remapping/conservative_remapping.hpp"
#include "geo/kernels/water/water_balance.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kDaysPerMonth = 365.25 / kMonths;

/// The outputs of the stage.
struct Outputs {
  std::span<float> temperature, temperature_range, precipitation, seasonality, wind_east,
      wind_north, coast, evaporation;
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
  model.energy.obliquity_deg = planet.obliquity_deg;
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

/// Interpolated fields of the coarse planet along one row of the stage's grid.
class PlanetRows {
 public:
  PlanetRows(const ConservativeRemapping& overlay, const SeasonalFields& fields)
      : temperature(overlay, fields.temperature_c),
        harmonic_cos(overlay, fields.harmonic_cos_k),
        harmonic_sin(overlay, fields.harmonic_sin_k),
        rain(overlay, fields.precipitation_mm_yr),
        boreal(overlay, fields.boreal_rain_share),
        wind_east(overlay, fields.wind_east, Interpolator::Kind::vector_component),
        wind_north(overlay, fields.wind_north, Interpolator::Kind::vector_component),
        humidity(overlay, fields.humidity) {}
  Interpolator temperature, harmonic_cos, harmonic_sin, rain, boreal, wind_east, wind_north,
      humidity;
};

/// How many times more than over level ground air rains out at the scale of single ranges, on the
/// relief grid: e where it has just been lifted by `lift_height_m`, 1/e where it has sunk by that.
std::vector<float> relief_ascent(const ClimateFrame& frame, std::span<const float> wind_east,
                                 std::span<const float> wind_north, std::span<const float> height_m,
                                 const ClimateParameters& p) {
  const Grid& relief = frame.relief();
  std::vector<float> east(height_m.size()), north(height_m.size()), ascent(height_m.size());
  const Interpolator east_of(frame.relief_on_planet(), wind_east,
                             Interpolator::Kind::vector_component);
  const Interpolator north_of(frame.relief_on_planet(), wind_north,
                              Interpolator::Kind::vector_component);
  ParallelErrors errors;
#pragma omp parallel
  {
    auto scratch = errors.make<std::vector<float>>(east_of.scratch_size());
#pragma omp for schedule(static)
    for (int j = 0; j < relief.ny(); ++j) {
      if (errors.any()) continue;
      const std::size_t begin = static_cast<std::size_t>(j) * relief.nx();
      east_of.row(j, std::span(east).subspan(begin, relief.nx()), scratch);
      north_of.row(j, std::span(north).subspan(begin, relief.nx()), scratch);
    }
  }
  errors.rethrow();
  upwind_lift(relief, height_m, east, north, 1000.0 * p.lift_reach_km, ascent);
  const auto per_lift = static_cast<float>(1.0 / p.lift_height_m);
  for (float& value : ascent) value = std::exp(std::clamp(value * per_lift, -1.0F, 1.0F));
  return ascent;
}

/// Its mean over each cell of the planet, 1 beyond the stage's grid.
std::vector<float> mean_ascent(const ClimateFrame& frame, std::span<const float> ascent) {
  std::vector<float> mean(static_cast<std::size_t>(frame.planet().size()));
  frame.relief_on_planet().average(ascent, mean);
  std::replace(mean.begin(), mean.end(), 0.0F, 1.0F);
  return mean;
}

/// How much more sun than on average reaches the ground under a column of this humidity
/// (Angstrom-Prescott, sunshine falling with humidity).
float clearness(float humidity) {
  const float sunshine = std::clamp(1.1F - humidity, 0.1F, 0.9F);
  return (0.25F + 0.5F * sunshine) / 0.5F;
}

/// Potential evapotranspiration of Oudin et al. (2005) over the year along one row.
void add_up_evaporation(double latitude_deg, const SeasonalClimate& model,
                        std::span<const float> temperature, std::span<const float> cosine,
                        std::span<const float> sine, std::span<const float> humidity,
                        std::span<float> evaporation) {
  const auto insolation = monthly_insolation_w_m2(latitude_deg, model.energy.obliquity_deg,
                                                  model.energy.solar_constant_w_m2);
  std::fill(evaporation.begin(), evaporation.end(), 0.0F);
  for (int month = 0; month < kMonths; ++month) {
    const double longitude = month_solar_longitude_deg(month) * kRadians;
    const auto c = static_cast<float>(std::cos(longitude)),
               s = static_cast<float>(std::sin(longitude));
    // Oudin's formula is linear in T + 5 degC above its threshold.
    const auto per_kelvin =
        static_cast<float>(oudin_evaporation_mm_d(insolation[month], -4.0) * kDaysPerMonth);
    for (std::size_t i = 0; i < evaporation.size(); ++i) {
      const float above = temperature[i] + c * cosine[i] - s * sine[i] + 5.0F;
      evaporation[i] += per_kelvin * std::max(0.0F, above);
    }
  }
  for (std::size_t i = 0; i < evaporation.size(); ++i) evaporation[i] *= clearness(humidity[i]);
}

class ClimateStage final : public Stage {
 public:
  explicit ClimateStage(ClimateParameters parameters) : p_(std::move(parameters)) {}
  [[nodiscard]] const StageInfo& info() const override { return info_; }
  [[nodiscard]] std::vector<Parameter> parameters() override { return p_.declarations(); }

  void run(StageIo& io, Context& context) const override {
    const auto elevation = io.read(field::elevation);
    const Outputs out{
        io.write(field::temperature),       io.write(field::temperature_range),
        io.write(field::precipitation),     io.write(field::precipitation_seasonality),
        io.write(field::wind_east),         io.write(field::wind_north),
        io.write(field::distance_to_coast), io.write(field::potential_evaporation)};
    distance_to_coast(io.grid(), elevation, out.coast);
    context.advance(0.2);

    const ClimateFrame frame(io.grid(), p_, context.planet);
    const auto size = static_cast<std::size_t>(frame.planet().size());
    std::vector<float> land(size), height_m(size);
    frame.planet_relief(elevation, land, height_m);
    const auto model = on_planet(p_.seasonal, context.planet, p_.blueprint.greenhouse_k);
    const auto relief_size = static_cast<std::size_t>(frame.relief().size());
    std::vector<float> relief_land(relief_size), relief_height(relief_size), coverage(relief_size);
    frame.on_relief().average_relief(elevation, relief_land, relief_height, coverage);
    const bool closed_formulas = p_.model == "blueprint";
    std::vector<float> ascent, planet_ascent;
    ReliefAscent ascent_of;  // the blueprint has its own
    if (!closed_formulas) {
      ascent_of = [&](std::span<const float> wind_east, std::span<const float> wind_north) {
        ascent = relief_ascent(frame, wind_east, wind_north, relief_height, p_);
        planet_ascent = mean_ascent(frame, ascent);
        return planet_ascent;
      };
    }
    SeasonalFields fields = solve_seasonal_climate(
        frame.planet(), model, frame.planet_latitudes_deg(), land, height_m, ascent_of);
    context.advance(0.5);
    const DimmedSun dimmed =
        dim_the_sun(model.energy, closed_formulas ? &p_.blueprint : nullptr, context);
    if (closed_formulas) {
      std::vector<float> rain(relief_size);
      blueprint_relief_precipitation(frame.relief(), p_.blueprint, frame.relief_latitudes_deg(),
                                     relief_land, relief_height, rain);
      finish_blueprint(frame, model, fields, rain, elevation, dimmed, context, out);
    } else {
      // What a cell rains is spread over its ranges as they lift the air.
      for (std::size_t cell = 0; cell < size; ++cell) {
        fields.precipitation_mm_yr[cell] /= planet_ascent[cell];
      }
      finish_energy_balance(frame, model, fields, ascent, elevation, dimmed, context, out);
      report_water(io.grid(), fields.water, dimmed.rain_left, elevation, out, context.budget);
    }
    context.advance(1.0);
  }

 private:
  void finish_energy_balance(const ClimateFrame& frame, const SeasonalClimate& model,
                             const SeasonalFields& fields, std::span<const float> ascent,
                             std::span<const float> elevation, const DimmedSun& dimmed,
                             Context& context, const Outputs& out) const {
    const Grid& grid = frame.on_planet().fine();
    const PlanetRows planet(frame.on_planet(), fields);
    const Interpolator ascent_of(frame.on_relief(), ascent);
    const ClimateNoise noise(p_, grid, context.seed);
    const auto limits = TemperatureLimits::of_air(context.planet.pressure_bar);
    std::vector<std::int64_t> held(grid.ny());
    const auto lapse = static_cast<float>(model.energy.lapse_k_m);
    const auto cooling = static_cast<float>(dimmed.cooling_k);
    const auto rain_left = static_cast<float>(dimmed.rain_left);
    ParallelErrors errors;
#pragma omp parallel
    {
      const auto nx = static_cast<std::size_t>(grid.nx());
      auto scratch = errors.make<std::vector<float>>(
          std::max(planet.rain.scratch_size(), ascent_of.scratch_size()));
      auto cosine = errors.make<std::vector<float>>(nx);
      auto sine = errors.make<std::vector<float>>(nx);
      auto lifted = errors.make<std::vector<float>>(nx);
      auto humidity = errors.make<std::vector<float>>(nx);
#pragma omp for schedule(static)
      for (int j = 0; j < grid.ny(); ++j) {
        if (errors.any()) continue;
        const std::size_t begin = static_cast<std::size_t>(j) * nx;
        const auto row = [&](std::span<float> field) { return field.subspan(begin, nx); };
        const auto temperature = row(out.temperature), rain = row(out.precipitation);
        const auto range = row(out.temperature_range), seasonality = row(out.seasonality);
        planet.temperature.row(j, temperature, scratch);
        planet.harmonic_cos.row(j, cosine, scratch);
        planet.harmonic_sin.row(j, sine, scratch);
        planet.rain.row(j, rain, scratch);
        planet.boreal.row(j, seasonality, scratch);
        planet.wind_east.row(j, row(out.wind_east), scratch);
        planet.wind_north.row(j, row(out.wind_north), scratch);
        planet.humidity.row(j, humidity, scratch);
        ascent_of.row(j, lifted, scratch);
        const float summer = frame.latitudes_deg()[j] < 0.0 ? -1.0F : 1.0F;
        for (std::size_t i = 0; i < nx; ++i) {
          const float above = std::max(0.0F, elevation[begin + i]);
          const auto shake = static_cast<float>(noise.temperature_k(static_cast<int>(i), j));
          temperature[i] += shake - cooling - lapse * above;
          held[j] += limits.hold(temperature[i]) ? 1 : 0;
          range[i] = 2.0F * std::sqrt(cosine[i] * cosine[i] + sine[i] * sine[i]);
          const auto stray = static_cast<float>(noise.rain_mm_yr(static_cast<int>(i), j));
          rain[i] = rain_left * std::max(0.0F, rain[i] * lifted[i] + stray);
          seasonality[i] = std::clamp(summer * seasonality[i], -1.0F, 1.0F);
        }
        add_up_evaporation(frame.latitudes_deg()[j], model, temperature, cosine, sine, humidity,
                           row(out.evaporation));
      }
    }
    errors.rethrow();
    // A part of a planet has no budget of its own: its air goes on beyond the edge.
    if (grid.topology() != Topology::plane) {
      close_rain(grid, dimmed.rain_left * fields.water.precipitation_m3_s, out.precipitation);
    }
    report_limits(grid, limits, held, /*part_of_model=*/false, context);
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

  void finish_blueprint(const ClimateFrame& frame, const SeasonalClimate& model,
                        const SeasonalFields& fields, std::span<const float> relief_rain,
                        std::span<const float> elevation, const DimmedSun& dimmed, Context& context,
                        const Outputs& out) const {
    const Grid& grid = frame.on_planet().fine();
    const PlanetRows planet(frame.on_planet(), fields);
    const Interpolator relief_of(frame.on_relief(), relief_rain);
    const ClimateNoise noise(p_, grid, context.seed);
    const double pressure_bar = context.planet.pressure_bar;
    ParallelErrors errors;
    const TemperatureLimits limits;
    std::vector<std::int64_t> held(grid.ny());
#pragma omp parallel
    {
      const auto nx = static_cast<std::size_t>(grid.nx());
      auto scratch = errors.make<std::vector<float>>(
          std::max(planet.rain.scratch_size(), relief_of.scratch_size()));
      auto cosine = errors.make<std::vector<float>>(nx);
      auto sine = errors.make<std::vector<float>>(nx);
      auto humidity = errors.make<std::vector<float>>(nx);
#pragma omp for schedule(static)
      for (int j = 0; j < grid.ny(); ++j) {
        if (errors.any()) continue;
        const std::size_t begin = static_cast<std::size_t>(j) * nx;
        const auto row = [&](std::span<float> field) { return field.subspan(begin, nx); };
        const auto temperature = row(out.temperature), rain = row(out.precipitation);
        const auto range = row(out.temperature_range), seasonality = row(out.seasonality);
        planet.harmonic_cos.row(j, cosine, scratch);
        planet.harmonic_sin.row(j, sine, scratch);
        planet.boreal.row(j, seasonality, scratch);
        planet.humidity.row(j, humidity, scratch);
        relief_of.row(j, rain, scratch);
        const double latitude = frame.latitudes_deg()[j];
        const double hadley = hadley_precipitation_mm_yr(latitude);
        const WindDirection wind = three_cell_wind(latitude);
        const float summer = latitude < 0.0 ? -1.0F : 1.0F;
        for (std::size_t i = 0; i < nx; ++i) {
          const double h = elevation[begin + i], coast_km = 1.0e-3 * out.coast[begin + i];
          const int column = static_cast<int>(i);
          temperature[i] = static_cast<float>(
              blueprint_temperature_c(p_.blueprint, latitude, h, coast_km, pressure_bar,
                                      noise.temperature_k(column, j), dimmed.cooling_k));
          held[j] += limits.is_end(temperature[i]) ? 1 : 0;
          rain[i] = static_cast<float>(blueprint_precipitation_mm_yr(
              p_.blueprint, hadley, rain[i], h, coast_km, pressure_bar, noise.rain_mm_yr(column, j),
              dimmed.aerosol));
          range[i] = 2.0F * std::sqrt(cosine[i] * cosine[i] + sine[i] * sine[i]);
          seasonality[i] = std::clamp(summer * seasonality[i], -1.0F, 1.0F);
          out.wind_east[begin + i] = static_cast<float>(p_.wind_speed_m_s * wind.east);
          out.wind_north[begin + i] = static_cast<float>(p_.wind_speed_m_s * wind.north);
        }
        add_up_evaporation(latitude, model, temperature, cosine, sine, humidity,
                           row(out.evaporation));
      }
    }
    errors.rethrow();
    report_limits(grid, limits, held, /*part_of_model=*/true, context);
  }

  ClimateParameters p_;
  StageInfo info_{"climate",
                  "temperature, winds and rain from insolation, relief and the sea",
                  {&field::elevation},
                  {},
                  {&field::temperature, &field::temperature_range, &field::precipitation,
                   &field::precipitation_seasonality, &field::wind_east, &field::wind_north,
                   &field::distance_to_coast, &field::potential_evaporation},
                  /*own_grid=*/false,
                  /*feels_events=*/true};
};

}  // namespace

std::unique_ptr<Stage> make_climate_stage(ClimateParameters parameters) {
  return std::make_unique<ClimateStage>(std::move(parameters));
}

}  // namespace geo
