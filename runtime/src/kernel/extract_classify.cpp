// SPDX-License-Identifier: BSD-3-Clause
//
// Passes 1 and 2 of the extraction (see extract_count.hpp): classify samples into bits, then find the tiles without a
// missing corner.
#include "kernel/extract_count.hpp"

#include <algorithm>

#include "kernel/tile_selection.hpp"

namespace tegl::detail {

template <int N>
void Counter<N>::classify(const SampleClassifier<N>& source, std::size_t k, bool invert, std::size_t chunk,
                          Layer<N>& layer, Word* buffer, const TileSelection* selection) const {
  const std::size_t first = chunk * kChunkRows;
  bool uniform = true;
  if (selection == nullptr)
    classify_rows(source, k, invert, first, shape_.chunk_end(chunk), layer, buffer);
  else
    classify_selected(source, k, invert, chunk, layer, buffer, *selection);
  for (std::size_t row = first; row < shape_.chunk_end(chunk); ++row)
    uniform = uniform && layer.state[row] == layer.state[first];
  layer.chunk_state[chunk] = uniform ? layer.state[first] : RowState::mixed;
}

template <int N>
void Counter<N>::classify_rows(const SampleClassifier<N>& source, std::size_t k, bool invert, std::size_t first,
                               std::size_t end, Layer<N>& layer, Word* buffer) const {
  const std::size_t pitch = shape_.pitch();
  for (std::size_t row = first; row < end;) {
    auto start = shape_.index_of(row);
    start[N - 1] = k;
    const std::size_t along = N > 2 ? shape_.size(1) - start[1] : 1;
    const std::size_t rows = std::min({end - row, along, kWordBits});
    Word* const high = layer.high.data() + row * pitch;
    const BitRows missing =
        layer.missing.empty() ? BitRows{buffer, 0} : BitRows{layer.missing.data() + row * pitch, pitch};
    const Word any_missing = source.classify(start, rows, {high, pitch}, missing);
    for (std::size_t r = 0; r < rows; ++r) {
      const bool any = (any_missing >> r & 1u) != 0;
      if (!any && layer.row_missing[row + r] != 0)
        std::fill_n(missing.first + r * missing.pitch, shape_.words(), Word{0});
      layer.row_missing[row + r] = any ? 1 : 0;
      layer.state[row + r] = finish_row(high + r * pitch, invert, any);
    }
    row += rows;
  }
}

template <int N>
void Counter<N>::classify_selected(const SampleClassifier<N>& source, std::size_t k, bool invert, std::size_t chunk,
                                   Layer<N>& layer, Word* buffer, const TileSelection& selection) const {
  const std::uint32_t selected = selection.rows(k, chunk);
  const std::size_t first = chunk * kChunkRows;
  const std::size_t end = shape_.chunk_end(chunk);
  for (std::size_t row = first, next; row < end; row = next) {
    const std::uint32_t rest = selected >> (row - first);
    const bool here = (rest & 1u) != 0;
    next = std::min(end, row + static_cast<std::size_t>(std::countr_zero(here ? ~rest : rest)));
    if (here) {
      classify_rows(source, k, invert, row, next, layer, buffer);
    } else if (selection.only_these()) {
      std::fill(layer.state.begin() + static_cast<std::ptrdiff_t>(row),
                layer.state.begin() + static_cast<std::ptrdiff_t>(next), RowState::low);
    } else {
      guess_rows(source, k, invert, row, next, layer);
    }
  }
}

template <int N>
void Counter<N>::guess_rows(const SampleClassifier<N>& source, std::size_t k, bool invert, std::size_t first,
                            std::size_t end, Layer<N>& layer) const {
  bool high = false;
  for (std::size_t row = first; row < end; ++row) {
    auto index = shape_.index_of(row);
    if (row == first || index[1] == 0) {  // otherwise it is adjacent to the row before and has the same state
      index[N - 1] = k;
      high = source.is_high(index) != invert;
    }
    layer.state[row] = high ? RowState::high : RowState::low;
    if (ranks_ == RankReaders::none && !has_cubes_) continue;
    // Closing at the border and counting cubes read bits.
    for (std::size_t w = 0; w < shape_.words(); ++w)
      layer.high[row * shape_.pitch() + w] = high ? shape_.mask(w, false) : 0;
  }
}

template <int N>
RowState Counter<N>::finish_row(Word* high, bool invert, bool any_missing) const {
  const std::size_t last = shape_.words() - 1;
  const Word last_mask = shape_.mask(last, false);
  if (invert) {
    for (std::size_t w = 0; w < last; ++w) high[w] = ~high[w];
    high[last] = ~high[last] & last_mask;
  }
  Word any = high[last];
  Word all = high[last] | ~last_mask;
  for (std::size_t w = 0; w < last; ++w) {
    any |= high[w];
    all &= high[w];
  }
  if (any_missing || (any != 0 && ~all != 0)) return RowState::mixed;
  return any != 0 ? RowState::high : RowState::low;
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
  Word* const valid = slab.valid.data() + row * shape_.words();
  std::fill(valid, valid + shape_.words(), Word{0});
  if (!shape_.has_cells(shape_.index_of(row), kMiddle)) return;
  // corners that are missing
  for (const Layer<N>* layer : {&lower, &upper})
    for (unsigned corner = 0; corner <= kMiddle; corner += 2) {
      const std::size_t at = shape_.shifted(row, corner);
      if (layer->row_missing[at] == 0) continue;
      const Word* const missing = layer->missing.data() + at * shape_.pitch();
      for (std::size_t w = 0; w < shape_.words(); ++w)
        valid[w] |= missing[w] | missing[w] >> 1 | missing[w + 1] << (kWordBits - 1);
    }
  // tiles without any of them
  for (std::size_t w = 0; w < shape_.words(); ++w) valid[w] = ~valid[w] & shape_.mask(w, true);
}

template <int N>
bool Counter<N>::cells_of_valid_tiles(unsigned axes, std::size_t row, const Slab<N>* below, const Slab<N>* above,
                                      Word* out) const {
  if ((below != nullptr && below->all_valid) || (above != nullptr && above->all_valid)) return false;
  const auto index = shape_.index_of(row);
  std::fill(out, out + shape_.words(), Word{0});
  // A cell belongs to the tiles displaced backwards along any axes that the cell does not span.
  for (unsigned back = 0; back < 1u << (N - 1); back += 2) {
    bool exists = (back & axes) == 0;
    for (int a = 1; a < N - 1; ++a) exists = exists && ((back >> a & 1u) == 0 || index[a] > 0);
    if (!exists) continue;
    for (const Slab<N>* slab : {below, above}) {
      if (slab == nullptr) continue;
      const Word* const valid = slab->valid.data() + shape_.unshifted(row, back) * shape_.words();
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

template class Counter<2>;
template class Counter<3>;
template class Counter<4>;

}  // namespace tegl::detail
