// SPDX-License-Identifier: BSD-3-Clause
//
// Contours in Python: arrays are views into the memory of the library's contour, which they keep alive.
#include <fmt/format.h>

#include <algorithm>

#include "binding.hpp"
#include "docs.hpp"
#include "tegl/periodic.hpp"
#include "tegl/slice.hpp"

namespace tegl::python {

py::dict attribute_arrays(const std::vector<Attribute>& attributes, py::handle owner) {
  py::dict result;
  for (const Attribute& attribute : attributes) {
    const auto width = static_cast<py::ssize_t>(attribute.width);
    const auto rows = static_cast<py::ssize_t>(attribute.values.size()) / std::max<py::ssize_t>(width, 1);
    std::vector<py::ssize_t> shape{rows};
    if (width != 1) shape.push_back(width);
    result[py::str(attribute.name)] =
        py::make_tuple(read_only(attribute.values.data(), std::move(shape), owner), attribute.unit);
  }
  return result;
}

namespace {

template <class T, std::size_t Width>
py::array matrix(const Buffer<std::array<T, Width>>& rows, py::handle owner) {
  return read_only(rows.empty() ? nullptr : rows.data()->data(),
                   {static_cast<py::ssize_t>(rows.size()), static_cast<py::ssize_t>(Width)}, owner);
}

const AnyContour& held(py::handle self) { return py::cast<const AnyContour&>(self); }

template <class F>
auto of_contour(F f) {
  return [f](py::object self) { return std::visit([&](const auto& c) { return f(c, self); }, held(self).contour); };
}

/// Attributes as given by Python: (name, unit, values of #rows x width) each.
using AttributeArguments =
    std::vector<std::tuple<std::string, std::string, py::array_t<double, py::array::c_style | py::array::forcecast>>>;

std::vector<Attribute> to_attributes(const AttributeArguments& arguments, std::size_t rows, const char* of) {
  std::vector<Attribute> result;
  for (const auto& [name, unit, values] : arguments) {
    if (values.ndim() < 1 || values.ndim() > 2 || static_cast<std::size_t>(values.shape(0)) != rows)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("attribute '{}' has {} rows in {} dimensions; expected {}, one for each of the {}", name,
                              values.ndim() > 0 ? values.shape(0) : 0, values.ndim(), rows, of));
    Attribute attribute{name, unit, values.ndim() == 2 ? static_cast<int>(values.shape(1)) : 1, {}};
    attribute.values.assign(values.data(), values.data() + values.size());
    result.push_back(std::move(attribute));
  }
  return result;
}

template <class T, std::size_t Width, class Array>
Buffer<std::array<T, Width>> copied(const Array& rows) {
  Buffer<std::array<T, Width>> result(static_cast<std::size_t>(rows.shape(0)));
  if (!result.empty()) std::copy_n(rows.data(), static_cast<std::size_t>(rows.size()), result.data()->data());
  return result;
}

void require_rows(const char* what, const py::array& rows, py::ssize_t width) {
  if (rows.ndim() != 2 || rows.shape(1) != width)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} have {} dimensions and {} columns; expected rows of {} numbers", what, rows.ndim(),
                            rows.ndim() == 2 ? rows.shape(1) : 0, width));
}

template <class Real>
using Rows = py::array_t<Real, py::array::c_style | py::array::forcecast>;

template <int N, class Real>
AnyContour contour_of(const py::array& vertices, const Rows<Index>& simplices,
                      const std::optional<py::array>& normals) {
  Contour<N, Real> contour;
  require_rows("vertices", vertices, N);
  require_rows("simplices", simplices, N);
  contour.vertices = copied<Real, N>(Rows<Real>(vertices));
  contour.simplices = copied<Index, N>(simplices);
  if (normals) {
    require_rows("normals", *normals, N);
    if (normals->shape(0) != vertices.shape(0))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("{} normals; expected {}, one for each vertex", normals->shape(0), vertices.shape(0)));
    contour.normals = copied<Real, N>(Rows<Real>(*normals));
  }
  return {std::move(contour), std::nullopt};
}

template <class Real>
AnyContour contour_of(int dim, const py::array& vertices, const Rows<Index>& simplices,
                      const std::optional<py::array>& normals) {
  if (dim == 2) return contour_of<2, Real>(vertices, simplices, normals);
  if (dim == 3) return contour_of<3, Real>(vertices, simplices, normals);
  if (dim == 4) return contour_of<4, Real>(vertices, simplices, normals);
  if (dim == 5) return contour_of<5, Real>(vertices, simplices, normals);
  throw Error(ErrorCode::InvalidArgument,
              fmt::format("vertices and simplices have rows of {} numbers; expected 2 to 5", dim));
}

