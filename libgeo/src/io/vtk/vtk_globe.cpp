#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt32Array.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "vtk_parts.hpp"

namespace geo::io {
namespace {

/// Corners of the cells of a grid round a planet, each once: rows from south to north between the
/// rows of cells, then the south and the north pole.
class Corners {
 public:
  explicit Corners(const Grid& grid) : grid_(grid) {}

  [[nodiscard]] Index count() const { return grid_.nx() * (grid_.ny() - 1) + 2; }
  [[nodiscard]] Index south_pole() const { return count() - 2; }
  [[nodiscard]] Index north_pole() const { return count() - 1; }
  /// Lower left corner of a cell; columns wrap. Rows 1 to ny - 1.
  [[nodiscard]] Index at(int column, int row) const {
    return (row - 1) * grid_.nx() + column % grid_.nx();
  }

 private:
  const Grid& grid_;
};

/// Heights of corners: means of the cells that meet there. Zero without elevation.
std::vector<float> heights_of_corners(const Grid& grid, const Corners& corners,
                                      std::span<const float> elevation_m) {
  std::vector<float> heights(corners.count(), 0.0F);
  if (elevation_m.empty()) return heights;
  const int nx = grid.nx();
#pragma omp parallel for schedule(static)
  for (int row = 1; row < grid.ny(); ++row) {
    for (int column = 0; column < nx; ++column) {
      const int left = column == 0 ? nx - 1 : column - 1;
      heights[corners.at(column, row)] =
          0.25F * (elevation_m[grid.cell(left, row - 1)] + elevation_m[grid.cell(column, row - 1)] +
                   elevation_m[grid.cell(left, row)] + elevation_m[grid.cell(column, row)]);
    }
  }
  for (const int row : {0, grid.ny() - 1}) {
    double sum = 0.0;
    for (int column = 0; column < nx; ++column) sum += elevation_m[grid.cell(column, row)];
    heights[row == 0 ? corners.south_pole() : corners.north_pole()] = static_cast<float>(sum / nx);
  }
  return heights;
}

/// Position of a place of given geodetic latitude and height above the ellipsoid, m.
struct Place {
  double latitude_deg, longitude_deg, height_m;
};
std::array<float, 3> position_of(const Ellipsoid& figure, const Place& place) {
  constexpr double kRadians = std::numbers::pi / 180.0;
  const double sine = std::sin(place.latitude_deg * kRadians);
  const double cosine =
      std::abs(place.latitude_deg) == 90.0 ? 0.0 : std::cos(place.latitude_deg * kRadians);
  const double squared = figure.flattening * (2.0 - figure.flattening);
  const double normal = figure.radius_m / std::sqrt(1.0 - squared * sine * sine);
  const double across = (normal + place.height_m) * cosine;
  return {static_cast<float>(across * std::cos(place.longitude_deg * kRadians)),
          static_cast<float>(across * std::sin(place.longitude_deg * kRadians)),
          static_cast<float>((normal * (1.0 - squared) + place.height_m) * sine)};
}

void set_points(vtkPolyData& surface, const Grid& grid, const Corners& corners,
                std::span<const float> heights, double times) {
  const vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(corners.count());
  float* xyz = static_cast<vtkFloatArray*>(points->GetData())->GetPointer(0);
  const Window& window = grid.window();
  const double dx = (window.east_deg - window.west_deg) / grid.nx();
  const double dy = (window.north_deg - window.south_deg) / grid.ny();
  const auto put = [&](Index corner, double latitude_deg, double longitude_deg) {
    const auto position =
        position_of(grid.figure(), {latitude_deg, longitude_deg, times * heights[corner]});
    std::copy(position.begin(), position.end(), xyz + 3 * static_cast<std::size_t>(corner));
  };
#pragma omp parallel for schedule(static)
  for (int row = 1; row < grid.ny(); ++row) {
    for (int column = 0; column < grid.nx(); ++column) {
      put(corners.at(column, row), window.south_deg + row * dy, window.west_deg + column * dx);
    }
  }
  put(corners.south_pole(), -90.0, 0.0);
  put(corners.north_pole(), 90.0, 0.0);
  surface.SetPoints(points);
}

/// One face a cell, in the order of the cells: counter-clockwise from above, triangles at the
/// poles.
void set_faces(vtkPolyData& surface, const Grid& grid, const Corners& corners) {
  const int nx = grid.nx(), last = grid.ny() - 1;
  const vtkNew<vtkTypeInt32Array> offsets, faces;
  offsets->SetNumberOfValues(grid.size() + 1);
  faces->SetNumberOfValues(4 * static_cast<vtkIdType>(grid.size()) - 2 * nx);
  Index next = 0;
  const auto add = [&](Index corner) { faces->SetValue(next++, corner); };
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const int row = grid.row(cell), column = grid.column(cell);
    offsets->SetValue(cell, next);
    if (row == 0) {
      add(corners.south_pole());
    } else {
      add(corners.at(column, row));
      add(corners.at(column + 1, row));
    }
    if (row == last) {
      add(corners.north_pole());
    } else {
      add(corners.at(column + 1, row + 1));
      add(corners.at(column, row + 1));
    }
  }
  offsets->SetValue(grid.size(), next);
  const vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, faces);
  surface.SetPolys(cells);
}

}  // namespace

void write_globe(const std::filesystem::path& path, const Snapshot& snapshot,
                 const Provenance& provenance, std::span<const float> elevation_m, double times,
                 int compression) {
  const Grid& grid = *snapshot.grid;
  if (grid.topology() != Topology::sphere) {
    throw Bug(path.string() + ": only a grid round the whole planet is a globe");
  }
  if (grid.size() > std::numeric_limits<Index>::max() / 4) {
    throw ConfigurationError("output.globe: a grid of more than 536 million cells is too large");
  }
  const Corners corners(grid);
  auto heights = heights_of_corners(grid, corners, elevation_m);
  const vtkNew<vtkPolyData> surface;
  set_points(*surface, grid, corners, heights, times);
  set_faces(*surface, grid, corners);
  const vtkNew<vtkFloatArray> topography;
  topography->SetName("topography");
  constexpr int kKeep = 1;
  topography->SetArray(heights.data(), static_cast<vtkIdType>(heights.size()), kKeep);
  surface->GetPointData()->AddArray(topography);
  add_fields(*surface, snapshot);
  add_provenance(*surface, provenance);
  const vtkNew<vtkXMLPolyDataWriter> writer;
  write_whole(*writer, *surface, path, compression);
}

}  // namespace geo::io
