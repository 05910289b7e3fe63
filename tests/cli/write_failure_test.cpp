// A disk that is full or forbidden: exit code 4, one line, nothing half-written under a final name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

#include <algorithm>
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

void expect_refusal(const Outcome& outcome, const std::string& where, const std::string& why) {
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  const auto lines = lines_of(outcome.err);
  ASSERT_FALSE(lines.empty());
  EXPECT_THAT(lines.back(), StartsWith("terrane: error: "));
  EXPECT_THAT(lines.back(), HasSubstr(where));
  EXPECT_THAT(lines.back(), HasSubstr(why));
}

void expect_no_temporary_files(const fs::path& folder) {
  for (const auto& [name, bytes] : contents_of(folder)) {
    EXPECT_THAT(name, testing::Not(HasSubstr(".tmp")));
  }
}

/// A small disk of one's own, where the system lets us have one.
class SmallDisk {
 public:
  SmallDisk(fs::path path, const std::string& options) : path_(std::move(path)) {
    fs::create_directories(path_);
    there_ = ::mount("terrane-test", path_.c_str(), "tmpfs", 0, options.c_str()) == 0;
  }
  ~SmallDisk() {
    if (there_) ::umount2(path_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  [[nodiscard]] bool is_there() const { return there_; }

 private:
  fs::path path_;
  bool there_ = false;
};

TEST(WriteFailure, DiskWithoutRoomIsRefusedBeforeTheRun) {
  const TemporaryFolder folder;
  ReliefFile{}.write(folder / "relief.nc");
  const SmallDisk disk(folder / "disk", "size=64k");
  if (!disk.is_there()) GTEST_SKIP() << "may not mount a small disk here";
  const Outcome outcome = terrane(quick_run(folder / "relief.nc", folder / "disk/out"));
  expect_refusal(outcome, "disk/out", "not enough room on the disk");
  EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
  EXPECT_TRUE(contents_of(folder / "disk").empty());
}

TEST(WriteFailure, DiskThatFillsUpDuringTheRunIsToldAndTheRunGoesOnLater) {
  const TemporaryFolder folder;
  ReliefFile{}.write(folder / "relief.nc");
  // Room for bytes, but after folder, configuration and manifest only for the first files.
  const SmallDisk disk(folder / "disk", "nr_inodes=6");
  if (!disk.is_there()) GTEST_SKIP() << "may not mount a small disk here";
  const Outcome outcome = terrane(quick_run(folder / "relief.nc", folder / "disk/out"));
  expect_refusal(outcome, "cannot write ", "No space left on device");
  expect_no_temporary_files(folder / "disk");

  fs::copy(folder / "disk/out", folder / "out");
  const Outcome resumed = terrane({"run", "--resume", "-o", folder / "out"});
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  terrane(quick_run(folder / "relief.nc", folder / "straight"));
  EXPECT_EQ(digests_of(folder / "out"), digests_of(folder / "straight"));
}

TEST(WriteFailure, FileSizeLimitIsTold) {
  const TemporaryFolder folder;
  ReliefFile{}.write(folder / "relief.nc");
  // The configuration fits, a stage does not.
  for (const long limit_bytes : {12000L, 30000L, 60000L}) {
    SCOPED_TRACE(limit_bytes);
    const Outcome outcome =
        terrane({.arguments = quick_run(folder / "relief.nc", folder / "out", {"--overwrite"}),
                 .environment = {},
                 .working_folder = {},
                 .file_size_limit_bytes = limit_bytes});
    expect_refusal(outcome, "cannot write ", "File too large");
    expect_no_temporary_files(folder / "out");
  }
}

TEST(WriteFailure, APlanetFromItsSeedTellsItToo) {
  const TemporaryFolder folder;
  const Outcome outcome =
      terrane({.arguments = {"run", "--preset", "preview", "--grid", "64x32", "-o", folder / "out"},
               .environment = {},
               .working_folder = {},
               .file_size_limit_bytes = 60000L});
  expect_refusal(outcome, "cannot write ", "File too large");
  expect_no_temporary_files(folder / "out");
}

// The library that writes pictures has a word of its own on standard error unless it is kept from
// it.
TEST(WriteFailure, PicturesTellItInOneLine) {
  const TemporaryFolder folder;
  ReliefFile{}.write(folder / "relief.nc");
  ASSERT_EQ(terrane(quick_run(folder / "relief.nc", folder / "out")).code, 0);
  const Outcome outcome = terrane({.arguments = {"maps", folder / "out"},
                                   .environment = {},
                                   .working_folder = {},
                                   .file_size_limit_bytes = 20000L});
  EXPECT_EQ(outcome.code, 4);
  const auto lines = lines_of(outcome.err);
  EXPECT_EQ(std::count_if(lines.begin(), lines.end(),
                          [](const auto& line) { return line.find("rror") != line.npos; }),
            1)
      << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(".png: File too large"));
  expect_no_temporary_files(folder / "out");
}

TEST(WriteFailure, FullStandardOutputIsTold) {
  const TemporaryFolder folder;
  const std::string command =
      std::string(TERRANE_PROGRAM) + " params > /dev/full 2> " + (folder / "err").string();
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 4);
  EXPECT_THAT(text_of(folder / "err"), HasSubstr("standard output"));
}

