#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/core/state.hpp"

namespace terrane::python {

namespace py = pybind11;

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

/// A read-only array over values that somebody else may hold too; nothing is copied.
py::array view_of(const std::shared_ptr<const geo::Values>& values, const geo::Grid& grid);

/// An array that takes a vector over; nothing is copied.
template <class T>
py::array_t<T> array_of(std::vector<T> values, std::vector<py::ssize_t> shape) {
  auto* const kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* held) { delete static_cast<std::vector<T>*>(held); });
  return py::array_t<T>(std::move(shape), kept->data(), owner);
}
/// The same in the shape of a grid.
template <class T>
py::array_t<T> array_on(const geo::Grid& grid, std::vector<T> values) {
  return array_of(std::move(values), {grid.ny(), grid.nx()});
}

/// Throws InputError that names the array unless its shape is (ny, nx).
void check_shape(const geo::Grid& grid, const py::array& array, const char* name);
/// The values of an array in the shape (ny, nx) of a grid. Throws InputError that names it.
template <class T>
std::span<const T> values_on(const geo::Grid& grid, const Array<T>& array, const char* name) {
  check_shape(grid, array, name);
  return {array.data(), static_cast<std::size_t>(grid.size())};
}

}  // namespace terrane::python
