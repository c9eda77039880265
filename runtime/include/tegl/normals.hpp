// SPDX-License-Identifier: BSD-3-Clause
//
// Normals of contours that are there: from their own shape, or from an image's gradient.
#pragma once

#include "tegl/contour.hpp"
#include "tegl/extract.hpp"

namespace tegl {

/// What a simplex counts for in the normal of one of its vertices: its area (length, volume); its angle there (N = 4:
/// solid angle), which does not depend on how a flat facet is divided into simplices; or as much as any other, which is
/// the thesis's plain mean. In 2D all angles are alike.
enum class NormalWeights { area, angle, equal };

/// The unit normal of every simplex, #S x N, to the side that its orientation faces; 0 for one of zero size. N = 2, 3,
/// 4. Errors: InvalidArgument (a vertex number out of range); Cancelled. O(#S) time; thread-safe. Source: M. Liversage,
/// thesis, 1994, section 8.2.4.
template <int N, class Real>
requires DimensionBetween<N, 2, 4> Buffer<typename Contour<N, Real>::Vertex> flat_normals(
    const Contour<N, Real>& contour, const WorkOptions& options = {});

/// The unit normal of every vertex from the simplices around it, #V x N, as Contour::normals has them: the mean of
/// their unit normals by `weights`; 0 where that vanishes and for vertices in no simplex. Simplices of zero size count
/// for nothing. It needs no image and follows the surface as it is, with its corners; where an image is at hand its
/// gradient is an order more exact (docs/normals.md). N = 2, 3, 4.
///
/// Errors: InvalidArgument (a vertex number out of range); Cancelled. O(#S + #V) time, one thread for the sums; 8 N
/// bytes per vertex and simplex. Thread-safe. Sources: M. Liversage, thesis, 1994, section 8.2.5; angles: G. Thuermer
/// and C. A. Wuethrich, "Computing Vertex Normals from Polygonal Facets", 1998; solid angles: A. van Oosterom and J.
/// Strackee, "The Solid Angle of a Plane Triangle", 1983.
template <int N, class Real>
requires DimensionBetween<N, 2, 4> Buffer<typename Contour<N, Real>::Vertex> geometric_normals(
    const Contour<N, Real>& contour, NormalWeights weights = NormalWeights::angle, const WorkOptions& options = {});

/// The normal of every vertex from an image, #V x N: what `extract` with ExtractOptions::normals gives, but for any
/// contour in the image's world, such as a saved or a simplified one; the gradients at the samples of the vertex's
/// cell, interpolated multilinearly, in the contour's `direction`, of length 1. 0 where the gradient vanishes and
/// outside of the grid (by more than a thousandth of a step). N = 2, 3, 4.
/// Errors: Cancelled. O(#V 4^N) time. Thread-safe. Source: M. Liversage, thesis, 1994, sections 8.2.6 to 8.2.15.
template <Value T, int N, class Real>
requires DimensionBetween<N, 2, 4> Buffer<typename Contour<N, Real>::Vertex> gradient_normals(
    const Image<T, N>& image, const Contour<N, Real>& contour, GradientKind kind = GradientKind::differences,
    const WorkOptions& options = {});

}  // namespace tegl
