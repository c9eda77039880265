// SPDX-License-Identifier: BSD-3-Clause
//
// Normals of existing contours: from their geometry, or from the gradient of an image.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "tegl/contour.hpp"
#include "tegl/extract.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// All kinds of normals, in order.
inline constexpr std::array kNormals = {Normals::none,    Normals::differences, Normals::sobel,   Normals::prewitt,
                                        Normals::forward, Normals::backward,    Normals::context, Normals::kernel};
/// The name of a kind, as options have it: "gradient" for `differences`, otherwise the name here.
[[nodiscard]] constexpr std::string_view name_of(Normals kind) noexcept {
  constexpr std::array<std::string_view, kNormals.size()> kNames = {"none",    "gradient", "sobel",   "prewitt",
                                                                    "forward", "backward", "context", "kernel"};
  return kNames[static_cast<std::size_t>(kind)];
}

/// The weight of a simplex in the normal of one of its vertices. area: length, area or volume of the simplex. angle:
/// its angle at the vertex (N = 4: solid angle), which does not depend on how a flat facet is divided into simplices.
/// equal: 1, the thesis's plain mean. In 2D all angles are equal.
enum class NormalWeights { area, angle, equal };

/// The unit normal of every simplex, #S x N, on the side that its orientation faces; 0 for simplices of zero size. N =
/// 2, 3, 4. Errors: InvalidArgument (a vertex number out of range); Cancelled. O(#S) time; thread-safe. Source: M.
/// Liversage, thesis, 1994, section 8.2.4.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Buffer<typename Contour<N, Real>::Vertex> flat_normals(const Contour<N, Real>& contour,
                                                                     const WorkOptions& work = {});

/// The unit normal of every vertex from its simplices, #V x N, as in Contour::normals: their weighted mean unit normal;
/// 0 if that vanishes and for vertices without simplices. Simplices of zero size have no weight. Needs no image and
/// follows the surface with its corners. If an image is available, gradient normals are more accurate by one order
/// (docs/normals.md). N = 2, 3, 4.
///
/// Errors: InvalidArgument (a vertex number out of range); Cancelled. O(#S + #V) time, one thread for the sums; 8 N
/// bytes per vertex and simplex. Thread-safe. Sources: M. Liversage, thesis, 1994, section 8.2.5; angles: G. Thuermer
/// and C. A. Wuethrich, "Computing Vertex Normals from Polygonal Facets", 1998; solid angles: A. van Oosterom and J.
/// Strackee, "The Solid Angle of a Plane Triangle", 1983.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Buffer<typename Contour<N, Real>::Vertex> geometric_normals(const Contour<N, Real>& contour,
                                                                          NormalWeights weights = NormalWeights::angle,
                                                                          const WorkOptions& work = {});

/// The normal of every vertex from an image, #V x N, as `extract` computes it with the same kind. Works for
/// any contour in the image's world coordinates, such as a loaded or a simplified one. The gradients at the samples of
/// the vertex's cell are interpolated multilinearly, on the side of the contour's `direction`, and scaled to length 1.
/// 0 if the gradient is zero and outside of the grid (by more than a thousandth of a step). With Normals::context,
/// vertices on edges of the grid have the gradients at both ends as seen along the edge. N = 2, 3, 4.
/// Errors: InvalidArgument (Normals::none, a wrong kernel); Cancelled. O(#V 4^N) time, O(#V 6^N) with kernels.
/// Thread-safe. Source: M. Liversage, thesis, 1994, sections 8.2.6 to 8.2.16.
template <Value T, int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Buffer<typename Contour<N, Real>::Vertex> gradient_normals(const Image<T, N>& image,
                                                                         const Contour<N, Real>& contour,
                                                                         Normals kind = Normals::differences,
                                                                         const WorkOptions& work = {},
                                                                         const GradientKernel& kernel = {});

/// How uncertain the normal by Normals::context is at every vertex, #V numbers between 0 and 1: the part of the values'
/// variation within the vertex's context that a linear function does not explain, residual / (residual + slope), as
/// weighted root mean squares over a sample and its neighbours. 0: the values are linear; about 0.1 on smooth surfaces
/// with a radius of a few steps; near 1: noise, or no gradient. 1 outside of the grid. N = 2, 3, 4. Errors: Cancelled.
/// O(#V 6^N) time. Thread-safe.
template <Value T, int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Buffer<double> normal_uncertainty(const Image<T, N>& image, const Contour<N, Real>& contour,
                                                const WorkOptions& work = {});

namespace detail {

/// As normal_uncertainty, for the vertices at which `result` is NaN.
template <Value T, int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void complete_uncertainty(const Image<T, N>& image, const Contour<N, Real>& contour, const WorkOptions& work,
                          Buffer<double>& result);

}  // namespace detail

}  // namespace tegl
