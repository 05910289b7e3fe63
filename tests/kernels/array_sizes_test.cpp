// Kernels refuse arrays that do not fit: each array of each kernel, one value too short.
#include "geo/core/array_sizes.hpp"

#include <gmock/gmock.h>

#include "geo/core/error.hpp"
#include "geo/kernels/climate/blueprint_climate.hpp"
#include "geo/kernels/climate/circulation.hpp"
#include "geo/kernels/climate/distance_to_coast.hpp"
#include "geo/kernels/climate/energy_balance.hpp"
#include "geo/kernels/climate/evaporation.hpp"
#include "geo/kernels/climate/moisture.hpp"
#include "geo/kernels/climate/mountain_barrier.hpp"
#include "geo/kernels/climate/ocean_heat.hpp"
#include "geo/kernels/climate/orography.hpp"
#include "geo/kernels/climate/seasonal_climate.hpp"
#include "geo/kernels/climate/stationary_wave.hpp"
#include "geo/kernels/landscape/deltas.hpp"
#include "geo/kernels/landscape/hypsometric_curve.hpp"
#include "geo/kernels/landscape/marine_deposition.hpp"
#include "geo/kernels/landscape/plastic_ice.hpp"
#include "geo/kernels/landscape/region_score.hpp"
#include "geo/kernels/landscape/river_courses.hpp"
#include "geo/kernels/landscape/river_sediment.hpp"
#include "geo/kernels/landscape/straits.hpp"
#include "geo/kernels/landscape/stream_power.hpp"
#include "geo/kernels/landscape/surface_detail.hpp"
#include "geo/kernels/numerics/diffusion.hpp"
#include "geo/kernels/remapping/conservative_remapping.hpp"
#include "geo/kernels/remapping/healpix.hpp"
#include "geo/kernels/remapping/planet_cells.hpp"
#include "geo/kernels/remapping/turned_planet.hpp"
#include "geo/kernels/water/breaching.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/flow_graph.hpp"
#include "geo/kernels/water/inflow.hpp"
#include "geo/kernels/water/lakes.hpp"
#include "geo/kernels/water/multiple_flow.hpp"
#include "geo/kernels/water/rivers.hpp"
#include "geo/kernels/water/surface_rivers.hpp"
#include "geo/kernels/water/valley_width.hpp"
#include "geo/kernels/water/water_balance.hpp"
#include "kernels/refused_arrays.hpp"

