#include "stages/island/island_of_planet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace geo {

State make_planet(std::uint64_t seed) {
  State state(std::make_shared<const Grid>(Grid::sphere(256, 128)));
  const Pipeline pipeline = make_pipeline();
  const auto parameters = pipeline.parameters();
  find_parameter(parameters, "climate.resolution_deg")->set_text("10");  // takes a moment only
  // Valleys as wide as its cells, as those of a planet at full size are.
  find_parameter(parameters, "hydrology.valley_width_km")->set_text("160");
  Context context;
  context.seed = seed;
  State whole(state.shared_grid());
  Pipeline::Observer observer;
  observer.after = [&](int, const State& now, const Context&) {
    for (const FieldSpec* spec : now.present()) whole.share(*spec, now.values(*spec));
  };
  pipeline.run(state, context, 0, pipeline.find("biomes"), observer);
  return whole;
}

const State& planet() {
  static const State kPlanet = make_planet(3);
  return kPlanet;
}

namespace {

Made make_in(Context context, IslandParameters p, State state) {
  const auto stage = make_island_stage(std::move(p));
  StageIo io(state, stage->info());
  stage->run(io, context);
  return {io.result(), context.budget};
}

}  // namespace

Made make(IslandParameters p, State state, std::uint64_t seed) {
  Context context;
  context.seed = seed;
  return make_in(std::move(context), std::move(p), std::move(state));
}

Made make_smooth(IslandParameters p) {
  const Pipeline pipeline = make_pipeline();
  Context context;
  context.seed = 3;
  context.configuration = pipeline.parameters();
  for (const char* name :
       {"hydrology.carving", "hydrology.breach_depth_m", "hydrology.gorge_factor"}) {
    find_parameter(context.configuration, name)->set_text("0");
  }
  p.detail_amplitude = p.least_roughness_m = p.coast_fray = 0.0;
  p.erosion_steps = 0;
  return make_in(std::move(context), std::move(p), planet());
}

std::string text(Centre place) {
  return std::to_string(place.latitude_deg) + "," + std::to_string(place.longitude_deg);
}

IslandParameters around(Centre place) {
  IslandParameters p;
  p.nx = 320;
  p.ny = 192;
  p.cell_m = 5000.0;
  p.center = text(place);
  return p;
}

Centre place_of(Index planet_cell, const Grid& grid) {
  return grid.position(grid.column(planet_cell), grid.row(planet_cell));
}

std::vector<Index> great_rivers(std::size_t count, const State& whole) {
  const Grid& grid = whole.grid();
  const auto discharge = whole.read(field::discharge);
  const auto receiver = whole.read(field::flow_receiver);
  const auto basin = whole.read(field::basin_id);
  const auto lake = whole.read(field::lake_id);
  std::vector<Index> cells(grid.size());
  for (Index c = 0; c < grid.size(); ++c) cells[c] = c;
  std::stable_sort(cells.begin(), cells.end(),
                   [&](Index a, Index b) { return discharge[a] > discharge[b]; });
  std::vector<Index> rivers;
  std::vector<std::int32_t> seen;
  for (const Index c : cells) {
    if (rivers.size() == count) break;
    if (std::abs(grid.latitude_deg(grid.row(c))) > 60.0 || lake[c] > 0 || receiver[c] == c)
      continue;
    if (std::find(seen.begin(), seen.end(), basin[c]) != seen.end()) continue;
    // Far enough upstream for the sea to be out of sight, with half of the water.
    Index up = c;
    bool meets_lake = false;
    for (int step = 0; step < 5; ++step) {
      Index largest = kNoCell;
      for (int k = 0; k < kDirections; ++k) {
        const Index next = grid.neighbour(up, k);
        if (next == kNoCell || receiver[next] != up || next == up) continue;
        if (largest == kNoCell || discharge[next] > discharge[largest]) largest = next;
      }
      if (largest == kNoCell) break;
      meets_lake |= lake[largest] > 0;
      if (step < 4) up = largest;
    }
    seen.push_back(basin[c]);
    if (!meets_lake && discharge[up] > 0.5 * discharge[c]) rivers.push_back(up);
  }
  return rivers;
}

Index mouth_of(Index river, const State& whole) {
  const auto receiver = whole.read(field::flow_receiver);
  const auto z = whole.read(field::elevation);
  while (receiver[river] != river && z[receiver[river]] >= 0.0F) river = receiver[river];
  return river;
}

bool on_edge(const Grid& grid, Index c) { return grid.is_open_edge(grid.column(c), grid.row(c)); }

void expect_drained(const State& island) {
  const Grid& fine = island.grid();
  const auto z = island.read(field::elevation);
  const auto receiver = island.read(field::flow_receiver);
  const auto lake = island.read(field::lake_id);
  std::vector<std::int8_t> good(fine.size(), -1);  // -1: not known yet
  std::vector<Index> way;
  Index land = 0;
  for (Index start = 0; start < fine.size(); ++start) {
    if (z[start] < 0.0F) continue;
    ++land;
    Index c = start;
    way.clear();
    while (good[c] < 0 && receiver[c] != c) {
      way.push_back(c);
      ASSERT_LE(way.size(), static_cast<std::size_t>(fine.size())) << "round and round";
      c = receiver[c];
    }
    if (good[c] < 0) good[c] = z[c] < 0.0F || on_edge(fine, c) || lake[c] > 0 ? 1 : 0;
    for (const Index passed : way) good[passed] = good[c];
    ASSERT_EQ(good[start], 1) << "cell " << start << " ends at " << c;
  }
  EXPECT_GT(land, fine.size() / 4);
}

const Made& example() {
  static const Made kMade = make(around(place_of(great_rivers(1).front())));
  return kMade;
}

IslandParameters coarse_look() {
  IslandParameters p = around(place_of(great_rivers(1).front()));
  p.nx = 160;
  p.ny = 96;
  p.cell_m = 10e3;
  return p;
}

}  // namespace geo
