// SPDX-License-Identifier: BSD-3-Clause
//
// Coordinates of curved grids as arrays that share the library's memory.
#pragma once

#include <memory>

#include "binding.hpp"
#include "tegl/grid.hpp"

namespace tegl::python {

/// `columns` numbers of each sample from `first_column` on, as an array of #samples x columns, or of #samples for 0
/// columns. It keeps the memory.
inline py::array array_of_points(const CurvedPoints& points, std::size_t first_column, std::size_t columns) {
  auto kept = std::make_unique<CurvedPoints>(points);
  const py::capsule owner(kept.release(), [](void* own) { delete static_cast<CurvedPoints*>(own); });
  const auto array = [&]<class T>(const T* first) -> py::array {
    const auto bytes = static_cast<py::ssize_t>(sizeof(T));
    std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(points.size())};
    std::vector<py::ssize_t> strides = {bytes * static_cast<py::ssize_t>(points.pitch())};
    if (columns > 0) {
      shape.push_back(static_cast<py::ssize_t>(columns));
      strides.push_back(bytes);
    }
    return py::array(py::dtype::of<T>(), shape, strides, first + first_column, owner);
  };
  return points.floats() != nullptr ? array(points.floats()) : array(points.doubles());
}

/// A curved coordinate as an array of #coordinates, of float if it is stored so. It keeps the memory of points.
inline py::array coordinates_of(const CurvedAxis& one) {
  if (!one.values.empty()) return py::array_t<double>(static_cast<py::ssize_t>(one.values.size()), one.values.data());
  return array_of_points(one.points, one.column, 0);
}

}  // namespace tegl::python
