// terrane export: what it writes of a run and of a file, and what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "cli/program.hpp"
#include "cli/relief_file.hpp"
#include "cli/sample_run.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Each has a run with climate and rivers.
class Export : public testing::Test {
 protected:
  void SetUp() override {
    ReliefFile{}.write(folder / "relief.nc");
    const Outcome outcome = terrane(quick_run(folder / "relief.nc", folder / "run"));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    run = (folder / "run").string();
  }
  TemporaryFolder folder;
  std::string run;
};

TEST_F(Export, WritesEveryFormatOfARunAndNamesItsFiles) {
  for (const auto& [format, name] :
       {std::pair{"png16", "a.png"}, std::pair{"r16", "b.r16"}, std::pair{"geotiff", "c.tif"},
        std::pair{"zarr", "d.zarr"}, std::pair{"healpix", "e.nc"}, std::pair{"glb", "f.glb"}}) {
    const Outcome outcome =
        terrane({"export", run, "--format", format, "-o", (folder / name).string()});
    EXPECT_EQ(outcome.code, 0) << format << outcome.err;
    const auto lines = lines_of(outcome.out);
    ASSERT_FALSE(lines.empty()) << format;
    for (const auto& line : lines) EXPECT_TRUE(fs::exists(line)) << line;
  }
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    EXPECT_NE(entry.path().filename().string().front(), '.') << "left behind: " << entry.path();
  }
}

/// Lines of a rotation file as numbers: moving plate, time, pole, angle, fixed plate.
std::vector<std::array<double, 6>> rotations_in(const fs::path& file) {
  std::vector<std::array<double, 6>> rows;
  for (const std::string& line : lines_of(text_of(file))) {
    auto& row = rows.emplace_back();
    std::istringstream words(line);
    for (double& number : row) words >> number;
    EXPECT_TRUE(words) << line;
  }
  return rows;
}

TEST(ExportForGplates, OfAModelWithoutTimeIsOneFrameAndARotationPerPlate) {
  const TemporaryFolder folder;
  const fs::path run = folder / "run", out = folder / "gplates";
  ASSERT_EQ(terrane({"run", "--grid", "64x32", "--to", "plates", "--no-maps", "-o", run}).code, 0);
  const Outcome outcome = terrane({"export", run, "--format", "gplates", "-o", out});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const auto& line : lines_of(outcome.out)) EXPECT_TRUE(fs::exists(line)) << line;
  std::map<double, int> of_plate;
  for (const auto& row : rotations_in(out / "rotations.rot")) {
    ++of_plate[row[0]];
    EXPECT_GE(row[0], 1000.0);
    EXPECT_EQ(row[5], 0.0);
    EXPECT_TRUE(row[1] == 0.0 ? row[4] == 0.0 : row[1] == 1.0 && row[4] < 5.0);
  }
  EXPECT_GT(of_plate.size(), 5U);
  for (const auto& [plate, lines] : of_plate) EXPECT_EQ(lines, 2) << plate;
  const auto plates = nlohmann::json::parse(text_of(out / "plates.geojson"));
  EXPECT_EQ(plates.at("features").size(), of_plate.size());
  EXPECT_EQ(plates.at("features")[0].at("properties").at("FROMAGE"), 1.0);
}

TEST(ExportForGplates, OfADriftHasEachStepOnceAndNamesWhatIsWrongInItsTables) {
  const TemporaryFolder folder;
  const fs::path run = folder / "run", out = folder / "gplates";
  ASSERT_EQ(terrane({"run", "--preset", "sphere", "--grid", "64x32", "--to", "plates", "--no-maps",
                     "--set", "plates.sphere.samples=3000", "--set", "plates.sphere.time_myr=6",
                     "--set", "plates.sphere.frames_myr=4", "-o", run})
                .code,
            0);
  ASSERT_EQ(terrane({"export", run, "--format", "gplates", "-o", out}).code, 0);
  std::map<double, std::set<double>> times;
  for (const auto& row : rotations_in(out / "rotations.rot")) {
    EXPECT_TRUE(times[row[0]].insert(row[1]).second || row[5] != 0.0) << row[0] << " " << row[1];
  }
  EXPECT_EQ(times.begin()->second, (std::set<double>{0.0, 2.0, 4.0, 6.0}));
  std::set<double> frames;
  const auto plates = nlohmann::json::parse(text_of(out / "plates.geojson"));
  for (const auto& plate : plates.at("features")) {
    frames.insert(plate.at("properties").at("FROMAGE").get<double>());
  }
  EXPECT_EQ(frames, (std::set<double>{0.0, 2.0, 6.0}));

  const fs::path table = run / "01-plates-rotations.csv";
  const std::string whole = text_of(table);
  const auto refused = [&](const std::string& text, const char* words) {
    std::ofstream(table) << text;
    const Outcome outcome = terrane({"export", run, "--format", "gplates", "-o", out});
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(words));
    EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
  };
  refused(whole + "0,2,0,north,0,0\n", "pole_latitude_deg: must be a number");
  refused(whole + "0,2,777,10,0,0\n", "rotations of plate 777: it is in no list of plates");
  refused("from_myr,to_myr\n0,2\n", "has no column plate_id");
}

