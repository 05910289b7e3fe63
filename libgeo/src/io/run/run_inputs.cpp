#include "geo/io/run/run_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "geo/core/error.hpp"
#include "geo/io/drawing/map_view.hpp"
#include "geo/io/input/dem.hpp"
#include "geo/io/input/exemplar_files.hpp"
#include "geo/io/input/hypsography.hpp"
#include "geo/io/input/plate_outlines.hpp"
#include "geo/io/input/plate_raster.hpp"
#include "geo/io/input/reconstruction.hpp"
#include "geo/io/input/table.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "geo/kernels/landscape/impact_crater.hpp"
#include "geo/kernels/numerics/quantiles.hpp"

namespace geo::io {
namespace {

/// Only a whole planet has poles that can be moved.
void refuse_turn(const RunSettings& settings, std::string_view what) {
  if (settings.turn.empty()) return;
  throw ConfigurationError(
      fmt::format("run.turn = {}: {} cannot be turned: must be empty", settings.turn, what));
}

/// The grid that a DEM is put on.
Grid grid_for(const Dem& dem, const RunSettings& settings, const Planet& planet) {
  const Grid& source = dem.grid;
  const auto turn = parse_turn("run.turn", settings.turn);
  if (source.topology() != Topology::sphere) refuse_turn(settings, "a part of a planet");
  const auto [nx, ny] = settings.grid_is_automatic() ? GridSize{source.nx(), source.ny()}
                                                     : parse_grid_size(settings.grid);
  if (source.topology() == Topology::sphere) return Grid::sphere(nx, ny, planet.figure(), turn);
  if (settings.grid_is_automatic()) return source;
  if (source.is_latitude_longitude()) {
    return Grid::window(nx, ny, source.window(), planet.figure(), source.edges());
  }
  const double width_m = source.spacing_east_m(0) * source.nx();
  const double height_m = source.step_north_m() * source.ny();
  return Grid::plane(nx, ny, width_m / nx, height_m / ny, source.edges(), source.centre(),
                     planet.figure());
}

/// Refuses a DEM of a part of a planet where a whole one is needed.
void check_whole_planet(const Dem& dem, std::string_view key) {
  if (dem.grid.topology() == Topology::sphere) return;
  throw InputError(fmt::format("{}: {}: must cover the whole planet", key, dem.source));
}

/// Refuses events that this planet has no place for.
void check_events(const std::vector<Event>& events, const Grid& grid, const Planet& planet) {
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (!std::holds_alternative<OceanShift>(events[i].what) && !grid.is_geographic()) {
      throw ConfigurationError(fmt::format(
          "event {} ({}) needs a DEM with latitudes and longitudes", i + 1, events[i].kind()));
    }
    if (const auto* shift = std::get_if<OceanShift>(&events[i].what)) {
      constexpr double kDeepest_km = 20.0;
      const double most_km3 = 1e-6 * grid.total_area_m2() * kDeepest_km;
      if (std::abs(shift->water_km3) > most_km3) {
        throw ConfigurationError(fmt::format(
            "event {} (ocean-shift): water_km3 = {:g}: must be within {:.3g}, {:g} km of water "
            "everywhere",
            i + 1, shift->water_km3, most_km3, kDeepest_km));
      }
    }
    const auto* impact = std::get_if<Impact>(&events[i].what);
    if (impact == nullptr) continue;
    const double crater_km = 1e-3 * crater_of({.diameter_m = 1e3 * impact->diameter_km,
                                               .density_kg_m3 = impact->density_kg_m3,
                                               .velocity_m_s = 1e3 * impact->velocity_km_s,
                                               .angle_deg = impact->angle_deg,
                                               .ground_density_kg_m3 = impact->ground_density_kg_m3,
                                               .gravity_m_s2 = planet.gravity_m_s2})
                                        .diameter_m;
    if (crater_km > planet.radius_km) {
      throw ConfigurationError(
          fmt::format("event {} (impact): its crater of {:.0f} km is wider than the planet's "
                      "radius of {:g} km: must be a smaller or slower body",
                      i + 1, crater_km, planet.radius_km));
    }
  }
}

/// Heights that no solid planet holds up are a wrong unit or a damaged file.
void check_heights(const Dem& dem) {
  constexpr float kMost_m = 100e3F;
  for (const float height_m : dem.elevation_m) {
    if (std::abs(height_m) <= kMost_m) continue;
    throw InputError(fmt::format("{}: holds an elevation of {:g} m: must lie within {:g} m",
                                 dem.source, height_m, kMost_m));
  }
}

/// The hypsography that heights by rank aim at, with the share of ocean that is wanted.
Hypsography hypsography_of(const RunConfiguration& run) {
  const RunSettings& settings = run.settings;
  Hypsography curve = read_hypsography(settings.hypsography);
  if (settings.hypsography_ocean == "curve" || run.planet.sea_level != "fraction") return curve;
  return with_ocean_share(std::move(curve), run.planet.ocean_fraction);
}

/// The planet as stages see it: where the hypsography says which part of it lies below the sea, all
/// of them have that sea.
Planet planet_with_sea(const RunConfiguration& run, const RunPlan& plan) {
  Planet planet = run.planet;
  if (run.settings.hypsography_ocean != "curve" || !follows_hypsography(run, plan)) return planet;
  planet.sea_level = "fraction";
  planet.ocean_fraction = ocean_share_of(read_hypsography(run.settings.hypsography));
  return planet;
}

/// Reads the inputs of one run, one kind after the other.
class Reader {
 public:
  Reader(const RunConfiguration& run, RunPlan& plan, std::optional<State> loaded,
         const std::function<void(const Grid&)>& on_grid)
      : run_(run), settings_(run.settings), plan_(plan), on_grid_(on_grid) {
    inputs_.state = std::move(loaded);
    if (inputs_.state && on_grid_) on_grid_(inputs_.state->grid());
  }

