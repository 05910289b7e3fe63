// terrane run --memory: the same planet in less memory, what does not fit in a scratch file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cli/program.hpp"
#include "cli/sample_run.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double kCap_bytes = 200e6;

/// Takes 350 MB of memory and 2 s of processor time.
std::vector<std::string> large_run(const fs::path& folder,
                                   const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"run",  "--preset", "hypsography", "--grid",    "2048x1024",
                                     "--to", "isostasy", "--no-vtk",    "--no-maps", "--threads",
                                     "2",    "-o",       folder};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

void expect_refusal(const Outcome& outcome, int code, const std::string& what) {
  EXPECT_EQ(outcome.code, code) << outcome.err;
  const auto lines = lines_of(outcome.err);
  ASSERT_EQ(lines.size(), 1U) << outcome.err;
  EXPECT_THAT(lines.front(), StartsWith("terrane: error: "));
  EXPECT_THAT(lines.front(), HasSubstr(what));
}

TEST(MemoryCap, IsKeptAndChangesNoBit) {
#ifdef TERRANE_SANITIZED
  GTEST_SKIP() << "a sanitizer has memory of its own";
#endif
  const TemporaryFolder folder;
  const Outcome plain = terrane(large_run(folder / "plain"));
  ASSERT_EQ(plain.code, 0) << plain.err;
  ASSERT_GT(plain.peak_bytes, 1.5 * kCap_bytes) << "nothing to be kept";
  const Outcome capped = terrane(large_run(folder / "capped", {"--memory", "200MB"}));
  ASSERT_EQ(capped.code, 0) << capped.err;
  EXPECT_LT(capped.peak_bytes, kCap_bytes);
  EXPECT_THAT(capped.err, HasSubstr(" in the scratch file"));
  EXPECT_EQ(digests_of(folder / "capped"), digests_of(folder / "plain"));
}

TEST(MemoryCap, GoesOnWithAndWithoutFromWhatTheOtherLeft) {
  const TemporaryFolder folder;
  const auto run = [&](const fs::path& into, const std::string& last,
                       const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run",
                                       "--preset",
                                       "preview",
                                       "--grid",
                                       "256x128",
                                       "--to",
                                       last,
                                       "--no-vtk",
                                       "--no-maps",
                                       "--set",
                                       "erosion.steps=3",
                                       "--set",
                                       "climate.resolution_deg=10",
                                       "--threads",
                                       "2",
                                       "--quiet",
                                       "-o",
                                       into};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = terrane(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  };
  run(folder / "plain", "biomes", {});
  run(folder / "capped", "erosion", {"--memory", "200MB"});
  run(folder / "capped", "climate", {"--resume"});
  run(folder / "capped", "biomes", {"--resume", "--memory", "210MB"});
  EXPECT_EQ(digests_of(folder / "capped"), digests_of(folder / "plain"));
}

TEST(MemoryCap, LeavesNothingInTheScratchFolderWhenKilled) {
#ifdef TERRANE_SANITIZED
  GTEST_SKIP() << "a sanitizer has memory of its own";
#endif
  const TemporaryFolder folder;
  fs::create_directories(folder / "scratch");
  Running running(Call{.arguments = large_run(
                           folder / "out", {"--memory", "200MB", "--scratch", folder / "scratch"}),
                       .environment = {},
                       .working_folder = {}});
  constexpr double kMuch_bytes = 50e6;
  ASSERT_TRUE(running.until([&] {
    return running.bytes_of_deleted_files_in(folder / "scratch") > kMuch_bytes;
  })) << "it was not used";
  EXPECT_TRUE(fs::is_empty(folder / "scratch"));
  running.send(SIGKILL);
  running.finish();
  EXPECT_TRUE(fs::is_empty(folder / "scratch"));
}

TEST(MemoryCap, WithAFullDiskForTheScratchFileIsToldInOneLine) {
#ifdef TERRANE_SANITIZED
  GTEST_SKIP() << "a sanitizer has memory of its own";
#endif
  const TemporaryFolder folder;
  const Outcome outcome =
      terrane(Call{.arguments = large_run(folder / "out", {"--memory", "200MB", "--quiet"}),
                   .environment = {},
                   .working_folder = {},
                   .file_size_limit_bytes = 40'000'000});
  expect_refusal(outcome, 4,
                 "the disk is too full for the scratch file of --memory; --scratch DIR");
}

