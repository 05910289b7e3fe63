// fields.plates: what one drift leaves begins another one, also behind an export.
#include <gtest/gtest.h>

#include <map>

#include "cli/program.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

using Words = std::vector<std::string>;

std::vector<std::int16_t> plates_in(const std::string& file) {
  const io::Snapshot snapshot = io::read_netcdf(file);
  for (const auto& [spec, values] : snapshot.fields) {
    if (spec->name == "plate_id") return std::get<std::vector<std::int16_t>>(*values);
  }
  ADD_FAILURE() << file << " has no plates";
  return {};
}

/// Share of cells in which two numberings agree, once each plate of `b` is called what most of its
/// cells are in `a`.
double agreement(const std::vector<std::int16_t>& a, const std::vector<std::int16_t>& b) {
  std::map<std::int16_t, std::map<std::int16_t, int>> counts;
  for (std::size_t c = 0; c < a.size(); ++c) ++counts[b[c]][a[c]];
  int same = 0;
  for (const auto& [plate, of] : counts) {
    int most = 0;
    for (const auto& [other, count] : of) most = std::max(most, count);
    same += most;
  }
  return static_cast<double>(same) / static_cast<double>(a.size());
}

TEST(PlatesByNumber, PlatesAndMotionsOfADriftBeginAnotherOne) {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder / name).string(); };
  const auto drift = [&](const char* name, const Words& more) {
    Words words{"run",       "--preset", "sphere", "--grid",
                "128x64",    "--to",     "plates", "--no-vtk",
                "--no-maps", "--quiet",  "--set",  "plates.sphere.samples=10000",
                "-o",        path(name)};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = terrane(words);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  };
  drift("first", {"--set", "plates.sphere.time_myr=40"});
  const Outcome exported = terrane({"export", path("first"), "--stage", "plates", "--field",
                                    "plate_id", "--format", "geotiff", "-o", path("plates.tif")});
  ASSERT_EQ(exported.code, 0) << exported.err;
  const auto first = plates_in(path("first/01-plates.nc"));
  for (const char* numbers : {"first/01-plates.nc:plate_id", "plates.tif"}) {
    drift("second", {"--overwrite", "--set", "plates.sphere.time_myr=0", "--set",
                     "fields.plates=" + path(numbers), "--set",
                     "fields.plate_rotations=" + path("first/01-plates-rotations.csv")});
    EXPECT_GT(agreement(first, plates_in(path("second/01-plates.nc"))), 0.95) << numbers;
  }
}

}  // namespace
}  // namespace geo
