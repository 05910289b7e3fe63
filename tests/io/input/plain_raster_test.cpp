#include "io/input/plain_raster.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <array>
#include <cmath>
#include <fstream>

#include "geo/core/error.hpp"
#include "geo/io/export/export.hpp"
#include "geo/io/input/dem.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "io/drawing/png_file.hpp"
#include "io/temporary_folder.hpp"
#include "support/message_of.hpp"
#include "support/text_of.hpp"

namespace geo::io {
namespace {

using test::message_of;
using testing::HasSubstr;

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::vector<float> heights(const Grid& grid) {
  std::vector<float> values(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    values[cell] = static_cast<float>(
        4000.0 * std::sin(0.3 * grid.column(cell)) * std::cos(0.2 * grid.row(cell)) - 1000.0);
  }
  return values;
}

std::filesystem::path stage_file(const std::filesystem::path& path, const Grid& grid) {
  Snapshot snapshot{"erosion", std::make_shared<const Grid>(grid), {}};
  snapshot.fields.emplace_back(&field::elevation, std::make_shared<const Values>(heights(grid)));
  write_netcdf(path, snapshot, {"terrane: erosion", "# none\n", 7, "0.1.0", "now", "none"});
  return path;
}

TEST(ImageRelief, PicturesThatCannotBeReadKeepNoMemory) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> grey(16 * 8);
  write_grey_png(folder / "whole.png", grey, 16, 8);
  const auto path = (folder / "cut.png").string();
  write_text(path, test::text_of(folder / "whole.png").substr(0, 20));
  const auto refuse = [&] {
    EXPECT_THROW(read_png_raster(path, {.range = std::pair{0.0, 1.0}}), InputError);
  };
  constexpr int kTimes = 500;
  refuse();
  const auto before = mallinfo2().uordblks;
  for (int time = 0; time < kTimes; ++time) refuse();
  EXPECT_LT(mallinfo2().uordblks, before + 100U * kTimes);
}

TEST(ImageRelief, ExportedAndReadAgainIsWithinHalfAQuantum) {
  const TemporaryFolder folder;
  for (const auto& grid : {Grid::sphere(64, 32), Grid::window(40, 20, {10.0, 30.0, -20.0, 20.0})}) {
    const auto source = stage_file(folder / "stage.nc", grid);
    const auto truth = heights(grid);
    const auto [least, most] = std::minmax_element(truth.begin(), truth.end());
    ExportRequest request;
    request.place = source.string();
    request.output = folder / "height.png";
    export_field(request);
    const Dem dem = read_dem(request.output.string(), {});
    ASSERT_EQ(dem.grid.nx(), grid.nx());
    ASSERT_EQ(dem.grid.ny(), grid.ny());
    EXPECT_EQ(dem.grid.topology(), grid.topology());
    const double quantum = (*most - *least) / 65535.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      // And the rounding of a float of some thousands.
      ASSERT_NEAR(dem.elevation_m[i], truth[i], 0.5 * quantum + 2.5e-4) << i;
    }
  }
}

TEST(ImageRelief, GeotiffExportedAndReadAgainIsTheSame) {
  const TemporaryFolder folder;
  for (const auto& grid : {Grid::sphere(64, 32), Grid::window(40, 20, {10.0, 30.0, -20.0, 20.0}),
                           Grid::equal_area(40, 30, 900.0, {-38.0, 176.0})}) {
    ExportRequest request;
    request.place = stage_file(folder / "stage.nc", grid).string();
    request.format = ExportFormat::geotiff;
    request.output = folder / "height.tif";
    export_field(request);
    const Dem dem = read_dem(request.output.string(), {});
    EXPECT_EQ(dem.grid.topology(), grid.topology());
    EXPECT_EQ(dem.elevation_m, heights(grid));
    EXPECT_NEAR(dem.grid.total_area_m2(), grid.total_area_m2(), 1e-6 * grid.total_area_m2());
  }
}

TEST(ImageRelief, RangeAndWindowGiveSamplesTheirMeaning) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> bytes(16 * 8);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(2 * i);
  bytes.back() = 255;
  write_grey_png(folder / "a.png", bytes, 16, 8);
  const Dem planet = read_dem((folder / "a.png").string(), {}, {"-1000,4100", ""});
  EXPECT_EQ(planet.grid.topology(), Topology::sphere);
  // Row 0 of the picture is the northernmost.
  EXPECT_FLOAT_EQ(planet.elevation_m[7 * 16], -1000.0F);
  EXPECT_FLOAT_EQ(planet.elevation_m[7 * 16 + 3], -1000.0F + 20.0F * 6.0F);
  EXPECT_FLOAT_EQ(planet.elevation_m[15], 4100.0F);
  const Dem part = read_dem((folder / "a.png").string(), {}, {"0,1", "170,-20,-150,0"});
  EXPECT_NEAR(part.grid.window().east_deg - part.grid.window().west_deg, 40.0, 1e-9);
  EXPECT_NEAR(part.grid.window().south_deg, -20.0, 1e-9);
  // A quantity with bounds has them.
  const Dem share = read_field((folder / "a.png").string(), field::river_intensity, {});
  EXPECT_FLOAT_EQ(share.elevation_m[15], 1.0F);
  // An order without a unit runs from 0 to 1; others have the range that is given.
  FieldSpec order = field::ranking;
  order.units = "";
  EXPECT_FLOAT_EQ(read_field((folder / "a.png").string(), order, {}).elevation_m[15], 1.0F);
  const Dem uplift =
      read_field((folder / "a.png").string(), field::uplift_rate, {}, {"0,0.01", "0,0,40,20"});
  EXPECT_FLOAT_EQ(uplift.elevation_m[15], 0.01F);
  EXPECT_NEAR(uplift.grid.window().east_deg, 40.0, 1e-9);
}

