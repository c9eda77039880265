// SPDX-License-Identifier: BSD-3-Clause
//
// Passes 1 to 3 of the extraction: find critical cells, count vertices and simplices by row, and number them. Works on
// bits only, independent of value type and coordinates.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "ambiguity/face_estimator.hpp"
#include "ambiguity/tesseract_decision.hpp"
#include "kernel/contour_output.hpp"
#include "kernel/extract_cell.hpp"
#include "kernel/extract_layers.hpp"
#include "kernel/extract_rows.hpp"
#include "kernel/table_set.hpp"
#include "tegl/table_contract.hpp"
#include "tile/signature_set.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

/// Answers of a caller's estimator for the tiles of a row that it resolves, in row order. They are stored so that
/// generation uses the answers that were compared with the counts, even if the estimator changes them later.
struct RowAnswers {
  std::vector<ResolvedTile> tesseracts;  ///< N = 4
  std::vector<std::uint16_t> keys;       ///< N < 4: keys of all active tiles
  std::size_t taken = 0;                 ///< number of answers already written
};

/// Working storage of one thread for counting and listing tiles.
struct CountScratch {
  std::vector<Word> words;                       ///< one row
  TileLists tiles;                               ///< one row, if slabs do not keep lists
  std::unique_ptr<ResolvedTesseract> tesseract;  ///< N = 4, if ambiguities are resolved from the data
  std::unique_ptr<TesseractsOfWord> of_word;     ///< with `tesseract`
  std::size_t assembled_words = 0;               ///< of the last chunk's kept tiles, and a few more
  RowAnswers answers;                            ///< if a caller's estimator resolves ambiguities
};

class TileSelection;

template <int N>
class Counter {
 public:
  /// `rows`: flat table for the fast path, or null. `ranks`: what other code reads vertex numbers on edges.
  /// `estimator`: resolves ambiguous tiles; null: the table does.
  Counter(const RowShape<N>& shape, const TableSet<N>& tables, const RowTable* rows, RankReaders ranks,
          const FaceEstimator<N>* estimator = nullptr);

  /// Whether slabs keep the lists of their active tiles (4 bytes per sample). Otherwise each list is computed twice. In
  /// 4D, where slabs are large, the lists would be most of the working storage.
  void keep_tiles(bool keep) noexcept { keeps_tiles_ = keep; }
  /// Up to `bytes` of 4D tiles resolved from the data are kept by each chunk of a slab, as they were assembled for
  /// counting. The others are assembled twice.
  void keep_assembled(std::size_t bytes) noexcept { most_assembled_ = bytes / sizeof(std::uint64_t); }

  /// Allocate a layer's bits, the counts of a layer or slab, and the bits of missing values (only if any is missing).
  void allocate(Layer<N>& layer) const;
  void allocate(LayerPlanes<N>& planes) const;
  void allocate(SlabPlanes<N>& planes) const;
  void allocate_missing(Layer<N>& layer) const;
  void allocate_valid(Slab<N>& slab) const;
  /// Bytes that the first three `allocate` functions take.
  [[nodiscard]] std::size_t layer_bytes() const noexcept;
  [[nodiscard]] std::size_t layer_planes_bytes() const noexcept;
  [[nodiscard]] std::size_t slab_planes_bytes() const noexcept;
  [[nodiscard]] std::size_t cube_row_bytes() const noexcept;

  // The passes work on chunks of rows. Chunks may be processed in any order and in parallel. Each pass requires the
  // previous passes on all rows that it reads.