/// Calls as nobody, in folders whose rights the test sets.
class Forbidden : public testing::Test {
 protected:
  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "only root can act for another user";
    ReliefFile{}.write(folder_ / "relief.nc");
    fs::permissions(folder_.path(), fs::perms(0755));
    fs::permissions(folder_ / "relief.nc", fs::perms(0644));
    const Call version{.arguments = {"--version"},
                       .environment = {},
                       .working_folder = folder_.path(),
                       .as_nobody = true};
    if (terrane(version).code != 0) GTEST_SKIP() << "nobody may not start " << TERRANE_PROGRAM;
  }

  Outcome as_nobody(std::vector<std::string> arguments) {
    const auto before = contents_of(folder_.path());
    Outcome outcome = terrane({.arguments = std::move(arguments),
                               .environment = {},
                               .working_folder = folder_.path(),
                               .as_nobody = true});
    EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
    EXPECT_TRUE(before == contents_of(folder_.path())) << "files were touched";
    return outcome;
  }

  void make(const std::string& name, int mode) {
    fs::create_directory(folder_ / name);
    fs::permissions(folder_ / name, fs::perms(mode));
  }

  TemporaryFolder folder_;
};

TEST_F(Forbidden, FolderThatMayNotBeWritten) {
  make("out", 0555);
  expect_refusal(as_nobody(quick_run("relief.nc", "out")), "out", "Permission denied");
}

TEST_F(Forbidden, FolderInAFolderThatMayNotBeWritten) {
  make("locked", 0555);
  expect_refusal(as_nobody(quick_run("relief.nc", "locked/a/b")), "locked", "Permission denied");
}

TEST_F(Forbidden, FolderThatMayNotBeEntered) {
  make("locked", 0700);
  expect_refusal(as_nobody(quick_run("relief.nc", "locked/out")), "locked", "Permission denied");
  expect_refusal(as_nobody(quick_run("relief.nc", "locked")), "locked", "Permission denied");
  expect_refusal(as_nobody({"run", "--resume", "-o", "locked/out"}), "locked", "Permission denied");
  expect_refusal(as_nobody({"maps", "locked/out"}), "locked", "Permission denied");
}

TEST_F(Forbidden, ReliefThatMayNotBeRead) {
  fs::permissions(folder_ / "relief.nc", fs::perms(0600));
  expect_refusal(as_nobody(quick_run("relief.nc", "/tmp/terrane-never")), "relief.nc",
                 "Permission denied");
  make("locked", 0700);
  expect_refusal(as_nobody(quick_run("locked/relief.nc", "/tmp/terrane-never")), "locked/relief.nc",
                 "Permission denied");
  EXPECT_FALSE(fs::exists("/tmp/terrane-never"));
}

TEST_F(Forbidden, ConfigurationThatMayNotBeRead) {
  make("locked", 0700);
  std::ofstream(folder_ / "locked/planet.toml") << "[run]\nseed = 2\n";
  std::ofstream(folder_ / "planet.toml") << "[run]\nseed = 2\n";
  fs::permissions(folder_ / "planet.toml", fs::perms(0600));
  for (const std::string file : {"planet.toml", "locked/planet.toml"}) {
    expect_refusal(as_nobody(quick_run("relief.nc", "/tmp/terrane-never", {file})), file,
                   "Permission denied");
  }
}

}  // namespace
}  // namespace geo
