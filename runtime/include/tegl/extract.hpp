// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of 2D, 3D, 4D and 5D images.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <type_traits>

#include "tegl/ambiguity.hpp"
#include "tegl/contour.hpp"
#include "tegl/image.hpp"

namespace tegl {

/// How facets become simplices: compact, with few of them (for intersections in 4D and biased volumes see
/// docs/limits.md), or coned from barycentres, with more and evener ones. In 5D both names mean barycentric.
enum class Triangulation { compact, barycentric };

/// How the gradient at a sample is made, which normals follow. differences: the mean of the difference quotients
/// forward and backward; sobel: the mean of those of all lines of samples beside it, itself among them, weighted by
/// their nearness (docs/normals.md): noise is damped, at ten times the cost.
enum class GradientKind { differences, sobel };

/// What a contour is made of, and how.
struct ExtractOptions {
  Triangulation triangulation = Triangulation::compact;      ///< how facets become simplices
  Ambiguity ambiguity = Ambiguity::low;                      ///< how ambiguous faces are resolved
  Estimator estimator = {};                                  ///< for Ambiguity::custom, else not looked at
  GradientDirection direction = GradientDirection::descent;  ///< which side it faces
  /// Close the contour at the image's border by the high part of the border itself. Where the border
  /// of the *data* lies inside the image (missing values), the contour stays open.
  bool close = false;
  /// Keeps the points on edges at least this share of an edge away from the samples, in [0, 0.5).
  /// 0: exact positions; where a sample equals the isovalue, simplices of zero size arise. (Whatever it is, four points
  /// of a compact 4D tile may lie in one plane.)
  double epsilon = 0.0;
  /// Whether vertices get normals: in the contour's `direction`, along the image's gradient there; of length 1, or 0
  /// where it vanishes. At samples it is the mean of the difference quotients forward and backward, at
  /// the image's border and next to missing values the one that there is; between samples it is interpolated (linearly
  /// along edges). Normals of a vertex are as exact as its type allows. Where a 4D contour is taken apart next to
  /// missing values, vertices put in the middle between two have the mean of their normals, of length 1.
  bool normals = false;
  GradientKind gradient = GradientKind::differences;  ///< what normals are made of
  /// How many threads work; 0, or more than there are: all that the machine has. The result is the same, byte by byte.
  unsigned threads = 0;
  /// Called by the thread that asks for the contour and by no other, for every slab (between two layers of the last
  /// axis) at least once, and within large ones, with fractions that do not fall; how often depends on the threads'
  /// pace. It may use threads (TBB) itself: while it waits for them, it is not called again.
  Progress progress = {};
};

/// What an extraction did, for reports.
struct ExtractStats {
  std::uint64_t tiles = 0;         ///< of the image
  std::uint64_t active_tiles = 0;  ///< those with high and low corners
  double read_seconds = 0;         ///< layers, where they come one by one (tegl/stream.hpp)
  double classify_seconds = 0;     ///< samples against the isovalue
  double find_seconds = 0;         ///< active tiles, counts, places in the output
  double generate_seconds = 0;     ///< vertices and simplices
  double close_seconds = 0;        ///< caps
};

/// The contour {value = isovalue} of an image: separates samples >= isovalue (high) from the others.
///
/// Closed (away from the image's border and from missing values), a manifold and oriented, whatever
/// the values. Where tiles next to missing values meet in an edge or a square of the grid alone, the vertices there are
/// doubled, in the same place, so that the contour is a manifold there too. Points of a 4D contour between two layers
/// of the last axis are kept off the layers by the least that Real can show, so that `slice` finds the contour of a
/// layer in it even where samples equal the isovalue. An image with an axis of one sample has no tiles, hence an empty
/// contour. Errors: InvalidIsovalue (not finite), InvalidArgument (epsilon), TooLarge, Cancelled; UnsupportedData for
/// 5D images with missing values. Cost: one pass over the samples plus the output. Memory beside both, up to 4D: 1/16
/// of an image of float, or 128 KiB where that is more; and at least one slab's bits and lists (docs/cost.md). Real:
/// float or double.
///
/// 5D: no tables; a tile is built when its signature is first met, up to symmetry: 0.1 to 0.3 ms for each where the
/// image is smooth, 3 ms in noise. That is little for smooth images, which have few kinds of tiles, and nearly all for
/// noise. Up to 256 MiB of built tiles and of their faces are kept for the next ones, whatever the number of threads;
/// beside them, in memory, are the tiles of two slabs. Closed at the border, a 5D contour may have simplices of zero
/// size there.
template <class Real = float, Value T, int N>
Contour<N, Real> extract(const Image<T, N>& image, double isovalue, const ExtractOptions& options = {},
                         ExtractStats* stats = nullptr);

/// The size of the contour that `extract` with these options would make, exactly. Needs little memory, and less time
/// than `extract`: nothing is written (but where the border is closed or samples are missing, all but the writing is
/// done). Errors: those of `extract`, but TooLarge.
template <Value T, int N>
ContourSize count(const Image<T, N>& image, double isovalue, const ExtractOptions& options = {},
                  ExtractStats* stats = nullptr);

/// A type that vertices can be numbered by.
template <class I>
concept VertexNumber = std::is_same_v<I, std::uint32_t> || std::is_same_v<I, std::uint64_t>;

/// Memory of the caller's for a contour.
template <int N, Coordinate Real, VertexNumber I = Index>
requires DimensionBetween<N, 2, 4>
struct ContourRoom {
  std::span<std::array<Real, N>> vertices = {};  ///< at least as many as `count` says
  std::span<std::array<I, N>> simplices = {};    ///< likewise
  std::span<std::array<Real, N>> normals = {};   ///< used with ExtractOptions::normals alone: as many as vertices
};

/// As `extract`, into memory of the caller's, which has to have room for the contour's size (`count` tells it) or more;
/// returns that size. With numbers of 64 bits a contour may have any number of vertices. Vertices, normals and
/// simplices are the same, byte by byte but for the width of the numbers. Images with missing values are gone through
/// twice. Errors: those of `extract`; InvalidArgument if there is no room; what the memory holds then, or after any
/// error, is not defined.
template <Value T, int N, class Real, VertexNumber I>
requires DimensionBetween<N, 2, 4> ContourSize extract_into(const Image<T, N>& image, double isovalue,
                                                            const ContourRoom<N, Real, I>& room,
                                                            const ExtractOptions& options = {},
                                                            ExtractStats* stats = nullptr);

}  // namespace tegl
