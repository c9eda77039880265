// SPDX-License-Identifier: BSD-3-Clause
//
// The working storage of the extraction: bit planes of the layers along the last axis, with the ranks
// that turn "bit i of row r" into a vertex number.
//
// Words used here: a *row* is a line of samples along axis 0; a *layer* is all rows with the same index
// on the last axis; a *slab* is what lies between two layers. A layer owns the edges and cubes that lie
// in it; a slab owns the edges and cubes along the last axis, and the tiles. Vertices are numbered
// layer 0, slab 0, layer 1, slab 1, ...; within a layer or slab row by row; within a row category by
// category; within a category by bits. So every number is base[row] + prefix[word] + popcount: rows are
// independent of each other, and no two passes can disagree.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "image/bitplanes.hpp"
#include "image/extract_source.hpp"
#include "tegl/contour.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::detail {

/// Rows that are counted, placed and written together: a *chunk* of a layer or slab. Places are sums over chunks, and
/// sums over rows within each.
inline constexpr std::size_t kChunkRows = 32;
constexpr std::size_t chunk_of(std::size_t row) noexcept { return row / kChunkRows; }

/// Sizes of an image in rows and words.
template <int N>
class RowShape {
 public:
  using Index = std::array<std::size_t, N>;

  explicit RowShape(const Index& size) : size_(size), words_((size[0] + kWordBits - 1) / kWordBits) {
    for (int a = 1; a < N - 1; ++a) {
      stride_[a] = rows_;
      rows_ *= size[a];
    }
    indices_.resize(rows_);
    for (std::size_t row = 0; row < rows_; ++row)
      for (int a = 1; a < N - 1; ++a) indices_[row][a] = row / stride_[a] % size[a];
  }
  [[nodiscard]] std::size_t size(int axis) const noexcept { return size_[axis]; }
  [[nodiscard]] std::size_t layers() const noexcept { return size_[N - 1]; }
  [[nodiscard]] std::size_t rows() const noexcept { return rows_; }
  [[nodiscard]] std::size_t chunks() const noexcept { return chunk_of(rows_ - 1) + 1; }
  /// The end of the rows of a chunk.
  [[nodiscard]] std::size_t chunk_end(std::size_t chunk) const noexcept {
    return std::min(rows_, (chunk + 1) * kChunkRows);
  }
  [[nodiscard]] std::size_t words() const noexcept { return words_; }
  /// Words from row to row of samples: one more, always 0, so that a row may be read shifted.
  [[nodiscard]] std::size_t pitch() const noexcept { return words_ + 1; }

  /// The row's index on the axes 1 ... N-2; 0 elsewhere.
  [[nodiscard]] const Index& index_of(std::size_t row) const noexcept { return indices_[row]; }
  /// Row of the sample that lies one step further along the axes in `mask` (axes 0 and N-1 don't count).
  [[nodiscard]] std::size_t shifted(std::size_t row, unsigned mask) const noexcept {
    for (int a = 1; a < N - 1; ++a) row += (mask >> a & 1u) * stride_[a];
    return row;
  }
  [[nodiscard]] std::size_t unshifted(std::size_t row, unsigned mask) const noexcept {
    for (int a = 1; a < N - 1; ++a) row -= (mask >> a & 1u) * stride_[a];
    return row;
  }
  /// Whether cells along the axes in `mask` start in a row with this index (axes 0 and N-1 don't count).
  [[nodiscard]] bool has_cells(const Index& index, unsigned mask) const noexcept {
    for (int a = 1; a < N - 1; ++a)
      if ((mask >> a & 1u) != 0 && index[a] + 1 >= size_[a]) return false;
    return true;
  }
  /// Bits of word w that are samples (along_row = false), or edges along the row.
  [[nodiscard]] Word mask(std::size_t w, bool along_row) const noexcept {
    const std::size_t count = size_[0] - (along_row ? 1 : 0);
    if (count >= (w + 1) * kWordBits) return ~Word{0};
    return count <= w * kWordBits ? 0 : (Word{1} << (count - w * kWordBits)) - 1;
  }

 private:
  Index size_;
  std::array<std::size_t, N> stride_{};
  std::size_t rows_ = 1;
  std::size_t words_;
  std::vector<Index> indices_;  ///< by row: divisions are slow
};

/// Cells of one kind that own up to `Slots` vertices each: bit i of plane j in a row says that cell i
/// has more than j vertices.
template <unsigned Slots>
struct RankPlane {
  std::array<std::vector<Word>, Slots> bits;
  std::vector<std::uint32_t> prefix;  ///< vertices of the row before this word
  std::vector<Index> offset;          ///< first vertex of the row, from the chunk's first on
  std::vector<std::uint32_t> count;   ///< vertices of the row; where there are none, its bits mean nothing
  std::vector<Index> chunk_first;     ///< first vertex of each chunk

