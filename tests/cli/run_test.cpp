// What a run promises: the same bits, nothing but what was asked for, and silence where it belongs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <limits>

#include "cli/folder_contents.hpp"
#include "cli/program.hpp"
#include "cli/relief_file.hpp"
#include "cli/sample_run.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class Run : public testing::Test {
 protected:
  void SetUp() override { ReliefFile{}.write(relief_); }

  Outcome run(const std::string& name, const std::vector<std::string>& more = {}) {
    return terrane(quick_run(relief_, folder_ / name, more));
  }
  [[nodiscard]] bool there(const std::string& name) const { return fs::exists(folder_ / name); }

  TemporaryFolder folder_;
  const fs::path relief_ = folder_ / "relief.nc";
};

TEST_F(Run, WritesTheFilesThatItsManifestNames) {
  const Outcome outcome = run("out");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  const auto manifest = manifest_of(folder_ / "out");
  EXPECT_TRUE(manifest.at("complete").get<bool>());
  std::vector<std::string> named{"config.toml", "manifest.json", "planet.pvd", "island.pvd"};
  for (const auto& stage : manifest.at("stages")) {
    EXPECT_FALSE(stage.at("fields").empty());
    for (const std::string file : stage.at("files")) named.push_back(file);
    EXPECT_THAT(outcome.err, HasSubstr(stage.at("name")));
  }
  std::vector<std::string> found;
  for (const auto& [name, bytes] : contents_of(folder_ / "out")) found.push_back(name);
  EXPECT_THAT(found, testing::UnorderedElementsAreArray(named));
}

