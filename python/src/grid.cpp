#include "geo/core/grid.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>

#include "arrays.hpp"
#include "geo/core/error.hpp"
#include "module.hpp"

namespace terrane::python {
namespace {

using geo::Grid;

geo::Edges edges_of(const std::string& word) {
  if (word == "open") return geo::Edges::open;
  if (word == "closed") return geo::Edges::closed;
  throw geo::ConfigurationError(fmt::format("edges = {}: must be open or closed", word));
}

const char* topology_of(const Grid& grid) {
  switch (grid.topology()) {
    case geo::Topology::sphere:
      return "sphere";
    case geo::Topology::plane:
      return "plane";
    case geo::Topology::torus:
      return "torus";
  }
  return "";
}

/// One value for each row or column.
template <class Function>
py::array_t<double> along(int count, const Function& value) {
  std::vector<double> values(count);
  for (int k = 0; k < count; ++k) values[k] = value(k);
  return array_of(std::move(values), {count});
}

/// One value for each cell.
template <class Function>
py::array_t<double> over(const Grid& grid, const Function& value) {
  std::vector<double> values(grid.size());
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) values[grid.cell(i, j)] = value(i, j);
  }
  return array_on(grid, std::move(values));
}

using GridClass = py::class_<Grid, std::shared_ptr<Grid>>;

void add_topologies(GridClass& grid) {
  grid.def_static(
          "sphere",
          [](int nx, int ny, double radius_m, double flattening) {
            return std::make_shared<Grid>(Grid::sphere(nx, ny, {radius_m, flattening}));
          },
          py::arg("nx"), py::arg("ny"), py::arg("radius_m") = 6371e3, py::arg("flattening") = 0.0,
          "The whole planet: latitudes ascending, longitudes from -180; `nx` must be even.")
      .def_static(
          "plane",
          [](int nx, int ny, double dx_m, double dy_m, const std::string& edges) {
            return std::make_shared<Grid>(Grid::plane(nx, ny, dx_m, dy_m, edges_of(edges)));
          },
          py::arg("nx"), py::arg("ny"), py::arg("dx_m"), py::arg("dy_m"), py::arg("edges") = "open",
          "A flat rectangle; water and rock leave at open edges.")
      .def_static(
          "torus",
          [](int nx, int ny, double dx_m, double dy_m) {
            return std::make_shared<Grid>(Grid::torus(nx, ny, dx_m, dy_m));
          },
          py::arg("nx"), py::arg("ny"), py::arg("dx_m"), py::arg("dy_m"),
          "A flat rectangle whose opposite edges meet.");
}

void add_figures(GridClass& grid) {
  grid.def_property_readonly("nx", &Grid::nx)
      .def_property_readonly("ny", &Grid::ny)
      .def_property_readonly("shape", [](const Grid& g) { return py::make_tuple(g.ny(), g.nx()); })
      .def_property_readonly("topology", &topology_of)
      .def_property_readonly("is_latitude_longitude", &Grid::is_latitude_longitude)
      .def_property_readonly("is_projected", &Grid::is_projected)
      .def_property_readonly("is_geographic", &Grid::is_geographic)
      .def_property_readonly("radius_m", [](const Grid& g) { return g.figure().radius_m; })
      .def_property_readonly("flattening", [](const Grid& g) { return g.figure().flattening; })
      .def_property_readonly("centre",
                             [](const Grid& g) -> py::object {
                               if (!g.centre()) return py::none();
                               return py::make_tuple(g.centre()->latitude_deg,
                                                     g.centre()->longitude_deg);
                             })
      .def_property_readonly("cell_size_m", [](const Grid& g) {
        return py::make_tuple(g.spacing_east_m(g.ny() / 2), g.step_north_m());
      });
}

void add_arrays(GridClass& grid) {
  grid.def_property_readonly(
          "row_area_m2",
          [](const Grid& g) { return along(g.ny(), [&](int j) { return g.area_m2(j); }); },
          "Area of each cell of a row, m2.")
      .def_property_readonly(
          "latitude",
          [](const Grid& g) { return along(g.ny(), [&](int j) { return g.latitude_deg(j); }); })
      .def_property_readonly(
          "longitude",
          [](const Grid& g) { return along(g.nx(), [&](int i) { return g.longitude_deg(i); }); })
      .def_property_readonly(
          "x_m", [](const Grid& g) { return along(g.nx(), [&](int i) { return g.x_m(i); }); })
      .def_property_readonly(
          "y_m", [](const Grid& g) { return along(g.ny(), [&](int j) { return g.y_m(j); }); })
      .def_property_readonly("cell_latitude",
                             [](const Grid& g) {
                               return over(
                                   g, [&](int i, int j) { return g.position(i, j).latitude_deg; });
                             })
      .def_property_readonly("cell_longitude",
                             [](const Grid& g) {
                               return over(
                                   g, [&](int i, int j) { return g.position(i, j).longitude_deg; });
                             })
      .def("__repr__", [](const Grid& g) {
        return fmt::format("<Grid {} of {} x {} cells>", topology_of(g), g.nx(), g.ny());
      });
}

}  // namespace

void add_grid(py::module_& module) {
  GridClass grid(module, "Grid", "Cell-centred raster; row 0 is the southernmost.");
  add_topologies(grid);
  add_figures(grid);
  add_arrays(grid);
}

}  // namespace terrane::python
