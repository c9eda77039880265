// SPDX-License-Identifier: BSD-3-Clause
//
// Parts of the implementation of fields.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "tegl/field.hpp"

namespace tegl::detail {

inline constexpr std::size_t kMostCoordinates = 5;
using FieldPoint = std::array<double, kMostCoordinates>;

/// A field by a function of a point.
template <class AtPoint>
Field field_by_point(int dim, AtPoint at_point) {
  return Field(dim,
               [dim, at_point = std::move(at_point)](const double* start, double step, std::size_t count, double* out) {
                 FieldPoint point{};
                 std::copy_n(start, dim, point.begin());
                 for (std::size_t i = 0; i < count; ++i) {
                   point[0] = start[0] + static_cast<double>(i) * step;
                   out[i] = at_point(point);
                 }
               });
}

/// Quantum numbers of an orbital.
struct Orbital {
  int n = 1;
  int l = 0;
  int m = 0;
};

/// A real hydrogen-like wave function in units of Bohr radii: `extent` of these are one unit of length. 2D: in the
/// plane y = 0. 4D: the density of two orbitals with equal weights, one beat from t = -1 to 1. 5D: the same, with the
/// first orbital alone at u = -1, equal weights at 0 and the second one alone at 1. Errors: InvalidArgument for
/// impossible quantum numbers.
Field make_orbital(int dim, const Orbital& first, const Orbital& second, double extent);

}  // namespace tegl::detail
