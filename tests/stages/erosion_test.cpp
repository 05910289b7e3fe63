#include "geo/stages/erosion/erosion.hpp"

#include <gtest/gtest.h>

#include "geo/stages/erosion/seas.hpp"
#ifdef _OPENMP
#include <omp.h>
#endif

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geo/core/pipeline.hpp"
#include "geo/kernels/numerics/area_sum.hpp"
#include "geo/kernels/water/flow_graph.hpp"
#include "support/terrain.hpp"

namespace geo {
namespace {

struct Outcome {
  std::vector<float> z, rate, thickness, laid_rate, flux, uplift, crust_change;
  std::vector<double> area;
  std::vector<Index> receiver;
  Budget budget;
};

Outcome erode(const Grid& grid, const std::vector<float>& z,
              const std::vector<std::pair<std::string, std::string>>& settings,
              const std::vector<float>& uplift = {}, const std::vector<float>& thickening = {}) {
  auto stage = make_erosion_stage();
  const auto parameters = stage->parameters();
  for (const auto& [key, text] : settings) find_parameter(parameters, key)->set_text(text);
  State state(std::make_shared<const Grid>(grid));
  state.set(field::elevation, z);
  if (!uplift.empty()) state.set(field::uplift_rate, uplift);
  if (!thickening.empty()) state.set(field::thickening_rate, thickening);
  Context context;
  StageIo io(state, stage->info());
  stage->run(io, context);
  const auto copy = [](auto span) { return std::vector(span.begin(), span.end()); };
  const auto sediment = [&](const Field<float>& spec) {
    return state.has(spec) ? copy(state.read(spec)) : std::vector<float>();
  };
  return {copy(state.read(field::elevation)),      copy(state.read(field::erosion_rate)),
          sediment(field::sediment_thickness),     sediment(field::deposition_rate),
          sediment(field::sediment_flux),          copy(state.read(field::uplift_rate)),
          sediment(field::crust_thickness_change), copy(state.read(field::drainage_area)),
          copy(state.read(field::flow_receiver)),  context.budget};
}

TEST(Erosion, RockBudgetCloses) {
  for (const Grid& grid : test::small_grids()) {
    for (const char* depressions : {"fill", "breach"}) {
      const auto z = test::random_terrain(grid, 5);
      const Outcome out = erode(grid, z,
                                {{"erosion.steps", "7"},
                                 {"erosion.uplift_mm_yr", "0.5"},
                                 {"erosion.depressions", depressions},
                                 {"erosion.rebound_fraction", "0.8"},
                                 {"erosion.relaxation_fraction", "0.15"}});
      EXPECT_LT(std::abs(out.budget.at("rock_closing_error")), 1e-10);
      EXPECT_GT(out.budget.at("rock_uplifted_m3"), 0.0);
      EXPECT_GT(out.budget.at("rock_eroded_m3"), 0.0);
    }
  }
}

TEST(Erosion, RockBudgetNeedsEachOfItsTerms) {
  const Grid grid = Grid::sphere(60, 30);
  const auto z = test::random_terrain(grid, 5);
  auto thickening = test::random_terrain(grid, 6);
  for (float& rate : thickening) rate = 1e-6F * std::max(0.0F, rate);
  const Outcome out = erode(grid, z,
                            {{"erosion.steps", "7"},
                             {"erosion.time_step_yr", "1e5"},
                             {"erosion.uplift_from", "shortening"},
                             {"erosion.relaxation_fraction", "0.15"}},
                            {}, thickening);
  const auto term = [&](const char* name) { return out.budget.at(name); };
  const std::vector<double> terms{term("rock_uplifted_m3"),         term("rock_rebound_m3"),
                                  term("rock_reshaped_m3"),         term("sediment_laid_at_sea_m3"),
                                  term("sediment_laid_on_land_m3"), -term("rock_eroded_m3")};
  const double scale = std::abs(terms.back());
  const double all = std::accumulate(terms.begin(), terms.end(), term("rock_rounded_m3"));
  EXPECT_LT(std::abs(all - term("rock_stored_m3")) / scale, 1e-12);
  EXPECT_LT(std::abs(term("rock_rounded_m3")) / scale, test::kHeightRounding);
  for (std::size_t k = 0; k < terms.size(); ++k) {
    EXPECT_GT(std::abs(all - terms[k] - term("rock_stored_m3")) / scale,
              100.0 * test::kHeightRounding)
        << "without term " << k;
  }
}

TEST(Erosion, RockBudgetSumsUpliftFromItsRate) {
  const Grid grid = Grid::plane(40, 30, 1000.0, 1000.0, Edges::open);
  const std::vector<float> z(grid.size(), 500.0F);
  const Outcome out = erode(grid, z,
                            {{"erosion.steps", "7"},
                             {"erosion.time_step_yr", "1e5"},
                             {"erosion.uplift_mm_yr", "0.5"},
                             {"erosion.uplift_from", "none"}});
  // Edges are outlets and stay.
  EXPECT_NEAR(out.budget.at("rock_uplifted_m3"), 38.0 * 28.0 * 1e6 * 0.5e-3 * 7e5, 10.0);
}

TEST(Erosion, NoStepsLeaveTheReliefAlone) {
  const Grid grid = Grid::sphere(60, 30);
  const auto z = test::random_terrain(grid, 2);
  const Outcome out = erode(grid, z, {{"erosion.steps", "0"}});
  EXPECT_EQ(out.z, z);
  EXPECT_GT(*std::max_element(out.rate.begin(), out.rate.end()), 0.0F);
}

TEST(Erosion, SeaStaysSeaAndLandStaysLandWithoutStraitsAndDeltas) {
  for (const Grid& grid : test::small_grids()) {
    const auto z = test::random_terrain(grid, 8);
    for (const std::string model : {"detachment", "sediment"}) {
      const Outcome out = erode(grid, z,
                                {{"erosion.steps", "30"},
                                 {"erosion.uplift_mm_yr", "-0.1"},
                                 {"erosion.model", model},
                                 {"erosion.strait_sill_m", "0"},
                                 {"erosion.sediment.highstand_yr", "0"}});
      for (Index cell = 0; cell < grid.size(); ++cell) {
        ASSERT_EQ(z[cell] < 0.0F, out.z[cell] < 0.0F);
        if (z[cell] < 0.0F && model == "detachment") {
          ASSERT_EQ(z[cell], out.z[cell]);
        }
      }
    }
  }
}

TEST(Erosion, SedimentBudgetClosesFromIndependentSums) {
  for (const Grid& grid : test::small_grids()) {
    for (const char* depressions : {"fill", "breach"}) {
      const auto z = test::random_terrain(grid, 5);
      const Outcome out = erode(grid, z,
                                {{"erosion.steps", "7"},
                                 {"erosion.time_step_yr", "1e5"},
                                 {"erosion.warping_m", "0"},
                                 {"erosion.model", "sediment"},
                                 {"erosion.sediment.dispersal_km", "3"},
                                 {"erosion.strait_sill_m", "0"},
                                 {"erosion.sediment.highstand_yr", "0"},
                                 {"erosion.depressions", depressions}});
      const auto sum = [&](const std::vector<float>& field, bool at_sea) {
        double total = 0.0;
        for (Index c = 0; c < grid.size(); ++c) {
          if ((z[c] < 0.0F) == at_sea) total += grid.area_m2(grid.row(c)) * field[c];
        }
        return total;
      };
      EXPECT_LT(std::abs(out.budget.at("sediment_closing_error")), 1e-12);
      EXPECT_LT(std::abs(out.budget.at("rock_closing_error")), 1e-12);
      // What the fields say, rounded to floats.
      const double at_sea = out.budget.at("sediment_laid_at_sea_m3"), years = 7e5;
      EXPECT_GT(at_sea, 0.0);
      EXPECT_NEAR(sum(out.thickness, true) / at_sea, 1.0, 1e-5);
      EXPECT_NEAR(sum(out.laid_rate, true) * years / at_sea, 1.0, 1e-5);
      EXPECT_NEAR(sum(out.laid_rate, false) * years /
                      std::max(out.budget.at("sediment_laid_on_land_m3"), 1.0),
                  1.0, 1e-5);
      // Net loss of land is what left it.
      const double lost = sum(out.rate, false) * years;
      const double left =
          at_sea + out.budget.at("sediment_unsettled_m3") + out.budget.at("rock_exported_m3");
      EXPECT_NEAR(lost / left, 1.0, 1e-5);
      for (const float thickness : out.thickness) ASSERT_GE(thickness, 0.0F);
      for (const float flux : out.flux) ASSERT_GE(flux, 0.0F);
    }
  }
}

/// Also where valleys drown: the sea, which deltas have pushed back, keeps its share.
TEST(Erosion, SedimentReachesTheSeaOnce) {
  const Grid grid = Grid::sphere(128, 64);
  std::vector<float> z = test::random_terrain(grid, 5);
  for (Index c = 0; c < grid.size(); ++c) {
    // Continents that slope gently to shallow seas, which deltas fill.
    const double height_m =
        1500.0 * std::cos(4.0 * std::numbers::pi * (grid.column(c) + 0.5) / grid.nx());
    z[c] = static_cast<float>((height_m > 0.0 ? 0.2 : 0.05) * height_m + 0.05 * z[c]);
  }
  constexpr double kYears = 2e6;
  const Outcome out = erode(grid, z,
                            {{"erosion.steps", "1"},
                             {"erosion.time_step_yr", "2e6"},
                             {"erosion.depressions", "fill"},
                             {"erosion.warping_m", "0"},
                             {"erosion.sediment.highstand_yr", "2e6"}});
  double to_sea_m3 = 0.0;
  int drowned = 0;
  for (Index c = 0; c < grid.size(); ++c) {
    if (out.z[c] < 0.0F) to_sea_m3 += kYears * out.flux[c];
    drowned += out.z[c] < 0.0F && z[c] >= 0.0F ? 1 : 0;
  }
  EXPECT_GT(drowned, 20);
  const double brought_m3 =
      out.budget.at("sediment_laid_at_sea_m3") + out.budget.at("sediment_unsettled_m3");
  EXPECT_NEAR(to_sea_m3 / brought_m3, 1.0, 0.02);
}

TEST(Erosion, StraitsFilledSeasAndDeltasAreInTheBudgets) {
  for (const Grid& grid : test::small_grids()) {
    auto z = test::random_terrain(grid, 5);
    for (float& height : z) height = height < 0.0F ? 0.02F * height : height;  // shallow seas
    const Outcome out = erode(grid, z,
                              {{"erosion.steps", "4"},
                               {"erosion.time_step_yr", "1e5"},
                               {"erosion.strait_width_km", "1"},
                               {"erosion.strait_sea_km2", "1"},
                               {"erosion.sediment.highstand_yr", "5e4"}});
    EXPECT_LT(std::abs(out.budget.at("sediment_closing_error")), 1e-12);
    EXPECT_LT(std::abs(out.budget.at("rock_closing_error")), 1e-12);
    int gained = 0;
    for (Index c = 0; c < grid.size(); ++c) gained += z[c] < 0.0F && out.z[c] >= 0.0F ? 1 : 0;
    if (grid.topology() == Topology::plane) {
      EXPECT_GT(gained, 0) << "mouths build land out";
      continue;
    }
    // A whole planet's sea rises by what it lost, until it covers as much as before.
    const double largest_cell_m2 = std::max(grid.area_m2(0), grid.area_m2(grid.ny() / 2));
    EXPECT_NEAR(share_of_sea(grid, out.z), share_of_sea(grid, z),
                1.5 * largest_cell_m2 / grid.total_area_m2());
  }
}

TEST(Erosion, LoadsOfSedimentBendTheSeaFloor) {
  // Half of an island's rock lies on the sea floor, which sinks under it by the share of its
  // weight.
  const Grid grid = Grid::plane(60, 60, 20e3, 20e3);
  std::vector<float> z(grid.size(), -3000.0F);
  for (int j = 20; j < 40; ++j) {
    for (int i = 20; i < 40; ++i) z[grid.cell(i, j)] = 1500.0F;
  }
  const auto settled = [&](const char* rebound) {
    return erode(grid, z,
                 {{"erosion.steps", "4"},
                  {"erosion.model", "sediment"},
                  {"erosion.rebound_fraction", rebound},
                  {"erosion.rebound_length_km", "0"},
                  {"erosion.rebound_time_yr", "1"},
                  {"erosion.warping_m", "0"}});
  };
  const Outcome stiff = settled("0"), bent = settled("0.8");
  const Index offshore = grid.cell(30, 17);
  EXPECT_NEAR(stiff.z[offshore] - z[offshore], stiff.thickness[offshore], 0.01);
  const double share = (0.8 - 1030.0 / 3300.0) / (1.0 - 1030.0 / 3300.0);
  EXPECT_NEAR((bent.z[offshore] - z[offshore]) / bent.thickness[offshore], 1.0 - share, 1e-3);
}

TEST(Erosion, ReachesTheBalanceOfUpliftAndIncision) {
  // Long after the start every point is lowered as fast as it rises.
  const Grid grid = Grid::plane(48, 40, 2000.0, 2000.0);
  auto z = test::random_terrain(grid, 4);
  for (float& height : z) height = 0.1F * std::abs(height) + 1.0F;
  const std::vector<float> uplift(grid.size(), 1e-3F);
  const std::vector<std::pair<std::string, std::string>> settings{
      {"erosion.steps", "300"},
      {"erosion.time_step_yr", "1e5"},
      {"erosion.erodibility_yr", "1e-5"},
      {"erosion.rebound_fraction", "0"},
      {"erosion.warping_m", "0"}};
  Outcome out = erode(grid, z, settings, uplift);
  out = erode(grid, out.z,
              {{"erosion.steps", "10"},
               {"erosion.time_step_yr", "1e5"},
               {"erosion.erodibility_yr", "1e-5"},
               {"erosion.rebound_fraction", "0"},
               {"erosion.warping_m", "0"}},
              uplift);
  double rate = 0.0;
  int cells = 0;
  for (int j = 1; j < grid.ny() - 1; ++j) {
    for (int i = 1; i < grid.nx() - 1; ++i) {
      rate += out.rate[grid.cell(i, j)];
      ++cells;
    }
  }
  EXPECT_NEAR(rate / cells, 1e-3, 5e-5);
}

TEST(Erosion, CrustIsWhatShorteningAddsAndErosionLeaves) {
  for (const Grid& grid : test::small_grids()) {
    for (const std::string model : {"detachment", "sediment"}) {
      const auto z = test::random_terrain(grid, 5);
      auto thickening = test::random_terrain(grid, 6);
      for (float& rate : thickening) rate = 1e-6F * std::max(0.0F, rate);
      const Outcome out = erode(grid, z,
                                {{"erosion.steps", "7"},
                                 {"erosion.time_step_yr", "1e5"},
                                 {"erosion.warping_m", "0"},
                                 {"erosion.model", model},
                                 {"erosion.sediment.dispersal_km", "3"},
                                 {"erosion.uplift_from", "shortening"}},
                                {}, thickening);
      const auto sum = [&](const std::vector<float>& field) {
        return area_sum<double>(grid, [&](Index c) { return static_cast<double>(field[c]); });
      };
      EXPECT_LT(std::abs(out.budget.at("crust_closing_error")), 1e-12);
      EXPECT_LT(std::abs(out.budget.at("rock_closing_error")), 1e-12);
      EXPECT_GT(out.budget.at("crust_shortened_m3"), 0.0);
      EXPECT_NEAR(out.budget.at("crust_shortened_m3") / (7e5 * sum(thickening)), 1.0, 1e-6);
      EXPECT_NEAR(sum(out.crust_change) / out.budget.at("crust_stored_m3"), 1.0, 1e-5);
    }
  }
}

/// A plain that belts of one rate raise, with the given model.
std::vector<std::pair<std::string, std::string>> shortened(const char* model, const char* steps,
                                                           const char* rebound) {
  return {{"erosion.steps", steps},
          {"erosion.time_step_yr", "1e5"},
          {"erosion.model", model},
          {"erosion.erodibility_yr", "1e-5"},
          {"erosion.rebound_fraction", rebound},
          {"erosion.rebound_length_km", "0"},
          {"erosion.rebound_time_yr", "1"},
          {"erosion.warping_m", "0"},
          {"erosion.diffusivity_m2_yr", "0"},
          {"erosion.damage", "0"},
          {"erosion.subgrid_exponent", "0"},
          {"erosion.flow_routing", "d8"},
          {"erosion.uplift_from", "shortening"}};
}

TEST(Erosion, BeltsLastWhereRiversTakeAllThatShorteningAdds) {
  // dz/dt = (1 - c) (dh/dt - E): the balance is that of thickening and erosion, whatever part of
  // either isostasy gives back, and rivers stand at K A^m S = (1 + G) dh/dt.
  const Grid grid = Grid::plane(32, 24, 2000.0, 2000.0);
  auto z = test::random_terrain(grid, 4);
  for (float& height : z) height = 0.1F * std::abs(height) + 1.0F;
  constexpr float kRate = 1e-3F;
  const std::vector<float> thickening(grid.size(), kRate);
  for (const auto& [model, deposition] :
       {std::pair{"detachment", 0.0}, std::pair{"sediment", 1.0}}) {
    Outcome out = erode(grid, z, shortened(model, "600", "0.8"), {}, thickening);
    out = erode(grid, out.z, shortened(model, "10", "0.8"), {}, thickening);
    for (int j = 1; j < grid.ny() - 1; ++j) {
      for (int i = 1; i < grid.nx() - 1; ++i) {
        const Index cell = grid.cell(i, j), to = out.receiver[cell];
        ASSERT_NEAR(out.rate[cell] / kRate, 1.0, 0.01);
        ASSERT_NEAR(out.uplift[cell] / kRate, 1.0, 0.01);
        // Outlets stay where they are while a step's rebound lifts the land beside them.
        if (grid.is_open_edge(grid.column(to), grid.row(to))) continue;
        const bool diagonal = grid.column(to) != i && grid.row(to) != j;
        const double slope =
            (out.z[cell] - out.z[to]) / ((diagonal ? std::sqrt(2.0) : 1.0) * 2000.0);
        ASSERT_NEAR(slope * 1e-5 * std::sqrt(out.area[cell]) / ((1.0 + deposition) * kRate), 1.0,
                    0.02);
      }
    }
  }
}

TEST(Erosion, ReboundStretchesTheTimeInWhichBeltsWearDown) {
  // Without uplift dz/dt = -(1 - c) E: with c = 0.8 relief lives five times as long.
  const Grid grid = Grid::plane(32, 24, 2000.0, 2000.0);
  auto z = test::random_terrain(grid, 4);
  for (float& height : z) height = 0.1F * std::abs(height) + 1.0F;
  const std::vector<float> thickening(grid.size(), 1e-3F), none(grid.size(), 0.0F);
  const Outcome belt = erode(grid, z, shortened("detachment", "600", "0"), {}, thickening);
  const auto mean_after = [&](const char* steps, const char* step_yr, const char* rebound) {
    auto settings = shortened("detachment", steps, rebound);
    settings[1].second = step_yr;
    const Outcome out = erode(grid, belt.z, settings, {}, none);
    return area_sum<double>(grid, [&](Index c) { return static_cast<double>(out.z[c]); }) /
           grid.total_area_m2();
  };
  const double start = mean_after("1", "1", "0"), alone = mean_after("80", "5e3", "0"),
               with_rebound = mean_after("400", "5e3", "0.8");
  EXPECT_LT(alone, 0.7 * start);
  EXPECT_NEAR(with_rebound / alone, 1.0, 0.03);
}

#ifdef _OPENMP
TEST(Erosion, SameBitsForAnyNumberOfThreads) {
  const int threads = omp_get_max_threads();
  for (const Grid& grid : test::small_grids()) {
    const auto z = test::random_terrain(grid, 9);
    std::vector<Outcome> outcomes;
    for (const int number : {1, 2, 4}) {
      omp_set_num_threads(number);
      outcomes.push_back(erode(grid, z, {{"erosion.steps", "5"}, {"erosion.uplift_mm_yr", "1"}}));
    }
    omp_set_num_threads(threads);
    for (const Outcome& other : outcomes) {
      EXPECT_EQ(other.z, outcomes[0].z);
      EXPECT_EQ(other.area, outcomes[0].area);
      EXPECT_EQ(other.receiver, outcomes[0].receiver);
      EXPECT_EQ(other.budget, outcomes[0].budget);
    }
  }
}
#endif

TEST(Erosion, LargeRiversDoNotPreferTheAxesOfTheGrid) {
  // An island of noise, uplifted and dissected. Large rivers' bearings over 12 steps, folded to
  // the distance from the nearest multiple of 45 degrees: 11.25 on average if they have no
  // preference.
  double sum = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Grid grid = Grid::plane(160, 160, 2000.0, 2000.0);
    const RandomStream random(seed, "isotropy");
    std::vector<float> z(grid.size());
    for (Index cell = 0; cell < grid.size(); ++cell) {
      const double r = std::hypot(grid.x_m(grid.column(cell)), grid.y_m(grid.row(cell)));
      z[cell] = r < 150e3 ? static_cast<float>(1.0 + 50.0 * random.uniform(cell)) : -100.0F;
    }
    const Outcome out = erode(grid, z,
                              {{"erosion.steps", "60"},
                               {"erosion.uplift_mm_yr", "0.5"},
                               {"erosion.erodibility_yr", "3e-6"},
                               {"erosion.sediment.highstand_yr", "0"},
                               {"erosion.time_step_yr", "2e5"}});
    for (Index cell = 0; cell < grid.size(); ++cell) {
      if (out.area[cell] < 4e8 || out.z[cell] < 0.0F) continue;
      Index to = cell;
      int steps = 0;
      for (; steps < 12 && out.z[out.receiver[to]] >= 0.0F; ++steps) to = out.receiver[to];
      if (steps < 12) continue;
      const double bearing =
          std::atan2(grid.row(to) - grid.row(cell), grid.column(to) - grid.column(cell)) *
          57.29577951;
      const double off = std::remainder(bearing, 45.0);
      sum += std::abs(off);
      ++count;
    }
  }
  ASSERT_GT(count, 500);
  RecordProperty("mean_deviation_deg", std::to_string(sum / count));
  EXPECT_NEAR(sum / count, 11.25, 1.2);
}

}  // namespace
}  // namespace geo
