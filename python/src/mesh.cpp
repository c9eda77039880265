// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of meshes for Python.
#include <fmt/format.h>

#include <memory>
#include <span>
#include <tuple>
#include <utility>
#include <variant>

#include "binding.hpp"
#include "docs.hpp"
#include "facets.hpp"
#include "tegl/cell_index.hpp"
#include "tegl/complex.hpp"
#include "tegl/delaunay.hpp"
#include "tegl/equal_cells.hpp"

namespace tegl::python {

namespace {

using Doubles = py::array_t<double, py::array::c_style>;
using Corners = py::array_t<std::uint32_t, py::array::c_style>;
using Types = py::array_t<std::uint8_t, py::array::c_style>;

template <class T, class Array>
std::span<const T> span_of(const Array& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

template <int N>
std::vector<std::array<double, N>> points_of(const Doubles& array) {
  std::vector<std::array<double, N>> points(static_cast<std::size_t>(array.size()) / N);
  if (!points.empty()) std::copy_n(array.data(), array.size(), points.data()->data());
  return points;
}

using Ends = py::array_t<std::uint64_t, py::array::c_style>;
/// Types, corners and the six other arrays of CellLists, which are empty without polygons, polyhedra and polytopes.
using CellArrays = std::tuple<Types, Corners, Ends, Corners, Ends, Ends, Ends, Ends>;

/// What the caller gave, without Python.
struct MeshArguments {
  CellLists cells;
  std::span<const double> values, times;
  std::vector<std::string> axis_names;
};

using AnyComplex = std::variant<Complex<2>, Complex<3>, Complex<4>>;

/// Checks that no two cells have the same corners, too.
template <int N>
Complex<N> complex_of_cells(std::vector<std::array<double, N>> points, const CellLists& cells) {
  Complex<N> complex = cells.ends.empty() ? Complex<N>(std::move(points), cells.types, cells.corners)
                                          : Complex<N>(std::move(points), cells);
  if (const auto equal = find_equal_cells(cells))
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("cell {} has the same corners as cell {}; expected each cell once", equal->second, equal->first));
  return complex;
}

/// `points`: #P x N, or, if they move, #T x #P x N.
template <int N>
AnyComplex complex_of(std::vector<std::array<double, N>> points, const MeshArguments& mesh) {
  if (mesh.times.empty()) {
    Complex<N> complex = complex_of_cells<N>(std::move(points), mesh.cells);
    complex.set_values(std::vector<double>(mesh.values.begin(), mesh.values.end()));
    return complex;
  }
  if constexpr (N < 4) {
    const std::size_t count = mesh.values.size() / mesh.times.size();
    const bool moves = points.size() != count;
    std::vector<std::array<double, N>> first(
        points.begin(), points.begin() + static_cast<std::ptrdiff_t>(std::min(count, points.size())));
    const Complex<N> complex = complex_of_cells<N>(std::move(first), mesh.cells);
    const std::span<const std::array<double, N>> moving(points);
    return in_time<N>(complex, mesh.times, mesh.values, moves ? moving : moving.first(0));
  } else {
    throw Error(ErrorCode::UnsupportedData, "times with a 4D mesh; expected a mesh in 2 or 3 dimensions");
  }
}

AnyComplex complex_of(const Doubles& points, const MeshArguments& mesh) {
  const py::ssize_t dim = points.ndim() == 0 ? 0 : points.shape(points.ndim() - 1);
  if (dim == 2) return complex_of<2>(points_of<2>(points), mesh);
  if (dim == 3) return complex_of<3>(points_of<3>(points), mesh);
  if (dim == 4) return complex_of<4>(points_of<4>(points), mesh);
  throw Error(ErrorCode::UnsupportedData, fmt::format("points have {} coordinates; expected 2 to 4", dim));
}

template <class T, class Array>
std::vector<T> vector_of(const Array& array) {
  return std::vector<T>(array.data(), array.data() + array.size());
}

MeshArguments arguments_of(const CellArrays& arrays, const Doubles& values, const Doubles& times,
                           const std::vector<std::string>& axis_names) {
  const auto& [types, corners, ends, face_corners, face_ends, face_lists_ends, facet_ends, facet_lists_ends] = arrays;
  MeshArguments mesh{{}, span_of<double>(values), span_of<double>(times), axis_names};
  for (const std::uint8_t type : span_of<std::uint8_t>(types)) mesh.cells.types.push_back(static_cast<CellType>(type));
  mesh.cells.corners = vector_of<Index>(corners);
  mesh.cells.ends = vector_of<std::uint64_t>(ends);
  mesh.cells.face_corners = vector_of<Index>(face_corners);
  mesh.cells.face_ends = vector_of<std::uint64_t>(face_ends);
  mesh.cells.face_lists_ends = vector_of<std::uint64_t>(face_lists_ends);
  mesh.cells.facet_ends = vector_of<std::uint64_t>(facet_ends);
  mesh.cells.facet_lists_ends = vector_of<std::uint64_t>(facet_lists_ends);
  return mesh;
}

/// Arrays at the points of a mesh, by name.
using PointArrays = std::vector<std::pair<std::string, Doubles>>;

/// What a contour is made of, beside the mesh.
struct ContourArguments {
  double level;
  bool is_double;
  ExtractOptions options;
  std::string normals;
  std::vector<std::pair<std::string, std::span<const double>>> attributes;
};

/// `index`: null for a single contour.
std::unique_ptr<AnyContour> contour_of(const AnyComplex& any, const CellIndex* index,
                                       const std::vector<std::string>& axis_names, const ContourArguments& wanted) {
  const auto named = [&](const auto& complex, auto contour) {
    for (std::size_t a = 0; a < std::min(axis_names.size(), contour.axis_names.size()); ++a)
      contour.axis_names[a] = axis_names[a];
    for (const auto& [name, numbers] : wanted.attributes)
      contour.vertex_attributes.push_back(interpolate_points(complex, wanted.level, numbers, name, "", wanted.options));
    auto result = std::make_unique<AnyContour>();
    *result = {std::move(contour), wanted.level};
    add_shape_normals(*result, wanted.normals, wanted.options);
    return result;
  };
  return std::visit(
      [&](const auto& complex) {
        const auto& [level, is_double, options, normals, attributes] = wanted;
        if (index != nullptr)
          return is_double ? named(complex, extract<double>(complex, *index, level, options))
                           : named(complex, extract<float>(complex, *index, level, options));
        return is_double ? named(complex, extract<double>(complex, level, options))
                         : named(complex, extract<float>(complex, level, options));
      },
      any);
}

ContourArguments wanted_of(double level, bool is_double, const py::dict& arguments, const PointArrays& attributes,
                           Call& call) {
  ContourArguments wanted{
      level, is_double, extract_options(arguments, call), arguments["normals"].cast<std::string>(), {}};
  for (const auto& [name, array] : attributes) wanted.attributes.emplace_back(name, span_of<double>(array));
  return wanted;
}

std::unique_ptr<AnyContour> extract_mesh(const Doubles& points, const CellArrays& cells, const Doubles& values,
                                         const Doubles& times, const std::vector<std::string>& axis_names, double level,
                                         bool is_double, const py::dict& arguments, const PointArrays& attributes,
                                         const py::object& progress) {
  Call call(progress);
  const ContourArguments wanted = wanted_of(level, is_double, arguments, attributes, call);
  const MeshArguments mesh = arguments_of(cells, values, times, axis_names);
  return call.run([&] { return contour_of(complex_of(points, mesh), nullptr, axis_names, wanted); });
}

std::unique_ptr<AnyFacets> extract_mesh_facets(const Doubles& points, const CellArrays& cells, const Doubles& values,
                                               const Doubles& times, const std::vector<std::string>& axis_names,
                                               double level, bool is_double, const py::dict& arguments,
                                               const py::object& progress) {
  Call call(progress);
  const ExtractOptions options = extract_options(arguments, call);
  const MeshArguments mesh = arguments_of(cells, values, times, axis_names);
  const auto extracted = [&]<class Real, int N>(Real, const Complex<N>& complex) {
    auto facets = extract_facets<Real>(complex, level, options);
    for (std::size_t a = 0; a < std::min(axis_names.size(), facets.axis_names.size()); ++a)
      facets.axis_names[a] = axis_names[a];
    return std::make_unique<AnyFacets>(std::move(facets), level);
  };
  return call.run([&] {
    return std::visit(
        [&](const auto& complex) { return is_double ? extracted(double{}, complex) : extracted(float{}, complex); },
        complex_of(points, mesh));
  });
}

std::pair<std::uint64_t, std::uint64_t> count_mesh(const Doubles& points, const CellArrays& cells,
                                                   const Doubles& values, const Doubles& times, double level,
                                                   const py::dict& arguments, const py::object& progress) {
  Call call(progress);
  const ExtractOptions options = extract_options(arguments, call);
  const MeshArguments mesh = arguments_of(cells, values, times, {});
  const ContourSize size = call.run([&] {
    return std::visit([&](const auto& complex) { return count(complex, level, options); }, complex_of(points, mesh));
  });
  return {size.vertices, size.simplices};
}

/// A mesh with its edges and an interval tree of its cells.
struct MeshIndex {
  AnyComplex complex;
  CellIndex index;
  std::vector<std::string> axis_names;
};

std::unique_ptr<MeshIndex> make_index(const Doubles& points, const CellArrays& cells, const Doubles& values,
                                      const Doubles& times, const std::vector<std::string>& axis_names,
                                      unsigned threads, const py::object& progress) {
  Call call(progress);
  const MeshArguments mesh = arguments_of(cells, values, times, axis_names);
  const WorkOptions work{threads, call.progress()};
  return call.run([&] {
    AnyComplex complex = complex_of(points, mesh);
    CellIndex index = std::visit(
        [&](auto& any) {
          any.find_edges({work.threads, {}});
          return CellIndex(any, work);
        },
        complex);
    return std::make_unique<MeshIndex>(MeshIndex{std::move(complex), std::move(index), axis_names});
  });
}

std::unique_ptr<AnyContour> contour_of_mesh_index(const MeshIndex& mesh, double level, bool is_double,
                                                  const py::dict& arguments, const PointArrays& attributes,
                                                  const py::object& progress) {
  Call call(progress);
  const ContourArguments wanted = wanted_of(level, is_double, arguments, attributes, call);
  return call.run([&] { return contour_of(mesh.complex, &mesh.index, mesh.axis_names, wanted); });
}

/// The Delaunay cells of points, #C x (N + 1).
py::array delaunay_cells(const Doubles& points) {
  const auto cells = [&]<int N>(std::integral_constant<int, N>) {
    const std::vector<Index> corners = [&] {
      py::gil_scoped_release release;
      return delaunay_corners<N>(points_of<N>(points));
    }();
    return py::array_t<Index>({static_cast<py::ssize_t>(corners.size()) / (N + 1), py::ssize_t{N + 1}}, corners.data());
  };
  const py::ssize_t dim = points.ndim() == 2 ? points.shape(1) : 0;
  if (dim == 2) return cells(std::integral_constant<int, 2>());
  if (dim == 3) return cells(std::integral_constant<int, 3>());
  if (dim == 4) return cells(std::integral_constant<int, 4>());
  throw Error(ErrorCode::UnsupportedData, fmt::format("points have {} coordinates; expected 2 to 4", dim));
}

}  // namespace

void bind_mesh(py::module_& m) {
  m.def("delaunay", &delaunay_cells, py::arg("points"), doc::delaunay);
  m.def("extract_mesh", &extract_mesh, py::arg("points"), py::arg("cells"), py::arg("values"), py::arg("times"),
        py::arg("axis_names"), py::arg("level"), py::arg("double"), py::arg("options"), py::arg("attributes"),
        py::arg("progress"), doc::extract);
  m.def("extract_mesh_facets", &extract_mesh_facets, py::arg("points"), py::arg("cells"), py::arg("values"),
        py::arg("times"), py::arg("axis_names"), py::arg("level"), py::arg("double"), py::arg("options"),
        py::arg("progress"), doc::extract_facets_2);
  m.def("count_mesh", &count_mesh, py::arg("points"), py::arg("cells"), py::arg("values"), py::arg("times"),
        py::arg("level"), py::arg("options"), py::arg("progress"), doc::count);
  py::class_<MeshIndex>(m, "MeshIndex", doc::CellIndex)
      .def(py::init(&make_index), py::arg("points"), py::arg("cells"), py::arg("values"), py::arg("times"),
           py::arg("axis_names"), py::arg("threads"), py::arg("progress"))
      .def("contour", &contour_of_mesh_index, py::arg("level"), py::arg("double"), py::arg("options"),
           py::arg("attributes"), py::arg("progress"), doc::extract)
      .def_property_readonly(
          "cells",
          [](const MeshIndex& mesh) {
            return std::visit([](const auto& complex) { return complex.cell_count(); }, mesh.complex);
          },
          "Number of cells; over time of prisms.")
      .def_property_readonly(
          "memory", [](const MeshIndex& mesh) { return mesh.index.bytes(); }, "Bytes of the tree.");
}

}  // namespace tegl::python
