// SPDX-License-Identifier: BSD-3-Clause
//
// From a dimension to everything that is emitted for it: contours of both alternatives in both triangulations,
// certified; tables packed; regions.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tegl/gen/emit.hpp"

namespace tegl::gen {

/// The layout that measured faster for a dimension and triangulation: by class where the triangulation is
/// equivariant and flat tables would not fit the cache (4D barycentric), else flat.
Layout preferred_layout(int dim, Triangulation triangulation);

/// What to make.
struct TableRequest {
  int dim = 0;
  std::vector<Triangulation> triangulations{Triangulation::barycentric, Triangulation::compact};
  std::function<Layout(Triangulation)> layout;  ///< empty: preferred_layout
  std::string command;                          ///< for the banner
};

/// Builds and certifies; throws Error{CertificateFailed} or Error{Internal} before anything could be written.
TableSet make_table_set(const TableRequest& request);

/// The certificate of every signature of both alternatives in both triangulations.
std::vector<CertifiedFigures> certify_all(int dim);

/// Squares, cubes and tesseracts of a tile whose centre's sign matters, by dimension (index 2, 3, 4): ambiguous
/// squares; cubes and tesseracts whose Sigma, with squares resolved by `builder`'s rule, has several components or
/// one that is no sphere.
std::vector<std::uint32_t> ambiguous_faces(const CubeLattice& lattice, int dim, Alternative alternative,
                                           Signature signature);

}  // namespace tegl::gen
