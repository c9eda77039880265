// SPDX-License-Identifier: BSD-3-Clause
//
// Caps of a contour at the image border (see border_caps.hpp). A border face of an N-dimensional image is an image of
// dimension N - 1. Its cap is the high set, built tile by tile from the region tables.
#include "kernel/border_caps.hpp"

#include <utility>

#include "ambiguity/cube_decision.hpp"
#include "kernel/contour_output.hpp"
#include "kernel/extract_generate.hpp"
#include "tegl/tile/corners.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {
namespace {

/// Mean of the corners and edge points in a region's mask, in the frame of the cell.
template <int N, unsigned Axes>
TilePoint<std::popcount(Axes)> region_place(const EdgePlaces<N, Axes>& places, std::uint32_t mask) noexcept {
  constexpr int kDim = std::popcount(Axes);
  Weighted<kDim> sum;
  for (; mask != 0; mask &= mask - 1) {
    const auto v = static_cast<unsigned>(std::countr_zero(mask));
    sum.add(v < (1u << kDim) ? corner_point<kDim>(v) : places(v - (1u << kDim)), 1.0);
  }
  for (double& x : sum.point) x /= sum.weight;
  return sum.point;
}

/// Position of a vertex that a region of a cube adds in the barycentric triangulation. The weights are unequal, as in
/// mask_place and unless all points are corners, so that the vertex is hardly ever coplanar with three others.
template <unsigned Axes>
TilePoint<3> centre_place(const EdgePlaces<4, Axes>& places, std::uint32_t mask) noexcept {
  Weighted<3> sum;
  const double step = mask >> 8 != 0 ? 0.01 : 0.0;
  for (; mask != 0; mask &= mask - 1) {
    const auto v = static_cast<unsigned>(std::countr_zero(mask));
    sum.add(v < 8 ? corner_point<3>(v) : places(v - 8), 1.0 + step * v);
  }
  for (double& x : sum.point) x /= sum.weight;
  return sum.point;
}

}  // namespace

template <int N, class Real>
Caps<N, Real>::Caps(const EdgeCrossings<N>& source, const RowShape<N>& shape, const TableSet<N>& tables,
                    const Counter<N>& counter, const Placement<N, Real>& placement, const FaceEstimator<N>* estimator,
                    bool inverted, bool flip, unsigned closed_axes, unsigned seam_axes)
    : source_(source),
      shape_(shape),
      tables_(tables),
      counter_(counter),
      placement_(placement),
      estimator_(estimator),
      inverted_(inverted),
      flip_(flip),
      closed_axes_(closed_axes),
      seam_axes_(seam_axes),
      border_(shape.words()),
      valid_(shape.words()) {
  for (EdgePlane& corners : corners_) corners.allocate(shape_.rows(), shape_.words());
}

template <int N, class Real>
const Word* Caps<N, Real>::border_cells(unsigned axes, const Row& at) {
  const auto index = shape_.index_of(at.row);
  bool all = closes(N - 1) && (axes >> (N - 1) & 1u) == 0 && (at.layer == 0 || at.layer + 1 == shape_.layers());
  for (int a = 1; a < N - 1; ++a)
    all = all || (closes(a) && (axes >> a & 1u) == 0 && (index[a] == 0 || index[a] + 1 == shape_.size(a)));
  const bool along_row = (axes & 1u) != 0;
  for (std::size_t w = 0; w < shape_.words(); ++w) border_[w] = all ? shape_.mask(w, along_row) : 0;
  if (!along_row && closes(0)) {
    const std::size_t last = shape_.size(0) - 1;
    border_[0] |= 1;
    border_[last / kWordBits] |= Word{1} << (last % kWordBits);
  }
  if (counter_.cells_of_valid_tiles(axes, at.row, at.below, at.above, valid_.data()))
    for (std::size_t w = 0; w < shape_.words(); ++w) border_[w] &= valid_[w];
  return border_.data();
}

template <int N, class Real>
template <unsigned Axes>
void Caps<N, Real>::add_vertex(const typename RowShape<N>::Index& index,
                               const std::array<double, std::popcount(Axes)>& place) {
  using Frame = CellFrame<N, Axes>;
  vertices_.push_back(placement_.template in_cell<Frame>(index, place));
  if (placement_.normals() != nullptr) normals_.push_back(placement_.normals()->template in_cell<Frame>(index, place));
}

