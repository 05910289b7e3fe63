// mpirun terrane run: the same planet from several processes, of which each holds a part.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "cli/program.hpp"
#include "cli/sample_run.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

/// All stages of a small planet, or of a part of them.
std::vector<std::string> small_run(const fs::path& folder,
                                   const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"run",       "--preset",
                                     "preview",   "--grid",
                                     "256x128",   "--no-vtk",
                                     "--set",     "erosion.steps=3",
                                     "--set",     "climate.resolution_deg=10",
                                     "--threads", "2",
                                     "-o",        folder};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// Takes 370 MB of memory in one process, 3 s of processor time.
std::vector<std::string> large_run(const fs::path& folder) {
  return {"run",       "--grid",    "2048x1024", "--to", "isostasy", "--no-vtk",
          "--no-maps", "--threads", "2",         "-o",   folder};
}

Call on_ranks(int ranks, std::vector<std::string> arguments) {
  Call call{.arguments = std::move(arguments), .environment = {}, .working_folder = {}};
  call.ranks = ranks;
  return call;
}

std::vector<std::string> errors_of(const Outcome& outcome) {
  std::vector<std::string> errors;
  for (const std::string& line : lines_of(outcome.err)) {
    if (line.find("terrane: error: ") != std::string::npos) errors.push_back(line);
  }
  return errors;
}

class Ranks : public testing::Test {
 protected:
  void SetUp() override {
#ifdef TERRANE_SANITIZED
    GTEST_SKIP() << "a sanitizer has memory of its own";
#endif
    if (!can_start_ranks()) GTEST_SKIP() << "no mpirun here";
  }
};

TEST_F(Ranks, ChangeNoBit) {
  const TemporaryFolder folder;
  const Outcome alone = terrane(small_run(folder / "alone"));
  ASSERT_EQ(alone.code, 0) << alone.err;
  for (const int ranks : {1, 2, 5}) {
    SCOPED_TRACE(ranks);
    const fs::path there = folder / std::to_string(ranks);
    const Outcome shared = terrane(on_ranks(ranks, small_run(there)));
    ASSERT_EQ(shared.code, 0) << shared.err;
    EXPECT_EQ(digests_of(there), digests_of(folder / "alone"));
  }
}

TEST_F(Ranks, ShareThePlanetAmongThem) {
  const TemporaryFolder folder;
  const Outcome alone = terrane(large_run(folder / "alone"));
  ASSERT_EQ(alone.code, 0) << alone.err;
  constexpr int kRanks = 4;
  const Outcome shared = terrane(on_ranks(kRanks, large_run(folder / "shared")));
  ASSERT_EQ(shared.code, 0) << shared.err;
  EXPECT_EQ(digests_of(folder / "shared"), digests_of(folder / "alone"));
  EXPECT_THAT(shared.err, HasSubstr(" shared with the other ranks"));
  EXPECT_LT(shared.peak_bytes, 1.3 * alone.peak_bytes / kRanks + 200e6);
  EXPECT_LT(shared.peak_bytes, alone.peak_bytes);
}

TEST_F(Ranks, GoOnFromWhatOthersLeft) {
  const TemporaryFolder folder;
  ASSERT_EQ(terrane(small_run(folder / "alone")).code, 0);
  const fs::path shared = folder / "shared";
  ASSERT_EQ(terrane(on_ranks(3, small_run(shared, {"--to", "erosion"}))).code, 0);
  ASSERT_EQ(terrane(on_ranks(2, small_run(shared, {"--to", "climate", "--resume"}))).code, 0);
  ASSERT_EQ(terrane(small_run(shared, {"--resume"})).code, 0);
  EXPECT_EQ(digests_of(shared), digests_of(folder / "alone"));
}

TEST_F(Ranks, TellBadInputOnce) {
  const TemporaryFolder folder;
  const Outcome outcome =
      terrane(on_ranks(4, small_run(folder / "out", {"--set", "planet.radius_km=none"})));
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_EQ(errors_of(outcome).size(), 1U) << outcome.err;
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(Ranks, OfWhichOneDiesEndTheJobAndLeaveWhatGoesOn) {
  const TemporaryFolder folder;
  ASSERT_EQ(terrane(small_run(folder / "alone")).code, 0);
  for (const int victim : {0, 1, 2}) {
    SCOPED_TRACE(victim);
    const fs::path there = folder / std::to_string(victim);
    Running running(on_ranks(3, small_run(there)));
    ASSERT_TRUE(running.until([&] { return fs::exists(there / "01-plates.nc"); }));
    ASSERT_TRUE(running.send_to_rank(victim, SIGKILL));
    const auto killed = std::chrono::steady_clock::now();
    const Outcome outcome = running.finish();
    EXPECT_LT(std::chrono::steady_clock::now() - killed, std::chrono::seconds(30));
    EXPECT_NE(outcome.code, 0);
    const auto errors = errors_of(outcome);
    ASSERT_EQ(errors.size(), 1U) << outcome.err;
    EXPECT_THAT(errors.front(), HasSubstr("another of its ranks died"));
    const Outcome rest = victim == 0 ? terrane(small_run(there, {"--resume"}))
                                     : terrane(on_ranks(2, small_run(there, {"--resume"})));
    ASSERT_EQ(rest.code, 0) << rest.err;
    EXPECT_EQ(digests_of(there), digests_of(folder / "alone"));
  }
}

TEST_F(Ranks, SayWhatEachWillTakeAndRefuseTooLittle) {
  const TemporaryFolder folder;
  const auto dry = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run",       "--grid", "4096x2048",
                                       "--dry-run", "-o",     folder / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return terrane(on_ranks(3, arguments));
  };
  const Outcome told = dry({});
  EXPECT_EQ(told.code, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr(" in each of 3 ranks"));
  const Outcome little = dry({"--memory", "250MB"});
  EXPECT_EQ(little.code, 2);
  ASSERT_EQ(errors_of(little).size(), 1U) << little.err;
  EXPECT_THAT(little.err, HasSubstr("--memory 250MB: 3 ranks want about "));
  EXPECT_EQ(dry({"--memory", "2GB"}).code, 0);
  const Outcome scratch = dry({"--memory", "2GB", "--scratch", folder / "scratch"});
  EXPECT_EQ(scratch.code, 2);
  EXPECT_THAT(scratch.err, HasSubstr("several ranks have no scratch file"));
}

}  // namespace
}  // namespace geo
