#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace geo {

/// Flat cell index, row * nx + column. Row 0 is the southernmost.
using Index = std::int32_t;
inline constexpr Index kNoCell = -1;

/// The eight directions, clockwise from north. `flow_direction` in files is this number + 1.
enum Direction : int {
  kNorth,
  kNorthEast,
  kEast,
  kSouthEast,
  kSouth,
  kSouthWest,
  kWest,
  kNorthWest
};
inline constexpr int kDirections = 8;
/// Column and row steps of each direction (rows count northwards).
inline constexpr std::array<int, kDirections> kColumnStep{0, 1, 1, 1, 0, -1, -1, -1};
inline constexpr std::array<int, kDirections> kRowStep{1, 1, 0, -1, -1, -1, 0, 1};

enum class Topology : std::uint8_t {
  sphere,  ///< columns wrap, a step over a pole lands on the same row half-way round
  plane,   ///< four edges
  torus,   ///< columns and rows wrap
};

/// What a plane does at its edges: `open` lets water and rock leave, `closed` lets nothing pass.
enum class Edges : std::uint8_t { open, closed };

/// Figure of the planet. `flattening` 0 is a sphere.
struct Ellipsoid {
  double radius_m = 6371000.0;
  double flattening = 0.0;
};

/// Cell-centred latitude-longitude window, degrees; outer edges, not centres.
struct Window {
  double south_deg, north_deg, west_deg, east_deg;
};

/// Geographic position of the centre of a metric plane, for everything that depends on latitude.
struct Centre {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
};

/// A cell-centred raster with the true metric of what it covers.
///
/// Areas, distances and face lengths depend on the row alone, so each is a table of `ny` entries:
/// cell areas are exact on the ellipsoid (authalic latitude), distances between neighbours are
/// geodesics (Karney 2013, GeographicLib), face lengths are arcs of meridians and parallels.
/// No kernel measures anything in cells.
class Grid {
 public:
  /// The whole planet, latitudes ascending from -90, longitudes from -180. `nx` must be even, so
  /// that half-way round is a column. Throws ConfigurationError on sizes it cannot represent.
  /// `turn` (an axis times an angle, radians) turns the frame of noise and meshes under the grid:
  /// the same planet with another place at its poles.
  static Grid sphere(int nx, int ny, Ellipsoid figure = {}, std::array<double, 3> turn = {});
  /// A latitude-longitude window of a planet: plane topology, the metric of the ellipsoid.
  static Grid window(int nx, int ny, Window window, Ellipsoid figure = {},
                     Edges edges = Edges::open);
  /// A flat rectangle of cells dx_m by dy_m. With `centre` its cells know their latitude and
  /// longitude (local azimuthal approximation, for rectangles small against the planet).
  static Grid plane(int nx, int ny, double dx_m, double dy_m, Edges edges = Edges::open,
                    std::optional<Centre> centre = {}, Ellipsoid figure = {});
  /// A rectangle of square cells in Lambert's azimuthal equal-area projection about `centre`
  /// (EqualAreaProjection): plane topology and metric, true areas, and a true latitude and
  /// longitude for every cell. Throws ConfigurationError as `check_equal_area` does.
  static Grid equal_area(int nx, int ny, double cell_m, Centre centre, Ellipsoid figure = {},
                         Edges edges = Edges::open);
  /// Throws ConfigurationError when it does not fit the hemisphere round its centre, has too many
  /// or too few cells or the centre is no place.
  static void check_equal_area(int nx, int ny, double cell_m, Centre centre, Ellipsoid figure = {});
  /// A flat rectangle whose opposite edges meet.
  static Grid torus(int nx, int ny, double dx_m, double dy_m);

  [[nodiscard]] Topology topology() const noexcept { return topology_; }
  [[nodiscard]] Edges edges() const noexcept { return edges_; }
  [[nodiscard]] int nx() const noexcept { return nx_; }
  [[nodiscard]] int ny() const noexcept { return ny_; }
  [[nodiscard]] Index size() const noexcept { return nx_ * ny_; }
  [[nodiscard]] const Ellipsoid& figure() const noexcept { return figure_; }

  [[nodiscard]] int row(Index cell) const noexcept { return cell / nx_; }
  [[nodiscard]] int column(Index cell) const noexcept { return cell % nx_; }
  [[nodiscard]] Index cell(int column, int row) const noexcept { return row * nx_ + column; }

  /// Neighbour in direction k, wrapping and crossing poles as the topology says; kNoCell beyond
  /// the edge of a plane.
  [[nodiscard]] Index neighbour(int column, int row, int k) const noexcept;
  [[nodiscard]] Index neighbour(Index cell, int k) const noexcept {
    return neighbour(column(cell), row(cell), k);
  }
  /// Direction that leads back from neighbour(column, row, k): not simply the opposite one where
  /// the step crosses a pole.
  [[nodiscard]] int back_direction(int row, int k) const noexcept;
  /// True where all eight neighbours are at the constant flat offsets of `offsets()`.
  [[nodiscard]] bool is_interior(int column, int row) const noexcept {
    return column > 0 && column < nx_ - 1 && row > 0 && row < ny_ - 1;
  }
  /// Flat index offsets of the eight neighbours of an interior cell.
  [[nodiscard]] std::array<Index, kDirections> offsets() const noexcept;
  /// True for a cell at the edge of an open plane, where water and rock leave.
  [[nodiscard]] bool is_open_edge(int column, int row) const noexcept {
    return topology_ == Topology::plane && edges_ == Edges::open && !is_interior(column, row);
  }