  RunInputs read() {
    const bool has_elevation = inputs_.state && inputs_.state->has(field::elevation);
    if (!has_elevation && needs_elevation(run_.pipeline, plan_)) {
      read_initial_elevation();
    } else if (!inputs_.state) {
      begin_with_bare_planet();
    }
    leave_out_island(plan_, run_, grid());
    check_events(settings_.events, grid(), run_.planet);
    read_given_fields();
    read_initial_conditions();
    if (!settings_.exemplars.empty()) find_exemplars(inputs_, run_, plan_);
    // Bad ones are refused before anything is computed.
    if (!settings_.start_frame.empty()) (void)read_checkpoint(settings_.start_frame);
    (void)hypsography_of(run_);
    return std::move(inputs_);
  }

 private:
  [[nodiscard]] const Grid& grid() const { return inputs_.state->grid(); }

  void begin_on(std::shared_ptr<const Grid> grid) {
    settings_.grid = fmt::format("{}x{}", grid->nx(), grid->ny());
    inputs_.state.emplace(std::move(grid));
    if (on_grid_) on_grid_(this->grid());
  }

  /// The sphere, or the torus of square cells, on which the first stage starts from the seed alone.
  void begin_with_bare_planet() {
    const bool is_torus = settings_.topology == "torus";
    const GridSize usual = is_torus ? GridSize{1024, 1024} : GridSize{4096, 2048};
    const auto [nx, ny] = settings_.grid_is_automatic() ? usual : parse_grid_size(settings_.grid);
    const auto figure = run_.planet.figure();
    const double cell_m = 2.0 * std::numbers::pi * figure.radius_m / std::max(1, nx);
    if (is_torus) refuse_turn(settings_, "a torus");
    begin_on(std::make_shared<const Grid>(
        is_torus ? Grid::torus(nx, ny, cell_m, cell_m)
                 : Grid::sphere(nx, ny, figure, parse_turn("run.turn", settings_.turn))));
  }

  void read_initial_elevation() {
    const std::string_view first = run_.name_of(plan_.first);
    if (settings_.topology != "sphere") {
      throw ConfigurationError(
          fmt::format("run.topology = {}: {} starts from a DEM here, which brings its own grid: "
                      "must be sphere, or the run must start with {}",
                      settings_.topology, first, run_.name_of(0)));
    }
    if (settings_.dem_file.empty()) {
      throw ConfigurationError(
          fmt::format("{} needs a DEM to start from: give one with --dem FILE[:VARIABLE], a file "
                      "of elevations, or start with {}",
                      first, run_.name_of(0)));
    }
    Dem dem =
        read_dem(settings_.dem_variable.empty() ? settings_.dem_file
                                                : settings_.dem_file + ":" + settings_.dem_variable,
                 run_.planet, {settings_.dem_range, settings_.dem_window});
    check_heights(dem);
    settings_.dem_variable = dem.variable;
    if (!inputs_.state) {
      begin_on(std::make_shared<const Grid>(grid_for(dem, settings_, run_.planet)));
    }
    std::vector<float> elevation_m = resample(dem, grid());
    if (settings_.dem_sea_level == "fraction") {
      const float sea_level_m =
          level_for_fraction(grid(), elevation_m, planet_with_sea(run_, plan_).ocean_fraction);
      for (float& height_m : elevation_m) height_m -= sea_level_m;
    }
    inputs_.state->set(field::elevation, std::move(elevation_m));
  }

