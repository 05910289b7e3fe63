#include "geo/io/netcdf/stage_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netcdf.h>
#include <omp.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <array>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <future>
#include <limits>

#include "geo/core/error.hpp"
#include "geo/io/files/atomic_file.hpp"
#include "io/sample_snapshot.hpp"
#include "io/temporary_folder.hpp"
#include "support/difference_of.hpp"
#include "support/message_of.hpp"
#include "support/text_of.hpp"

namespace geo::io {
namespace {

using test::difference_of;
using test::message_of;
using test::text_of;
using testing::HasSubstr;

std::vector<Grid> all_topologies() {
  return {Grid::sphere(64, 32),
          Grid::sphere(46, 23, {3.3962e6, 0.00589}),
          Grid::window(33, 21, {-7.3, 61.9, 100.1, 245.0}, {6378137.0, 1 / 298.257223563},
                       Edges::closed),
          Grid::plane(30, 17, 30.5, 29.9),
          Grid::plane(31, 18, 100.0, 90.1, Edges::closed, Centre{47.1, -121.7}, {3.4e6, 0.0}),
          Grid::torus(24, 12, 1500.0, 1499.0)};
}

void expect_same_grid(const Grid& a, const Grid& b) {
  ASSERT_EQ(a.nx(), b.nx());
  ASSERT_EQ(a.ny(), b.ny());
  EXPECT_EQ(a.topology(), b.topology());
  EXPECT_EQ(a.edges(), b.edges());
  EXPECT_EQ(a.figure().radius_m, b.figure().radius_m);
  EXPECT_EQ(a.figure().flattening, b.figure().flattening);
  EXPECT_EQ(a.is_latitude_longitude(), b.is_latitude_longitude());
  ASSERT_EQ(a.is_geographic(), b.is_geographic());
  for (int j = 0; j < a.ny(); ++j) {
    ASSERT_EQ(a.area_m2(j), b.area_m2(j)) << "row " << j;
    ASSERT_EQ(a.distances_m(j), b.distances_m(j)) << "row " << j;
    if (a.is_geographic()) {
      ASSERT_EQ(a.latitude_deg(j), b.latitude_deg(j));
    }
  }
  for (int i = 0; i < a.nx(); ++i) ASSERT_EQ(a.unit_vector(i, 3), b.unit_vector(i, 3));
}

TEST(StageFile, RoundTripKeepsEveryBitOnEveryTopology) {
  const TemporaryFolder folder;
  int number = 0;
  for (Grid& grid : all_topologies()) {
    SCOPED_TRACE(number);
    const auto path = folder / (std::to_string(number++) + ".nc");
    const Snapshot written = sample_snapshot(std::move(grid));
    write_netcdf(path, written, sample_provenance());
    const Snapshot read = read_netcdf(path);
    EXPECT_EQ(read.stage, "sample");
    expect_same_grid(*written.grid, *read.grid);
    ASSERT_EQ(read.fields.size(), written.fields.size());
    for (std::size_t k = 0; k < read.fields.size(); ++k) {
      EXPECT_EQ(read.fields[k].first, written.fields[k].first);
      EXPECT_TRUE(same_bits(*read.fields[k].second, *written.fields[k].second))
          << read.fields[k].first->name;
    }
  }
}

TEST(StageFile, RoundTripKeepsValuesAcrossManyChunksAtEveryCompression) {
  const TemporaryFolder folder;
  const Snapshot written = sample_snapshot(Grid::sphere(1030, 515));
  std::uintmax_t larger = std::numeric_limits<std::uintmax_t>::max();
  for (const int compression : {0, 1, 9}) {
    const auto path = folder / "a.nc";
    write_netcdf(path, written, sample_provenance(), compression);
    const Snapshot read = read_netcdf(path);
    ASSERT_EQ(read.fields.size(), written.fields.size());
    for (std::size_t k = 0; k < read.fields.size(); ++k) {
      EXPECT_TRUE(same_bits(*read.fields[k].second, *written.fields[k].second));
    }
    EXPECT_LT(std::filesystem::file_size(path), larger);
    larger = std::filesystem::file_size(path);
  }
}

TEST(StageFile, KeepsProvenance) {
  const TemporaryFolder folder;
  const Provenance written = sample_provenance();
  write_netcdf(folder / "a.nc", sample_snapshot(Grid::sphere(16, 8)), written);
  const Provenance read = read_provenance(folder / "a.nc");
  EXPECT_EQ(read.title, written.title);
  EXPECT_EQ(read.config_toml, written.config_toml);
  EXPECT_EQ(read.seed, written.seed);
  EXPECT_EQ(read.version, written.version);
  EXPECT_EQ(read.history, written.history);
  EXPECT_EQ(read.references, written.references);
}

TEST(StageFile, KeepsTheConfigurationInAVariableAndItsDigestInAnAttribute) {
  const TemporaryFolder folder;
  Provenance written = sample_provenance();
  written.config_toml.append(40'000, '#');
  write_netcdf(folder / "a.nc", sample_snapshot(Grid::sphere(16, 8)), written);
  int id = 0, variable = 0, attributes = 0;
  ASSERT_EQ(nc_open((folder / "a.nc").c_str(), NC_WRITE, &id), NC_NOERR);
  nc_inq_natts(id, &attributes);
  for (int k = 0; k < attributes; ++k) {
    std::array<char, NC_MAX_NAME + 1> name{};
    std::size_t length = 0;
    nc_inq_attname(id, NC_GLOBAL, k, name.data());
    nc_inq_attlen(id, NC_GLOBAL, name.data(), &length);
    EXPECT_LT(length, 200) << name.data() << " fills what every client prints";
  }
  // Another text than that of the digest is refused.
  const char* text = "seed = 8\n";
  ASSERT_EQ(nc_inq_varid(id, "terrane_config", &variable), NC_NOERR);
  ASSERT_EQ(nc_put_var_string(id, variable, &text), NC_NOERR);
  nc_close(id);
  EXPECT_THAT(message_of(ErrorKind::input, [&] { read_provenance(folder / "a.nc"); }),
              HasSubstr("terrane_config"));
}

TEST(StageFile, ReadsTheConfigurationThatOlderFilesHoldAsAnAttribute) {
  const TemporaryFolder folder;
  int id = 0;
  ASSERT_EQ(nc_create((folder / "a.nc").c_str(), NC_NETCDF4, &id), NC_NOERR);
  for (const auto& [name, text] :
       {std::pair{"terrane_config", "seed = 7"}, std::pair{"terrane_seed", "7"},
        std::pair{"terrane_version", "0.1.0"}}) {
    nc_put_att_text(id, NC_GLOBAL, name, std::strlen(text), text);
  }
  nc_close(id);
  EXPECT_EQ(read_provenance(folder / "a.nc").config_toml, "seed = 7");
}

/// A frame of drift with a checkpoint, on many chunks.
Snapshot sample_frame() {
  Snapshot snapshot = sample_snapshot(Grid::sphere(1030, 515));
  snapshot.checkpoint = std::make_shared<const Checkpoint>(Checkpoint{
      12.5,
      {{"plate", std::vector<std::int16_t>{0, 1, 2}}, {"age", std::vector<float>(5000, 3.0F)}}});
  return snapshot;
}

TEST(Frame, LiesOnATimeOfOneEntryInPlainMyrAndReadsBack) {
  const TemporaryFolder folder;
  const Snapshot written = sample_frame();
  write_netcdf(folder / "a.nc", written, sample_provenance());
  const Snapshot read = read_netcdf(folder / "a.nc");
  ASSERT_EQ(read.fields.size(), written.fields.size());
  for (std::size_t k = 0; k < read.fields.size(); ++k) {
    EXPECT_TRUE(same_bits(*read.fields[k].second, *written.fields[k].second));
  }
  const Checkpoint checkpoint = read_checkpoint(folder / "a.nc");
  EXPECT_EQ(checkpoint.time_myr, 12.5);
  EXPECT_EQ(checkpoint.arrays, written.checkpoint->arrays);
  int id = 0, variable = 0, dimensions = 0;
  ASSERT_EQ(nc_open((folder / "a.nc").c_str(), NC_NOWRITE, &id), NC_NOERR);
  nc_inq_varid(id, "elevation", &variable);
  nc_inq_varndims(id, variable, &dimensions);
  EXPECT_EQ(dimensions, 3);
  ASSERT_EQ(nc_inq_varid(id, "drift_time", &variable), NC_NOERR);
  std::array<char, 4> units{};
  nc_get_att_text(id, variable, "units", units.data());
  EXPECT_STREQ(units.data(), "Myr");
  EXPECT_NE(nc_inq_varid(id, "time", &variable), NC_NOERR) << "no calendar goes so far";
  nc_close(id);
}

TEST(Frame, WithOtherArraysThanWereWrittenIsRefused) {
  const TemporaryFolder folder;
  write_netcdf(folder / "a.nc", sample_frame(), sample_provenance());
  int id = 0, group = 0, variable = 0;
  ASSERT_EQ(nc_open((folder / "a.nc").c_str(), NC_WRITE, &id), NC_NOERR);
  nc_inq_ncid(id, "checkpoint", &group);
  nc_inq_varid(group, "plate", &variable);
  const short plates[] = {0, 1, 1};
  ASSERT_EQ(nc_put_var_short(group, variable, plates), NC_NOERR);
  nc_close(id);
  EXPECT_THAT(message_of(ErrorKind::input, [&] { read_checkpoint(folder / "a.nc"); }),
              HasSubstr("damaged"));
}

/// A file that says it holds far more than it does.
void write_huge_claim(const std::filesystem::path& path, std::size_t rows, std::size_t columns) {
  int id = 0, variable = 0;
  std::array<int, 2> dimensions{};
  ASSERT_EQ(nc_create(path.c_str(), NC_NETCDF4, &id), NC_NOERR);
  nc_def_dim(id, "lat", rows, dimensions.data());
  nc_def_dim(id, "lon", columns, dimensions.data() + 1);
  nc_def_var(id, "elevation", NC_FLOAT, 2, dimensions.data(), &variable);
  nc_put_att_text(id, variable, "units", 1, "m");
  for (const auto& [name, text] :
       {std::pair{"terrane_grid", "sphere"}, std::pair{"terrane_stage", "erosion"}}) {
    nc_put_att_text(id, NC_GLOBAL, name, std::strlen(text), text);
  }
  const double radius_m = 6371000.0, flattening = 0.0;
  nc_put_att_double(id, NC_GLOBAL, "terrane_grid_radius_m", NC_DOUBLE, 1, &radius_m);
  nc_put_att_double(id, NC_GLOBAL, "terrane_grid_flattening", NC_DOUBLE, 1, &flattening);
  nc_close(id);
}

TEST(StageFile, SizesAreCheckedBeforeMemoryIsAskedFor) {
  const TemporaryFolder folder;
  write_huge_claim(folder / "a.nc", 20'000, 20'000);
  EXPECT_THAT(message_of(ErrorKind::input, [&] { read_netcdf(folder / "a.nc"); }),
              HasSubstr("claims 400000000 values"));
}

TEST(StageFile, SizesOfGridsAreCheckedThoughNoFieldIsWanted) {
  const TemporaryFolder folder;
  write_huge_claim(folder / "a.nc", 50'000'000, 4);
  const auto none = [](const FieldSpec&) { return false; };
  EXPECT_THAT(message_of(ErrorKind::input, [&] { read_netcdf(folder / "a.nc", none); }),
              HasSubstr("claims 200000000 values"));
  // What is not told by the size of the file is told by its axes.
  write_huge_claim(folder / "b.nc", 4'000'000, 4);
  EXPECT_THAT(message_of(ErrorKind::input, [&] { read_netcdf(folder / "b.nc", none); }),
              HasSubstr("claims 4000004 rows and columns"));
}

TEST(StageFile, SameContentGivesTheSameBytes) {
  const TemporaryFolder folder;
  for (const char* name : {"a.nc", "b.nc"}) {
    write_netcdf(folder / name, sample_snapshot(Grid::sphere(640, 320)), sample_provenance());
  }
  for (const char* name : {"a.vti", "b.vti"}) {
    write_vti(folder / name, sample_snapshot(Grid::sphere(640, 320)), sample_provenance());
  }
  EXPECT_EQ(difference_of(folder / "a.nc", folder / "b.nc"), "");
  EXPECT_EQ(difference_of(folder / "a.vti", folder / "b.vti"), "");
}

TEST(StageFile, HasTheSameBytesWhateverThreadsPackIt) {
  const TemporaryFolder folder;
  for (const int threads : {1, 3, 40}) {
    omp_set_num_threads(threads);
    write_netcdf(folder / fmt::format("{}.nc", threads), sample_snapshot(Grid::sphere(1400, 700)),
                 sample_provenance());
  }
  omp_set_num_threads(omp_get_num_procs());
  EXPECT_EQ(difference_of(folder / "1.nc", folder / "3.nc"), "");
  EXPECT_EQ(difference_of(folder / "1.nc", folder / "40.nc"), "");
}

/// What a read of every variable leaves in memory that held `before`.
std::vector<char> contents(const std::filesystem::path& path, char before) {
  int file = -1, variables = 0;
  EXPECT_EQ(nc_open(path.c_str(), NC_NOWRITE, &file), NC_NOERR);
  EXPECT_EQ(nc_inq_nvars(file, &variables), NC_NOERR);
  std::vector<char> all;
  for (int variable = 0; variable < variables; ++variable) {
    nc_type type = NC_NAT;
    int count = 0;
    std::array<int, NC_MAX_VAR_DIMS> dimensions{};
    std::size_t size = 0;
    nc_inq_var(file, variable, nullptr, &type, &count, dimensions.data(), nullptr);
    if (type == NC_STRING) {  // what is read is where the text lies
      char* text = nullptr;
      EXPECT_EQ(nc_get_var_string(file, variable, &text), NC_NOERR);
      EXPECT_TRUE(text != nullptr && *text != '\0');
      all.insert(all.end(), text, text + std::strlen(text));
      nc_free_string(1, &text);
      continue;
    }
    nc_inq_type(file, type, nullptr, &size);
    for (int k = 0; k < count; ++k) {
      std::size_t length = 0;
      nc_inq_dimlen(file, dimensions[k], &length);
      size *= length;
    }
    std::vector<char> values(size, before);
    EXPECT_EQ(nc_get_var(file, variable, values.data()), NC_NOERR);
    all.insert(all.end(), values.begin(), values.end());
  }
  nc_close(file);
  return all;
}

TEST(StageFile, NoVariableIsLeftWithoutValues) {
  const TemporaryFolder folder;
  for (const Grid& grid : all_topologies()) {
    write_netcdf(folder / "stage.nc", sample_snapshot(grid), sample_provenance());
    EXPECT_TRUE(contents(folder / "stage.nc", '\0') == contents(folder / "stage.nc", '\x5a'));
  }
}

/// Lets no file of this process grow beyond a size, as a full disk would.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

TEST(StageFile, DiskFailureNamesPathAndReasonAndLeavesNothing) {
  const TemporaryFolder folder;
  const Snapshot snapshot = sample_snapshot(Grid::sphere(512, 256));
  const FileSizeLimit limit(200'000);
  testing::internal::CaptureStderr();
  // On another thread, as a run does it: HDF5 keeps an error stack for each.
  const std::string nc = std::async(std::launch::async, [&] {
                           return message_of(ErrorKind::io, [&] {
                             write_netcdf(folder / "a.nc", snapshot, sample_provenance());
                           });
                         }).get();
  const std::string vti = message_of(
      ErrorKind::io, [&] { write_vti(folder / "a.vti", snapshot, sample_provenance()); });
  const std::string text = message_of(
      ErrorKind::io, [&] { write_text_file(folder / "a.txt", std::string(300'000, 'x')); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "libraries must keep quiet";
  EXPECT_THAT(nc, HasSubstr((folder / "a.nc").string()));
  EXPECT_THAT(vti, HasSubstr((folder / "a.vti").string()));
  for (const auto& message : {nc, vti, text}) EXPECT_THAT(message, HasSubstr("File too large"));
  EXPECT_TRUE(folder.is_empty());
}

TEST(StageFile, FailedWriteKeepsTheOldFile) {
  const TemporaryFolder folder;
  write_netcdf(folder / "a.nc", sample_snapshot(Grid::sphere(16, 8)), sample_provenance());
  const std::string before = text_of(folder / "a.nc");
  {
    const FileSizeLimit limit(200'000);
    EXPECT_THROW(
        write_netcdf(folder / "a.nc", sample_snapshot(Grid::sphere(512, 256)), sample_provenance()),
        IoError);
  }
  EXPECT_TRUE(text_of(folder / "a.nc") == before);
}

TEST(StageFile, MissingFolderIsAnIoError) {
  const TemporaryFolder folder;
  const std::string message = message_of(ErrorKind::io, [&] {
    write_netcdf(folder / "none/a.nc", sample_snapshot(Grid::sphere(16, 8)), sample_provenance());
  });
  EXPECT_THAT(message, HasSubstr("none/a.nc"));
  EXPECT_THAT(message, HasSubstr("No such file or directory"));
}

TEST(StageFile, AbsentFileIsAnIoError) {
  const std::string message =
      message_of(ErrorKind::io, [] { read_netcdf("/nowhere/01-erosion.nc"); });
  EXPECT_THAT(message, HasSubstr("/nowhere/01-erosion.nc"));
  EXPECT_THAT(message, HasSubstr("No such file"));
}

TEST(StageFile, TruncatedFileIsAnInputErrorAtAnyLength) {
  const TemporaryFolder folder;
  write_netcdf(folder / "a.nc", sample_snapshot(Grid::sphere(512, 256)), sample_provenance());
  const std::string whole = text_of(folder / "a.nc");
  testing::internal::CaptureStderr();
  for (const double share : {0.0, 0.001, 0.1, 0.5, 0.9, 0.9999}) {
    SCOPED_TRACE(share);
    std::ofstream(folder / "cut.nc", std::ios::binary)
        << whole.substr(0, static_cast<std::size_t>(share * whole.size()));
    const std::string message =
        message_of(ErrorKind::input, [&] { read_netcdf(folder / "cut.nc"); });
    EXPECT_THAT(message, HasSubstr((folder / "cut.nc").string()));
    EXPECT_THAT(message, HasSubstr("truncated"));
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(StageFile, DamagedValuesAreAnInputError) {
  const TemporaryFolder folder;
  write_netcdf(folder / "a.nc", sample_snapshot(Grid::sphere(512, 256)), sample_provenance());
  std::string bytes = text_of(folder / "a.nc");
  // Compressed streams fill most of the file: no stretch of this length escapes them.
  for (std::size_t k = bytes.size() / 2; k < bytes.size() / 2 + 60'000; ++k) bytes[k] = '\0';
  std::ofstream(folder / "bad.nc", std::ios::binary) << bytes;
  const std::string message = message_of(ErrorKind::input, [&] { read_netcdf(folder / "bad.nc"); });
  EXPECT_THAT(message, HasSubstr("variable "));
}

TEST(StageFile, ForeignFileIsAnInputErrorThatNamesWhatIsMissing) {
  const TemporaryFolder folder;
  int id = 0;
  ASSERT_EQ(nc_create((folder / "a.nc").c_str(), NC_NETCDF4, &id), NC_NOERR);
  nc_close(id);
  const std::string message = message_of(ErrorKind::input, [&] { read_netcdf(folder / "a.nc"); });
  EXPECT_THAT(message, HasSubstr("not a stage file"));
  EXPECT_THAT(message, HasSubstr("terrane_grid"));
}

TEST(StageFile, OtherUnitsAreAnInputErrorThatNamesTheVariable) {
  const TemporaryFolder folder;
  write_netcdf(folder / "a.nc", sample_snapshot(Grid::sphere(16, 8)), sample_provenance());
  int id = 0, variable = 0;
  ASSERT_EQ(nc_open((folder / "a.nc").c_str(), NC_WRITE, &id), NC_NOERR);
  nc_inq_varid(id, "temperature", &variable);
  nc_put_att_text(id, variable, "units", 1, "K");
  nc_close(id);
  const std::string message = message_of(ErrorKind::input, [&] { read_netcdf(folder / "a.nc"); });
  EXPECT_THAT(message, HasSubstr("temperature"));
  EXPECT_THAT(message, HasSubstr("degC"));
}

TEST(StageFile, CollectionEscapesNamesAndKeepsOrder) {
  const TemporaryFolder folder;
  write_pvd(folder / "planet.pvd", {folder / "01 <a>&\"b\".vti", folder / "02-climate.vti"});
  const std::string text = text_of(folder / "planet.pvd");
  EXPECT_THAT(text, HasSubstr("file=\"01 &lt;a&gt;&amp;&quot;b&quot;.vti\""));
  EXPECT_LT(text.find("01 "), text.find("02-climate"));
}

TEST(AtomicFile, LeftoversOfKilledRunsCanBeRemoved) {
  const TemporaryFolder folder;
  std::ofstream(folder / ".01-erosion.nc.4242.tmp") << "half";
  std::ofstream(folder / "02-climate.nc") << "whole";
  remove_leftovers(folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder / ".01-erosion.nc.4242.tmp"));
  EXPECT_TRUE(std::filesystem::exists(folder / "02-climate.nc"));
}

}  // namespace
}  // namespace geo::io
