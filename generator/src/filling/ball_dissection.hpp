// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts balls into tetrahedra without added vertices (private to the generator). Whether a given complex is a ball is
// decided by tile::shape_of.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "base/tile_contour.hpp"
#include "filling/sigma_complex.hpp"

namespace tegl::gen {

/// A ball cut into tetrahedra on the vertices of its boundary and, if a smaller ball remains, the boundary triangles of
/// that one (ascending vertices). It must be coned from an added vertex.
struct BallDissection {
  std::vector<LocalSimplex> tetrahedra;
  std::vector<LocalSimplex> rest;
  [[nodiscard]] bool empty() const { return tetrahedra.empty(); }
};

/// Searches for few tetrahedra that fill the ball inside a triangulated sphere, counting the tetrahedra of the cone
/// over `rest`. `sigma` must allow each tetrahedron on own vertices. Returns an empty result if at most `limit`
/// tetrahedra do not suffice. The result depends on the set of triangles only, not on their order or orientation. It is
/// not oriented: vertices ascend.
///
/// Tetrahedra are removed from the ball one by one so that the rest is always a ball: either around a vertex with three
/// triangles, which removes the vertex, or over two triangles with a common edge, which exchanges the edge for the
/// other diagonal. A complete removal with V vertices and x exchanges has V - 3 + x tetrahedra. Many tries with seeded
/// random choices search for a good order of steps.
///
/// If `accepts` is given, the result is the smallest one found for which it returns true. It is called for dissections
/// smaller than those accepted before.
BallDissection dissect_ball(const std::vector<LocalSimplex>& sphere, const SigmaComplex& sigma, std::size_t limit,
                            const std::function<bool(const BallDissection&)>& accepts = {});

}  // namespace tegl::gen