namespace geo {
namespace {

using namespace refused_arrays;
using testing::HasSubstr;

FlowGraph graph_of(Lengths& n, bool ordered) {
  FlowGraph graph;
  graph.receiver.resize(n(cells()));
  graph.order.resize(ordered ? n(cells()) : cells());
  return graph;
}

TEST(ArraySizes, AreThoseAskedForOrEmptyOrSingleWhereThatIsAllowed) {
  using May = ArraySize::May;
  EXPECT_NO_THROW(
      check_sizes("k", 3, {{"a", 3}, {"b", 0, May::be_empty}, {"c", 1, May::be_single}}));
  EXPECT_THROW(check_sizes("k", 3, {{"a", 0}}), Bug);
  EXPECT_THROW(check_sizes("k", 3, {{"a", 1, May::be_empty}}), Bug);
  EXPECT_THROW(check_sizes("k", 3, {{"a", 0, May::be_single}}), Bug);
  try {
    check_sizes("incise", 3, {{"area_m2", 3}, {"elevation_m", 2}});
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Bug& error) {
    EXPECT_STREQ(error.what(), "incise: elevation_m has 2 values: must have 3");
  }
}

TEST(ArraySizes, OfRoutingAreChecked) {
  const Grid& grid = planet();
  expect_refused("find_outlets", 1, [&](Lengths& n) { find_outlets(grid, Floats(n(cells()))); });
  expect_refused("steepest_receivers", 3, [&](Lengths& n) {
    const Floats z(n(cells()));
    const Bytes outlets(n(cells()));
    std::vector<Index> receiver(n(cells()));
    steepest_receivers(grid, z, outlets, receiver);
  });
  expect_refused("route_water", 2, [&](Lengths& n) {
    const Floats z(n(cells()));
    route_water(grid, z, Bytes(n(cells())));
  });
  expect_refused("fill_depressions", 3, [&](Lengths& n) {
    const Floats z(n(cells()));
    const Bytes outlets(n(cells()));
    Floats filled(n(cells()));
    fill_depressions(grid, z, outlets, filled);
  });
  expect_refused("build_depression_hierarchy", 3, [&](Lengths& n) {
    const Floats z(n(cells()));
    const Bytes outlets(n(cells()));
    build_depression_hierarchy(grid, z, outlets, std::vector<Index>(n(cells())));
  });
  expect_refused("accumulate", 2, [&](Lengths& n) {
    FlowGraph graph;
    graph.receiver.resize(cells());
    graph.order.resize(n(cells()));
    Doubles values(n(cells()));
    graph.accumulate(values);
  });
  expect_refused("number_basins", 2, [&](Lengths& n) {
    const FlowGraph graph = graph_of(n, false);
    number_basins(grid, graph, Bytes(n(cells())));
  });
  expect_refused("strahler_order", 2, [&](Lengths& n) {
    FlowGraph graph;
    graph.receiver.resize(cells());
    const Bytes channel(n(cells()));
    std::vector<std::int8_t> order(n(cells()));
    strahler_order(graph, channel, order);
  });
  expect_refused(
      "accumulate_flow", 3,
      [&](Lengths& n) {
        const Floats surface(n(cells()));
        const std::vector<Index> receiver(n(cells()));
        Doubles values(n(cells()));
        accumulate_flow(grid, surface, receiver, {}, values);
      },
      ErrorKind::input);
}

TEST(ArraySizes, OfRiversAndLakesAreChecked) {
  const Grid& grid = planet();
  expect_refused("steepest_slope", 3, [&](Lengths& n) {
    const Floats z(n(cells()));
    const Bytes sea(n(cells()));
    Floats slope(n(cells()));
    steepest_slope(grid, z, sea, slope);
  });
  expect_refused("flow_directions", 2, [&](Lengths& n) {
    const std::vector<Index> receiver(n(cells()));
    std::vector<std::int8_t> direction(n(cells()));
    flow_directions(grid, receiver, direction);
  });
  expect_refused("blueprint_river_scale", 2, [&](Lengths& n) {
    const Doubles area(n(cells()));
    blueprint_river_scale(grid, area, Bytes(n(cells())), 1.0);
  });
  expect_refused("carve_valleys", 4, [&](Lengths& n) {
    const FlowGraph graph = graph_of(n, false);
    const Bytes sea(n(cells()));
    const Doubles discharge(n(cells()));
    Floats z(n(cells()));
    carve_valleys(grid, graph, sea, discharge, {}, z);
  });
  expect_refused("breach_depressions", 3, [&](Lengths& n) {
    const Bytes outlets(n(cells()));
    Floats z(n(cells()));
    const Floats toughness(n(cells()));
    breach_depressions(grid, outlets, {}, z, toughness);
  });
  expect_refused("grade_rivers", 4, [&](Lengths& n) {
    const FlowGraph graph = graph_of(n, false);
    const Bytes outlets(n(cells()));
    const Doubles discharge(n(cells()));
    Floats z(n(cells()));
    grade_rivers(grid, graph, outlets, discharge, {}, z);
  });
  expect_refused("widen_valleys", 3, [&](Lengths& n) {
    const Floats before(n(cells()));
    const Bytes fixed(n(cells()));
    Floats z(n(cells()));
    widen_valleys<float>(grid, before, fixed, z);
  });
  expect_refused("land_water", 5, [&](Lengths& n) {
    const Bytes sea(n(cells()));
    const Floats rain(n(cells())), potential(n(cells()));
    Doubles runoff(n(cells()));
    Floats loss(n(cells()));
    land_water(grid, sea, rain, potential, runoff, loss);
  });
  expect_refused("balance_lakes", 3, [&](Lengths& n) {
    const Floats z(n(cells()));
    const Doubles runoff(n(cells()));
    balance_lakes(grid, z, {}, runoff, Floats(n(cells())));
  });
  expect_refused("map_lakes", 4, [&](Lengths& n) {
    Lakes lakes;
    lakes.lakes.resize(2);
    const Floats z(n(cells()));
    const Bytes hidden(n(2));
    Floats depth(n(cells()));
    std::vector<std::int32_t> id(n(cells()));
    map_lakes(grid, z, {}, lakes, hidden, depth, id);
  });
  expect_refused("run_rivers", 3, [&](Lengths& n) {
    SurfaceRivers rivers;
    rivers.receiver.resize(n(cells()));
    const std::vector<std::int8_t> is_rock(n(cells()));
    Floats z(cells()), rock(n(cells()));
    run_rivers({}, rivers, {}, is_rock, z, rock);
  });
}

TEST(ArraySizes, OfLandscapesAreChecked) {
  const Grid& grid = planet();
  expect_refused("incise", 5, [&](Lengths& n) {
    const FlowGraph graph = graph_of(n, true);
    const Doubles area(n(cells()));
    const Floats erodibility(n(cells()));
    Floats z(n(cells()));
    incise<float, float>(grid, graph, area, erodibility, {}, z);
  });
  expect_refused("incision_rate", 5, [&](Lengths& n) {
    const FlowGraph graph = graph_of(n, false);
    const Doubles area(n(cells()));
    const Floats erodibility(n(cells())), z(n(cells()));
    Floats rate(n(cells()));
    incision_rate(grid, graph, area, erodibility, {}, z, rate);
  });
  expect_refused("incise_and_deposit", 6, [&](Lengths& n) {
    const FlowGraph graph = graph_of(n, true);
    const Doubles area(n(cells()));
    const Floats erodibility(n(cells()));
    const Bytes flooded(n(cells()));
    Floats z(n(cells()));
    incise_and_deposit<float, float>(grid, graph, area, erodibility, {}, 1.0, flooded, z);
  });
  expect_refused("sediment_outflow", 4, [&](Lengths& n) {
    const FlowGraph graph = graph_of(n, true);
    const Floats before(n(cells())), after(n(cells()));
    sediment_outflow<float>(grid, graph, before, after);
  });
  expect_refused("flooded_cells", 2, [&](Lengths& n) {
    FlowGraph graph;
    graph.receiver.resize(cells());
    graph.order.resize(n(cells()));
    const Floats z(n(cells()));
    flooded_cells<float>(graph, z);
  });
  expect_refused("breach_sills", 3, [&](Lengths& n) {
    const FlowGraph graph = graph_of(n, true);
    Floats z(n(cells()));
    breach_sills<float>(grid, graph, z);
  });
  expect_refused("lay_at_sea", 3, [&](Lengths& n) {
    const Bytes sea(n(cells()));
    const Doubles room(n(cells()));
    Doubles supply(n(cells()));
    lay_at_sea<double>(grid, sea, 1e4, room, supply);
  });
  expect_refused("build_deltas", 4, [&](Lengths& n) {
    const Bytes sea(n(cells()));
    const Floats z(n(cells()));
    Doubles volume(n(cells()));
    Floats laid(n(cells()));
    build_deltas(grid, {}, sea, z, volume, laid);
  });
  expect_refused("open_straits", 1, [&](Lengths& n) {
    Floats z(n(cells()));
    open_straits(grid, {}, z);
  });
  expect_refused("bend_hypsometry", 1, [&](Lengths& n) {
    Floats z(n(cells()));
    bend_hypsometry(grid, z, 400.0, 0.0);
  });
  expect_refused("bend_hypsometry_once", 1, [&](Lengths& n) {
    Floats z(n(cells()));
    bend_hypsometry_once(grid, z, 400.0, 0.0);
  });
  expect_refused("region_figures", 2, [&](Lengths& n) {
    const Floats z(n(cells()));
    region_figures(grid, z, std::vector<std::int8_t>(n(cells())), 0, 1e6, 1e6);
  });
  expect_refused("region_land", 1,
                 [&](Lengths& n) { region_land(grid, Floats(n(cells())), 0, 1e6, 1e6); });
  expect_refused("best_region", 2, [&](Lengths& n) {
    const Floats z(n(cells()));
    best_region(grid, z, std::vector<std::int8_t>(n(cells())), 1e6, 1e6, 1);
  });
  expect_refused(
      "plastic_ice_surface", 2,
      [&](Lengths& n) {
        const Floats bed(n(cells()));
        static_cast<void>(plastic_ice_surface(grid, 10.0, bed, std::vector<IceGround>(n(cells()))));
      },
      ErrorKind::input);
  expect_refused(
      "diffuse", 3,
      [&](Lengths& n) {
        Floats z(n(cells()));
        const Bytes fixed(n(cells())), excluded(n(cells()));
        diffuse(grid, std::span<float>(z), 1.0, 1.0, {.fixed = fixed, .excluded = excluded});
      },
      ErrorKind::input);
}

TEST(ArraySizes, OfClimateAreChecked) {
  const Grid& grid = planet();
  expect_refused("distance_to_coast", 2, [&](Lengths& n) {
    const Floats z(n(cells()));
    Floats distance(n(cells()));
    distance_to_coast(grid, z, distance);
  });
  expect_refused("upwind_lift", 4, [&](Lengths& n) {
    const Floats z(n(cells())), east(n(cells())), north(n(cells()));
    Floats lift(n(cells()));
    upwind_lift(grid, z, east, north, 4e4, lift);
  });
  expect_refused("balanced_winds", 5, [&](Lengths& n) {
    const Doubles latitude(n(rows()));
    const Floats land(n(cells())), pressure(n(cells()));
    Floats east(n(cells())), north(n(cells()));
    balanced_winds(grid, {}, latitude, land, pressure, east, north);
  });
  expect_refused("ocean_heat", 3, [&](Lengths& n) {
    const Doubles latitude(n(rows()));
    const Floats land(n(cells()));
    Doubles heat(n(cells()));
    ocean_heat(grid, {}, false, latitude, land, heat);
  });
  expect_refused("open_channels", 2, [&](Lengths& n) {
    const Doubles latitude(n(rows()));
    const Floats land(n(cells()));
    static_cast<void>(open_channels(grid, latitude, land));
  });
  expect_refused("solve_energy_balance", 4, [&](Lengths& n) {
    const Doubles latitude(n(rows()));
    const Floats land(n(cells())), height(n(cells())), ice(n(cells()));
    static_cast<void>(solve_energy_balance(grid, {}, false, latitude, land, height, {}, ice));
  });
  expect_refused("solve_seasonal_climate", 4, [&](Lengths& n) {
    const Doubles latitude(n(rows()));
    const Floats land(n(cells())), height(n(cells())), ice(n(cells()));
    static_cast<void>(solve_seasonal_climate(grid, {}, latitude, land, height, {}, ice));
  });
  expect_refused("stationary_wave", 9, [&](Lengths& n) {
    const Doubles latitude(n(rows())), wind(n(rows()));
    const Floats heating(n(cells())), push_east(n(cells())), push_north(n(cells()));
    const Floats height(n(cells()));
    Floats east(n(cells())), north(n(cells())), descent(n(cells()));
    stationary_wave(grid, {}, 7e-5, latitude, wind, {heating, push_east, push_north, height},
                    {east, north, descent});
  });
  expect_refused("cold_advection_k_s", 3, [&](Lengths& n) {
    const Floats warm(n(cells())), east(n(cells())), north(n(cells()));
    static_cast<void>(cold_advection_k_s(grid, warm, east, north));
  });
  expect_refused("blueprint_orographic_precipitation", 4, [&](Lengths& n) {
    const Doubles latitude(n(rows()));
    const Floats land(n(cells())), height(n(cells()));
    Floats rain(n(cells()));
    blueprint_orographic_precipitation(grid, {}, latitude, land, height, rain);
  });
  expect_refused("mountain_barrier", 1,
                 [&](Lengths& n) { const MountainBarrier barrier(grid, Floats(n(cells()))); });
  const MountainBarrier barrier(grid, Floats(cells(), 1.0F));
  expect_refused("turn_aside", 2, [&](Lengths& n) {
    Floats east(n(cells())), north(n(cells()));
    barrier.turn_aside(0.5, east, north);
  });
  expect_refused("eddy_driven_wind_m_s", 3, [&](Lengths& n) {
    const Doubles latitude(n(rows())), warm(n(rows())), rough(n(rows()));
    static_cast<void>(eddy_driven_wind_m_s(grid, {}, latitude, warm, rough));
  });
  expect_refused("cell_winds", 3, [&](Lengths& n) {
    const Doubles latitude(n(rows())), pressure(n(rows())), driven(n(rows()));
    static_cast<void>(cell_winds(grid, {}, latitude, pressure, driven));
  });
  expect_refused("moisture", 9, [&](Lengths& n) {
    Floats arrays[8];
    for (Floats& array : arrays) array.resize(n(cells()));
    Doubles column(n(cells()));
    const MoistureSeason season{arrays[0], arrays[1], arrays[2], arrays[3], arrays[4],
                                arrays[5], arrays[6], arrays[7], column};
    const SteadyMoisture moisture(grid, {}, {&season, 1});
  });
}

TEST(ArraySizes, OfRemappingAreChecked) {
  const Grid& grid = planet();
  const Grid coarse = Grid::sphere(6, 3);
  const std::size_t few = coarse.size();
  const ConservativeRemapping remapping(grid, coarse);
  expect_refused("ConservativeRemapping", 2, [&](Lengths& n) {
    const Floats values(n(cells()));
    Floats mean(n(few));
    remapping.average(values, mean);
  });
  expect_refused("ConservativeRemapping", 4, [&](Lengths& n) {
    const Floats z(n(cells()));
    Floats land(n(few)), height(n(few)), coverage(n(few));
    remapping.average_elevation(z, land, height, coverage);
  });
  expect_refused("Interpolator", 1,
                 [&](Lengths& n) { const Interpolator smooth(remapping, Floats(n(few))); });
  const Healpix pixels(2);
  const HealpixRemapping onto(grid, pixels);
  expect_refused("HealpixRemapping", 2, [&](Lengths& n) {
    const Floats values(n(cells()));
    Floats mean(n(pixels.size()));
    onto.mean(values, mean);
  });
  expect_refused("HealpixRemapping", 2, [&](Lengths& n) {
    const std::vector<std::int32_t> values(n(cells()));
    std::vector<std::int32_t> result(n(pixels.size()));
    onto.dominant(values, result);
  });
  expect_refused("laid_out_turned", 1, [&](Lengths& n) {
    static_cast<void>(laid_out_turned(grid, Floats(n(cells())), grid));
  });
  const Grid fine = Grid::window(8, 6, {-20.0, 20.0, -30.0, 30.0});
  const PlanetCells parts(grid, fine);
  expect_refused("PlanetCells", 2, [&](Lengths& n) {
    const Floats values(n(fine.size()));
    static_cast<void>(parts.means(values, Bytes(n(fine.size())), 0.0F));
  });
  expect_refused("local_roughness", 2, [&](Lengths& n) {
    const Floats z(n(cells()));
    Floats covered(n(parts.size()));
    local_roughness(parts, z, covered);
  });
  expect_refused("unit_detail", 1, [&](Lengths& n) {
    Floats detail(n(fine.size()));
    unit_detail(fine, {}, 1, "detail", detail);
  });
  expect_refused("unit_detail_near_edge", 1, [&](Lengths& n) {
    Floats detail(n(fine.size()));
    unit_detail_near_edge(fine, {}, 1e4, 1, "detail", detail);
  });
  expect_refused("find_inflow", 8, [&](Lengths& n) {
    const Floats planet_m(n(cells()));
    const std::vector<Index> receiver(n(cells()));
    const Doubles area(n(cells()));
    const Floats discharge(n(cells()));
    const std::vector<std::int32_t> lakes(n(cells()));
    Floats z(n(fine.size()));
    Doubles area_in(n(fine.size()));
    Floats inflow(n(fine.size()));
    find_inflow(parts, {planet_m, receiver, area, discharge, lakes}, z, area_in, inflow);
  });
  expect_refused("trace_river_courses", 6, [&](Lengths& n) {
    const Floats planet_m(n(cells()));
    const std::vector<Index> receiver(n(cells()));
    const Doubles area(n(cells()));
    const Floats discharge(n(cells()));
    const std::vector<std::int32_t> lakes(n(cells()));
    const Floats z(n(fine.size()));
    trace_river_courses(parts, {planet_m, receiver, area, discharge, lakes}, {}, 1, z);
  });
  expect_refused("open_river_courses", 2, [&](Lengths& n) {
    const Bytes outlets(n(fine.size()));
    RiverCourses courses;
    Floats z(n(fine.size()));
    open_river_courses(fine, outlets, courses, z);
  });
}

}  // namespace
}  // namespace geo