template <int N, class Real>
void Caps<N, Real>::add_corners(EdgePlane& plane, const Layer<N>& layer, const Row& at) {
  const Word* const border = border_cells(0, at);
  const std::size_t first = at.row * shape_.words();
  const Word* const high = layer.high.data() + at.row * shape_.pitch();
  auto index = shape_.index_of(at.row);
  index[N - 1] = at.layer;
  plane.offset[at.row] = static_cast<Index>(vertices_.size());
  for (std::size_t w = 0; w < shape_.words(); ++w) {
    plane.prefix[first + w] = static_cast<std::uint32_t>(vertices_.size()) - plane.offset[at.row];
    plane.bits[0][first + w] = (inverted_ ? ~high[w] : high[w]) & border[w];
    for (Word rest = plane.bits[0][first + w]; rest != 0; rest &= rest - 1) {
      index[0] = w * kWordBits + static_cast<std::size_t>(std::countr_zero(rest));
      if (seam_axes_ != 0 && is_on_seam(index)) seam_corners_.push_back({index, vertices_.size()});
      add_vertex<0>(index, {});
    }
  }
}

template <int N, class Real>
bool Caps<N, Real>::is_on_seam(const typename RowShape<N>::Index& index) const noexcept {
  for (int a = 0; a < N; ++a)
    if ((seam_axes_ >> a & 1u) != 0 && (index[a] == 0 || index[a] + 1 == shape_.size(a))) return true;
  return false;
}

template <int N, class Real>
void Caps<N, Real>::add_layer(std::size_t k, const Layer<N>& layer, const Slab<N>* below, const Slab<N>* above) {
  for (std::size_t row = 0; row < shape_.rows(); ++row) add_corners(corners_[k % 2], layer, {row, k, below, above});
}

template <int N, class Real>
template <int Omitted>
void Caps<N, Real>::corner_ids(std::size_t row, std::size_t layer, std::size_t i, unsigned signature,
                               Index* out) const {
  using Frame = CellFrame<N, kAll ^ 1u << Omitted>;
  for (unsigned corner = 0; corner < 1u << (N - 1); ++corner) {
    if ((signature >> corner & 1u) == 0) continue;
    const unsigned mask = Frame::spread(corner);
    const EdgePlane& plane = corners_[(layer + (mask >> (N - 1) & 1u)) % 2];
    out[corner] = plane.id(shape_.shifted(row, mask), shape_.words(), i + (mask & 1u));
  }
}

template <int N, class Real>
template <int Omitted>
Word Caps<N, Real>::face_cells(const Slab<N>& slab, std::size_t row, std::size_t w, unsigned side) const {
  constexpr bool kAcrossRow = Omitted == 0;
  Word cells = shape_.mask(w, !kAcrossRow);
  if constexpr (kAcrossRow) {
    const std::size_t at = side == 0 ? 0 : shape_.size(0) - 1;
    cells = w == at / kWordBits ? Word{1} << (at % kWordBits) : 0;
  }
  if (slab.all_valid) return cells;
  const Word* const valid = slab.valid.data() + shape_.unshifted(row, side << Omitted) * shape_.words();
  if (!kAcrossRow || side == 0) return cells & valid[w];
  return cells & (valid[w] << 1 | (w == 0 ? 0 : valid[w - 1] >> (kWordBits - 1)));
}

