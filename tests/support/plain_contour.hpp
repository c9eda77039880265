// SPDX-License-Identifier: BSD-3-Clause
//
// Extraction by definition, tile by tile, as a reference for the kernel. The facets of each tile come from the
// recursion over dimension (the generator's builder, no tables), each vertex from its key in a sorted map (no bit
// planes, no ranks), each point from its two samples. The order of the keys is the library's order of vertices.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "fields.hpp"
#include "filling/facets.hpp"
#include "tegl/eigen.hpp"
#include "tegl/extract.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::test {

/// The contours of a tile's signatures, built on demand.
template <int N>
class RecursiveBuilder {
 public:
  explicit RecursiveBuilder(const ExtractOptions& options)
      : lattice_(N),
        builder_(lattice_, N, options.ambiguity == Ambiguity::low ? tile::Alternative::low : tile::Alternative::high,
                 options.triangulation) {}

  const gen::TileContour& contour(unsigned signature) {
    const auto [at, is_new] = built_.try_emplace(signature);
    if (is_new) at->second = builder_.build(signature);
    return at->second;
  }
  /// N = 4: number of own vertices of the contour in the 3-face `cube`.
  unsigned cube_vertices(unsigned cube, unsigned signature) {
    return builder_.face_contour(cube, signature).cone_vertices;
  }

 private:
  gen::CubeLattice lattice_;
  gen::ContourBuilder builder_;
  std::map<unsigned, gen::TileContour> built_;
};

template <int N, class Real>
struct PlainContour {
  /// An active tile: the end of its simplices, and its own vertices [first_own, end_own).
  struct Tile {
    std::size_t end;
    Index first_own;
    Index end_own;
  };

  Contour<N, Real> contour;  ///< points that are not on edges of the grid are NaN
  std::vector<Tile> tiles;   ///< active tiles, in order
};

template <int N, class Real, Value T>
class PlainExtraction {
 public:
  PlainExtraction(const Image<T, N>& image, double isovalue, const ExtractOptions& options,
                  RecursiveBuilder<N>& builder)
      : image_(image), isovalue_(isovalue), options_(options), builder_(builder) {}

  PlainContour<N, Real> run() {
    std::array<std::size_t, N> sizes = image_.grid().sizes();
    for (std::size_t& size : sizes)
      if (size-- == 1) return {};
    const auto tiles = Grid<N>::unit(sizes);
    for_each_sample<N>(tiles, [&](std::size_t, const Corner& tile) { name_vertices(tile); });
    Index number = 0;
    for (auto& [key, vertex] : vertices_) vertex = number++;
    result_.contour.vertices.resize(number);
    for (auto& vertex : result_.contour.vertices) vertex.fill(std::numeric_limits<Real>::quiet_NaN());
    for_each_sample<N>(tiles, [&](std::size_t, const Corner& tile) { add_tile(tile); });
    return std::move(result_);
  }

 private:
  using Corner = std::array<std::size_t, N>;
  /// Layer (2 k) or slab (2 k + 1); row; kind of cell; position in the row; number in the cell.
  using Key = std::array<std::size_t, 5>;

  static Corner shifted(Corner corner, unsigned mask) {
    for (int a = 0; a < N; ++a) corner[a] += mask >> a & 1u;
    return corner;
  }
  bool is_high(const Corner& corner) const { return static_cast<double>(image_(corner)) >= isovalue_; }

  /// The signature of a tile; 0 for a tile with a missing corner.
  unsigned signature(const Corner& tile) const {
    unsigned result = 0;
    for (unsigned v = 0; v < 1u << N; ++v) {
      const Corner corner = shifted(tile, v);
      if (std::isnan(static_cast<double>(image_(corner)))) return 0;
      result |= static_cast<unsigned>(is_high(corner)) << v;
    }
    return result;
  }