TEST(ExportForGplates, RefusesWhatIsNoRunOfPlates) {
  const TemporaryFolder folder;
  const fs::path run = folder / "run";
  ASSERT_EQ(terrane({"run", "--preset", "hypsography", "--grid", "32x16", "--to", "plates",
                     "--no-maps", "-o", run})
                .code,
            0);
  const auto refused = [&](std::vector<std::string> arguments, const char* words) {
    arguments.insert(arguments.begin(), {"export", "--format", "gplates"});
    const Outcome outcome = terrane(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.out << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(words));
    EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
  };
  refused({run}, "one plate, which does not move");
  refused({run / "01-plates.nc"}, "takes the folder of a run");
  refused({folder.path()}, "holds no run");
  refused({run, "--field", "elevation"},
          "--field goes with --format png16, r16, geotiff, zarr, healpix or glb, not with gplates");
}

TEST_F(Export, OfAFieldOfAnotherStageTakesItFromThere) {
  const Outcome outcome = terrane({"export", run, "--format", "r16", "--field", "temperature", "-o",
                                   (folder / "t.r16").string()});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(text_of(folder / "t.json"));
  EXPECT_EQ(json.at("stage"), "climate");
  EXPECT_EQ(json.at("units"), "degC");
  EXPECT_EQ(fs::file_size(folder / "t.r16"),
            2 * json.at("width").get<int>() * json.at("height").get<int>());
}

TEST_F(Export, ComesInAgainAsAFieldByItsJsonOrByTheRangeThatIsGiven) {
  const fs::path image = folder / "up.png";
  ASSERT_EQ(terrane({"export", run, "--format", "png16", "--field", "elevation", "-o", image}).code,
            0);
  const auto uplift_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{
        "run",      "--preset",     "hypsography",
        "--grid",   "64x32",        "--to",
        "erosion",  "--set",        "fields.uplift_rate=" + image.string(),
        "-o",       folder / "out", "--overwrite",
        "--no-maps"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return terrane(arguments);
  };
  fs::remove(folder / "up.json");
  const Outcome untold = uplift_of({});
  EXPECT_EQ(untold.code, 3);
  EXPECT_THAT(untold.err, HasSubstr("give --dem-range MIN,MAX"));
  const Outcome told = uplift_of({"--dem-range=0,0.002"});
  ASSERT_EQ(told.code, 0) << told.err;
  const auto manifest = manifest_of(folder / "out");
  for (const auto& stage : manifest.at("stages")) {
    if (stage.at("name") != "erosion") continue;
    EXPECT_NEAR(stage.at("fields").at("uplift_rate").at("max").get<double>(), 0.002, 2e-4);
  }
}

TEST_F(Export, RefusesInOneLineWhatDoesNotGoTogether) {
  std::ofstream(folder / "notes.txt") << "no planet\n";
  fs::create_directory(folder / "other.zarr");
  struct Case {
    std::vector<std::string> options;
    int code;
    const char* words;
  };
  const std::vector<Case> cases{
      {{run}, 2, "--format"},
      {{run, "--format", "geotif"}, 2, "geotiff"},
      {{run, "--format", "png16", "--field", "elevatoin"}, 2, "elevation"},
      {{run, "--format", "png16", "--stage", "hydrologie"}, 2, "hydrology"},
      {{run, "--format", "geotiff", "--tiles", "65"}, 2, "--tiles"},
      {{run, "--format", "zarr", "--layout", "cube"}, 2, "--layout"},
      {{run, "--format", "glb", "--masks", "rivers"}, 2, "--masks"},
      {{run, "--format", "png16", "--layout", "ball"}, 2, "cube"},
      {{run, "--format", "png16", "--masks", "river"}, 2, "rivers"},
      {{run, "--format", "png16", "--tiles", "2"}, 2, "3"},
      {{run, "--format", "png16", "--tiles", "many"}, 2, "--tiles"},
      {{run, "--format", "png16", "--range", "7,-7"}, 2, "less"},
      {{run, "--format", "png16", "--range", "7"}, 2, "two numbers"},
      {{run, "--format", "healpix", "--nside", "100"}, 2, "power of two"},
      {{run, "--format", "png16", "--nside", "64"}, 2, "healpix"},
      {{run, "--format", "glb", "--exaggeration", "-1"}, 2, "--exaggeration"},
      {{run, "--format", "png16", "-o", (folder / "a.json").string()}, 2, ".png"},
      {{run, "--format", "png16", "-o", (folder / "nowhere" / "a.png").string()}, 4, "nowhere"},
      {{run, "--format", "zarr", "-o", (folder / "other.zarr").string()}, 2, "no Zarr store"},
      {{folder.path().string(), "--format", "png16"}, 2, "holds no run"},
      {{(folder / "notes.txt").string(), "--format", "png16"}, 3, "notes.txt"},
      {{(folder / "absent.nc").string(), "--format", "png16"}, 4, "absent.nc"},
  };
  for (const Case& each : cases) {
    std::vector<std::string> arguments{"export"};
    arguments.insert(arguments.end(), each.options.begin(), each.options.end());
    Call call;
    call.arguments = arguments;
    call.working_folder = folder.path();
    const Outcome outcome = terrane(call);
    EXPECT_EQ(outcome.code, each.code) << outcome.err << testing::PrintToString(each.options);
    EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(each.words));
  }
}

}  // namespace
}  // namespace geo
