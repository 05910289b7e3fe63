#include <pybind11/stl.h>

#include <cmath>
#include <optional>
#include <string>

#include "geo/core/field.hpp"
#include "module.hpp"

namespace terrane::python {

namespace py = pybind11;

namespace {

std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

const char* numpy_name(geo::Type type) {
  switch (type) {
    case geo::Type::float32:
      return "float32";
    case geo::Type::float64:
      return "float64";
    case geo::Type::int8:
      return "int8";
    case geo::Type::int16:
      return "int16";
    case geo::Type::int32:
      return "int32";
  }
  return "";
}

}  // namespace

void add_fields(py::module_& module) {
  using geo::FieldSpec;
  py::class_<FieldSpec>(module, "Field", "One row of the vocabulary of fields.")
      .def_property_readonly("name", [](const FieldSpec& f) { return std::string(f.name); })
      .def_property_readonly("units", [](const FieldSpec& f) { return std::string(f.units); })
      .def_property_readonly("standard_name",
                             [](const FieldSpec& f) { return std::string(f.standard_name); })
      .def_property_readonly("long_name", [](const FieldSpec& f) { return std::string(f.doc); })
      .def_property_readonly("dtype", [](const FieldSpec& f) { return numpy_name(f.type); })
      .def_property_readonly("cell_methods",
                             [](const FieldSpec& f) { return std::string(f.cell_methods); })
      .def_readonly("missing", &FieldSpec::missing)
      .def_property_readonly("minimum", [](const FieldSpec& f) { return finite(f.least); })
      .def_property_readonly("maximum", [](const FieldSpec& f) { return finite(f.most); })
      .def_property_readonly("flags",
                             [](const FieldSpec& f) {
                               py::dict flags;
                               for (const geo::Flag& flag : f.flags)
                                 flags[py::str(std::string(flag.meaning))] = flag.value;
                               return flags;
                             })
      .def("__repr__", [](const FieldSpec& f) {
        return "<Field " + std::string(f.name) + " [" + std::string(f.units) + "]>";
      });
  module.def("fields", [] {
    py::list rows;
    for (const FieldSpec* field : geo::field::all()) {
      rows.append(py::cast(field, py::return_value_policy::reference));
    }
    return rows;
  });
}

}  // namespace terrane::python
