// SPDX-License-Identifier: BSD-3-Clause
//
// Hypersurface elements for Python.
#include "tegl/elements.hpp"

#include <fmt/format.h>

#include "binding.hpp"
#include "docs.hpp"
#include "tegl/io/elements.hpp"

namespace tegl::python {

namespace {

/// Elements of any dimension: `_tegl.Elements`.
struct AnyElements {
  std::variant<Elements<2>, Elements<3>, Elements<4>, Elements<5>> elements;
};

template <int N>
const Grid<N>& grid_of(const AnyGrid& grid) {
  const auto* found = std::get_if<Grid<N>>(&grid.grid);
  if (found == nullptr)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("the grid has {} axes; expected {}, as the contour", grid.grid.index() + 2, N));
  return *found;
}

std::unique_ptr<AnyElements> elements_any(const AnyContour& contour, const AnyGrid* grid, unsigned threads,
                                          const py::object& progress) {
  Call call(progress);
  const WorkOptions options{threads, call.progress()};
  return call.run([&] {
    return std::visit(
        [&]<int N, class Real>(const Contour<N, Real>& c) {
          auto found = grid == nullptr ? elements(c, options) : elements_by_cell(c, grid_of<N>(*grid), options);
          return std::unique_ptr<AnyElements>(new AnyElements{std::move(found)});
        },
        contour.contour);
  });
}

template <class F>
auto of_elements(F f) {
  return [f](py::object self) {
    return std::visit([&](const auto& e) { return f(e, self); }, py::cast<const AnyElements&>(self).elements);
  };
}

template <int N>
py::array points(const Buffer<std::array<double, N>>& rows, py::handle owner) {
  return read_only(rows.empty() ? nullptr : rows.data()->data(), {static_cast<py::ssize_t>(rows.size()), N}, owner);
}

template <class T>
py::array numbers(const Buffer<T>& values, py::handle owner) {
  return read_only(values.data(), {static_cast<py::ssize_t>(values.size())}, owner);
}

py::dict sum_any(const AnyElements& elements) {
  return std::visit(
      [](const auto& e) {
        const auto sum = sum_of(e);
        py::dict result;
        put(result, "normal", to_list(sum.normal));
        put(result, "absolute", to_list(sum.absolute));
        put(result, "measure", sum.measure);
        put(result, "closure_error", sum.closure_error());
        return result;
      },
      elements.elements);
}

void write_any_elements(const AnyElements& elements, const std::string& path, const std::string& axes,
                        const std::string& components, bool header, const py::object& progress) {
  Call call(progress);
  ElementFileOptions options;
  options.axes =
      named<ElementAxes>("axes", axes, {{"time_first", ElementAxes::time_first}, {"as_is", ElementAxes::as_is}});
  options.components = named<ElementComponents>(
      "components", components,
      {{"covariant", ElementComponents::covariant}, {"contravariant", ElementComponents::contravariant}});
  options.header = header;
  options.work.progress = call.progress();
  call.run([&] {
    const FileLock lock(options.work.progress);
    std::visit([&](const auto& e) { write_elements(e, path, options); }, elements.elements);
  });
}

}  // namespace

void bind_elements(py::module_& m) {
  const auto centroids = []<int N>(const Elements<N>& e, const py::object& self) {
    return points<N>(e.centroids, self);
  };
  const auto normals = []<int N>(const Elements<N>& e, const py::object& self) { return points<N>(e.normals, self); };
  const auto measures = [](const auto& e, const py::object& self) { return numbers(e.measures, self); };
  const auto counts = [](const auto& e, const py::object& self) { return numbers(e.counts, self); };
  const auto attributes = [](const auto& e, const py::object& self) { return attribute_arrays(e.attributes, self); };
  py::class_<AnyElements>(m, "Elements", doc::Elements)
      .def_property_readonly("centroids", of_elements(centroids))
      .def_property_readonly("normals", of_elements(normals))
      .def_property_readonly("measures", of_elements(measures))
      .def_property_readonly("counts", of_elements(counts))
      .def_property_readonly("attributes", of_elements(attributes), "name -> (values, unit)");
  m.def("elements", &elements_any, py::arg("contour"), py::arg("grid"), py::arg("threads"), py::arg("progress"),
        doc::elements);
  m.def("sum_of", &sum_any, py::arg("elements"), doc::ElementSum);
  m.def("write_elements", &write_any_elements, py::arg("elements"), py::arg("path"), py::arg("axes"),
        py::arg("components"), py::arg("header"), py::arg("progress"), doc::write_elements);
}

}  // namespace tegl::python
