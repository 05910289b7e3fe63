// The commands that only tell: params, presets, info, maps, --version, --help.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>

#include "cli/folder_contents.hpp"
#include "cli/program.hpp"
#include "cli/relief_file.hpp"
#include "cli/sample_run.hpp"
#include "io/maps/picture.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

/// What a command that must succeed prints; it says nothing on stderr.
std::string told_by(const std::vector<std::string>& arguments) {
  const Outcome outcome = terrane(arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  return outcome.out;
}

TEST(Version, NamesProgramCommitAndLibraries) {
  const std::string text = told_by({"--version"});
  EXPECT_THAT(text, StartsWith("terrane "));
  for (const char* words : {"commit", "CLI11"}) EXPECT_THAT(text, HasSubstr(words));
  EXPECT_GT(lines_of(text).size(), 3U);
}

TEST(Help, ListsEveryCommandAndEveryCommandHasItsOwn) {
  const std::string all = told_by({"--help"});
  for (const std::string command : {"run", "score", "maps", "params", "info", "presets"}) {
    EXPECT_THAT(all, HasSubstr(command));
    EXPECT_THAT(told_by({command, "--help"}), HasSubstr("terrane " + command));
  }
  for (const char* option : {"--dem", "--set", "--resume", "--dry-run", "--log-json"}) {
    EXPECT_THAT(told_by({"run", "--help"}), HasSubstr(option));
  }
}

TEST(Params, TellTheSameInEveryFormat) {
  const auto json = nlohmann::json::parse(told_by({"params", "--format", "json"}));
  const std::string table = told_by({"params"});
  const std::string markdown = told_by({"params", "--format", "markdown"});
  const std::string toml = told_by({"params", "--format", "toml"});
  EXPECT_EQ(told_by({"params", "--format", "table"}), table);
  ASSERT_GT(json.size(), 20U);
  EXPECT_EQ(lines_of(table).size(), json.size() + 1);
  for (const auto& parameter : json) {
    const std::string name = parameter.at("name");
    const std::string key = name.substr(name.rfind('.') + 1);
    EXPECT_THAT(table, HasSubstr(name + " "));
    EXPECT_THAT(markdown, HasSubstr("| <a id=\"" + name + "\"></a>`" + key + "` |"));
    EXPECT_THAT(toml, HasSubstr("\n" + key + " = "));
    EXPECT_FALSE(parameter.at("doc").get<std::string>().empty()) << name;
    EXPECT_FALSE(parameter.at("source").get<std::string>().empty()) << name;
  }
}

TEST(Params, OfOneStageAreItsOwn) {
  const auto json = nlohmann::json::parse(told_by({"params", "erosion", "--format", "json"}));
  ASSERT_FALSE(json.empty());
  for (const auto& parameter : json) {
    EXPECT_THAT(parameter.at("name").get<std::string>(), StartsWith("erosion."));
  }
}

TEST(Params, OfAStageWithTheNameOfACommandAreItsOwn) {
  const auto json = nlohmann::json::parse(told_by({"params", "island", "--format", "json"}));
  ASSERT_FALSE(json.empty());
  EXPECT_THAT(json.front().at("name").get<std::string>(), StartsWith("island."));
}

TEST(Options, ASettingMayStandBeforeTheConfiguration) {
  const Outcome outcome = terrane({"run", "--set", "output.maps=false", "absent.toml"});
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("absent.toml: "));
}

TEST(Params, AsTomlRunAsTheyAre) {
  const TemporaryFolder folder;
  ReliefFile{}.write(folder / "relief.nc");
  std::ofstream(folder / "all.toml") << told_by({"params", "--format", "toml"});
  ASSERT_EQ(terrane(quick_run(folder / "relief.nc", folder / "a", {folder / "all.toml"})).code, 0);
  ASSERT_EQ(terrane(quick_run(folder / "relief.nc", folder / "b", {"--preset", "earth"})).code, 0);
  EXPECT_EQ(digests_of(folder / "a"), digests_of(folder / "b"));
  EXPECT_EQ(text_of(folder / "a/config.toml"), text_of(folder / "b/config.toml"));
}