  /// Pass 1: classifies the samples of layer `k`. `invert`: for the high-connected alternative. `buffer`: pitch words.
  /// `selection`: rows or tiles to process; null: all.
  void classify(const SampleClassifier<N>& source, std::size_t k, bool invert, std::size_t chunk, Layer<N>& layer,
                Word* buffer, const TileSelection* selection) const;
  /// Call after all chunks of a layer are classified. If samples are missing and the layer has no storage for them, it
  /// must be classified again after allocate_missing.
  static void find_missing(Layer<N>& layer);
  /// Pass 2: finds tiles without a missing corner between two layers. Requires slab.all_valid.
  void find_valid(const Layer<N>& lower, const Layer<N>& upper, std::size_t chunk, Slab<N>& slab) const;
  /// Pass 3 for layer 0: finds critical edges (and cubes) of the layer, which lies below slab `above`. `buffer`: pitch
  /// words.
  void count_first_layer(Layer<N>& layer, const Slab<N>& above, std::size_t chunk, Word* buffer) const;
  /// Pass 3: finds critical edges (and cubes) along the last axis, active tiles and their own vertices, and critical
  /// cells of the upper layer, which lies below slab `above` (or null). `upper` and `slab` belong to `view`.
  void count_slab(const SlabView<N>& view, Layer<N>& upper, Slab<N>& slab, const Slab<N>* above, std::size_t chunk,
                  CountScratch& scratch) const;
  [[nodiscard]] CountScratch make_scratch() const;

  /// Active tiles of a counted row if the fast path can be used, otherwise none. Valid until the scratch is used again.
  [[nodiscard]] RowTiles tiles(const SlabView<N>& view, std::size_t row, CountScratch& scratch) const;

  /// Number vertices from `first` on (and simplices from `first_simplex` on). Return one past the last vertex.
  std::uint64_t place_layer(Layer<N>& layer, std::uint64_t first) const;
  std::uint64_t place_slab(Slab<N>& slab, std::uint64_t first, std::uint64_t& first_simplex) const;

  /// Whether the critical edges of this row of the slab and of the layer above are derived from the row's active tiles
  /// instead of from bits.
  [[nodiscard]] bool goes_by_tiles(const Slab<N>& slab, std::size_t row) const noexcept {
    return quick_ && slab.all_valid && shape_.has_cells(shape_.index_of(row), (1u << N) - 1);
  }

  /// Whether the edges of a slab and of the layer above it, which lies below slab `above` (null: it is the last), have
  /// bits, by which vertices are found. Tiles adjacent to missing values use them.
  [[nodiscard]] bool has_ranks(const Slab<N>& slab, const Slab<N>* above) const noexcept {
    if (!quick_ || ranks_ == RankReaders::any || !slab.all_valid) return true;
    return above != nullptr ? !above->all_valid : ranks_ == RankReaders::last_layer;
  }
  /// Whether any cube owns vertices.
  [[nodiscard]] bool has_cubes() const noexcept { return has_cubes_; }
  /// Whether cubes are resolved from the data (N = 4). Cubes that own vertices are then listed instead of marked by
  /// bits.
  [[nodiscard]] bool lists_cubes() const noexcept { return lists_cubes_; }

  /// Writes to `out` the cells along `axes` based in this row that belong to a valid tile of one of the slabs (null: no
  /// slab). If all cells do, returns false and writes nothing.
  bool cells_of_valid_tiles(unsigned axes, std::size_t row, const Slab<N>* below, const Slab<N>* above,
                            Word* out) const;

