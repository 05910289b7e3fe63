// Every kind of bad input: the right exit code, one line that says what and where, no harm done.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "cli/folder_contents.hpp"
#include "cli/program.hpp"
#include "cli/relief_file.hpp"
#include "cli/sample_run.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;
using Words = std::vector<std::string>;

constexpr int kConfiguration = 2, kInput = 3, kIo = 4;

/// What is wrong: how to call the program in a folder that holds a sound `relief.nc`, with which
/// code it must refuse, and what its one line must say.
struct BadInput {
  std::string name;
  int code;
  Words says;
  std::function<Words(const fs::path& folder)> arguments;
  Words environment = {};  ///< name, value
};

void PrintTo(const BadInput& input, std::ostream* stream) { *stream << input.name; }

/// A sound run with more arguments.
auto run_with(Words more) {
  return [more = std::move(more)](const fs::path& folder) {
    return quick_run(folder / "relief.nc", folder / "out", more);
  };
}

/// A sound run of a configuration file.
auto run_config(std::string toml) {
  return [toml = std::move(toml)](const fs::path& folder) {
    std::ofstream(folder / "planet.toml", std::ios::binary) << toml;
    return quick_run(folder / "relief.nc", folder / "out", {(folder / "planet.toml").string()});
  };
}

/// A run of a relief that is not sound.
auto run_relief(ReliefFile relief, std::string variable = "") {
  return [relief, variable = std::move(variable)](const fs::path& folder) {
    relief.write(folder / "bad.nc");
    return quick_run((folder / "bad.nc").string() + variable, folder / "out");
  };
}

/// A run of a relief file with such bytes.
auto run_bytes(std::function<std::string(const std::string& sound)> bytes) {
  return [bytes = std::move(bytes)](const fs::path& folder) {
    std::ofstream(folder / "bad.nc", std::ios::binary) << bytes(text_of(folder / "relief.nc"));
    return quick_run(folder / "bad.nc", folder / "out");
  };
}