TEST(Presets, AreListedShownAndCanBeRun) {
  const TemporaryFolder folder;
  ReliefFile{}.write(folder / "relief.nc");
  const auto lines = lines_of(told_by({"presets"}));
  ASSERT_FALSE(lines.empty());
  EXPECT_THAT(lines.front(), StartsWith("earth "));
  for (const std::string& line : lines) {
    SCOPED_TRACE(line);
    const std::string name = line.substr(0, line.find(' '));
    EXPECT_GT(line.size(), 20U) << "says what it is";
    std::ofstream(folder / "preset.toml") << told_by({"presets", "--show", name});
    for (const auto& way : {std::vector<std::string>{"--preset", name},
                            std::vector<std::string>{folder / "preset.toml"}}) {
      auto arguments = quick_run(folder / "relief.nc", folder / "out", way);
      arguments.push_back("--dry-run");
      EXPECT_EQ(terrane(arguments).code, 0);
    }
  }
}

class FinishedRun : public testing::Test {
 protected:
  void SetUp() override {
    ReliefFile{}.write(folder_ / "relief.nc");
    ASSERT_EQ(terrane(quick_run(folder_ / "relief.nc", run_, {"--seed", "11"})).code, 0);
  }
  TemporaryFolder folder_;
  const fs::path run_ = folder_ / "out";
};

TEST_F(FinishedRun, InfoTellsWhatTheManifestTells) {
  const auto manifest = manifest_of(run_);
  for (const auto& stage : manifest.at("stages")) {
    const fs::path file = run_ / stage.at("files").at(0).get<std::string>();
    const std::string table = told_by({"info", file});
    EXPECT_THAT(table, HasSubstr("stage    " + stage.at("name").get<std::string>()));
    const bool own_grid = stage.at("name") == "island";
    EXPECT_THAT(table, HasSubstr(own_grid ? "128 x 64 cells" : "72 x 36 cells, sphere"));
    EXPECT_THAT(table, HasSubstr("seed 11"));
    const auto json = nlohmann::json::parse(told_by({"info", "--json", file}));
    EXPECT_EQ(json.at("nx"), own_grid ? 128 : 72);
    EXPECT_EQ(json.at("seed"), 11);
    ASSERT_EQ(json.at("fields").size(), stage.at("fields").size());
    for (const auto& [name, field] : stage.at("fields").items()) {
      EXPECT_THAT(table, HasSubstr(name));
      for (const char* key : {"units", "min", "mean", "max", "missing", "digest"}) {
        EXPECT_EQ(json.at("fields").at(name).at(key), field.at(key)) << name << ' ' << key;
      }
    }
  }
}

TEST_F(FinishedRun, ScoreTellsTheSameAsTableAndAsJson) {
  const std::string table = told_by({"score", run_});
  const auto json = nlohmann::json::parse(told_by({"score", run_, "--json"}));
  EXPECT_EQ(json.at("nx"), 72);
  const auto& figures = json.at("figures");
  ASSERT_GT(figures.size(), 50U);
  int within = 0;
  for (const auto& figure : figures) {
    for (const char* key : {"group", "name", "unit", "value", "target", "tolerance", "within"}) {
      ASSERT_TRUE(figure.contains(key)) << figure << ' ' << key;
    }
    const double off =
        std::abs(figure.at("value").get<double>() - figure.at("target").get<double>());
    EXPECT_EQ(figure.at("within"), off <= figure.at("tolerance").get<double>()) << figure;
    within += figure.at("within").get<bool>() ? 1 : 0;
    EXPECT_THAT(table, HasSubstr(figure.at("words").get<std::string>()));
  }
  EXPECT_EQ(json.at("totals").at("figures"), figures.size());
  EXPECT_EQ(json.at("totals").at("within"), within);
  EXPECT_THAT(table, HasSubstr(std::to_string(within) + " of " + std::to_string(figures.size())));
  EXPECT_THAT(table, HasSubstr("left out, no plate_id"));
}

