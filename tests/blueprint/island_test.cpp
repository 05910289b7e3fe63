// Section 9: the island.
#include <gtest/gtest.h>

#include "blueprint.hpp"

namespace geo {
namespace {

using test::planet;

/// All fields that stages of the planet have written, the latest values of each.
State whole_planet() {
  State state = planet().after.at("plates");
  for (const char* stage : {"isostasy", "erosion", "climate", "hydrology", "biomes"}) {
    const State& later = planet().after.at(stage);
    for (const FieldSpec* spec : later.present()) state.share(*spec, later.values(*spec));
  }
  return state;
}

test::Settings small(test::Settings more = {}) {
  test::Settings settings{"island.nx=128", "island.ny=64", "island.cell_m=8000"};
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}
test::BlueprintPlanet island(test::Settings more = {}) {
  return test::go_on(whole_planet(), "island", "island", small(std::move(more)));
}

TEST(BlueprintIsland, DetailIsAShareOfTheHeight) {
  // (9.3): six octaves from 8 waves a width on, 15 % of the height. Without rivers' ways, which are
  // dug later, most of the land is nothing but this.
  const test::Settings bare{"island.erosion_steps=0", "island.edge_fade=false",
                            "hydrology.carving=0", "hydrology.breach_depth_m=0",
                            "hydrology.gorge_factor=0"};
  test::Settings smooth = bare;
  smooth.emplace_back("island.height_amplitude=0");
  const auto with = island(bare), without = island(smooth);
  const Grid& fine = with.grid();
  const auto z = with.read("island", field::elevation);
  const auto plain = without.read("island", field::elevation);
  const Noise noise(planet().seed, "island.detail");
  const double frequency = 8.0 * 1e3 * test::kRadius_km / (fine.nx() * 8000.0);
  int land = 0, same = 0;
  for (int j = 8; j < fine.ny() - 8; ++j) {
    for (int i = 8; i < fine.nx() - 8; ++i) {
      const Index c = fine.cell(i, j);
      if (plain[c] <= 1.0F) continue;
      const double wave = noise.fbm(fine.unit_vector(i, j), frequency, 6, 0.5);
      ++land;
      same += std::abs(z[c] - plain[c] * (1.0 + 0.15 * wave)) < 0.5 ? 1 : 0;
    }
  }
  ASSERT_GT(land, 1000);
  EXPECT_GT(same, 0.7 * land);
}

TEST(BlueprintIsland, EdgesSinkToFiveHundredMetresBelowTheSea) {
  const auto made = island();  // (9.4)
  const Grid& fine = made.grid();
  const auto z = made.read("island", field::elevation);
  for (int i = 0; i < fine.nx(); ++i) {
    ASSERT_NEAR(z[fine.cell(i, 0)], -500.0F, 1.0F);
    ASSERT_NEAR(z[fine.cell(i, fine.ny() - 1)], -500.0F, 1.0F);
  }
  EXPECT_GT(test::share_of(fine, [&](Index c) { return z[c] >= 0.0F; }), 0.05);
  // (9.5): a million years without uplift.
  EXPECT_NEAR(made.budget.at("island").at("time_yr"), 1e6, 1.0);
  for (const float uplift : made.read("island", field::uplift_rate)) ASSERT_EQ(uplift, 0.0F);
}

TEST(BlueprintIsland, RatesOfErosionAreThoseOfItsBoundaries) {
  // 9.6: where all is of one type, as with a field of its erodibility.
  for (const auto& [type, rate] : {std::pair(BoundaryType::convergent, 2e-6F),
                                   {BoundaryType::divergent, 5e-6F},
                                   {BoundaryType::interior, 8e-6F}}) {
    State by_type = whole_planet();
    std::ranges::fill(by_type.update(field::boundary_type), static_cast<std::int8_t>(type));
    State by_field = by_type;
    std::ranges::fill(by_field.update(field::erodibility), rate);
    const auto a = test::go_on(std::move(by_type), "island", "island", small());
    const auto b =
        test::go_on(std::move(by_field), "island", "island", small({"island.erodibility=planet"}));
    const auto worn = a.read("island", field::elevation);
    const auto expected = b.read("island", field::elevation);
    const auto before = island({"island.erosion_steps=0"});
    double most = 0.0;
    for (std::size_t c = 0; c < worn.size(); ++c) {
      ASSERT_NEAR(worn[c], expected[c], 1e-2F) << "rate " << rate;
      most = std::max<double>(most, a.read("island", field::erosion_rate)[c]);
    }
    EXPECT_GT(most, 1e-6);
  }
}

TEST(BlueprintIsland, SettlesByRiversAndTheSea) {
  // (8.4), (8.5): no less than on the planet for the same climate, and no more than 0.4 above it.
  const auto made = island();
  const Grid& fine = made.grid();
  const auto z = made.read("island", field::elevation);
  const auto npp = made.read("island", field::net_primary_productivity);
  const auto river = made.read("island", field::river_intensity);
  const auto lake = made.read("island", field::lake_depth);
  const auto settlement = made.read("island", field::settlement_suitability);
  for (Index c = 0; c < fine.size(); ++c) {
    if (z[c] < 0.0F || lake[c] > 0.0F) continue;
    const double elev_factor = std::max(1.0 - std::max(z[c] - 500.0, 0.0) / 4000.0, 0.0);
    const double base = npp[c] / 2500.0 * elev_factor + 0.25 * river[c];
    ASSERT_GE(settlement[c], std::min(1.0, base) - 1e-5);
    ASSERT_LE(settlement[c], std::min(1.0, base + 0.15) + 1e-5);
  }
}

}  // namespace
}  // namespace geo