  /// Area of each cell of a row, m2.
  [[nodiscard]] double area_m2(int row) const noexcept { return area_m2_[row]; }
  [[nodiscard]] std::span<const double> row_areas_m2() const noexcept { return area_m2_; }
  [[nodiscard]] double total_area_m2() const noexcept { return total_area_m2_; }
  /// Centre-to-centre distances to the eight neighbours from a row, m (also over a pole or edge).
  [[nodiscard]] const std::array<double, kDirections>& distances_m(int row) const noexcept {
    return distance_m_[row];
  }
  /// Arc along the row between neighbouring centres, m.
  [[nodiscard]] double spacing_east_m(int row) const noexcept { return spacing_east_m_[row]; }
  /// Meridian arc from the centre of `row` to that of `row + 1`, m. For the topmost row: across
  /// the edge (torus), to the edge and as far again (plane), over the pole (sphere).
  [[nodiscard]] double spacing_north_m(int row) const noexcept { return distance_m_[row][kNorth]; }
  /// Length of the face towards the eastern neighbour, m.
  [[nodiscard]] double face_east_m(int row) const noexcept { return face_east_m_[row]; }
  /// Length of the face between `row` and `row + 1`, m; 0 at a pole. `row` may be -1.
  [[nodiscard]] double face_north_m(int row) const noexcept { return face_north_m_[row + 1]; }

  /// Whether cells have a latitude and a longitude.
  [[nodiscard]] bool is_geographic() const noexcept { return !latitude_deg_.empty(); }
  /// Whether rows are parallels and columns meridians (sphere and window).
  [[nodiscard]] bool is_latitude_longitude() const noexcept { return latitude_longitude_; }
  [[nodiscard]] double latitude_deg(int row) const noexcept { return latitude_deg_[row]; }
  [[nodiscard]] double longitude_deg(int column) const noexcept { return longitude_deg_[column]; }
  /// Whether cells lie in an equal-area projection, each with its own latitude and longitude; the
  /// functions of a row or a column alone then give those of the middle column or row.
  [[nodiscard]] bool is_projected() const noexcept { return !cell_latitude_deg_.empty(); }
  /// Latitude and longitude of one cell of any geographic grid.
  [[nodiscard]] Centre position(int column, int row) const noexcept {
    if (!is_projected()) return {latitude_deg_[row], longitude_deg_[column]};
    return {cell_latitude_deg_[cell(column, row)], cell_longitude_deg_[cell(column, row)]};
  }
  /// Projected coordinates of a metric plane or torus, m, centred on 0.
  [[nodiscard]] double x_m(int column) const noexcept {
    return (column + 0.5 - 0.5 * nx_) * spacing_east_m_[0];
  }
  [[nodiscard]] double y_m(int row) const noexcept {
    return (row + 0.5 - 0.5 * ny_) * step_north_m_;
  }
  /// Outer edges in degrees (latitude-longitude grids).
  [[nodiscard]] const Window& window() const noexcept { return window_; }
  /// Geographic centre of a plane that was given one.
  [[nodiscard]] const std::optional<Centre>& centre() const noexcept { return centre_; }
  /// Row step of a metric plane or torus, m.
  [[nodiscard]] double step_north_m() const noexcept { return step_north_m_; }

  /// Position for coherent noise: on the unit sphere where cells are geographic (geodetic
  /// latitude), in units of the planet's radius on a plane, on a ring torus (seamless, not
  /// isometric) where both edges wrap. On a sphere with a turn it is turned by it.
  [[nodiscard]] std::array<double, 3> unit_vector(int column, int row) const noexcept;
  /// A vector of the frame of unit_vector in that of the axis: z to the north pole, x to longitude
  /// 0. The same vector on a grid without a turn.
  [[nodiscard]] std::array<double, 3> to_axis(const std::array<double, 3>& vector) const noexcept;
  [[nodiscard]] const std::array<double, 3>& turn() const noexcept { return turn_; }

 private:
  Grid(Topology topology, Edges edges, int nx, int ny, Ellipsoid figure);
  void set_latitude_longitude(Window window);
  void set_plane_metric(double dx_m, double dy_m);
  void finish();

  Topology topology_;
  Edges edges_;
  int nx_, ny_;
  Ellipsoid figure_;
  Window window_{};
  std::optional<Centre> centre_;
  bool latitude_longitude_ = false;
  std::array<double, 3> turn_{};
  std::array<std::array<double, 3>, 3> turned_axes_{};  // x, y, z of the axis' frame, turned
  bool is_turned_ = false;
  double step_north_m_ = 0.0;
  double total_area_m2_ = 0.0;
  std::vector<double> area_m2_, spacing_east_m_, face_east_m_, face_north_m_;
  std::vector<std::array<double, kDirections>> distance_m_;
  std::vector<double> latitude_deg_, longitude_deg_;
  std::vector<double> cell_latitude_deg_, cell_longitude_deg_;  // projected grids
  std::vector<double> sin_lat_, cos_lat_, sin_lon_, cos_lon_;
};

}  // namespace geo