TEST_F(FinishedRun, ScoreTakesAStageFileAndAReliefToo) {
  const auto stage = nlohmann::json::parse(told_by({"score", run_ / "03-erosion.nc", "--json"}));
  const auto relief =
      nlohmann::json::parse(told_by({"score", (folder_ / "relief.nc").string() + ":z", "--json"}));
  EXPECT_LT(stage.at("figures").size(), 60U);
  EXPECT_EQ(relief.at("figures").at(0).at("name"), "land_fraction");
  EXPECT_EQ(relief.at("ny"), 36);
}

TEST_F(FinishedRun, MapsAreDrawnAgain) {
  const auto before = contents_of(run_);
  const auto drawn = lines_of(told_by({"maps", run_, "--width", "300"}));
  EXPECT_THAT(drawn, Contains((run_ / "maps/elevation.png").string()));
  EXPECT_THAT(drawn, Contains((run_ / "report.html").string()));
  for (const std::string& file : drawn) EXPECT_TRUE(fs::exists(file)) << file;
  for (const auto& [name, bytes] : before) {
    if (name == "manifest.json") continue;
    EXPECT_TRUE(text_of(run_ / name) == bytes || bytes == "(folder)") << name;
  }
  // The manifest knows the new pictures and is what it was otherwise.
  auto then = nlohmann::json::parse(before.at("manifest.json")), now = manifest_of(run_);
  EXPECT_TRUE(now.at("files").contains("maps/elevation.png"));
  then.erase("files");
  now.erase("files");
  EXPECT_EQ(then, now);
}

TEST_F(FinishedRun, EveryFieldOfEveryStageIsDrawn) {
  const auto manifest = manifest_of(run_);
  for (const auto& stage : manifest.at("stages")) {
    std::vector<std::string> arguments{"maps", run_,      "--width",
                                       "300",  "--stage", stage.at("name").get<std::string>()};
    for (const auto& [name, field] : stage.at("fields").items()) {
      arguments.insert(arguments.end(), {"--field", name});
    }
    const auto drawn = lines_of(told_by(arguments));
    ASSERT_EQ(drawn.size(), stage.at("fields").size());
    for (const std::string& file : drawn) {
      EXPECT_THAT(file, StartsWith((run_ / "maps/fields").string()));
      EXPECT_GT(fs::file_size(file), 2000U) << file;
    }
  }
}

TEST_F(FinishedRun, OtherViewsLieBesideThePicturesOfTheRun) {
  told_by({"maps", run_, "--width", "300"});
  const auto before = contents_of(run_);
  const auto drawn = lines_of(told_by(
      {"maps", run_, "--projection", "orthographic", "--center", "-40,170", "--width", "300"}));
  EXPECT_THAT(drawn, Contains((run_ / "maps/orthographic/elevation.png").string()));
  const auto window =
      lines_of(told_by({"maps", run_, "--bbox", "160,-60,-150,-10", "--width", "300"}));
  EXPECT_THAT(window, Contains((run_ / "maps/window/elevation.png").string()));
  const auto elsewhere = lines_of(told_by({"maps", run_, "--field", "slope", "--projection",
                                           "mollweide", "--width", "300", "-o", folder_ / "x"}));
  EXPECT_THAT(elsewhere, testing::ElementsAre((folder_ / "x/slope.png").string()));
  for (const auto& [name, bytes] : before) {
    EXPECT_TRUE(bytes == "(folder)" || text_of(run_ / name) == bytes) << name;
  }
}

TEST_F(FinishedRun, AFieldIsThatOfTheLastStageOrOfTheOneNamed) {
  const auto draw = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"maps", run_, "--field", "elevation", "--width", "900"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return text_of(lines_of(told_by(arguments)).at(0));
  };
  // The upper right corner says which stage it is.
  const std::string last = draw({});
  EXPECT_TRUE(last == draw({"--stage", "hydrology"}));
  EXPECT_FALSE(last == draw({"--stage", "erosion"}));
  EXPECT_FALSE(last == draw({"--stage", "island"}));
}