TEST(MemoryCap, WithoutAPlaceForTheScratchFileIsToldInOneLine) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "no folder";
  const Outcome outcome = terrane(
      large_run(folder / "out", {"--memory", "200MB", "--scratch", (folder / "file").string()}));
  expect_refusal(outcome, 4, "no scratch file for --memory");
  expect_refusal(terrane(large_run(folder / "out", {"--scratch", folder / "scratch"})), 2,
                 "--scratch needs --memory");
}

// Pictures, exports and figures of a run that was kept within little memory fit into it too.
TEST(MemoryCap, IsKeptByWhatIsMadeOfARun) {
#ifdef TERRANE_SANITIZED
  GTEST_SKIP() << "a sanitizer has memory of its own";
#endif
  const TemporaryFolder folder;
  const fs::path run = folder / "run";
  ASSERT_EQ(terrane(large_run(run)).code, 0);
  const auto with_and_without = [&](std::vector<std::string> arguments) {
    const Outcome plain = terrane(arguments);
    EXPECT_EQ(plain.code, 0) << plain.err;
    arguments.insert(arguments.end(), {"--memory", "200MB", "--scratch", folder / "scratch"});
    const Outcome capped = terrane(arguments);
    EXPECT_EQ(capped.code, 0) << capped.err;
    EXPECT_LT(capped.peak_bytes, kCap_bytes);
    EXPECT_EQ(capped.out, plain.out);
  };
  with_and_without({"score", run, "--json"});
  const fs::path picture = run / "maps" / "elevation.png", heights = folder / "heights.png";
  with_and_without({"export", run, "--format", "png16", "-o", heights});
  with_and_without({"maps", run});
  const std::string drawn = text_of(picture);
  fs::remove(picture);
  ASSERT_EQ(terrane({"maps", run, "--memory", "200MB"}).code, 0);
  EXPECT_EQ(text_of(picture), drawn);
  for (const char* command : {"maps", "island", "export", "score", "calibrate"}) {
    SCOPED_TRACE(command);
    std::vector<std::string> arguments{command, run, "--memory", "16"};
    if (std::string(command) == "export") arguments.insert(arguments.end(), {"--format", "png16"});
    if (std::string(command) == "calibrate")
      arguments = {command, "--target", "earth", "--memory", "16"};
    expect_refusal(terrane(arguments), 2, "must be a size such as 16GiB or 500MB");
  }
}

TEST(MemoryCap, OfNoSizeOrTooSmallIsRefused) {
  const TemporaryFolder folder;
  for (const char* size :
       {"much", "16", "16G", "-1GB", "1e3GB", "nanGB", "1.2.3GB", "16 GiB", "16GiBs", "GiB"}) {
    SCOPED_TRACE(size);
    const std::string option = std::string("--memory=") + size;
    expect_refusal(terrane(large_run(folder / "out", {option})), 2,
                   "must be a size such as 16GiB or 500MB");
  }
  for (const char* size : {"199MB", "0B", "190MiB", "2000TiB"}) {
    SCOPED_TRACE(size);
    expect_refusal(terrane(large_run(folder / "out", {"--memory", size})), 2, "must be from 200MB");
  }
  EXPECT_FALSE(fs::exists(folder / "out"));
}

/// "memory  about 321 MB" of a dry run, or another line of it.
double predicted_bytes(const std::string& out, const std::string& line = "memory  about ") {
  const auto at = out.find(line);
  return at == std::string::npos ? 0.0 : 1e6 * std::stod(out.substr(at + line.size()));
}

/// `run` may replace what its folder holds.
void expect_predicted_memory(std::vector<std::string> run) {
  const Outcome done = terrane(run);
  ASSERT_EQ(done.code, 0) << done.err;
  run.emplace_back("--dry-run");
  const double predicted = predicted_bytes(terrane(run).out);
  EXPECT_NEAR(done.peak_bytes / predicted, 1.0, 0.15) << predicted;
}

TEST(Memory, IsPredictedWithin15PerCentWithACapAndWithout) {
#ifdef TERRANE_SANITIZED
  GTEST_SKIP() << "a sanitizer has memory of its own";
#endif
  const TemporaryFolder folder;
  for (const char* cap : {"", "250MB"}) {
    SCOPED_TRACE(cap);
    std::vector<std::string> run{"run",  "--preset", "earth",       "--grid",    "2048x1024",
                                 "--to", "isostasy", "--no-vtk",    "--no-maps", "--threads",
                                 "2",    "--quiet",  "--overwrite", "-o",        folder / "out"};
    if (*cap != '\0') run.insert(run.end(), {"--memory", cap});
    expect_predicted_memory(std::move(run));
  }
}

