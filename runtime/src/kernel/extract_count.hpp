// SPDX-License-Identifier: BSD-3-Clause
//
// Passes 1 to 3 of the extraction: which cells are critical, how many vertices and simplices each row
// has, and where they go. Works on bits alone: independent of the value type and of coordinates.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "ambiguity/face_estimator.hpp"
#include "ambiguity/tesseract_decision.hpp"
#include "kernel/extract_cell.hpp"
#include "kernel/extract_layers.hpp"
#include "kernel/table_set.hpp"
#include "tegl/table_contract.hpp"
#include "tile/extract_rows.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

/// What a caller's estimator said of the tiles of a row that data decide on, in their order. Kept so that what is
/// written is what was compared with the counts, whatever it would answer next.
struct RowAnswers {
  std::vector<ResolvedTile> tesseracts;  ///< N = 4
  std::vector<std::uint16_t> keys;       ///< N < 4: of all active tiles
  std::size_t taken = 0;                 ///< how many of them are written
};

/// What a thread keeps while it counts and lists tiles.
struct CountScratch {
  std::vector<Word> words;                       ///< of a row
  TileLists tiles;                               ///< of a row, where slabs do not keep them
  std::unique_ptr<ResolvedTesseract> tesseract;  ///< N = 4, where data decide
  RowAnswers answers;                            ///< where a caller decides
};

class TileSelection;

template <int N>
class Counter {
 public:
  /// `rows`: the table for the quick way, or null. `ranks`: whether others ask for the ranks of vertices on edges.
  /// `estimator`: what decides on ambiguous tiles, or null: the table does.
  Counter(const RowShape<N>& shape, const TableSet<N>& tables, const RowTable* rows, bool ranks,
          const FaceEstimator<N>* estimator = nullptr);

  /// Whether slabs keep the lists of their active tiles, four bytes for each sample. Otherwise each list is made twice:
  /// for large slabs (4D) they are most of what is kept.
  void keep_tiles(bool keep) noexcept { keeps_tiles_ = keep; }

  /// Storage for a layer's bits; for what is counted of a layer or a slab; and for missing values, where they turn up.
  void allocate(Layer<N>& layer) const;
  void allocate(LayerPlanes<N>& planes) const;
  void allocate(SlabPlanes<N>& planes) const;
  void allocate_missing(Layer<N>& layer) const;
  void allocate_valid(Slab<N>& slab) const;
  /// Bytes of each of the first three.
  [[nodiscard]] std::size_t layer_bytes() const noexcept;
  [[nodiscard]] std::size_t layer_planes_bytes() const noexcept;
  [[nodiscard]] std::size_t slab_planes_bytes() const noexcept;
  [[nodiscard]] std::size_t cube_row_bytes() const noexcept;

  // By chunks of rows, which may be done in any order and side by side. A pass needs the passes before it on all rows
  // of what it looks at.

  /// 1. Classifies layer `k`; `invert` for the high-connected alternative. `buffer`: pitch words. `selection`: what is
  /// looked at; null: all.
  void classify(const SampleSource<N>& source, std::size_t k, bool invert, std::size_t chunk, Layer<N>& layer,
                Word* buffer, const TileSelection* selection) const;
  /// After all chunks of a layer are classified. If samples are missing, and there is no storage for them so far, then
  /// the layer is to be classified once more when there is.
  static void find_missing(Layer<N>& layer);
  /// 2. Tiles without a missing corner, between two layers; slab.all_valid is known.
  void find_valid(const Layer<N>& lower, const Layer<N>& upper, std::size_t chunk, Slab<N>& slab) const;
  /// 3. Critical edges (and cubes) in layer 0, below `above`. `buffer`: pitch words.
  void count_first_layer(Layer<N>& layer, const Slab<N>& above, std::size_t chunk, Word* buffer) const;
  /// 3. Critical edges (and cubes) along the last axis, active tiles and what they own; and what is critical in the
  /// upper layer, above which there is `above` (or null). `upper` and `slab` are those of `view`.
  void count_slab(const SlabView<N>& view, Layer<N>& upper, Slab<N>& slab, const Slab<N>* above, std::size_t chunk,
                  CountScratch& scratch) const;
  [[nodiscard]] CountScratch make_scratch() const;

  /// The active tiles of a row that is counted, where the quick way can be taken with them; else none. They stay as
  /// long as the scratch is left alone.
  [[nodiscard]] RowTiles tiles(const SlabView<N>& view, std::size_t row, CountScratch& scratch) const;

  /// Turn counts into places, starting with vertex `first` (and simplex `first_simplex`); return the end.
  std::uint64_t place_layer(Layer<N>& layer, std::uint64_t first) const;
  std::uint64_t place_slab(Slab<N>& slab, std::uint64_t first, std::uint64_t& first_simplex) const;

