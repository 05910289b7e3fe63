#include "arrays.hpp"

#include <fmt/format.h>

#include <variant>

#include "geo/core/error.hpp"

namespace terrane::python {

void check_shape(const geo::Grid& grid, const py::array& array, const char* name) {
  if (array.ndim() == 2 && array.shape(0) == grid.ny() && array.shape(1) == grid.nx()) return;
  std::string shape;
  for (py::ssize_t axis = 0; axis < array.ndim(); ++axis) {
    shape += fmt::format("{}{}", axis == 0 ? "" : ", ", array.shape(axis));
  }
  throw geo::InputError(
      fmt::format("{}: has shape ({}): must be ({}, {}), the rows and columns of the grid", name,
                  shape, grid.ny(), grid.nx()));
}

py::array view_of(const std::shared_ptr<const geo::Values>& values, const geo::Grid& grid) {
  return std::visit(
      [&]<class T>(const std::vector<T>& held) -> py::array {
        auto* const kept = new std::shared_ptr<const geo::Values>(values);
        const py::capsule owner(
            kept, [](void* p) { delete static_cast<std::shared_ptr<const geo::Values>*>(p); });
        py::array_t<T> array({grid.ny(), grid.nx()}, held.data(), owner);
        array.attr("flags").attr("writeable") = false;
        return array;
      },
      *values);
}

}  // namespace terrane::python
