#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "geo/core/error.hpp"
#include "geo/kernels/landscape/stream_power.hpp"
#include "geo/kernels/numerics/diffusion.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/flow_graph.hpp"
#include "geo/kernels/water/multiple_flow.hpp"
#include "module.hpp"

namespace terrane::python {
namespace {

using geo::Grid;
using geo::Index;
using Bytes = Array<std::uint8_t>;
template <class T>
using Given = std::optional<Array<T>>;

/// Outlets that were given, or the sea and the open edge.
std::vector<std::uint8_t> outlets_of(const Grid& grid, std::span<const float> elevation_m,
                                     const Given<std::uint8_t>& outlets, float sea_level_m) {
  if (!outlets) return geo::find_outlets(grid, elevation_m, sea_level_m);
  const auto given = values_on<std::uint8_t>(grid, *outlets, "outlets");
  return {given.begin(), given.end()};
}

/// A forest that was given by its receivers. Throws InputError where one is no cell, or where they
/// go round in a circle.
geo::FlowGraph graph_of(const Grid& grid, const Array<Index>& receiver) {
  const auto given = values_on<Index>(grid, receiver, "receiver");
  for (const Index to : given) {
    if (to >= 0 && to < grid.size()) continue;
    throw geo::InputError(fmt::format(
        "receiver: holds {}: must be the flat index of a cell, 0 to {}", to, grid.size() - 1));
  }
  geo::FlowGraph graph;
  graph.receiver.assign(given.begin(), given.end());
  try {
    graph.put_in_order();
  } catch (const geo::Bug&) {
    throw geo::InputError(
        "receiver: water goes round in a circle: every cell must drain to a root");
  }
  return graph;
}

py::tuple route(const Grid& grid, const Array<float>& elevation, const Given<std::uint8_t>& outlets,
                float sea_level_m) {
  const auto elevation_m = values_on<float>(grid, elevation, "elevation");
  geo::Routing routing;
  {
    const py::gil_scoped_release unlocked;
    const auto ends = outlets_of(grid, elevation_m, outlets, sea_level_m);
    routing = geo::route_water(grid, elevation_m, ends, true);
  }
  return py::make_tuple(array_on(grid, std::move(routing.graph.receiver)),
                        array_of(std::move(routing.graph.order), {grid.size()}),
                        array_on(grid, std::move(routing.filled_m)));
}

py::array_t<float> fill(const Grid& grid, const Array<float>& elevation,
                        const Given<std::uint8_t>& outlets, float sea_level_m) {
  const auto elevation_m = values_on<float>(grid, elevation, "elevation");
  std::vector<float> filled_m(grid.size());
  {
    const py::gil_scoped_release unlocked;
    const auto ends = outlets_of(grid, elevation_m, outlets, sea_level_m);
    geo::fill_depressions(grid, elevation_m, ends, filled_m);
  }
  return array_on(grid, std::move(filled_m));
}

geo::FlowMethod method_of(const std::string& word) {
  if (word == "steepest") return geo::FlowMethod::steepest;
  if (word == "multiple") return geo::FlowMethod::multiple;
  if (word == "d_infinity") return geo::FlowMethod::d_infinity;
  throw geo::ConfigurationError(
      fmt::format("method = {}: must be steepest, multiple or d_infinity", word));
}

py::array_t<double> accumulate(const Grid& grid, const Array<float>& surface,
                               const Array<Index>& receiver, const Given<double>& source,
                               const std::string& method, double exponent) {
  const auto surface_m = values_on<float>(grid, surface, "surface");
  const auto graph = graph_of(grid, receiver);
  const geo::FlowPartition partition{.method = method_of(method), .exponent = exponent};
  std::vector<double> values(grid.size());
  if (source) {
    const auto given = values_on<double>(grid, *source, "source");
    values.assign(given.begin(), given.end());
  } else {
    for (Index cell = 0; cell < grid.size(); ++cell) values[cell] = grid.area_m2(grid.row(cell));
  }
  {
    const py::gil_scoped_release unlocked;
    if (partition.method == geo::FlowMethod::steepest) {
      graph.accumulate(values);
    } else {
      for (Index cell = 0; cell < grid.size(); ++cell) {
        if (surface_m[graph.receiver[cell]] <= surface_m[cell]) continue;
        throw geo::InputError(
            "surface: climbs from a cell to its receiver: must be the filled surface of `route`");
      }
      geo::accumulate_flow(grid, surface_m, graph.receiver, partition, values);
    }
  }
  return array_on(grid, std::move(values));
}

py::array_t<float> incise(const Grid& grid, const Array<float>& elevation,
                          const Array<Index>& receiver, const Array<double>& area,
                          const Array<float>& erodibility, double dt_yr, double area_exponent,
                          double slope_exponent, double sea_level_m) {
  const auto before = values_on<float>(grid, elevation, "elevation");
  const auto area_m2 = values_on<double>(grid, area, "area");
  std::span<const float> factor{erodibility.data(), 1};
  if (erodibility.size() != 1) factor = values_on<float>(grid, erodibility, "erodibility");
  if (!(dt_yr >= 0.0) || !(slope_exponent > 0.0)) {
    throw geo::InputError("incise: dt_yr must not be negative, slope_exponent must be positive");
  }
  const auto graph = graph_of(grid, receiver);
  std::vector<float> elevation_m(before.begin(), before.end());
  {
    const py::gil_scoped_release unlocked;
    geo::incise<float, float>(grid, graph, area_m2, factor,
                              {.area_exponent = area_exponent,
                               .slope_exponent = slope_exponent,
                               .dt_yr = dt_yr,
                               .sea_level_m = sea_level_m},
                              elevation_m);
  }
  return array_on(grid, std::move(elevation_m));
}

py::array_t<double> diffuse(const Grid& grid, const Array<double>& field, double diffusivity_m2_yr,
                            double dt_yr, const Given<std::uint8_t>& fixed,
                            const Given<std::uint8_t>& excluded, bool is_positive) {
  const auto before = values_on<double>(grid, field, "field");
  std::vector<double> values(before.begin(), before.end());
  geo::DiffusionOptions options;
  if (fixed) options.fixed = values_on<std::uint8_t>(grid, *fixed, "fixed");
  if (excluded) options.excluded = values_on<std::uint8_t>(grid, *excluded, "excluded");
  if (is_positive) options.scheme = geo::DiffusionScheme::positive;
  {
    const py::gil_scoped_release unlocked;
    geo::diffuse(grid, std::span(values), diffusivity_m2_yr, dt_yr, options);
  }
  return array_on(grid, std::move(values));
}

}  // namespace

void add_kernels(py::module_& module) {
  module.def("route", &route, py::arg("grid"), py::arg("elevation"), py::arg("outlets"),
             py::arg("sea_level_m"));
  module.def("fill", &fill, py::arg("grid"), py::arg("elevation"), py::arg("outlets"),
             py::arg("sea_level_m"));
  module.def("accumulate", &accumulate, py::arg("grid"), py::arg("surface"), py::arg("receiver"),
             py::arg("source"), py::arg("method"), py::arg("exponent"));
  module.def("incise", &incise, py::arg("grid"), py::arg("elevation"), py::arg("receiver"),
             py::arg("area"), py::arg("erodibility"), py::arg("dt_yr"), py::arg("area_exponent"),
             py::arg("slope_exponent"), py::arg("sea_level_m"));
  module.def("diffuse", &diffuse, py::arg("grid"), py::arg("field"), py::arg("diffusivity_m2_yr"),
             py::arg("dt_yr"), py::arg("fixed"), py::arg("excluded"), py::arg("is_positive"));
}

}  // namespace terrane::python