  /// The key of a cell that starts at `base`: in its slab if it spans the last axis, else in its layer.
  Key key(const Corner& base, bool in_slab, std::size_t kind, std::size_t slot) const {
    std::size_t row = 0;
    for (int a = N - 2; a > 0; --a) row = row * image_.size(a) + base[a];
    return {2 * base[N - 1] + (in_slab ? 1 : 0), row, kind, base[0], slot};
  }
  /// In a row, edges come first, by axis; then 3-faces (N = 4), by the axis orthogonal to them; then tiles.
  Key edge_key(const Corner& base, int axis) const {
    return key(base, axis == N - 1, axis == N - 1 ? 0 : static_cast<std::size_t>(axis), 0);
  }
  Key cube_key(const Corner& tile, unsigned cube, std::size_t slot) const {
    const unsigned omitted = cube / 2;
    return key(shifted(tile, (cube % 2) << omitted), omitted != N - 1, N + omitted, slot);
  }
  Key own_key(const Corner& tile, std::size_t slot) const { return key(tile, true, 2 * N, slot); }

  struct Edge {
    int axis;
    unsigned base;
  };
  static Edge edge(unsigned e) {
    const unsigned axis = e >> (N - 1);
    const unsigned squeezed = e & ((1u << (N - 1)) - 1);
    return {static_cast<int>(axis), (squeezed & ((1u << axis) - 1)) | squeezed >> axis << (axis + 1)};
  }

  std::size_t own_vertices(unsigned s) {
    const gen::TileContour& contour = builder_.contour(s);
    return contour.cone_vertices + contour.side_masks.size();
  }

  void name_vertices(const Corner& tile) {
    const unsigned s = signature(tile);
    for (unsigned e = 0; e < tables::edge_count(N); ++e) {
      const auto [axis, base] = edge(e);
      if ((s >> base & 1u) != (s >> (base | 1u << axis) & 1u)) vertices_[edge_key(shifted(tile, base), axis)];
    }
    if (N == 4)
      for (unsigned cube = 0; cube < 8; ++cube)
        for (unsigned j = 0; j < builder_.cube_vertices(cube, s); ++j) vertices_[cube_key(tile, cube, j)];
    for (std::size_t j = 0; j < own_vertices(s); ++j) vertices_[own_key(tile, j)];
  }

  Index vertex(const Corner& tile, unsigned v) {
    constexpr unsigned kEdges = tables::edge_count(N);
    if (v >= tables::first_tile_vertex(N)) return vertices_.at(own_key(tile, v - tables::first_tile_vertex(N)));
    if (v >= kEdges)
      return vertices_.at(cube_key(tile, (v - kEdges) / tables::kFaceSlots, (v - kEdges) % tables::kFaceSlots));
    const auto [axis, base] = edge(v);
    const Corner from = shifted(tile, base);
    const Index number = vertices_.at(edge_key(from, axis));
    result_.contour.vertices[number] = point(from, axis);
    return number;
  }

  void add_tile(const Corner& tile) {
    const unsigned s = signature(tile);
    if (s == 0 || s == (1u << (1u << N)) - 1) return;
    for (const gen::LocalFacet& facet : builder_.contour(s).facets)
      for (const gen::LocalSimplex& stored : facet.simplices) {
        std::array<Index, N> simplex;
        for (int j = 0; j < N; ++j) simplex[j] = vertex(tile, stored[j]);
        if (is_flipped()) std::swap(simplex[0], simplex[1]);
        result_.contour.simplices.push_back(simplex);
      }
    const std::size_t own = own_vertices(s);
    const Index first = own == 0 ? 0 : vertices_.at(own_key(tile, 0));
    result_.tiles.push_back({result_.contour.simplices.size(), first, static_cast<Index>(first + own)});
  }

  /// True if the requested orientation is opposite to the builder's ("the positive side faces high in the grid's
  /// frame").
  bool is_flipped() const {
    bool flip = options_.direction == GradientDirection::descent;
    for (const Axis& axis : image_.grid().axes) flip = flip != axis.is_descending();
    return flip != (as_eigen(image_.grid().linear).determinant() < 0);
  }

