// Folders that hold something else than a run could start from or go on with.
#include <fstream>

#include "cli/bad_input/bad_input.hpp"
#include "cli/folder_contents.hpp"
#include "cli/program.hpp"
#include "cli/relief_file.hpp"

namespace geo {
namespace {

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

INSTANTIATE_TEST_SUITE_P(Folder, BadInputTest, testing::ValuesIn(kFolders), name_of_input);

}  // namespace
}  // namespace geo
