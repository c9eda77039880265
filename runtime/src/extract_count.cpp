// SPDX-License-Identifier: BSD-3-Clause
//
// Counting by popcount; see extract_count.hpp.
// Based on: W. Schroeder, R. Maynard, B. Geveci, Flying Edges, 2015 (count, prefix sum, generate by
// rows), here on bit planes and in any dimension.
#include "extract_count.hpp"

#include <algorithm>

namespace tegl::detail {

template <int N>
Counter<N>::Counter(const RowShape<N>& shape, const TableSet<N>& tables, const RowTable* rows, bool ranks)
    : shape_(shape), tile_(*tables.tile), rows_(rows), ranks_(ranks) {
  if constexpr (N == 4)
    for (unsigned s = 0; s < 256; ++s) {
      cube_vertices_[s] = tables.cube->lists[tables.cube->list_of[s]].cone_vertices;
      has_cubes_ = has_cubes_ || cube_vertices_[s] != 0;
    }
  quick_ = rows_ != nullptr && !has_cubes_ && shape_.size(0) <= kMostListed;
}

template <int N>
void Counter<N>::allocate(Layer<N>& layer) const {
  layer.high.assign(shape_.rows() * shape_.pitch(), 0);
  layer.row_missing.assign(shape_.rows(), 0);
  layer.state.assign(shape_.rows(), RowState::mixed);
  layer.chunk_state.assign(shape_.chunks(), RowState::mixed);
}

template <int N>
void Counter<N>::allocate(LayerPlanes<N>& planes) const {
  for (EdgePlane& plane : planes.edges) plane.allocate(shape_.rows(), shape_.pitch());
  planes.chunk_vertices.assign(shape_.chunks(), 0);
  if (has_cubes_) planes.cubes.allocate(shape_.rows(), shape_.pitch());
}

template <int N>
void Counter<N>::allocate(SlabPlanes<N>& planes) const {
  planes.active.assign(shape_.rows() * shape_.pitch(), 0);
  planes.active_count.assign(shape_.rows(), 0);
  if (rows_ != nullptr) {
    constexpr std::size_t kMargin = 64;  // is read and written in vain
    planes.signatures.resize(shape_.rows() * shape_.size(0) + kMargin);
    planes.tiles_at.resize(shape_.rows() * shape_.size(0) + kMargin);
  }
  planes.edges.allocate(shape_.rows(), shape_.pitch());
  if (has_cubes_)
    for (CubePlane& plane : planes.cubes) plane.allocate(shape_.rows(), shape_.pitch());
  planes.first_tile.assign(shape_.rows(), 0);
  planes.own_offset.assign(shape_.rows(), 0);
  planes.simplex_offset.assign(shape_.rows(), 0);
  planes.chunks.assign(shape_.chunks(), {});
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
  constexpr std::size_t kCounts = sizeof(std::uint32_t) + sizeof(Index) + sizeof(std::uint64_t) + sizeof(std::size_t);
  const std::size_t tiles = rows_ != nullptr ? shape_.size(0) * 2 * sizeof(std::uint16_t) : 0;
  return shape_.rows() * (shape_.pitch() * sizeof(Word) + kCounts + tiles + EdgePlane::row_bytes(shape_.pitch()) +
                          (has_cubes_ ? (N - 1) * CubePlane::row_bytes(shape_.pitch()) : 0));
}

template <int N>
void Counter<N>::classify(const SampleSource<N>& source, std::size_t k, bool invert, std::size_t chunk, Layer<N>& layer,
                          Word* buffer) const {
  const std::size_t first = chunk * kChunkRows;
  bool uniform = true;
  for (std::size_t row = first; row < shape_.chunk_end(chunk); ++row) {
    classify_row(source, k, invert, row, layer, buffer);
    uniform = uniform && layer.state[row] == layer.state[first];
  }
  layer.chunk_state[chunk] = uniform ? layer.state[first] : RowState::mixed;
}

template <int N>
void Counter<N>::classify_row(const SampleSource<N>& source, std::size_t k, bool invert, std::size_t row,
                              Layer<N>& layer, Word* buffer) const {
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
void Counter<N>::find_valid(const Layer<N>& lower, const Layer<N>& upper, std::size_t chunk, Slab<N>& slab) const {
  for (std::size_t row = chunk * kChunkRows; row < shape_.chunk_end(chunk); ++row)
    find_valid_row(lower, upper, row, slab);
}

template <int N>
void Counter<N>::find_valid_row(const Layer<N>& lower, const Layer<N>& upper, std::size_t row, Slab<N>& slab) const {
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
void Counter<N>::count_layer_row(Layer<N>& layer, const Slab<N>* below, const Slab<N>* above, std::size_t row,
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

namespace {

template <int N>
TileRow tile_row(const RowShape<N>& shape, const SlabView<N>& view, const Slab<N>& slab, std::size_t row) {
  constexpr unsigned kAll = (1u << N) - 1;
  TileRow tiles{{}, shape.size(0) - 1, slab.all_valid ? nullptr : slab.valid.data() + row * shape.pitch()};
  const CellBits<N, kAll> cells(view, row);
  std::copy(cells.rows().begin(), cells.rows().end(), tiles.corners.begin());
  return tiles;
}

template <int N>
TileRoom tile_room(const RowShape<N>& shape, Slab<N>& slab, std::size_t row) {
  const std::size_t first = slab.first_tile[row];
  return {slab.active.data() + row * shape.pitch(), slab.signatures.data() + first, slab.tiles_at.data() + first};
}

template <int N>
void keep_tiles(const TileCount& count, Slab<N>& slab, std::size_t row) {
  slab.own_offset[row] = count.own_vertices;
  slab.simplex_offset[row] = count.simplices;
  slab.active_count[row] = count.active;
}

}  // namespace

template <int N>
void Counter<N>::count_tiles(const SlabView<N>& view, Slab<N>& slab, std::size_t row) const {
  constexpr unsigned kAll = (1u << N) - 1;
  Word* const active = slab.active.data() + row * shape_.pitch();
  slab.own_offset[row] = 0;
  slab.simplex_offset[row] = 0;
  slab.active_count[row] = 0;
  if (!shape_.has_cells(shape_.index_of(row), kAll)) return;
  if (is_uniform(view, row)) return;
  if (rows_ != nullptr) {
    keep_tiles(count_tile_row<N>(tile_row(shape_, view, slab, row), *rows_, tile_room(shape_, slab, row)), slab, row);
    return;
  }
  CellBits<N, kAll> cells(view, row);
  for (std::size_t w = 0; w < shape_.words(); ++w) {
    cells.load(w);
    Word mixed = cells.mixed() & shape_.mask(w, true);
    if (!slab.all_valid) mixed &= slab.valid[row * shape_.pitch() + w];
    active[w] = mixed;
    for (; mixed != 0; mixed &= mixed - 1) {
      const unsigned signature = cells.signature(static_cast<unsigned>(std::countr_zero(mixed)));
      const tables::List& list = tile_.lists[tile_.list_of[signature]];
      slab.own_offset[row] += Index{list.cone_vertices} + list.side_vertices;
      slab.simplex_offset[row] += list.simplex_count;
      ++slab.active_count[row];
    }
  }
}

template <int N>
void Counter<N>::count_slab_row(const SlabView<N>& view, Slab<N>& slab, std::size_t row, Word* buffer) const {
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

template <int N>
void Counter<N>::count_quickly(const SlabView<N>& view, Layer<N>& upper, Slab<N>& slab, std::size_t row) const {
  TileCount count;
  if (!is_uniform(view, row))
    count = count_tile_row<N>(tile_row(shape_, view, slab, row), *rows_, tile_room(shape_, slab, row));
  keep_tiles(count, slab, row);
  for (int axis = 0; axis < N - 1; ++axis) upper.edges[axis].count[row] = count.edges[axis];
  slab.edges.count[row] = count.edges[N - 1];
}

template <int N>
bool Counter<N>::is_uniform_chunk(const SlabView<N>& view, std::size_t chunk) const {
  constexpr unsigned kMiddle = ((1u << (N - 1)) - 1) & ~1u;
  const RowState first = view.layers[0]->chunk_state[chunk];
  if (first == RowState::mixed) return false;
  const std::size_t last = shape_.chunk_end(chunk) - 1;
  for (unsigned corner = 0; corner <= kMiddle; corner += 2) {
    const std::size_t end = chunk_of(std::min(shape_.rows() - 1, shape_.shifted(last, corner)));
    for (std::size_t c = chunk_of(shape_.shifted(chunk * kChunkRows, corner)); c <= end; ++c)
      if (view.layers[0]->chunk_state[c] != first || view.layers[1]->chunk_state[c] != first) return false;
  }
  return true;
}

template <int N>
void Counter<N>::clear_chunk(Layer<N>& upper, Slab<N>& slab, std::size_t chunk) const {
  const auto clear = [&](auto& plane) {
    std::fill(plane.count.begin() + static_cast<std::ptrdiff_t>(chunk * kChunkRows),
              plane.count.begin() + static_cast<std::ptrdiff_t>(shape_.chunk_end(chunk)), 0u);
  };
  if (upper.chunk_vertices[chunk] != 0) {
    for (EdgePlane& plane : upper.edges) clear(plane);
    if (has_cubes_) clear(upper.cubes);
  }
  upper.chunk_vertices[chunk] = 0;
  if (slab.chunks[chunk].vertices != 0) {
    clear(slab.edges);
    if (has_cubes_)
      for (CubePlane& plane : slab.cubes) clear(plane);
  }
  slab.chunks[chunk] = {};
}

namespace {

template <class Plane>
void offset(Plane& plane, std::size_t row, std::uint64_t& next) {
  plane.offset[row] = static_cast<Index>(next);
  next += plane.count[row];
}

}  // namespace

template <int N>
std::uint64_t Counter<N>::offset_layer_row(Layer<N>& layer, std::size_t row, std::uint64_t first) const {
  std::uint64_t next = first;
  for (EdgePlane& plane : layer.edges) offset(plane, row, next);
  if (has_cubes_) offset(layer.cubes, row, next);
  return next - first;
}

template <int N>
std::uint64_t Counter<N>::offset_slab_row(Slab<N>& slab, std::size_t row, SlabChunk& sums) const {
  std::uint64_t next = sums.vertices;
  offset(slab.edges, row, next);
  if (has_cubes_)
    for (CubePlane& plane : slab.cubes) offset(plane, row, next);
  const std::uint64_t own_vertices = slab.own_offset[row];
  slab.own_offset[row] = static_cast<Index>(next);
  next += own_vertices;
  const std::uint64_t simplices = slab.simplex_offset[row];
  slab.simplex_offset[row] = sums.simplices;
  sums.simplices += simplices;
  sums.active += slab.active_count[row];
  std::swap(sums.vertices, next);
  return sums.vertices - next;
}

template <int N>
void Counter<N>::count_first_layer(Layer<N>& layer, const Slab<N>& above, std::size_t chunk, Word* buffer) const {
  std::uint64_t vertices = 0;
  for (std::size_t row = chunk * kChunkRows; row < shape_.chunk_end(chunk); ++row) {
    count_layer_row(layer, nullptr, &above, row, buffer);
    vertices += offset_layer_row(layer, row, vertices);
  }
  layer.chunk_vertices[chunk] = vertices;
}

template <int N>
void Counter<N>::count_slab(const SlabView<N>& view, Layer<N>& upper, Slab<N>& slab, const Slab<N>* above,
                            std::size_t chunk, Word* buffer) const {
  if (is_uniform_chunk(view, chunk)) return clear_chunk(upper, slab, chunk);
  // Tiles next to missing values ask for the ranks of their edges.
  const bool ranks = !quick_ || ranks_ || !slab.all_valid || (above != nullptr && !above->all_valid);
  SlabChunk sums;
  std::uint64_t in_layer = 0;
  for (std::size_t row = chunk * kChunkRows; row < shape_.chunk_end(chunk); ++row) {
    slab.first_tile[row] = chunk * kChunkRows * shape_.size(0) + sums.active;
    if (!ranks && goes_by_tiles(slab, row)) {
      count_quickly(view, upper, slab, row);
    } else {
      count_layer_row(upper, &slab, above, row, buffer);
      count_slab_row(view, slab, row, buffer);
    }
    const std::uint64_t vertices = offset_layer_row(upper, row, in_layer);
    in_layer += vertices;
    const bool busy = (offset_slab_row(slab, row, sums) | vertices | slab.active_count[row]) != 0;
    sums.busy |= static_cast<std::uint32_t>(busy) << (row % kChunkRows);
  }
  upper.chunk_vertices[chunk] = in_layer;
  slab.chunks[chunk] = sums;
}

template <int N>
std::uint64_t Counter<N>::place_layer(Layer<N>& layer, std::uint64_t first) const {
  std::uint64_t next = first;
  for (std::size_t chunk = 0; chunk < shape_.chunks(); ++chunk) {
    for (EdgePlane& plane : layer.edges) plane.chunk_first[chunk] = static_cast<Index>(next);
    if (has_cubes_) layer.cubes.chunk_first[chunk] = static_cast<Index>(next);
    next += layer.chunk_vertices[chunk];
  }
  return next;
}

template <int N>
std::uint64_t Counter<N>::place_slab(Slab<N>& slab, std::uint64_t first, std::uint64_t& first_simplex) const {
  std::uint64_t next = first;
  for (std::size_t chunk = 0; chunk < shape_.chunks(); ++chunk) {
    slab.edges.chunk_first[chunk] = static_cast<Index>(next);
    if (has_cubes_)
      for (CubePlane& plane : slab.cubes) plane.chunk_first[chunk] = static_cast<Index>(next);
    slab.chunks[chunk].first_simplex = first_simplex;
    next += slab.chunks[chunk].vertices;
    first_simplex += slab.chunks[chunk].simplices;
  }
  return next;
}

template class Counter<2>;
template class Counter<3>;
template class Counter<4>;

}  // namespace tegl::detail
