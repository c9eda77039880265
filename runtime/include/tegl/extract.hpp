// SPDX-License-Identifier: BSD-3-Clause
//
// Extraction of contours (isolines, isosurfaces and their higher-dimensional counterparts) from 2D to 5D images.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <type_traits>
#include <vector>

#include "tegl/ambiguity.hpp"
#include "tegl/contour.hpp"
#include "tegl/image.hpp"
#include "tegl/tile/triangulation.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// Whether normals are computed from the image, and how the gradient at a sample is computed for them
/// (docs/normals.md). differences: the mean of the forward and the backward difference quotient. forward, backward: one
/// of them; at the border the other one. sobel: a mean of differences over the sample's own line and the neighbouring
/// lines of samples, weighted by nearness; damps noise and takes ten times as long. prewitt: the same with equal
/// weights. kernel: the same with weights of the caller (GradientKernel). context: a linear function that fits those
/// neighbours that belong to the same side of jumps and kinks of the values; for images of several materials.
enum class Normals { none, differences, sobel, prewitt, forward, backward, context, kernel };

/// A kernel for the derivative along axis 0: 3^N weights of the sample and its neighbours, with index
/// sum_a (1 + offset_a) 3^a. For the derivative along axis a, axes 0 and a are exchanged. Or N 3^N weights: one kernel
/// for each axis, one after the other. On each line along the axis of the derivative the three weights must sum to 0:
/// so the kernel is a sum of differences of neighbours, each of which is divided by its own distance. The result is
/// divided by the sum of the differences' weights, so that a linear function has its exact slope; this sum must not be
/// 0. Source: M. Liversage, thesis, 1994, 8.2.13 to 8.2.15.
struct GradientKernel {
  std::vector<double> weights = {};  ///< 3^N or N 3^N
};

/// Options of all functions that extract contours: in memory, streamed, counted, as facets, slices or components.
struct ExtractOptions {
  Triangulation triangulation = Triangulation::compact;      ///< how facets are divided into simplices
  Ambiguity ambiguity = Ambiguity::low;                      ///< how ambiguous faces are resolved
  Estimator estimator = {};                                  ///< for Ambiguity::custom; ignored otherwise
  GradientDirection direction = GradientDirection::descent;  ///< the side that the contour faces
  /// Closes the contour at the image border by caps: the high part of the border itself. At missing values inside the
  /// image the contour stays open.
  bool close = false;
  /// Keeps the points on edges at least this share of an edge away from the samples, in [0, 0.5). 0: exact positions; a
  /// sample that equals the isovalue gives simplices of zero size. Values such as 0.01 avoid them; docs/limits.md lists
  /// the exceptions (4D beside missing values, closed 5D).
  double epsilon = 0.0;
  /// Vertex normals: along the image's gradient, on the side of `direction`; of length 1, or 0 if the gradient is zero.
  /// At the image border and next to missing values, gradients are one-sided differences. They are interpolated between
  /// samples, linearly along edges. Normals have the precision of the vertex type. If a 4D contour is separated next to
  /// missing values, a vertex added midway between two others gets the mean of their normals, of length 1. With
  /// Normals::context, `extract` of 2D to 4D images adds the vertex attribute "normal_uncertainty" (tegl/normals.hpp).
  Normals normals = Normals::none;
  GradientKernel kernel = {};  ///< for Normals::kernel; ignored otherwise
  /// Number of threads and progress. More threads than the machine has count as all of the machine. The progress
  /// callback is called only by the thread that called the extraction, at least once for each slab (the tiles between
  /// two layers of the last axis) and several times within large slabs. Fractions never decrease. The number of calls
  /// depends on the threads' speed. The callback may itself use threads (TBB): it is not called again while it waits
  /// for them.
  WorkOptions work = {};
};

/// Counts and times of one extraction.
struct ExtractStats {
  std::uint64_t tiles = 0;         ///< tiles of the image
  std::uint64_t active_tiles = 0;  ///< tiles with both high and low corners
  double read_seconds = 0;         ///< to read layers, if the image is streamed (tegl/stream.hpp)
  double classify_seconds = 0;     ///< to compare samples with the isovalue
  double find_seconds = 0;         ///< to find active tiles, count, and compute output offsets
  double generate_seconds = 0;     ///< to write vertices and simplices
  double close_seconds = 0;        ///< to make caps
};

/// A contour with the counts and times of its extraction.
template <int N, Coordinate Real = float>
requires DimensionBetween<N, 2, 5>
struct Extraction {
  Contour<N, Real> contour = {};  ///< the contour
  ExtractStats stats = {};        ///< counts and times
};

/// The size of a contour with the counts and times of its extraction.
struct ExtractedSize {
  ContourSize size = {};    ///< the size
  ExtractStats stats = {};  ///< counts and times
};

