// SPDX-License-Identifier: BSD-3-Clause
//
// Balls from spheres without added vertices (private to the generator).
#pragma once

#include <cstddef>
#include <vector>

#include "filling/sigma_complex.hpp"
#include "filling/tile_contour.hpp"

namespace tegl::gen {

/// What a sphere is filled with: tetrahedra of its own vertices, and, where these leave something over, the triangles
/// around that (by ascending vertices), over which a cone from an added vertex has to be made.
struct Shelling {
  std::vector<Simplex> tetrahedra;
  std::vector<Simplex> rest;
  [[nodiscard]] bool empty() const { return tetrahedra.empty(); }
};

/// Few tetrahedra, those of the cone included, that fill a triangulated sphere, each one of those of its own vertices
/// allowed by `sigma`; empty if nothing is found with at most `limit`. Depends on the set of triangles alone, not on
/// their order or orientation. Not oriented: vertices ascend.
///
/// Tetrahedra are taken off the ball one by one, so that what is left is a ball at any time: either around a vertex
/// with three triangles, which then is gone, or over two triangles with a common edge, which then is exchanged for the
/// other diagonal. With V vertices and x exchanges that makes V - 3 + x tetrahedra, if it comes to an end. The order of
/// the steps is searched for, by many tries with seeded choices.
Shelling shell_sphere(const std::vector<Simplex>& sphere, const SigmaComplex& sigma, std::size_t limit);

}  // namespace tegl::gen
