// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of meshes for Python.
#include <fmt/format.h>

#include <span>

#include "binding.hpp"
#include "docs.hpp"
#include "tegl/complex.hpp"
#include "tegl/delaunay.hpp"

namespace tegl::python {

namespace {

using Doubles = py::array_t<double, py::array::c_style>;
using Numbers = py::array_t<std::uint32_t, py::array::c_style>;
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

/// What the caller gave, without Python.
struct MeshArguments {
  std::vector<CellType> types;
  std::span<const Index> corners;
  std::span<const double> values, times;
  double level;
  bool is_double;
  std::vector<std::string> axis_names;
};

template <int N>
AnyContour contour_of(const Complex<N>& complex, const MeshArguments& mesh, const ExtractOptions& options) {
  const auto named = [&](auto contour) -> AnyContour {
    for (std::size_t a = 0; a < std::min(mesh.axis_names.size(), contour.axis_names.size()); ++a)
      contour.axis_names[a] = mesh.axis_names[a];
    return {std::move(contour), mesh.level};
  };
  if (mesh.is_double) return named(extract<double>(complex, mesh.level, options));
  return named(extract<float>(complex, mesh.level, options));
}

/// `points`: #P x N, or, if they move, #T x #P x N.
template <int N>
AnyContour contour_of_mesh(std::vector<std::array<double, N>> points, const MeshArguments& mesh,
                           const ExtractOptions& options) {
  if (mesh.times.empty()) {
    Complex<N> complex(std::move(points), mesh.types, mesh.corners);
    complex.set_values(std::vector<double>(mesh.values.begin(), mesh.values.end()));
    return contour_of(complex, mesh, options);
  }
  if constexpr (N < 4) {
    const std::size_t count = mesh.values.size() / mesh.times.size();
    const bool moves = points.size() != count;
    std::vector<std::array<double, N>> first(
        points.begin(), points.begin() + static_cast<std::ptrdiff_t>(std::min(count, points.size())));
    const Complex<N> complex(std::move(first), mesh.types, mesh.corners);
    const std::span<const std::array<double, N>> moving(points);
    return contour_of(in_time<N>(complex, mesh.times, mesh.values, moves ? moving : moving.first(0)), mesh, options);
  } else {
    throw Error(ErrorCode::UnsupportedData, "times with a 4D mesh; expected a mesh in 2 or 3 dimensions");
  }
}

std::unique_ptr<AnyContour> extract_mesh(const Doubles& points, const Types& types, const Numbers& corners,
                                         const Doubles& values, const Doubles& times,
                                         const std::vector<std::string>& axis_names, double level, bool is_double,
                                         const py::dict& arguments, const py::object& progress) {
  Call call(progress);
  const ExtractOptions options = extract_options(arguments, call);
  const auto normals = arguments["normals"].cast<std::string>();
  MeshArguments mesh{
      {}, span_of<Index>(corners), span_of<double>(values), span_of<double>(times), level, is_double, axis_names};
  for (const std::uint8_t type : span_of<std::uint8_t>(types)) mesh.types.push_back(static_cast<CellType>(type));
  const py::ssize_t dim = points.ndim() == 0 ? 0 : points.shape(points.ndim() - 1);
  if (dim < 2 || dim > 4)
    throw Error(ErrorCode::UnsupportedData, fmt::format("points have {} coordinates; expected 2 to 4", dim));
  return call.run([&] {
    auto contour = std::make_unique<AnyContour>(dim == 2   ? contour_of_mesh<2>(points_of<2>(points), mesh, options)
                                                : dim == 3 ? contour_of_mesh<3>(points_of<3>(points), mesh, options)
                                                           : contour_of_mesh<4>(points_of<4>(points), mesh, options));
    add_shape_normals(*contour, normals, options);
    return contour;
  });
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
  m.def("extract_mesh", &extract_mesh, py::arg("points"), py::arg("types"), py::arg("corners"), py::arg("values"),
        py::arg("times"), py::arg("axis_names"), py::arg("level"), py::arg("double"), py::arg("options"),
        py::arg("progress"), doc::extract);
}

}  // namespace tegl::python
