// An island's climate and runoff against those of the planet.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geo/kernels/climate/blueprint_climate.hpp"
#include "geo/kernels/remapping/catmull_rom.hpp"
#include "geo/kernels/remapping/planet_cells.hpp"
#include "geo/kernels/water/water_balance.hpp"
#include "geo/stages/climate/climate.hpp"
#include "stages/island/island_of_planet.hpp"

namespace geo {
namespace {

const double kLapse_k_m = ClimateParameters{}.seasonal.energy.lapse_k_m;

TEST(Island, RunoffIsThatOfThePlanetOverTheSameGround) {
  const Grid& coarse = planet().grid();
  const auto z = planet().read(field::elevation);
  std::vector<std::uint8_t> sea(coarse.size());
  std::transform(z.begin(), z.end(), sea.begin(), [](float height) { return height < 0.0F; });
  std::vector<double> runoff(coarse.size());
  std::vector<float> loss(coarse.size());
  land_water(coarse, sea, planet().read(field::precipitation),
             planet().read(field::potential_evapotranspiration), runoff, loss);
  const auto& [island, budget] = example();
  const PlanetCells cells(coarse, island.grid());
  double planets_m3_s = 0.0;
  for (const Index c : cells.cell_of()) {
    planets_m3_s += runoff[c] / coarse.area_m2(coarse.row(c)) * island.grid().area_m2(0);
  }
  EXPECT_NEAR(budget.at("land_precipitation_m3_s") - budget.at("land_evaporation_m3_s"),
              planets_m3_s, 0.1 * planets_m3_s);
}

TEST(Island, RainIsThePlanetsAtTheEdge) {
  IslandParameters parameters = around(place_of(great_rivers(1).front()));
  parameters.climate_smoothing_km = 0.0;
  const State island = make(parameters).island;
  const Grid& fine = island.grid();
  const auto planets_p = planet().read(field::precipitation);
  const auto p = island.read(field::precipitation);
  for (Index c = 0; c < fine.size(); ++c) {
    if (!on_edge(fine, c)) continue;
    const CatmullRom stencil(planet().grid(), fine.position(fine.column(c), fine.row(c)));
    const double rain = std::max(0.0, stencil.of(planets_p));
    ASSERT_NEAR(p[c], rain, 1e-3 * rain + 0.1) << "cell " << c;
  }
}

TEST(Island, ClimateJoinsThePlanetsAtTheEdge) {
  IslandParameters parameters = around(place_of(great_rivers(1).front()));
  parameters.climate_smoothing_km = 0.0;  // it mixes heights
  const State island = make_smooth(parameters).island;
  const Grid& fine = island.grid();
  const auto planets_z = planet().read(field::elevation);
  const auto planets_t = planet().read(field::temperature);
  const auto planets_p = planet().read(field::precipitation);
  const auto z = island.read(field::elevation);
  const auto t = island.read(field::temperature);
  const auto p = island.read(field::precipitation);
  const auto height = [](double h) { return std::max(0.0, h); };
  int compared = 0;
  for (Index c = 0; c < fine.size(); ++c) {
    if (!on_edge(fine, c)) continue;
    const CatmullRom stencil(planet().grid(), fine.position(fine.column(c), fine.row(c)));
    const double rain = std::max(0.0, stencil.of(planets_p));
    ASSERT_NEAR(p[c], rain, 1e-3 * rain + 0.1) << "cell " << c;
    // The air came before rivers cut their gaps.
    if (std::abs(z[c] - stencil.of(planets_z)) > 1.0) continue;
    const double at_sea_level = stencil.of([&](int i, int j) {
      const Index k = planet().grid().cell(i, j);
      return planets_t[k] + kLapse_k_m * height(planets_z[k]);
    });
    ASSERT_NEAR(t[c] + kLapse_k_m * height(z[c]), at_sea_level, 0.01) << "cell " << c;
    ++compared;
  }
  EXPECT_GT(compared, fine.nx());
}

// No noise, no smoothing, no valleys cut after the air has passed: what is left are the formulas.
TEST(Island, BlueprintsClimateHoldsAtTheIslandsOwnPlaces) {
  const Pipeline pipeline = make_pipeline();
  Context context;
  context.planet.pressure_bar = 1.3;
  context.configuration = pipeline.parameters();
  for (const auto& [name, value] : {std::pair{"climate.model", "blueprint"},
                                    {"climate.temperature_noise_k", "0"},
                                    {"climate.precipitation_noise_mm_yr", "0"},
                                    {"climate.resolution_deg", "10"},
                                    {"hydrology.carving", "0"},
                                    {"hydrology.breach_depth_m", "0"},
                                    {"hydrology.gorge_factor", "0"}}) {
    find_parameter(context.configuration, name)->set_text(value);
  }
  State state = planet();
  for (const char* name : {"climate", "hydrology"}) {
    const Stage& stage = *pipeline.stages()[pipeline.find(name)];
    StageIo io(state, stage.info());
    stage.run(io, context);
  }
  IslandParameters p = around(place_of(mouth_of(great_rivers(1).front())));
  p.climate_smoothing_km = 0.0;
  const auto stage = make_island_stage(p);
  StageIo io(state, stage->info());
  stage->run(io, context);
  const State& island = io.result();
  const Grid& fine = island.grid();
  const auto z = island.read(field::elevation);
  const auto coast = island.read(field::distance_to_coast);
  const auto temperature = island.read(field::temperature);
  const auto rain = island.read(field::precipitation);
  const BlueprintClimate model;
  int sea = 0, land = 0;
  for (Index c = 0; c < fine.size(); ++c) {
    const double latitude = fine.position(fine.column(c), fine.row(c)).latitude_deg;
    ASSERT_NEAR(temperature[c],
                blueprint_temperature_c(model, latitude, z[c], 1e-3 * coast[c], 1.3), 2e-3)
        << "cell " << c << " at " << z[c] << " m";
    z[c] < 0.0F ? ++sea : ++land;
    if (z[c] < 0.0F) {
      ASSERT_NEAR(rain[c], hadley_precipitation_mm_yr(latitude) * 1.2 * std::sqrt(1.3), 0.5);
    } else {
      ASSERT_GE(rain[c], 19.9);
      ASSERT_LE(rain[c], 4500.1);
    }
  }
  EXPECT_GT(std::min(sea, land), fine.size() / 50);
}

}  // namespace
}  // namespace geo
