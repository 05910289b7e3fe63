#include "fine_climate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "climatology_rows.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/climate/blueprint_climate.hpp"
#include "geo/kernels/climate/circulation.hpp"
#include "geo/kernels/climate/evaporation.hpp"
#include "geo/kernels/climate/insolation.hpp"
#include "geo/kernels/climate/ocean_currents.hpp"
#include "geo/kernels/life/koppen.hpp"
#include "geo/kernels/noise/noise.hpp"

namespace geo {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kDaysPerMonth = 365.25 / kMonths;

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

/// What a coarse cell rains on level ground: it is spread over its ranges as they lift the air.
std::vector<float> on_level_ground(std::vector<float> rain_mm_yr,
                                   std::span<const float> planet_ascent) {
  for (std::size_t cell = 0; cell < rain_mm_yr.size(); ++cell) {
    rain_mm_yr[cell] /= planet_ascent[cell];
  }
  return rain_mm_yr;
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

/// Currents of the sea on the coarse grid.
struct Currents {
  std::vector<float> east, north;
};

/// Those that the stress of the months' winds drives; none unless the grid is a whole planet, and
/// they are wanted.
Currents wind_driven_currents(const ClimateFrame& frame, const ClimateParameters& p,
                              const SeasonalClimate& model, const SeasonalFields& fields,
                              std::span<const float> land_fraction) {
  const Grid& grid = frame.planet();
  const auto size = static_cast<std::size_t>(grid.size());
  Currents currents{std::vector<float>(size), std::vector<float>(size)};
  if (!p.solves_currents || grid.topology() != Topology::sphere) return currents;
  std::vector<double> east_pa(size), north_pa(size);
  for (std::size_t cell = 0; cell < size; ++cell) {
    for (int m = 0; m < kMonths; ++m) {
      const WindStress stress =
          wind_stress(model.currents, fields.wind_east[m][cell], fields.wind_north[m][cell]);
      east_pa[cell] += stress.east_pa / kMonths;
      north_pa[cell] += stress.north_pa / kMonths;
    }
  }
  ocean_currents(grid, model.currents, model.circulation.rotation_rad_s(),
                 frame.planet_latitudes_deg(), land_fraction, east_pa, north_pa, currents.east,
                 currents.north);
  return currents;
}

/// What the months make of one row: evaporation (Oudin et al. 2005), the range of temperature, how
/// far rain keeps to the summer of the hemisphere, and classes after Köppen and Geiger.
class SeasonsOfRows {
 public:
  SeasonsOfRows(const ClimateFrame& frame, const SeasonalClimate& model, const Climatology& year)
      : frame_(frame), model_(model), rows_(frame.on_planet(), year) {}
  [[nodiscard]] std::size_t scratch_size() const { return rows_.scratch_size(); }

  /// `months` holds twice twelve rows.
  void row(int j, std::span<const float> elevation, const ClimateOutputs& out,
           std::span<float> months, std::span<float> scratch) const {
    const auto nx = static_cast<std::size_t>(frame_.on_planet().fine().nx());
    const std::size_t begin = static_cast<std::size_t>(j) * nx;
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
      evaporation[i] *= static_cast<float>(clearness(rain[i], evaporation[i]));
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

}  // namespace

/// One row after the other.
class FineClimate::Rows {
 public:
  Rows(const ClimateFrame& frame, const ClimateParameters& p, const SeasonalClimate& model,
       const SeasonalFields& fields, std::span<const float> land_fraction,
       std::span<const float> planet_ascent, std::span<const float> on_topography,
       const DimmedSun& dimmed, const Context& context)
      : frame_(frame),
        p_(p),
        model_(model),
        dimmed_(dimmed),
        pressure_bar_(context.planet.pressure_bar),
        limits_(closed_formulas() ? TemperatureLimits{} : TemperatureLimits::of_air(pressure_bar_)),
        year_(std::make_shared<Climatology>(
            shape_of_year(frame.shared_planet(), fields, mean_c_, rain_mm_yr_))),
        mean_of_(frame.on_planet(), mean_c_),
        rain_of_(frame.on_planet(), on_level_ground(rain_mm_yr_, planet_ascent)),
        east_of_(frame.on_planet(), annual_mean(year_->wind_east),
                 Interpolator::Kind::vector_component),
        north_of_(frame.on_planet(), annual_mean(year_->wind_north),
                  Interpolator::Kind::vector_component),
        topography_of_(frame.on_topography(), on_topography),
        currents_(wind_driven_currents(frame, p, model, fields, land_fraction)),
        current_east_of_(frame.on_planet(), currents_.east, Interpolator::Kind::vector_component),
        current_north_of_(frame.on_planet(), currents_.north, Interpolator::Kind::vector_component),
        seasons_(frame, model, *year_),
        noise_(p, frame.on_planet().fine(), context.seed) {}

  [[nodiscard]] const Grid& grid() const { return frame_.on_planet().fine(); }
  [[nodiscard]] const TemperatureLimits& limits() const { return limits_; }
  [[nodiscard]] const std::shared_ptr<Climatology>& year() const { return year_; }

  /// What one thread works in.
  struct Work {
    std::vector<float> scratch, over_topography, months;
  };
  [[nodiscard]] Work work() const {
    const auto nx = static_cast<std::size_t>(grid().nx());
    return {std::vector<float>(std::max(seasons_.scratch_size(), topography_of_.scratch_size())),
            std::vector<float>(nx), std::vector<float>(2 * kMonths * nx)};
  }

  /// All outputs of a row; how many of its cells were held at an end of the temperatures' range.
  std::int64_t row(int j, std::span<const float> elevation, const ClimateOutputs& out,
                   Work& work) const {
    topography_of_.row(j, work.over_topography, work.scratch);
    const std::int64_t held = closed_formulas() ? closed_row(j, elevation, out, work)
                                                : balanced_row(j, elevation, out, work);
    seasons_.row(j, elevation, out, work.months, work.scratch);
    sea_row(j, elevation, out, work);
    return held;
  }

 private:
  [[nodiscard]] bool closed_formulas() const { return p_.model == "blueprint"; }

  /// Ice and currents.
  void sea_row(int j, std::span<const float> elevation, const ClimateOutputs& out,
               Work& work) const {
    const auto nx = static_cast<std::size_t>(grid().nx());
    const std::size_t begin = static_cast<std::size_t>(j) * nx;
    current_east_of_.row(j, out.current_east.subspan(begin, nx), work.scratch);
    current_north_of_.row(j, out.current_north.subspan(begin, nx), work.scratch);
    for (std::size_t cell = begin; cell < begin + nx; ++cell) {
      const bool at_sea = elevation[cell] < 0.0F;
      out.sea_ice[cell] =
          at_sea ? static_cast<float>(sea_ice_share(model_.energy, out.temperature[cell])) : 0.0F;
      if (at_sea) continue;
      out.current_east[cell] = out.current_north[cell] = 0.0F;
    }
  }

  /// By the blueprint's formulas.
  std::int64_t closed_row(int j, std::span<const float> elevation, const ClimateOutputs& out,
                          const Work& work) const {
    const double latitude = frame_.latitudes_deg()[j];
    const double hadley = hadley_precipitation_mm_yr(latitude);
    const WindDirection wind = three_cell_wind(latitude);
    std::int64_t held = 0;
    for (int i = 0; i < grid().nx(); ++i) {
      const Index cell = grid().cell(i, j);
      const double h = elevation[cell], coast_km = 1.0e-3 * out.coast[cell];
      out.temperature[cell] = static_cast<float>(
          blueprint_temperature_c(p_.blueprint, latitude, h, coast_km, pressure_bar_,
                                  noise_.temperature_k(i, j), dimmed_.cooling_k));
      held += limits_.is_end(out.temperature[cell]) ? 1 : 0;
      out.precipitation[cell] = static_cast<float>(
          blueprint_precipitation_mm_yr(p_.blueprint, hadley, work.over_topography[i], h, coast_km,
                                        pressure_bar_, noise_.rain_mm_yr(i, j), dimmed_.aerosol));
      out.wind_east[cell] = static_cast<float>(p_.wind_speed_m_s * wind.east);
      out.wind_north[cell] = static_cast<float>(p_.wind_speed_m_s * wind.north);
    }
    return held;
  }

  /// From the budgets of energy and moisture.
  std::int64_t balanced_row(int j, std::span<const float> elevation, const ClimateOutputs& out,
                            Work& work) const {
    const auto nx = static_cast<std::size_t>(grid().nx());
    const auto row = [&](std::span<float> field) {
      return field.subspan(static_cast<std::size_t>(j) * nx, nx);
    };
    const auto temperature = row(out.temperature), rain = row(out.precipitation);
    mean_of_.row(j, temperature, work.scratch);
    rain_of_.row(j, rain, work.scratch);
    east_of_.row(j, row(out.wind_east), work.scratch);
    north_of_.row(j, row(out.wind_north), work.scratch);
    const auto lapse = static_cast<float>(model_.energy.lapse_k_m);
    const auto cooling = static_cast<float>(dimmed_.cooling_k);
    const auto rain_left = static_cast<float>(dimmed_.rain_left);
    std::int64_t held = 0;
    for (std::size_t i = 0; i < nx; ++i) {
      const int column = static_cast<int>(i);
      const float above = std::max(0.0F, elevation[grid().cell(column, j)]);
      const auto shake = static_cast<float>(noise_.temperature_k(column, j));
      temperature[i] += shake - cooling - lapse * above;
      held += limits_.hold(temperature[i]) ? 1 : 0;
      const auto stray = static_cast<float>(noise_.rain_mm_yr(column, j));
      rain[i] = rain_left * std::max(0.0F, rain[i] * work.over_topography[i] + stray);
    }
    return held;
  }

  const ClimateFrame& frame_;
  const ClimateParameters& p_;
  const SeasonalClimate& model_;
  DimmedSun dimmed_;
  double pressure_bar_;
  TemperatureLimits limits_;
  std::vector<float> mean_c_, rain_mm_yr_;  ///< of coarse cells, filled with the year
  std::shared_ptr<Climatology> year_;
  Interpolator mean_of_, rain_of_, east_of_, north_of_, topography_of_;
  Currents currents_;
  Interpolator current_east_of_, current_north_of_;
  SeasonsOfRows seasons_;
  ClimateNoise noise_;
};

FineClimate::FineClimate(const ClimateFrame& frame, const ClimateParameters& parameters,
                         const SeasonalClimate& model, const SeasonalFields& fields,
                         std::span<const float> land_fraction, std::span<const float> planet_ascent,
                         std::span<const float> on_topography, const DimmedSun& dimmed,
                         const Context& context)
    : rows_(std::make_unique<const Rows>(frame, parameters, model, fields, land_fraction,
                                         planet_ascent, on_topography, dimmed, context)) {}

FineClimate::~FineClimate() = default;

std::vector<std::int64_t> FineClimate::fill(std::span<const float> elevation,
                                            const ClimateOutputs& out) const {
  const int ny = rows_->grid().ny();
  std::vector<std::int64_t> held(ny);
  ParallelErrors errors;
#pragma omp parallel
  {
    Rows::Work work;
    errors.guard([&] { work = rows_->work(); });
#pragma omp for schedule(static)
    for (int j = 0; j < ny; ++j) {
      if (errors.any()) continue;
      held[j] = rows_->row(j, elevation, out, work);
    }
  }
  errors.rethrow();
  return held;
}

const TemperatureLimits& FineClimate::limits() const { return rows_->limits(); }

std::shared_ptr<const Climatology> FineClimate::year() const { return rows_->year(); }

}  // namespace geo
