// Section 4: uplift, noise, relaxation, hypsometry, detail, sea level.
#include <gtest/gtest.h>

#include "blueprint.hpp"
#include "geo/kernels/landscape/sea_level.hpp"
#include "geo/kernels/numerics/quantiles.hpp"
#include "geo/kernels/numerics/smoothing.hpp"

namespace geo {
namespace {

using test::planet;

TEST(BlueprintErosion, UpliftGrowsWithTheSpeedOfPlates) {
  // (4.5): 5, -2 and 1 mm/yr times strength times speed / 5.
  const Grid& grid = planet().grid();
  const auto type = planet().read("plates", field::boundary_type);
  const auto strength = planet().read("plates", field::boundary_strength);
  const std::array<double, 4> rate{0.0, 0.005, -0.002, 0.001};
  for (const double speed : {2.5, 5.0, 10.0}) {
    const auto made = test::go_on(planet().after.at("isostasy"), "erosion", "erosion",
                                  {"plates.speed_cm_yr=" + std::to_string(speed)});
    const auto uplift = made.read("erosion", field::uplift_rate);
    double most = 0.0;
    for (Index c = 0; c < grid.size(); ++c) {
      ASSERT_NEAR(uplift[c], strength[c] * rate[type[c]] * speed / 5.0, 1e-8) << speed << " cm/yr";
      most = std::max<double>(most, uplift[c]);
    }
    EXPECT_GT(most, 0.8 * 0.005 * speed / 5.0);
    EXPECT_NEAR(made.budget.at("erosion").at("time_yr"), 1.5e6, 1.0);
  }
}

TEST(BlueprintErosion, FinishIsThatOfItsEquations) {
  // Without a step what comes after the rivers is all there is.
  const State& before = planet().after.at("isostasy");
  const Grid& grid = before.grid();
  const auto initial = before.read(field::elevation);
  const auto made = test::go_on(before, "erosion", "erosion", {"erosion.steps=0"});
  std::vector<float> h(initial.begin(), initial.end());
  std::vector<std::uint8_t> land(h.size());
  for (std::size_t c = 0; c < h.size(); ++c) land[c] = h[c] >= 0.0F ? 1 : 0;

  const Noise injected(planet().seed, "erosion.injected");
  double least = 0.0, most = 0.0;
  for (Index c = 0; c < grid.size(); ++c) {
    if (land[c] == 0) continue;
    const double perturbation = test::octave(injected, test::place(grid, c), 48) * 5.0;
    least = std::min(least, perturbation);
    most = std::max(most, perturbation);
    h[c] = static_cast<float>(std::max(h[c] + perturbation, 0.5));  // (4.5a)
    h[c] = 0.85F * h[c] + 0.15F * initial[c];                       // (4.6)
  }
  EXPECT_LT(least, -4.0);
  EXPECT_GT(most, 4.0);
  smooth(grid, h, 15.5e3, land);  // 5 passes over the land

  // (4.7) to (4.9)
  for (std::size_t c = 0; c < h.size(); ++c) land[c] = h[c] > 0.0F ? 1 : 0;
  const double max_land = quantile(grid, h, 1.0, land), median_fb = quantile(grid, h, 0.5, land);
  const double alpha =
      std::clamp(std::log(400.0 / max_land) / std::log(median_fb / max_land), 1.0, 5.0);
  EXPECT_GT(alpha, 1.1);  // it has something to do
  std::vector<float> delta(h.size(), 0.0F);
  for (std::size_t c = 0; c < h.size(); ++c) {
    if (land[c] == 0) continue;
    delta[c] = h[c] - static_cast<float>(std::pow(h[c] / max_land, alpha) * max_land);
  }
  smooth(grid, delta, 22e3, land);  // 10 passes
  for (std::size_t c = 0; c < h.size(); ++c) {
    // Land stays land where the smoothed change is more than a shore's height.
    if (land[c] != 0) h[c] = std::max(h[c] - delta[c], std::min(h[c], 0.1F));
  }

  const Noise detail(planet().seed, "erosion.detail");
  for (Index c = 0; c < grid.size(); ++c) {
    if (h[c] <= 0.0F) continue;
    const auto at = test::place(grid, c);
    const double octaves = test::octave(detail, at, 16) * 80 + test::octave(detail, at, 32) * 40 +
                           test::octave(detail, at, 64) * 20 + test::octave(detail, at, 128) * 10;
    h[c] += static_cast<float>(octaves * std::sqrt(std::clamp(h[c] / 5000.0, 0.0, 1.0)));  // (4.9a)
  }
  const float sea = level_for_fraction(grid, h, 0.71);  // 4.7
  const auto found = made.read("erosion", field::elevation);
  for (Index c = 0; c < grid.size(); ++c) ASSERT_NEAR(found[c], h[c] - sea, 0.05) << "cell " << c;
}

}  // namespace
}  // namespace geo
