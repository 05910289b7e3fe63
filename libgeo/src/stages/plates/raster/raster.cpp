#include "raster.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

#include "geo/core/error.hpp"
#include "raster_on_sphere.hpp"
#include "raster_on_torus.hpp"

namespace geo {
namespace {

/// Reads "0.1, 0.2" into one member of the plates' own settings.
void read_own(std::string_view key, std::string_view text, double least, double most,
              double RasterPlateSettings::*member, std::vector<RasterPlateSettings>& own) {
  for (std::size_t plate = 0; !text.empty(); ++plate) {
    const std::size_t comma = std::min(text.find(','), text.size());
    std::string_view entry = text.substr(0, comma);
    text.remove_prefix(std::min(comma + 1, text.size()));
    while (!entry.empty() && entry.front() == ' ') entry.remove_prefix(1);
    while (!entry.empty() && entry.back() == ' ') entry.remove_suffix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(entry.data(), entry.data() + entry.size(), value);
    if (error != std::errc{} || end != entry.data() + entry.size() ||
        !(value >= least && value <= most)) {
      throw ConfigurationError(std::string(key) + ": entry " + std::to_string(plate) + " is \"" +
                               std::string(entry) + "\"; it must be a number from " +
                               std::to_string(least) + " to " + std::to_string(most));
    }
    if (own.size() <= plate) own.resize(plate + 1);
    own[plate].*member = value;
  }
}

RasterSettings settings_of(const PlatesParameters& parameters, double width_km) {
  const RasterParameters& p = parameters.raster;
  RasterSettings s = p.model;
  s.world = {static_cast<int>(p.columns), static_cast<int>(p.rows)};
  s.plates = static_cast<int>(p.plates);
  s.cycles = static_cast<int>(p.cycles);
  s.cycle_steps = static_cast<int>(p.cycle_steps);
  s.erosion_steps = static_cast<int>(p.erosion_steps);
  s.restart_quiet = static_cast<int>(p.restart_quiet);
  const auto width = static_cast<double>(p.columns);
  s.continents_across = std::max(1.0, width_km / (2.0 * parameters.start.continent_km));
  s.speed = p.drift * width;
  s.arc_cells = p.arc_distance * width;
  s.arc_scatter_cells = 0.3 * s.arc_cells;
  s.overlap_cells = p.overlap_absolute * width * static_cast<double>(p.rows);
  const double radians = parameters.sphere.law.step_myr * std::numbers::pi / 180.0;
  s.spin = p.spin_deg_myr * radians;
  s.curve = p.curve_deg_myr * radians;
  read_own("plates.raster.plate_speed", p.plate_speed, 0.0, 10.0, &RasterPlateSettings::speed,
           s.own);
  read_own("plates.raster.plate_folding", p.plate_folding, 0.0, 1.0,
           &RasterPlateSettings::folding_ratio, s.own);
  read_own("plates.raster.plate_overlap", p.plate_overlap, 0.0, 10.0,
           &RasterPlateSettings::overlap_relative, s.own);
  read_own("plates.raster.plate_erosion", p.plate_erosion, 0.0, 1e4,
           &RasterPlateSettings::erosion_steps, s.own);
  return s;
}

double width_of(const Grid& grid) {
  return grid.topology() == Topology::torus ? 1e-3 * grid.nx() * grid.spacing_east_m(0)
                                            : 2e-3 * std::numbers::pi * grid.figure().radius_m;
}

/// A tile is not stretched.
void check_shape(const Grid& grid, const RasterParameters& p) {
  const double height = grid.ny() * grid.step_north_m() / (grid.nx() * grid.spacing_east_m(0));
  const double rows = height * static_cast<double>(p.columns);
  if (std::abs(rows - static_cast<double>(p.rows)) < 0.5) return;
  throw ConfigurationError(
      "plates.raster.map_rows = " + std::to_string(p.rows) +
      ": must be as high over plates.raster.map_columns = " + std::to_string(p.columns) +
      " as the torus, " + std::to_string(std::lround(rows)) + " for this grid");
}

template <class Model>
void report(const Model& model, Budget& budget) {
  const RasterBudget& sums = model.budget();
  const double mass = model.mass();
  budget["raster_steps"] = static_cast<double>(sums.steps);
  budget["raster_cycles"] = sums.cycles;
  budget["raster_mergers"] = sums.mergers;
  budget["raster_crust_start"] = sums.start;
  budget["raster_crust_end"] = mass;
  budget["raster_crust_created"] = sums.created;
  budget["raster_crust_subducted"] = sums.subducted;
  budget["raster_crust_melted"] = sums.melted;
  budget["raster_crust_folded"] = sums.folded;
  budget["raster_crust_resampled"] = sums.resampled;
  budget["raster_crust_rounded"] = sums.rounded;
  budget["raster_crust_closing_error"] = (mass - sums.balance()) / mass;
}

template <class Model>
void run_cycles(Model& model, Context& context) {
  while (model.advance()) {
    constexpr int kTold = 32;
    if (model.steps() % kTold == 0) context.advance(0.8 * model.progress());
  }
  report(model, context.budget);
  context.advance(0.8);
}

}  // namespace

double wanted_ocean(const Context& context) {
  return context.planet.sea_level == "fraction" ? context.planet.ocean_fraction : 1.0;
}

void check_rasters(const PlatesParameters& parameters, const Grid& grid) {
  if (grid.topology() == Topology::torus) check_shape(grid, parameters.raster);
  static_cast<void>(settings_of(parameters, width_of(grid)));
}

void collide_rasters(const PlatesParameters& parameters, StageIo& io, Context& context) {
  const Grid& grid = io.grid();
  if (grid.topology() == Topology::plane) {
    throw InputError("plates: the grid must be a whole sphere or a torus");
  }
  check_rasters(parameters, grid);
  context.advance(0.0);
  const bool on_torus = grid.topology() == Topology::torus;
  const double width_km = width_of(grid);
  RasterScale scale;
  scale.cell_km = width_km / static_cast<double>(parameters.raster.columns);
  scale.step_myr = parameters.sphere.law.step_myr;
  scale.summit_km = parameters.sphere.law.summit_km;
  scale.oldest_floor_myr = parameters.oldest_floor_myr;
  RasterSettings settings = settings_of(parameters, width_km);
  if (on_torus) {
    RasterTectonics model(settings, context.seed);
    run_cycles(model, context);
    return lay_on_torus(parameters, model, scale, io, context);
  }
  const FibonacciSphere samples(raster_samples(settings.world.columns));
  const SphereMesh mesh(samples);
  settings.overlap_cells = parameters.raster.overlap_absolute * samples.size();
  RasterSphere model(mesh, settings, context.seed);
  run_cycles(model, context);
  lay_on_sphere(parameters, model, scale, io, context);
}

}  // namespace geo
