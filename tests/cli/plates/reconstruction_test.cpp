// Drifts that are driven by a reconstruction of GPlates.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "cli/program.hpp"
#include "geo/io/input/table.hpp"
#include "geo/kernels/plates/plate_motion.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Words = std::vector<std::string>;

Outcome drift(const fs::path& out, const Words& more) {
  Words words{"run",       "--preset",
              "sphere",    "--grid",
              "96x48",     "--to",
              "plates",    "--no-vtk",
              "--no-maps", "--quiet",
              "--set",     "plates.sphere.samples=10000",
              "--set",     "plates.sphere.frames_myr=10",
              "-o",        out.string()};
  words.insert(words.end(), more.begin(), more.end());
  return terrane(words);
}

Words driven_by(const fs::path& gplates, const Words& more = {}) {
  Words words{"--set", "fields.plates=" + (gplates / "plates.geojson").string(), "--set",
              "fields.plate_rotations=" + (gplates / "rotations.rot").string()};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Rotations of plates (rad/Myr) by the beginning of the step and the plate's number.
std::map<std::pair<double, int>, Vector3> turns_in(const fs::path& run) {
  const io::Table table = io::Table::of_file(run / "01-plates-rotations.csv");
  EXPECT_TRUE(table.has_columns({"from_myr", "to_myr", "plate_id", "pole_latitude_deg",
                                 "pole_longitude_deg", "rate_deg_myr"}));
  std::map<std::pair<double, int>, Vector3> turns;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    turns[{table.number(row, 0), static_cast<int>(table.number(row, 2))}] =
        euler_rotation(table.number(row, 3), table.number(row, 4), table.number(row, 5));
  }
  return turns;
}

/// Numbers of the plates that a drift began with.
std::set<int> first_plates(const fs::path& run) {
  const io::Table table = io::Table::of_file(run / "01-plates-lives.csv");
  std::set<int> numbers;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.text(row, 1) == "first") numbers.insert(static_cast<int>(table.number(row, 0)));
  }
  return numbers;
}

nlohmann::json manifest_of(const fs::path& run) {
  std::ifstream in(run / "manifest.json");
  return nlohmann::json::parse(in);
}

class Reconstruction : public testing::Test {
 protected:
  /// A drift in which plates break, and what GPlates gets of it.
  void SetUp() override {
    const Outcome run = drift(
        first_, {"--set", "plates.sphere.time_myr=50", "--set", "plates.sphere.rifts_myr=0.05"});
    ASSERT_EQ(run.code, 0) << run.err;
    const Outcome exported =
        terrane({"export", first_, "--format", "gplates", "-o", gplates_.string()});
    ASSERT_EQ(exported.code, 0) << exported.err;
  }

  TemporaryFolder folder_;
  const fs::path first_ = folder_ / "first", gplates_ = folder_ / "gplates";
};

