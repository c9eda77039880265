// SPDX-License-Identifier: BSD-3-Clause
//
// Images from NumPy arrays, and their contours.
#include "tegl/extract.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "binding.hpp"
#include "docs.hpp"
#include "periods.hpp"
#include "points.hpp"
#include "tegl/cells.hpp"
#include "tegl/curved.hpp"
#include "tegl/division.hpp"
#include "tegl/lattice.hpp"
#include "tegl/normals.hpp"
#include "tegl/periodic.hpp"
#include "tegl/positions.hpp"
#include "tegl/slice.hpp"

namespace tegl::python {

void add_shape_normals(AnyContour& contour, const std::string& kind, const ExtractOptions& options) {
  if (kind != "geometric" && kind != "flat") return;
  std::visit(
      [&]<int N, class Real>(Contour<N, Real>& c) {
        if constexpr (N <= 4) {
          // The extraction has already reported progress up to 1.
          const WorkOptions work{options.work.threads,
                                 [&](double) { return !options.work.progress || options.work.progress(1.0); }};
          if (kind == "geometric") {
            c.normals = geometric_normals(c, NormalWeights::angle, work);
            return;
          }
          Attribute attribute{"normal", "", N, {}};
          for (const auto& normal : flat_normals(c, work))
            attribute.values.insert(attribute.values.end(), normal.begin(), normal.end());
          c.simplex_attributes.push_back(std::move(attribute));
        } else {
          throw_dimension("normals 'geometric' and 'flat'", N, "2 to 4 dimensions, or normals='gradient'");
        }
      },
      contour.contour);
}

namespace {

/// A tuple (origin, step), or a list of the coordinates of all samples.
using AxisArgument = py::object;
using Matrix = std::vector<std::vector<double>>;

template <int N>
Grid<N> grid_of(const py::array& array, const std::vector<AxisArgument>& axes, const std::optional<Matrix>& affine,
                const std::vector<std::string>& names, const std::vector<std::string>& units) {
  Grid<N> grid;
  for (std::size_t a = 0; a < N; ++a) {
    const auto size = static_cast<std::size_t>(array.shape(static_cast<py::ssize_t>(a)));
    if (py::isinstance<py::tuple>(axes[a])) {
      const auto [first, step] = py::cast<std::pair<double, double>>(axes[a]);
      grid.axes[a] = Axis::uniform(size, first, step);
    } else {
      const auto coordinates = py::cast<std::vector<double>>(axes[a]);
      if (coordinates.size() != size)
        throw Error(ErrorCode::InvalidGrid, fmt::format("an axis of {} samples has {} coordinates; expected {}", size,
                                                        coordinates.size(), size));
      grid.axes[a] = Axis::rectilinear(coordinates);
    }
    grid.axes[a].name = names[a];
    grid.axes[a].unit = units[a];
  }
  if (affine)
    for (int row = 0; row < N; ++row) {
      const auto& numbers = affine->at(static_cast<std::size_t>(row));
      for (int column = 0; column < N; ++column)
        grid.linear[row][column] = numbers.at(static_cast<std::size_t>(column));
      grid.offset[row] = numbers.at(N);
    }
  return grid;
}

template <class T, int N>
bool try_view(const py::array& array, const Grid<N>& grid, std::optional<ViewsOf<N>>& view) {
  if (!py::isinstance<py::array_t<T>>(array)) return false;
  typename Image<T, N>::Strides strides;
  for (int a = 0; a < N; ++a) {
    if (array.strides(a) % static_cast<py::ssize_t>(sizeof(T)) != 0)
      throw Error(ErrorCode::InvalidArgument, fmt::format("axis {} has a stride of {} bytes; expected a multiple of {}",
                                                          a, array.strides(a), sizeof(T)));
    strides[static_cast<std::size_t>(a)] = array.strides(a) / static_cast<py::ssize_t>(sizeof(T));
  }
  view = Image<T, N>(static_cast<const T*>(array.data()), grid, strides);
  return true;
}

template <int N>
ViewsOf<N> view_of(const py::array& array, const Grid<N>& grid) {
  std::optional<ViewsOf<N>> view;
  if (try_view<std::uint8_t>(array, grid, view) || try_view<std::int8_t>(array, grid, view) ||
      try_view<std::uint16_t>(array, grid, view) || try_view<std::int16_t>(array, grid, view) ||
      try_view<std::int32_t>(array, grid, view) || try_view<float>(array, grid, view) ||
      try_view<double>(array, grid, view))
    return *view;
  throw Error(ErrorCode::UnsupportedData,
              fmt::format("values are of type {}; expected uint8, int8, uint16, int16, int32, float32 or float64",
                          std::string(py::str(array.dtype()))));
}

AnyImage make_image(const py::array& array, const std::vector<AxisArgument>& axes, const std::optional<Matrix>& affine,
                    const std::vector<std::string>& names, const std::vector<std::string>& units) {
  const auto dim = static_cast<std::size_t>(array.ndim());
  if (dim < 2 || dim > 5)
    throw Error(ErrorCode::UnsupportedData, fmt::format("the array has {} axes; expected 2 to 5", dim));
  if (axes.size() != dim || names.size() != dim || units.size() != dim || (affine && affine->size() < dim))
    throw Error(ErrorCode::InvalidArgument, fmt::format("expected axes, names and units for each of {} axes", dim));
  const auto view = [&]<int N>(std::integral_constant<int, N>) {
    return view_of<N>(array, grid_of<N>(array, axes, affine, names, units));
  };
  if (dim == 2) return {view(std::integral_constant<int, 2>()), array};
  if (dim == 3) return {view(std::integral_constant<int, 3>()), array};
  if (dim == 4) return {view(std::integral_constant<int, 4>()), array};
  return {view(std::integral_constant<int, 5>()), array};
}

template <class Real>
AnyContour contour_of_image(const AnyImage& image, double level, const ExtractOptions& options) {
  return visit_image(image, [&](const auto& view) -> AnyContour {
    return {extract<Real>(view, level, options), level};
  });
}

std::unique_ptr<AnyContour> extract_any(const AnyImage& image, double level, bool is_double, const py::dict& arguments,
                                        const py::object& progress) {
  Call call(progress);
  const ExtractOptions options = extract_options(arguments, call);
  const auto normals = py::cast<std::string>(arguments["normals"]);
  return call.run([&] {
    auto result = std::make_unique<AnyContour>(is_double ? contour_of_image<double>(image, level, options)
                                                         : contour_of_image<float>(image, level, options));
    add_shape_normals(*result, normals, options);
    return result;
  });
}

/// Coordinates of a curved grid: axis, axes that they differ along, float or double numbers in memory that they share
/// with others, from one to the next one of them, counted in numbers, and the unit.
using CurvedAxes = std::vector<std::tuple<int, unsigned, py::array, std::size_t, std::string>>;

/// The coordinates in place, so that their arrays must outlive the result.
std::vector<CurvedAxis> curved_axes(const CurvedAxes& given) {
  std::vector<CurvedAxis> curved;
  for (const auto& [axis, along, values, pitch, unit] : given) {
    std::variant<const float*, const double*> first = static_cast<const double*>(values.data());
    if (py::isinstance<py::array_t<float>>(values)) first = static_cast<const float*>(values.data());
    const auto size = static_cast<std::size_t>(values.size());
    curved.push_back({axis, along, {}, "", unit, CurvedPoints::in_place(first, size, 1, pitch)});
  }
  return curved;
}

/// Stores arrays of equally many coordinates, float or double in one order, sample by sample: #samples x pitch.
py::array by_points_any(const std::vector<py::array>& arrays, unsigned threads) {
  std::vector<CoordinateArray> columns;
  for (const py::array& array : arrays) {
    if (py::isinstance<py::array_t<float>>(array))
      columns.push_back({static_cast<const float*>(array.data())});
    else
      columns.push_back({static_cast<const double*>(array.data())});
  }
  const auto samples = arrays.empty() ? std::size_t{0} : static_cast<std::size_t>(arrays.front().size());
  const auto points = [&] {
    const py::gil_scoped_release release;
    return std::make_unique<CurvedPoints>(samples, columns, threads);
  }();
  return array_of_points(*points, 0, points->pitch());
}

template <class Real>
AnyContour placed_contour_of(const AnyImage& image, const PositionOptions& positions,
                             const std::optional<CellFaces>& cells, std::span<const CurvedAxis> curved, double level,
                             const ExtractOptions& options) {
  return visit_image(image, [&]<class T, int N>(const Image<T, N>& view) -> AnyContour {
    if (cells) {
      if constexpr (N <= 4)
        return {extract_cells<Real>(view, level, positions, options, *cells), level};
      else
        throw_dimension("an image of cells", N, "2 to 4 dimensions");
    }
    if (!curved.empty()) {
      if constexpr (N <= 4) {
        const Image<T, N> indexed{view.data(), index_grid<N>(view.grid(), curved), view.strides()};
        auto contour = extract_placed<Real>(indexed, level, positions, options);
        return {on_curved_grid<Real>(std::move(contour), view.grid(), curved, {options.work.threads, {}}), level};
      } else {
        throw_dimension("curved grids", N, "2 to 4 dimensions");
      }
    }
    return {extract_placed<Real>(view, level, positions, options), level};
  });
}

/// The function of PositionOptions::custom_of_many that calls a Python function. It gets arrays of its own, which it
/// may keep.
auto custom_of_many(Call& call, const py::object& custom) {
  return [&call, &custom](std::span<const double> first, std::span<const double> second, double level,
                          std::span<double> out) {
    call.with_python([&] {
      const auto copy = [](std::span<const double> from) {
        return py::array_t<double>(static_cast<py::ssize_t>(from.size()), from.data());
      };
      const auto places = py::cast<py::array_t<double, py::array::c_style>>(custom(copy(first), copy(second), level));
      if (static_cast<std::size_t>(places.size()) != out.size())
        throw py::value_error("not as many positions as edges");
      std::copy_n(places.data(), out.size(), out.begin());
    });
  };
}

/// `values`: contiguous float or double, by sample, the image's axis 0 fastest; empty for other rules than "filtered".
/// `custom`: for "custom", a function of the arrays of both samples and the level. `cells`: samples are cells, with
/// these faces. `curved`: of a curved grid, or empty.
std::unique_ptr<AnyContour> extract_placed_any(const AnyImage& image, const std::string& rule, const py::array& values,
                                               const py::object& custom, double margin, double last_axis_weight,
                                               const std::optional<CellFaces>& cells, const CurvedAxes& curved,
                                               double level, bool is_double, const py::dict& arguments,
                                               const py::object& progress) {
  Call call(progress);
  const ExtractOptions options = extract_options(arguments, call);
  const auto normals = py::cast<std::string>(arguments["normals"]);
  PositionOptions positions;
  positions.rule = named<Positions>("positions", rule,
                                    {{"linear", Positions::linear},
                                     {"custom", Positions::custom},
                                     {"filtered", Positions::filtered},
                                     {"gravitation", Positions::gravitation},
                                     {"relaxed", Positions::relaxed}});
  const auto count = static_cast<std::size_t>(values.size());
  if (py::isinstance<py::array_t<double>>(values))
    positions.filtered = std::span(static_cast<const double*>(values.data()), count);
  else
    positions.filtered = std::span(static_cast<const float*>(values.data()), count);
  if (!custom.is_none()) positions.custom_of_many = custom_of_many(call, custom);
  positions.margin = margin;
  positions.last_axis_weight = last_axis_weight;
  const std::vector<CurvedAxis> axes = curved_axes(curved);
  return call.run([&] {
    auto result = std::make_unique<AnyContour>(
        is_double ? placed_contour_of<double>(image, positions, cells, axes, level, options)
                  : placed_contour_of<float>(image, positions, cells, axes, level, options));
    add_shape_normals(*result, normals, options);
    return result;
  });
}

template <class Real>
AnyContour periodic_contour_of(const AnyImage& image, const std::vector<int>& axes, const std::vector<double>& given,
                               double level, const ExtractOptions& options) {
  return visit_image(image, [&]<class T, int N>(const Image<T, N>& view) -> AnyContour {
    if constexpr (N <= 4) {
      const Image<T, N> samples = periodic_samples(view, axes, given);
      return {extract_periodic<Real>(samples, periods_of(samples.grid(), axes, given), level, options), level};
    } else {
      throw_dimension("periodic axes", N, "2 to 4 dimensions, or division 'kuhn' or 'symmetric'");
    }
  });
}

std::unique_ptr<AnyContour> extract_periodic_any(const AnyImage& image, const std::vector<int>& axes,
                                                 const std::vector<double>& periods, double level, bool is_double,
                                                 const py::dict& arguments, const py::object& progress) {
  Call call(progress);
  const ExtractOptions options = extract_options(arguments, call);
  const auto normals = py::cast<std::string>(arguments["normals"]);
  return call.run([&] {
    auto result =
        std::make_unique<AnyContour>(is_double ? periodic_contour_of<double>(image, axes, periods, level, options)
                                               : periodic_contour_of<float>(image, axes, periods, level, options));
    add_shape_normals(*result, normals, options);
    return result;
  });
}

/// The seams of periodic axes on a curved grid. `periods`: along their own axes; NaN: by the coordinates.
template <int N>
std::vector<CurvedSeam<N>> seams_of(const Grid<N>& grid, const std::vector<CurvedAxis>& curved,
                                    const std::vector<int>& axes, const std::vector<double>& periods) {
  return find_seams<N>(grid, curved, axes, periods);
}

template <class Real>
AnyContour curved_contour_of(const AnyImage& image, const std::vector<CurvedAxis>& curved, const std::vector<int>& axes,
                             const std::vector<double>& periods, double level, const ExtractOptions& options) {
  return visit_image(image, [&]<class T, int N>(const Image<T, N>& view) -> AnyContour {
    if constexpr (N <= 4) {
      const WithoutRepeated<T, N> kept = without_repeated<T, N>(view, curved, axes, periods);
      return {extract_curved<Real>(kept.image, kept.curved, level, options,
                                   seams_of(kept.image.grid(), kept.curved, axes, periods)),
              level};
    } else {
      throw_dimension("curved grids", N, "2 to 4 dimensions");
    }
  });
}

/// Number of cells in which a curved grid is folded, and the index of the first, by axis of the library.
std::pair<std::uint64_t, std::vector<std::size_t>> find_folds_any(const AnyImage& image, const CurvedAxes& given,
                                                                  const std::vector<int>& axes,
                                                                  const std::vector<double>& periods) {
  const std::vector<CurvedAxis> curved = curved_axes(given);
  return visit_image(
      image, [&]<class T, int N>(const Image<T, N>& view) -> std::pair<std::uint64_t, std::vector<std::size_t>> {
        if constexpr (N <= 4) {
          const WithoutRepeated<T, N> kept = without_repeated<T, N>(view, curved, axes, periods);
          const GridFolds<N> folds = find_folds<N>(kept.image.grid(), kept.curved, {},
                                                   seams_of(kept.image.grid(), kept.curved, axes, periods));
          return {folds.cells, {folds.first.begin(), folds.first.end()}};
        } else {
          throw_dimension("curved grids", N, "2 to 4 dimensions");
        }
      });
}

void continue_longitudes_any(py::array_t<double, py::array::c_style>& values, const std::vector<std::size_t>& sizes) {
  continue_longitudes({values.mutable_data(), static_cast<std::size_t>(values.size())}, sizes);
}

/// The axis along which curved longitudes run: those of the first coordinate of `given`.
int axis_of_longitudes_any(const AnyImage& image, const CurvedAxes& given) {
  const std::vector<CurvedAxis> curved = curved_axes(given);
  return visit_image(image, [&]<class T, int N>(const Image<T, N>& view) -> int {
    if constexpr (N <= 4) {
      return axis_of_longitudes<N>(view.grid(), curved.at(0));
    } else {
      throw_dimension("curved grids", N, "2 to 4 dimensions");
    }
  });
}

std::vector<int> longitude_axes_any(const AnyImage& image, const CurvedAxes& given) {
  const std::vector<CurvedAxis> curved = curved_axes(given);
  return visit_image(image, [&]<class T, int N>(const Image<T, N>& view) -> std::vector<int> {
    return longitude_axes<T, N>(view, curved);
  });
}

std::unique_ptr<AnyContour> extract_curved_any(const AnyImage& image, const CurvedAxes& given,
                                               const std::vector<int>& axes, const std::vector<double>& periods,
                                               double level, bool is_double, const py::dict& arguments,
                                               const py::object& progress) {
  Call call(progress);
  const ExtractOptions options = extract_options(arguments, call);
  const auto normals = py::cast<std::string>(arguments["normals"]);
  const std::vector<CurvedAxis> curved = curved_axes(given);
  return call.run([&] {
    auto result = std::make_unique<AnyContour>(
        is_double ? curved_contour_of<double>(image, curved, axes, periods, level, options)
                  : curved_contour_of<float>(image, curved, axes, periods, level, options));
    add_shape_normals(*result, normals, options);
    return result;
  });
}

template <class Real>
AnyContour lattice_contour_of(const AnyImage& image, Lattice lattice, const std::vector<int>& axes,
                              const std::vector<double>& periods, double level, const ExtractOptions& options) {
  return visit_image(image, [&]<class T, int N>(const Image<T, N>& view) -> AnyContour {
    if constexpr (N <= 4) {
      const Image<T, N> samples = periodic_samples(view, axes, periods);
      return {extract_lattice<Real>(samples, lattice, level, options, periods_of(samples.grid(), axes, periods)),
              level};
    } else {
      throw_dimension("lattices", N, "2 to 4 dimensions");
    }
  });
}

std::unique_ptr<AnyContour> extract_lattice_any(const AnyImage& image, const std::string& name,
                                                const std::vector<int>& axes, const std::vector<double>& periods,
                                                double level, bool is_double, const py::dict& arguments,
                                                const py::object& progress) {
  Call call(progress);
  const ExtractOptions options = extract_options(arguments, call);
  const auto normals = py::cast<std::string>(arguments["normals"]);
  const auto lattice = named<Lattice>("lattice", name, lattices());
  return call.run([&] {
    auto result = std::make_unique<AnyContour>(
        is_double ? lattice_contour_of<double>(image, lattice, axes, periods, level, options)
                  : lattice_contour_of<float>(image, lattice, axes, periods, level, options));
    add_shape_normals(*result, normals, options);
    return result;
  });
}

template <class Real>
AnyContour divided_contour_of(const AnyImage& image, Division division, const std::vector<int>& axes,
                              const std::vector<double>& periods, double level, const ExtractOptions& options) {
  return visit_image(image, [&]<class T, int N>(const Image<T, N>& view) -> AnyContour {
    const Image<T, N> samples = periodic_samples(view, axes, periods);
    return {extract_divided<Real>(samples, division, level, options, periods_of(samples.grid(), axes, periods)), level};
  });
}

std::unique_ptr<AnyContour> extract_divided_any(const AnyImage& image, const std::string& name,
                                                const std::vector<int>& axes, const std::vector<double>& periods,
                                                double level, bool is_double, const py::dict& arguments,
                                                const py::object& progress) {
  Call call(progress);
  const ExtractOptions options = extract_options(arguments, call);
  const auto normals = py::cast<std::string>(arguments["normals"]);
  const auto division = named<Division>("division", name, divisions());
  return call.run([&] {
    auto result = std::make_unique<AnyContour>(
        is_double ? divided_contour_of<double>(image, division, axes, periods, level, options)
                  : divided_contour_of<float>(image, division, axes, periods, level, options));
    add_shape_normals(*result, normals, options);
    return result;
  });
}

std::pair<std::unique_ptr<AnyContour>, py::array> unroll_any(const AnyContour& contour) {
  Buffer<Index> originals;
  auto result = std::make_unique<AnyContour>(std::visit(
      [&]<int N, class Real>(const Contour<N, Real>& c) -> AnyContour {
        Unrolled<N, Real> unrolled = unroll(c);
        originals = std::move(unrolled.originals);
        return {std::move(unrolled.contour), contour.isovalue};
      },
      contour.contour));
  return {std::move(result), py::array_t<Index>(static_cast<py::ssize_t>(originals.size()), originals.data())};
}

/// `axes`: the periodic axes, with their periods; `lattice`, `division`: names. All are empty for a plain image.
std::pair<std::uint64_t, std::uint64_t> count_any(const AnyImage& image, const std::vector<int>& axes,
                                                  const std::vector<double>& periods, const std::string& lattice,
                                                  const std::string& division, double level, const py::dict& arguments,
                                                  const py::object& progress) {
  Call call(progress);
  const ExtractOptions options = extract_options(arguments, call);
  const auto of_view = [&]<class T, int N>(const Image<T, N>& given) -> ContourSize {
    const Image<T, N> view = periodic_samples(given, axes, periods);
    if (axes.empty() && lattice.empty() && division.empty()) return count(view, level, options);
    if (!division.empty())
      return count_divided(view, named<Division>("division", division, divisions()), level, options,
                           periods_of(view.grid(), axes, periods));
    if constexpr (N <= 4) {
      if (!lattice.empty()) {
        const auto on = named<Lattice>("lattice", lattice, lattices());
        if (axes.empty()) return count(lattice_complex(view, on), level, options);
        const auto contour = extract_lattice(view, on, level, options, periods_of(view.grid(), axes, periods));
        return {contour.vertices.size(), contour.simplices.size()};
      }
      return count_periodic(view, periods_of(view.grid(), axes, periods), level, options);
    }
    throw_dimension(lattice.empty() ? "periodic axes" : "lattices", N,
                    lattice.empty() ? "2 to 4 dimensions, or division 'kuhn' or 'symmetric'" : "2 to 4 dimensions");
  };
  const ContourSize size = call.run([&] { return visit_image(image, of_view); });
  return {size.vertices, size.simplices};
}

template <class Real>
AnyContour cut_of(const AnyImage& image, double level, int axis, double at, const ExtractOptions& options) {
  return visit_image(image, [&]<class T, int N>(const Image<T, N>& view) -> AnyContour {
    if constexpr (N >= 3) {
      return {slice_image<Real>(view, level, Hyperplane<N>::across(axis, at), options), level};
    } else {
      throw Error(ErrorCode::UnsupportedData, fmt::format("a slice of a {}D image; expected 3 to 5 dimensions", N));
    }
  });
}

std::unique_ptr<AnyContour> cut_any(const AnyImage& image, double level, int axis, double at, bool is_double,
                                    const py::dict& arguments, const py::object& progress) {
  Call call(progress);
  const ExtractOptions options = extract_options(arguments, call);
  const auto normals = py::cast<std::string>(arguments["normals"]);
  return call.run([&] {
    auto result = std::make_unique<AnyContour>(is_double ? cut_of<double>(image, level, axis, at, options)
                                                         : cut_of<float>(image, level, axis, at, options));
    add_shape_normals(*result, normals, options);
    return result;
  });
}

}  // namespace

void bind_extract(py::module_& m) {
  py::class_<AnyGrid>(m, "Grid", "The coordinates of an image's samples.");
  py::class_<AnyImage>(m, "Image", doc::Image)
      .def(py::init(&make_image), py::arg("array"), py::arg("axes"), py::arg("affine"), py::arg("names"),
           py::arg("units"))
      .def_readonly("array", &AnyImage::array)
      .def_property_readonly(
          "grid",
          [](const AnyImage& image) {
            return visit_image(image, [](const auto& view) { return AnyGrid{view.grid()}; });
          },
          "Its grid, a copy.")
      .def_property_readonly("ndim", [](const AnyImage& image) { return image.array.ndim(); });
  m.def("extract", &extract_any, py::arg("image"), py::arg("level"), py::arg("double"), py::arg("options"),
        py::arg("progress"), doc::extract);
  m.def("extract_periodic", &extract_periodic_any, py::arg("image"), py::arg("axes"), py::arg("periods"),
        py::arg("level"), py::arg("double"), py::arg("options"), py::arg("progress"), doc::extract_periodic);
  m.def("extract_curved", &extract_curved_any, py::arg("image"), py::arg("curved"), py::arg("axes"), py::arg("periods"),
        py::arg("level"), py::arg("double"), py::arg("options"), py::arg("progress"), doc::extract_curved);
  m.def("by_points", &by_points_any, py::arg("arrays"), py::arg("threads"), doc::by_points);
  m.def("longitude_axes", &longitude_axes_any, py::arg("image"), py::arg("curved"), doc::longitude_axes);
  m.def("axis_of_longitudes", &axis_of_longitudes_any, py::arg("image"), py::arg("curved"), doc::axis_of_longitudes);
  m.def("continue_longitudes", &continue_longitudes_any, py::arg("values").noconvert(), py::arg("sizes"),
        doc::continue_longitudes);
  m.def("is_longitude_unit", &is_longitude_unit, py::arg("unit"), doc::is_longitude_unit);
  m.def("find_folds", &find_folds_any, py::arg("image"), py::arg("curved"), py::arg("axes"), py::arg("periods"),
        doc::find_folds);
  m.def("extract_placed", &extract_placed_any, py::arg("image"), py::arg("rule"), py::arg("values"), py::arg("custom"),
        py::arg("margin"), py::arg("last_axis_weight"), py::arg("cells"), py::arg("curved"), py::arg("level"),
        py::arg("double"), py::arg("options"), py::arg("progress"), doc::extract_placed);
  m.def("extract_lattice", &extract_lattice_any, py::arg("image"), py::arg("lattice"), py::arg("axes"),
        py::arg("periods"), py::arg("level"), py::arg("double"), py::arg("options"), py::arg("progress"),
        doc::extract_lattice);
  m.def("extract_divided", &extract_divided_any, py::arg("image"), py::arg("division"), py::arg("axes"),
        py::arg("periods"), py::arg("level"), py::arg("double"), py::arg("options"), py::arg("progress"),
        doc::extract_divided);
  m.def("unroll", &unroll_any, py::arg("contour"), doc::unroll);
  m.def("count", &count_any, py::arg("image"), py::arg("axes"), py::arg("periods"), py::arg("lattice"),
        py::arg("division"), py::arg("level"), py::arg("options"), py::arg("progress"), doc::count);
  m.def("slice_image", &cut_any, py::arg("image"), py::arg("level"), py::arg("axis"), py::arg("at"), py::arg("double"),
        py::arg("options"), py::arg("progress"), doc::slice_image);
}

}  // namespace tegl::python
