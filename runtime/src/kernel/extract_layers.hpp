// SPDX-License-Identifier: BSD-3-Clause
//
// Working storage of the extraction: bit planes of the layers along the last axis. Their vertices are numbered by
// vertex_numbers.hpp.
//
// Terms: a *row* is a line of samples along axis 0. A *layer* is the set of rows with the same index on the last axis.
// A *slab* lies between two adjacent layers. A layer owns the edges and cubes inside it; a slab owns the tiles, and the
// edges and cubes along the last axis.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ambiguity/assembled_tiles.hpp"
#include "image/bitplanes.hpp"
#include "image/sample_source.hpp"
#include "kernel/vertex_numbers.hpp"
#include "tegl/contour.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::detail {

/// Size of an image in rows and in words.
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
  /// One past the last row of a chunk.
  [[nodiscard]] std::size_t chunk_end(std::size_t chunk) const noexcept {
    return std::min(rows_, (chunk + 1) * kChunkRows);
  }
  [[nodiscard]] std::size_t words() const noexcept { return words_; }
  /// Words between the starts of adjacent rows of samples. The additional word is always 0, so a row can be read
  /// shifted by one sample.
  [[nodiscard]] std::size_t pitch() const noexcept { return words_ + 1; }

  /// Index of the row on axes 1 ... N-2; 0 on the others.
  [[nodiscard]] const Index& index_of(std::size_t row) const noexcept { return indices_[row]; }
  /// Row of the sample one step further along the axes in `mask` (axes 0 and N-1 are ignored).
  [[nodiscard]] std::size_t shifted(std::size_t row, unsigned mask) const noexcept {
    for (int a = 1; a < N - 1; ++a) row += (mask >> a & 1u) * stride_[a];
    return row;
  }
  [[nodiscard]] std::size_t unshifted(std::size_t row, unsigned mask) const noexcept {
    for (int a = 1; a < N - 1; ++a) row -= (mask >> a & 1u) * stride_[a];
    return row;
  }
  /// The row at the start of an axis, 0 < axis < N - 1, that differs from `row` only along it.
  [[nodiscard]] std::size_t at_start(std::size_t row, int axis) const noexcept {
    return row - indices_[row][axis] * stride_[axis];
  }
  /// Whether cells along the axes in `mask` start in a row with this index (axes 0 and N-1 are ignored).
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
  std::vector<Index> indices_;  ///< by row; cached because divisions are slow
};

/// A cube that owns vertices.
struct ListedCube {
  std::uint32_t at;      ///< position along the row
  std::uint32_t before;  ///< vertices of the row before it
  std::uint16_t key;     ///< key of its filling (cube_key.hpp)
};

/// Cubes of one kind that own vertices, if ambiguities are resolved from the data. These cubes are few and are found
/// together with their tiles. Each row has an ordered list; the lists of a chunk's rows are contiguous.
class CubeLists {
 public:
  void allocate(std::size_t rows) {
    chunks_.resize(chunk_of(rows - 1) + 1);
    first_.assign(rows, 0);
    size_.assign(rows, 0);
  }
  /// Rows of a chunk must come in ascending order.
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
  CubeLists lists;  ///< replaces the bits if ambiguities are resolved from the data

  /// Allocates lists instead of bits.
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
  /// Number of vertices of the i-th listed cube of a row.
  [[nodiscard]] std::uint32_t listed_vertices(std::size_t row, std::size_t i) const noexcept {
    const auto of_row = lists.row(row);
    return (i + 1 < of_row.size() ? of_row[i + 1].before : count[row]) - of_row[i].before;
  }
  /// First vertex of a listed cube.
  [[nodiscard]] Index listed_id(std::size_t row, std::size_t at) const noexcept {
    return first(row) + find(row, at)->before;
  }
  /// Whether a cube is listed with this key and number of vertices. With 0 vertices: whether it is not listed.
  [[nodiscard]] bool has_listed(std::size_t row, std::size_t at, unsigned key, unsigned vertices) const noexcept {
    const auto of_row = count[row] == 0 ? std::span<const ListedCube>() : lists.row(row);
    const auto found = count[row] == 0 ? of_row.begin() : find(row, at);
    const bool is_listed = found != of_row.end() && found->at == at;
    return is_listed ? vertices != 0 && found->key == key : vertices == 0;
  }

 private:
  /// First listed cube of a row at position `at` or after.
  [[nodiscard]] std::span<const ListedCube>::iterator find(std::size_t row, std::size_t at) const noexcept {
    const auto of_row = lists.row(row);
    return std::lower_bound(of_row.begin(), of_row.end(), at,
                            [](const ListedCube& cube, std::size_t place) { return cube.at < place; });
  }
};

/// Common state of all samples of a row.
enum class RowState : std::uint8_t { low, high, mixed };

/// Counts of a layer.
template <int N>
struct LayerPlanes {
  std::array<EdgePlane, N - 1> edges;         ///< by axis
  CubePlane cubes;                            ///< N = 4: the cubes in the layer
  std::vector<std::uint64_t> chunk_vertices;  ///< vertices of each chunk
};

/// Counts of a chunk of a slab.
struct SlabChunk {
  std::uint64_t vertices = 0;
  std::uint64_t simplices = 0;
  std::uint64_t active = 0;  ///< number of active tiles
  std::uint64_t first_simplex = 0;
  std::uint32_t busy = 0;  ///< bit i: row i of the chunk has tiles or vertices, or the layer above has vertices there
  static_assert(kChunkRows <= 32);
};

