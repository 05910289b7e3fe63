#include <omp.h>
#include <pybind11/stl.h>

#include <string>

#include "calibration/calibrate.hpp"
#include "configuration.hpp"
#include "listener.hpp"
#include "module.hpp"

namespace terrane::python {

namespace py = pybind11;

namespace {

using geo::calibration::Curve;
using geo::calibration::FittedParameter;
using geo::calibration::Result;
using geo::calibration::SeedMisfit;

Result fit(Configuration& configuration, const std::string& target, const std::string& folder,
           const std::string& name, bool resume, bool overwrite, bool allow_other_build,
           py::object tell) {
  Listener listener(std::move(tell));
  const geo::calibration::Watch watch{
      .info = [&](std::string_view text) { listener.tell("info", text, 0.0); },
      .iteration =
          [&](const geo::calibration::Iteration& step) {
            listener.tell("iteration", std::to_string(step.number), step.wasserstein_m);
          },
      .stop = listener.stop()};
  return listener.run([&] {
    return geo::calibration::calibrate({.target = target,
                                        .preset_or_config = name,
                                        .folder = folder,
                                        .configuration = configuration.parameters(),
                                        .events = configuration.settings.events,
                                        .settings = configuration.calibration,
                                        .resume = resume,
                                        .overwrite = overwrite,
                                        .allow_other_build = allow_other_build},
                                       watch);
  });
}

}  // namespace

void add_calibration(py::module_& module) {
  py::class_<FittedParameter>(module, "FittedParameter", "One free parameter, before and after.")
      .def_readonly("name", &FittedParameter::name)
      .def_readonly("units", &FittedParameter::units)
      .def_readonly("start", &FittedParameter::start)
      .def_readonly("fitted", &FittedParameter::fitted)
      .def_readonly("minimum", &FittedParameter::low)
      .def_readonly("maximum", &FittedParameter::high)
      .def_readonly("at_bound", &FittedParameter::at_bound)
      .def_readonly("standard_error", &FittedParameter::standard_error)
      .def_readonly("seed_error", &FittedParameter::seed_error)
      .def("__repr__", [](const FittedParameter& p) {
        return "<" + p.name + " = " + std::to_string(p.fitted) + " +- " +
               std::to_string(p.standard_error) + " " + p.units + ">";
      });
  py::class_<Curve>(module, "Curve", "A hypsometric curve by bins of equal area.")
      .def_readonly("elevation_m", &Curve::elevation_m)
      .def_property_readonly("share", [](const Curve& curve) {
        std::vector<double> shares;
        for (std::size_t k = 0; k < curve.elevation_m.size(); ++k) shares.push_back(curve.share(k));
        return shares;
      });
  py::class_<SeedMisfit>(module, "SeedMisfit", "Distance of one planet from the target, m.")
      .def_readonly("seed", &SeedMisfit::seed)
      .def_readonly("before_m", &SeedMisfit::before_m)
      .def_readonly("after_m", &SeedMisfit::after_m);
  py::class_<Result>(module, "Calibration", "All that a calibration found.")
      .def_readonly("target_name", &Result::target_name)
      .def_readonly("converged", &Result::converged)
      .def_readonly("ending", &Result::ending)
      .def_readonly("warnings", &Result::warnings)
      .def_readonly("parameters", &Result::parameters)
      .def_readonly("correlation", &Result::correlation)
      .def_readonly("target", &Result::target)
      .def_readonly("before", &Result::before)
      .def_readonly("after", &Result::after)
      .def_readonly("fitted", &Result::fitted)
      .def_readonly("held_out", &Result::held_out)
      .def_readonly("held_out_resolution", &Result::held_out_resolution)
      .def_readonly("cost_before", &Result::cost_before)
      .def_readonly("cost_after", &Result::cost_after)
      .def_readonly("seconds", &Result::seconds)
      .def_property_readonly("failure", &geo::calibration::failure_of,
                             "Why the target was not reached; empty when it was.");
  module.def("calibrate", &fit, py::arg("configuration"), py::arg("target"), py::arg("folder"),
             py::arg("name"), py::arg("resume"), py::arg("overwrite"), py::arg("allow_other_build"),
             py::arg("tell"));
}

}  // namespace terrane::python
