#include "geo/io/run/manifest.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "geo/core/error.hpp"
#include "io/files/vouched_bytes.hpp"
#include "io/sample_snapshot.hpp"
#include "io/temporary_folder.hpp"

namespace geo::io {
namespace {

TEST(Digest, IsXxh3Of128Bits) {
  // The published digest of no bytes at all (xxHash test vectors).
  EXPECT_EQ(digest_of(""), "99aa06d3014798d86001c324468d497f");
  const Values values = std::vector<float>{1.0F, 2.0F};
  const Values other = std::vector<float>{1.0F, std::nextafter(2.0F, 3.0F)};
  EXPECT_NE(digest_of(values), digest_of(other));
}

TEST(Digest, TellsZeroesApart) {
  EXPECT_NE(digest_of(Values(std::vector<float>{0.0F})),
            digest_of(Values(std::vector<float>{-0.0F})));
}

TEST(FieldRecord, MeanIsWeightedByAreaAndMissingCellsAreLeftOut) {
  const Grid grid = Grid::sphere(8, 4);
  std::vector<float> values(grid.size(), std::numeric_limits<float>::quiet_NaN());
  values[grid.cell(0, 0)] = 10.0F;
  values[grid.cell(0, 2)] = -30.0F;
  const FieldRecord summary = summarise(field::elevation, Values(values), grid);
  const double polar = grid.area_m2(0), other = grid.area_m2(2);
  EXPECT_EQ(summary.min, -30.0);
  EXPECT_EQ(summary.max, 10.0);
  EXPECT_NEAR(summary.mean, (10.0 * polar - 30.0 * other) / (polar + other), 1e-12);
  EXPECT_EQ(summary.missing, grid.size() - 2);
}

TEST(FieldRecord, MissingFlagsAreLeftOut) {
  const Grid grid = Grid::sphere(8, 4);
  std::vector<std::int8_t> values(grid.size(), 3);
  values[0] = -1;
  const FieldRecord summary = summarise(field::biome, Values(values), grid);
  EXPECT_EQ(summary.min, 3.0);
  EXPECT_DOUBLE_EQ(summary.mean, 3.0);
  EXPECT_EQ(summary.missing, 1);
}

TEST(FieldRecord, SameBitsForAnyNumberOfThreads) {
  const Grid grid = Grid::sphere(256, 128);
  const Values values = sample_values(field::wind_east, grid.size(), 5);
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const double one = summarise(field::wind_east, values, grid).mean;
  omp_set_num_threads(4);
  const double four = summarise(field::wind_east, values, grid).mean;
  omp_set_num_threads(before);
  EXPECT_EQ(one, four);
}

Manifest sample_manifest(const Snapshot& snapshot) {
  Manifest manifest{"0.1.0",
                    "abc",
                    "g++ 12",
                    "0123456789abcdef",
                    library_versions(),
                    18446744073709551615ULL,
                    2,
                    digest_of("seed = 1"),
                    {},
                    false};
  StageRecord stage{"sample",
                    1.25,
                    {{"rock_eroded_m3", 1.0 / 3.0}},
                    {{1, "impact", "Tunnel", {{"rim_m", 12.5}}},
                     {2, "rift", "", {{"depth_m", 900.0}}, {{1.5, -3.0}, {2.0, 7.0}}}},
                    {"a \"warning\""},
                    {"01-sample.nc", "01-sample.vti"},
                    {}};
  for (const auto& [spec, values] : snapshot.fields) {
    stage.fields.push_back(summarise(*spec, *values, *snapshot.grid));
  }
  manifest.stages.push_back(stage);
  return manifest;
}

TEST(Manifest, RoundTripKeepsEverything) {
  const TemporaryFolder folder;
  const Manifest written = sample_manifest(sample_snapshot(Grid::sphere(16, 8)));
  write_manifest(folder / "manifest.json", written);
  const Manifest read = read_manifest(folder / "manifest.json");
  EXPECT_EQ(read.seed, written.seed);
  EXPECT_EQ(read.libraries, written.libraries);
  EXPECT_EQ(read.config_digest, written.config_digest);
  EXPECT_EQ(read.complete, written.complete);
  ASSERT_EQ(read.stages.size(), 1U);
  EXPECT_EQ(read.stages[0].budget, written.stages[0].budget);
  EXPECT_EQ(read.stages[0].warnings, written.stages[0].warnings);
  ASSERT_EQ(read.stages[0].events.size(), 2U);
  EXPECT_EQ(read.stages[0].events[0].figures, written.stages[0].events[0].figures);
  EXPECT_EQ(read.stages[0].events[0].name, "Tunnel");
  EXPECT_EQ(read.stages[0].events[1].number, 2);
  ASSERT_EQ(read.stages[0].events[1].path.size(), 2U);
  EXPECT_EQ(read.stages[0].events[1].path[1].longitude_deg, 7.0);
  EXPECT_EQ(read.stages[0].files, written.stages[0].files);
  ASSERT_EQ(read.stages[0].fields.size(), written.stages[0].fields.size());
  EXPECT_EQ(read.stages[0].fields[3].mean, written.stages[0].fields[3].mean);
}

TEST(Manifest, AgreesWithItsFileAndNotWithAnother) {
  const TemporaryFolder folder;
  const Snapshot snapshot = sample_snapshot(Grid::sphere(16, 8));
  write_netcdf(folder / "a.nc", snapshot, sample_provenance());
  const StageRecord record = sample_manifest(snapshot).stages[0];
  EXPECT_EQ(disagreement(record, read_netcdf(folder / "a.nc")), "");
  Snapshot other = sample_snapshot(Grid::sphere(16, 8), 2);
  const std::string first(other.fields.front().first->name);
  EXPECT_EQ(disagreement(record, other), first + ": digest differs");
  other.fields.erase(other.fields.begin());
  EXPECT_EQ(disagreement(record, other), first + ": missing in the file");
}

TEST(Manifest, UnreadableOnesAreNamed) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_manifest(folder / "none.json"), IoError);
  for (const char* text : {"", "{", "{\"version\": 3}", "[]"}) {
    std::ofstream(folder / "bad.json") << text;
    EXPECT_THROW(read_manifest(folder / "bad.json"), InputError) << text;
  }
}

