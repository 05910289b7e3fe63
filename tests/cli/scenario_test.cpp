// Scenarios of data/scenarios: what they promise happens, and in time.
#include <gtest/gtest.h>
#include <netcdf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "cli/program.hpp"
#include "geo/core/grid.hpp"
#include "geo/core/vector3.hpp"
#include "geo/io/netcdf/stage_file.hpp"
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

std::vector<float> values(int file, const char* name) {
  int variable = -1, dimensions = 0;
  EXPECT_EQ(nc_inq_varid(file, name, &variable), NC_NOERR) << name;
  std::array<int, NC_MAX_VAR_DIMS> dimension{};
  EXPECT_EQ(nc_inq_var(file, variable, nullptr, nullptr, &dimensions, dimension.data(), nullptr),
            NC_NOERR);
  std::size_t size = 1;
  for (int d = 0; d < dimensions; ++d) {
    std::size_t length = 0;
    EXPECT_EQ(nc_inq_dimlen(file, dimension[d], &length), NC_NOERR);
    size *= length;
  }
  std::vector<float> all(size);
  EXPECT_EQ(nc_get_var_float(file, variable, all.data()), NC_NOERR) << name;
  return all;
}

/// Sea floor of the map that is no older than an age, within 2500 km of a place.
double young_floor_km2(const fs::path& folder, const Centre& about, double age_myr) {
  int file = -1;
  EXPECT_EQ(nc_open((folder / "01-plates.nc").c_str(), NC_NOWRITE, &file), NC_NOERR);
  const auto latitude = values(file, "lat"), longitude = values(file, "lon");
  const auto age = values(file, "crust_age"), fraction = values(file, "continental_fraction");
  nc_close(file);
  constexpr double kRadius_km = 6371.0, kReach_km = 2500.0, kDegree = std::numbers::pi / 180.0;
  const double cell_rad2 =
      2.0 * std::numbers::pi / longitude.size() * std::numbers::pi / latitude.size();
  const auto unit = [](double phi, double lambda) {
    return Vector3{std::cos(phi * kDegree) * std::cos(lambda * kDegree),
                   std::cos(phi * kDegree) * std::sin(lambda * kDegree), std::sin(phi * kDegree)};
  };
  const Vector3 middle = unit(about.latitude_deg, about.longitude_deg);
  double area = 0.0;
  for (std::size_t j = 0; j < latitude.size(); ++j) {
    for (std::size_t i = 0; i < longitude.size(); ++i) {
      const std::size_t cell = j * longitude.size() + i;
      if (fraction[cell] >= 0.5F || age[cell] > age_myr) continue;
      if (kRadius_km * angle_between(unit(latitude[j], longitude[i]), middle) > kReach_km) continue;
      area += kRadius_km * kRadius_km * cell_rad2 * std::cos(latitude[j] * kDegree);
    }
  }
  return area;
}

