// SPDX-License-Identifier: BSD-3-Clause
//
// Caps: the high part of the image's border, which closes a contour there. Gathered slab by slab
// beside the extraction, by the same bit planes and ranks.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "kernel/extract_count.hpp"
#include "kernel/placement.hpp"
#include "tile/extract_tables.hpp"

namespace tegl::detail {

/// Vertices of the caps that are not on the contour: high samples on the border, and (N = 4) squares
/// whose high region has a barycentre. Of one layer, or of one slab. Numbers count caps' vertices alone.
struct CapPlanes {
  EdgePlane corners;                 ///< layers only
  std::array<EdgePlane, 3> squares;  ///< layers: axes 01, 02, 12; slabs: axes 03, 13, 23
};

template <int N, class Real>
class Caps {
 public:
  using Vertex = std::array<Real, N>;
  using Simplex = std::array<std::uint64_t, N>;

  /// `inverted`: the layers' bits are. `flip`: against the orientation "positive side faces high".
  /// `closed_axes`: bit a: whether the borders across axis a get caps.
  /// `estimator`: as Counter's.
  Caps(const SampleSource<N>& source, const RowShape<N>& shape, const TableSet<N>& tables, const Counter<N>& counter,
       const Placement<N, Real>& placement, const FaceEstimator<N>* estimator, bool inverted, bool flip,
       unsigned closed_axes);

  /// The cap vertices of layer k, between its slabs (or null); after its contour points are known.
  void add_layer(std::size_t k, const Layer<N>& layer, const Slab<N>* below, const Slab<N>* above);
  /// The caps between layers k and k + 1; after add_layer of both.
  void add_slab(std::size_t k, const SlabView<N>& view);
  /// The least number that a vertex of the contour met from now on can have; the largest is below that plus 2^32.
  void set_least(std::uint64_t least) noexcept { least_ = least; }

  /// Vertices that are not on the contour.
  [[nodiscard]] const Buffer<Vertex>& vertices() const noexcept { return vertices_; }
  /// As many, or none.
  [[nodiscard]] const Buffer<Vertex>& normals() const noexcept { return normals_; }
  [[nodiscard]] const Buffer<Simplex>& simplices() const noexcept { return simplices_; }
  /// The number of a simplex's vertex, if those of the caps are to begin with `first`.
  [[nodiscard]] static std::uint64_t number(std::uint64_t stored, std::uint64_t first) noexcept {
    return (stored & kCapVertex) != 0 ? first + (stored & ~kCapVertex) : stored;
  }

 private:
  static constexpr unsigned kAll = (1u << N) - 1;
  /// What the passes over one kind of cell in one row share.
  struct Row {
    std::size_t row;
    std::size_t layer;
    const Slab<N>* below;
    const Slab<N>* above;
  };
  using Ids = std::array<Index, 256>;
  static constexpr Index kNoSquare = ~Index{0};  ///< of a square without a barycentre

  /// Cells along `axes` based in this row that lie in the border and belong to a valid tile.
  const Word* border_cells(unsigned axes, const Row& at);
  template <unsigned Axes>
  void add_vertex(const typename RowShape<N>::Index& index, const std::array<double, std::popcount(Axes)>& place);
  void add_corners(EdgePlane& plane, const Layer<N>& layer, const Row& at);
  template <unsigned Axes>
  void add_squares(EdgePlane& plane, const SlabView<N>& view, const Row& at);
  /// Whether squares of the border have barycentres that the cubes around them share (N = 4).
  [[nodiscard]] bool has_squares() const noexcept {
    return N == 4 && tables_.square != nullptr && tables_.square->max_own_vertices != 0;
  }
  template <int Omitted>
  void add_face(const SlabView<N>& view, std::size_t k, unsigned side);
  /// `face`: what the cells of the face at `side` of axis `Omitted` lie in, from `layer` on.
  template <int Omitted>
  void add_face_row(const SlabView<N>& face, const Slab<N>& slab, std::size_t layer, unsigned side, std::size_t row);
  /// The cells of a face that belong to a valid tile.
  template <int Omitted>
  Word face_cells(const Slab<N>& slab, std::size_t row, std::size_t w, unsigned side) const;
  /// Numbers of corners, cubes' and squares' barycentres of a face's cell, by local vertex.
  template <int Omitted>
  void shared_ids(const SlabView<N>& face, std::size_t row, std::size_t layer, std::size_t i, unsigned signature,
                  Ids& ids) const;
  /// The table that a square is in, where data may decide.
  template <unsigned Axes>
  [[nodiscard]] const tables::RegionTable& table_of(const tables::RegionTable& low, unsigned signature,
                                                    const typename RowShape<N>::Index& index) const noexcept;
  template <unsigned Axes>
  void add_own(const tables::RegionTable& table, unsigned signature, const typename RowShape<N>::Index& index,
               Ids& ids);
  void add_simplices(const tables::RegionTable& table, unsigned signature, const Ids& ids, bool flip);
  template <int Omitted>
  void add_resolved(const SlabView<N>& face, std::size_t row, std::size_t layer,
                    const typename RowShape<N>::Index& index, unsigned signature, Ids& ids, bool flip);
  template <int Omitted>
  void corner_ids(std::size_t row, std::size_t layer, std::size_t i, unsigned signature, Index* out) const;
  template <int Omitted>
  void square_ids(std::size_t row, std::size_t layer, std::size_t i, Index* out) const;
  [[nodiscard]] bool closes(int axis) const noexcept { return (closed_axes_ >> axis & 1u) != 0; }
  [[nodiscard]] unsigned original(unsigned signature, unsigned corners) const noexcept {
    return inverted_ ? ~signature & ((1u << corners) - 1) : signature;
  }

  const SampleSource<N>& source_;
  const RowShape<N>& shape_;
  TableSet<N> tables_;
  const Counter<N>& counter_;
  const Placement<N, Real>& placement_;
  const FaceEstimator<N>* estimator_;
  bool inverted_;
  bool flip_;
  unsigned closed_axes_;
  std::array<CapPlanes, 2> layers_;  ///< by k % 2
  CapPlanes slab_;
  std::vector<Word> border_;
  std::vector<Word> valid_;
  Buffer<Vertex> vertices_;
  Buffer<Vertex> normals_;
  static constexpr std::uint64_t kCapVertex = std::uint64_t{1} << 63;
  Buffer<Simplex> simplices_;  ///< vertices of the caps have the bit kCapVertex
  std::uint64_t least_ = 0;
};

}  // namespace tegl::detail