TEST(Manifest, NumbersThatDoNotFitAreRefused) {
  const TemporaryFolder folder;
  write_manifest(folder / "manifest.json", {});
  std::stringstream sound;
  sound << std::ifstream(folder / "manifest.json").rdbuf();
  for (const char* threads : {"6.6e92", "2.5", "99999999999", "-99999999999", "\"1\"", "null"}) {
    std::string text = sound.str();
    const auto at = text.find("\"threads\": 1");
    ASSERT_NE(at, std::string::npos);
    text.replace(at, 12, std::string("\"threads\": ") + threads);
    std::ofstream(folder / "bad.json") << text;
    EXPECT_THROW(read_manifest(folder / "bad.json"), InputError) << threads;
  }
}

TEST(Manifest, DigestsOfFilesTellWhetherTheirBytesAreAsWritten) {
  const TemporaryFolder folder;
  const auto path = folder / "04-climate.nc";
  std::ofstream(path) << std::string(3'000'000, 'a');
  EXPECT_FALSE(is_as_recorded(path)) << "nothing says what it should be";
  Manifest manifest;
  manifest.stages.emplace_back().name = "climate";
  manifest.stages[0].list(folder.path(), "04-climate.nc");
  write_manifest(folder / "manifest.json", manifest);
  const Manifest read = read_manifest(folder / "manifest.json");
  EXPECT_EQ(read.stages[0].files, std::vector<std::string>{"04-climate.nc"});
  EXPECT_EQ(read.stages[0].file_digests, manifest.stages[0].file_digests);
  EXPECT_EQ(read.stages[0].file_digests.at("04-climate.nc"),
            digest_of(std::string(3'000'000, 'a')));
  std::ofstream(path, std::ios::app) << "";
  std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now());
  EXPECT_TRUE(is_as_recorded(path));
  std::fstream(path, std::ios::in | std::ios::out).seekp(2'000'000) << 'b';
  EXPECT_FALSE(is_as_recorded(path)) << "one byte is another";
}

}  // namespace
}  // namespace geo::io
