// Whatever ends a run: what is there is whole, and --resume goes on to the same bits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netcdf.h>

#include <csignal>
#include <fstream>

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

/// Every file that carries a final name can be read to its end.
void expect_whole_files(const fs::path& folder) {
  for (const auto& [name, bytes] : contents_of(folder)) {
    if (fs::path(name).filename().string().starts_with('.')) continue;
    SCOPED_TRACE(name);
    const auto extension = fs::path(name).extension();
    if (extension == ".nc") {
      EXPECT_EQ(terrane({"info", folder / name}).code, 0);
    } else if (extension == ".vti" || extension == ".pvd") {
      EXPECT_THAT(bytes, testing::EndsWith("</VTKFile>\n"));
    } else if (extension == ".json") {
      EXPECT_TRUE(nlohmann::json::accept(bytes));
    } else if (extension == ".png") {
      EXPECT_THAT(bytes, HasSubstr("IEND"));
    }
  }
}

bool has_temporary_files(const fs::path& folder) {
  for (const auto& [name, bytes] : contents_of(folder)) {
    if (name.ends_with(".tmp")) return true;
  }
  return false;
}

class Interruption : public testing::Test {
 protected:
  void SetUp() override {
    // Large enough for each stage to take a moment in which it can be hit.
    ReliefFile{.nx = 128, .ny = 64}.write(relief_);
    const Outcome outcome = terrane(run_into(straight_));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    ASSERT_GE(stages_of(straight_).size(), 3U);
  }

  [[nodiscard]] std::vector<std::string> run_into(const fs::path& folder) const {
    return quick_run(relief_, folder, {"--set", "erosion.steps=20"});
  }

  void expect_resumed_like_straight(const fs::path& folder) const {
    const Outcome outcome = terrane({"run", "--resume", "-o", folder});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(digests_of(folder), digests_of(straight_));
    EXPECT_TRUE(manifest_of(folder).at("complete").get<bool>());
    EXPECT_FALSE(has_temporary_files(folder));
    const auto names = [](const std::map<std::string, std::string>& files) {
      std::vector<std::string> keys;
      for (const auto& [name, bytes] : files) keys.push_back(name);
      return keys;
    };
    EXPECT_EQ(names(contents_of(folder)), names(contents_of(straight_)));
  }

  TemporaryFolder folder_;
  const fs::path relief_ = folder_ / "relief.nc", straight_ = folder_ / "straight";
};

TEST_F(Interruption, KilledAnywhereAndResumedGivesTheSameBits) {
  // Moments that show in the folder: before the first file, each file when it appears or grows.
  std::vector<std::string> moments{"manifest.json", "config.toml"};
  for (const auto& [name, bytes] : contents_of(straight_)) {
    if (name.ends_with(".nc") || name.ends_with(".vti")) moments.push_back(name);
  }
  int hits = 0;
  for (const std::string& moment : moments) {
    for (const bool half_written : {false, true}) {
      SCOPED_TRACE(moment + (half_written ? " while it is written" : " when it is there"));
      const fs::path folder = folder_ / "killed";
      fs::remove_all(folder);
      Running running(Call{.arguments = run_into(folder), .environment = {}, .working_folder = {}});
      hits += running.until([&] {
        if (!half_written) return fs::exists(folder / moment);
        std::error_code gone;
        for (const auto& entry : fs::directory_iterator(folder, gone)) {
          if (entry.path().filename().string().starts_with("." + moment)) return true;
        }
        return false;
      });
      running.send(SIGKILL);
      running.finish();
      if (!fs::exists(folder / "config.toml")) {
        EXPECT_NE(terrane({"run", "--resume", "-o", folder}).code, 0);
        continue;
      }
      expect_whole_files(folder);
      expect_resumed_like_straight(folder);
    }
  }
  EXPECT_GT(hits, static_cast<int>(moments.size())) << "most runs ended before they were hit";
}

TEST(InterruptedFrames, LeaveNothingHalfWrittenOnceResumed) {
  const TemporaryFolder folder;
  const fs::path out = folder / "out";
  const Outcome outcome =
      terrane({"run", "--preset", "sphere", "--grid", "32x16", "--to", "plates", "--no-maps",
               "--set", "plates.sphere.samples=2000", "--set", "plates.sphere.time_myr=20", "--set",
               "plates.sphere.frames_myr=10", "--quiet", "-o", out});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  // As kills leave them.
  for (const char* name : {".01-plates.nc.1.tmp", "frames/.plates-0010.00.nc.1.tmp"}) {
    std::ofstream(out / name) << "half";
  }
  const Outcome resumed = terrane({"run", "--resume", "--quiet", "-o", out});
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_FALSE(has_temporary_files(out));
}

TEST_F(Interruption, EndingAfterEachStageAndResumingGivesTheSameBits) {
  for (const std::string& stage : stages_of(straight_)) {
    SCOPED_TRACE(stage);
    const fs::path folder = folder_ / stage;
    std::vector<std::string> arguments = run_into(folder);
    arguments.insert(arguments.end(), {"--to", stage});
    ASSERT_EQ(terrane(arguments).code, 0);
    EXPECT_EQ(stages_of(folder).back(), stage);
    expect_resumed_like_straight(folder);
  }
}