std::unique_ptr<AnyContour> from_arrays(const py::array& vertices, const Rows<Index>& simplices,
                                        const std::optional<py::array>& normals,
                                        const std::vector<std::string>& axis_names,
                                        const std::vector<std::string>& axis_units, const std::string& direction,
                                        std::optional<double> isovalue, const AttributeArguments& vertex_attributes,
                                        const AttributeArguments& simplex_attributes,
                                        const std::vector<double>& periods) {
  const int dim = vertices.ndim() == 2 ? static_cast<int>(vertices.shape(1)) : 0;
  const bool is_double = py::isinstance<py::array_t<double>>(vertices);
  auto result = std::make_unique<AnyContour>(is_double ? contour_of<double>(dim, vertices, simplices, normals)
                                                       : contour_of<float>(dim, vertices, simplices, normals));
  result->isovalue = isovalue;
  std::visit(
      [&]<int N, class Real>(Contour<N, Real>& contour) {
        for (std::size_t a = 0; a < contour.axis_names.size(); ++a) {
          if (a < axis_names.size()) contour.axis_names[a] = axis_names[a];
          if (a < axis_units.size()) contour.axis_units[a] = axis_units[a];
        }
        contour.direction = named<GradientDirection>("direction", direction, gradient_directions());
        contour.vertex_attributes = to_attributes(vertex_attributes, contour.vertices.size(), "vertices");
        contour.simplex_attributes = to_attributes(simplex_attributes, contour.simplices.size(), "simplices");
        contour.periods = periods_of_numbers<N>(periods);
      },
      result->contour);
  return result;
}

/// Moves the contour's memory to writable arrays. The contour is empty afterwards.
py::tuple take_arrays(AnyContour& contour) {
  return std::visit(
      [](auto& c) {
        return py::make_tuple(owned(std::move(c.vertices)), owned(std::move(c.simplices)), owned(std::move(c.normals)));
      },
      contour.contour);
}

}  // namespace

void bind_contour(py::module_& m) {
  const auto ndim = [](const auto& c, const py::object&) { return static_cast<int>(c.axis_names.size()); };
  const auto vertices = [](const auto& c, const py::object& self) { return matrix(c.vertices, self); };
  const auto simplices = [](const auto& c, const py::object& self) { return matrix(c.simplices, self); };
  const auto normals = [](const auto& c, const py::object& self) -> py::object {
    if (c.normals.size() != c.vertices.size() || c.vertices.empty()) return py::none();
    return matrix(c.normals, self);
  };
  const auto names = [](const auto& c, const py::object&) {
    return std::vector<std::string>(c.axis_names.begin(), c.axis_names.end());
  };
  const auto units = [](const auto& c, const py::object&) {
    return std::vector<std::string>(c.axis_units.begin(), c.axis_units.end());
  };
  const auto direction = [](const auto& c, const py::object&) {
    return c.direction == GradientDirection::descent ? "descent" : "ascent";
  };
  const auto periods = [](const auto& c, const py::object&) { return period_numbers(c.periods); };
  // A property of a wrapped contour and of the hyperplanes with a normal; `otherwise` for other contours.
  const auto of_wrapped = [](bool otherwise, const auto& property) {
    return [=](const AnyContour& contour, const std::vector<double>& normal) {
      return std::visit(
          [&]<int N, class Real>(const Contour<N, Real>& c) {
            if constexpr (N >= 3) {
              if (c.periods.empty() || normal.size() != N) return otherwise;
              Hyperplane<N> hyperplane;
              std::copy(normal.begin(), normal.end(), hyperplane.normal.begin());
              return property(c.periods, hyperplane);
            }
            return otherwise;
          },
          contour.contour);
    };
  };
  const auto has_all_offsets =
      of_wrapped(false, []<int N>(const std::vector<Period<N>>& repeated, const Hyperplane<N>& hyperplane) {
        return cut_period<N>(repeated, hyperplane.normal).has_value();
      });
  const auto cuts =
      of_wrapped(true, []<int N>(const std::vector<Period<N>>& repeated, const Hyperplane<N>& hyperplane) {
        return cuts_wrapped<N>(repeated, hyperplane);
      });
  const auto of_vertices = [](const auto& c, const py::object& self) {
    return attribute_arrays(c.vertex_attributes, self);
  };
  const auto of_simplices = [](const auto& c, const py::object& self) {
    return attribute_arrays(c.simplex_attributes, self);
  };
  py::class_<AnyContour>(m, "Contour", doc::Contour)
      .def_static("from_arrays", &from_arrays, py::arg("vertices"), py::arg("simplices"), py::arg("normals"),
                  py::arg("axis_names"), py::arg("axis_units"), py::arg("direction"), py::arg("isovalue"),
                  py::arg("vertex_attributes"), py::arg("simplex_attributes"),
                  py::arg("periods") = std::vector<double>(),
                  "A contour from arrays, which are copied. Attributes: (name, unit, values) each.")
      .def("take_arrays", &take_arrays,
           "(vertices, simplices, normals): the memory itself, to write to. The contour is empty afterwards.")
      .def_property_readonly("ndim", of_contour(ndim), "N, the number of coordinates of a vertex.")
      .def_property_readonly("vertices", of_contour(vertices))
      .def_property_readonly("simplices", of_contour(simplices))
      .def_property_readonly("normals", of_contour(normals))
      .def_property_readonly("axis_names", of_contour(names))
      .def_property_readonly("axis_units", of_contour(units))
      .def_property_readonly("direction", of_contour(direction))
      .def_property_readonly("periods", of_contour(periods), "vector, dual and start of each period, flat")
      .def("has_all_offsets", has_all_offsets, py::arg("normal"),
           "Whether all hyperplanes with this normal cut the wrapped contour, whatever their offsets.")
      .def("cuts_wrapped", cuts, py::arg("normal"),
           "Whether hyperplanes with this normal cut the contour as it is wrapped.")
      .def_property_readonly("vertex_attributes", of_contour(of_vertices), "name -> (values, unit)")
      .def_property_readonly("simplex_attributes", of_contour(of_simplices), "name -> (values, unit)")
      .def_readonly("isovalue", &AnyContour::isovalue);
}

}  // namespace tegl::python