  std::array<Real, N> point(const Corner& from, int axis) const {
    const double a = static_cast<double>(image_(from));
    const double b = static_cast<double>(image_(shifted(from, 1u << axis)));
    const double alpha =
        std::clamp((isovalue_ - a) / (b - a), options_.epsilon, 1.0 - options_.epsilon) + 0.0;  // no -0
    std::array<double, N> x;
    for (int i = 0; i < N; ++i) x[i] = image_.grid().axes[i][from[i]];
    const double start = x[axis];
    const double end = image_.grid().axes[axis][from[axis] + 1];
    x[axis] =
        alpha >= 1.0 ? end : std::clamp(start + alpha * (end - start), std::min(start, end), std::max(start, end));
    auto vertex = to_world(x);
    if (N == 4 && axis == N - 1) keep_inside(vertex, from[axis]);
    return vertex;
  }

  std::array<Real, N> to_world(const std::array<double, N>& x) const {
    std::array<Real, N> vertex;
    for (int i = 0; i < N; ++i) {
      double sum = 0;
      for (int j = 0; j < N; ++j) sum += image_.grid().linear[i][j] * x[j];
      vertex[i] = static_cast<Real>(image_.grid().has_world_map() ? sum + image_.grid().offset[i] : x[i]);
    }
    return vertex;
  }

  /// Keeps points between two layers of a 4D image off both layers, by the smallest representable distance (for grids
  /// whose world map does not mix the last axis with others).
  void keep_inside(std::array<Real, N>& vertex, std::size_t k) const {
    for (int i = 0; i + 1 < N; ++i)
      if (image_.grid().linear[N - 1][i] != 0) return;
    std::array<double, N> x{};
    x[N - 1] = image_.grid().axes[N - 1][k];
    Real low = to_world(x)[N - 1];
    x[N - 1] = image_.grid().axes[N - 1][k + 1];
    Real high = to_world(x)[N - 1];
    if (low > high) std::swap(low, high);
    const Real least = (high - low) * (std::numeric_limits<Real>::epsilon() / 2);
    const Real first = std::max(std::nextafter(low, high), low + least);
    const Real last = std::min(std::nextafter(high, low), high - least);
    if (first <= last) vertex[N - 1] = std::clamp(vertex[N - 1], first, last);
  }

  const Image<T, N>& image_;
  double isovalue_;
  const ExtractOptions& options_;
  RecursiveBuilder<N>& builder_;
  std::map<Key, Index> vertices_;
  PlainContour<N, Real> result_;
};

/// As `extract`, with open borders. Does not support infinite samples and the error TooLarge.
template <class Real, Value T, int N>
PlainContour<N, Real> plain_contour(const Image<T, N>& image, double isovalue, const ExtractOptions& options,
                                    RecursiveBuilder<N>& builder) {
  return PlainExtraction<N, Real, T>(image, isovalue, options, builder).run();
}

/// A simplex with ascending vertices, and the parity of the sorting permutation.
template <int N>
using SortedSimplex = std::pair<std::array<Index, N>, bool>;

/// The simplices [first, tile.end) in canonical form and order. Tables may number a tile's own vertices in any order,
/// so an own vertex is named by the smallest other vertex that shares a simplex with it.
template <int N, class Real>
std::vector<SortedSimplex<N>> sorted_simplices(const Contour<N, Real>& contour, std::size_t first,
                                               const typename PlainContour<N, Real>::Tile& tile) {
  constexpr Index kNone = std::numeric_limits<Index>::max();
  const auto is_own = [&](Index v) { return tile.first_own <= v && v < tile.end_own; };
  std::vector<Index> name(tile.end_own - tile.first_own, kNone);
  for (std::size_t s = first; s < tile.end; ++s)
    for (const Index v : contour.simplices[s])
      for (const Index w : contour.simplices[s])
        if (is_own(v) && !is_own(w)) name[v - tile.first_own] = std::min(name[v - tile.first_own], w);
  std::vector<SortedSimplex<N>> result;
  for (std::size_t s = first; s < tile.end; ++s) {
    auto simplex = contour.simplices[s];
    for (Index& v : simplex)
      if (is_own(v)) v = kNone - name[v - tile.first_own];
    bool odd = false;
    for (int i = 0; i < N; ++i)
      for (int j = i + 1; j < N; ++j) odd = odd != (simplex[i] > simplex[j]);
    std::sort(simplex.begin(), simplex.end());
    if (std::adjacent_find(simplex.begin(), simplex.end()) != simplex.end()) odd = false;
    result.emplace_back(simplex, odd);
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace tegl::test
