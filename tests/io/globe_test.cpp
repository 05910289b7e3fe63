// The closed surfaces that ParaView shows as globes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>

#include <cmath>
#include <map>
#include <numbers>

#include "geo/core/error.hpp"
#include "io/sample_snapshot.hpp"
#include "io/temporary_folder.hpp"

namespace geo::io {
namespace {

using Point = std::array<double, 3>;

class Globe : public testing::Test {
 protected:
  vtkPolyData& write_and_read(const Grid& grid, std::span<const float> elevation_m, double times,
                              int compression = 0) {
    const auto path = folder_ / "a.vtp";
    write_globe(path, sample_snapshot(grid), {}, elevation_m, times, compression);
    reader_->SetFileName(path.c_str());
    reader_->Modified();
    reader_->Update();
    return *reader_->GetOutput();
  }
  static std::vector<vtkIdType> corners_of(vtkPolyData& surface, vtkIdType cell) {
    const vtkNew<vtkIdList> points;
    surface.GetCellPoints(cell, points);
    return {points->begin(), points->end()};
  }

  TemporaryFolder folder_;
  vtkNew<vtkXMLPolyDataReader> reader_;
};

TEST_F(Globe, IsClosedWithoutSeamOrHole) {
  for (const auto& grid : {Grid::sphere(48, 24), Grid::sphere(46, 23, {3.3962e6, 0.00589})}) {
    auto& surface = write_and_read(grid, {}, 1.0);
    ASSERT_EQ(surface.GetNumberOfCells(), grid.size());
    // Each edge is walked once in each direction: two faces meet there and look the same way.
    std::map<std::pair<vtkIdType, vtkIdType>, int> walked;
    for (vtkIdType cell = 0; cell < surface.GetNumberOfCells(); ++cell) {
      const auto corners = corners_of(surface, cell);
      for (std::size_t i = 0; i < corners.size(); ++i) {
        ++walked[{corners[i], corners[(i + 1) % corners.size()]}];
      }
    }
    for (const auto& [edge, times] : walked) {
      EXPECT_EQ(times, 1);
      EXPECT_EQ((walked.count({edge.second, edge.first})), 1U);
    }
    const auto edges = static_cast<vtkIdType>(walked.size() / 2);
    EXPECT_EQ(surface.GetNumberOfPoints() - edges + surface.GetNumberOfCells(), 2) << "Euler";
  }
}

TEST_F(Globe, FacesLieWhereTheirCellsLieAndLookOutwards) {
  const Grid grid = Grid::sphere(96, 48);
  auto& surface = write_and_read(grid, {}, 1.0);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    Point middle{}, first{}, second{}, third{};
    const auto corners = corners_of(surface, cell);
    for (const vtkIdType corner : corners) {
      Point point{};
      surface.GetPoint(corner, point.data());
      for (int i = 0; i < 3; ++i) middle[i] += point[i] / static_cast<double>(corners.size());
    }
    const double length = std::hypot(middle[0], middle[1], middle[2]);
    const auto expected = grid.unit_vector(grid.column(cell), grid.row(cell));
    const double within = 2.0 * std::numbers::pi / 96.0;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(middle[i] / length, expected[i], 0.5 * within);
    surface.GetPoint(corners[0], first.data());
    surface.GetPoint(corners[1], second.data());
    surface.GetPoint(corners[2], third.data());
    const Point a{second[0] - first[0], second[1] - first[1], second[2] - first[2]};
    const Point b{third[0] - first[0], third[1] - first[1], third[2] - first[2]};
    EXPECT_GT((a[1] * b[2] - a[2] * b[1]) * middle[0] + (a[2] * b[0] - a[0] * b[2]) * middle[1] +
                  (a[0] * b[1] - a[1] * b[0]) * middle[2],
              0.0)
        << "cell " << cell;
  }
}

/// Every field of the snapshot has its values in a data set, bit for bit.
void expect_values(vtkDataSet& data, const Snapshot& snapshot) {
  for (const auto& [spec, values] : snapshot.fields) {
    vtkDataArray* array = data.GetCellData()->GetArray(std::string(spec->name).c_str());
    ASSERT_NE(array, nullptr) << spec->name;
    std::visit(
        [&](const auto& known) {
          for (Index cell = 0; cell < snapshot.grid->size(); ++cell) {
            const auto read = array->GetComponent(cell, 0);
            const auto written = static_cast<double>(known[cell]);
            EXPECT_TRUE(read == written || (std::isnan(read) && std::isnan(written)));
          }
        },
        *values);
  }
}

TEST_F(Globe, HoldsEveryValueOfEveryFieldAtAnyCompression) {
  const Grid grid = Grid::sphere(96, 48);
  std::uintmax_t plain = 0;
  for (const int compression : {0, 1, 9}) {
    expect_values(write_and_read(grid, {}, 1.0, compression), sample_snapshot(grid));
    const auto size = std::filesystem::file_size(folder_ / "a.vtp");
    if (compression == 0) {
      plain = size;
    } else {
      EXPECT_LT(size, plain * 0.9);
    }
  }
}

TEST(Image, HoldsEveryValueOfEveryFieldAtAnyCompression) {
  const TemporaryFolder folder;
  const Snapshot snapshot = sample_snapshot(Grid::sphere(96, 48));
  std::uintmax_t plain = 0;
  for (const int compression : {0, 1, 9}) {
    const auto path = folder / "a.vti";
    write_vti(path, snapshot, {}, compression);
    const vtkNew<vtkXMLImageDataReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    expect_values(*reader->GetOutput(), snapshot);
    const auto size = std::filesystem::file_size(path);
    if (compression == 0) {
      plain = size;
    } else {
      EXPECT_LT(size, plain * 0.9);
    }
  }
}

TEST_F(Globe, CornersAreRaisedByTheMeanAroundThem) {
  const Grid grid = Grid::sphere(24, 12);
  std::vector<float> elevation_m(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    elevation_m[cell] = static_cast<float>(100 * grid.row(cell) + grid.column(cell));
  }
  auto& surface = write_and_read(grid, elevation_m, 20.0);
  vtkDataArray* topography = surface.GetPointData()->GetArray("topography");
  ASSERT_NE(topography, nullptr);
  for (vtkIdType point = 0; point < surface.GetNumberOfPoints(); ++point) {
    Point at{};
    surface.GetPoint(point, at.data());
    EXPECT_NEAR(std::hypot(at[0], at[1], at[2]), 6371e3 + 20.0 * topography->GetComponent(point, 0),
                2.0);
  }
  // Between columns 4 and 5, rows 0 and 1; at the date line; at the poles.
  EXPECT_FLOAT_EQ(topography->GetComponent(5, 0), 54.5);
  EXPECT_FLOAT_EQ(topography->GetComponent(0, 0), 61.5);
  EXPECT_FLOAT_EQ(topography->GetComponent(surface.GetNumberOfPoints() - 2, 0), 11.5);
  EXPECT_FLOAT_EQ(topography->GetComponent(surface.GetNumberOfPoints() - 1, 0), 1111.5);
}

TEST_F(Globe, FollowsTheEllipsoid) {
  const Ellipsoid figure{6378137.0, 1 / 298.257223563};
  auto& surface = write_and_read(Grid::sphere(32, 16, figure), {}, 1.0);
  Point pole{}, equator{};
  surface.GetPoint(surface.GetNumberOfPoints() - 1, pole.data());
  surface.GetPoint(32 * 7, equator.data());
  EXPECT_NEAR(pole[2], 6356752.3, 1.0);
  EXPECT_NEAR(equator[0], -6378137.0, 1.0);
}

TEST_F(Globe, NeedsAWholePlanet) {
  EXPECT_THROW(write_and_read(Grid::window(8, 8, {0.0, 10.0, 0.0, 10.0}), {}, 1.0), Error);
}

}  // namespace
}  // namespace geo::io
