// Files that break the libraries which read them: one line, exit code 3, and nobody waits for ever.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/program.hpp"
#include "cli/relief_file.hpp"
#include "cli/sample_run.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr int kInput = 3;

/// Files found by changing sound ones at random, on which HDF5 crashes or hangs in the program's
/// own process.
std::vector<fs::path> crashing_files() {
  std::vector<fs::path> files;
  for (const auto& entry :
       fs::directory_iterator(fs::path(TERRANE_SOURCE_DIR) / "tests/cli/crashing_files")) {
    files.push_back(entry.path());
  }
  return files;
}

void expect_refusal(const std::vector<std::string>& arguments) {
  const Outcome outcome = terrane(arguments);
  EXPECT_EQ(outcome.code, kInput) << outcome.err;
  EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("terrane: error: "));
}

TEST(DamagedFile, ThatCrashesItsLibraryIsOneLineOfInputError) {
  const auto files = crashing_files();
  ASSERT_GE(files.size(), 2U);
  for (const fs::path& file : files) {
    SCOPED_TRACE(file);
    expect_refusal({"score", file.string()});
    expect_refusal({"info", file.string()});
    const TemporaryFolder folder;
    expect_refusal({"run", "--dem", file.string(), "--dry-run", "-o", (folder / "out").string()});
    EXPECT_TRUE(folder.is_empty());
  }
}

TEST(DamagedFile, InTheFolderOfARunIsNotTrusted) {
  const TemporaryFolder folder;
  ReliefFile().write(folder / "relief.nc");
  ASSERT_EQ(terrane(quick_run(folder / "relief.nc", folder / "out", {"--to", "erosion"})).code, 0);
  for (const fs::path& file : crashing_files()) {
    fs::copy_file(file, folder / "out" / "03-erosion.nc", fs::copy_options::overwrite_existing);
    expect_refusal({"score", (folder / "out").string()});
  }
}

TEST(FileOfARun, ReadsTheSameWhetherItsBytesAreVouchedForOrNot) {
  const TemporaryFolder folder;
  ReliefFile().write(folder / "relief.nc");
  ASSERT_EQ(terrane(quick_run(folder / "relief.nc", folder / "out", {"--to", "climate"})).code, 0);
  const auto digests = manifest_of(folder / "out").at("stages").at(0).at("file_digests");
  EXPECT_TRUE(digests.contains("03-erosion.nc")) << digests;
  EXPECT_TRUE(digests.contains("03-erosion.vti")) << digests;
  const auto inside = terrane({"info", "--json", (folder / "out" / "04-climate.nc").string()});
  fs::copy_file(folder / "out" / "04-climate.nc", folder / "alone.nc");
  const auto aside = terrane({"info", "--json", (folder / "alone.nc").string()});
  EXPECT_EQ(inside.code, 0) << inside.err;
  EXPECT_EQ(aside.code, 0) << aside.err;
  EXPECT_EQ(inside.out, aside.out);  // digests of all values among it
}

}  // namespace
}  // namespace geo
