// Exemplars as files hold them, and the cache of those that terrane grows.
#include "geo/io/input/exemplar_files.hpp"

#include <geotiff.h>
#include <geovalues.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netcdf.h>
#include <tiffio.h>
#include <xtiffio.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <set>

#include "geo/core/error.hpp"
#include "io/input/exemplar_cache.hpp"
#include "io/temporary_folder.hpp"

namespace geo::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr int kColumns = 80, kRows = 50;
constexpr double kCell_m = 90.0;
constexpr float kGap = -9999.0F;

/// Ridges that run north-east; row 0 the southernmost.
float height(int column, int row) {
  return std::round(1000.0F + 600.0F * std::sin(0.2F * static_cast<float>(column - row)) +
                    static_cast<float>(row));
}

/// Whether a cell lies in a hole of the files that have one.
bool in_hole(int column, int row) { return column >= 60 && row >= 30; }

struct TiffFile {
  bool whole_numbers = false, tiled = false, geographic = false, hole = false, placed = true;

  void write(const std::filesystem::path& path) const {
    TIFF* const tiff = XTIFFOpen(path.c_str(), "w");
    ASSERT_NE(tiff, nullptr);
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, kColumns);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kRows);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, whole_numbers ? 16 : 32);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT,
                 whole_numbers ? SAMPLEFORMAT_INT : SAMPLEFORMAT_IEEEFP);
    if (tiled) {
      TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 32);
      TIFFSetField(tiff, TIFFTAG_TILELENGTH, 32);
    } else {
      TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 7);
    }
    if (placed) put_place(tiff);
    if (hole) put_no_data(tiff);
    if (whole_numbers) {
      write_samples<std::int16_t>(tiff);
    } else {
      write_samples<float>(tiff);
    }
    XTIFFClose(tiff);
  }

 private:
  void put_place(TIFF* tiff) const {
    const double step = geographic ? 0.001 : kCell_m;
    double scale[3] = {step, step, 0.0};
    double tie[6] = {0.0, 0.0, 0.0, geographic ? 10.0 : 400e3, geographic ? 60.0 : 4e6, 0.0};
    TIFFSetField(tiff, 33550, 3, scale);
    TIFFSetField(tiff, 33922, 6, tie);
    GTIF* const keys = GTIFNew(tiff);
    GTIFKeySet(keys, GTModelTypeGeoKey, TYPE_SHORT, 1,
               geographic ? ModelTypeGeographic : ModelTypeProjected);
    GTIFKeySet(keys, GTRasterTypeGeoKey, TYPE_SHORT, 1, RasterPixelIsArea);
    if (geographic) {
      GTIFKeySet(keys, GeographicTypeGeoKey, TYPE_SHORT, 1, 4326);
    } else {
      GTIFKeySet(keys, ProjectedCSTypeGeoKey, TYPE_SHORT, 1, 32611);
    }
    GTIFWriteKeys(keys);
    GTIFFree(keys);
  }
  static void put_no_data(TIFF* tiff) {
    static const TIFFFieldInfo kField[] = {
        {42113, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("GDAL_NODATA")}};
    TIFFMergeFieldInfo(tiff, kField, 1);
    TIFFSetField(tiff, 42113, "-9999");
  }
  template <class T>
  [[nodiscard]] T sample(int column, int row_from_north) const {
    const int row = kRows - 1 - row_from_north;
    if (column >= kColumns || row < 0) return T{0};
    return static_cast<T>(hole && in_hole(column, row) ? kGap : height(column, row));
  }
  template <class T>
  void write_samples(TIFF* tiff) const {
    if (!tiled) {
      std::vector<T> line(kColumns);
      for (int j = 0; j < kRows; ++j) {
        for (int i = 0; i < kColumns; ++i) line[i] = sample<T>(i, j);
        ASSERT_EQ(TIFFWriteScanline(tiff, line.data(), static_cast<std::uint32_t>(j), 0), 1);
      }
      return;
    }
    std::vector<T> tile(32 * 32);
    for (int top = 0; top < kRows; top += 32) {
      for (int left = 0; left < kColumns; left += 32) {
        for (int k = 0; k < 32 * 32; ++k) tile[k] = sample<T>(left + k % 32, top + k / 32);
        ASSERT_GT(TIFFWriteTile(tiff, tile.data(), static_cast<std::uint32_t>(left),
                                static_cast<std::uint32_t>(top), 0, 0),
                  0);
      }
    }
  }
};

