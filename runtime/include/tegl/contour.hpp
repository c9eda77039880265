// SPDX-License-Identifier: BSD-3-Clause
//
// The result of contouring: an indexed simplicial complex (segments, triangles, tetrahedra or 4-simplices).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tegl/dimensions.hpp"
#include "tegl/memory.hpp"
#include "tegl/vector.hpp"

namespace tegl {

/// A std::vector whose new elements are uninitialised after `resize`.
template <class T>
using Buffer = std::vector<T, detail::UninitialisedAllocator<T, detail::BufferMemory>>;

/// The number of a vertex.
using Index = std::uint32_t;

/// How large a contour is.
struct ContourSize {
  std::uint64_t vertices = 0;                           ///< how many points
  std::uint64_t simplices = 0;                          ///< how many segments, triangles, tetrahedra or 4-simplices
  bool operator==(const ContourSize&) const = default;  ///< equal if both counts are equal
};

/// Named numbers of every vertex, or of every simplex.
struct Attribute {
  std::string name = {};       ///< such as "temperature"; not empty
  std::string unit = {};       ///< may be empty
  int width = 1;               ///< how many numbers each has
  Buffer<double> values = {};  ///< #V (or #S) x width, row = vertex (or simplex)
};

/// The side that the oriented contour and its normals face: low samples (descent) or high samples (ascent).
enum class GradientDirection { descent, ascent };

/// A period of a wrapped contour (tegl/periodic.hpp): the points x and x + vector are the same. Vertices have their
/// share of the period, <dual, x> - start, in [0, 1], up to rounding; 1 only if a sample equals the isovalue or is
/// missing.
template <int N>
struct Period {
  Vector<N> vector = {};                           ///< in world coordinates
  Vector<N> dual = {};                             ///< <dual, vector> is 1, and 0 for the vectors of other periods
  double start = 0;                                ///< <dual, x> of the first sample
  bool operator==(const Period&) const = default;  ///< equal if all numbers are equal
};

/// The contour of an N-dimensional image: an (N-1)-dimensional simplicial complex in N-space.
/// N = 2: segments, 3: triangles, 4: tetrahedra, 5: 4-simplices. tegl/eigen.hpp has views of vertices and simplices as
/// Eigen matrices.
template <int N, Coordinate Real = float>
requires DimensionBetween<N, 2, 5>
struct Contour {
  using Vertex = std::array<Real, N>;  ///< a point, N coordinates
  /// N vertex numbers.
  using Simplex = std::array<Index, N>;

  Buffer<Vertex> vertices = {};    ///< #V x N world coordinates, row = vertex; for time-varying images t is last
  Buffer<Simplex> simplices = {};  ///< #S x N vertex numbers, row = simplex, consistently oriented
  Buffer<Vertex> normals = {};     ///< #V x N, of length 1 or 0, if requested (ExtractOptions::normals); else empty
  std::array<std::string, N> axis_names = {};                ///< taken from the grid
  std::array<std::string, N> axis_units = {};                ///< taken from the grid; such as "mm"
  GradientDirection direction = GradientDirection::descent;  ///< which side simplices and normals face
  std::vector<Attribute> vertex_attributes = {};             ///< empty after `extract`
  std::vector<Attribute> simplex_attributes = {};            ///< empty after `extract`
  /// Only of wrapped contours (tegl/periodic.hpp). A simplex may then cross the seam: its corners are those next to
  /// each other modulo the periods. Functions that do not know periods refuse the contour with UnsupportedData.
  std::vector<Period<N>> periods = {};
};

}  // namespace tegl