/// As `extract`, with counts and times.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Extraction<N, Real> extract_with_stats(const Image<T, N>& image, double isovalue,
                                                     const ExtractOptions& options = {});

/// Extracts the contour {value = isovalue} of an image. It separates samples >= isovalue (high) from the others.
///
/// The contour is an oriented manifold whatever the values. It has a boundary only at the image border and at missing
/// values. If tiles beside these share only faces of lower dimension, vertices there are doubled in place, so that the
/// contour is a manifold there too; in 5D by few cuts. Vertices of a 4D or 5D contour between two layers of
/// the last axis (in 5D of the last two) are kept off the layers by the smallest step of Real, so `slice` at a layer's
/// coordinate gives that layer's contour even if samples equal the isovalue. An image with an axis of one sample has no
/// tiles and an empty contour.
///
/// Errors: InvalidIsovalue (not finite), InvalidArgument (epsilon), TooLarge, Cancelled. Time: one pass over the
/// samples, plus the output. Working memory up to 4D: 1/16 of the size of
/// a float image, or 128 KiB (192 KiB in 4D with ambiguities resolved from the data) if that is more, and at least the
/// bits and lists of one slab (docs/cost.md). Real: float or double.
///
/// 5D has no tables. A tile is built when its signature first occurs, out of its ten tesseracts: in about 0.02 ms for
/// smooth images, 0.1 ms for noise. In the barycentric triangulation, whose contours have three to four times as many
/// simplices, these are 0.1 to 0.3 ms, up to symmetry, and 3 ms. Up to 256 MiB of built tiles and faces are cached,
/// whatever the number of threads; the tiles of two slabs are held in memory besides. With `close`, a 5D contour may
/// have simplices of zero size at the border.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Contour<N, Real> extract(const Image<T, N>& image, double isovalue, const ExtractOptions& options = {}) {
  return extract_with_stats<Real>(image, isovalue, options).contour;
}

/// Extracts the contours of several isovalues, one after another: contour i equals
/// `extract<Real>(image, isovalues[i], options)` byte by byte. Progress covers all contours. Isovalues may be in any
/// order and may repeat. Errors: those of `extract`, before any contour if an isovalue is not finite. Time: that of
/// `extract` for each isovalue; an index (tegl/active_tiles.hpp) saves reading the samples each time.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] std::vector<Contour<N, Real>> extract_several(const Image<T, N>& image, std::span<const double> isovalues,
                                                            const ExtractOptions& options = {});
/// The same for a list: `extract_several(image, {1.0, 2.0})`.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] std::vector<Contour<N, Real>> extract_several(const Image<T, N>& image,
                                                            std::initializer_list<double> isovalues,
                                                            const ExtractOptions& options = {}) {
  return extract_several<Real>(image, std::span<const double>(isovalues.begin(), isovalues.size()), options);
}

/// As `count`, with counts and times.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] ExtractedSize count_with_stats(const Image<T, N>& image, double isovalue,
                                             const ExtractOptions& options = {});

/// Counts the vertices and simplices that `extract` would make with these options, exactly. Takes little memory, and
/// less time than `extract` because nothing is written; with `close` or missing values everything except writing is
/// done. Errors: those of `extract` except TooLarge.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] ContourSize count(const Image<T, N>& image, double isovalue, const ExtractOptions& options = {}) {
  return count_with_stats(image, isovalue, options).size;
}

/// The types of vertex numbers.
template <class I>
concept VertexNumber = std::is_same_v<I, std::uint32_t> || std::is_same_v<I, std::uint64_t>;

/// Buffers of the caller that a contour is written to.
template <int N, Coordinate Real, VertexNumber I = Index>
requires DimensionBetween<N, 2, 4>
struct ContourRoom {
  std::span<std::array<Real, N>> vertices = {};  ///< #V x N; at least ContourSize::vertices rows, see `count`
  std::span<std::array<I, N>> simplices = {};    ///< #S x N; at least ContourSize::simplices rows
  std::span<std::array<Real, N>> normals = {};   ///< #V x N; used only if ExtractOptions::normals is not `none`
};

/// As `extract`, but writes to the caller's memory and returns the contour's size. `room` must hold at least that many
/// rows; `count` returns the size. With 64-bit numbers a contour may have any number of vertices. Vertices, normals and
/// simplices equal those of `extract` byte by byte, except for the width of the numbers. Images with missing values are
/// processed twice. Errors: those of `extract`; InvalidArgument if `room` is too small. After an error the contents of
/// the memory are undefined.
template <Value T, int N, Coordinate Real, VertexNumber I>
requires DimensionBetween<N, 2, 4> ExtractedSize extract_into(const Image<T, N>& image, double isovalue,
                                                              const ContourRoom<N, Real, I>& room,
                                                              const ExtractOptions& options = {});

}  // namespace tegl
