#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/io/netcdf/planet_file.hpp"
#include "geo/io/run/memory_run.hpp"
#include "geo/io/score/scorecard.hpp"
#include "module.hpp"

namespace terrane::python {

namespace py = pybind11;

namespace {

using geo::io::Scorecard;
using geo::io::ScoreLine;
using geo::io::StageInMemory;

/// The fields of all stages of a planet; of several the last.
geo::State planet_of(const std::vector<const StageInMemory*>& stages) {
  if (stages.empty()) throw geo::ConfigurationError("score: the planet has no stage");
  geo::State state(stages.front()->snapshot.grid);
  for (const StageInMemory* stage : stages) {
    if (stage->snapshot.grid != state.shared_grid()) continue;  // an island
    for (const auto& [spec, values] : stage->snapshot.fields) state.share(*spec, values);
  }
  return state;
}

}  // namespace

void add_score(py::module_& module) {
  py::class_<ScoreLine>(module, "Figure", "One figure of a planet beside Earth's.")
      .def_readonly("group", &ScoreLine::group)
      .def_readonly("name", &ScoreLine::name)
      .def_readonly("words", &ScoreLine::words)
      .def_readonly("units", &ScoreLine::unit)
      .def_readonly("value", &ScoreLine::value)
      .def_readonly("earth", &ScoreLine::earth)
      .def_readonly("tolerance", &ScoreLine::tolerance)
      .def_readonly("is_judged", &ScoreLine::judged)
      .def_readonly("source", &ScoreLine::source)
      .def_property_readonly("is_within", &ScoreLine::within)
      .def("__repr__", [](const ScoreLine& line) {
        return "<" + line.words + ": " + py::str(py::float_(line.value)).cast<std::string>() + " " +
               line.unit + (line.within() ? "" : ", outside") + ">";
      });
  py::class_<Scorecard>(module, "Scorecard", "A planet's figures.")
      .def_readonly("figures", &Scorecard::lines)
      .def_readonly("left_out", &Scorecard::left_out)
      .def_property_readonly("within", &Scorecard::count_within)
      .def("__len__", [](const Scorecard& card) { return card.lines.size(); })
      .def("__getitem__",
           [](const Scorecard& card, const std::string& name) {
             for (const ScoreLine& line : card.lines) {
               if (line.name == name) return line;
             }
             throw py::key_error(name);
           })
      .def("__repr__", [](const Scorecard& card) {
        return "<Scorecard: " + std::to_string(card.count_within()) + " of " +
               std::to_string(card.lines.size()) + " figures within tolerance>";
      });
  module.def("score_file", [](const std::string& place) {
    const py::gil_scoped_release unlocked;
    return geo::io::score_planet(geo::io::read_planet_or_dem(place, geo::io::scorecard_fields()));
  });
  module.def("score_stages", [](const std::vector<const StageInMemory*>& stages) {
    const auto planet = planet_of(stages);
    const py::gil_scoped_release unlocked;
    return geo::io::score_planet(planet);
  });
}

}  // namespace terrane::python