/// What follows a first stage that is already in the folder.
auto after_erosion(Words more) {
  return [more = std::move(more)](const fs::path& folder) {
    const Outcome first =
        terrane(quick_run(folder / "relief.nc", folder / "out", {"--to", "erosion", "--no-vtk"}));
    EXPECT_EQ(first.code, 0) << first.err;
    Words arguments{"run", "-o", (folder / "out").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
}

auto words(Words arguments) {
  return [arguments = std::move(arguments)](const fs::path&) { return arguments; };
}

const BadInput kConfigurations[] = {
    {"UnknownKey",
     kConfiguration,
     {"planet.toml:2: ", "unknown key erosion.step", "did you mean erosion.steps?"},
     run_config("[erosion]\nstep = 3\n")},
    {"FormerKey",
     kConfiguration,
     {"planet.toml:3: plates.samples is now plates.sphere.samples"},
     run_config("[plates]\nmodel = \"sphere\"\nsamples = 60000\n")},
    {"FormerNameOfAKey",
     kConfiguration,
     {"planet.toml:2: fields.first_relief is now fields.initial_elevation"},
     run_config("[fields]\nfirst_relief = \"earth.nc\"\n")},
    {"UnknownSection",
     kConfiguration,
     {"planet.toml:1: ", "unknown section [erosoin]", "did you mean erosion?"},
     run_config("[erosoin]\nsteps = 3\n")},
    {"KeyWithoutSection",
     kConfiguration,
     {"planet.toml:1: ", "steps must stand in a section", "[erosion]"},
     run_config("steps = 3\n")},
    {"WrongType",
     kConfiguration,
     {"planet.toml:2: ", "erosion.steps = \"three\"", "must be an integer"},
     run_config("[erosion]\nsteps = \"three\"\n")},
    {"FractionForInteger",
     kConfiguration,
     {"planet.toml:2: ", "erosion.steps = 2.5", "must be an integer"},
     run_config("[erosion]\nsteps = 2.5\n")},
    {"ArrayForNumber",
     kConfiguration,
     {"planet.toml:3: ", "erosion.steps: is an array", "must be a plain integer"},
     run_config("[erosion]\n\nsteps = [1, 2]\n")},
    {"OutOfRange",
     kConfiguration,
     {"planet.toml:2: ", "erosion.slope_exponent = -1.0", "must be in [0.1, 10]"},
     run_config("[erosion]\nslope_exponent = -1.0\n")},
    {"NotANumber",
     kConfiguration,
     {"planet.toml:2: ", "erosion.slope_exponent = nan", "must be finite"},
     run_config("[erosion]\nslope_exponent = nan\n")},
    {"Infinite",
     kConfiguration,
     {"planet.toml:2: ", "planet.radius_km = inf", "must be finite"},
     run_config("[planet]\nradius_km = inf\n")},
    {"UnknownChoice",
     kConfiguration,
     {"planet.toml:2: ", "dem.sea_level = \"fractoin\"", "one of", "did you mean \"fraction\"?"},
     run_config("[dem]\nsea_level = \"fractoin\"\n")},
    {"SyntaxError", kConfiguration, {"planet.toml:3: "}, run_config("[erosion]\nsteps = 3\n= 4\n")},
    {"UnclosedText", kConfiguration, {"planet.toml:2: "}, run_config("[run]\nto = \"erosion\n")},
    {"DuplicateKey",
     kConfiguration,
     {"planet.toml:3: ", "steps"},
     run_config("[erosion]\nsteps = 3\nsteps = 4\n")},
    {"BytesThatAreNoText",
     kConfiguration,
     {"planet.toml:1: "},
     run_config(std::string("\x89PNG\r\n\x1a\n\0\xff", 10))},
    {"AbsentConfiguration", kIo, {"nowhere.toml", "No such file"}, run_with({"nowhere.toml"})},
    {"FolderForConfiguration", kIo, {"/tmp", "is a folder"}, run_with({"/tmp"})},
    {"UnknownPreset",
     kConfiguration,
     {"unknown preset eart", "did you mean earth?"},
     run_with({"--preset", "eart"})},
    {"UnknownStageToStartFrom",
     kConfiguration,
     {"unknown stage erode", "erosion", "climate"},
     run_with({"--from", "erode"})},
    {"UnknownStageToEndWith",
     kConfiguration,
     {"unknown stage clmate", "did you mean climate?"},
     run_with({"--to", "clmate"})},
    {"FromAfterTo",
     kConfiguration,
     {"run.from = biomes comes after run.to = erosion"},
     run_with({"--from", "biomes", "--to", "erosion"})},
    {"FromAStageThatLacksItsInput",
     kConfiguration,
     {"stage biomes needs the field", "which stage"},
     run_with({"--from", "biomes"})},
    {"EventOfUnknownKind",
     kConfiguration,
     {"planet.toml:3: event.kind = \"comet\": must be one of impact, rift, ocean-shift"},
     run_config("\n[run]\n[[event]]\nkind = \"comet\"\n")},
    {"EventThatLacksItsPlace",
     kConfiguration,
     {"planet.toml:1: event of kind impact needs latitude_deg"},
     run_config("[[event]]\nkind = \"impact\"\n")},
    {"EventAsAnOption",
     kConfiguration,
     {"--set event.kind=rift: events are tables [[event]] of a configuration file"},
     run_with({"--set", "event.kind=rift"})},
    {"ImpactThatEndsThePlanet",
     kConfiguration,
     {"event 1 (impact): its crater of", "wider than the planet's radius"},
     run_config("[[event]]\nkind = \"impact\"\nlatitude_deg = 0\nlongitude_deg = 0\n"
                "diameter_km = 1000\nvelocity_km_s = 70\nangle_deg = 90\n")},
    {"ShiftOfMoreWaterThanThereIs",
     kConfiguration,
     {"event 1 (ocean-shift): water_km3 = -1e+12: must be within"},
     run_config("[[event]]\nkind = \"ocean-shift\"\nwater_km3 = -1e12\n")},
    {"EpochThatIsNoNumber",
     kConfiguration,
     {"SOURCE_DATE_EPOCH = yesterday", "seconds since 1970"},
     run_with({}),
     {"SOURCE_DATE_EPOCH", "yesterday"}},
    {"EpochBeforeTime",
     kConfiguration,
     {"SOURCE_DATE_EPOCH = -1", "seconds since 1970"},
     run_with({}),
     {"SOURCE_DATE_EPOCH", "-1"}},
    {"EpochBeyondTheCalendar",
     kConfiguration,
     {"SOURCE_DATE_EPOCH = 999999999999999999", "seconds since 1970"},
     run_with({}),
     {"SOURCE_DATE_EPOCH", "999999999999999999"}},
    {"EpochOfADryRun",
     kConfiguration,
     {"SOURCE_DATE_EPOCH = yesterday"},
     run_with({"--dry-run"}),
     {"SOURCE_DATE_EPOCH", "yesterday"}},
};

const BadInput kCommandLines[] = {
    {"NoCommand", kConfiguration, {"no command", "--help"}, words({})},
    {"UnknownCommand",
     kConfiguration,
     {"unknown command rnu", "did you mean run?"},
     words({"rnu"})},
    {"UnknownProgramOption",
     kConfiguration,
     {"unknown option --versoin", "did you mean --version?"},
     words({"--versoin"})},
    {"UnknownOption",
     kConfiguration,
     {"unknown option --overwrit", "did you mean --overwrite?"},
     run_with({"--overwrit"})},
    {"UnknownShortOption", kConfiguration, {"unknown option -q", "--help"}, run_with({"-q"})},
    {"TwoConfigurations",
     kConfiguration,
     {"unknown argument b.toml"},
     words({"run", "a.toml", "b.toml"})},
    {"OptionWithoutItsValue", kConfiguration, {"--seed"}, words({"run", "--seed"})},
    {"OptionGivenTwice", kConfiguration, {"--seed"}, run_with({"--seed", "1", "--seed", "2"})},
    {"SetWithoutEquals",
     kConfiguration,
     {"--set erosion.steps", "must be section.key=value"},
     run_with({"--set", "erosion.steps"})},
    {"SetWithoutKey", kConfiguration, {"--set =3", "section.key"}, run_with({"--set", "=3"})},
    {"SetWithoutSection",
     kConfiguration,
     {"--set steps=3: must be section.key=value", "did you mean erosion.steps?"},
     run_with({"--set", "steps=3"})},
    {"SetUnknownKey",
     kConfiguration,
     {"--set: unknown key erosion.stpes", "did you mean erosion.steps?"},
     run_with({"--set", "erosion.stpes=3"})},
    {"SetFormerKey",
     kConfiguration,
     {"--set: plates.foundering_myr is now plates.sphere.subduction_initiation_myr"},
     run_with({"--set", "plates.foundering_myr=0.1"})},
    {"SetWrongType",
     kConfiguration,
     {"--set: erosion.steps = \"many\"", "must be an integer"},
     run_with({"--set", "erosion.steps=many"})},
    {"SetOutOfRange",
     kConfiguration,
     {"--set: planet.ocean_fraction = 1.5", "must be in"},
     run_with({"--set", "planet.ocean_fraction=1.5"})},
    {"SetNaN",
     kConfiguration,
     {"--set: planet.radius_km = nan", "must be finite"},
     run_with({"--set", "planet.radius_km=nan"})},
    {"SetNoTruth",
     kConfiguration,
     {"--set: output.vtk = \"yes\"", "true or false"},
     run_with({"--set", "output.vtk=yes"})},
    {"SeedThatIsNoNumber",
     kConfiguration,
     {"--seed", "run.seed = \"x1\""},
     run_with({"--seed", "x1"})},
    {"NegativeSeed", kConfiguration, {"--seed", "run.seed = -1"}, run_with({"--seed=-1"})},
    {"SeedBeyondItsRange",
     kConfiguration,
     {"--seed", "99999999999999999999"},
     run_with({"--seed", "99999999999999999999"})},
    {"GridOfWords",
     kConfiguration,
     {"run.grid = \"abc\"", "WIDTHxHEIGHT"},
     run_with({"--grid", "abc"})},
    {"GridWithoutHeight",
     kConfiguration,
     {"run.grid = \"10x\"", "WIDTHxHEIGHT"},
     run_with({"--grid", "10x"})},
    {"GridWithATail",
     kConfiguration,
     {"run.grid = \"72x36x2\"", "WIDTHxHEIGHT"},
     run_with({"--grid", "72x36x2"})},
    {"GridOfNothing", kConfiguration, {"0 x 0", "at least 4 x 3"}, run_with({"--grid", "0x0"})},
    {"NegativeGrid",
     kConfiguration,
     {"grid", "-72 x 36", "at least"},
     run_with({"--grid", "-72x36"})},
    {"OddWidthOnASphere",
     kConfiguration,
     {"grid width 73", "must be even"},
     run_with({"--grid", "73x36"})},
    {"GridBeyondAnyMemory",
     kConfiguration,
     {"100000 x 100000", "at most"},
     run_with({"--grid", "100000x100000"})},
    {"GridBeyondIntegers",
     kConfiguration,
     {"run.grid", "99999999999x36", "WIDTHxHEIGHT"},
     run_with({"--grid", "99999999999x36"})},
    {"NoThreads", kConfiguration, {"--threads 0", "from 1 to"}, run_with({"--threads", "0"})},
    {"ThreadsThatAreNoNumber",
     kConfiguration,
     {"--threads two", "from 1 to"},
     run_with({"--threads", "two"})},
    {"TooManyThreads",
     kConfiguration,
     {"--threads 100000", "from 1 to"},
     run_with({"--threads", "100000"})},
    {"NoRelief",
     kConfiguration,
     {"erosion needs a DEM", "--dem FILE"},
     words({"run", "--from", "erosion", "-o", "out"})},
    {"NoReliefWithPreset",
     kConfiguration,
     {"erosion needs a DEM", "--dem FILE"},
     words({"run", "--preset", "earth", "--set", "run.from=erosion", "-o", "out"})},
    {"EmptyFolderName",
     kConfiguration,
     {"-o", "folder"},
     [](const fs::path& folder) { return quick_run(folder / "relief.nc", ""); }},
    {"ResumeAndOverwrite",
     kConfiguration,
     {"--resume and --overwrite exclude each other"},
     run_with({"--resume", "--overwrite"})},
    {"ResumeWithoutARun",
     kConfiguration,
     {"--resume", "out", "holds no run"},
     run_with({"--resume"})},
    {"InfoWithoutFile", kConfiguration, {"info: which FILE?"}, words({"info"})},
    {"MapProjectionUnknown",
     kConfiguration,
     {"output.map_projection", "robinson"},
     run_with({"--set", "output.map_projection=robbinson"})},
    {"MapCenterOffTheEquator",
     kConfiguration,
     {"robinson", "equator"},
     run_with({"--set", "output.map_projection=robinson", "--set", "output.map_center=10,0"})},
    {"MapsWithoutFolder", kConfiguration, {"maps:", "folder"}, words({"maps"})},
    {"ScoreOfNothing", kConfiguration, {"score:", "which planet?"}, words({"score"})},
    {"ScoreOfNoSuchFile",
     kIo,
     {"cannot read nowhere.nc", "No such file"},
     words({"score", "nowhere.nc"})},
    {"ScoreOfAFolderWithoutStages",
     kInput,
     {"/usr: holds no stage file", "03-erosion.nc"},
     words({"score", "/usr"})},
    {"ScoreOfAPartOfAPlanet",
     kInput,
     {"part.nc:z: covers a part of a planet only", "pole to pole"},
     [](const fs::path& folder) {
       ReliefFile part;
       part.north_deg = 30.0;
       part.write(folder / "part.nc");
       return Words{"score", folder / "part.nc"};
     }},
    {"MapsOfNoRun", kConfiguration, {"maps:", "holds no run"}, words({"maps", "/usr"})},
    {"ParamsOfUnknownStage",
     kConfiguration,
     {"unknown stage ersion", "did you mean erosion?"},
     words({"params", "ersion"})},
    {"ParamsOfAFormerKey",
     kConfiguration,
     {"erosion.wave_base_m is now erosion.sediment.wave_base_m"},
     words({"params", "erosion.wave_base_m"})},
    {"ParamsInUnknownFormat",
     kConfiguration,
     {"--format jsno", "did you mean json?"},
     words({"params", "--format", "jsno"})},
    {"ShowOfUnknownPreset",
     kConfiguration,
     {"unknown preset previw", "did you mean preview?"},
     words({"presets", "--show", "previw"})},
};

const BadInput kReliefs[] = {
    {"NaN",
     kInput,
     {"bad.nc", "variable z", "1 cell(s) are missing or NaN", "row 18, column 5", "latitude 2.5"},
     run_relief({.hole = std::nan("")})},
    {"MissingValue",
     kInput,
     {"bad.nc", "variable z", "1 cell(s) are missing or NaN", "row 18, column 5"},
     run_relief({.hole = -32768.0})},
    {"Infinity",
     kInput,
     {"bad.nc", "variable z", "row 18, column 5"},
     run_relief({.hole = INFINITY})},
    {"HeightsBeyondAnyPlanet",
     kInput,
     {"bad.nc:z", "elevation of", "within 100000 m"},
     run_relief({.hole = 1e30})},
    {"WrongUnits",
     kInput,
     {"bad.nc", "variable z", "units are \"K\"", "must be a length"},
     run_relief({.units = "K"})},
    {"AbsentVariable",
     kInput,
     {"bad.nc", "variable height is missing", "holds z"},
     run_relief({}, ":height")},
    {"OneDimension",
     kInput,
     {"bad.nc", "holds no raster over latitude and longitude"},
     run_relief({.one_dimensional = true})},
    {"OneDimensionByName",
     kInput,
     {"bad.nc", "variable z"},
     run_relief({.one_dimensional = true}, ":z")},
    {"UnevenLatitudes",
     kInput,
     {"bad.nc", "axis lat", "uneven at index"},
     run_relief({.latitude_kink_deg = 1.0})},
    {"Truncated", kInput, {"bad.nc", "truncated"}, run_bytes([](const std::string& sound) {
       return sound.substr(0, sound.size() * 2 / 3);
     })},
    {"Empty", kInput, {"bad.nc", "not a NetCDF file"}, run_bytes([](auto&) { return ""; })},
    {"TextFile", kInput, {"bad.nc", "not a NetCDF file"}, run_bytes([](auto&) {
       return "latitude,longitude,elevation\n";
     })},
    {"FieldBelowItsBound",
     kInput,
     {"k.nc:k: erodibility is -", "yr-1 somewhere; must be at least 0"},
     [](const fs::path& folder) {
       ReliefFile{.variable = "k", .units = "yr-1"}.write(folder / "k.nc");
       return quick_run(folder / "relief.nc", folder / "out",
                        {"--set", "fields.erodibility=" + (folder / "k.nc").string()});
     }},
    {"Folder",
     kIo,
     {"Is a directory"},
     [](const fs::path& folder) { return quick_run(folder, folder / "out"); }},
    {"Absent",
     kIo,
     {"nowhere.nc", "No such file"},
     [](const fs::path& folder) { return quick_run(folder / "nowhere.nc", folder / "out"); }},
    {"NameBeyondAllNames",
     kIo,
     {"File name too long"},
     [](const fs::path& folder) { return quick_run(std::string(5000, 'x'), folder / "out"); }},
    {"InfoOfARelief",
     kInput,
     {"relief.nc", "not a stage file"},
     [](const fs::path& folder) {
       return Words{"info", folder / "relief.nc"};
     }},
    {"InfoOfText",
     kInput,
     {"note.txt", "not a NetCDF file"},
     [](const fs::path& folder) {
       std::ofstream(folder / "note.txt") << "hello\n";
       return Words{"info", folder / "note.txt"};
     }},
    {"InfoOfNothing", kIo, {"nowhere.nc", "No such file"}, words({"info", "nowhere.nc"})},
};

const BadInput kFolders[] = {
    {"HoldsARun",
     kConfiguration,
     {"out already holds a run", "--resume", "--overwrite"},
     [](const fs::path& folder) {
       after_erosion({})(folder);
       return quick_run(folder / "relief.nc", folder / "out");
     }},
    {"HoldsARunAlsoForADryRun",
     kConfiguration,
     {"out already holds a run"},
     after_erosion({"--dry-run"})},
    {"HoldsHalfARun",
     kConfiguration,
     {"out already holds a run"},
     [](const fs::path& folder) {
       fs::create_directory(folder / "out");
       std::ofstream(folder / "out" / "03-erosion.nc") << "precious";
       return quick_run(folder / "relief.nc", folder / "out");
     }},
    {"ResumeWithAnotherParameter",
     kConfiguration,
     {"--resume", "the configuration changed", "erosion.steps is 7, was 0"},
     after_erosion({"--resume", "--set", "erosion.steps=7"})},
    {"ResumeWithAnotherSeed",
     kConfiguration,
     {"the configuration changed", "run.seed is 2, was 1"},
     after_erosion({"--resume", "--seed", "2"})},
    {"ResumeWithAnotherGrid",
     kConfiguration,
     {"the configuration changed", "run.grid is \"36x18\", was \"72x36\""},
     after_erosion({"--resume", "--grid", "36x18"})},
    {"ResumeWithAnotherRelief",
     kConfiguration,
     {"the configuration changed", "dem.file is \"/other.nc\", was"},
     after_erosion({"--resume", "--dem", "/other.nc"})},
    {"ResumeWithBrokenManifest",
     kInput,
     {"manifest.json"},
     [](const fs::path& folder) {
       const Words arguments = after_erosion({"--resume"})(folder);
       std::ofstream(folder / "out" / "manifest.json") << "{\"version\": ";
       return arguments;
     }},
    {"ResumeOfAnotherVersionsRun",
     kConfiguration,
     {"--resume", "was made by terrane 0.0.1, this is ", "--overwrite"},
     [](const fs::path& folder) {
       const Words arguments = after_erosion({"--resume"})(folder);
       auto manifest = manifest_of(folder / "out");
       manifest["version"] = "0.0.1";
       std::ofstream(folder / "out" / "manifest.json") << manifest;
       return arguments;
     }},
    {"FromBehindAStageThatIsNotThere",
     kConfiguration,
     {"--from biomes", "holds no complete climate"},
     after_erosion({"--overwrite", "--from", "biomes", "--to", "biomes"})},
    {"IsAFile",
     kIo,
     {"note", "is a file, must be a folder"},
     [](const fs::path& folder) {
       std::ofstream(folder / "note") << "precious";
       return quick_run(folder / "relief.nc", folder / "note");
     }},
    {"LiesInAFile",
     kIo,
     {"note", "is a file, must be a folder"},
     [](const fs::path& folder) {
       std::ofstream(folder / "note") << "precious";
       return quick_run(folder / "relief.nc", folder / "note" / "out");
     }},
    {"LiesWhereNobodyMayWrite",
     kIo,
     {"/proc"},
     [](const fs::path& folder) { return quick_run(folder / "relief.nc", "/proc/terrane/out"); }},
};

/// A run of drifting plates that are in such a file.
auto drift_of(std::string plates, Words more = {}) {
  return [plates = std::move(plates), more = std::move(more)](const fs::path& folder) {
    if (!plates.empty()) std::ofstream(folder / "plates.geojson", std::ios::binary) << plates;
    Words arguments{"run",
                    "-o",
                    (folder / "out").string(),
                    "--grid",
                    "64x32",
                    "--to",
                    "plates",
                    "--set",
                    "plates.model=sphere",
                    "--set",
                    "fields.plates=" + (folder / "plates.geojson").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
}

std::string two_plates(const std::string& properties, const std::string& ring) {
  return R"({"type": "FeatureCollection", "features": [)"
         R"({"properties": {"Code": "PA"}, "geometry": {"type": "Polygon", "coordinates": )"
         R"([[[0, 0], [90, 0], [90, 45], [0, 0]]]}}, {"properties": {)" +
         properties + R"(}, "geometry": {"type": "Polygon", "coordinates": [)" + ring + "]}}]}";
}

const BadInput kPlates[] = {
    {"WithARelief",
     kConfiguration,
     {"fields.plates = earth: is for stage plates", "begins with erosion", "--dem",
      "must be empty"},
     [](const fs::path& folder) {
       return quick_run(folder / "relief.nc", folder / "out", {"--set", "fields.plates=earth"});
     }},
    {"FirstReliefWithARelief",
     kConfiguration,
     {"fields.initial_elevation = x.nc: is for stage plates", "must be empty"},
     [](const fs::path& folder) {
       return quick_run(folder / "relief.nc", folder / "out",
                        {"--set", "fields.initial_elevation=x.nc"});
     }},
    {"OthersBehindAStageThatStays",
     kConfiguration,
     {"--from isostasy", "fields.plates is \"earth\", was \"\"", "--overwrite"},
     [](const fs::path& folder) {
       const Words drift{"run", "-o", (folder / "out").string(), "--set", "plates.model=sphere"};
       Words first = drift, again = drift;
       for (const char* word :
            {"--grid", "64x32", "--to", "plates", "--set", "plates.sphere.samples=2000", "--set",
             "plates.sphere.time_myr=4", "--no-vtk", "--no-maps"}) {
         first.emplace_back(word);
       }
       for (const char* word : {"--overwrite", "--from", "isostasy", "--to", "isostasy", "--set",
                                "plates.sphere.samples=2000", "--set", "plates.sphere.time_myr=4",
                                "--set", "fields.plates=earth"}) {
         again.emplace_back(word);
       }
       const Outcome outcome = terrane(first);
       EXPECT_EQ(outcome.code, 0) << outcome.err;
       return again;
     }},
    {"NoFile", kInput, {"fields.plates", "no such file", "must be earth or"}, drift_of("")},
    {"NoJson", kInput, {"plates.geojson: is no JSON"}, drift_of("<kml/>")},
    {"UnknownCode",
     kInput,
     {"plates.geojson: feature 2 (XY): XY is no Code of PB2002"},
     drift_of(two_plates(R"("Code": "XY")", "[[0, 0], [9, 0], [9, 9], [0, 0]]"))},
    {"CrossesItself",
     kInput,
     {"feature 2 (AF): a ring crosses itself"},
     drift_of(two_plates(R"("Code": "AF")", "[[0, 0], [9, 9], [9, 0], [0, 9], [0, 0]]"))},
    {"InMetres",
     kInput,
     {"feature 2 (AF): 900000, 0 is no longitude"},
     drift_of(two_plates(R"("Code": "AF")", "[[0, 0], [9e5, 0], [9e5, 9], [0, 0]]"))},
    {"MotionsOfOutlines",
     kConfiguration,
     {"fields.plate_rotations = x.csv", "by number", "must be empty"},
     drift_of("<>", {"--set", "fields.plate_rotations=x.csv"})},
    {"NumbersWithoutMotions",
     kConfiguration,
     {"relief.nc", "plates by number", "fields.plate_rotations"},
     [](const fs::path& folder) {
       ReliefFile{}.write(folder / "relief.nc");
       return drift_of("", {"--set", "fields.plates=" + (folder / "relief.nc").string()})(folder);
     }},
    {"NoFirstRelief",
     kConfiguration,
     {"plates.sphere.initial_elevation = given", "fields.initial_elevation"},
     drift_of("",
              {"--set", "fields.plates=earth", "--set", "plates.sphere.initial_elevation=given"})},
    {"FirstReliefOfAPart",
     kInput,
     {"fields.initial_elevation", "must cover the whole planet"},
     [](const fs::path& folder) {
       ReliefFile{.north_deg = 60.0}.write(folder / "part.nc");
       return drift_of(
           "", {"--set", "fields.plates=earth", "--set", "plates.sphere.initial_elevation=given",
                "--set", "fields.initial_elevation=" + (folder / "part.nc").string()})(folder);
     }},
};

class BadInputTest : public testing::TestWithParam<BadInput> {};

TEST_P(BadInputTest, IsRefusedInOneLineAndHarmsNothing) {
  const BadInput& input = GetParam();
  const TemporaryFolder folder;
  ReliefFile{}.write(folder / "relief.nc");
  Call call{.arguments = input.arguments(folder.path()),
            .environment = {},
            .working_folder = folder.path()};
  if (!input.environment.empty()) {
    call.environment.emplace_back(input.environment[0], input.environment[1]);
  }
  const auto before = contents_of(folder.path());
  const Outcome outcome = terrane(call);
  EXPECT_EQ(outcome.code, input.code);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
  EXPECT_THAT(outcome.err, StartsWith("terrane: error: "));
  for (const std::string& words : input.says) EXPECT_THAT(outcome.err, HasSubstr(words));
  EXPECT_TRUE(before == contents_of(folder.path())) << "files were touched";
}

const auto name_of = [](const testing::TestParamInfo<BadInput>& info) { return info.param.name; };
INSTANTIATE_TEST_SUITE_P(Configuration, BadInputTest, testing::ValuesIn(kConfigurations), name_of);
INSTANTIATE_TEST_SUITE_P(CommandLine, BadInputTest, testing::ValuesIn(kCommandLines), name_of);
INSTANTIATE_TEST_SUITE_P(Relief, BadInputTest, testing::ValuesIn(kReliefs), name_of);
INSTANTIATE_TEST_SUITE_P(Plates, BadInputTest, testing::ValuesIn(kPlates), name_of);
INSTANTIATE_TEST_SUITE_P(Folder, BadInputTest, testing::ValuesIn(kFolders), name_of);

}  // namespace
}  // namespace geo
