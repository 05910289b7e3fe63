// Memory and threads that the system refuses: exit code 2 and one line, never a signal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include "cli/program.hpp"
#include "cli/sample_run.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr long kMegabyte = 1000000;

Outcome with_memory(std::vector<std::string> arguments, long bytes) {
  return terrane({.arguments = std::move(arguments),
                  .environment = {},
                  .working_folder = {},
                  .address_space_limit_bytes = bytes});
}

/// The least address space in which the program begins at all: below it the loader ends it.
long least_to_begin() {
  long too_little = 0, enough = 4000 * kMegabyte;
  while (enough - too_little > kMegabyte) {
    const long between = (too_little + enough) / 2;
    (with_memory({"presets"}, between).code == 0 ? enough : too_little) = between;
  }
  return enough;
}

/// The most that a run takes.
long most_of(const std::vector<std::string>& arguments) {
  Running running(Call{.arguments = arguments, .environment = {}, .working_folder = {}});
  long most = 0;
  running.until([&] {
    most = std::max(most, running.address_space_bytes());
    return false;
  });
  EXPECT_EQ(running.finish().code, 0);
  return most;
}

void expect_told_or_done(const Outcome& outcome) {
  EXPECT_THAT(outcome.code, AnyOf(0, 2)) << outcome.err;
  if (outcome.code == 0) return;
  const auto lines = lines_of(outcome.err);
  ASSERT_EQ(lines.size(), 1U) << outcome.err;
  EXPECT_THAT(lines.front(), AnyOf(StartsWith("terrane: error: not enough memory: "),
                                   StartsWith("terrane: error: could not begin a thread")));
  EXPECT_THAT(lines.front(), HasSubstr(" MB "));
}

/// Twenty limits from the least with which the program begins to what the run takes.
void expect_told_at_all_limits(const std::vector<std::string>& arguments) {
  const long least = least_to_begin(), most = most_of(arguments);
  ASSERT_GT(most, least + 20 * kMegabyte);
  constexpr int kLevels = 20;
  int told = 0;
  for (int level = 0; level < kLevels; ++level) {
    const long limit = least + level * (most - least) / (kLevels - 1);
    SCOPED_TRACE(std::to_string(limit / kMegabyte) + " MB");
    const Outcome outcome = with_memory(arguments, limit);
    expect_told_or_done(outcome);
    told += outcome.code == 2 ? 1 : 0;
  }
  EXPECT_GT(told, 2) << "no limit was felt";
  EXPECT_EQ(with_memory(arguments, 2 * most).code, 0);
}

/// Sanitizers have a heap of their own and reserve terabytes of address space as the program
/// begins.
class LimitedMemory : public testing::Test {
 protected:
  void SetUp() override {
#ifdef TERRANE_SANITIZED
    GTEST_SKIP() << "a sanitizer has its own heap and begins within no limit of address space";
#endif
  }
};

TEST_F(LimitedMemory, ThatRunsOutInARunIsToldAtTwentyLimits) {
  const TemporaryFolder folder;
  expect_told_at_all_limits({"run", "--preset", "preview", "--grid", "512x256", "--to", "hydrology",
                             "--set", "erosion.steps=5", "--set", "climate.resolution_deg=10",
                             "--threads", "2", "--quiet", "--overwrite", "-o", folder / "out"});
}

TEST_F(LimitedMemory, ThatRunsOutInFilesAndPicturesIsToldAtTwentyLimits) {
  const TemporaryFolder folder;
  const auto written =
      terrane({"run", "--preset", "preview", "--grid", "256x128", "--set", "output.vtk=true",
               "--set", "output.compression=1", "--threads", "2", "--quiet", "-o", folder / "out"});
  ASSERT_EQ(written.code, 0) << written.err;
  expect_told_at_all_limits({"maps", folder / "out", "--width", "2400"});
}

/// Libraries look a function up in the program before they take the C library's. OpenMP allocates
/// its teams aligned, and ends the program with exit code 1 where it is refused.
TEST_F(LimitedMemory, IsAskedForThroughTheProgramAlone) {
  for (const char* name : {"malloc", "calloc", "realloc", "aligned_alloc", "memalign",
                           "posix_memalign", "pthread_create"}) {
    const std::string command =
        std::string("nm -D --defined-only '") + TERRANE_PROGRAM + "' | grep -q ' T " + name + "$'";
    EXPECT_EQ(std::system(command.c_str()), 0) << name;
  }
}

