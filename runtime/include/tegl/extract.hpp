// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of 2D, 3D and 4D images.
#pragma once

#include <cstdint>

#include "tegl/contour.hpp"
#include "tegl/image.hpp"

namespace tegl {

enum class Triangulation { compact, barycentric };
/// How ambiguous faces are resolved (theory: the consistent method). low: high corners that meet only
/// across a diagonal are kept apart; high: they are joined.
enum class Ambiguity { low, high };

struct ExtractOptions {
  Triangulation triangulation = Triangulation::compact;
  Ambiguity ambiguity = Ambiguity::low;
  GradientDirection direction = GradientDirection::descent;
  /// Close the contour at the image's border by the high part of the border itself. Where the border
  /// of the *data* lies inside the image (missing values), the contour stays open.
  bool close = false;
  /// Keeps the points on edges at least this share of an edge away from the samples, in [0, 0.5).
  /// 0: exact positions; where a sample equals the isovalue, simplices of zero size arise. (Whatever it is, four points
  /// of a compact 4D tile may lie in one plane.)
  double epsilon = 0.0;
  /// How many threads work; 0: all that the machine has. The result is the same, byte by byte.
  unsigned threads = 0;
  Progress progress;
};

/// What an extraction did, for reports.
struct ExtractStats {
  std::uint64_t tiles = 0;
  std::uint64_t active_tiles = 0;
  double read_seconds = 0;      ///< layers, where they come one by one (tegl/stream.hpp)
  double classify_seconds = 0;  ///< samples against the isovalue
  double find_seconds = 0;      ///< active tiles, counts, places in the output
  double generate_seconds = 0;  ///< vertices and simplices
  double close_seconds = 0;     ///< caps
};

/// The contour {value = isovalue} of an image: separates samples >= isovalue (high) from the others.
///
/// Closed (away from the image's border and from missing values), a manifold and oriented, whatever
/// the values. Where tiles next to missing values meet in an edge or a square of the grid alone, the vertices there are
/// doubled, in the same place, so that the contour is a manifold there too. Points of a 4D contour between two layers
/// of the last axis are kept off the layers by the least that Real can show, so that `slice` finds the contour of a
/// layer in it even where samples equal the isovalue. An image with an axis of one sample has no tiles, hence an empty
/// contour. Errors: InvalidIsovalue (not finite), InvalidArgument (epsilon), TooLarge, Cancelled. Cost: one pass over
/// the samples plus the output. Real: float or double.
template <class Real = float, Value T, int N>
Contour<N, Real> extract(const Image<T, N>& image, double isovalue, const ExtractOptions& options = {},
                         ExtractStats* stats = nullptr);

}  // namespace tegl
