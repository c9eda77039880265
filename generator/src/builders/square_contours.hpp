// SPDX-License-Identifier: BSD-3-Clause
//
// The contour in a square by the rule that its builder is emitted from: maximal runs of corners are cut off.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace tegl::gen {

/// The corners of the square in counter-clockwise order.
inline constexpr std::array<std::uint8_t, 4> kRingCorner = {0, 1, 3, 2};
/// The edges between them: ring edge k joins ring corners k and k + 1.
inline constexpr std::array<std::uint8_t, 4> kRingEdge = {0, 3, 1, 2};

/// A segment by its two edges; high corners are on its left.
using SquareSegment = std::array<std::uint8_t, 2>;

/// The segments in a square: each maximal run of corners that differ from the centre is cut off. In the order of each
/// segment's first edge on the ring. `centre_high` has an effect on signatures 6 and 9 only.
[[nodiscard]] std::vector<SquareSegment> square_segments(unsigned signature, bool centre_high);

/// Certifies square_segments for all signatures and both signs of the centre, and compares it with tile::FacetBuilder.
/// Errors: CertificateFailed.
void certify_squares();

}  // namespace tegl::gen
