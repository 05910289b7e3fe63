#include "geo/stages/hydrology/hydrology.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "geo/core/release.hpp"
#include "geo/kernels/water/breaching.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/flow_graph.hpp"
#include "geo/kernels/water/lakes.hpp"
#include "geo/kernels/water/rivers.hpp"
#include "geo/kernels/water/valley_width.hpp"
#include "geo/kernels/water/water_balance.hpp"

namespace geo {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes sea_cells(std::span<const float> z) {
  Bytes sea(z.size());
#pragma omp parallel for schedule(static)
  for (std::size_t c = 0; c < z.size(); ++c) sea[c] = z[c] < 0 ? 1 : 0;
  return sea;
}

/// Water and ways of a finished surface.
struct Drainage {
  DepressionHierarchy hierarchy;
  Lakes lakes;
  FlowGraph graph;
};

Drainage drain(const Grid& grid, std::span<const float> z, const Bytes& outlets,
               std::span<const double> runoff, std::span<const float> loss) {
  Drainage d;
  d.graph.receiver.resize(grid.size());
  steepest_receivers(grid, z, outlets, d.graph.receiver);
  d.hierarchy = build_depression_hierarchy(grid, z, outlets, d.graph.receiver);
  d.lakes = balance_lakes(grid, z, d.hierarchy, runoff, loss);
  connect_lakes(d.lakes, d.graph.receiver);
  d.graph.put_in_order();
  return d;
}

/// Where water ends: outlets, and the bottoms of the basins that keep theirs before any depression
/// is breached. Not those behind what a coarse elevation model has made of a gorge: basins smaller
/// than `least_m2` when full to their sill, and those that so much water comes to that its valley,
/// times `gorge_factor`, would be as deep as the sill is high above the bottom.
Bytes with_closed_basins(const Grid& grid, std::span<const float> z, Bytes outlets,
                         std::span<const double> runoff, std::span<const float> loss,
                         double least_m2, double gorge_factor) {
  const Drainage d = drain(grid, z, outlets, runoff, loss);
  const auto& depressions = d.hierarchy.depressions;
  // Parents stand behind their children.
  std::vector<std::int32_t> whole(depressions.size());
  for (auto n = static_cast<std::int32_t>(depressions.size()); n-- > 0;) {
    whole[n] = depressions[n].parent == kSea ? n : whole[depressions[n].parent];
  }
  std::vector<double> comes_m3_s(depressions.size(), 0.0);
  for (const Lake& lake : d.lakes.lakes) comes_m3_s[whole[lake.depression]] += lake.inflow_m3_s;
  for (std::int32_t leaf = 0; leaf < d.hierarchy.leaves; ++leaf) {
    if (d.lakes.exit_of_leaf[leaf].inside != kNoCell) continue;
    const Depression& basin = depressions[whole[leaf]];
    const double rim_m = basin.sill_m - z[basin.pit];
    if (basin.area_m2 >= least_m2 && gorge_factor * valley_depth(comes_m3_s[whole[leaf]]) < rim_m) {
      outlets[depressions[leaf].pit] = 1;
    }
  }
  return outlets;
}

/// Discharge out of each cell: runoff and what lakes lose, downstream. `water` holds the runoff.
void accumulate_discharge(const Drainage& d, std::span<double> water) {
  for (const Lake& lake : d.lakes.lakes) {
    water[lake.outlet == kNoCell ? lake.bottom : lake.outlet] -= lake.loss_m3_s;
  }
  d.graph.accumulate(water);
}

/// What leaves the land: over the shore, or over an open edge.
double runoff_to_sea(const FlowGraph& graph, const Bytes& outlets, std::span<const double> water) {
  double sum = 0.0;
  for (std::size_t c = 0; c < water.size(); ++c) {
    if (outlets[c] != 0 && graph.receiver[c] == static_cast<Index>(c)) sum += water[c];
  }
  return sum;
}

/// Discharge as the field has it: that of the whole lake on its cells, none at sea.
void write_discharge(const Drainage& d, const Bytes& sea, std::span<const double> water,
                     std::span<const float> lake_depth, std::span<float> discharge) {
#pragma omp parallel for schedule(static)
  for (std::size_t c = 0; c < water.size(); ++c) {
    double q = sea[c] != 0 ? 0.0 : std::max(water[c], 0.0);
    if (lake_depth[c] > 0) {
      const Lake& lake = d.lakes.lakes[d.lakes.lake_of_leaf[d.hierarchy.leaf_of_cell[c]]];
      q = lake.outlet == kNoCell ? lake.inflow_m3_s : lake.inflow_m3_s - lake.loss_m3_s;
    }
    discharge[c] = static_cast<float>(q);
  }
}

/// Hollows that ice has scoured are no spurious depressions of a coarse elevation model: their pits
/// keep their sills.
Bytes with_scoured_basins(const Grid& grid, std::span<const float> z,
                          std::span<const float> scoured_m, Bytes outlets) {
  if (scoured_m.empty()) return outlets;
  constexpr float kScoured_m = 20.0F;
  std::vector<Index> receiver(grid.size());
  steepest_receivers(grid, z, outlets, receiver);
  for (Index c = 0; c < grid.size(); ++c) {
    if (receiver[c] == c && scoured_m[c] >= kScoured_m) outlets[c] = 1;
  }
  return outlets;
}

/// Water does not leave where it comes in, nor where the edge is shut.
Bytes open_outlets(Bytes outlets, std::span<const double> inflow_area, const Bytes& shut) {
  for (std::size_t c = 0; c < inflow_area.size(); ++c) {
    if (inflow_area[c] > 0) outlets[c] = 0;
  }
  for (std::size_t c = 0; c < shut.size(); ++c) {
    if (shut[c] != 0) outlets[c] = 0;
  }
  return outlets;
}

/// Adds what comes from beyond the edge to the runoff; returns its sum, m3/s.
double add_inflow(std::span<const float> inflow_m3_s, std::span<double> water) {
  double sum = 0.0;
  for (std::size_t c = 0; c < inflow_m3_s.size(); ++c) {
    water[c] += inflow_m3_s[c];
    sum += inflow_m3_s[c];
  }
  return sum;
}

class HydrologyStage final : public Stage {
 public:
  HydrologyStage(HydrologyParameters parameters, Bytes shut, std::vector<float> toughness)
      : p_(std::move(parameters)), shut_(std::move(shut)), toughness_(std::move(toughness)) {}
  [[nodiscard]] const StageInfo& info() const override { return info_; }
  [[nodiscard]] std::vector<Parameter> parameters() override { return p_.declarations(); }
  [[nodiscard]] StageCost cost(std::span<const Parameter> /*configuration*/) const override {
    return {.per_cell_ns = 150.0, .cell_bytes = 108.0};
  }