template <int N, class Real>
template <int Omitted>
void Caps<N, Real>::add_face_row(const SlabView<N>& face, const Slab<N>& slab, std::size_t layer, unsigned side,
                                 std::size_t row) {
  constexpr unsigned kAxes = kAll ^ 1u << Omitted;
  constexpr unsigned kCorners = 1u << (N - 1);
  CellBits<N, kAxes> cells(face, row);
  CellEdges<N, kAxes> edges(face, row);
  // The contour's positive side faces inwards here. This is the sign of (frame of the face, inward direction) in
  // N-space.
  const bool flip = flip_ != (((N - 1 - Omitted) % 2 != 0) != (side != 0));
  auto index = shape_.index_of(row);
  index[N - 1] = layer;
  Ids ids;
  for (std::size_t w = 0; w < shape_.words(); ++w) {
    Word rest = face_cells<Omitted>(slab, row, w, side);
    if (rest == 0) continue;
    cells.load(w);
    edges.load(w);
    for (; rest != 0; rest &= rest - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(rest));
      const unsigned signature = original(cells.signature(bit), kCorners);
      if (tables_.face->lists[signature].simplex_count == 0) continue;
      index[0] = w * kWordBits + bit;
      if constexpr (N == 4)
        if (estimator_ != nullptr) {
          edges.ids(bit, ids.data() + kCorners);
          add_resolved<Omitted>(face, row, layer, index, signature, ids, !flip);
          continue;
        }
      const tables::RegionTable& table = N == 3 ? table_of<kAxes>(*tables_.face, signature, index) : *tables_.face;
      edges.ids(bit, ids.data() + kCorners);
      shared_ids<Omitted>(face, row, layer, index[0], signature, ids);
      add_own<kAxes>(table, signature, index, ids);
      add_simplices(table, signature, ids, flip);
    }
  }
}

template <int N, class Real>
template <int Omitted>
void Caps<N, Real>::shared_ids(const SlabView<N>& face, std::size_t row, std::size_t layer, std::size_t i,
                               unsigned signature, Ids& ids) const {
  corner_ids<Omitted>(row, layer, i, signature, ids.data());
  if constexpr (N == 4) {
    Index* const cubes = ids.data() + (1u << (N - 1)) + tables::edge_count(N - 1);
    if (counter_.has_cubes())
      for (unsigned j = 0; j < tables::kFaceSlots; ++j)
        cubes[j] = face.cubes(Omitted, 0).id(row, shape_.words(), i) + j;
  }
}

template <int N, class Real>
template <unsigned Axes>
const tables::RegionTable& Caps<N, Real>::table_of(
    const tables::RegionTable& low, [[maybe_unused]] unsigned signature,
    [[maybe_unused]] const typename RowShape<N>::Index& index) const noexcept {
  if constexpr (std::popcount(Axes) == 2)
    if (estimator_ != nullptr && ambiguous_signatures<2>()[signature]) {
      std::array<double, 4> values;
      estimator_->source().corner_values(index, Axes, values.data());
      if (estimator_->is_square_high(index, Axes, values)) return *tables_.high_face;
    }
  return low;
}

template <int N, class Real>
template <unsigned Axes>
void Caps<N, Real>::add_own(const tables::RegionTable& table, unsigned signature,
                            const typename RowShape<N>::Index& index, Ids& ids) {
  const tables::RegionList& list = table.lists[signature];
  if (list.own_vertices == 0) return;
  const EdgePlaces<N, Axes> places(source_, index, signature);
  for (unsigned j = 0; j < list.own_vertices; ++j) {
    ids[tables::first_region_vertex(N - 1) + j] = static_cast<Index>(vertices_.size());
    add_vertex<Axes>(index, region_place<N, Axes>(places, table.masks[list.first_mask + j]));
  }
}

template <int N, class Real>
void Caps<N, Real>::add_simplices(const tables::RegionTable& table, unsigned signature, const Ids& ids, bool flip) {
  const tables::RegionList& list = table.lists[signature];
  constexpr unsigned kFirst = 1u << (N - 1);  // first local vertex on the contour
  constexpr unsigned kEnd = kFirst + tables::edge_count(N - 1) + (N == 4 ? tables::kFaceSlots : 0);
  const auto number = [&](unsigned v) {
    if (v < kFirst || v >= kEnd) return kCapVertex | ids[v];
    return least_ + static_cast<Index>(ids[v] - static_cast<Index>(least_));
  };
  const std::uint8_t* stored = table.simplices + std::size_t{list.first_simplex} * N;
  for (unsigned q = 0; q < list.simplex_count; ++q, stored += N) {
    Simplex simplex;
    for (int j = 0; j < N; ++j) simplex[j] = number(stored[j]);
    if (flip) std::swap(simplex[N - 2], simplex[N - 1]);
    simplices_.push_back(simplex);
  }
}