class Scenario : public testing::Test {
 protected:
  void run(const std::string& name, const Words& more = {}) {
    Words arguments{"run",       std::string(TERRANE_SOURCE_DIR) + "/data/scenarios/" + name,
                    "-o",        out_.string(),
                    "--to",      "plates",
                    "--grid",    "128x64",
                    "--set",     "plates.sphere.samples=12000",
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
  // A new sea, on the map: both sides go 30 mm/yr for 36 Myr, 2160 km, along a coast of 5000 km,
  // less the passive margins and what the islands within take.
  const Centre fracture{-8.0, -45.0};
  EXPECT_GT(young_floor_km2(out_, fracture, 37.0), 0.4 * 2160.0 * 5000.0);
}

TEST_F(Scenario, TheIslandCollidesOnAFinerLatticeToo) {
  run("island-and-supercontinent.toml",
      {"--set", "plates.sphere.samples=100000", "--set", "plates.sphere.time_myr=100"});
  const auto all = happenings(out_);
  const auto collision = std::find_if(all.begin(), all.end(), [](const Happening& one) {
    return one.kind == "continental-collision";
  });
  ASSERT_NE(collision, all.end());
  EXPECT_NEAR(collision->time_myr, 77.0, 20.0);
  EXPECT_NEAR(collision->area_km2, 7.9e5, 2e5);
}

/// Continental crust of the map: that which is joined to a place, and all of it.
struct Land {
  double joined_km2 = 0.0, all_km2 = 0.0, joined_km3 = 0.0;
};
Land land_about(const fs::path& folder, const Centre& about) {
  int file = -1;
  EXPECT_EQ(nc_open((folder / "01-plates.nc").c_str(), NC_NOWRITE, &file), NC_NOERR);
  const auto fraction = values(file, "continental_fraction");
  const auto thickness_m = values(file, "crust_thickness");
  const Grid grid = Grid::sphere(static_cast<int>(values(file, "lon").size()),
                                 static_cast<int>(values(file, "lat").size()));
  nc_close(file);
  Land land;
  const auto area_km2 = [&](Index c) { return 1e-6 * grid.area_m2(grid.row(c)); };
  for (Index c = 0; c < grid.size(); ++c) {
    if (fraction[c] >= 0.5F) land.all_km2 += area_km2(c);
  }
  int row = 0, column = 0;
  while (std::abs(grid.latitude_deg(row) - about.latitude_deg) > 90.0 / grid.ny()) ++row;
  while (std::abs(grid.longitude_deg(column) - about.longitude_deg) > 180.0 / grid.nx()) ++column;
  std::vector<Index> reached{grid.cell(column, row)};
  std::vector<std::uint8_t> seen(grid.size(), 0);
  seen[reached.front()] = 1;
  for (std::size_t n = 0; n < reached.size(); ++n) {
    land.joined_km2 += area_km2(reached[n]);
    land.joined_km3 += area_km2(reached[n]) * 1e-3 * thickness_m[reached[n]];
    for (int k = 0; k < kDirections; ++k) {
      const Index next = grid.neighbour(reached[n], k);
      if (next == kNoCell || seen[next] != 0 || fraction[next] < 0.5F) continue;
      seen[next] = 1;
      reached.push_back(next);
    }
  }
  return land;
}

TEST_F(Scenario, AnIslandArcRisesAndBecomesPartOfAContinent) {
  const Centre continent{-15.0, -158.0};
  run("island-arc-and-continent.toml", {"--set", "plates.sphere.time_myr=34"});
  const Land before = land_about(out_, continent);
  // A chain of islands that is not yet joined to the continent.
  EXPECT_GT(before.all_km2 - before.joined_km2, 3e5);
  run("island-arc-and-continent.toml", {"--overwrite"});
  const auto all = happenings(out_);
  const auto collision = std::find_if(all.begin(), all.end(), [](const Happening& one) {
    return one.kind == "continental-collision";
  });
  ASSERT_NE(collision, all.end());
  EXPECT_NEAR(collision->time_myr, 48.0, 12.0);
  // East of the continent, where its coast was.
  EXPECT_NEAR(collision->place.longitude_deg, -147.0, 12.0);
  // Their crust is the continent's now: arcs emerge with 25 km. It is stacked rather than laid
  // alongside, so that the map shows a range and little more land.
  const Land after = land_about(out_, continent);
  EXPECT_GT(after.joined_km3 - before.joined_km3, 0.6 * 25.0 * collision->area_km2);
  EXPECT_GT(after.joined_km2, before.joined_km2);
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
  // On the map: 24 mm/yr open 1680 km in 70 Myr along 4000 km of central Africa, and what is now
  // Queensland is one land with China.
  EXPECT_GT(young_floor_km2(out_, {11.0, 18.0}, 71.0), 0.5 * 1680.0 * 4000.0);
  EXPECT_GT(land_about(out_, {-3.0, 153.0}).joined_km2, 4e7);
}

TEST_F(Scenario, ItsFramesAreWrittenAndGoOn) {
  run("island-and-supercontinent.toml",
      {"--set", "plates.sphere.time_myr=60", "--set", "plates.sphere.frames_myr=30"});
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
      {"--overwrite", "--set", "plates.sphere.time_myr=60", "--set", "plates.sphere.frames_myr=0",
       "--set", "fields.start_frame=" + middle.string()});
  EXPECT_EQ(plates(first), whole);  // digests of every field among it
}

TEST_F(Scenario, ItsLandscapeIsInFramesAndFilms) {
  run("island-and-supercontinent.toml",
      {"--set", "plates.sphere.time_myr=20", "--set", "plates.sphere.frames_myr=10", "--set",
       "plates.landscape=full"});
  const fs::path films = out_ / "maps" / "frames";
  const Outcome drawn = terrane({"maps", out_.string(), "--frames", "--width", "300"});
  ASSERT_EQ(drawn.code, 0) << drawn.err;
  for (const char* theme : {"elevation", "precipitation", "temperature", "crust_age"}) {
    for (const char* time : {"0000.00.png", "0010.00.png", "0020.00.png"}) {
      EXPECT_TRUE(fs::exists(films / theme / time)) << theme << time;
    }
  }
  const Outcome exported = terrane(
      {"export", out_.string(), "--format", "gplates", "-o", (folder_ / "gplates").string()});
  ASSERT_EQ(exported.code, 0) << exported.err;
  EXPECT_TRUE(fs::exists(folder_ / "gplates" / "coastlines.geojson"));
  run("island-and-supercontinent.toml",
      {"--overwrite", "--set", "plates.sphere.time_myr=10", "--set", "plates.sphere.frames_myr=0"});
  const Outcome none = terrane({"maps", out_.string(), "--frames"});
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.err.find("has no frames to draw"), std::string::npos) << none.err;
}

