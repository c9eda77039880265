// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images that are larger than memory: layer after layer along the last axis comes in, the contour goes out
// in parts.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "tegl/extract.hpp"
#include "tegl/layers.hpp"

namespace tegl {

/// Takes a contour in parts, in the order of its numbers. What it throws ends the extraction and reaches its caller.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
class ContourSink {
 public:
  using Vertex = std::array<Real, N>;  ///< a point, N coordinates
  /// N vertex numbers.
  using Simplex = std::array<std::uint64_t, N>;
  ContourSink() = default;
  ContourSink(const ContourSink&) = delete;
  ContourSink& operator=(const ContourSink&) = delete;
  virtual ~ContourSink() = default;

  /// The next vertices. The first one of all has the number 0.
  virtual void add_vertices(std::span<const Vertex> vertices) = 0;
  /// With ExtractOptions::normals: the normals of the vertices that were just added. A sink that does not expect any
  /// throws InvalidArgument.
  virtual void add_normals(std::span<const Vertex> /*normals*/) {
    throw Error(ErrorCode::InvalidArgument, "normals for a sink that takes none; expected one with add_normals");
  }
  /// The next simplices, of vertices that were added before or will be.
  virtual void add_simplices(std::span<const Simplex> simplices) = 0;
  /// Another vertex for a corner of a simplex that was added before (next to missing values, where sheets that touch
  /// are taken apart).
  virtual void replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex) = 0;
};

/// How large a streamed contour became.
using StreamedSize = ContourSize;

/// As `extract`, for an image that comes in by layers and a contour that goes out in parts: the same vertices, normals
/// and simplices with the same numbers, but with 64 bits to number them. Memory: three layers of samples (four with
/// normals; more where they are small), the contour between two of them, and what takes part in missing values' borders
/// or the closing of the image's border. Errors: those of `extract`, but TooLarge, and what the reader and the sink
/// throw.
template <class Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4> StreamedSize extract_streamed(LayerReader<T, N>& layers, double isovalue,
                                                                 const ExtractOptions& options,
                                                                 ContourSink<N, Real>& sink,
                                                                 ExtractStats* stats = nullptr);

}  // namespace tegl