  /// What images of fields mean: where they lie is told of all, their range of those that have no
  /// JSON beside them, unless it is that of a DEM.
  [[nodiscard]] ImageWords image_words(const std::string& given) const {
    auto described = split_dem(given).first;
    described.replace_extension(".json");
    const bool has_range = settings_.dem_file.empty() && !std::filesystem::exists(described);
    return {has_range ? settings_.dem_range : "", settings_.dem_window};
  }

  void read_given_fields() {
    State& state = *inputs_.state;
    const auto read = [&](const Field<float>& spec, const std::string& given) {
      if (given.empty()) return;
      refuse_field_of_stage(spec, given);
      if (state.has(spec) || !is_still_read(run_.pipeline, plan_, spec)) return;
      FieldSpec read_as = spec;
      if (&spec == &field::ranking) read_as.units = "";  // an order has no unit
      state.set(spec,
                resample(read_field(given, read_as, run_.planet, image_words(given)), grid()));
    };
    read(field::erodibility, settings_.erodibility);
    read(field::uplift_rate, settings_.uplift_rate);
    read(field::ranking, settings_.ranking);
  }

  /// A field that a stage makes before another reads it has no use for given values.
  void refuse_field_of_stage(const FieldSpec& spec, const std::string& given) const {
    for (int at = plan_.begin; at <= plan_.last; ++at) {
      const StageInfo& info = run_.stage(at).info();
      if (lists(info.reads, spec) || lists(info.optional, spec)) return;
      if (info.own_grid || !lists(info.writes, spec)) continue;
      throw ConfigurationError(
          fmt::format("fields.{} = {}: stage {} of this run makes {} itself: must be empty",
                      spec.name, given, info.name, spec.name));
    }
  }

  /// A run that leaves the first stage out has no use for what it begins with.
  void refuse_initial_conditions() const {
    const std::pair<std::string_view, const std::string*> given[] = {
        {"fields.plates", &settings_.plates},
        {"fields.plate_rotations", &settings_.plate_rotations},
        {"fields.initial_elevation", &settings_.initial_elevation},
        {"fields.initial_age", &settings_.initial_age},
        {"fields.start_frame", &settings_.start_frame}};
    for (const auto& [key, value] : given) {
      if (value->empty()) continue;
      throw ConfigurationError(
          fmt::format("{} = {}: is for stage {}, and this run begins with {}{}: must be empty", key,
                      *value, run_.name_of(0), run_.name_of(plan_.begin),
                      settings_.dem_file.empty() ? "" : ", with the elevation of --dem"));
    }
  }

  /// An initial elevation that was announced and not given.
  void refuse_missing_elevation() const {
    for (const Parameter& row : run_.stage(0).parameters()) {
      if (row.key() != "initial_elevation") continue;
      if (row.value() != ParameterValue(std::string("given"))) continue;
      throw ConfigurationError(fmt::format(
          "{} = given needs fields.initial_elevation, a NetCDF file of a planet's elevation",
          row.name));
    }
  }

  /// Static polygons and their finite rotations.
  void read_reconstructed_plates(bool has_polygons) {
    const std::string& rotations = settings_.plate_rotations;
    if (!has_polygons) {
      throw ConfigurationError(
          fmt::format("fields.plate_rotations = {}: rotations of GPlates need fields.plates, "
                      "polygons of GPlates in a file that ends in .geojson or .json",
                      rotations));
    }
    const std::string key = fmt::format("{}.sphere.time_myr", run_.name_of(0));
    const Parameter* time_myr = find_parameter(run_.parameters, key);
    if (time_myr == nullptr) throw Bug("a run without " + key + " begins with plates");
    GivenReconstruction given =
        read_reconstruction(settings_.plates, rotations, settings_.rotations_from_ma,
                            std::get<double>(time_myr->value()));
    inputs_.plates = std::move(given.plates);
    inputs_.reconstruction = std::make_shared<const PlateReconstruction>(std::move(given.motion));
  }