// fields.plates: what one drift leaves begins another one, also behind an export.

std::vector<std::int16_t> plates_in(const std::string& file) {
  const io::Snapshot snapshot = io::read_netcdf(file);
  for (const auto& [spec, values] : snapshot.fields) {
    if (spec->name == "plate_id") return std::get<std::vector<std::int16_t>>(*values);
  }
  ADD_FAILURE() << file << " has no plates";
  return {};
}

/// Share of cells in which two numberings agree, once each plate of `b` is called what most of its
/// cells are in `a`.
double agreement(const std::vector<std::int16_t>& a, const std::vector<std::int16_t>& b) {
  std::map<std::int16_t, std::map<std::int16_t, int>> counts;
  for (std::size_t c = 0; c < a.size(); ++c) ++counts[b[c]][a[c]];
  int same = 0;
  for (const auto& [plate, of] : counts) {
    int most = 0;
    for (const auto& [other, count] : of) most = std::max(most, count);
    same += most;
  }
  return static_cast<double>(same) / static_cast<double>(a.size());
}

TEST(PlatesByNumber, PlatesAndMotionsOfADriftBeginAnotherOne) {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder / name).string(); };
  const auto drift = [&](const char* name, const Words& more) {
    Words words{"run",       "--preset", "sphere", "--grid",
                "128x64",    "--to",     "plates", "--no-vtk",
                "--no-maps", "--quiet",  "--set",  "plates.sphere.samples=10000",
                "-o",        path(name)};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = terrane(words);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  };
  drift("first", {"--set", "plates.sphere.time_myr=40"});
  const Outcome exported = terrane({"export", path("first"), "--stage", "plates", "--field",
                                    "plate_id", "--format", "geotiff", "-o", path("plates.tif")});
  ASSERT_EQ(exported.code, 0) << exported.err;
  const auto first = plates_in(path("first/01-plates.nc"));
  for (const char* numbers : {"first/01-plates.nc:plate_id", "plates.tif"}) {
    drift("second", {"--overwrite", "--set", "plates.sphere.time_myr=0", "--set",
                     "fields.plates=" + path(numbers), "--set",
                     "fields.plate_rotations=" + path("first/01-plates-rotations.csv")});
    EXPECT_GT(agreement(first, plates_in(path("second/01-plates.nc"))), 0.95) << numbers;
  }
}

}  // namespace
}  // namespace geo
