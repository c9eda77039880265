// SPDX-License-Identifier: BSD-3-Clause
//
// Passes 1 to 3 of the extraction: which cells are critical, how many vertices and simplices each row
// has, and where they go. Works on bits alone: independent of the value type and of coordinates.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "extract_cell.hpp"
#include "extract_layers.hpp"
#include "extract_rows.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::detail {

/// Tables that one extraction uses. All of one triangulation.
template <int N>
struct TableSet {
  const tables::TileTable* tile = nullptr;      ///< of N
  const RowTable* rows = nullptr;               ///< `tile` for the quick way, if it is at hand
  bool compact = false;                         ///< the compact triangulation
  const tables::TileTable* cube = nullptr;      ///< of 3; N = 4 only
  const tables::RegionTable* face = nullptr;    ///< of N - 1; for closed borders
  const tables::RegionTable* square = nullptr;  ///< of 2; N = 4, for closed borders
};

template <int N>
class Counter {
 public:
  /// `rows`: the table for the quick way, or null.
  Counter(const RowShape<N>& shape, const TableSet<N>& tables, const RowTable* rows);

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

  // By row; rows may be done in any order and side by side. A pass needs the passes before it on all rows of what it
  // looks at.

  /// 1. Classifies a row of layer `k`; `invert` for the high-connected alternative. `buffer`: pitch words.
  void classify(const SampleSource<N>& source, std::size_t k, bool invert, std::size_t row, Layer<N>& layer,
                Word* buffer) const;
  /// After all rows of a layer are classified. If samples are missing, and there is no storage for them so far, then
  /// rows with missing samples are to be classified once more when there is.
  static void find_missing(Layer<N>& layer);
  /// 2. Tiles without a missing corner, between two layers; slab.all_valid is known.
  void find_valid(const Layer<N>& lower, const Layer<N>& upper, std::size_t row, Slab<N>& slab) const;
  /// 3. Critical edges (and cubes) in a layer; `below` and `above` are its slabs, or null at the border. `buffer`:
  /// pitch words.
  void count_layer(Layer<N>& layer, const Slab<N>* below, const Slab<N>* above, std::size_t row, Word* buffer) const;
  /// 3. Critical edges (and cubes) along the last axis, active tiles and what they own.
  void count_slab(const SlabView<N>& view, Slab<N>& slab, std::size_t row, Word* buffer) const;

  /// Turn counts into places, starting with vertex `first` (and simplex `first_simplex`); return the end.
  std::uint64_t place_layer(Layer<N>& layer, std::uint64_t first) const;
  std::uint64_t place_slab(Slab<N>& slab, std::uint64_t first, std::uint64_t& first_simplex) const;

  /// Whether any cube has vertices of its own.
  [[nodiscard]] bool has_cubes() const noexcept { return has_cubes_; }

  /// In `out` (words): the cells along `axes` based in this row that belong to a valid tile of one of
  /// the slabs (null: none). Returns false, and writes nothing, if that is all of them.
  bool cells_of_valid_tiles(unsigned axes, std::size_t row, const Slab<N>* below, const Slab<N>* above,
                            Word* out) const;

 private:
  void count_edges(EdgePlane& plane, std::size_t row, const Word* a, const Word* b, bool along_row,
                   const Word* valid) const;
  template <unsigned Axes>
  void count_cubes(CubePlane& plane, const SlabView<N>& view, std::size_t row, const Word* valid) const;
  void count_tiles(const SlabView<N>& view, Slab<N>& slab, std::size_t row) const;

  const RowShape<N>& shape_;
  const tables::TileTable& tile_;
  const RowTable* rows_;
  std::array<std::uint8_t, 256> cube_vertices_{};  ///< by signature
  bool has_cubes_ = false;
};

}  // namespace tegl::detail