  /// Outlines with their motions, with their finite rotations, or a raster of numbers and a table
  /// of motions.
  void read_plates() {
    const std::string& given = settings_.plates;
    const std::string& rotations = settings_.plate_rotations;
    const auto [file, variable] = split_dem(given);
    const std::string ending = file.extension();
    const bool has_outlines = given == "earth" || ending == ".geojson" || ending == ".json";
    const bool are_finite = std::filesystem::path(rotations).extension() == ".rot";
    if (are_finite) return read_reconstructed_plates(has_outlines && given != "earth");
    if (settings_.rotations_from_ma > 0.0) {
      throw ConfigurationError(
          fmt::format("fields.rotations_age_myr = {:g}: is for rotations of GPlates, and "
                      "fields.plate_rotations is {}: must be 0",
                      settings_.rotations_from_ma, rotations.empty() ? "empty" : rotations));
    }
    if (!rotations.empty() && (given.empty() || has_outlines)) {
      throw ConfigurationError(
          fmt::format("fields.plate_rotations = {}: is for plates by number, and fields.plates is "
                      "{}: must be empty",
                      rotations, given.empty() ? "empty" : given));
    }
    if (given.empty()) return;
    if (rotations.empty() && !has_outlines && std::filesystem::exists(file)) {
      throw ConfigurationError(
          fmt::format("fields.plates = {}: outlines are in files that end in .geojson or .json; "
                      "plates by number "
                      "need their motions, fields.plate_rotations",
                      given));
    }
    if (rotations.empty()) {
      inputs_.plates = read_plate_outlines(given);
      return;
    }
    const Dem numbers =
        read_field_with_gaps(given, field::plate_id, run_.planet, image_words(given));
    check_whole_planet(numbers, "fields.plates");
    inputs_.plates = plates_of_raster(numbers, Table::of_file(rotations));
  }

  /// The first plates and the initial elevation, as far as the first stage is still to come. Cells
  /// of the DEM are of one size whatever the grid of the run, so that the same planet comes of it.
  void read_initial_conditions() {
    if (plan_.begin != 0) refuse_initial_conditions();
    if (plan_.first != 0) return;
    read_plates();
    if (settings_.initial_elevation.empty()) return refuse_missing_elevation();
    constexpr GridSize kCells{2160, 1080};
    GivenElevation given{Grid::sphere(kCells.nx, kCells.ny, run_.planet.figure()), {}, {}};
    const Dem dem = read_dem(settings_.initial_elevation, run_.planet,
                             image_words(settings_.initial_elevation));
    check_whole_planet(dem, "fields.initial_elevation");
    check_heights(dem);
    given.elevation_m = resample(dem, given.grid);
    if (!settings_.initial_age.empty()) {
      const Dem age = read_field_with_gaps(settings_.initial_age, field::crust_age, run_.planet,
                                           image_words(settings_.initial_age));
      check_whole_planet(age, "fields.initial_age");
      given.age_myr = resample(age, given.grid);
    }
    inputs_.initial_elevation = std::make_shared<const GivenElevation>(std::move(given));
  }

  const RunConfiguration& run_;
  RunSettings& settings_;
  RunPlan& plan_;
  const std::function<void(const Grid&)>& on_grid_;
  RunInputs inputs_;
};

}  // namespace

RunInputs read_inputs(const RunConfiguration& run, RunPlan& plan, std::optional<State> loaded,
                      const std::function<void(const Grid&)>& on_grid) {
  return Reader(run, plan, std::move(loaded), on_grid).read();
}

void find_exemplars(RunInputs& inputs, const RunConfiguration& run, const RunPlan& plan) {
  const std::string& folder = run.settings.exemplars;
  for (int at = plan.first; at <= plan.last; ++at) {
    const std::string_view stage = run.name_of(at);
    if (!asks_for_exemplars(run.parameters, fmt::format("{}.detail", stage))) continue;
    if (run.stage(at).info().own_grid) {
      if (!inputs.exemplars) inputs.exemplars = exemplars_of(folder, run.planet);
    } else if (!inputs.planet_exemplars) {
      const Parameter* longest_km =
          find_parameter(run.parameters, fmt::format("{}.detail_longest_km", stage));
      const double longest_m = 1e3 * std::get<double>(longest_km->value());
      inputs.planet_exemplars = planet_exemplars_of(folder, run.planet, longest_m, inputs.warnings);
    }
  }
}

Context context_of(const RunInputs& inputs, const RunConfiguration& run, const RunPlan& plan) {
  Context context;
  context.planet = planet_with_sea(run, plan);
  context.seed = static_cast<std::uint64_t>(run.settings.seed);
  context.hypsography = hypsography_of(run);
  context.plates = inputs.plates;
  context.reconstruction = inputs.reconstruction;
  context.initial_elevation = inputs.initial_elevation;
  context.exemplars = inputs.exemplars;
  context.planet_exemplars = inputs.planet_exemplars;
  context.events = run.settings.events;
  if (!run.settings.start_frame.empty()) {
    context.checkpoint =
        std::make_shared<const Checkpoint>(read_checkpoint(run.settings.start_frame));
  }
  return context;
}

}  // namespace geo::io
