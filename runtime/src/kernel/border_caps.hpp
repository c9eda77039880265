// SPDX-License-Identifier: BSD-3-Clause
//
// Caps: the high part of the image's border, which closes the contour there. Built slab by slab during the extraction,
// from the same bit planes and prefix sums.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "kernel/extract_count.hpp"
#include "kernel/placement.hpp"
#include "tile/extract_tables.hpp"

namespace tegl::detail {

template <int N, class Real>
class Caps {
 public:
  using Vertex = std::array<Real, N>;
  using Simplex = std::array<std::uint64_t, N>;

  /// `inverted`: the layers' bits are inverted. `flip`: orientation opposite to "positive side faces high". Bit a of
  /// `closed_axes`: the borders across axis a get caps; of `seam_axes`: its corners are listed (seam_corners).
  /// `estimator`: as in Counter.
  Caps(const EdgeCrossings<N>& source, const RowShape<N>& shape, const TableSet<N>& tables, const Counter<N>& counter,
       const Placement<N, Real>& placement, const FaceEstimator<N>* estimator, bool inverted, bool flip,
       unsigned closed_axes, unsigned seam_axes);

  /// Adds the cap vertices of layer k, which lies between slabs `below` and `above` (either may be null). Requires that
  /// the layer's contour vertices are numbered.
  void add_layer(std::size_t k, const Layer<N>& layer, const Slab<N>* below, const Slab<N>* above);
  /// Adds the caps between layers k and k + 1. Requires add_layer of both.
  void add_slab(std::size_t k, const SlabView<N>& view);
  /// Sets the smallest number that contour vertices met from now on can have; all are below `least` + 2^32.
  void set_least(std::uint64_t least) noexcept { least_ = least; }

  /// Cap vertices that are not on the contour.
  [[nodiscard]] const Buffer<Vertex>& vertices() const noexcept { return vertices_; }
  /// Normals of vertices(); empty if none were requested.
  [[nodiscard]] const Buffer<Vertex>& normals() const noexcept { return normals_; }
  [[nodiscard]] const Buffer<Simplex>& simplices() const noexcept { return simplices_; }
  /// A cap vertex at a sample in the first or last layer across one of `seam_axes`.
  struct SeamCorner {
    std::array<std::size_t, N> index;
    std::uint64_t vertex;  ///< in vertices()
  };
  [[nodiscard]] const std::vector<SeamCorner>& seam_corners() const noexcept { return seam_corners_; }
  /// Final number of a simplex's vertex, if cap vertices are numbered from `first` on.
  [[nodiscard]] static std::uint64_t number(std::uint64_t stored, std::uint64_t first) noexcept {
    return (stored & kCapVertex) != 0 ? first + (stored & ~kCapVertex) : stored;
  }

 private:
  static constexpr unsigned kAll = (1u << N) - 1;
  /// Row that a pass over one kind of cell processes, with its neighbourhood.
  struct Row {
    std::size_t row;
    std::size_t layer;
    const Slab<N>* below;
    const Slab<N>* above;
  };
  using Ids = std::array<Index, 256>;

  /// Bits of the cells along `axes` based in this row that lie in the border and belong to a valid tile.
  const Word* border_cells(unsigned axes, const Row& at);
  template <unsigned Axes>
  void add_vertex(const typename RowShape<N>::Index& index, const std::array<double, std::popcount(Axes)>& place);
  void add_corners(EdgePlane& plane, const Layer<N>& layer, const Row& at);
  [[nodiscard]] bool is_on_seam(const typename RowShape<N>::Index& index) const noexcept;
  template <int Omitted>
  void add_face(const SlabView<N>& view, std::size_t k, unsigned side);
  /// Adds the caps of a row of cells, in the border face at `side` of axis `Omitted`. `face`: the layers that contain
  /// these cells, the lower one being number `layer`.
  template <int Omitted>
  void add_face_row(const SlabView<N>& face, const Slab<N>& slab, std::size_t layer, unsigned side, std::size_t row);
  /// Cells of a border face that belong to a valid tile.
  template <int Omitted>
  Word face_cells(const Slab<N>& slab, std::size_t row, std::size_t w, unsigned side) const;
  /// Writes to `ids` the numbers of a cell's corners and of cubes' barycentres, by local vertex.
  template <int Omitted>
  void shared_ids(const SlabView<N>& face, std::size_t row, std::size_t layer, std::size_t i, unsigned signature,
                  Ids& ids) const;
  /// Region table for a cell of `signature`: `low`, or the high-connected one if an estimator decides so for a square.
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
  [[nodiscard]] bool closes(int axis) const noexcept { return (closed_axes_ >> axis & 1u) != 0; }
  [[nodiscard]] unsigned original(unsigned signature, unsigned corners) const noexcept {
    return inverted_ ? ~signature & ((1u << corners) - 1) : signature;
  }

  const EdgeCrossings<N>& source_;
  const RowShape<N>& shape_;
  TableSet<N> tables_;
  const Counter<N>& counter_;
  const Placement<N, Real>& placement_;
  const FaceEstimator<N>* estimator_;
  bool inverted_;
  bool flip_;
  unsigned closed_axes_, seam_axes_;
  std::vector<SeamCorner> seam_corners_;
  std::array<EdgePlane, 2>
      corners_;  ///< by k % 2: the high samples of a layer in the border, which caps have as vertices
  std::vector<Word> border_;
  std::vector<Word> valid_;
  Buffer<Vertex> vertices_;
  Buffer<Vertex> normals_;
  static constexpr std::uint64_t kCapVertex = std::uint64_t{1} << 63;
  Buffer<Simplex> simplices_;  ///< vertices not on the contour have the bit kCapVertex
  std::uint64_t least_ = 0;
};

}  // namespace tegl::detail
