// The extension under the Python package: types and functions, documented in terrane/*.py.
#include "module.hpp"

#include <pybind11/stl.h>

#include "geo/core/error.hpp"
#include "geo/io/config/presets.hpp"
#include "geo/io/files/build_info.hpp"

namespace terrane::python {

namespace py = pybind11;

void add_errors(py::module_& module) {
  // Later ones are asked first: those of a kind of their own stand behind the general one.
  static const py::exception<geo::Error> base(module, "Error", PyExc_RuntimeError);
  py::register_exception<geo::ConfigurationError>(
      module, "ConfigurationError",
      py::make_tuple(base, py::reinterpret_borrow<py::object>(PyExc_ValueError)));
  py::register_exception<geo::InputError>(
      module, "InputError",
      py::make_tuple(base, py::reinterpret_borrow<py::object>(PyExc_ValueError)));
  py::register_exception<geo::IoError>(
      module, "FileError", py::make_tuple(base, py::reinterpret_borrow<py::object>(PyExc_OSError)));
  py::register_exception_translator([](std::exception_ptr raised) {
    try {
      if (raised) std::rethrow_exception(raised);
    } catch (const geo::ConfigurationError&) {
      throw;
    } catch (const geo::InputError&) {
      throw;
    } catch (const geo::IoError&) {
      throw;
    } catch (const geo::Interrupted&) {
      PyErr_SetNone(PyExc_KeyboardInterrupt);
    } catch (const geo::Error& error) {
      PyErr_SetString(base.ptr(), error.what());
    }
  });
}

}  // namespace terrane::python

PYBIND11_MODULE(_core, module) {
  using namespace terrane::python;
  module.doc() = "The extension under the package terrane.";
  add_errors(module);
  add_fields(module);
  add_grid(module);
  add_configuration(module);
  add_runs(module);
  add_score(module);
  add_calibration(module);
  add_kernels(module);
  const auto& build = geo::io::build_info();
  module.attr("__version__") = build.version;
  module.attr("__commit__") = build.commit;
}