  void run(StageIo& io, Context& context) const override {
    const Grid& grid = io.grid();
    const auto temperature = io.read(field::temperature);
    const auto z = io.write(field::elevation);
    const auto inflow_area = io.read_optional(field::inflow_area);
    const Bytes sea = sea_cells(z);
    const Bytes outlets = open_outlets(find_outlets(grid, z), inflow_area, shut_);

    std::vector<double> water(grid.size());
    std::vector<float> loss(grid.size());
    const LandWater land = land_water(grid, sea, io.read(field::precipitation),
                                      io.read(field::potential_evapotranspiration), water, loss);
    const double inflow = add_inflow(io.read_optional(field::inflow_discharge), water);
    context.advance(0.1);
    const Bytes closed = by_area() ? outlets
                                   : with_closed_basins(grid, z, outlets, water, loss,
                                                        1e6 * p_.closed_basin_km2, p_.gorge_factor);
    const Bytes kept =
        with_scoured_basins(grid, z, io.read_optional(field::glacial_erosion), closed);
    shape_valleys(grid, closed, kept, sea, water, inflow_area,
                  io.read_optional(field::ice_thickness), z);
    context.advance(0.5);

    Drainage d = drain(grid, z, outlets, water, loss);
    release(loss);
    context.advance(0.7);
    accumulate_discharge(d, water);
    report(context, land, inflow, d.lakes, runoff_to_sea(d.graph, outlets, water));

    const auto lake_depth = io.write(field::lake_depth);
    map_lakes(grid, z, d.hierarchy, d.lakes, frozen(d.lakes, temperature), lake_depth,
              io.write(field::lake_id));
    const auto discharge = io.write(field::discharge);
    write_discharge(d, sea, water, lake_depth, discharge);
    release(water);
    d.hierarchy = {};
    context.advance(0.8);

    write_network(grid, std::move(d.graph), sea, inflow_area, io);
    const auto slope = io.write(field::slope);
    steepest_slope(grid, z, sea, slope);
    write_rivers(grid, sea, discharge, slope, io);
    context.advance(1.0);
  }

 private:
  [[nodiscard]] bool by_area() const { return p_.rivers == "area"; }

  void write_rivers(const Grid& grid, const Bytes& sea, std::span<const float> discharge,
                    std::span<const float> slope, StageIo& io) const {
    const auto river = io.write(field::river_intensity);
    const auto area = io.write(field::drainage_area);
    const RiverScale scale =
        by_area() ? blueprint_river_scale(grid, area, sea, static_cast<double>(p_.carving_rounds))
                  : RiverScale{p_.river_threshold_m3_s, p_.river_reference_m3_s};
#pragma omp parallel for schedule(static)
    for (Index c = 0; c < grid.size(); ++c) {
      const double size = by_area() ? (sea[c] != 0 ? 0.0 : area[c]) : discharge[c];
      river[c] = river_prominence(size, slope[c], scale);
    }
  }

