// SPDX-License-Identifier: BSD-3-Clause
//
// Counting by popcount; see extract_count.hpp.
// Based on: W. Schroeder, R. Maynard, B. Geveci, Flying Edges, 2015 (count, prefix sum, generate by
// rows), here on bit planes and in any dimension.
#include "extract_count.hpp"

#include <algorithm>

namespace tegl::detail {

template <int N>
Counter<N>::Counter(const RowShape<N>& shape, const TableSet<N>& tables, const RowTable* rows)
    : shape_(shape), tile_(*tables.tile), rows_(rows) {
  if constexpr (N == 4)
    for (unsigned s = 0; s < 256; ++s) {
      cube_vertices_[s] = tables.cube->lists[tables.cube->list_of[s]].cone_vertices;
      has_cubes_ = has_cubes_ || cube_vertices_[s] != 0;
    }
}

template <int N>
void Counter<N>::allocate(Layer<N>& layer) const {
  layer.high.assign(shape_.rows() * shape_.pitch(), 0);
  layer.row_missing.assign(shape_.rows(), 0);
  layer.state.assign(shape_.rows(), RowState::mixed);
}

template <int N>
void Counter<N>::allocate(LayerPlanes<N>& planes) const {
  for (EdgePlane& plane : planes.edges) plane.allocate(shape_.rows(), shape_.pitch());
  if (has_cubes_) planes.cubes.allocate(shape_.rows(), shape_.pitch());
}

template <int N>
void Counter<N>::allocate(SlabPlanes<N>& planes) const {
  planes.active.assign(shape_.rows() * shape_.pitch(), 0);
  planes.active_count.assign(shape_.rows(), 0);
  if (rows_ != nullptr) planes.signatures.resize(shape_.rows() * shape_.size(0));
  planes.edges.allocate(shape_.rows(), shape_.pitch());
  if (has_cubes_)
    for (CubePlane& plane : planes.cubes) plane.allocate(shape_.rows(), shape_.pitch());
  planes.tile_base.assign(shape_.rows(), 0);
  planes.simplex_base.assign(shape_.rows(), 0);
}

template <int N>
void Counter<N>::allocate_missing(Layer<N>& layer) const {
  layer.missing.assign(shape_.rows() * shape_.pitch(), 0);
}

template <int N>
void Counter<N>::allocate_valid(Slab<N>& slab) const {
  slab.valid.assign(shape_.rows() * shape_.pitch(), 0);
}

template <int N>
std::size_t Counter<N>::layer_bytes() const noexcept {
  return shape_.rows() * (shape_.pitch() * sizeof(Word) + sizeof(RowState) + 1);
}

template <int N>
std::size_t Counter<N>::layer_planes_bytes() const noexcept {
  return shape_.rows() *
         ((N - 1) * EdgePlane::row_bytes(shape_.pitch()) + (has_cubes_ ? CubePlane::row_bytes(shape_.pitch()) : 0));
}

template <int N>
std::size_t Counter<N>::slab_planes_bytes() const noexcept {
  constexpr std::size_t kCounts = sizeof(std::uint32_t) + sizeof(Index) + sizeof(std::uint64_t);
  return shape_.rows() *
         (shape_.pitch() * sizeof(Word) + kCounts + (rows_ != nullptr ? shape_.size(0) * sizeof(std::uint16_t) : 0) +
          EdgePlane::row_bytes(shape_.pitch()) + (has_cubes_ ? (N - 1) * CubePlane::row_bytes(shape_.pitch()) : 0));
}

template <int N>
void Counter<N>::classify(const SampleSource<N>& source, std::size_t k, bool invert, std::size_t row, Layer<N>& layer,
                          Word* buffer) const {
  auto start = shape_.index_of(row);
  start[N - 1] = k;
  Word* const high = layer.high.data() + row * shape_.pitch();
  Word* const missing = layer.missing.empty() ? buffer : layer.missing.data() + row * shape_.pitch();
  const bool any = source.classify(start, high, missing);
  if (!any && layer.row_missing[row] != 0) std::fill(missing, missing + shape_.words(), Word{0});
  layer.row_missing[row] = any ? 1 : 0;
  if (invert)
    for (std::size_t w = 0; w < shape_.words(); ++w) high[w] = ~high[w] & shape_.mask(w, false);
  Word ones = 0;
  Word zeros = 0;
  for (std::size_t w = 0; w < shape_.words(); ++w) {
    ones |= high[w];
    zeros |= ~high[w] & shape_.mask(w, false);
  }
  layer.state[row] = any || (ones != 0 && zeros != 0) ? RowState::mixed : ones != 0 ? RowState::high : RowState::low;
}

template <int N>
void Counter<N>::find_missing(Layer<N>& layer) {
  layer.any_missing =
      std::find(layer.row_missing.begin(), layer.row_missing.end(), std::uint8_t{1}) != layer.row_missing.end();
}

template <int N>
void Counter<N>::find_valid(const Layer<N>& lower, const Layer<N>& upper, std::size_t row, Slab<N>& slab) const {
  constexpr unsigned kMiddle = ((1u << (N - 1)) - 1) & ~1u;
  Word* const valid = slab.valid.data() + row * shape_.pitch();
  std::fill(valid, valid + shape_.words(), Word{0});
  if (!shape_.has_cells(shape_.index_of(row), kMiddle)) return;
  for (const Layer<N>* layer : {&lower, &upper})
    for (unsigned corner = 0; corner <= kMiddle; corner += 2) {
      const std::size_t at = shape_.shifted(row, corner);
      if (layer->row_missing[at] == 0) continue;
      const Word* const missing = layer->missing.data() + at * shape_.pitch();
      for (std::size_t w = 0; w < shape_.words(); ++w)
        valid[w] |= missing[w] | missing[w] >> 1 | missing[w + 1] << (kWordBits - 1);
    }
  for (std::size_t w = 0; w < shape_.words(); ++w) valid[w] = ~valid[w] & shape_.mask(w, true);
}

template <int N>
bool Counter<N>::cells_of_valid_tiles(unsigned axes, std::size_t row, const Slab<N>* below, const Slab<N>* above,
                                      Word* out) const {
  if ((below != nullptr && below->all_valid) || (above != nullptr && above->all_valid)) return false;
  const auto index = shape_.index_of(row);
  std::fill(out, out + shape_.words(), Word{0});
  // The tiles around a cell: displaced backwards along any of the axes that the cell does not span.
  for (unsigned back = 0; back < 1u << (N - 1); back += 2) {
    bool exists = (back & axes) == 0;
    for (int a = 1; a < N - 1; ++a) exists = exists && ((back >> a & 1u) == 0 || index[a] > 0);
    if (!exists) continue;
    for (const Slab<N>* slab : {below, above}) {
      if (slab == nullptr) continue;
      const Word* const valid = slab->valid.data() + shape_.unshifted(row, back) * shape_.pitch();
      Word carry = 0;
      for (std::size_t w = 0; w < shape_.words(); ++w) {
        out[w] |= valid[w];
        if ((axes & 1u) == 0) out[w] |= valid[w] << 1 | carry;
        carry = valid[w] >> (kWordBits - 1);
      }
    }
  }
  return true;
}

template <int N>
void Counter<N>::count_edges(EdgePlane& plane, std::size_t row, const Word* a, const Word* b, bool along_row,
                             const Word* valid) const {
  const std::size_t at = row * shape_.pitch();
  plane.count[row] = count_edge_row(a, along_row ? nullptr : b, shape_.size(0), valid, plane.bits[0].data() + at,
                                    plane.prefix.data() + at);
}

template <int N>
template <unsigned Axes>
void Counter<N>::count_cubes(CubePlane& plane, const SlabView<N>& view, std::size_t row, const Word* valid) const {
  const std::size_t pitch = shape_.pitch();
  plane.count[row] = 0;
  if (!shape_.has_cells(shape_.index_of(row), Axes)) return;  // its bits have been 0 from the start
  CellBits<N, Axes> cells(view, row);
  std::uint32_t count = 0;
  for (std::size_t w = 0; w < shape_.words(); ++w) {
    cells.load(w);
    std::array<Word, tables::kFaceSlots> bits{};
    Word mixed = cells.mixed() & shape_.mask(w, (Axes & 1u) != 0);
    if (valid != nullptr) mixed &= valid[w];
    plane.prefix[row * pitch + w] = count;
    for (; mixed != 0; mixed &= mixed - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(mixed));
      const unsigned vertices = cube_vertices_[cells.signature(bit)];
      for (unsigned slot = 0; slot < vertices; ++slot) bits[slot] |= Word{1} << bit;
      count += vertices;
    }
    for (unsigned slot = 0; slot < tables::kFaceSlots; ++slot) plane.bits[slot][row * pitch + w] = bits[slot];
  }
  plane.count[row] = count;
}

