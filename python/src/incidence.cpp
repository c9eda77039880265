// SPDX-License-Identifier: BSD-3-Clause
//
// The incidence of a contour's simplices for Python: made once, passed to several operations.
#include "incidence.hpp"

#include "docs.hpp"

namespace tegl::python {

namespace {

std::unique_ptr<AnyIncidence> incidence_of(const AnyContour& contour, unsigned threads, const py::object& progress) {
  Call call(progress);
  const WorkOptions work{threads, call.progress()};
  return call.run([&] {
    return std::visit(
        [&]<int N, class Real>(const Contour<N, Real>& c) {
          return std::unique_ptr<AnyIncidence>(new AnyIncidence{Incidence<N>(c, work)});
        },
        contour.contour);
  });
}

std::size_t vertex_count(const AnyIncidence& any) {
  return std::visit([](const auto& incidence) { return incidence.vertex_count(); }, any.incidence);
}

std::size_t simplex_count(const AnyIncidence& any) {
  return std::visit([](const auto& incidence) { return incidence.simplex_count(); }, any.incidence);
}

/// #S x N simplices. `self` keeps the memory.
py::array across(const py::object& self) {
  return std::visit(
      [&]<int N>(const Incidence<N>& incidence) {
        const auto rows = static_cast<py::ssize_t>(incidence.simplex_count());
        const Index* data = rows == 0 ? nullptr : incidence.across(0).data();
        return read_only(data, {rows, static_cast<py::ssize_t>(N)}, self);
      },
      py::cast<const AnyIncidence&>(self).incidence);
}

/// The simplices around a vertex. `self` keeps the memory.
py::array around(const py::object& self, std::size_t vertex) {
  return std::visit(
      [&](const auto& incidence) {
        if (vertex >= incidence.vertex_count())
          throw Error(ErrorCode::InvalidArgument, fmt::format("vertex is {}; expected a number below {}, the vertices",
                                                              vertex, incidence.vertex_count()));
        const auto found = incidence.around(static_cast<Index>(vertex));
        return read_only(found.data(), {static_cast<py::ssize_t>(found.size())}, self);
      },
      py::cast<const AnyIncidence&>(self).incidence);
}

bool fits(const AnyIncidence& incidence, const AnyContour& contour) {
  const py::gil_scoped_release release;
  return std::visit(
      [&]<int N, class Real>(const Contour<N, Real>& c) {
        const auto* same_dimension = std::get_if<Incidence<N>>(&incidence.incidence);
        return same_dimension != nullptr && same_dimension->fits(c);
      },
      contour.contour);
}

}  // namespace

void bind_incidence(py::module_& m) {
  py::class_<AnyIncidence>(m, "Incidence", doc::Incidence)
      .def(py::init(&incidence_of), py::arg("contour"), py::arg("threads"), py::arg("progress"))
      .def_property_readonly("vertex_count", &vertex_count)
      .def_property_readonly("simplex_count", &simplex_count)
      .def_property_readonly("across", &across)
      .def("around", &around, py::arg("vertex"))
      .def("fits", &fits, py::arg("contour"));
}

}  // namespace tegl::python