TEST_F(LimitedMemory, ThatASmallGridNeedsIsThere) {
  const TemporaryFolder folder;
  const Outcome outcome = with_memory({"run", "--preset", "preview", "--grid", "32x16", "--no-maps",
                                       "--threads", "1", "--quiet", "-o", folder / "out"},
                                      1500 * kMegabyte);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

TEST_F(LimitedMemory, ForAGridThatNoMachineHoldsIsToldWithItsSize) {
  const TemporaryFolder folder;
  const Outcome outcome = with_memory({"run", "--preset", "preview", "--grid", "16384x8192",
                                       "--threads", "2", "--quiet", "-o", folder / "out"},
                                      2000 * kMegabyte);
  EXPECT_EQ(outcome.code, 2);
  expect_told_or_done(outcome);
  EXPECT_THAT(outcome.err, HasSubstr("MB more were wanted beyond the"));
}

TEST(Memory, BeyondTheMachinesIsRefusedBeforeTheRunBegins) {
  const TemporaryFolder folder;
  // Few files, as a disk that is too small for them would be told first.
  const auto run = [&](const std::string& grid) {
    return terrane({"run", "--grid", grid, "--to", "erosion", "--no-vtk", "--no-maps", "--quiet",
                    "--dry-run", "-o", folder / "out"});
  };
  const Outcome outcome = run("32768x16384");  // no grid may have more cells
  if (outcome.code == 0) GTEST_SKIP() << "this machine holds 92 GB";
  EXPECT_EQ(outcome.code, 2);
  const auto lines = lines_of(outcome.err);
  ASSERT_EQ(lines.size(), 1U) << outcome.err;
  EXPECT_THAT(lines.front(), HasSubstr("a run on 32768 x 16384 cells wants about"));
  EXPECT_THAT(lines.front(), HasSubstr("(--memory "));
  const auto at = lines.front().find("--grid ");
  ASSERT_NE(at, std::string::npos) << lines.front();
  EXPECT_EQ(run(lines.front().substr(at + 7)).code, 0) << "what it says would do does";
}

// A smaller planet was proposed, which would not have helped.
TEST(Memory, BeyondWhatThereIsForAnIslandIsRefusedForItsCells) {
  const TemporaryFolder folder;
  const auto island = [&](const char* side) {
    return terrane(
        {.arguments = {"run", "--preset", "preview", "--grid", "64x32", "--to", "island", "--set",
                       std::string("island.nx=") + side, "--set", std::string("island.ny=") + side,
                       "--no-vtk", "--no-maps", "--quiet", "--dry-run", "-o", folder / "out"},
         .environment = {},
         .working_folder = {},
         .data_limit_bytes = 1000 * kMegabyte});
  };
  const Outcome outcome = island("4096");  // of 3.5 GB
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err,
              HasSubstr("must be an island of fewer cells, island.nx times island.ny"));
  EXPECT_EQ(island("1024").code, 0);
}

TEST(Threads, OfTheEnvironmentAreNoMoreThanTheMachineHas) {
  const TemporaryFolder folder;
  const std::vector<std::string> run{"run",       "--preset", "preview", "--grid",      "32x16",
                                     "--no-maps", "--quiet",  "-o",      folder / "out"};
  const Outcome outcome = terrane(
      {.arguments = run, .environment = {{"OMP_NUM_THREADS", "40000"}}, .working_folder = {}});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto lines = lines_of(outcome.err);
  ASSERT_EQ(lines.size(), 1U) << outcome.err;
  EXPECT_THAT(lines.front(),
              StartsWith("terrane: warning: OMP_NUM_THREADS asks for 40000 threads"));
  EXPECT_LT(manifest_of(folder / "out").at("threads").get<int>(), 40000);
}

TEST(Threads, WaitAsleepUnlessTheUserSaysOtherwise) {
  const TemporaryFolder folder;
  const auto spins = [&](std::vector<std::pair<std::string, std::string>> environment) {
    Running running(Call{.arguments = {"run", "--preset", "preview", "--grid", "64x32", "--set",
                                       "erosion.steps=100000", "--overwrite", "-o", folder / "out"},
                         .environment = std::move(environment),
                         .working_folder = {}});
    EXPECT_TRUE(running.until([&] { return fs::exists(folder / "out/manifest.json"); }));
    std::string seen = running.environment();
    running.send(SIGKILL);
    running.finish();
    fs::remove_all(folder / "out");
    std::replace(seen.begin(), seen.end(), '\0', '\n');
    return "\n" + seen;
  };
  EXPECT_THAT(spins({{"OMP_WAIT_POLICY", ""}, {"GOMP_SPINCOUNT", ""}}),
              HasSubstr("GOMP_SPINCOUNT="));
  EXPECT_THAT(spins({{"OMP_WAIT_POLICY", "active"}}), testing::Not(HasSubstr("\nGOMP_SPINCOUNT=")));
  EXPECT_THAT(spins({{"GOMP_SPINCOUNT", "77"}}), HasSubstr("\nGOMP_SPINCOUNT=77\n"));
}

}  // namespace
}  // namespace geo
