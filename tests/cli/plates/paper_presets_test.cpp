// The presets that drift plates by the rules and constants of the papers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/program.hpp"
#include "geo/io/input/table.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A small planet of a preset, to its isostasy.
fs::path planet_of(const fs::path& folder, const std::string& preset) {
  const fs::path out = folder / preset;
  const Outcome outcome = terrane({"run", "--preset", preset, "--seed", "3", "--grid", "96x48",
                                   "--to", "isostasy", "--no-vtk", "--no-maps", "--quiet", "--set",
                                   "plates.sphere.samples=12000", "-o", out.string()});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return out;
}

double budget_of(const fs::path& run, const std::string& name) {
  std::ifstream file(run / "manifest.json");
  const auto manifest = nlohmann::json::parse(file);
  for (const auto& stage : manifest.at("stages")) {
    if (stage.at("name") == "plates") return stage.at("budget").at(name);
  }
  return std::nan("");
}

TEST(PaperPresets, CortialHasTheConstantsOfTableThree) {
  TemporaryFolder folder;
  const fs::path run = planet_of(folder.path(), "cortial");
  const std::string config = text_of(run / "config.toml");
  // Symbols of the table, in its order: dt, z_r, z_a, z_t, z_c, r_s, r_c, Delta_c, v_0, eps_o,
  // eps_c, eps_t, u_0; then 40 plates of which 0.3 are land (Table 2).
  for (const char* line :
       {"time_step_myr = 2.0", "ridge_elevation_km = -1.0", "abyss_elevation_km = -6.0",
        "trench_elevation_km = -10.0", "summit_elevation_km = 10.0",
        "subduction_distance_km = 1800.0", "collision_distance_km = 4200.0",
        "collision_coefficient_km = 1.3e-05", "fastest_mm_yr = 100.0", "ocean_damping_mm_yr = 0.04",
        "continental_erosion_mm_yr = 0.03", "sediment_accretion_mm_yr = 0.3",
        "subduction_uplift_mm_yr = 0.6", "count = 40", "continental_share = 0.3",
        "penetration_km = 300.0", "margin_km = 0.0", "subduction_initiation_myr = 0.0"}) {
    EXPECT_THAT(config, HasSubstr(line));
  }
  EXPECT_GT(budget_of(run, "collisions"), 0.0);
  EXPECT_EQ(budget_of(run, "subduction_initiations"), 0.0);
  EXPECT_NEAR(budget_of(run, "continental_closing_error"), 0.0, 1e-6);
}

TEST(PaperPresets, DriftworldBeginsWithoutLandAndMergesPlates) {
  TemporaryFolder folder;
  const fs::path run = planet_of(folder.path(), "driftworld");
  const std::string config = text_of(run / "config.toml");
  for (const char* line :
       {"overlap = \"score\"", "collisions = \"plates\"", "uplift_profile = \"driftworld\"",
        "uplift_sources = \"all\"", "accretion = \"abyss\"", "rifting = \"largest\"",
        "rifts_myr = 0.1", "count = 20", "continental_share = 0.0"}) {
    EXPECT_THAT(config, HasSubstr(line));
  }
  EXPECT_EQ(budget_of(run, "continental_start_km3"), 0.0);
  EXPECT_GT(budget_of(run, "continental_end_km3"), 1e8);  // of arcs that have emerged
  EXPECT_GT(budget_of(run, "rifts"), 3.0);
  EXPECT_NEAR(budget_of(run, "continental_closing_error"), 0.0, 1e-6);
}

}  // namespace
}  // namespace geo
