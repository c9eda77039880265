// SPDX-License-Identifier: BSD-3-Clause
//
// Contours whose vertices are placed on their edges of the grid by other rules than linear interpolation. Which samples
// are separated stays as it is; only positions change.
//
// Based on: M. Liversage, thesis, 1994, sections 6.2.4 (positions by an estimate), 9.1.7 (filtered images) and 9.2.6
// (gravitation). The rule `relaxed` is tegl's own.
#pragma once

#include <functional>
#include <span>
#include <variant>

#include "tegl/contour.hpp"
#include "tegl/extract.hpp"
#include "tegl/image.hpp"

namespace tegl {

/// Where on its edge, between a high and a low sample, a vertex lies.
/// - linear: by linear interpolation of the samples, as `extract`.
/// - filtered: by linear interpolation of a second image, whose samples are first clamped to the side of the image's
///   own samples: at a high sample to at least the isovalue, at a low one to the largest number below it.
/// - custom: by a function of the two samples.
/// - gravitation: first linear; then the vertex is moved off its edge, across it, towards neighbouring samples of the
///   sides that attract it. For masks.
/// - relaxed: from the sides only, not from the values: smooth, without the stair steps of masks and labels, without
///   shrinking (docs/positions.md).
enum class Positions { linear, filtered, custom, gravitation, relaxed };

/// Options of `extract_placed`.
struct PositionOptions {
  Positions rule = Positions::linear;  ///< the rule
  /// For `filtered`: a value for each sample of the image, axis 0 fastest, then axis 1, and so on. If a value is NaN,
  /// the image's own value is used. As doubles if float would round them, such as small differences of large values.
  std::variant<std::span<const float>, std::span<const double>> filtered = {};
  /// For `custom`: the position between two samples as a number from 0 (at the first) to 1 (at the second); others are
  /// clamped. One of the samples is at or above the isovalue, the other is below. Called by several threads at once;
  /// an exception ends the extraction and is passed on.
  std::function<double(double first, double second, double isovalue)> custom = {};
  /// For `custom`, in place of the function `custom`: the positions between many pairs of samples, first[i] and
  /// second[i], as out[i], for interpreters and vector units. Called by the calling thread for blocks of at most 65 536
  /// edges, in the same order for any number of threads. Memory: 12 bytes per edge between a high and a low sample.
  std::function<void(std::span<const double> first, std::span<const double> second, double isovalue,
                     std::span<double> out)>
      custom_of_many = {};
  /// For `relaxed`: minimum distance of vertices from samples as a share of an edge, in (0, 0.5), unless
  /// ExtractOptions::epsilon is larger.
  double margin = 0.01;
  /// For `relaxed`: weight of the smoothing along the last axis relative to the others, 0 or more. 0: each layer is
  /// smoothed by itself.
  double last_axis_weight = 1.0;
};

/// As `extract_placed`, with counts and times; these do not include the time to find positions.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Extraction<N, Real> extract_placed_with_stats(const Image<T, N>& image, double isovalue,
                                                            const PositionOptions& positions,
                                                            const ExtractOptions& options = {});

/// Extracts the contour of an image with vertices placed by a rule. Simplices, with their vertex numbers, equal those
/// of `extract`. Each vertex on an edge of the grid stays on this edge, except with `gravitation`, which moves it
/// inside the double pyramid over its edge. Vertices inside cells are computed from the vertices on edges as in
/// `extract`, with levels of rays (docs/embedding.md) from the image itself. Normals are those of the image's gradient
/// at the new positions along the edge.
///
/// Except with `gravitation`, what docs/embedding.md proves about self-intersections holds: it is proved for all
/// positions on edges.
///
/// Errors: as `extract`; InvalidArgument for `filtered` values that are not as many as samples, `custom` without a
/// function or with a function that returns NaN or with two functions, and for a margin or weight outside of its range;
/// UnsupportedData for `gravitation` in 5D; TooLarge for `relaxed` and `custom_of_many` with more than 2^30 vertices on
/// edges.
///
/// Time and memory: docs/positions.md. Streams, indexes of active tiles, slices of images, facets, and periodic
/// contours have linear positions only.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Contour<N, Real> extract_placed(const Image<T, N>& image, double isovalue,
                                              const PositionOptions& positions, const ExtractOptions& options = {}) {
  return extract_placed_with_stats<Real>(image, isovalue, positions, options).contour;
}

}  // namespace tegl