/// Fills a cube with freely resolved ambiguities. Used for all cubes of the border, so that adjacent ones match.
template <int N, class Real>
template <int Omitted>
void Caps<N, Real>::add_resolved(const SlabView<N>& face, std::size_t row, std::size_t layer,
                                 const typename RowShape<N>::Index& index, unsigned signature, Ids& ids, bool flip) {
  constexpr unsigned kAxes = kAll ^ 1u << Omitted;
  using Regions = CubeRegions;
  // numbers of shared vertices
  const CubeKey key = cube_key<N>(*estimator_, index, kAxes, signature);
  corner_ids<Omitted>(row, layer, index[0], signature, ids.data());
  const unsigned own = cube_vertices(estimator_->triangulation(), key);
  if (estimator_->is_callers() && !face.cubes(Omitted, 0).has_listed(row, index[0], key.bits(), own))
    return estimator_->report_change(index);
  if (own != 0) {
    const Index first = face.cubes(Omitted, 0).listed_id(row, index[0]);
    for (unsigned j = 0; j < own; ++j) ids[Regions::kFirstOwn + j] = first + j;
  }
  const auto number = [&](unsigned v) {
    if (v < Regions::kFirstEdge || v >= Regions::kFirstCentre) return kCapVertex | ids[v];
    return least_ + static_cast<Index>(ids[v] - static_cast<Index>(least_));
  };
  // new vertices and tetrahedra of each region
  const EdgePlaces<N, kAxes> places(source_, index, signature);
  const bool barycentric = estimator_->triangulation() == Triangulation::barycentric;
  const Regions& regions = Regions::of_caps(estimator_->triangulation());
  for (const Regions::Region& region : regions.regions(list_of_key(key), true)) {
    const std::span<const std::uint32_t> masks = regions.centres(region);
    for (std::size_t j = 0; j < masks.size(); ++j) {
      ids[Regions::kFirstCentre + j] = static_cast<Index>(vertices_.size());
      add_vertex<kAxes>(index,
                        barycentric ? centre_place<kAxes>(places, masks[j]) : region_place<N, kAxes>(places, masks[j]));
    }
    for (const Regions::Tetrahedron& tetrahedron : regions.tetrahedra(region)) {
      Simplex simplex;
      for (int j = 0; j < N; ++j) simplex[j] = number(tetrahedron[j]);
      if (flip) std::swap(simplex[N - 2], simplex[N - 1]);
      simplices_.push_back(simplex);
    }
  }
}

template <int N, class Real>
template <int Omitted>
void Caps<N, Real>::add_face(const SlabView<N>& view, std::size_t k, unsigned side) {
  constexpr unsigned kAxes = kAll ^ 1u << Omitted;
  if (!closes(Omitted)) return;
  if (Omitted == N - 1 && k != (side == 0 ? 0 : shape_.layers() - 2)) return;
  // A face across the last axis lies in one layer; `in_layer` has it as the lower one.
  const SlabView<N> in_layer{&shape_, {view.layers[side], nullptr}, view.slab};
  const SlabView<N>& face = Omitted == N - 1 ? in_layer : view;
  const std::size_t layer = Omitted == N - 1 ? k + side : k;
  for (std::size_t row = 0; row < shape_.rows(); ++row) {
    const auto index = shape_.index_of(row);
    const bool across_rows = Omitted > 0 && Omitted < N - 1;
    if (across_rows && index[Omitted] != (side == 0 ? 0 : shape_.size(Omitted) - 1)) continue;
    if (shape_.has_cells(index, kAxes)) add_face_row<Omitted>(face, *view.slab, layer, side, row);
  }
}

template <int N, class Real>
void Caps<N, Real>::add_slab(std::size_t k, const SlabView<N>& view) {
  for (unsigned side = 0; side < 2; ++side) {
    add_face<0>(view, k, side);
    add_face<1>(view, k, side);
    if constexpr (N > 2) add_face<2>(view, k, side);
    if constexpr (N > 3) add_face<3>(view, k, side);
  }
}

#define TEGL_INSTANTIATE_CONTOURS(N, Real) template class Caps<N, Real>;
#include "base/instantiate.hpp"

}  // namespace tegl::detail