TEST_F(FinishedRun, BiomesAloneHaveTheIceThatTheirMapHas) {
  // What is frozen all year is told by fields of the climate, which the stage of biomes has not.
  const fs::path cold = folder_ / "cold";
  ASSERT_EQ(terrane(quick_run(folder_ / "relief.nc", cold,
                              {"--set", "climate.solar_constant_w_m2=1150", "--to", "biomes"}))
                .code,
            0);
  const auto drawn = lines_of(told_by({"maps", cold, "--field", "biome", "--width", "600"}));
  const io::Picture picture(drawn.at(0), {});
  constexpr io::Colour kIce{244, 247, 251};
  bool legend_has_ice = false;
  for (int y = 2 * picture.height() / 3; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const io::Colour here = picture.at(x, y);  // rounded by Cairo
      legend_has_ice |= std::abs(here.r - kIce.r) <= 1 && std::abs(here.g - kIce.g) <= 1 &&
                        std::abs(here.b - kIce.b) <= 1;
    }
  }
  EXPECT_TRUE(legend_has_ice);
}

TEST_F(FinishedRun, WhatMapsCannotDrawIsSaidInOneLine) {
  const auto refusal = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"maps", run_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto before = contents_of(run_);
    const Outcome outcome = terrane(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
    EXPECT_TRUE(contents_of(run_) == before);
    return outcome.err;
  };
  EXPECT_THAT(refusal({"--field", "elevatoin"}), HasSubstr("perhaps elevation"));
  EXPECT_THAT(refusal({"--field", "precipitation", "--stage", "erosion"}),
              HasSubstr("stage erosion"));
  EXPECT_THAT(refusal({"--field", "slope", "--stage", "hydrolgy"}), HasSubstr("perhaps hydrology"));
  EXPECT_THAT(refusal({"--stage", "hydrology"}), HasSubstr("--field"));
  EXPECT_THAT(refusal({"--projection", "molweide"}), HasSubstr("perhaps mollweide"));
  EXPECT_THAT(refusal({"--projection", "robinson", "--center", "10,20"}), HasSubstr("equator"));
  EXPECT_THAT(refusal({"--center", "10"}), HasSubstr("--center 10"));
  EXPECT_THAT(refusal({"--bbox", "0,10,20"}), HasSubstr("--bbox 0,10,20"));
  EXPECT_THAT(refusal({"--field", "elevation", "--stage", "island", "--projection", "robinson"}),
              HasSubstr("as it lies"));
}

TEST(MapsOfARun, HaveTheProjectionOfTheConfiguration) {
  const TemporaryFolder folder;
  ReliefFile{}.write(folder / "relief.nc");
  auto arguments = quick_run(folder / "relief.nc", folder / "out",
                             {"--set", "output.map_projection=mollweide", "--set",
                              "output.map_center=0,90", "--set", "output.map_width_px=300"});
  std::erase(arguments, "--no-maps");
  ASSERT_EQ(terrane(arguments).code, 0);
  const std::string run = text_of(folder / "out/maps/elevation.png");
  told_by({"maps", folder / "out", "--projection", "mollweide", "--center", "0,90", "-o",
           folder / "again"});
  EXPECT_TRUE(text_of(folder / "again/elevation.png") == run);
  told_by({"maps", folder / "out", "--projection", "mollweide", "-o", folder / "centred"});
  EXPECT_FALSE(text_of(folder / "centred/elevation.png") == run);
}

TEST(MapsOfARun, AreThoseOfItsFiles) {
  const TemporaryFolder folder;
  const fs::path run = folder / "out";
  const auto starts = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run", "-o", run, "--no-vtk"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ASSERT_EQ(terrane(arguments).code, 0);
  };
  const auto expect_same_from_files = [&] {
    const auto before = contents_of(run);
    ASSERT_TRUE(before.contains("maps/island.png"));
    told_by({"maps", run});
    for (const auto& [name, bytes] : contents_of(run)) {
      EXPECT_TRUE(before.contains(name) && before.at(name) == bytes) << name;
    }
  };
  starts({"--grid", "128x64", "--set", "island.nx=128", "--set", "island.ny=64", "--set",
          "climate.resolution_deg=10", "--set", "output.map_width_px=300"});
  expect_same_from_files();
  starts({"--overwrite", "--from", "hydrology"});
  expect_same_from_files();
}

}  // namespace
}  // namespace geo