  /// What carves, m3/s, and from what on: the water that flows while every depression overflows,
  /// or the same runoff from everywhere.
  std::vector<double> carving_discharge(const Grid& grid, const FlowGraph& graph, const Bytes& sea,
                                        std::span<const double> runoff,
                                        std::span<const double> inflow_area,
                                        double& threshold_m3_s) const {
    threshold_m3_s = p_.river_threshold_m3_s;
    if (!by_area()) {
      std::vector<double> discharge(runoff.begin(), runoff.end());
      graph.accumulate(discharge);
      return discharge;
    }
    constexpr double kYear_s = 365.25 * 86400.0;
    const double runoff_m_s = 1e-3 * p_.carving_runoff_mm_yr / kYear_s;
    std::vector<double> area(grid.size());
    drain_area(grid, graph, inflow_area, area);
    threshold_m3_s =
        runoff_m_s * blueprint_river_scale(grid, area, sea, static_cast<double>(p_.carving_rounds))
                         .threshold_m3_s;
    for (double& flow : area) flow *= runoff_m_s;
    return area;
  }

  static void drain_area(const Grid& grid, const FlowGraph& graph,
                         std::span<const double> inflow_area, std::span<double> area) {
    for (int j = 0; j < grid.ny(); ++j) {
      std::fill_n(area.begin() + grid.cell(0, j), grid.nx(), grid.area_m2(j));
    }
    for (std::size_t c = 0; c < inflow_area.size(); ++c) area[c] += inflow_area[c];
    graph.accumulate(area);
  }

  /// Breaches spurious depressions, but for those of basins in `kept`, and carves valleys, as wide
  /// as cells are high where meridians converge; rivers are those that flow while every depression
  /// overflows.
  void shape_valleys(const Grid& grid, const Bytes& outlets, const Bytes& kept, const Bytes& sea,
                     std::span<const double> runoff, std::span<const double> inflow_area,
                     std::span<const float> ice_m, std::span<float> z) const {
    const std::vector<float> before(z.begin(), z.end());
    breach_depressions(grid, kept, {p_.breach_depth_m, p_.breach_length_km * 1000}, z, toughness_);
    const FlowGraph graph = route_water(grid, z, outlets).graph;
    double threshold_m3_s = 0.0;
    const std::vector<double> discharge =
        carving_discharge(grid, graph, sea, runoff, inflow_area, threshold_m3_s);
    grade_rivers(grid, graph, outlets, discharge, {p_.gorge_factor, p_.gorge_length_km * 1000}, z);
    if (p_.carving > 0) {
      const CarvingLaw law{p_.carving, static_cast<double>(p_.carving_rounds), threshold_m3_s,
                           p_.valley_blend, 1000 * p_.valley_width_km};
      carve_valleys(grid, graph, sea, discharge, law, z);
    }
    widen_valleys<float>(grid, before, sea, z);
    // Water runs below ice, not into it.
    for (std::size_t c = 0; c < ice_m.size(); ++c) {
      if (ice_m[c] > 0.0F) z[c] = before[c];
    }
  }

  [[nodiscard]] Bytes frozen(const Lakes& lakes, std::span<const float> temperature) const {
    Bytes hidden(lakes.lakes.size());
    for (std::size_t n = 0; n < hidden.size(); ++n) {
      hidden[n] = temperature[lakes.lakes[n].bottom] < p_.frozen_temperature_degc ? 1 : 0;
    }
    return hidden;
  }

  void write_network(const Grid& grid, FlowGraph graph, const Bytes& sea,
                     std::span<const double> inflow_area, StageIo& io) const {
    const auto area = io.write(field::drainage_area);
    drain_area(grid, graph, inflow_area, area);
    Bytes channel(grid.size());
#pragma omp parallel for schedule(static)
    for (Index c = 0; c < grid.size(); ++c) {
      channel[c] = sea[c] == 0 && area[c] > p_.channel_area_km2 * 1e6 ? 1 : 0;
    }
    strahler_order(graph, channel, io.write(field::stream_order));
    io.write(field::basin_id, number_basins(grid, graph, sea));
    graph.order = {};
    flow_directions(grid, graph.receiver, io.write(field::flow_direction));
    io.write(field::flow_receiver, std::move(graph.receiver));
  }

