// SPDX-License-Identifier: BSD-3-Clause
//
// Contours as facets for Python: arrays of each dimension, checks, files, triangles.
#include "facets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "binding.hpp"
#include "docs.hpp"
#include "periods.hpp"
#include "tegl/io/facets.hpp"
#include "tegl/polygons.hpp"

namespace tegl::python {

namespace {

/// `axes`: the periodic axes, with their periods (NaN: by the samples); `lattice`, `division`: names. All are empty for
/// none.
std::unique_ptr<AnyFacets> extract_facets_any(const AnyImage& image, const std::string& lattice,
                                              const std::string& division, const std::vector<int>& axes,
                                              const std::vector<double>& periods, double level, bool is_double,
                                              const py::dict& arguments, const py::object& progress) {
  Call call(progress);
  const ExtractOptions options = extract_options(arguments, call);
  const auto of_view = [&]<class T, int N>(const Image<T, N>& given_image) -> std::unique_ptr<AnyFacets> {
    if constexpr (N <= 4) {
      const Image<T, N> view = periodic_samples(given_image, axes, periods);
      const AxisPeriods<N> given = periods_of(view.grid(), axes, periods);
      const auto extracted = [&]<class Real>(Real) {
        if (!division.empty()) {
          const auto by = named<Division>("division", division, divisions());
          return std::make_unique<AnyFacets>(extract_facets<Real>(view, by, level, options, given), level);
        }
        if (lattice.empty())
          return std::make_unique<AnyFacets>(extract_facets<Real>(view, level, options, given), level);
        const auto on = named<Lattice>("lattice", lattice, lattices());
        return std::make_unique<AnyFacets>(extract_facets<Real>(view, on, level, options, given), level);
      };
      return is_double ? extracted(double{}) : extracted(float{});
    } else {
      throw_dimension("facets", N, "2 to 4 dimensions");
    }
  };
  return call.run([&] { return visit_image(image, of_view); });
}

/// A getter of read-only arrays: get(facets, owner).
template <class Get>
auto of_facets(const Get& get) {
  return [get](const py::object& self) {
    const auto& any = py::cast<const AnyFacets&>(self);
    return std::visit([&](const auto& facets) { return get(facets, self); }, any.facets);
  };
}

constexpr auto dimension_of = []<int N, class Real>(const FacetHierarchy<N, Real>&, py::handle) { return N; };
constexpr auto rows_of = []<std::size_t N, class Real>(const Buffer<std::array<Real, N>>& rows, py::handle owner) {
  const auto count = static_cast<py::ssize_t>(rows.size());
  return read_only(count == 0 ? nullptr : rows.data()->data(), {count, static_cast<py::ssize_t>(N)}, owner);
};
constexpr auto vertices_of = [](const auto& facets, py::handle owner) { return rows_of(facets.vertices, owner); };
constexpr auto normals_of = [](const auto& facets, py::handle owner) -> py::object {
  if (facets.normals.empty() && !facets.vertices.empty()) return py::none();
  return rows_of(facets.normals, owner);
};
constexpr auto names_of = [](const auto& facets, py::handle) {
  return std::vector<std::string>(facets.axis_names.begin(), facets.axis_names.end());
};
constexpr auto units_of = [](const auto& facets, py::handle) {
  return std::vector<std::string>(facets.axis_units.begin(), facets.axis_units.end());
};
constexpr auto direction_of = [](const auto& facets, py::handle) {
  return facets.direction == GradientDirection::descent ? "descent" : "ascent";
};
constexpr auto period_numbers_of = []<int N, class Real>(const FacetHierarchy<N, Real>& facets, py::handle) {
  return period_numbers<N>(facets.periods);
};
constexpr auto sizes_of = [](const auto& facets, py::handle) {
  return std::vector<std::size_t>(facets.sizes.begin(), facets.sizes.end());
};
constexpr auto cells_of = [](const auto& facets, py::handle) { return facets.cells; };

template <class T>
py::array numbers_of(const Buffer<T>& numbers, py::handle owner) {
  return read_only(numbers.data(), {static_cast<py::ssize_t>(numbers.size())}, owner);
}

/// Calls visit(facets, k) with the hierarchy. Throws InvalidArgument for a dimension that it does not have.
template <class Visit>
auto visit_level(const AnyFacets& any, int k, const Visit& visit) {
  return std::visit(
      [&]<int N, class Real>(const FacetHierarchy<N, Real>& facets) {
        if (k < 0 || k >= N)
          throw Error(ErrorCode::InvalidArgument, fmt::format("facets of dimension {}; expected 0 to {}", k, N - 1));
        return visit(facets, k);
      },
      any.facets);
}

/// A member of all places, without a copy.
template <class T>
py::array member_of(const Buffer<FacetPlace>& places, const T FacetPlace::*member, py::handle owner) {
  const auto count = static_cast<py::ssize_t>(places.size());
  if (count == 0) return py::array_t<T>(0);
  py::array result(py::dtype::of<T>(), std::vector<py::ssize_t>{count},
                   std::vector<py::ssize_t>{py::ssize_t{sizeof(FacetPlace)}}, &(places.data()->*member), owner);
  py::detail::array_proxy(result.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return result;
}

py::dict places_of(const py::object& self, int k) {
  return visit_level(py::cast<const AnyFacets&>(self), k, [&](const auto& facets, int dim) {
    const auto& places = facets.levels[static_cast<std::size_t>(dim)].places;
    py::dict result;
    result["base"] = member_of(places, &FacetPlace::base, self);
    result["signature"] = member_of(places, &FacetPlace::signature, self);
    result["axes"] = member_of(places, &FacetPlace::axes, self);
    result["number"] = member_of(places, &FacetPlace::number, self);
    result["is_cap"] = member_of(places, &FacetPlace::is_cap, self);
    return result;
  });
}

/// The boundaries: (first, facets, signs); of points without entries.
py::tuple down_of(const py::object& self, int k) {
  return visit_level(py::cast<const AnyFacets&>(self), k, [&](const auto& facets, int dim) {
    const auto& level = facets.levels[static_cast<std::size_t>(dim)];
    return py::make_tuple(numbers_of(level.down_first, self), numbers_of(level.down, self),
                          numbers_of(level.down_signs, self));
  });
}

/// The facets that facets bound: (first, facets, signs); of the highest dimension without entries.
py::tuple up_of(const py::object& self, int k) {
  auto& any = py::cast<AnyFacets&>(self);
  {
    const py::gil_scoped_release release;
    std::call_once(any.connected, [&] { std::visit([](auto& facets) { facets.connect_up(); }, any.facets); });
  }
  return visit_level(any, k, [&](const auto& facets, int dim) {
    const auto& level = facets.levels[static_cast<std::size_t>(dim)];
    return py::make_tuple(numbers_of(level.up_first, self), numbers_of(level.up, self),
                          numbers_of(level.up_signs, self));
  });
}

/// The points of each facet: (first, points).
py::tuple points_of(const AnyFacets& any, int k) {
  Buffer<std::uint64_t> first;
  Buffer<Index> points;
  {
    const py::gil_scoped_release release;
    std::vector<Index> all;
    visit_level(any, k, [&](const auto& facets, int dim) {
      const std::size_t count = facets.count(dim);
      first.resize(count + 1);
      first[0] = 0;
      for (std::size_t f = 0; f < count; ++f) {
        const std::vector<Index> own = facets.points_of(dim, f);
        all.insert(all.end(), own.begin(), own.end());
        first[f + 1] = all.size();
      }
    });
    points.resize(all.size());
    std::copy(all.begin(), all.end(), points.begin());
  }
  return py::make_tuple(owned(std::move(first)), owned(std::move(points)));
}

py::array euler_of(const AnyFacets& any, int k) {
  Buffer<std::int32_t> numbers;
  {
    const py::gil_scoped_release release;
    visit_level(any, k, [&](const auto& facets, int dim) {
      numbers.resize(facets.count(dim));
      for (std::size_t f = 0; f < numbers.size(); ++f) numbers[f] = facet_euler(facets, dim, f);
    });
  }
  return owned(std::move(numbers));
}

py::dict check_facets(const AnyFacets& any, const py::object& progress) {
  Call call(progress);
  const WorkOptions work{1, call.progress()};
  const FacetReport report =
      call.run([&] { return std::visit([&](const auto& facets) { return check(facets, work); }, any.facets); });
  const int dim = std::visit([]<int N, class Real>(const FacetHierarchy<N, Real>&) { return N; }, any.facets);
  py::dict result;
  put(result, "counts", std::vector<std::uint64_t>(report.facets.begin(), report.facets.begin() + dim));
  put(result, "components", report.components);
  put(result, "euler", report.euler);
  put(result, "tori", report.tori);
  put(result, "below_zero", report.below_zero);
  put(result, "above_one", report.above_one);
  put(result, "border", report.border);
  put(result, "branching", report.branching);
  put(result, "conflicts", report.conflicts);
  put(result, "open_boundaries", report.open_boundaries);
  return result;
}

void write_facets_any(const AnyFacets& any, const std::string& path, bool is_compressed, const py::object& progress) {
  Call call(progress);
  const Progress tell = call.progress();
  call.run([&] {
    const FileLock lock(tell);
    const WriteOptions options{.work = {.progress = tell},
                               .compression = is_compressed ? Compression::deflate : Compression::none};
    std::visit([&](const auto& facets) { write_facets(facets, path, options); }, any.facets);
  });
}

std::unique_ptr<AnyContour> triangulate_any(const AnyFacets& any, const std::string& name, unsigned threads,
                                            const py::object& progress) {
  Call call(progress);
  const WorkOptions work{threads, call.progress()};
  const auto method = named<PolygonTriangulation>("method", name,
                                                  {{"fan", PolygonTriangulation::fan},
                                                   {"zigzag", PolygonTriangulation::zigzag},
                                                   {"halving-chord", PolygonTriangulation::halving_chord},
                                                   {"halving-kink", PolygonTriangulation::halving_kink},
                                                   {"barycentric", PolygonTriangulation::barycentric}});
  return call.run([&] {
    return std::visit(
        [&]<int N, class Real>(const FacetHierarchy<N, Real>& facets) -> std::unique_ptr<AnyContour> {
          if constexpr (N == 3) {
            auto result = std::make_unique<AnyContour>();
            *result = {triangulate(facets, method, work), any.isovalue};
            return result;
          } else {
            throw_dimension("triangulate", N, "3 dimensions, whose facets are polygons");
          }
        },
        any.facets);
  });
}

}  // namespace

void bind_facets(py::module_& m) {
  py::class_<AnyFacets>(m, "Facets", doc::FacetHierarchy)
      .def_property_readonly("ndim", of_facets(dimension_of), "N, the number of coordinates of a point.")
      .def_property_readonly("vertices", of_facets(vertices_of))
      .def_property_readonly("normals", of_facets(normals_of))
      .def_property_readonly("axis_names", of_facets(names_of))
      .def_property_readonly("axis_units", of_facets(units_of))
      .def_property_readonly("direction", of_facets(direction_of))
      .def_property_readonly("periods", of_facets(period_numbers_of), "vector, dual and start of each period, flat")
      .def_property_readonly("sizes", of_facets(sizes_of), "of the image; 0 for a mesh or lattice")
      .def_property_readonly("cells", of_facets(cells_of), "of the mesh or lattice; 0 for an image")
      .def_readonly("isovalue", &AnyFacets::isovalue)
      .def("places", &places_of, py::arg("dimension"), doc::FacetPlace)
      .def("down", &down_of, py::arg("dimension"), "(first, facets, signs) of the boundaries")
      .def("up", &up_of, py::arg("dimension"), "(first, facets, signs) of the facets that facets bound")
      .def("points", &points_of, py::arg("dimension"), "(first, points) of each facet")
      .def("euler", &euler_of, py::arg("dimension"), doc::facet_euler);
  m.def("extract_facets", &extract_facets_any, py::arg("image"), py::arg("lattice"), py::arg("division"),
        py::arg("axes"), py::arg("periods"), py::arg("level"), py::arg("double"), py::arg("options"),
        py::arg("progress"), doc::extract_facets);
  m.def("check_facets", &check_facets, py::arg("facets"), py::arg("progress"), doc::FacetReport);
  m.def("write_facets", &write_facets_any, py::arg("facets"), py::arg("path"), py::arg("compressed"),
        py::arg("progress"), doc::write_facets);
  m.def("triangulate", &triangulate_any, py::arg("facets"), py::arg("method"), py::arg("threads"), py::arg("progress"),
        doc::triangulate);
}

}  // namespace tegl::python
