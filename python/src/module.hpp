#pragma once

#include <pybind11/pybind11.h>

namespace terrane::python {

// Each adds a part of the module, in an order in which types stand before their use.
void add_errors(pybind11::module_& module);
void add_fields(pybind11::module_& module);
void add_grid(pybind11::module_& module);
void add_configuration(pybind11::module_& module);
void add_runs(pybind11::module_& module);
void add_score(pybind11::module_& module);
void add_calibration(pybind11::module_& module);
void add_kernels(pybind11::module_& module);

}  // namespace terrane::python
