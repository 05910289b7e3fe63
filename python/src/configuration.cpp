#include "configuration.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/config/presets.hpp"
#include "module.hpp"

namespace terrane::python {

namespace py = pybind11;

namespace {

std::vector<std::string> texts_of(const std::vector<std::string_view>& words) {
  return {words.begin(), words.end()};
}

std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

const geo::Parameter& row_of(const Configuration& configuration, const std::string& name) {
  const auto& rows = configuration.all_parameters();
  if (const geo::Parameter* row = geo::find_parameter(rows, name)) return *row;
  if (const geo::Parameter* today = geo::find_renamed(rows, name)) {
    throw geo::ConfigurationError(name + " is now " + std::string(today->name));
  }
  std::vector<std::string_view> names;
  for (const geo::Parameter& row : rows) names.push_back(row.name);
  throw geo::ConfigurationError("unknown parameter " + name + geo::io::suggestion(name, names));
}

/// A value as Python has it; of a list its entries with commas between.
geo::ParameterValue value_of(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (PyIndex_Check(value.ptr()) != 0) return value.cast<std::int64_t>();
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    return py::str(",")
        .attr("join")(py::module_::import("builtins").attr("map")(py::type::of(py::str()), value))
        .cast<std::string>();
  }
  if (py::hasattr(value, "__fspath__")) return value.attr("__fspath__")().cast<std::string>();
  if (py::hasattr(value, "__float__"))
    return py::float_(py::reinterpret_borrow<py::object>(value)).cast<double>();
  throw geo::ConfigurationError("a value must be a number, a truth value, a text or a list, not " +
                                py::str(py::type::handle_of(value)).cast<std::string>());
}

std::unique_ptr<Configuration> make(const std::string& preset, const std::string& config,
                                    const std::string& dem) {
  auto configuration = std::make_unique<Configuration>();
  ConfigurationSources sources;
  sources.preset = preset;
  sources.config = config;
  sources.dem = dem;
  configuration->take(sources);
  return configuration;
}

/// All values as TOML, read back into another.
std::unique_ptr<Configuration> copy_of(const Configuration& other) {
  auto copy = std::make_unique<Configuration>();
  geo::io::apply_toml(geo::io::write_config(other.all_parameters(), "copy", other.settings.events),
                      "configuration", copy->all_parameters(), &copy->settings.events);
  return copy;
}

}  // namespace

void add_configuration(py::module_& module) {
  using geo::Parameter;
  py::class_<Parameter>(module, "ParameterInfo",
                        "What a parameter is: unit, range, meaning, source.")
      .def_property_readonly("name", [](const Parameter& p) { return std::string(p.name); })
      .def_property_readonly("units", [](const Parameter& p) { return std::string(p.units); })
      .def_property_readonly("type", [](const Parameter& p) { return std::string(p.type_name()); })
      .def_property_readonly("minimum", [](const Parameter& p) { return finite(p.min); })
      .def_property_readonly("maximum", [](const Parameter& p) { return finite(p.max); })
      .def_property_readonly("choices", [](const Parameter& p) { return texts_of(p.choices); })
      .def_property_readonly("range", &Parameter::range_text)
      .def_property_readonly("doc", [](const Parameter& p) { return std::string(p.doc); })
      .def_property_readonly("source", [](const Parameter& p) { return std::string(p.source); })
      .def_readonly("default", &Parameter::default_value)
      .def("__repr__", [](const Parameter& p) {
        return "<" + std::string(p.name) + " [" + std::string(p.units) + "] " +
               std::string(p.type_name()) + " " + p.range_text() + ": " + std::string(p.doc) + ">";
      });
  py::class_<Configuration>(module, "Configuration")
      .def(py::init(&make), py::arg("preset") = "", py::arg("config") = "", py::arg("dem") = "")
      .def("copy", &copy_of)
      .def("get",
           [](const Configuration& c, const std::string& name) { return row_of(c, name).value(); })
      .def("set", [](const Configuration& c, const std::string& name,
                     const py::object& value) { row_of(c, name).set(value_of(value)); })
      .def("assign",
           [](const Configuration& c, const std::string& assignment) {
             geo::io::apply_assignment(assignment, c.all_parameters());
           })
      .def("apply_toml",
           [](Configuration& c, const std::string& text, const std::string& name) {
             geo::io::apply_toml(text, name, c.all_parameters(), &c.settings.events);
           })
      .def(
          "info", [](const Configuration& c, const std::string& name) { return &row_of(c, name); },
          py::return_value_policy::reference_internal)
      .def("names",
           [](const Configuration& c) {
             std::vector<std::string> names;
             for (const Parameter& row : c.all_parameters()) names.emplace_back(row.name);
             return names;
           })
      .def("to_toml", [](const Configuration& c) {
        return geo::io::write_config(c.all_parameters(), "terrane: every parameter",
                                     c.settings.events);
      });
  module.def("presets", [] {
    std::vector<std::pair<std::string, std::string>> presets;
    for (const auto& preset : geo::io::presets()) presets.emplace_back(preset.name, preset.summary);
    return presets;
  });
}

}  // namespace terrane::python
