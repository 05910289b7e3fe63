// `terrane island`: further islands of a planet that is there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "cli/folder_contents.hpp"
#include "cli/program.hpp"
#include "cli/relief_file.hpp"
#include "cli/sample_run.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using Words = std::vector<std::string>;

const Words kSmall{"--set", "island.nx=48", "--set", "island.ny=32", "--set", "island.cell_m=8000"};

class Island : public testing::Test {
 protected:
  void SetUp() override { ReliefFile{}.write(relief_); }

  void run(Words more = {}) {
    more.insert(more.end(), kSmall.begin(), kSmall.end());
    const Outcome outcome = terrane(quick_run(relief_, out_, more));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  Outcome island(const Words& more = {}) {
    Words arguments{"island", out_.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return terrane(arguments);
  }
  /// The island is refused in one line that says this, and nothing in the folder changes.
  void expect_refusal(const Words& more, int code, const Words& says) {
    const auto before = contents_of(out_);
    const Outcome outcome = island(more);
    SCOPED_TRACE(testing::PrintToString(more) + ": " + outcome.err);
    EXPECT_EQ(outcome.code, code);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(lines_of(outcome.err).size(), 1U);
    for (const std::string& words : says) EXPECT_THAT(outcome.err, HasSubstr(words));
    EXPECT_TRUE(contents_of(out_) == before);
  }

  TemporaryFolder folder_;
  const fs::path relief_ = folder_ / "relief.nc", out_ = folder_ / "out";
};

/// Names of the files in a folder that begin with the number of the stage.
Words island_files(const fs::path& folder) {
  Words names;
  for (const auto& [name, bytes] : contents_of(folder)) {
    if (name.starts_with("07-")) names.push_back(name);
  }
  return names;
}

TEST_F(Island, ExemplarsAreThoseOfAFolderOrGrown) {
  run({"--set", "output.maps=false"});
  // An island is as good an exemplar as any, whatever the terrain of the place.
  fs::create_directory(folder_ / "exemplars");
  for (const char* name : {"andean.nc", "himalayan.nc", "old.nc", "plain.nc"}) {
    fs::copy_file(out_ / "07-island.nc", folder_ / "exemplars" / name);
  }
  const auto with_cache = [&](Words more) {
    Words arguments{"island", out_.string(), "--cell=1000", "--size=96,64", "--no-maps"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return terrane(Call{.arguments = arguments,
                        .environment = {{"XDG_CACHE_HOME", (folder_ / "cache").string()}},
                        .working_folder = {}});
  };
  const Outcome given = with_cache({"--exemplars", (folder_ / "exemplars").string()});
  EXPECT_EQ(given.code, 0) << given.err;
  const Outcome grown = with_cache({"--detail", "exemplars"});
  EXPECT_EQ(grown.code, 0) << grown.err;
  EXPECT_FALSE(fs::is_empty(folder_ / "cache/terrane"));
  const auto elevation = [&](const std::string& island) {
    for (const std::string& line : digests_of(out_)) {
      if (line.starts_with(island + "/elevation: ")) return line.substr(island.size());
    }
    return std::string();
  };
  EXPECT_NE(elevation("island-2"), "");
  EXPECT_NE(elevation("island-2"), elevation("island-3"));
}

TEST_F(Island, AFolderOfExemplarsThatCannotBeUsedIsRefused) {
  run({"--set", "output.maps=false"});
  const auto folder = [&](const char* name) { return (folder_ / name).string(); };
  expect_refusal({"--exemplars", folder("absent")}, 4, {"exemplars", "absent"});
  fs::create_directory(folder_ / "empty");
  expect_refusal({"--exemplars", folder("empty")}, 3, {"exemplars", "empty", "GeoTIFF"});
  fs::create_directory(folder_ / "broken");
  std::ofstream(folder_ / "broken/a.tif") << "no picture";
  expect_refusal({"--exemplars", folder("broken")}, 3, {"a.tif", "TIFF"});
  expect_refusal({"--detail", "exemplar"}, 2, {"island.detail", "exemplars"});
}

TEST_F(Island, FurtherOnesAreNumberedAndListed) {
  run();
  const auto before = contents_of(out_);
  const auto digests = digests_of(out_);
  for (const char* name : {"island-2", "island-3"}) {
    const Outcome outcome = island({"--center=10,20"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, HasSubstr(name));
    EXPECT_THAT(text_of(out_ / "island.pvd"), HasSubstr("07-" + std::string(name) + ".vti"));
  }
  EXPECT_THAT(island_files(out_), ElementsAre("07-island-2.nc", "07-island-2.vti", "07-island-3.nc",
                                              "07-island-3.vti", "07-island.nc", "07-island.vti"));
  EXPECT_THAT(text_of(out_ / "island.pvd"), HasSubstr("07-island.vti"));
  // What was there stays.
  const auto after = contents_of(out_);
  for (const auto& [name, bytes] : before) {
    if (name == "manifest.json" || name == "island.pvd") continue;
    EXPECT_TRUE(after.at(name) == bytes) << name;
  }
  const auto now = digests_of(out_);
  EXPECT_TRUE(std::equal(digests.begin(), digests.end(), now.begin()));
}

// The report was written anew without its globe, and without the year.
TEST_F(Island, TheReportKeepsWhatItHasOfThePlanet) {
  Words arguments = quick_run(relief_, out_, {"--to", "biomes", "--set", "output.monthly=true"});
  std::erase(arguments, "--no-maps");
  ASSERT_EQ(terrane(arguments).code, 0);
  const auto shows = [&](const char* what) {
    return text_of(out_ / "report.html").find(what) != std::string::npos;
  };
  ASSERT_TRUE(shows("id=\"globe\"") && shows("maps/year.png") && !shows("maps/island.png"));
  const Outcome outcome = island({"--size", "48,32", "--cell", "8000"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(shows("maps/island.png"));
  EXPECT_TRUE(shows("id=\"globe\""));
  EXPECT_TRUE(shows("maps/year.png"));
}

TEST_F(Island, ManifestTellsWhatAndWhere) {
  run();
  const Outcome made =
      island({"--center=-33.5,-70", "--size", "40,36", "--cell", "5000", "--quiet"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(made.err, "");
  const auto manifest = manifest_of(out_);
  EXPECT_TRUE(manifest.at("complete").get<bool>());
  const auto& entry = manifest.at("stages").back();
  EXPECT_EQ(entry.at("name"), "island-2");
  EXPECT_THAT(entry.at("files").get<Words>(), ElementsAre("07-island-2.nc", "07-island-2.vti"));
  EXPECT_DOUBLE_EQ(entry.at("budget").at("center_latitude_degree").get<double>(), -33.5);
  EXPECT_DOUBLE_EQ(entry.at("budget").at("center_longitude_degree").get<double>(), -70.0);
  for (const char* field : {"elevation", "discharge", "temperature", "biome"}) {
    EXPECT_TRUE(entry.at("fields").contains(field)) << field;
  }
  const Outcome told = terrane({"info", out_ / "07-island-2.nc"});
  EXPECT_EQ(told.code, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("40 x 36"));
}

TEST_F(Island, TheSameAskedTwiceIsTheSame) {
  run({"--no-vtk"});
  ASSERT_EQ(island({"--center=10,20"}).code, 0);
  ASSERT_EQ(island({"--center=10,20"}).code, 0);
  const auto stages = manifest_of(out_).at("stages");
  const auto& first = stages.at(stages.size() - 2);
  const auto& second = stages.back();
  EXPECT_EQ(second.at("name"), "island-3");
  EXPECT_EQ(first.at("fields"), second.at("fields"));
  EXPECT_FALSE(fs::exists(out_ / "island.pvd"));
}

TEST_F(Island, TheFirstHasNoNumber) {
  run({"--to", "biomes"});
  ASSERT_EQ(island({"--center=10,20"}).code, 0);
  EXPECT_THAT(island_files(out_), ElementsAre("07-island.nc", "07-island.vti"));
  ASSERT_EQ(island({"--center=20,20"}).code, 0);
  EXPECT_THAT(island_files(out_),
              ElementsAre("07-island-2.nc", "07-island-2.vti", "07-island.nc", "07-island.vti"));
}

TEST_F(Island, GivesTheFirstNameToTheRunsOwn) {
  run({"--to", "biomes"});
  ASSERT_EQ(island({"--center=10,20"}).code, 0);
  const std::string made = text_of(out_ / "07-island.nc");
  const Outcome resumed = terrane({"run", "--resume", "--to", "island", "-o", out_});
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  // The planet is the same: what was cut out of it stays, as a further one.
  EXPECT_THAT(stages_of(out_), testing::IsSupersetOf({"island", "island-2"}));
  EXPECT_THAT(island_files(out_),
              ElementsAre("07-island-2.nc", "07-island-2.vti", "07-island.nc", "07-island.vti"));
  EXPECT_TRUE(text_of(out_ / "07-island-2.nc") == made);
  EXPECT_FALSE(text_of(out_ / "07-island.nc") == made);
  const Outcome verified = terrane({"info", "--verify", out_});
  EXPECT_EQ(verified.code, 0) << verified.err;
  const Outcome anew = terrane({"run", "--overwrite", "--from", "hydrology", "-o", out_});
  EXPECT_EQ(anew.code, 0) << anew.err;
  EXPECT_THAT(island_files(out_), ElementsAre("07-island.nc", "07-island.vti"));
}

TEST_F(Island, BadRequestsAreRefusedInOneLine) {
  run({"--no-vtk"});
  const Words centre{"island.center", "latitude within 90"};
  for (const char* text : {"91,0", "-90.5,0", "0,361", "north", "10", "10,20,30", "nan,0"}) {
    expect_refusal({"--center=" + std::string(text)}, 2, centre);
  }
  expect_refusal({"--size", "64"}, 2, {"--size 64", "columns and rows"});
  expect_refusal({"--size", "8,64"}, 2, {"island.nx = 8", "must be in [32, 8192]"});
  expect_refusal({"--size", "64,b"}, 2, {"island.ny", "must be an integer"});
  expect_refusal({"--cell=0"}, 2, {"island.cell_m = 0", "must be in [10, 20000] m"});
  expect_refusal({"--cell", "wide"}, 2, {"island.cell_m", "must be a real number"});
  expect_refusal({"--wide"}, 2, {"--wide"});
}

TEST_F(Island, NeedsARun) {
  expect_refusal({}, 2, {"holds no run", out_.string()});
  fs::create_directory(out_);
  std::ofstream(out_ / "notes.txt") << "mine";
  expect_refusal({}, 2, {"holds no run", out_.string()});
  const Outcome nowhere = terrane({"island"});
  EXPECT_EQ(nowhere.code, 2);
  EXPECT_EQ(lines_of(nowhere.err).size(), 1U);
  EXPECT_THAT(nowhere.err, HasSubstr("give the folder of a run"));
}

TEST_F(Island, NeedsACompletePlanet) {
  run({"--to", "climate", "--no-vtk"});
  expect_refusal({}, 2, {"holds no complete planet", "discharge is missing", "--resume"});
}

TEST_F(Island, NeedsAWholePlanet) {
  ReliefFile half;
  half.north_deg = 45.0;
  half.write(relief_);
  run({"--no-vtk", "--to", "biomes"});
  expect_refusal({}, 2, {"holds a part of a planet", "the whole of one"});
}

TEST_F(Island, NeedsTheFilesThatTheManifestNames) {
  run({"--no-vtk"});
  fs::copy_file(out_ / "05-hydrology.nc", out_ / "04-climate.nc",
                fs::copy_options::overwrite_existing);
  expect_refusal({}, 3, {"04-climate.nc", "manifest"});
  fs::remove(out_ / "04-climate.nc");
  const auto before = contents_of(out_);
  const Outcome outcome = island();
  EXPECT_GT(outcome.code, 1) << outcome.err;
  EXPECT_EQ(lines_of(outcome.err).size(), 1U);
  EXPECT_THAT(outcome.err, HasSubstr("04-climate.nc"));
  EXPECT_TRUE(contents_of(out_) == before);
}

TEST_F(Island, NeedsAPlanetOfTheSameBuildOrAWordThatIsKept) {
  run({"--no-vtk"});
  const auto whole = manifest_of(out_);
  for (const std::string key : {"version", "commit", "build"}) {
    SCOPED_TRACE(key);
    auto manifest = whole;
    manifest[key] = "0.0.1";
    for (auto& stage : manifest["stages"]) stage["written_by"][key] = "0.0.1";
    std::ofstream(out_ / "manifest.json") << manifest.dump();
    expect_refusal({}, 2, {"was made by terrane ", "0.0.1", "--allow-other-build"});
  }
  const Outcome outcome = island({"--allow-other-build"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto manifest = manifest_of(out_);
  EXPECT_EQ(manifest.at("allowed"), nlohmann::json::array({"other-build"}));
  EXPECT_EQ(manifest.at("stages").front().at("written_by").at("build"), "0.0.1");
  EXPECT_EQ(manifest.at("stages").back().at("written_by").at("build"), whole.at("build"));
  EXPECT_EQ(manifest.at("build"), "0.0.1");
}

TEST_F(Island, NeedsThatAllStagesAreOfOneBuild) {
  run({"--no-vtk"});
  auto manifest = manifest_of(out_);
  manifest["stages"][2]["written_by"]["build"] = "0.0.1";
  std::ofstream(out_ / "manifest.json") << manifest.dump();
  expect_refusal({}, 2, {"build 0.0.1", "--allow-other-build"});
}

}  // namespace
}  // namespace geo
