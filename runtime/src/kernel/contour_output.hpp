// SPDX-License-Identifier: BSD-3-Clause
//
// Where an extraction puts its contour, part after part, and how it goes about its work.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <Eigen/LU>

#include "ambiguity/face_estimator.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// Vertices that an extraction may have: one less than numbers, so that no number is the largest.
inline constexpr std::uint64_t kMaxVertices = std::numeric_limits<Index>::max();

/// Throws TooLarge if `count` vertices are more than `limit`.
void check_vertex_count(std::uint64_t count, std::uint64_t limit);

/// Throws InvalidIsovalue or InvalidArgument.
void check_arguments(double isovalue, const ExtractOptions& options);

/// Where an output has to move, it gets room for what the share of the image that is `done` lets expect, within bounds.
template <class T>
void resize_output(Buffer<T>& output, std::uint64_t size, double done) {
  if (size > output.capacity()) {
    const double expected = 1.05 * static_cast<double>(size) / done;
    output.reserve(std::max(size + size / 2, std::min(4 * size, static_cast<std::size_t>(expected))));
  }
  output.resize(size);
}

/// Whether the orientation of tiles, "positive side faces the high corners", is to be reversed, so that normals point
/// as asked for in the world.
template <int N>
bool against_tables(const Grid<N>& grid, const ExtractOptions& options) {
  bool flip = options.direction == GradientDirection::descent;
  for (const Axis& axis : grid.axes) flip = flip != axis.is_descending();
  return flip != (grid.linear.determinant() < 0);
}

class TileSelection;
/// A run of an extraction's vertices and simplices, by number.
struct ContourPart {
  std::uint64_t first_vertex, end_vertex;
  std::uint64_t first_simplex, end_simplex;
  double done;  ///< share of the image whose contour is counted
};

template <int N, class Real>
class Caps;
class PinchList;

/// Where an extraction puts its contour: part after part, each in two steps. Vertices' numbers in simplices count
/// modulo 2^32; those in a part's simplices belong to it or to the part before.
template <int N, class Real>
class ContourOutput {
 public:
  using Vertex = typename Contour<N, Real>::Vertex;
  using Simplex = typename Contour<N, Real>::Simplex;
  struct Room {
    Vertex* vertices;
    Simplex* simplices;
    Vertex* normals = nullptr;  ///< null: none are wanted
  };
  ContourOutput() = default;
  ContourOutput(const ContourOutput&) = delete;
  ContourOutput& operator=(const ContourOutput&) = delete;
  virtual ~ContourOutput() = default;

  /// The most that can come.
  virtual void expect(double /*vertices*/, double /*simplices*/) {}
  /// Room for a part, which is then written; two null pointers: it is not.
  virtual Room open(const ContourPart& part) = 0;
  /// What the next part is likely to be written to, in pieces that may be touched side by side until it is opened: the
  /// system then hands them out one by one, and not the same one to several threads.
  [[nodiscard]] virtual std::size_t pieces_ahead() const noexcept { return 0; }
  virtual void touch_ahead(std::size_t /*piece*/) noexcept {}
  /// A part is written. `pinches`: the vertices of this part and all before that may have to be doubled.
  virtual void close(const ContourPart& /*part*/, const PinchList& /*pinches*/) {}
  /// All parts are written; `caps` may be null.
  virtual void finish(const ContourPart& all, const Caps<N, Real>* caps, const PinchList& pinches) = 0;
};

/// How an extraction goes about its work.
struct ExtractPlan {
  std::uint64_t max_vertices = kMaxVertices;
  unsigned closed_axes = ~0u;  ///< bit a: whether options.close closes the borders across axis a
  std::size_t batch = 0;       ///< slabs at a time; 0: as many as suit the image
  /// Of two batches, one after the other: numbers in simplices are told apart modulo 2^32.
  std::uint64_t max_vertices_at_once = std::uint64_t{1} << 32;
  const TileSelection* selection = nullptr;  ///< what to look at; null: all
  PartOfImage part{};                        ///< for estimators: what the grid is a part of
  /// N = 3: whether points between layers of the last axis are kept off the layers, as they always are in 4D.
  bool keeps_off_layers = false;
  bool keeps_tiles = true;  ///< false: lists of active tiles are made twice, whatever memory there is for them
};

}  // namespace tegl::detail