TEST_F(Reconstruction, OfADriftDrivesAnotherOneAsItMoved) {
  const fs::path second = folder_ / "second";
  const Outcome run = drift(second, driven_by(gplates_, {"--set", "plates.sphere.time_myr=50"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(first_plates(second), first_plates(first_));
  const auto wanted = turns_in(first_), found = turns_in(second);
  // The table has all digits, the rotation file 1e-13 degrees.
  constexpr double kDigits_rad_myr = 1e-12;
  std::size_t compared = 0, all = 0;
  for (const auto& [step_and_plate, rotation] : wanted) {
    if (!first_plates(first_).contains(step_and_plate.second)) continue;
    ++all;
    const auto same = found.find(step_and_plate);
    if (same == found.end()) continue;
    ++compared;
    EXPECT_LT(length(add(rotation, same->second, -1.0)), kDigits_rad_myr)
        << "plate " << step_and_plate.second << " at " << step_and_plate.first << " Myr";
  }
  EXPECT_GT(compared, 9 * all / 10);
}

/// Origin of plates, by what it is.
std::map<std::string, int> origins_in(const fs::path& run) {
  const io::Table table = io::Table::of_file(run / "01-plates-lives.csv");
  std::map<std::string, int> count;
  for (std::size_t row = 0; row < table.rows(); ++row) ++count[table.text(row, 1)];
  return count;
}

TEST_F(Reconstruction, CutsOutPlatesThatAppearLater) {
  const fs::path second = folder_ / "second";
  const Outcome run = drift(second, driven_by(gplates_, {"--set", "plates.sphere.time_myr=50"}));
  ASSERT_EQ(run.code, 0) << run.err;
  ASSERT_GT(origins_in(first_)["rift"], 0);
  EXPECT_GT(origins_in(second)["rift"], 0);
  // Each of them turns at the end as one of the first drift that is no plate of its beginning.
  const auto wanted = turns_in(first_), found = turns_in(second);
  const std::set<int> known = first_plates(first_);
  constexpr double kLastStep_myr = 48.0, kDigits_rad_myr = 1e-12;
  int later = 0;
  for (const auto& [step_and_plate, rotation] : found) {
    if (step_and_plate.first != kLastStep_myr || known.contains(step_and_plate.second)) continue;
    const bool is_known =
        std::any_of(wanted.begin(), wanted.end(), [&, turn = rotation](const auto& other) {
          return other.first.first == kLastStep_myr &&
                 length(add(other.second, turn, -1.0)) < kDigits_rad_myr;
        });
    EXPECT_TRUE(is_known) << "plate " << step_and_plate.second;
    ++later;
  }
  EXPECT_GT(later, 0);
}

TEST_F(Reconstruction, GoesOnFromAFrameAndByAnyNumberOfThreadsAsItWas) {
  const Words more{"--set", "plates.sphere.time_myr=40", "--set", "fields.rotations_age_myr=50"};
  const auto whole = [&](const char* name, const char* threads, Words with = {}) {
    Words words = driven_by(gplates_, more);
    words.insert(words.end(), with.begin(), with.end());
    words.insert(words.end(), {"--threads", threads});
    const Outcome run = drift(folder_ / name, words);
    EXPECT_EQ(run.code, 0) << run.err;
    return text_of(folder_ / name / "01-plates-lives.csv") +
           manifest_of(folder_ / name).at("stages").at(0).at("fields").dump();
  };
  const std::string one = whole("one", "1");
  EXPECT_EQ(whole("three", "3"), one);
  const std::string frame = (folder_ / "one/frames/plates-0020.00.nc").string();
  EXPECT_EQ(whole("again", "1", {"--set", "fields.start_frame=" + frame}), one);
  // Another beginning would be another time of the rotations.
  const Outcome other =
      drift(folder_ / "other", driven_by(gplates_, {"--set", "plates.sphere.time_myr=50", "--set",
                                                    "fields.rotations_age_myr=50.0", "--set",
                                                    "fields.start_frame=" + frame}));
  EXPECT_EQ(other.code, 0) << other.err;
  const Outcome wrong =
      drift(folder_ / "wrong", driven_by(gplates_, {"--set", "plates.sphere.time_myr=40", "--set",
                                                    "fields.start_frame=" + frame}));
  EXPECT_EQ(wrong.code, 3);
  EXPECT_THAT(wrong.err, HasSubstr("fields.rotations_age_myr: the drift of the frame to go on from "
                                   "began at 50 Ma: must be that, not 40"));
}

TEST_F(Reconstruction, IsRefusedInOneLine) {
  const auto refused = [&](int code, const std::string& what, const Words& words) {
    const Outcome run = drift(folder_ / "bad", words);
    EXPECT_EQ(run.code, code) << run.err;
    EXPECT_THAT(run.err, HasSubstr(what));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  };
  const std::string rotations = (gplates_ / "rotations.rot").string();
  refused(3, "must reach over the drift, from 60 to 0 Ma",
          driven_by(gplates_, {"--set", "plates.sphere.time_myr=60"}));
  refused(2, "rotations of GPlates need fields.plates",
          {"--set", "fields.plate_rotations=" + rotations});
  refused(2, "rotations of GPlates need fields.plates",
          {"--set", "fields.plates=earth", "--set", "fields.plate_rotations=" + rotations});
  refused(2, "fields.rotations_age_myr = 50: is for rotations of GPlates",
          {"--set", "fields.rotations_age_myr=50"});
  std::ofstream(gplates_ / "rotations.rot", std::ios::app) << "1001 5 95 0 0 000 !\n";
  const auto lines = std::to_string([&] {
    const std::string text = text_of(gplates_ / "rotations.rot");
    return std::count(text.begin(), text.end(), '\n');
  }());
  refused(3, "rotations.rot:" + lines + ": the latitude is 95",
          driven_by(gplates_, {"--set", "plates.sphere.time_myr=50"}));
}

}  // namespace
}  // namespace geo