void write_netcdf_file(const std::filesystem::path& path, bool hole = false) {
  int id = 0, y = 0, x = 0, yv = 0, xv = 0, zv = 0;
  ASSERT_EQ(nc_create(path.c_str(), NC_NETCDF4 | NC_CLOBBER, &id), NC_NOERR);
  nc_def_dim(id, "y", kRows, &y);
  nc_def_dim(id, "x", kColumns, &x);
  nc_def_var(id, "y", NC_DOUBLE, 1, &y, &yv);
  nc_def_var(id, "x", NC_DOUBLE, 1, &x, &xv);
  for (const int axis : {yv, xv}) nc_put_att_text(id, axis, "units", 1, "m");
  const int plane[] = {y, x};
  nc_def_var(id, "z", NC_FLOAT, 2, plane, &zv);
  nc_put_att_text(id, zv, "units", 1, "m");
  nc_put_att_float(id, zv, "_FillValue", NC_FLOAT, 1, &kGap);
  nc_enddef(id);
  std::vector<double> rows, columns;
  std::vector<float> z;
  for (int j = 0; j < kRows; ++j) rows.push_back(4e6 + kCell_m * j);
  for (int i = 0; i < kColumns; ++i) columns.push_back(400e3 + kCell_m * i);
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) z.push_back(hole && in_hole(i, j) ? kGap : height(i, j));
  }
  nc_put_var_double(id, yv, rows.data());
  nc_put_var_double(id, xv, columns.data());
  nc_put_var_float(id, zv, z.data());
  ASSERT_EQ(nc_close(id), NC_NOERR);
}

class ExemplarFiles : public testing::Test {
 protected:
  [[nodiscard]] ExemplarLibrary read() const { return read_exemplars(folder_.path(), Planet{}); }
  /// Refused as this kind of error, in one line that says all of it.
  void expect_refusal(ErrorKind kind, const std::string& says, const std::string& where) const {
    try {
      (void)read_exemplars(folder_ / where, Planet{});
      ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind) << error.what();
      EXPECT_THAT(error.what(), AllOf(HasSubstr(says), HasSubstr(where), HasSubstr("exemplars")));
      EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
    }
  }
  TemporaryFolder folder_;
};

TEST_F(ExemplarFiles, NetcdfAndEveryKindOfGeotiffAreReadAlike) {
  write_netcdf_file(folder_ / "a.nc");
  TiffFile{}.write(folder_ / "b.tif");
  TiffFile{.whole_numbers = true, .tiled = true}.write(folder_ / "c.tiff");
  std::ofstream(folder_ / "notes.txt") << "not a relief";
  const ExemplarLibrary library = read();
  ASSERT_EQ(library.exemplars.size(), 3U);
  for (const Exemplar& e : library.exemplars) {
    SCOPED_TRACE(e.name);
    ASSERT_EQ(e.nx, kColumns);
    ASSERT_EQ(e.ny, kRows);
    EXPECT_NEAR(e.cell_m, kCell_m, 1e-6);
    EXPECT_FALSE(e.periodic);
    for (int j = 0; j < kRows; ++j) {
      for (int i = 0; i < kColumns; ++i) ASSERT_EQ(e.elevation_m[j * kColumns + i], height(i, j));
    }
    EXPECT_NEAR(e.fold_rad, 0.7854, 0.02);
    EXPECT_EQ(e.terrain, Terrain::andean);
  }
  EXPECT_EQ(library.exemplars[0].name, "a");
}

TEST_F(ExemplarFiles, DegreesBecomeSquareCells) {
  TiffFile{.geographic = true}.write(folder_ / "alps.tif");
  const Exemplar e = read().exemplars.at(0);
  // 0.001 degrees at 60 north: half as wide as high.
  EXPECT_NEAR(e.cell_m, 111.19 * std::cos(59.975 * 3.14159265 / 180.0), 0.1);
  EXPECT_EQ(e.nx, kColumns);
  EXPECT_NEAR(e.ny, 2 * kRows, 1);
  EXPECT_NEAR(e.highest_m, 1650.0F, 20.0F);
}

TEST_F(ExemplarFiles, NamesSayTheTerrain) {
  for (const char* name :
       {"andean_1.nc", "Old Appalachians.nc", "plain-2.nc", "x_himalayan.nc", "golden.nc"}) {
    write_netcdf_file(folder_ / name);
  }
  const auto library = read();
  const auto terrain = [&](const std::string& name) {
    for (const Exemplar& e : library.exemplars) {
      if (e.name == name) return e.terrain;
    }
    throw Bug(name);
  };
  EXPECT_EQ(terrain("andean_1"), Terrain::andean);
  EXPECT_EQ(terrain("Old Appalachians"), Terrain::old_mountains);
  EXPECT_EQ(terrain("plain-2"), Terrain::plain);
  EXPECT_EQ(terrain("x_himalayan"), Terrain::himalayan);
  EXPECT_EQ(terrain("golden"), Terrain::andean);  // "old" is no word of it; its relief counts
}

TEST_F(ExemplarFiles, OfAReliefWithGapsTheLargestWholePartIsTaken) {
  write_netcdf_file(folder_ / "a.nc", true);
  TiffFile{.hole = true}.write(folder_ / "b.tif");
  for (const Exemplar& e : read().exemplars) {
    SCOPED_TRACE(e.name);
    ASSERT_EQ(e.nx, 60);
    ASSERT_EQ(e.ny, kRows);
    for (int j = 0; j < e.ny; ++j) {
      for (int i = 0; i < e.nx; ++i) ASSERT_EQ(e.elevation_m[j * e.nx + i], height(i, j));
    }
  }
}

