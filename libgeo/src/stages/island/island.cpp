#include "geo/stages/island/island.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "geo/core/error.hpp"
#include "geo/kernels/landscape/region_score.hpp"
#include "geo/kernels/landscape/river_courses.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/inflow.hpp"
#include "geo/stages/biomes/biomes.hpp"
#include "geo/stages/climate/climate.hpp"
#include "geo/stages/erosion/erosion.hpp"
#include "geo/stages/hydrology/hydrology.hpp"
#include "island_climate.hpp"
#include "island_edge.hpp"
#include "island_erosion.hpp"
#include "island_floodplain.hpp"
#include "island_surface.hpp"
#include "island_window.hpp"
#include "stages/climate/climate_events.hpp"
#include "stages/isostasy/guided_by_folds.hpp"

namespace geo {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Gives parameters the values that their namesakes have in the run.
void configure(std::span<const Parameter> own, std::span<const Parameter> run) {
  for (const Parameter& parameter : own) {
    if (const Parameter* outside = find_parameter(run, parameter.name)) {
      parameter.set(outside->value());
    }
  }
}

/// Reads "LAT,LON".
Centre parse_centre(const std::string& text) {
  Centre centre;
  const char* const end = text.data() + text.size();
  const auto [comma, first] = std::from_chars(text.data(), end, centre.latitude_deg);
  bool sound = first == std::errc() && comma != end && *comma == ',';
  if (sound) {
    const auto [stop, second] = std::from_chars(comma + 1, end, centre.longitude_deg);
    sound = second == std::errc() && stop == end;
  }
  // NaN-safe: a comparison with NaN is false.
  sound = sound && std::abs(centre.latitude_deg) <= 90.0 && std::abs(centre.longitude_deg) <= 360.0;
  if (!sound) {
    throw ConfigurationError(fmt::format(
        "island.center = \"{}\": must be LAT,LON in degrees, latitude within 90 and longitude "
        "within 360 of 0, or auto",
        text));
  }
  centre.longitude_deg = std::remainder(centre.longitude_deg, 360.0);
  return centre;
}

/// Bottoms of the planet's endorheic basins: the lowest land cell in each planet cell that keeps
/// its water.
void add_endorheic_bottoms(const PlanetCells& cells, std::span<const Index> receiver,
                           std::span<const float> z, Bytes& outlets) {
  std::vector<Index> lowest(cells.size(), kNoCell);
  const std::size_t first = static_cast<std::size_t>(cells.first_row()) * cells.planet().nx();
  for (Index c = 0; c < cells.fine().size(); ++c) {
    const Index cell = cells.cell_of()[c];
    if (z[c] < 0.0F || receiver[cell] != cell) continue;
    Index& best = lowest[cell - first];
    if (best == kNoCell || z[c] < z[best]) best = c;
  }
  for (const Index bottom : lowest) {
    if (bottom != kNoCell) outlets[bottom] = 1;
  }
}

/// Some fields, and besides them what stages that run inside write.
std::vector<const FieldSpec*> with_outputs_of(std::initializer_list<std::unique_ptr<Stage>> inside,
                                              std::vector<const FieldSpec*> fields) {
  for (const auto& stage : inside) {
    for (const FieldSpec* spec : stage->info().writes) {
      if (!lists(fields, *spec)) fields.push_back(spec);
    }
  }
  return fields;
}

class IslandStage final : public Stage {
 public:
  explicit IslandStage(IslandParameters parameters) : p_(std::move(parameters)) {}
  [[nodiscard]] const StageInfo& info() const override {
    return follows_exemplars() ? guided_ : info_;
  }
  [[nodiscard]] std::vector<Parameter> parameters() override { return p_.declarations(); }
  [[nodiscard]] StageCost cost(std::span<const Parameter> /*configuration*/) const override {
    return {.per_cell_ns = 5000.0, .cell_bytes = 210.0, .fixed_bytes = 65e6};
  }

  void check(const Grid& grid,
             const std::function<bool(const FieldSpec&)>& /*has*/) const override {
    if (grid.topology() != Topology::sphere) {
      throw ConfigurationError(
          "stage island needs a whole planet: this grid is a part of one; run --to biomes");
    }
    const Centre centre = p_.center == "auto" ? Centre{} : parse_centre(p_.center);
    Grid::check_equal_area(static_cast<int>(p_.nx), static_cast<int>(p_.ny), p_.cell_m, centre,
                           grid.figure());
  }

  void run(StageIo& io, Context& context) const override {
    const IslandWindow window(p_, centre(io, context), io.grid().figure());
    State state(window.island());
    context.budget["center_latitude_degree"] = state.grid().centre()->latitude_deg;
    context.budget["center_longitude_degree"] = state.grid().centre()->longitude_deg;
    Shaped ground = shape_surface(io, context, window, state);
    context.advance(0.6);
    // What the air and the water do depends on each other's surface: climate before hydrology.
    make_climate(io, context, PlanetCells(io.grid(), state.grid()), ground.planets_m, state);
    context.advance(0.75);
    make_water_and_life(context, std::move(ground.shut), std::move(ground.toughness), state);
    io.hand_over(std::move(state));
  }