template <int N>
struct Layer : LayerPlanes<N> {
  std::vector<RowState> state;            ///< by row, from `high`; mixed if any sample is missing
  std::vector<RowState> chunk_state;      ///< by chunk: common state of its rows, or mixed
  std::vector<Word> high;                 ///< rows x pitch; inverted for the high-connected alternative
  std::vector<Word> missing;              ///< rows x pitch; empty while no sample is missing
  std::vector<std::uint8_t> row_missing;  ///< by row: whether any sample is missing
  bool any_missing = false;
};

/// Iterates over the set bits of a row of words.
class BitWalk {
 public:
  explicit BitWalk(const Word* words) noexcept : words_(words), rest_(words[0]) {}
  /// Position of set bit number `ordinal`. Ordinals must not decrease between calls and must be less than the number of
  /// set bits.
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

/// Storage for active tiles.
struct TileLists {
  Buffer<std::uint16_t> signatures;
  Buffer<std::uint16_t> at;

  void allocate(std::size_t tiles) {
    constexpr std::size_t kMargin = 64;  // vector code reads and writes past the end
    signatures.resize(tiles + kMargin);
    at.resize(tiles + kMargin);
  }
  static constexpr std::size_t bytes(std::size_t tiles) noexcept { return tiles * 2 * sizeof(std::uint16_t); }
};

/// Counts of a slab.
template <int N>
struct SlabPlanes {
  std::vector<Word> active;  ///< rows x words: valid tiles with high and low corners
  TileLists tiles;           ///< may be omitted (Counter); chunks have separate ranges, their rows are contiguous
  /// N = 4, resolved from the data: by chunk the first tiles that are assembled (Counter::keep_assembled); may be
  /// empty.
  std::vector<AssembledTiles> assembled;
  std::vector<std::size_t> first_assembled;  ///< with `assembled`: by row
  std::vector<std::size_t> first_tile;       ///< by row
  std::vector<std::uint32_t> active_count;   ///< by row
  EdgePlane edges;                           ///< along the last axis
  std::array<CubePlane, N - 1> cubes;        ///< N = 4: by the axis that they leave out
  std::vector<Index> own_offset;             ///< by row: first vertex owned by its tiles, relative to the chunk's first
  std::vector<std::uint64_t> simplex_offset;  ///< by row: first simplex, relative to the chunk's first
  std::vector<SlabChunk> chunks;

  [[nodiscard]] Index first_own(std::size_t row) const noexcept {
    return edges.chunk_first[chunk_of(row)] + own_offset[row];
  }
  [[nodiscard]] std::uint64_t first_simplex(std::size_t row) const noexcept {
    return chunks[chunk_of(row)].first_simplex + simplex_offset[row];
  }
  /// End of a row's assembled tiles.
  [[nodiscard]] std::size_t end_assembled(std::size_t row) const noexcept {
    return is_last_of_chunk(row) ? assembled[chunk_of(row)].size() : first_assembled[row + 1];
  }
  /// Vertices owned by the tiles of a row, and its simplices. Derived from the offsets, so valid only once these are
  /// computed.
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
  std::vector<Word> valid;  ///< rows x words: tiles without a missing corner; undefined if all_valid
  bool all_valid = true;
};

/// A slab with its two adjacent layers: access to the vertex numbers that cells share.
template <int N>
struct SlabView {
  const RowShape<N>* shape;
  std::array<const Layer<N>*, 2> layers;
  const Slab<N>* slab;
  std::size_t k = 0;  ///< index of the slab

  [[nodiscard]] const EdgePlane& edges(int axis, unsigned up) const noexcept {
    return axis == N - 1 ? slab->edges : layers[up]->edges[static_cast<std::size_t>(axis)];
  }
  /// Writes the bits of a row's critical edges, in the upper layer or along the last axis. All tiles must be valid.
  void write_edges(int axis, std::size_t row, Word* out) const noexcept {
    const auto high = [&](unsigned up, unsigned mask) {
      return layers[up]->high.data() + shape->shifted(row, mask) * shape->pitch();
    };
    const Word* const here = high(1, 0);
    const Word* const there = axis == N - 1 ? high(0, 0) : high(1, 1u << axis);
    for (std::size_t w = 0; w < shape->words(); ++w) {
      const Word other = axis == 0 ? here[w] >> 1 | here[w + 1] << (kWordBits - 1) : there[w];
      out[w] = (here[w] ^ other) & shape->mask(w, axis == 0);
    }
  }
  [[nodiscard]] const CubePlane& cubes(int omitted, unsigned up) const noexcept {
    return omitted == N - 1 ? layers[up]->cubes : slab->cubes[static_cast<std::size_t>(omitted)];
  }
};

/// Numbers of the own vertices of the cubes of a row's tiles, if ambiguities are resolved from the data. The tiles come
/// in order along the row, so no list is searched.
class CubesOfTiles {
 public:
  CubesOfTiles(const SlabView<4>& view, std::size_t row) noexcept {
    for (unsigned cube = 0; cube < next_.size(); ++cube) {
      const unsigned axis = cube / 2, side = cube % 2;
      const CubePlane& plane = view.cubes(static_cast<int>(axis), axis == 3 ? side : 0);
      const std::size_t of_cube = view.shape->shifted(row, side << axis);
      if (plane.count[of_cube] == 0) continue;
      next_[cube] = plane.lists.row(of_cube).data();
      first_[cube] = plane.first(of_cube);
    }
  }
  /// First vertex of a cube of the tile at position `at`; the cube must own vertices.
  [[nodiscard]] Index first_vertex(unsigned cube, std::size_t at) noexcept {
    const ListedCube*& next = next_[cube];
    at += cube == 1 ? 1 : 0;
    while (next->at < at) ++next;
    return first_[cube] + next->before;
  }

 private:
  std::array<const ListedCube*, 8> next_{};
  std::array<Index, 8> first_{};
};

}  // namespace tegl::detail
