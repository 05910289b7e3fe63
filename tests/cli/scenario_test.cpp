// Scenarios of data/scenarios: what they promise happens, and in time.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/program.hpp"
#include "geo/core/grid.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

struct Happening {
  std::string kind;
  double time_myr, area_km2;
  Centre place;
};

/// What stage plates tells of a run.
std::vector<Happening> happenings(const fs::path& folder) {
  std::ifstream file(folder / "manifest.json");
  const auto manifest = nlohmann::json::parse(file);
  std::vector<Happening> all;
  for (const auto& event : manifest.at("stages").at(0).at("events")) {
    all.push_back({event.at("kind"),
                   event.at("time_myr"),
                   event.value("area_km2", 0.0),
                   {event.at("latitude_deg"), event.at("longitude_deg")}});
  }
  return all;
}

class Scenario : public testing::Test {
 protected:
  void run(const std::string& name, const Words& more = {}) {
    Words arguments{"run",       std::string(TERRANE_SOURCE_DIR) + "/data/scenarios/" + name,
                    "-o",        out_.string(),
                    "--to",      "plates",
                    "--grid",    "128x64",
                    "--set",     "plates.samples=12000",
                    "--no-maps", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = terrane(arguments);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }

  TemporaryFolder folder_;
  const fs::path out_ = folder_ / "out";
};

TEST_F(Scenario, AnIslandIsDrivenIntoAContinentAndASupercontinentBreaks) {
  run("island-and-supercontinent.toml");
  std::vector<Happening> collisions;
  bool broke = false;
  for (const Happening& one : happenings(out_)) {
    if (one.kind == "continental-collision") collisions.push_back(one);
    broke = broke || (one.kind == "plate-rift" && one.time_myr == 245.0);
  }
  ASSERT_GE(collisions.size(), 2U);
  EXPECT_NEAR(collisions.front().time_myr, 77.0, 20.0);
  EXPECT_NEAR(collisions.front().area_km2, 7.9e5, 2e5);
  const auto large = std::find_if(collisions.begin(), collisions.end(),
                                  [](const Happening& one) { return one.area_km2 > 3e6; });
  ASSERT_NE(large, collisions.end());
  EXPECT_NEAR(large->time_myr, 191.0, 20.0);
  EXPECT_TRUE(broke);
}

TEST_F(Scenario, TheIslandCollidesOnAFinerLatticeToo) {
  run("island-and-supercontinent.toml",
      {"--set", "plates.samples=100000", "--set", "plates.time_myr=100"});
  const auto all = happenings(out_);
  const auto collision = std::find_if(all.begin(), all.end(), [](const Happening& one) {
    return one.kind == "continental-collision";
  });
  ASSERT_NE(collision, all.end());
  EXPECT_NEAR(collision->time_myr, 77.0, 20.0);
  EXPECT_NEAR(collision->area_km2, 7.9e5, 2e5);
}

/// Today's Earth, 80 million years on. Needs the Earth's relief, which Debian installs.
class FutureEarth : public Scenario {
 protected:
  void SetUp() override {
    if (!fs::exists("/usr/share/ferret-vis/data/etopo20.cdf")) {
      GTEST_SKIP() << "no ferret-datasets here";
    }
  }
};

TEST_F(FutureEarth, AfricaBreaksAndAustraliaMeetsAsia) {
  run("earth-in-80-million-years.toml");
  bool left = false, broke = false, met = false;
  for (const Happening& one : happenings(out_)) {
    left = left || (one.kind == "plate-motion" && one.time_myr == 0.0);
    broke = broke || (one.kind == "plate-rift" && one.time_myr == 10.0);
    // All of Australia and New Guinea, which have come 2000 km north.
    met = met || (one.kind == "continental-collision" && one.area_km2 > 7e6 &&
                  one.place.latitude_deg < 0.0 && one.place.latitude_deg > -20.0 &&
                  one.place.longitude_deg > 120.0 && one.time_myr > 10.0 && one.time_myr < 50.0);
  }
  EXPECT_TRUE(left);
  EXPECT_TRUE(broke);
  EXPECT_TRUE(met);
}

TEST_F(Scenario, ItsFramesAreWrittenAndGoOn) {
  run("island-and-supercontinent.toml",
      {"--set", "plates.time_myr=60", "--set", "plates.frames_myr=30"});
  const fs::path middle = out_ / "frames" / "plates-0030.00.nc";
  for (const fs::path& file :
       {middle, out_ / "frames" / "plates-0060.00.vti", out_ / "plates.pvd"}) {
    EXPECT_TRUE(fs::exists(file)) << file;
  }
  const fs::path first = out_ / "manifest.json";
  const auto plates = [](const fs::path& manifest) {
    std::ifstream file(manifest);
    return nlohmann::json::parse(file).at("stages").at(0).at("fields").dump();
  };
  const std::string whole = plates(first);
  run("island-and-supercontinent.toml",
      {"--overwrite", "--set", "plates.time_myr=60", "--set", "plates.frames_myr=0", "--set",
       "fields.start_frame=" + middle.string()});
  EXPECT_EQ(plates(first), whole);  // digests of every field among it
}

}  // namespace
}  // namespace geo