  void allocate(std::size_t rows, std::size_t words) {
    for (auto& plane : bits) plane.assign(rows * words, 0);
    prefix.assign(rows * words, 0);
    offset.assign(rows, 0);
    count.assign(rows, 0);
    chunk_first.assign(chunk_of(rows - 1) + 1, 0);
  }
  /// Bytes for each row.
  static constexpr std::size_t row_bytes(std::size_t words) noexcept {
    return words * (Slots * sizeof(Word) + sizeof(std::uint32_t)) + sizeof(Index) + sizeof(std::uint32_t);
  }
  /// The first vertex of a row.
  [[nodiscard]] Index first(std::size_t row) const noexcept { return chunk_first[chunk_of(row)] + offset[row]; }
  /// The first vertex of cell i of a row (of the next cell that has one, if it has none).
  [[nodiscard]] Index id(std::size_t row, std::size_t words, std::size_t i) const noexcept {
    const std::size_t w = row * words + i / kWordBits;
    const Word below = (Word{1} << (i % kWordBits)) - 1;
    Index id = first(row) + prefix[w];
    for (const auto& plane : bits) id += static_cast<Index>(std::popcount(plane[w] & below));
    return id;
  }
};
using EdgePlane = RankPlane<1>;

/// A cube with vertices of its own.
struct ListedCube {
  std::uint32_t at;      ///< along the row
  std::uint32_t before;  ///< vertices of the row before it
  std::uint16_t key;     ///< of its filling (tile_variants.hpp)
};

/// Cubes of one kind that own vertices, where data decide: they are few, and found along with their tiles. Lists of
/// rows, in order; a chunk's rows have theirs one behind the other.
class CubeLists {
 public:
  void allocate(std::size_t rows) {
    chunks_.resize(chunk_of(rows - 1) + 1);
    first_.assign(rows, 0);
    size_.assign(rows, 0);
  }
  /// Rows of a chunk come in order.
  void begin_row(std::size_t row) noexcept {
    std::vector<ListedCube>& chunk = chunks_[chunk_of(row)];
    if (row % kChunkRows == 0) chunk.clear();
    first_[row] = static_cast<std::uint32_t>(chunk.size());
    size_[row] = 0;
  }
  void add(std::size_t row, const ListedCube& cube) {
    chunks_[chunk_of(row)].push_back(cube);
    ++size_[row];
  }
  [[nodiscard]] std::span<const ListedCube> row(std::size_t row) const noexcept {
    return {chunks_[chunk_of(row)].data() + first_[row], size_[row]};
  }

 private:
  std::vector<std::vector<ListedCube>> chunks_;
  std::vector<std::uint32_t> first_, size_;  ///< by row
};

struct CubePlane : RankPlane<tables::kFaceSlots> {
  CubeLists lists;  ///< in place of the bits, where data decide

  /// Without bits.
  void allocate_lists(std::size_t rows) {
    allocate(rows, 0);
    lists.allocate(rows);
  }
  static constexpr std::size_t list_bytes() noexcept { return row_bytes(0) + 2 * sizeof(std::uint32_t); }
  void begin_row(std::size_t row) noexcept {
    count[row] = 0;
    lists.begin_row(row);
  }
  void add(std::size_t row, std::size_t at, unsigned key, unsigned vertices) {
    lists.add(row, {static_cast<std::uint32_t>(at), count[row], static_cast<std::uint16_t>(key)});
    count[row] += vertices;
  }
  /// The first vertex of a cube that is listed.
  [[nodiscard]] Index listed_id(std::size_t row, std::size_t at) const noexcept {
    return first(row) + find(row, at)->before;
  }
  /// Whether a cube is listed with this key and so many vertices; with none: not listed.
  [[nodiscard]] bool has_listed(std::size_t row, std::size_t at, unsigned key, unsigned vertices) const noexcept {
    const auto of_row = count[row] == 0 ? std::span<const ListedCube>() : lists.row(row);
    const auto found = count[row] == 0 ? of_row.begin() : find(row, at);
    const bool is_listed = found != of_row.end() && found->at == at;
    return is_listed ? vertices != 0 && found->key == key : vertices == 0;
  }

 private:
  /// The first listed cube of a row that is not before `at`.
  [[nodiscard]] std::span<const ListedCube>::iterator find(std::size_t row, std::size_t at) const noexcept {
    const auto of_row = lists.row(row);
    return std::lower_bound(of_row.begin(), of_row.end(), at,
                            [](const ListedCube& cube, std::size_t place) { return cube.at < place; });
  }
};

/// What all samples of a row have in common.
enum class RowState : std::uint8_t { low, high, mixed };

/// What is counted of a layer.
template <int N>
struct LayerPlanes {
  std::array<EdgePlane, N - 1> edges;         ///< by axis
  CubePlane cubes;                            ///< N = 4: the cubes in the layer
  std::vector<std::uint64_t> chunk_vertices;  ///< by chunk: how many there are
};