 private:
  [[nodiscard]] Centre centre(const StageIo& io, const Context& context) const {
    if (p_.center != "auto") return parse_centre(p_.center);
    const Grid& planet = io.grid();
    const Index best =
        best_region(planet, io.read(field::elevation), io.read_optional(field::boundary_type),
                    p_.nx * p_.cell_m, p_.ny * p_.cell_m, context.seed,
                    p_.choose_by == "whole" ? RegionRule::whole : RegionRule::figures);
    return planet.position(planet.column(best), planet.row(best));
  }

  [[nodiscard]] bool follows_exemplars() const { return p_.detail == "exemplars"; }

  [[nodiscard]] PlanetTerrain terrain_of(const StageIo& io) const {
    const auto guide = [&]<class T>(const Field<T>& spec) {
      return follows_exemplars() ? io.read_optional(spec) : std::span<const T>{};
    };
    return {io.read(field::elevation),
            io.read_optional(field::boundary_type),
            io.read_optional(field::erodibility),
            guide(field::orogeny_type),
            guide(field::orogeny_age),
            guide(field::fold_direction_east),
            guide(field::fold_direction_north)};
  }

  [[nodiscard]] std::shared_ptr<const ExemplarLibrary> exemplars_of(const Context& context) const {
    if (!follows_exemplars()) return {};
    if (context.exemplars) return context.exemplars;
    return std::make_shared<const ExemplarLibrary>(grow_exemplars());
  }

  /// What is known of the finished surface beside the island's fields.
  struct Shaped {
    std::vector<float> planets_m;  ///< the planet's interpolated heights
    std::vector<float> toughness;  ///< of the ground that breaches go through
    Bytes shut;                    ///< where water does not leave over the edge
  };

  /// Makes the surface on the wide grid, and crops it with what comes in over the island's edge.
  Shaped shape_surface(const StageIo& io, Context& context, const IslandWindow& window,
                       State& state) const {
    ErosionParameters law;
    configure(law.declarations(), context.configuration);
    const Grid& fine = window.wide();
    const PlanetCells cells(io.grid(), fine);
    context.advance(0.1);
    const PlanetTerrain planet = terrain_of(io);
    std::vector<float> z(fine.size()), planets_m(fine.size());
    const auto exemplars = exemplars_of(context);
    raise_island(cells, planet, p_, exemplars.get(), context.seed, planets_m, z);

    std::vector<double> inflow_area(fine.size());
    std::vector<float> inflow(fine.size());
    const PlanetWater water{planet.elevation_m, io.read(field::flow_receiver),
                            io.read(field::drainage_area), io.read(field::discharge),
                            io.read_optional(field::lake_id)};
    const auto crossings = find_inflow(cells, water, z, inflow_area, inflow);
    RiverCourses courses = trace_river_courses(cells, water, crossings, context.seed, z);
    Bytes edges = find_outlets(fine, z), held = edges;
    for (std::size_t c = 0; c < edges.size(); ++c) {
      if (inflow_area[c] > 0.0) edges[c] = 0;
    }
    open_river_courses(fine, edges, courses, z);
    Bytes outlets = edges, ways_out = edges;
    add_endorheic_bottoms(cells, io.read(field::flow_receiver), z, outlets);
    add_ways_out(fine, z, ways_out);
    for (std::size_t c = 0; c < held.size(); ++c) {
      ways_out[c] |= outlets[c];
      held[c] |= ways_out[c];
    }

    const auto erodibility = island_erodibility(cells, planet, p_, law);
    const IslandErosion done = wear_island(
        cells, p_, law, {ways_out, held, inflow_area, erodibility},
        [&](double share) { context.advance(0.2 + 0.4 * share); }, z);
    roughen_floodplains(cells, p_, context.seed, held, z);
    open_river_courses(fine, edges, courses, z);

    const Bytes lake = fill_hollows_across_edge(window, cells, outlets, water.lake_id, z);
    IslandEdge edge = find_island_edge(window, cells, {z, outlets, inflow_area, inflow, lake},
                                       io.read(field::precipitation),
                                       io.read(field::potential_evapotranspiration));
    state.set(field::inflow_area, std::move(edge.inflow_area_m2));
    state.set(field::inflow_discharge, std::move(edge.inflow_m3_s));
    state.set(field::elevation, window.crop(z));
    report_erosion(*window.island(), {window.crop(done.lowered_m), window.crop(done.raised_m)},
                   context.budget, state);
    return {window.crop(planets_m), window.crop(courses.toughness), std::move(edge.shut)};
  }