TEST_F(Interruption, SignalFinishesTheFileAtHandAndEndsWith130) {
  int hits = 0;
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
    for (const std::string& stage : stages_of(straight_)) {
      SCOPED_TRACE(stage + ", signal " + std::to_string(signal_number));
      const fs::path folder = folder_ / "interrupted";
      fs::remove_all(folder);
      Running running(Call{.arguments = run_into(folder), .environment = {}, .working_folder = {}});
      // The stage is told when it is computed: its files are being written now.
      running.until([&] { return running.err_so_far().find(stage) != std::string::npos; });
      running.send(signal_number);
      const Outcome outcome = running.finish();
      EXPECT_FALSE(has_temporary_files(folder));
      expect_whole_files(folder);
      if (outcome.code != 0) {
        ++hits;
        EXPECT_EQ(outcome.code, 130);
        EXPECT_THAT(lines_of(outcome.err).back(), StartsWith("terrane: error: interrupted"));
        EXPECT_THAT(lines_of(outcome.err).back(), HasSubstr("--resume -o " + folder.string()));
        EXPECT_FALSE(manifest_of(folder).at("complete").get<bool>());
      }
      expect_resumed_like_straight(folder);
    }
  }
  EXPECT_GT(hits, 0) << "every run ended before its signal";
}

TEST_F(Interruption, SignalDuringAStageStopsIt) {
  const fs::path folder = folder_ / "long";
  std::vector<std::string> arguments = run_into(folder);
  arguments.insert(arguments.end(), {"--set", "erosion.steps=1000000"});
  Running running(Call{.arguments = arguments, .environment = {}, .working_folder = {}});
  ASSERT_TRUE(running.until([&] { return fs::exists(folder / "config.toml"); }));
  running.send(SIGINT);
  const Outcome outcome = running.finish();
  EXPECT_EQ(outcome.code, 130);
  EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
  EXPECT_FALSE(has_temporary_files(folder));
  EXPECT_TRUE(stages_of(folder).empty());
}

TEST_F(Interruption, SecondRunKeepsOutOfTheFolderOfTheFirst) {
  const fs::path folder = folder_ / "shared";
  std::vector<std::string> arguments = run_into(folder);
  arguments.insert(arguments.end(), {"--set", "erosion.steps=1000000"});
  Running first(Call{.arguments = arguments, .environment = {}, .working_folder = {}});
  ASSERT_TRUE(first.until([&] { return fs::exists(folder / "config.toml"); }));
  arguments.emplace_back("--overwrite");
  const Outcome second = terrane(arguments);
  EXPECT_EQ(second.code, 4);
  EXPECT_THAT(second.err, HasSubstr("another run is at work in this folder"));
  first.send(SIGKILL);
  first.finish();
  arguments.insert(arguments.end(), {"--set", "erosion.steps=1"});
  EXPECT_EQ(terrane(arguments).code, 0);
}

TEST_F(Interruption, DamagedStageIsComputedAgain) {
  for (const std::string damage : {"cut", "gone"}) {
    SCOPED_TRACE(damage);
    const fs::path folder = folder_ / "damaged";
    fs::remove_all(folder);
    fs::copy(straight_, folder, fs::copy_options::recursive);
    const fs::path file = folder / "04-climate.nc";
    if (damage == "cut") fs::resize_file(file, fs::file_size(file) / 2);
    if (damage == "gone") fs::remove(file);
    expect_resumed_like_straight(folder);
    EXPECT_EQ(text_of(folder / "03-erosion.nc"), text_of(straight_ / "03-erosion.nc"));
  }
}

// Somebody's work, perhaps: it is not thrown away unasked.
TEST_F(Interruption, ChangedStageIsRefusedUntilItIsTakenAway) {
  const fs::path folder = folder_ / "changed", file = folder / "04-climate.nc";
  fs::copy(straight_, folder, fs::copy_options::recursive);
  int id = 0, variable = 0;
  const std::size_t cell[2] = {3, 4};
  const float other = -77.0F;
  ASSERT_EQ(nc_open(file.c_str(), NC_WRITE, &id), NC_NOERR);
  ASSERT_EQ(nc_inq_varid(id, "temperature", &variable), NC_NOERR);
  ASSERT_EQ(nc_put_var1_float(id, variable, cell, &other), NC_NOERR);
  ASSERT_EQ(nc_close(id), NC_NOERR);
  const auto before = contents_of(folder);
  const Outcome refused = terrane({"run", "--resume", "-o", folder});
  EXPECT_EQ(refused.code, 3);
  ASSERT_EQ(lines_of(refused.err).size(), 1U) << refused.err;
  EXPECT_THAT(refused.err, HasSubstr("04-climate.nc"));
  EXPECT_THAT(refused.err, HasSubstr("temperature: digest differs"));
  EXPECT_TRUE(before == contents_of(folder)) << "files were touched";
  fs::remove(file);
  expect_resumed_like_straight(folder);
}

}  // namespace
}  // namespace geo
