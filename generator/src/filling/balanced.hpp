// SPDX-License-Identifier: BSD-3-Clause
//
// Balanced fillings: those that do not depend on which side of the contour is high. A tile and its complement have the
// same simplices with opposite orientations, so the contours of an image and of its negative together enclose the whole
// image. Estimated ambiguities use them. The tables of a fixed alternative prefer one side: their chords follow the
// convex hull of the low corners.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "filling/facets.hpp"

namespace tegl::gen {

/// The triangles of a polygon as a fan from its vertex with the largest number, with the polygon's orientation. If
/// every polygon of a tesseract's cubes is such a fan, the cone from a component's largest vertex is embedded: the fans
/// contain each triangle around that vertex. (Fans from the smallest vertex give 0.7 % more tetrahedra on smooth data.)
[[nodiscard]] std::vector<std::array<std::uint8_t, 3>> balanced_fan(const std::vector<std::uint8_t>& polygon);
/// The same from another vertex of the polygon.
[[nodiscard]] std::vector<std::array<std::uint8_t, 3>> fan_from(std::uint8_t apex,
                                                                const std::vector<std::uint8_t>& polygon);

/// The compact contours of the tesseracts that do not depend on the data beyond their signature, by signature; the
/// others are empty.
struct BalancedTesseracts {
  std::vector<TileContour> contours;
  std::uint64_t signatures = 0;  ///< number of tesseracts with a contour
  std::uint64_t simplices = 0;   ///< sum over them
};

/// Builds and certifies them: each is a manifold bounded by Sigma, proved to be embedded for all positions, within its
/// cubes and between them, and the complement's contour with reversed orientation. `depends_on_data`: by signature.
/// Throws Error{CertificateFailed}.
[[nodiscard]] BalancedTesseracts make_balanced_tesseracts(const Lattice& lattice,
                                                          const std::vector<bool>& depends_on_data);

}  // namespace tegl::gen
