// SPDX-License-Identifier: BSD-3-Clause
//
// Derives the rows that an extraction processes from the active tiles of an index (see tile_selection.hpp).
#include "kernel/tile_selection.hpp"

#include <algorithm>
#include <bit>

namespace tegl::detail {

static_assert(kChunkRows == 32, "a chunk's rows are the bits of a word");

namespace {

/// Number of a sample's row in its layer, from its index on axes 1 ... N - 2.
template <int N>
std::size_t row_of(const typename TileGrid<N>::GridIndex& index, const std::array<std::size_t, N>& samples) noexcept {
  std::size_t row = 0;
  for (int a = N - 2; a > 0; --a) row = row * samples[a] + index[a];
  return row;
}

template <int N>
std::size_t rows_in_layer(const std::array<std::size_t, N>& samples) noexcept {
  std::size_t rows = 1;
  for (int a = 1; a < N - 1; ++a) rows *= samples[a];
  return rows;
}

}  // namespace

template <int N>
TileSelection::TileSelection(const tegl::ActiveTiles<N>& active, const TileRowSet& tile_rows) {
  const auto& samples = active.image().sizes;
  const TileGrid<N>& grid = active.grid();
  chunks_ = chunk_of(rows_in_layer<N>(samples) - 1) + 1;
  rows_.assign(chunks_ * samples[N - 1], 0);
  for (std::size_t w = 0; w < tile_rows.words().size(); ++w)
    for (std::uint64_t word = tile_rows.words()[w]; word != 0; word &= word - 1) {
      const std::size_t tile_row = w * 64 + static_cast<unsigned>(std::countr_zero(word));
      const auto base = grid.index(TileNumber{tile_row} * grid.size(0));
      for (unsigned corner = 0; corner < 1u << (N - 1); ++corner) {
        auto index = base;
        for (int a = 1; a < N; ++a) index[a] += corner >> (a - 1) & 1u;
        const std::size_t row = row_of<N>(index, samples);
        rows_[index[N - 1] * chunks_ + chunk_of(row)] |= 1u << (row % kChunkRows);
      }
    }
}

template <int N>
TileSelection TileSelection::rows_of(const tegl::ActiveTiles<N>& active, double isovalue) {
  return TileSelection(active, active.find_rows(isovalue));
}

template <int N>
TileSelection TileSelection::tiles_of(const tegl::ActiveTiles<N>& active, double isovalue) {
  const std::vector<TileNumber> tiles = active.find(isovalue);
  TileRowSet tile_rows(active.grid().rows());
  tile_rows.add_rows_of(active.grid(), tiles);
  TileSelection selection(active, tile_rows);
  selection.place_tiles(active, tiles);
  return selection;
}

template <int N>
void TileSelection::place_tiles(const tegl::ActiveTiles<N>& active, const std::vector<TileNumber>& tiles) {
  const auto& samples = active.image().sizes;
  only_these_ = true;
  first_.assign(chunks_ * active.grid().size(N - 1) + 1, 0);
  places_.reserve(tiles.size());
  for (const TileNumber tile : tiles) {  // ascending: by slab, then by row, then along the row
    const auto index = active.grid().index(tile);
    const std::size_t row = row_of<N>(index, samples);
    ++first_[index[N - 1] * chunks_ + chunk_of(row) + 1];
    places_.push_back({static_cast<std::uint32_t>(row % kChunkRows), static_cast<std::uint32_t>(index[0])});
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
}

void TileSelection::write_valid(std::size_t slab, std::size_t chunk, std::size_t chunk_rows, std::size_t words,
                                std::vector<Word>& valid) const noexcept {
  Word* const first = valid.data() + chunk * kChunkRows * words;
  std::fill_n(first, chunk_rows * words, Word{0});
  const std::size_t at = slab * chunks_ + chunk;
  for (std::size_t i = first_[at]; i < first_[at + 1]; ++i)
    first[places_[i].row * words + places_[i].at / kWordBits] |= Word{1} << (places_[i].at % kWordBits);
}

#define TEGL_INSTANTIATE(N)                                                              \
  template TileSelection TileSelection::rows_of<N>(const tegl::ActiveTiles<N>&, double); \
  template TileSelection TileSelection::tiles_of<N>(const tegl::ActiveTiles<N>&, double);
TEGL_INSTANTIATE(2)
TEGL_INSTANTIATE(3)
TEGL_INSTANTIATE(4)
#undef TEGL_INSTANTIATE

}  // namespace tegl::detail