// An island without maps was told to take two fifths more than it did.
TEST(Memory, OfIslandsIsPredictedWithMapsAndWithout) {
#ifdef TERRANE_SANITIZED
  GTEST_SKIP() << "a sanitizer has memory of its own";
#endif
  const TemporaryFolder folder;
  for (const char* maps : {"true", "false"}) {
    SCOPED_TRACE(maps);
    std::vector<std::string> run{"run",
                                 "--preset",
                                 "earth",
                                 "--grid",
                                 "512x256",
                                 "--set",
                                 "erosion.steps=1",
                                 "--set",
                                 std::string("output.maps=") + maps,
                                 "--no-vtk",
                                 "--threads",
                                 "2",
                                 "--quiet",
                                 "--overwrite",
                                 "-o",
                                 folder / "out"};
    expect_predicted_memory(std::move(run));
  }
}

TEST(MemoryCap, ThatHoldsMostOfARunLeavesMoreOfItOutOfTheScratchFile) {
  const TemporaryFolder folder;
  const auto told = [&](const std::vector<std::string>& more) {
    auto run = large_run(folder / "out", {"--dry-run"});
    run.insert(run.end(), more.begin(), more.end());
    return terrane(run).out;
  };
  constexpr double kProgram_bytes = 150e6;
  const double wanted = predicted_bytes(told({}));
  const auto own_share = [&](double of_wanted) {
    const double cap = std::round(1e-6 * of_wanted * wanted);
    const std::string out = told({"--memory", std::to_string(static_cast<int>(cap)) + "MB"});
    const double own = wanted - kProgram_bytes - predicted_bytes(out, "scratch about ");
    return own / (1e6 * cap - kProgram_bytes);
  };
  EXPECT_NEAR(own_share(0.7), 0.4, 0.03);  // of the cap, less what the program takes
  EXPECT_NEAR(own_share(0.8), 0.7, 0.03);
}

/// Seconds from "85 min 26 s on 2 threads" or "30 s on 2 threads".
double told_seconds(const std::string& text) {
  std::istringstream words(text);
  double seconds = 0.0, value = 0.0;
  std::string unit;
  while (words >> value >> unit) {
    EXPECT_THAT(unit, ::testing::AnyOf("s", "min"));
    seconds += unit == "min" ? 60.0 * value : value;
  }
  return seconds;
}

/// How many times as long as without a cap that bites a run to erosion is told to take.
double told_times_as_long(const std::string& grid, const char* cap) {
  const TemporaryFolder folder;
  // A prediction is for the machine as busy as it is: the least of several in turn.
  std::array<double, 2> least_s;
  least_s.fill(std::numeric_limits<double>::infinity());
  const std::array<const char*, 2> caps{"1000GB", cap};
  constexpr int kPredictions = 8;
  for (int time = 0; time < kPredictions; ++time) {
    for (std::size_t k = 0; k < caps.size(); ++k) {
      const std::string line = "time    about ";
      const std::string out =
          terrane({"run", "--grid", grid, "--to", "erosion", "--no-vtk", "--no-maps", "--dry-run",
                   "--memory", caps[k], "-o", folder / "out"})
              .out;
      const auto at = out.find(line);
      EXPECT_NE(at, std::string::npos) << out;
      if (at == std::string::npos) return std::numeric_limits<double>::quiet_NaN();
      least_s[k] = std::min(least_s[k], told_seconds(out.substr(at + line.size())));
    }
  }
  return least_s[1] / least_s[0];
}

// Pages that come back from a scratch file take time: a cap of a third is told half as long again
// where the system holds the file, and longer where the disk has to take what leaves.
TEST(MemoryCap, OfAPartOfWhatARunTakesIsToldToTakeLonger) {
  const double in_cache = told_times_as_long("4096x2048", "310MB");
  EXPECT_GT(in_cache, 1.2);
  EXPECT_LT(in_cache, 1.7);
  const double on_disk = told_times_as_long("32768x16384", "20GB");
  EXPECT_GT(on_disk, 1.2);
  EXPECT_LT(on_disk, 2.5);
}

TEST(MemoryCap, ForAGridThatNoMachineHoldsIsPredicted) {
  const TemporaryFolder folder;
  const Outcome outcome =
      terrane({"run", "--grid", "32768x16384", "--to", "erosion", "--no-vtk", "--no-maps",
               "--dry-run", "--memory", "2GiB", "-o", folder / "out"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("memory  about 2.1 GB\n"));
  EXPECT_THAT(outcome.out, HasSubstr("\nscratch about "));
  EXPECT_FALSE(fs::exists(folder / "out"));
}

}  // namespace
}  // namespace geo