TEST_F(ExemplarFiles, UnusableOnesAreRefusedInOneLine) {
  namespace fs = std::filesystem;
  for (const char* name : {"empty", "torn", "no tiff", "nowhere", "no netcdf"}) {
    fs::create_directory(folder_ / name);
  }
  TiffFile{}.write(folder_ / "torn/a.tif");
  fs::resize_file(folder_ / "torn/a.tif", fs::file_size(folder_ / "torn/a.tif") / 2);
  std::ofstream(folder_ / "no tiff/a.tif") << "hello";
  std::ofstream(folder_ / "no netcdf/a.nc") << "hello";
  TiffFile{.placed = false}.write(folder_ / "nowhere/a.tif");
  expect_refusal(ErrorKind::io, "No such file", "absent");
  expect_refusal(ErrorKind::input, "holds no elevation model", "empty");
  expect_refusal(ErrorKind::input, "a.tif", "torn");
  expect_refusal(ErrorKind::input, "no sound TIFF", "no tiff");
  expect_refusal(ErrorKind::input, "a.nc", "no netcdf");
  expect_refusal(ErrorKind::input, "coordinate system", "nowhere");
}

TEST_F(ExemplarFiles, TerrainsThatAFolderHasNoneOfAreGrown) {
  setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1);
  std::filesystem::create_directory(folder_ / "given");
  write_netcdf_file(folder_ / "given/andean.nc");
  const auto library = exemplars_of(folder_ / "given", Planet{});
  std::vector<std::string> names;
  for (const Exemplar& e : library->exemplars) names.push_back(e.name);
  EXPECT_THAT(names, testing::ElementsAre("andean", "himalayan", "old_mountains", "plain"));
  EXPECT_EQ(library->exemplars[0].nx, kColumns);
}

TEST_F(ExemplarFiles, OnesTooSmallForAPlanetAreLeftOutInOneLine) {
  setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1);
  std::filesystem::create_directory(folder_ / "given");
  write_netcdf_file(folder_ / "given/andean.nc");
  std::vector<std::string> warnings;
  const auto library = planet_exemplars_of(folder_ / "given", Planet{}, 150e3, warnings);
  ASSERT_EQ(library->exemplars.size(), 4U);
  for (const Exemplar& e : library->exemplars) EXPECT_EQ(e.cell_m, kGrownForPlanets.cell_m);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0], testing::HasSubstr("andean ("));
  EXPECT_THAT(warnings[0], testing::HasSubstr("must be 500 km a side"));
  EXPECT_EQ(warnings[0].find('\n'), std::string::npos);
  // Shorter waves it does hold.
  warnings.clear();
  const auto shorter =
      planet_exemplars_of(folder_ / "given", Planet{}, 0.29 * kRows * kCell_m, warnings);
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(shorter->exemplars[0].nx, kColumns);
  // Each size has a cache of its own.
  EXPECT_EQ(exemplars_of({}, Planet{})->exemplars[0].cell_m, kGrownForIslands.cell_m);
}

TEST_F(ExemplarFiles, EachBuildHasACacheOfItsOwn) {
  setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1);
  std::set<std::filesystem::path> caches{exemplar_cache({})};
  for (auto part :
       {&BuildInfo::version, &BuildInfo::commit, &BuildInfo::compiler, &BuildInfo::id}) {
    BuildInfo other = build_info();
    other.*part += "x";
    caches.insert(exemplar_cache({}, other));
  }
  EXPECT_EQ(caches.size(), 5U);
}

TEST_F(ExemplarFiles, TheCacheGivesTheSameBitsAndHeals) {
  namespace fs = std::filesystem;
  setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1);
  const ExemplarLibrary grown = grown_exemplars();
  const fs::path cache = fs::directory_iterator(folder_ / "terrane")->path();
  const auto written = fs::last_write_time(cache);
  const auto expect_same = [&] {
    const ExemplarLibrary again = grown_exemplars();
    ASSERT_EQ(again.exemplars.size(), grown.exemplars.size());
    for (std::size_t k = 0; k < again.exemplars.size(); ++k) {
      EXPECT_TRUE(again.exemplars[k].elevation_m == grown.exemplars[k].elevation_m);
      EXPECT_EQ(again.exemplars[k].fold_rad, grown.exemplars[k].fold_rad);
      EXPECT_EQ(again.exemplars[k].periodic, grown.exemplars[k].periodic);
    }
  };
  expect_same();
  EXPECT_EQ(fs::last_write_time(cache), written);  // it was read
  std::fstream file(cache, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(fs::file_size(cache) / 2));
  file << "damage damage damage";
  file.close();
  const auto damaged = fs::last_write_time(cache);
  expect_same();
  EXPECT_NE(fs::last_write_time(cache), damaged);  // and written anew
  setenv("XDG_CACHE_HOME", "/proc/none", 1);       // where nothing can be written
  expect_same();
}

}  // namespace
}  // namespace geo::io