template <int N>
void Counter<N>::count_layer(Layer<N>& layer, const Slab<N>* below, const Slab<N>* above, std::size_t row,
                             Word* buffer) const {
  const auto index = shape_.index_of(row);
  const Word* const high = layer.high.data() + row * shape_.pitch();
  for (int axis = 0; axis < N - 1; ++axis) {
    const unsigned mask = 1u << axis;
    layer.edges[axis].count[row] = 0;
    if (!shape_.has_cells(index, mask)) continue;
    const RowState state = layer.state[row];
    if (state != RowState::mixed && state == layer.state[shape_.shifted(row, mask)]) continue;
    const bool masked = cells_of_valid_tiles(mask, row, below, above, buffer);
    const Word* const next = layer.high.data() + shape_.shifted(row, mask) * shape_.pitch();
    count_edges(layer.edges[axis], row, high, next, axis == 0, masked ? buffer : nullptr);
  }
  if constexpr (N == 4)
    if (has_cubes_) {
      const bool masked = cells_of_valid_tiles(7u, row, below, above, buffer);
      count_cubes<7u>(layer.cubes, {&shape_, {&layer, nullptr}, nullptr}, row, masked ? buffer : nullptr);
    }
}

/// Whether all corners of a row's tiles are alike.
template <int N>
static bool is_uniform(const SlabView<N>& view, std::size_t row) {
  const RowState first = view.layers[0]->state[row];
  if (first == RowState::mixed) return false;
  constexpr unsigned kMiddle = ((1u << (N - 1)) - 1) & ~1u;
  bool uniform = true;
  for (const Layer<N>* layer : view.layers)
    for (unsigned corner = 0; corner <= kMiddle; corner += 2)
      uniform = uniform && layer->state[view.shape->shifted(row, corner)] == first;
  return uniform;
}