TEST_F(Run, GivesTheSameBitsForAnyNumberOfThreads) {
  ReliefFile{.nx = 144, .ny = 72}.write(relief_);
  for (const std::string threads : {"1", "2", "4"}) {
    const Outcome outcome =
        run(threads, {"--threads", threads, "--no-vtk", "--set", "erosion.steps=20"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(digests_of(folder_ / threads), digests_of(folder_ / "1")) << threads << " threads";
  }
}

TEST_F(Run, WithADateGivenMakesTheSameFilesByteForByte) {
  std::map<std::string, std::string> first;
  for (int time = 0; time < 2; ++time) {
    fs::remove_all(folder_ / "out");
    const Outcome outcome = terrane(
        {.arguments = {"run", "--dem", relief_, "-o", folder_ / "out", "--threads", "2", "--set",
                       "climate.resolution_deg=10", "--set", "output.map_width_px=300"},
         .environment = {{"SOURCE_DATE_EPOCH", "1600000000"}},
         .working_folder = {}});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto files = contents_of(folder_ / "out");
    EXPECT_TRUE(files.contains("report.html"));
    EXPECT_TRUE(files.contains("maps/elevation.png"));
    if (time == 0) first = files;
    ASSERT_EQ(files.size(), first.size());
    for (const auto& [name, bytes] : files) EXPECT_TRUE(bytes == first[name]) << name;
  }
  EXPECT_THAT(terrane({"info", folder_ / "out" / "03-erosion.nc"}).out,
              HasSubstr("2020-09-13T12:26:40Z"));
}

TEST_F(Run, WritesOnlyWhatWasAskedFor) {
  ASSERT_EQ(run("bare", {"--no-vtk"}).code, 0);
  for (const auto& [name, bytes] : contents_of(folder_ / "bare")) {
    EXPECT_THAT(name, Not(testing::AnyOf(HasSubstr(".vti"), HasSubstr(".pvd"), HasSubstr("maps"),
                                         HasSubstr(".html"))));
  }
  // A resumed run may add them.
  const Outcome more =
      terrane({"run", "--resume", "-o", folder_ / "bare", "--set", "output.vtk=true", "--set",
               "output.maps=true", "--set", "output.map_width_px=300"});
  EXPECT_EQ(more.code, 0) << more.err;
  EXPECT_TRUE(there("bare/planet.pvd"));
  EXPECT_TRUE(there("bare/report.html"));
  const auto manifest = manifest_of(folder_ / "bare");
  for (const auto& stage : manifest.at("stages")) {
    ASSERT_EQ(stage.at("files").size(), 2U) << "the manifest names all files";
    for (const std::string file : stage.at("files")) EXPECT_TRUE(there("bare/" + file)) << file;
  }
}

TEST_F(Run, WritesGlobesOnRequest) {
  const Outcome outcome = run("out", {"--set", "output.globe=true"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string listed = text_of(folder_ / "out" / "globe.pvd");
  for (const std::string stage : {"03-erosion", "04-climate", "05-hydrology", "06-biomes"}) {
    EXPECT_TRUE(there("out/" + stage + ".vtp"));
    EXPECT_THAT(listed, HasSubstr(stage + ".vtp"));
  }
  const auto manifest = manifest_of(folder_ / "out");
  EXPECT_THAT(manifest.at("stages")[0].at("files").get<std::vector<std::string>>(),
              Contains("03-erosion.vtp"));
  EXPECT_FALSE(there("out/07-island.vtp")) << "an island is no globe";
  // Heights on them may be changed afterwards.
  const auto before = text_of(folder_ / "out" / "03-erosion.vtp");
  const Outcome more =
      terrane({"run", "--resume", "-o", folder_ / "out", "--set", "output.globe_exaggeration=2"});
  EXPECT_EQ(more.code, 0) << more.err;
  EXPECT_NE(text_of(folder_ / "out" / "03-erosion.vtp"), before);
}

TEST_F(Run, DryRunPredictsAndWritesNothing) {
  const auto before = contents_of(folder_.path());
  const Outcome outcome = run("out", {"--dry-run"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  for (const char* words : {"72 x 36", "erosion", "biomes", "memory", "time", "2 threads"}) {
    EXPECT_THAT(outcome.out, HasSubstr(words));
  }
  EXPECT_TRUE(before == contents_of(folder_.path()));
}

// A disk with room enough for a small island was refused, as for one of half a million cells.
TEST_F(Run, PredictsTheFilesOfAnIslandOfAnySize) {
  std::vector<std::string> arguments{
      "run",          "--preset", "preview",         "--grid",        "128x64",
      "--to",         "island",   "--set",           "island.nx=128", "--set",
      "island.ny=64", "--set",    "output.vtk=true", "--no-maps",     "-o",
      folder_ / "out"};
  ASSERT_EQ(terrane(arguments).code, 0);
  double written = 0.0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out")) {
    if (entry.is_regular_file()) written += static_cast<double>(entry.file_size());
  }
  arguments.insert(arguments.end(), {"--overwrite", "--dry-run"});
  const std::string told = terrane(arguments).out;
  const auto at = told.find("files   about ");
  ASSERT_NE(at, std::string::npos) << told;
  const double predicted = 1e6 * std::stod(told.substr(at + 14));
  EXPECT_GT(predicted, 0.4 * written);
  EXPECT_LT(predicted, 2.5 * written);
}

// A raster world was told to take 3 s whatever its map, and took 20 and 130.
TEST_F(Run, PredictsMoreTimeForLargerRasterWorldsAndLessForTiles) {
  const auto told_s = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run",  "--preset",      "raster",    "--grid",    "64x64",
                                       "--to", "plates",        "--no-maps", "--threads", "1",
                                       "-o",   folder_ / "out", "--dry-run"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const std::string out = terrane(arguments).out;
    const auto at = out.find("time    about ");
    EXPECT_NE(at, std::string::npos) << out;
    double seconds = 0.0, number = 0.0;
    std::istringstream words(out.substr(at + 14));
    for (std::string unit; words >> number >> unit && (unit == "min" || unit == "s");) {
      seconds += unit == "min" ? 60.0 * number : number;
    }
    return seconds;
  };
  // A prediction is for the machine as busy as it is: the least of several in turn has other work
  // out, and finds it as busy for one as for the other.
  const std::array<std::vector<std::string>, 4> worlds{{{},
                                                        {"--set", "plates.raster.map_columns=1024"},
                                                        {"--set", "plates.raster.cycles=1"},
                                                        {"--topology", "torus"}}};
  std::array<double, 4> least_s;
  least_s.fill(std::numeric_limits<double>::infinity());
  constexpr int kPredictions = 3;
  for (int time = 0; time < kPredictions; ++time) {
    for (std::size_t k = 0; k < worlds.size(); ++k) {
      least_s[k] = std::min(least_s[k], told_s(worlds[k]));
    }
  }
  const auto [usual_s, large_s, short_s, tile_s] = least_s;
  EXPECT_GT(large_s, 3.0 * usual_s);
  EXPECT_LT(short_s, 0.8 * usual_s);
  EXPECT_LT(tile_s, 0.5 * usual_s);
}

// Most of a small run is its climates, three of them, which cost what their air does. A machine
// that is busy with other tests slows some down and not others, so that only the two runs are held
// against each other closely, and each against its prediction within an order of size.
TEST_F(Run, PredictsTheTimeOfDearAndCheapClimates) {
  const auto least = [](double& kept, double seconds) { kept = std::min(kept, seconds); };
  struct Climate {
    std::vector<std::string> arguments;
    double took_s = std::numeric_limits<double>::infinity();
    double predicted_s = std::numeric_limits<double>::infinity();
  };
  std::array<Climate, 2> climates;
  for (std::size_t k = 0; k < climates.size(); ++k) {
    const std::string air_deg = k == 0 ? "3" : "10";
    climates[k].arguments = {"run",         "--preset",  "preview",
                             "--grid",      "64x32",     "--to",
                             "climate",     "--set",     "climate.resolution_deg=" + air_deg,
                             "--no-maps",   "--threads", "1",
                             "--overwrite", "-o",        folder_ / "timed"};
  }
  // A prediction is for the machine as busy as it is: the least of several in turn has other work
  // out, and finds it as busy for one as for the other.
  constexpr int kRuns = 2, kPredictions = 3;
  for (int time = 0; time < kRuns; ++time) {
    for (Climate& climate : climates) {
      const Outcome ran = terrane(climate.arguments);
      ASSERT_EQ(ran.code, 0) << ran.err;
      least(climate.took_s, ran.processor_s);
    }
    for (int told = 0; told < kPredictions; ++told) {
      for (Climate& climate : climates) {
        auto arguments = climate.arguments;
        arguments.emplace_back("--dry-run");
        const std::string out = terrane(arguments).out;
        const auto at = out.find("time    about ");
        ASSERT_NE(at, std::string::npos) << out;
        least(climate.predicted_s, std::stod(out.substr(at + 14)));
      }
    }
  }
  for (const Climate& climate : climates) {
    EXPECT_GT(climate.predicted_s, 0.2 * climate.took_s);
    EXPECT_LT(climate.predicted_s, 5.0 * climate.took_s);
  }
  const double dearer = climates[0].took_s / climates[1].took_s;
  const double told_dearer = climates[0].predicted_s / climates[1].predicted_s;
  EXPECT_GT(told_dearer, 0.5 * dearer);
  EXPECT_LT(told_dearer, 2.5 * dearer);
}

TEST_F(Run, QuietSaysNothing) {
  const Outcome outcome = run("out", {"--quiet"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "");
}

TEST_F(Run, EventsStrikeAreToldAndBindTheirFolder) {
  const fs::path file = folder_ / "planet.toml";
  const std::string shift = "[[event]]\nkind = \"ocean-shift\"\nrise_m = 250.0\n";
  std::ofstream(file) << "[[event]]\nkind = \"impact\"\nname = \"Big\"\nlatitude_deg = 10\n"
                         "longitude_deg = 20\ndiameter_km = 30\n"
                      << shift;
  const Outcome struck = run("struck", {file.string(), "--to", "climate"});
  ASSERT_EQ(struck.code, 0) << struck.err;
  ASSERT_EQ(run("spared", {"--to", "climate"}).code, 0);
  EXPECT_NE(digests_of(folder_ / "struck"), digests_of(folder_ / "spared"));
  const auto stages = manifest_of(folder_ / "struck").at("stages");
  ASSERT_EQ(stages.at(0).at("events").size(), 2U);
  EXPECT_EQ(stages.at(0).at("events").at(0).at("name"), "Big");
  EXPECT_GT(stages.at(0).at("events").at(0).at("crater_diameter_km"), 100.0);
  EXPECT_EQ(stages.at(0).at("events").at(1).at("rise_m"), 250.0);
  EXPECT_GT(stages.at(1).at("events").at(0).at("cooling_k"), 10.0);

  // The configuration that it wrote makes the same planet; another list of events goes nowhere.
  const std::string config = (folder_ / "struck" / "config.toml").string();
  const Outcome again =
      terrane(std::vector<std::string>{"run", config, "-o", folder_ / "again", "--quiet"});
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(digests_of(folder_ / "again"), digests_of(folder_ / "struck"));
  std::ofstream(file, std::ios::trunc) << shift;
  const Outcome changed = run("struck", {file.string(), "--resume"});
  EXPECT_EQ(changed.code, 2);
  EXPECT_THAT(changed.err, HasSubstr("the configuration changed: event 1 is another"));
  const Outcome kept = run("struck", {file.string(), "--overwrite", "--from", "climate"});
  EXPECT_EQ(kept.code, 2);
  EXPECT_THAT(kept.err, HasSubstr("the stages before it would not be the same: event 1"));
  const Outcome unfelt = run("unfelt", {file.string(), "--from", "climate", "--to", "climate"});
  EXPECT_EQ(unfelt.code, 0);
  EXPECT_THAT(unfelt.err, HasSubstr("events change elevation in stage erosion"));
}

TEST_F(Run, ClosedStreamsGoIntoNoFile) {
  ASSERT_EQ(run("open").code, 0);
  std::string command = TERRANE_PROGRAM;
  for (const auto& word : quick_run(relief_, folder_ / "closed")) command += " '" + word + "'";
  ASSERT_EQ(std::system((command + " <&- >&- 2>&-").c_str()), 0);
  EXPECT_EQ(digests_of(folder_ / "closed"), digests_of(folder_ / "open"));
  for (const auto& [name, bytes] : contents_of(folder_ / "closed")) {
    EXPECT_THAT(bytes, Not(HasSubstr("hydrology  0."))) << name;
    if (name.ends_with(".nc")) {
      EXPECT_EQ(terrane({"info", folder_ / "closed" / name}).code, 0) << name;
    }
  }
}

TEST_F(Run, QuietStillTellsErrors) {
  EXPECT_EQ(lines_of(run("out", {"--quiet", "--set", "erosion.steps=-1"}).err).size(), 1U);
}

TEST_F(Run, JsonLogIsOneObjectALine) {
  const Outcome sound = run("out", {"--log-json"});
  const Outcome refused = run("out", {"--log-json"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(sound.out, "");
  EXPECT_GE(lines_of(sound.err).size(), stages_of(folder_ / "out").size());
  for (const std::string& line : lines_of(sound.err + refused.err)) {
    ASSERT_TRUE(nlohmann::json::accept(line)) << line;
    const auto json = nlohmann::json::parse(line);
    EXPECT_TRUE(json.at("time").is_number());
    EXPECT_TRUE(json.at("message").is_string());
    EXPECT_THAT((std::vector<std::string>{"info", "warning", "error"}), Contains(json.at("level")));
  }
  EXPECT_THAT(refused.err, HasSubstr("\"level\":\"error\""));
}

TEST_F(Run, ProgressBarIsDrawnOnATerminalOnly) {
  EXPECT_THAT(run("out").err, Not(testing::AnyOf(HasSubstr("\r"), HasSubstr("\033"))));
  if (std::system("script --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "lacks script";
  const auto on_terminal = [&](const std::string& more) {
    std::string command = TERRANE_PROGRAM;
    for (const auto& word : quick_run(relief_, folder_ / "out", {"--overwrite", more})) {
      command += " '" + word + "'";
    }
    const fs::path file = folder_ / "typescript";
    const std::string call =
        "script -qec \"" + command + "\" " + file.string() + " > /dev/null < /dev/null";
    EXPECT_EQ(std::system(call.c_str()), 0) << call;
    return text_of(file);
  };
  const std::string shown = on_terminal("--no-vtk");
  EXPECT_THAT(shown, HasSubstr("\r\033[K"));
  EXPECT_THAT(shown, HasSubstr("climate    ["));
  EXPECT_THAT(shown, HasSubstr(" %"));
  EXPECT_THAT(on_terminal("--quiet"), Not(HasSubstr("climate ")));
  EXPECT_THAT(on_terminal("--log-json"), Not(HasSubstr("\033[K")));
}

TEST_F(Run, ConfigurationThatItWroteRunsAgainAsItIs) {
  ASSERT_EQ(run("first", {"--seed", "7", "--set", "erosion.steps=3"}).code, 0);
  const Outcome again =
      terrane({"run", folder_ / "first" / "config.toml", "-o", folder_ / "second"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(digests_of(folder_ / "second"), digests_of(folder_ / "first"));
  EXPECT_EQ(text_of(folder_ / "second/config.toml"), text_of(folder_ / "first/config.toml"));
  EXPECT_EQ(manifest_of(folder_ / "second").at("seed"), 7);
}

TEST_F(Run, LaterSayWins) {
  std::ofstream(folder_ / "planet.toml") << "[run]\ngrid = \"36x18\"\nseed = 5\n"
                                            "[erosion]\nsteps = 2\ntime_step_yr = 7.0\n";
  const Outcome outcome = run("out", {"--preset", "preview", folder_ / "planet.toml", "--seed", "6",
                                      "--set", "erosion.steps=4", "--to", "erosion"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string config = text_of(folder_ / "out/config.toml");
  for (const char* line : {"\ngrid = \"36x18\"\n", "\nseed = 6\n", "\nsteps = 4\n",
                           "\ntime_step_yr = 7.0\n", "\nmap_width_px = 800\n"}) {
    EXPECT_THAT(config, HasSubstr(line));
  }
}

TEST_F(Run, ReliefIsSoughtBesideTheConfigurationThatNamesIt) {
  fs::create_directory(folder_ / "deep");
  fs::copy(relief_, folder_ / "deep/relief.nc");
  fs::remove(relief_);
  std::ofstream(folder_ / "deep/planet.toml") << "[dem]\nfile = \"relief.nc\"\n";
  const Outcome outcome =
      terrane({.arguments = {"run", "deep/planet.toml", "--to", "erosion", "--no-maps", "--no-vtk"},
               .environment = {},
               .working_folder = folder_.path()});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(there("out/03-erosion.nc")) << "the folder is called out unless told otherwise";
}

TEST_F(Run, OverwriteReplacesItsOwnFilesOnly) {
  ASSERT_EQ(run("out").code, 0);
  std::ofstream(folder_ / "out/notes.txt") << "precious";
  ASSERT_EQ(run("out", {"--overwrite", "--to", "erosion", "--seed", "2"}).code, 0);
  EXPECT_EQ(text_of(folder_ / "out/notes.txt"), "precious");
  EXPECT_EQ(stages_of(folder_ / "out"), std::vector<std::string>{"erosion"});
  EXPECT_FALSE(there("out/04-climate.nc"));
}

TEST_F(Run, OverwriteFromAStageKeepsTheEarlierOnes) {
  ASSERT_EQ(run("out").code, 0);
  const std::string erosion = text_of(folder_ / "out/03-erosion.nc");
  const auto before = digests_of(folder_ / "out");
  const Outcome outcome = terrane({"run", "--overwrite", "--from", "climate", "-o", folder_ / "out",
                                   "--set", "climate.solar_constant_w_m2=1200"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(text_of(folder_ / "out/03-erosion.nc"), erosion);
  EXPECT_NE(digests_of(folder_ / "out"), before);
  // The same planet in one go.
  ASSERT_EQ(run("straight", {"--set", "climate.solar_constant_w_m2=1200"}).code, 0);
  EXPECT_EQ(digests_of(folder_ / "out"), digests_of(folder_ / "straight"));
}

TEST_F(Run, ResumedByItsOwnCommandLineGoesOnAsFarAsThatSays) {
  ASSERT_EQ(run("out", {"--to", "erosion"}).code, 0);
  ASSERT_EQ(run("out", {"--resume", "--to", "climate"}).code, 0);
  EXPECT_EQ(stages_of(folder_ / "out"), (std::vector<std::string>{"erosion", "climate"}));
  std::ofstream(folder_ / "planet.toml") << "[run]\nto = \"climate\"\n";
  const Outcome again = run("out", {folder_ / "planet.toml", "--resume"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("all stages are complete"));
  EXPECT_EQ(stages_of(folder_ / "out"), (std::vector<std::string>{"erosion", "climate"}));
  ASSERT_EQ(terrane({"run", "--resume", "-o", folder_ / "out"}).code, 0);
  ASSERT_EQ(run("straight").code, 0);
  EXPECT_EQ(digests_of(folder_ / "out"), digests_of(folder_ / "straight"));
  EXPECT_EQ(text_of(folder_ / "out/config.toml"), text_of(folder_ / "straight/config.toml"));
}

TEST_F(Run, StagesCanEndEarly) {
  ASSERT_EQ(run("out", {"--to", "climate"}).code, 0);
  EXPECT_EQ(stages_of(folder_ / "out"), (std::vector<std::string>{"erosion", "climate"}));
}

}  // namespace
}  // namespace geo