TEST(ImageRelief, AsciiGridsAreReadByTheirHeads) {
  const TemporaryFolder folder;
  const auto path = (folder / "a.asc").string();
  write_text(path,
             "NCOLS 4\r\nNROWS 3\nXLLCENTER 10.5\nYLLCENTER 20.5\nCELLSIZE 1\nNODATA_value -9999\n"
             "1 2 3 4\n5 6 7 8\n9 10 -1.5e1 12\n");
  const Dem window = read_dem(path, {});
  EXPECT_NEAR(window.grid.window().west_deg, 10.0, 1e-9);
  EXPECT_NEAR(window.grid.window().north_deg, 23.0, 1e-9);
  EXPECT_EQ(window.elevation_m, (std::vector<float>{9, 10, -15, 12, 5, 6, 7, 8, 1, 2, 3, 4}));
  write_text(path,
             "ncols 4\nnrows 3\nxllcorner 500000\nyllcorner 4000000\ncellsize 90\n"
             "1 2 3 4 5 6 7 8 9 10 11 12");
  const Dem plane = read_dem(path, {});
  EXPECT_FALSE(plane.grid.is_latitude_longitude());
  EXPECT_DOUBLE_EQ(plane.grid.spacing_east_m(0), 90.0);
}

TEST(ImageRelief, RefusesInOneLineWhatIsDamagedOrSaysTooLittle) {
  const TemporaryFolder folder;
  const auto path = (folder / "a").string();
  const auto refusal = [&](const std::string& bytes, ImageWords words = {}) {
    write_text(path, bytes);
    return message_of(ErrorKind::input, [&] { read_dem(path, {}, words); });
  };
  const std::string head = "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
  EXPECT_THAT(refusal(head + "1 2 3 4 5 6 7 8 9 10 11"), HasSubstr("missing"));
  EXPECT_THAT(refusal(head + "1 2 3 4 5 6 7 8 9 10 11 12 13"), HasSubstr("more values"));
  EXPECT_THAT(refusal(head + "1 2 3 4 5 six 7 8 9 10 11 12"),
              HasSubstr("row 2 from the top, column 2"));
  EXPECT_THAT(refusal(head + "nodata_value 7\n1 2 3 4 5 6 7 8 9 10 11 12"),
              HasSubstr("no value in row 2 from the top, column 3"));
  EXPECT_THAT(refusal("ncols 400000\nnrows 300000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1"),
              HasSubstr("too short"));
  EXPECT_THAT(refusal("ncols 4\nnrows three\n"), HasSubstr("nrows"));
  EXPECT_THAT(refusal("ncols 4\nnrows 3\n1 2 3"), HasSubstr("xllcorner"));
  EXPECT_THAT(refusal("ncols 1\nfloors 2\n"), HasSubstr("floors"));
  EXPECT_THAT(refusal("ncols 1\nfl\x88ors 2\n"), HasSubstr("fl?ors"));
  // Once taken for three rows, the last of them from beyond the values.
  EXPECT_THAT(refusal("ncols 4\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3 4 5 6 7 8"),
              HasSubstr("at least 4 x 3"));
  EXPECT_THAT(refusal("\x89PNG\r\n\x1a\n and no more", {"0,1", ""}), HasSubstr("PNG"));
  const std::vector<std::uint8_t> grey(16 * 8);
  write_grey_png(folder / "b.png", grey, 16, 8);
  EXPECT_THAT(message_of(ErrorKind::input, [&] { read_dem((folder / "b.png").string(), {}); }),
              HasSubstr("--dem-range"));
  const std::string whole = test::text_of(folder / "b.png");
  for (const std::size_t length : {9U, 30U, 45U, 60U}) {
    EXPECT_THAT(refusal(whole.substr(0, length), {"0,1", ""}), HasSubstr("PNG"));
  }
  write_text(folder / "b.json", "{\"offset\": 0, \"scale\": \"wide\"}");
  EXPECT_THAT(message_of(ErrorKind::input, [&] { read_dem((folder / "b.png").string(), {}); }),
              HasSubstr("b.json"));
  const std::array<std::uint32_t, 4> colours{};
  write_png(folder / "c.png", {reinterpret_cast<const std::uint8_t*>(colours.data()), 2, 2, 8});
  EXPECT_THAT(message_of(ErrorKind::input,
                         [&] {
                           read_dem((folder / "c.png").string(), {}, {"0,1", ""});
                         }),
              HasSubstr("grey"));
  for (const char* range : {"1", "1,1", "a,b", "0,inf", "nan,1"}) {
    EXPECT_THAT(message_of(ErrorKind::configuration,
                           [&] {
                             read_dem((folder / "b.png").string(), {}, {range, ""});
                           }),
                HasSubstr("--dem-range"));
  }
}

}  // namespace
}  // namespace geo::io