  static void report(Context& context, const LandWater& land, double inflow_m3_s,
                     const Lakes& lakes, double runoff_m3_s) {
    double lake_loss = 0.0;
    for (const Lake& lake : lakes.lakes) lake_loss += lake.loss_m3_s;
    const double supply = land.precipitation_m3_s + inflow_m3_s;
    const double error = supply - land.evaporation_m3_s - lake_loss - runoff_m3_s;
    if (inflow_m3_s > 0) context.budget["river_inflow_m3_s"] = inflow_m3_s;
    context.budget["land_precipitation_m3_s"] = land.precipitation_m3_s;
    context.budget["land_evaporation_m3_s"] = land.evaporation_m3_s;
    context.budget["lake_evaporation_m3_s"] = lake_loss;
    context.budget["runoff_to_sea_m3_s"] = runoff_m3_s;
    context.budget["water_closing_error"] = error / std::max(supply, 1e-30);
  }

  HydrologyParameters p_;
  Bytes shut_;
  std::vector<float> toughness_;
  StageInfo info_{"hydrology",
                  "runoff, lakes, rivers and basins; valleys carved by rivers",
                  {&field::elevation, &field::temperature, &field::precipitation,
                   &field::potential_evapotranspiration},
                  {&field::inflow_area, &field::inflow_discharge, &field::ice_thickness,
                   &field::glacial_erosion},
                  {&field::elevation, &field::slope, &field::flow_direction, &field::flow_receiver,
                   &field::drainage_area, &field::discharge, &field::river_intensity,
                   &field::lake_depth, &field::lake_id, &field::basin_id, &field::stream_order}};
};

}  // namespace

std::vector<Parameter> HydrologyParameters::declarations() {
  return {
      real("hydrology.breach_depth_m", breach_depth_m, "m", 0.0, 1e4,
           "deepest least-cost breach of a spurious depression; 0 breaches none", "lindsay2016"),
      real("hydrology.breach_length_km", breach_length_km, "km", 0.0, 1e4,
           "longest breach of a spurious depression", "lindsay2016"),
      real("hydrology.closed_basin_km2", closed_basin_km2, "km2", 0.0, 1e12,
           "area, when full to the sill, from which a basin that keeps its water stays closed, "
           "with rivers = discharge; smaller ones are breached as others are",
           "design"),
      real(
          "hydrology.gorge_factor", gorge_factor, "1", 0.0, 100.0,
          "deepest cut by a river through a barrier, over the depth of its valley, where a DEM has "
          "averaged gorges away; 0 cuts none: rivers of stage erosion have made their sills",
          "leopold1953"),
      real("hydrology.gorge_length_km", gorge_length_km, "km", 0.0, 1e5,
           "longest barrier that a river cuts through", "design"),
      real("hydrology.channel_area_km2", channel_area_km2, "km2", 0.0, 1e8,
           "drainage area from which a channel has a stream order", "design"),
      choice("hydrology.rivers", rivers, {"discharge", "area"},
             "what makes rivers: their discharge, or, as in the blueprint's 6.4 to 6.6a, the area "
             "that they drain, over the largest on the planet",
             "tectonica2026"),
      real("hydrology.river_threshold_m3_s", river_threshold_m3_s, "m3 s-1", 0.0, 1e7,
           "discharge from which a river shows and carves", "tectonica2026"),
      real("hydrology.river_reference_m3_s", river_reference_m3_s, "m3 s-1", 1.0, 1e8,
           "discharge of a river as prominent as rivers get", "tectonica2026"),
      real("hydrology.carving", carving, "1", 0.0, 10.0,
           "depth of river valleys over that of hydraulic geometry; 0 carves none", "leopold1953"),
      integer("hydrology.carving_rounds", carving_rounds, "1", 1, 100,
              "parts in which valleys are cut, each limited to 23 % of the height",
              "tectonica2026"),
      real("hydrology.carving_runoff_mm_yr", carving_runoff_mm_yr, "mm yr-1", 0.0, 10000.0,
           "runoff from everywhere whose rivers carve, with rivers = area", "fekete2002"),
      real("hydrology.valley_blend", valley_blend, "1", 0.0, 1.0,
           "share by which valley sides are lowered towards the mean of their neighbours",
           "tectonica2026"),
      real("hydrology.valley_width_km", valley_width_km, "km", 0.01, 1e6,
           "width of a carved valley with its sides; larger cells are lowered by the share of the "
           "cell that it takes",
           "design"),
      real("hydrology.frozen_temperature_degc", frozen_temperature_degc, "degC", -300.0, 100.0,
           "annual mean below which depressions hold ice instead of a lake", "design"),
  };
}

std::unique_ptr<Stage> make_hydrology_stage(HydrologyParameters parameters,
                                            std::vector<std::uint8_t> shut,
                                            std::vector<float> toughness) {
  return std::make_unique<HydrologyStage>(std::move(parameters), std::move(shut),
                                          std::move(toughness));
}

}  // namespace geo