/// What a chunk of a slab comes to.
struct SlabChunk {
  std::uint64_t vertices = 0;
  std::uint64_t simplices = 0;
  std::uint64_t active = 0;  ///< tiles
  std::uint64_t first_simplex = 0;
  std::uint32_t busy = 0;  ///< bit i: row i of the chunk has tiles or vertices, or the layer above has there
  static_assert(kChunkRows <= 32);
};

template <int N>
struct Layer : LayerPlanes<N> {
  std::vector<RowState> state;            ///< by row, of `high`; with missing samples: mixed
  std::vector<RowState> chunk_state;      ///< by chunk: that of all its rows, or mixed
  std::vector<Word> high;                 ///< rows x pitch; inverted for the high-connected alternative
  std::vector<Word> missing;              ///< rows x pitch, or none as long as no sample is missing
  std::vector<std::uint8_t> row_missing;  ///< by row: whether any sample is missing
  bool any_missing = false;
};

/// The bits set in a row of words, one after the other.
class BitWalk {
 public:
  explicit BitWalk(const Word* words) noexcept : words_(words), rest_(words[0]) {}
  /// Where bit number `ordinal` of those that are set is; numbers that do not fall, of bits that there are.
  std::size_t place_of(std::size_t ordinal) noexcept {
    while (passed_ < ordinal || rest_ == 0) {
      if (rest_ == 0) {
        rest_ = words_[++word_];
      } else {
        rest_ &= rest_ - 1;
        ++passed_;
      }
    }
    return word_ * kWordBits + static_cast<std::size_t>(std::countr_zero(rest_));
  }

 private:
  const Word* words_;
  std::size_t passed_ = 0;  ///< bits before `rest_`
  std::size_t word_ = 0;
  Word rest_;
};

/// Room for active tiles.
struct TileLists {
  Buffer<std::uint16_t> signatures;
  Buffer<std::uint16_t> at;

  void allocate(std::size_t tiles) {
    constexpr std::size_t kMargin = 64;  // is read and written in vain
    signatures.resize(tiles + kMargin);
    at.resize(tiles + kMargin);
  }
  static constexpr std::size_t bytes(std::size_t tiles) noexcept { return tiles * 2 * sizeof(std::uint16_t); }
};

/// What is counted of a slab.
template <int N>
struct SlabPlanes {
  std::vector<Word> active;                   ///< rows x words: valid tiles with high and low corners
  TileLists tiles;                            ///< kept or not (Counter): of chunks apart, of their rows in turn
  std::vector<std::size_t> first_tile;        ///< by row
  std::vector<std::uint32_t> active_count;    ///< by row
  EdgePlane edges;                            ///< along the last axis
  std::array<CubePlane, N - 1> cubes;         ///< N = 4: by the axis that they leave out
  std::vector<Index> own_offset;              ///< first vertex of each row's tiles, from the chunk's first on
  std::vector<std::uint64_t> simplex_offset;  ///< first simplex of each row, likewise
  std::vector<SlabChunk> chunks;

  [[nodiscard]] Index first_own(std::size_t row) const noexcept {
    return edges.chunk_first[chunk_of(row)] + own_offset[row];
  }
  [[nodiscard]] std::uint64_t first_simplex(std::size_t row) const noexcept {
    return chunks[chunk_of(row)].first_simplex + simplex_offset[row];
  }
  /// How many vertices the tiles of a row own, and how many simplices they have; what offsets know once they are made.
  [[nodiscard]] std::uint64_t own_vertices(std::size_t row) const noexcept {
    return (is_last_of_chunk(row) ? chunks[chunk_of(row)].vertices : edges.offset[row + 1]) - own_offset[row];
  }
  [[nodiscard]] std::uint64_t simplices(std::size_t row) const noexcept {
    return (is_last_of_chunk(row) ? chunks[chunk_of(row)].simplices : simplex_offset[row + 1]) - simplex_offset[row];
  }

 private:
  [[nodiscard]] bool is_last_of_chunk(std::size_t row) const noexcept {
    return row + 1 == own_offset.size() || chunk_of(row + 1) != chunk_of(row);
  }
};

template <int N>
struct Slab : SlabPlanes<N> {
  std::vector<Word> valid;  ///< rows x words: tiles without a missing corner; meaningful unless all_valid
  bool all_valid = true;
};

/// A slab with the two layers around it: where cells find the numbers of what they share.
template <int N>
struct SlabView {
  const RowShape<N>* shape;
  std::array<const Layer<N>*, 2> layers;
  const Slab<N>* slab;
  std::size_t k = 0;  ///< the slab's number

  [[nodiscard]] const EdgePlane& edges(int axis, unsigned up) const noexcept {
    return axis == N - 1 ? slab->edges : layers[up]->edges[static_cast<std::size_t>(axis)];
  }
  [[nodiscard]] const CubePlane& cubes(int omitted, unsigned up) const noexcept {
    return omitted == N - 1 ? layers[up]->cubes : slab->cubes[static_cast<std::size_t>(omitted)];
  }
};

}  // namespace tegl::detail