 private:
  void classify_rows(const SampleClassifier<N>& source, std::size_t k, bool invert, std::size_t first, std::size_t end,
                     Layer<N>& layer, Word* buffer) const;
  /// Classifies the selected rows of a chunk. The other rows are uniform; only their common state is determined.
  void classify_selected(const SampleClassifier<N>& source, std::size_t k, bool invert, std::size_t chunk,
                         Layer<N>& layer, Word* buffer, const TileSelection& selection) const;
  /// Determines the state of rows first ... end - 1, which no active tile touches. Reads one sample of each row that
  /// may differ from the row before.
  void guess_rows(const SampleClassifier<N>& source, std::size_t k, bool invert, std::size_t first, std::size_t end,
                  Layer<N>& layer) const;
  /// Converts a classified row to its final form (inverted, padded). Returns its common state.
  RowState finish_row(Word* high, bool invert, bool any_missing) const;
  void find_valid_row(const Layer<N>& lower, const Layer<N>& upper, std::size_t row, Slab<N>& slab) const;
  void count_layer_row(Layer<N>& layer, std::size_t k, const Slab<N>* below, const Slab<N>* above, std::size_t row,
                       Word* buffer) const;
  void count_slab_row(const SlabView<N>& view, Slab<N>& slab, std::size_t row, CountScratch& scratch) const;
  /// Counts a row of the slab and of the upper layer together. Requires goes_by_tiles(row).
  void count_quickly(const SlabView<N>& view, Layer<N>& upper, Slab<N>& slab, std::size_t row,
                     CountScratch& scratch) const;
  /// Whether all samples touched by a chunk's tiles and edges have the same state.
  [[nodiscard]] bool is_uniform_chunk(const SlabView<N>& view, std::size_t chunk) const;
  void clear_chunk(Layer<N>& upper, Slab<N>& slab, std::size_t chunk) const;
  /// Turns a row's vertex counts into offsets within its chunk, from `first` (or from `sums`) on. Returns the row's
  /// number of vertices.
  std::uint64_t offset_layer_row(Layer<N>& layer, std::size_t row, std::uint64_t first) const;
  std::uint64_t offset_slab_row(Slab<N>& slab, std::size_t row, SlabChunk& sums) const;
  void count_edges(EdgePlane& plane, std::size_t row, const Word* a, const Word* b, bool along_row,
                   const Word* valid) const;
  template <unsigned Axes>
  void count_cubes(CubePlane& plane, const SlabView<N>& view, std::size_t row, const Word* valid) const;
  void count_tiles(const SlabView<N>& view, Slab<N>& slab, std::size_t row, CountScratch& scratch) const;
  /// Finds the active tiles of a row. Ambiguous tiles are replaced by their keys (N < 4).
  [[nodiscard]] TileCount find_tiles(const SlabView<N>& view, std::size_t row, const TileRoom& room) const;
  void resolve_tiles(const SlabView<N>& view, std::size_t row, const TileRoom& room, TileCount& count) const;
  /// Returns the size of a tile. If there is room, assembles and keeps it. `assembled`: of the chunk, or null.
  ResolvedSize assemble(const ResolvedTile& tile, ResolvedTesseract& tesseract, AssembledTiles* assembled) const;
  /// Destination of cubes that resolve_tesseracts finds.
  struct FoundCubes {
    CubePlane& in_layer;
    std::array<CubePlane, N - 1>& in_slab;
  };
  void resolve_tesseracts(const SlabView<N>& view, std::size_t row, const TileRoom& room, TileCount& count,
                          CountScratch& scratch, AssembledTiles* assembled, const FoundCubes* found) const;
  [[nodiscard]] static AssembledTiles* assembled(Slab<N>& slab, std::size_t row) noexcept {
    return slab.assembled.empty() ? nullptr : &slab.assembled[chunk_of(row)];
  }
  /// Whether assembled tiles are kept. Not those of a caller's estimator, whose answers are compared with the counts.
  [[nodiscard]] bool keeps_assembled() const noexcept {
    return lists_cubes_ && most_assembled_ != 0 && !estimator_->is_callers();
  }
  template <unsigned Axes>
  void list_cubes(CubePlane& plane, const SlabView<N>& view, std::size_t row, const Word* valid) const;
  [[nodiscard]] bool keeps_tiles() const noexcept { return keeps_tiles_ && quick_; }
  [[nodiscard]] TileRoom tile_room(Slab<N>& slab, std::size_t row, CountScratch& scratch) const;

  const RowShape<N>& shape_;
  const tables::TileTable& tile_;
  const RowTable* rows_;
  const FaceEstimator<N>* estimator_;
  RankReaders ranks_;
  bool quick_ = false;
  bool keeps_tiles_ = true;
  std::size_t most_assembled_ = 0;                 ///< 64-bit words per chunk
  std::array<std::uint8_t, 256> cube_vertices_{};  ///< by signature
  bool has_cubes_ = false;
  bool lists_cubes_ = false;
  bool owns_vertices_ = true;  ///< N < 4: whether the tile of any signature does
  SignatureSet ambiguous_;     ///< N < 4, with an estimator
};

}  // namespace tegl::detail
