// SPDX-License-Identifier: BSD-3-Clause
//
// Interface of an extraction's output, which takes the contour part by part, and the plan of an extraction.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <Eigen/LU>

#include "ambiguity/face_estimator.hpp"
#include "tegl/eigen.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// Maximum number of vertices of a contour in memory. The largest Index is never used as a number.
inline constexpr std::uint64_t kMaxVertices = std::numeric_limits<Index>::max();

/// Throws TooLarge if `count` vertices are more than `limit`.
void check_vertex_count(std::uint64_t count, std::uint64_t limit);

/// Throws InvalidIsovalue or InvalidArgument.
void check_arguments(double isovalue, const ExtractOptions& options);

/// Resizes an output. If it has to be reallocated, its capacity is estimated from the share `done` of the image, within
/// bounds.
template <class T>
void resize_output(Buffer<T>& output, std::uint64_t size, double done) {
  if (size > output.capacity()) {
    const double expected = 1.05 * static_cast<double>(size) / done;
    output.reserve(std::max(size + size / 2, std::min(4 * size, static_cast<std::size_t>(expected))));
  }
  output.resize(size);
}

/// Whether to reverse the orientation of tiles ("positive side faces the high corners") so that normals have the
/// requested direction in the world.
template <int N>
bool against_tables(const Grid<N>& grid, const ExtractOptions& options) {
  bool flip = options.direction == GradientDirection::descent;
  for (const Axis& axis : grid.axes) flip = flip != axis.is_descending();
  const Eigen::Matrix<double, N, N> linear = as_eigen(grid.linear);
  return flip != (linear.determinant() < 0);
}

class TileSelection;
/// Ranges of vertex and simplex numbers of one part of an extraction.
struct ContourPart {
  std::uint64_t first_vertex, end_vertex;
  std::uint64_t first_simplex, end_simplex;
  double done;  ///< share of the image whose contour has been counted
};

template <int N, class Real>
class Caps;
class NonmanifoldCandidates;
template <int N>
class RowShape;
template <int N>
struct Layer;
template <int N>
struct Slab;
template <int N>
struct SlabView;

/// What reads the numbers of vertices on edges by their bits, beside tiles at missing values: nothing, an output that
/// compares the last layer with layer 0, or anything else.
enum class RankReaders { none, last_layer, any };

/// How vertices of planes are found.
struct NumberedBy {
  bool ranks;  ///< those on edges by bits; otherwise no tile is missing, and the bits are undefined
  bool lists;  ///< those of cubes by lists (Counter::lists_cubes)
};

/// Output of an extraction. It receives the parts in order, each by open and close. Vertex numbers in simplices count
/// modulo 2^32; those in a part's simplices belong to this part or to the previous one.
template <int N, class Real>
class ContourOutput {
 public:
  using Vertex = typename Contour<N, Real>::Vertex;
  using Simplex = typename Contour<N, Real>::Simplex;
  struct Room {
    Vertex* vertices;
    Simplex* simplices;
    Vertex* normals = nullptr;  ///< null: no normals requested
  };
  ContourOutput() = default;
  ContourOutput(const ContourOutput&) = delete;
  ContourOutput& operator=(const ContourOutput&) = delete;
  virtual ~ContourOutput() = default;

  /// Maximum numbers of vertices and simplices. Called once, before the first part.
  virtual void expect(double /*vertices*/, double /*simplices*/) {}
  /// Returns storage for a part, which the extraction then writes. If both pointers are null, nothing is written.
  virtual Room open(const ContourPart& part) = 0;
  /// Number of memory pieces that the next part will probably use. Until it is opened, threads may touch the pieces in
  /// parallel, so that the system allocates them one by one and no two threads wait for the same one.
  [[nodiscard]] virtual std::size_t pieces_ahead() const noexcept { return 0; }
  virtual void touch_ahead(std::size_t /*piece*/) noexcept {}
  /// Called after a part is written. `nonmanifold`: vertices of this and all previous parts that may have to be
  /// duplicated.
  virtual void close(const ContourPart& /*part*/, const NonmanifoldCandidates& /*nonmanifold*/) {}
  /// Which numbers of vertices on edges see_layer and see_slab read by their bits. They always have those of layer 0.
  [[nodiscard]] virtual RankReaders rank_readers() const noexcept { return RankReaders::none; }
  /// Called for layer 0, then for each slab and the layer above it, in order, when their vertices are numbered.
  virtual void see_layer(std::size_t /*k*/, const RowShape<N>& /*shape*/, const Layer<N>& /*layer*/,
                         NumberedBy /*by*/) {}
  virtual void see_slab(const SlabView<N>& /*view*/, NumberedBy /*by*/) {}
  /// Called after all parts are written. `caps` may be null.
  virtual void finish(const ContourPart& all, const Caps<N, Real>* caps, const NonmanifoldCandidates& nonmanifold) = 0;
};

/// The uncertainty of normals by context, by number of the vertex. NaN where the extraction does not write it: at
/// vertices inside cells and on caps.
class VertexUncertainty {
 public:
  /// Makes room for vertices, between parts of the extraction.
  void resize(std::size_t count) {
    const std::size_t before = values_.size();
    values_.resize(count);
    for (std::size_t v = before; v < count; ++v) values_[v] = std::numeric_limits<double>::quiet_NaN();
  }
  /// Any thread; each vertex once.
  void set(Index vertex, double value) noexcept { values_[vertex] = value; }
  [[nodiscard]] Buffer<double>& values() noexcept { return values_; }

 private:
  Buffer<double> values_;
};

/// Parameters of an extraction other than the user's options.
struct ExtractPlan {
  VertexUncertainty* uncertainty = nullptr;  ///< where that of normals by context goes; null: nowhere
  std::uint64_t max_vertices = kMaxVertices;
  unsigned closed_axes = ~0u;  ///< bit a: whether options.close closes the borders across axis a
  unsigned seam_axes = 0;      ///< bit a: the last layer across axis a repeats the first one
  std::size_t batch = 0;       ///< slabs per batch; 0: chosen from the image
  /// Maximum vertices of two consecutive batches: numbers in simplices are distinguished modulo 2^32.
  std::uint64_t max_vertices_at_once = std::uint64_t{1} << 32;
  const TileSelection* selection = nullptr;  ///< rows or tiles to process; null: all
  PartOfImage part{};                        ///< for estimators: the image that the grid is a part of
  /// N = 3: whether vertices between layers of the last axis are kept off the layers, as always from 4D on.
  bool keeps_off_layers = false;
  bool keeps_tiles = true;  ///< false: lists of active tiles are computed twice, however much memory there is
};

}  // namespace tegl::detail
