// SPDX-License-Identifier: BSD-3-Clause
//
// Incidences of contours of any dimension, for the operations that accept one.
#pragma once

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "binding.hpp"
#include "tegl/incidence.hpp"

namespace tegl::python {

/// The incidence of a contour of any dimension; `_tegl.Incidence` in Python.
struct AnyIncidence {
  std::variant<Incidence<2>, Incidence<3>, Incidence<4>, Incidence<5>> incidence;
};

/// Calls operation(contour), or operation(contour, incidence) if one is given. Throws InvalidArgument for an incidence
/// of another dimension; other simplices are found by the operation.
template <class Operation>
decltype(auto) visit_with(const AnyContour& contour, const AnyIncidence* incidence, const Operation& operation) {
  return std::visit(
      [&]<int N, class Real>(const Contour<N, Real>& c) -> decltype(auto) {
        if (incidence == nullptr) return operation(c);
        const auto* of_contour = std::get_if<Incidence<N>>(&incidence->incidence);
        if (of_contour == nullptr)
          throw Error(ErrorCode::InvalidArgument,
                      fmt::format("an incidence of a {}D contour; expected that of this contour, of {}D",
                                  incidence->incidence.index() + 2, N));
        return operation(c, *of_contour);
      },
      contour.contour);
}

}  // namespace tegl::python