  /// Whether the edges of a row of the slab, and those of the layer above it there, are to be known from the row's
  /// active tiles: else from bits.
  [[nodiscard]] bool goes_by_tiles(const Slab<N>& slab, std::size_t row) const noexcept {
    return quick_ && slab.all_valid && shape_.has_cells(shape_.index_of(row), (1u << N) - 1);
  }

  /// Whether any cube has vertices of its own.
  [[nodiscard]] bool has_cubes() const noexcept { return has_cubes_; }
  /// Whether data decide on cubes, N = 4: those with vertices of their own are listed, in place of bits.
  [[nodiscard]] bool lists_cubes() const noexcept { return lists_cubes_; }

  /// In `out` (words): the cells along `axes` based in this row that belong to a valid tile of one of
  /// the slabs (null: none). Returns false, and writes nothing, if that is all of them.
  bool cells_of_valid_tiles(unsigned axes, std::size_t row, const Slab<N>* below, const Slab<N>* above,
                            Word* out) const;

 private:
  void classify_rows(const SampleSource<N>& source, std::size_t k, bool invert, std::size_t first, std::size_t end,
                     Layer<N>& layer, Word* buffer) const;
  /// The selected rows of a chunk; of the others, which are uniform, what they have in common.
  void classify_selected(const SampleSource<N>& source, std::size_t k, bool invert, std::size_t chunk, Layer<N>& layer,
                         Word* buffer, const TileSelection& selection) const;
  /// Rows first ... end - 1 without an active tile, by one sample of each that may differ from the one before.
  void guess_rows(const SampleSource<N>& source, std::size_t k, bool invert, std::size_t first, std::size_t end,
                  Layer<N>& layer) const;
  /// Brings a classified row's bits into their last form, and says what they have in common.
  RowState finish_row(Word* high, bool invert, bool any_missing) const;
  void find_valid_row(const Layer<N>& lower, const Layer<N>& upper, std::size_t row, Slab<N>& slab) const;
  void count_layer_row(Layer<N>& layer, std::size_t k, const Slab<N>* below, const Slab<N>* above, std::size_t row,
                       Word* buffer) const;
  void count_slab_row(const SlabView<N>& view, Slab<N>& slab, std::size_t row, CountScratch& scratch) const;
  /// All of the slab's row and of the upper layer's at once, if the row goes by tiles.
  void count_quickly(const SlabView<N>& view, Layer<N>& upper, Slab<N>& slab, std::size_t row,
                     CountScratch& scratch) const;
  /// Whether all samples that a chunk's tiles and edges touch are alike.
  [[nodiscard]] bool is_uniform_chunk(const SlabView<N>& view, std::size_t chunk) const;
  void clear_chunk(Layer<N>& upper, Slab<N>& slab, std::size_t chunk) const;
  /// Offsets of a row's vertices in its chunk, from `first` (or the sums so far) on; returns how many there are.
  std::uint64_t offset_layer_row(Layer<N>& layer, std::size_t row, std::uint64_t first) const;
  std::uint64_t offset_slab_row(Slab<N>& slab, std::size_t row, SlabChunk& sums) const;
  void count_edges(EdgePlane& plane, std::size_t row, const Word* a, const Word* b, bool along_row,
                   const Word* valid) const;
  template <unsigned Axes>
  void count_cubes(CubePlane& plane, const SlabView<N>& view, std::size_t row, const Word* valid) const;
  void count_tiles(const SlabView<N>& view, Slab<N>& slab, std::size_t row, CountScratch& scratch) const;
  /// Finds the active tiles of a row, ambiguous ones by their keys (N < 4).
  [[nodiscard]] TileCount find_tiles(const SlabView<N>& view, std::size_t row, const TileRoom& room) const;
  void resolve_tiles(const SlabView<N>& view, std::size_t row, const TileRoom& room, TileCount& count) const;
  /// Of the tiles that are found, N = 4, what data decide on. `found`: takes the cubes, or null.
  struct FoundCubes {
    CubePlane& in_layer;
    std::array<CubePlane, N - 1>& in_slab;
  };
  void resolve_tesseracts(const SlabView<N>& view, std::size_t row, const TileRoom& room, TileCount& count,
                          ResolvedTesseract& tesseract, const FoundCubes* found) const;
  template <unsigned Axes>
  void list_cubes(CubePlane& plane, const SlabView<N>& view, std::size_t row, const Word* valid) const;
  [[nodiscard]] bool keeps_tiles() const noexcept { return keeps_tiles_ && quick_; }
  [[nodiscard]] TileRoom tile_room(Slab<N>& slab, std::size_t row, CountScratch& scratch) const;

  const RowShape<N>& shape_;
  const tables::TileTable& tile_;
  const RowTable* rows_;
  const FaceEstimator<N>* estimator_;
  bool ranks_;
  bool quick_ = false;
  bool keeps_tiles_ = true;
  std::array<std::uint8_t, 256> cube_vertices_{};  ///< by signature
  bool has_cubes_ = false;
  bool lists_cubes_ = false;
};

}  // namespace tegl::detail