template <int N>
void Counter<N>::count_tiles(const SlabView<N>& view, Slab<N>& slab, std::size_t row) const {
  constexpr unsigned kAll = (1u << N) - 1;
  Word* const active = slab.active.data() + row * shape_.pitch();
  slab.tile_base[row] = 0;
  slab.simplex_base[row] = 0;
  slab.active_count[row] = 0;
  if (!shape_.has_cells(shape_.index_of(row), kAll)) return;
  if (is_uniform(view, row)) return;
  CellBits<N, kAll> cells(view, row);
  if (rows_ != nullptr) {
    TileRow tiles{{}, shape_.size(0) - 1, slab.all_valid ? nullptr : slab.valid.data() + row * shape_.pitch()};
    std::copy(cells.rows().begin(), cells.rows().end(), tiles.corners.begin());
    const TileCount count = count_tile_row<N>(tiles, *rows_, active, slab.signatures.data() + row * shape_.size(0));
    slab.tile_base[row] = count.own_vertices;
    slab.simplex_base[row] = count.simplices;
    slab.active_count[row] = count.active;
    return;
  }
  for (std::size_t w = 0; w < shape_.words(); ++w) {
    cells.load(w);
    Word mixed = cells.mixed() & shape_.mask(w, true);
    if (!slab.all_valid) mixed &= slab.valid[row * shape_.pitch() + w];
    active[w] = mixed;
    for (; mixed != 0; mixed &= mixed - 1) {
      const unsigned signature = cells.signature(static_cast<unsigned>(std::countr_zero(mixed)));
      const tables::List& list = tile_.lists[tile_.list_of[signature]];
      slab.tile_base[row] += Index{list.cone_vertices} + list.side_vertices;
      slab.simplex_base[row] += list.simplex_count;
      ++slab.active_count[row];
    }
  }
}

template <int N>
void Counter<N>::count_slab(const SlabView<N>& view, Slab<N>& slab, std::size_t row, Word* buffer) const {
  const Word* const lower = view.layers[0]->high.data() + row * shape_.pitch();
  const Word* const upper = view.layers[1]->high.data() + row * shape_.pitch();
  const RowState state = view.layers[0]->state[row];
  slab.edges.count[row] = 0;
  if (state == RowState::mixed || state != view.layers[1]->state[row]) {
    const bool masked = cells_of_valid_tiles(1u << (N - 1), row, nullptr, &slab, buffer);
    count_edges(slab.edges, row, lower, upper, false, masked ? buffer : nullptr);
  }
  if constexpr (N == 4)
    if (has_cubes_) {
      const auto valid = [&](unsigned axes) {
        return cells_of_valid_tiles(axes, row, nullptr, &slab, buffer) ? buffer : nullptr;
      };
      count_cubes<14u>(slab.cubes[0], view, row, valid(14u));
      count_cubes<13u>(slab.cubes[1], view, row, valid(13u));
      count_cubes<11u>(slab.cubes[2], view, row, valid(11u));
    }
  count_tiles(view, slab, row);
}

namespace {

template <class Plane>
void place(Plane& plane, std::size_t row, std::uint64_t& next) {
  plane.base[row] = static_cast<Index>(next);
  next += plane.count[row];
}

}  // namespace

template <int N>
std::uint64_t Counter<N>::place_layer(Layer<N>& layer, std::uint64_t first) const {
  std::uint64_t next = first;
  for (std::size_t row = 0; row < shape_.rows(); ++row) {
    for (EdgePlane& plane : layer.edges) place(plane, row, next);
    if (has_cubes_) place(layer.cubes, row, next);
  }
  return next;
}

template <int N>
std::uint64_t Counter<N>::place_slab(Slab<N>& slab, std::uint64_t first, std::uint64_t& first_simplex) const {
  std::uint64_t next = first;
  for (std::size_t row = 0; row < shape_.rows(); ++row) {
    place(slab.edges, row, next);
    if (has_cubes_)
      for (CubePlane& plane : slab.cubes) place(plane, row, next);
    const std::uint64_t own_vertices = slab.tile_base[row];
    slab.tile_base[row] = static_cast<Index>(next);
    next += own_vertices;
    const std::uint64_t simplices = slab.simplex_base[row];
    slab.simplex_base[row] = first_simplex;
    first_simplex += simplices;
  }
  return next;
}

template class Counter<2>;
template class Counter<3>;
template class Counter<4>;

}  // namespace tegl::detail