  void report_erosion(const Grid& fine, const IslandErosion& done, Budget& budget,
                      State& state) const {
    const auto uplift = state.update(field::uplift_rate), rate = state.update(field::erosion_rate);
    const double time_yr = p_.erosion_steps * p_.time_step_yr;
    double raised = 0.0, eroded = 0.0;
    for (std::size_t c = 0; c < uplift.size(); ++c) {
      raised += done.raised_m[c];
      eroded += done.lowered_m[c];
      if (time_yr == 0.0) continue;
      uplift[c] = static_cast<float>(done.raised_m[c] / time_yr);
      rate[c] = static_cast<float>(done.lowered_m[c] / time_yr);
    }
    budget["rock_uplifted_m3"] = raised * fine.area_m2(0);
    budget["rock_eroded_m3"] = eroded * fine.area_m2(0);
    budget["rock_stored_m3"] = (raised - eroded) * fine.area_m2(0);
    budget["time_yr"] = time_yr;
  }

  void make_climate(const StageIo& io, const Context& context, const PlanetCells& cells,
                    std::span<const float> planets_m, State& state) const {
    ClimateParameters climate;
    configure(climate.declarations(), context.configuration);
    const ClimateFields<const float> from{
        io.read(field::temperature),       io.read(field::temperature_range),
        io.read(field::precipitation),     io.read(field::precipitation_seasonality),
        io.read(field::wind_east),         io.read(field::wind_north),
        io.read(field::distance_to_coast), io.read(field::potential_evapotranspiration)};
    const ClimateFields<float> to{
        state.update(field::temperature),       state.update(field::temperature_range),
        state.update(field::precipitation),     state.update(field::precipitation_seasonality),
        state.update(field::wind_east),         state.update(field::wind_north),
        state.update(field::distance_to_coast), state.update(field::potential_evapotranspiration)};
    island_climate(cells, climate,
                   {context.planet.pressure_bar, aerosol_of(context.events, context.planet)}, p_,
                   {io.read(field::elevation), planets_m, state.read(field::elevation)}, from, to);
  }

  void make_water_and_life(Context& context, Bytes shut, std::vector<float> toughness,
                           State& state) const {
    HydrologyParameters hydrology;
    configure(hydrology.declarations(), context.configuration);
    hydrology.river_threshold_m3_s = p_.river_threshold_m3_s;
    hydrology.river_reference_m3_s = p_.river_reference_m3_s;
    hydrology.channel_area_km2 = p_.channel_area_km2;
    run_inside(*make_hydrology_stage(hydrology, std::move(shut), std::move(toughness)), 0.75, 0.92,
               context, state);

    BiomesParameters biomes;
    configure(biomes.declarations(), context.configuration);
    biomes.smoothing_km = p_.biome_smoothing_km;
    biomes.river_weight = p_.river_weight;
    biomes.coast_weight = p_.coast_weight;
    run_inside(*make_biomes_stage(biomes), 0.92, 1.0, context, state);
  }

  /// Runs another stage on the island, from `begin` to `end` of this one's progress.
  static void run_inside(const Stage& stage, double begin, double end, Context& context,
                         State& state) {
    Context inner;
    inner.planet = context.planet;
    inner.seed = context.seed;
    inner.stop = context.stop;
    inner.on_progress = [&](double share) { context.advance(begin + share * (end - begin)); };
    StageIo io(state, stage.info());
    stage.run(io, inner);
    context.budget.merge(inner.budget);
    context.warnings.insert(context.warnings.end(), inner.warnings.begin(), inner.warnings.end());
  }

  IslandParameters p_;
  StageInfo info_{
      .name = "island",
      .doc = "a part of the planet in detail, on an equal-area grid of its own",
      .reads = {&field::elevation, &field::flow_receiver, &field::drainage_area, &field::discharge,
                &field::temperature, &field::temperature_range, &field::precipitation,
                &field::precipitation_seasonality, &field::wind_east, &field::wind_north,
                &field::distance_to_coast, &field::potential_evapotranspiration},
      .optional = {&field::boundary_type, &field::erodibility, &field::lake_id},
      .writes = with_outputs_of(
          {make_hydrology_stage(), make_biomes_stage()},
          {&field::elevation, &field::uplift_rate, &field::erosion_rate, &field::drainage_area,
           &field::inflow_area, &field::inflow_discharge, &field::flow_receiver,
           &field::flow_direction, &field::temperature, &field::temperature_range,
           &field::precipitation, &field::precipitation_seasonality, &field::wind_east,
           &field::wind_north, &field::distance_to_coast, &field::potential_evapotranspiration}),
      .own_grid = true};
  StageInfo guided_ = guided_by_folds(info_);
};

}  // namespace

std::unique_ptr<Stage> make_island_stage(IslandParameters parameters) {
  return std::make_unique<IslandStage>(std::move(parameters));
}

}  // namespace geo
