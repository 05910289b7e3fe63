#include "geo/io/score/scorecard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "geo/core/error.hpp"
#include "geo/io/netcdf/planet_file.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "io/sample_snapshot.hpp"
#include "io/temporary_folder.hpp"

namespace geo::io {
namespace {

/// A planet with every field: one continent with a river per row, two plates, bands of climate.
State whole_planet(int nx = 480) {
  State state(std::make_shared<const Grid>(Grid::sphere(nx, nx / 2)));
  const Grid& grid = state.grid();
  const auto fill = [&]<class T>(const Field<T>& spec, const auto& value) {
    const auto values = state.update(spec);
    for (Index c = 0; c < grid.size(); ++c) values[c] = static_cast<T>(value(c));
  };
  const auto column = [&](Index c) { return grid.column(c); };
  const auto east = [&](Index c) { return 2.0 * column(c) / nx; };  // 0 to 2, land below 0.6
  const auto land = [&](Index c) { return east(c) < 0.6; };
  fill(field::elevation, [&](Index c) {
    const double wave = std::sin(0.3 * column(c)) * std::sin(0.2 * grid.row(c));
    return land(c) ? 60.0 + 900.0 * (0.6 - east(c)) + 50.0 * wave : -4300.0 + 900.0 * wave;
  });
  fill(field::continental_fraction, [&](Index c) { return land(c) ? 1.0 : 0.0; });
  fill(field::crust_thickness, [&](Index c) { return land(c) ? 60e3 - 4e4 * east(c) : 7e3; });
  fill(field::crust_age, [&](Index c) { return 100.0 * east(c) - 60.0; });
  fill(field::plate_id, [&](Index c) { return east(c) < 1.0 ? 0 : 1; });
  fill(field::plate_velocity_east, [&](Index c) { return east(c) < 1.0 ? -30.0 : 30.0; });
  fill(field::temperature, [&](Index c) {
    const double latitude = grid.latitude_deg(grid.row(c)) / 90.0;
    return 28.0 - 50.0 * latitude * latitude;
  });
  fill(field::temperature_range, [&](Index c) { return land(c) ? 20.0 : 6.0; });
  fill(field::precipitation, [&](Index c) { return 200.0 + 1500.0 * std::cos(0.1 * column(c)); });
  fill(field::potential_evapotranspiration, [](Index) { return 1000.0; });
  const auto next_is_sea = [&](Index c) { return !land(grid.neighbour(c, kEast)); };
  fill(field::flow_receiver, [&](Index c) { return land(c) ? grid.neighbour(c, kEast) : c; });
  fill(field::drainage_area,
       [&](Index c) { return land(c) ? (column(c) + 1) * grid.area_m2(grid.row(c)) : 0.0; });
  fill(field::discharge, [&](Index c) { return next_is_sea(c) && land(c) ? 4000.0 : 0.0; });
  fill(field::basin_id, [&](Index c) { return land(c) ? grid.row(c) + 1 : 0; });
  fill(field::stream_order, [&](Index c) { return land(c) ? 1 + grid.row(c) % 3 : 0; });
  fill(field::lake_depth, [&](Index c) { return column(c) == 3 ? 5.0 : 0.0; });
  fill(field::sediment_flux, [&](Index c) { return column(c) == nx - 1 ? 1e6 : 0.0; });
  fill(field::sediment_thickness, [&](Index c) { return land(c) ? 700.0 : 300.0; });
  fill(field::erosion_rate, [](Index) { return 40e-6; });
  fill(field::ice_thickness,
       [&](Index c) { return land(c) && grid.row(c) % 30 == 0 ? 900.0 : 0.0; });
  fill(field::koppen_class, [&](Index c) { return land(c) ? 1 + grid.row(c) % 30 : 0; });
  fill(field::biome, [&](Index c) { return land(c) ? 1 + grid.row(c) % 11 : 0; });
  fill(field::plate_velocity_north, [](Index) { return 0.0; });
  return state;
}

const ScoreLine& line_named(const Scorecard& card, const std::string& name) {
  const auto at = std::find_if(card.lines.begin(), card.lines.end(),
                               [&](const ScoreLine& line) { return line.name == name; });
  if (at == card.lines.end()) throw std::runtime_error(name + " is not on the card");
  return *at;
}

TEST(Scorecard, MeasuresEveryRowOfTheTableWhenAllFieldsAreThere) {
  const auto card = score_planet(whole_planet(1024));
  std::set<std::string> names;
  for (const auto& line : card.lines) {
    EXPECT_TRUE(names.insert(line.name).second) << line.name << " stands twice";
    EXPECT_TRUE(std::isfinite(line.value)) << line.name;
    EXPECT_GT(line.tolerance, 0.0) << line.name;
    EXPECT_FALSE(line.words.empty() || line.unit.empty() || line.source.empty()) << line.name;
  }
  EXPECT_GT(card.lines.size(), 120U);
  for (const char* name : {"river_slope", "hypsometric_integral", "concavity", "steepness_q50",
                           "steepness_q90", "sediment_land", "sediment_sea"}) {
    EXPECT_EQ(names.count(name), 1U) << name;
  }
  // This planet's floor is older than some of the classes.
  for (const auto& sentence : card.left_out) {
    EXPECT_THAT(sentence, testing::StartsWith("nothing to measure")) << sentence;
    EXPECT_LT(std::count(sentence.begin(), sentence.end(), ','), 6) << sentence;
  }
}

TEST(Scorecard, EachPartNeedsItsOwnFieldsAlone) {
  const State state = whole_planet(1024);
  ScoreInParts score;
  for (const auto part : {ScoreInParts::Part::surface, ScoreInParts::Part::crust}) {
    State held(state.shared_grid());
    for (const FieldSpec* spec : ScoreInParts::fields(part)) {
      if (state.has(*spec)) held.share(*spec, state.values(*spec));
    }
    score.measure(part, held);
  }
  const Scorecard whole = score_planet(state), card = score.card();
  ASSERT_EQ(card.lines.size(), whole.lines.size());
  for (std::size_t k = 0; k < card.lines.size(); ++k) {
    EXPECT_EQ(card.lines[k].value, whole.lines[k].value) << card.lines[k].name;
  }
  EXPECT_EQ(card.left_out, whole.left_out);
}

TEST(Scorecard, FiguresAreInTheUnitsOfTheTable) {
  const State state = whole_planet();
  const auto card = score_planet(state);
  EXPECT_NEAR(line_named(card, "land_fraction").value, 30.0, 0.01);
  EXPECT_NEAR(line_named(card, "continental_area").value, 30.0, 0.5);
  EXPECT_NEAR(line_named(card, "continental_submerged").value, 0.0, 0.5);
  EXPECT_NEAR(line_named(card, "oceanic_thickness").value, 7.0, 0.1);
  EXPECT_NEAR(line_named(card, "thickness_slope").value, 900.0 / 4e4, 0.01);
  EXPECT_NEAR(line_named(card, "floor_share").value, 70.0, 0.01);
  EXPECT_NEAR(line_named(card, "floor_age_q50").value, 70.0, 1.0);
  EXPECT_NEAR(line_named(card, "plates_7").value, 100.0, 1e-9);
  EXPECT_NEAR(line_named(card, "ridge_length").value, 20.0, 0.5);
  EXPECT_NEAR(line_named(card, "ridge_opening").value, 60.0, 1.0);
  EXPECT_NEAR(line_named(card, "subduction_closing").value, 60.0, 2.0);
  EXPECT_NEAR(line_named(card, "season_land_55n").value, 20.0, 1e-4);
  EXPECT_NEAR(line_named(card, "season_ocean_35s").value, 6.0, 1e-4);
  EXPECT_NEAR(line_named(card, "denudation_mean").value, 40.0, 1e-3);
  EXPECT_NEAR(line_named(card, "denudation_median").value, 40.0, 1e-3);
  const double land_m2 = 0.3 * state.grid().total_area_m2();
  EXPECT_NEAR(line_named(card, "denudation_flux").value, 40e-6 * 2700.0 * land_m2 / 1e12, 1e-3);
  EXPECT_NEAR(line_named(card, "sediment_flux").value, 240 * 1e6 * 2700.0 / 1e12, 1e-9);
  EXPECT_NEAR(line_named(card, "sediment_land").value, 700.0, 1e-2);
  EXPECT_NEAR(line_named(card, "sediment_sea").value, 300.0,
              1.0);  // coasts within cells of a degree
  EXPECT_NEAR(line_named(card, "lakes").value, 100.0 / 144.0, 1e-3);
  EXPECT_NEAR(line_named(card, "endorheic").value, 0.0, 1e-12);
  EXPECT_NEAR(line_named(card, "largest_basin").value, 144 * state.grid().area_m2(120) / 1e12,
              1e-6);
}

TEST(Scorecard, MeasuresLocalReliefOnCellsOfOneSizeAlone) {
  State state(std::make_shared<const Grid>(Grid::sphere(1024, 512)));
  const auto z = state.update(field::elevation);
  for (Index c = 0; c < state.grid().size(); ++c) {
    const int i = state.grid().column(c), j = state.grid().row(c);
    z[c] = i < 200 ? 1000.0F + (j % 2 == 0 ? 0.0F : 80.0F) : i < 400 ? 100.0F : -4000.0F;
  }
  z[state.grid().cell(100, 200)] = -3001.0F;  // a hole in the land
  const auto card = score_planet(state);
  EXPECT_NEAR(line_named(card, "local_relief_q10").value, 0.0, 1e-3);
  EXPECT_NEAR(line_named(card, "local_relief_q90").value, 80.0, 1e-3);
  EXPECT_NEAR(line_named(card, "flat_land").value, 49.5, 0.1);
  EXPECT_EQ(line_named(card, "landlocked_seas").value, 1.0);
  State coarse(std::make_shared<const Grid>(Grid::sphere(512, 256)));
  for (float& height : coarse.update(field::elevation)) height = -100.0F;
  coarse.update(field::elevation)[7] = 5.0F;
  for (const ScoreLine& line : score_planet(coarse).lines) EXPECT_NE(line.group, "relief");
}

TEST(Scorecard, SaysWhichFieldsAreMissing) {
  State state(std::make_shared<const Grid>(Grid::sphere(36, 18)));
  for (float& z : state.update(field::elevation)) z = -100.0F;
  state.update(field::elevation)[7] = 5.0F;
  const auto card = score_planet(state);
  EXPECT_LT(card.lines.size(), 40U);
  EXPECT_THAT(card.left_out, testing::Contains(testing::StartsWith("no koppen_class: ")));
  EXPECT_THAT(
      card.left_out,
      testing::Contains(testing::StartsWith("no plate_velocity_east, plate_velocity_north")));
  State bare(std::make_shared<const Grid>(Grid::sphere(36, 18)));
  EXPECT_TRUE(score_planet(bare).lines.empty());
}

TEST(Scorecard, APartOfAPlanetIsRefused) {
  State window(std::make_shared<const Grid>(Grid::window(20, 20, {0, 20, 0, 20})));
  window.set(field::elevation, std::vector<float>(400));
  EXPECT_THROW(score_planet(window), InputError);
}

TEST(Scorecard, WithinIncludesTheBorderOfTheTolerance) {
  ScoreLine line;
  line.earth = -3686.0;
  line.tolerance = 150.0;
  line.value = -3536.0;
  EXPECT_TRUE(line.within());
  line.value = -3535.0;
  EXPECT_FALSE(line.within());
  line.value = std::nan("");
  EXPECT_FALSE(line.within());
}

TEST(Scorecard, IsTheSameForAnyNumberOfCellsUpToWhatTheyResolve) {
  const auto coarse = score_planet(whole_planet(480)), fine = score_planet(whole_planet(1920));
  for (const char* name : {"land_fraction", "continental_area", "floor_age_q50", "ridge_length",
                           "temperature", "denudation_flux"}) {
    const double one = line_named(coarse, name).value, other = line_named(fine, name).value;
    EXPECT_NEAR(other / one, 1.0, 0.01) << name;
  }
}

TEST(PlanetFile, TakesEachFieldFromTheLastStageThatWroteItAndPassesOverIslands) {
  const TemporaryFolder folder;
  const auto write = [&](const char* file, Grid grid, const Field<float>& spec, float value) {
    Snapshot snapshot{"sample", std::make_shared<const Grid>(std::move(grid)), {}};
    snapshot.fields.emplace_back(
        &spec, std::make_shared<Values>(std::vector<float>(snapshot.grid->size(), value)));
    write_netcdf(folder / file, snapshot, sample_provenance());
  };
  write("03-erosion.nc", Grid::sphere(20, 10), field::elevation, 1.0F);
  write("04-climate.nc", Grid::sphere(20, 10), field::temperature, 9.0F);
  write("05-hydrology.nc", Grid::sphere(20, 10), field::elevation, 2.0F);
  write("07-island.nc", Grid::plane(20, 10, 500, 500), field::elevation, 3.0F);
  const FieldSpec* const wanted[] = {&field::elevation, &field::slope};
  const State state = read_planet(folder.path(), wanted);
  EXPECT_EQ(state.read(field::elevation)[0], 2.0F);
  EXPECT_FALSE(state.has(field::temperature));
  EXPECT_FALSE(state.has(field::slope));
  const auto file = read_planet_or_dem(folder / "03-erosion.nc", wanted);
  EXPECT_EQ(file.read(field::elevation)[0], 1.0F);
  EXPECT_THROW(read_planet_or_dem(folder / "07-island.nc", wanted), InputError);
  EXPECT_THROW(read_planet_or_dem(folder / "08-nothing.nc", wanted), IoError);
  const TemporaryFolder empty;
  EXPECT_THROW(read_planet(empty.path(), wanted), InputError);
}

}  // namespace
}  // namespace geo::io
