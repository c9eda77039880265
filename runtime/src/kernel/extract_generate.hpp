// SPDX-License-Identifier: BSD-3-Clause
//
// Pass 4 of the extraction: writes the vertices and simplices of one row to the row's own range of the output.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <type_traits>

#include "ambiguity/tesseract_decision.hpp"
#include "hwy/cache_control.h"
#include "kernel/extract_cell.hpp"
#include "kernel/extract_count.hpp"
#include "kernel/extract_edges.hpp"
#include "kernel/extract_rows.hpp"
#include "kernel/generate_cubes.hpp"
#include "kernel/placement.hpp"
#include "kernel/shared_places.hpp"
#include "tile/extract_tables.hpp"
#include "tile/local_simplices.hpp"

namespace tegl::detail {

/// Writes the vertices that a row's tiles own, and their simplices.
template <int N, class Real>
class TileWriter {
 public:
  using Vertex = std::array<Real, N>;
  using Simplex = std::array<Index, N>;
  using OwnCells = CellVertices<N, Real>;
  static constexpr unsigned kAll = (1u << N) - 1;

  /// `flip`: reverses the tables' orientation. `rows`: flat table for the fast path, or null. `estimator`: as in
  /// Counter.
  TileWriter(const EdgeCrossings<N>& source, const TableSet<N>& tables, const RowTable* rows,
             const FaceEstimator<N>* estimator, const Placement<N, Real>& placement, bool flip, bool has_cubes)
      : source_(source),
        estimator_(estimator),
        table_(*tables.tile),
        cube_(tables.cube),
        compact_(tables.compact),
        rows_(has_cubes ? nullptr : rows),
        placement_(placement),
        flip_(flip),
        has_cubes_(has_cubes) {}

  /// `tiles`: the row's active tiles (Counter::tiles). `simplices`: destination of simplex `first_simplex`. `scratch`:
  /// of the calling thread. `cells`: takes own vertices of cells that are resolved from the data; null: none is. If
  /// a caller's estimator changed its answers after the row was counted, reports this and writes nothing.
  void write(const SlabView<N>& view, std::size_t row, std::size_t layer, const RowTiles& tiles,
             VertexRun<Vertex> vertices, Simplex* simplices, std::uint64_t first_simplex, CountScratch& scratch,
             OwnCells* cells) const noexcept {
    const RowShape<N>& shape = *view.shape;
    auto index = shape.index_of(row);
    if (view.slab->active_count[row] == 0) return;
    index[N - 1] = layer;
    if (estimator_ != nullptr && estimator_->is_callers() && !ask_again(view, row, index, tiles, scratch))
      return estimator_->report_change(index);
    Simplex* const out = simplices + (view.slab->first_simplex(row) - first_simplex);
    if (rows_ != nullptr && view.slab->all_valid)
      write_quickly(view, row, index, tiles, vertices, out, scratch, cells);
    else
      write_one_by_one(view, row, index, vertices, out, scratch, cells);
  }

  /// Whether barycentres of cubes in a slab and in the layer above it (and layer 0) are written together with its
  /// tiles, which compute their positions anyway. Each cube is written by the tile below it; requires that all tiles
  /// are valid.
  [[nodiscard]] bool writes_cubes(const Slab<N>& slab) const noexcept { return has_cubes_ && slab.all_valid; }

 private:
  using Ids = LocalIds;

  /// The tiles of one row that have own vertices; write_tile_row calls `write` for each, in ascending order, so their
  /// positions are found by iterating over the active bits.
  struct TilesWithOwnVertices {
    const TileWriter& writer;
    const SlabView<N>& view;
    std::size_t row;
    CountScratch& scratch;
    OwnCells* cells;
    typename RowShape<N>::Index index;  ///< of the current tile
    VertexRun<Vertex> vertices;
    BitWalk active;
    const std::uint16_t* listed;                  ///< positions of the tiles; null: `active` has them
    Index next;                                   ///< number of the next own vertex
    RowOfTesseracts* tesseracts = nullptr;        ///< N = 4, if resolved from the data without a caller's estimator
    const AssembledTiles* assembled = nullptr;    ///< with `tesseracts`: the row's first tiles may be kept here
    std::size_t at = 0, end = 0;                  ///< offset of the next one, and the end
    CubesOfTiles* cubes = nullptr;                ///< N = 4, if resolved from the data
    const ResolvedCubes* cubes_of_key = nullptr;  ///< N = 3, if resolved from the data

    static Index first_own(void* self, unsigned key, std::size_t ordinal) noexcept requires(N == 3) {
      auto& own = *static_cast<TilesWithOwnVertices*>(self);
      own.index[0] = own.listed != nullptr ? own.listed[ordinal] : own.active.place_of(ordinal);
      const Index first = own.next;
      if (own.cubes_of_key != nullptr && !CubeKey(key).is_plain()) {
        // by the number of its list: the lists by key are larger than the nearest caches
        const unsigned number = list_of_key(CubeKey(key));
        if (own.cubes_of_key->summary(number).barycentres == 0) {
          own.next += own.cubes_of_key->own_vertices(number);
          own.cells->add(*own.cubes_of_key, number, own.index, kAll, first);
          return first;
        }
      }
      const SimplexList<N> list(own.writer.table_, key);
      own.next += list.own_vertices();
      SharedPlaces<N> places(own.writer.source_, own.index, signature_of<N>(key), nullptr);
      own.writer.write_own(list, places, own.index, first, own.vertices);
      return first;
    }
    static Simplex* write(void* self, unsigned key, std::size_t ordinal, const Index* edge_ids, Simplex* out) noexcept {
      auto& own = *static_cast<TilesWithOwnVertices*>(self);
      own.index[0] = own.listed != nullptr ? own.listed[ordinal] : own.active.place_of(ordinal);
      if constexpr (N == 4)
        if (own.writer.is_estimated_tile(key)) {
          ResolvedTile tile;
          if (own.at < own.end) {
            const ResolvedView filling = own.assembled->read(own.at, tile);
            return own.writer.write_resolved(*own.cubes, own.index, key, tile, filling, edge_ids, own.next, *own.cells,
                                             out);
          }
          tile = own.writer.tile_of(own, static_cast<std::uint32_t>(ordinal), key);
          return own.writer.write_resolved(*own.cubes, own.index, key, tile,
                                           own.scratch.tesseract->find(tile.key, tile.lists, tile.apart), edge_ids,
                                           own.next, *own.cells, out);
        }
      Ids ids;
      std::copy_n(edge_ids, tables::edge_count(N), ids.data());
      const SimplexList<N> list(own.writer.table_, key);
      SharedPlaces<N> places(own.writer.source_, own.index, signature_of<N>(key), own.writer.cube_);
      own.writer.write_own(list, places, own.index, own.next, own.vertices);
      out = write_simplices<N>(list, own.writer.flip_, ids, own.next, out);
      own.next += list.own_vertices();
      return out;
    }
  };

  /// Writes a row whose tiles are all valid. Then every critical edge belongs to an active tile.
  void write_quickly(const SlabView<N>& view, std::size_t row, const typename RowShape<N>::Index& start,
                     const RowTiles& tiles, VertexRun<Vertex> vertices, Simplex* out, CountScratch& scratch,
                     OwnCells* cells) const noexcept {
    TileOutput<N> output{tiles.signatures, tiles.count, {}, flip_, out};
    CellEdges<N, kAll>::firsts(view, row, output.first.data());
    TilesWithOwnVertices own{*this,
                             view,
                             row,
                             scratch,
                             cells,
                             start,
                             vertices,
                             BitWalk(view.slab->active.data() + row * view.shape->words()),
                             view.shape->size(0) <= kMostListed ? tiles.at : nullptr,
                             view.slab->first_own(row)};
    // 4D tiles resolved from the data
    if constexpr (N == 4)
      if (estimator_ != nullptr) return write_tesseracts(output, start, tiles, own);
    if constexpr (N == 3) {
      if (cells != nullptr) own.cubes_of_key = &ResolvedCubes::instance(estimator_->triangulation());
      write_tile_row<N>(output, *rows_, {&TilesWithOwnVertices::first_own, &own});
    } else {
      write_tile_row<N>(output, *rows_, {&TilesWithOwnVertices::write, &own});
    }
  }

  /// write_tile_row for tiles resolved from the data. Not inlined, because its stack frame is large.
  [[gnu::noinline]] void write_tesseracts(const TileOutput<N>& output, const typename RowShape<N>::Index& start,
                                          const RowTiles& tiles, TilesWithOwnVertices& own) const noexcept {
    CubesOfTiles cubes(own.view, own.row);
    own.cubes = &cubes;
    RowOfTesseracts tesseracts(*estimator_, start, own.view.shape->size(0), tiles, *own.scratch.of_word);
    if (!estimator_->is_callers()) own.tesseracts = &tesseracts;
    const Slab<N>& slab = *own.view.slab;
    if (!slab.assembled.empty()) {
      own.assembled = &slab.assembled[chunk_of(own.row)];
      own.at = slab.first_assembled[own.row];
      own.end = slab.end_assembled(own.row);
    }
    write_tile_row<N>(output, *rows_, {&TilesWithOwnVertices::write, &own});
  }

  /// Writes a row tile by tile from bits.
  void write_one_by_one(const SlabView<N>& view, std::size_t row, typename RowShape<N>::Index index,
                        VertexRun<Vertex> vertices, Simplex* out, CountScratch& scratch,
                        [[maybe_unused]] OwnCells* own_cells) const noexcept {
    const RowShape<N>& shape = *view.shape;
    const Word* const active = view.slab->active.data() + row * shape.words();
    CellBits<N, kAll> cells(view, row);
    CellEdges<N, kAll> edges(view, row);
    [[maybe_unused]] std::optional<TileCubes> cubes;
    [[maybe_unused]] std::optional<CubesOfTiles> resolved_cubes;
    if constexpr (N == 4) {
      if (has_cubes_) cubes.emplace(view, row);
      if (estimator_ != nullptr) resolved_cubes.emplace(view, row);
    }
    Ids ids;
    Index own = view.slab->first_own(row);
    // active tiles, 64 positions at a time
    for (std::size_t w = 0; w < shape.words(); ++w) {
      Word rest = active[w];
      if (rest == 0) continue;
      cells.load(w);
      edges.load(w);
      if (cubes) cubes->load(w);
      for (; rest != 0; rest &= rest - 1) {
        const auto bit = static_cast<unsigned>(std::countr_zero(rest));
        const unsigned signature = cells.signature(bit);
        index[0] = w * kWordBits + bit;
        edges.ids(bit, ids.data());
        if constexpr (N == 4)
          if (is_estimated_tile(signature)) {
            const ResolvedTile tile = tile_of(scratch.answers, index, signature);
            out = write_resolved(*resolved_cubes, index, signature, tile,
                                 scratch.tesseract->find(tile.key, tile.lists, tile.apart), ids.data(), own, *own_cells,
                                 out);
            continue;
          }
        const SimplexList<N> list(table_, key_of(index, signature, scratch.answers));
        // shared and own vertices
        if constexpr (N == 4)
          if (cubes) cubes->ids(bit, ids);
        if (has_cubes_ || list.own_vertices() != 0) {
          SharedPlaces<N> places(source_, index, signature, cube_);
          write_own(list, places, index, own, vertices);
          if constexpr (N == 4)
            if (writes_cubes(*view.slab)) write_cubes(places, ids, index, vertices);
        }
        // simplices
        out = write_simplices<N>(list, flip_, ids, own, out);
        own += list.own_vertices();
      }
    }
  }

  /// Key of a tile: for an ambiguous one from the estimator if there is one, otherwise the signature.
  [[nodiscard]] unsigned key_of(const typename RowShape<N>::Index& index, unsigned signature) const noexcept {
    if constexpr (N < 4)
      if (estimator_ != nullptr && ambiguous_signatures<N>()[signature])
        return resolved_key<N>(*estimator_, index, signature);
    return signature;
  }
  /// Key of a tile during writing; a caller's estimator answered before (ask_again).
  [[nodiscard]] unsigned key_of(const typename RowShape<N>::Index& index, unsigned signature,
                                RowAnswers& answers) const noexcept {
    if constexpr (N < 4)
      if (estimator_ != nullptr && estimator_->is_callers()) return answers.keys[answers.taken++];
    return key_of(index, signature);
  }

  /// Queries a caller's estimator for all tiles of a row and keeps the answers. Returns whether they match the counts:
  /// equal numbers of vertices and simplices, and equal fillings of the cubes that own vertices.
  [[nodiscard]] bool ask_again(const SlabView<N>& view, std::size_t row, typename RowShape<N>::Index index,
                               const RowTiles& tiles, CountScratch& scratch) const noexcept {
    RowAnswers& answers = scratch.answers;
    answers.tesseracts.clear();
    answers.keys.clear();
    answers.taken = 0;
    std::uint64_t simplices = 0, own_vertices = 0;
    CellBits<N, kAll> cells(view, row);
    const Word* const active = view.slab->active.data() + row * view.shape->words();
    // resolve each active tile and sum the sizes
    for (std::size_t w = 0, ordinal = 0; w < view.shape->words(); ++w) {
      if (active[w] != 0) cells.load(w);
      for (Word rest = active[w]; rest != 0; rest &= rest - 1, ++ordinal) {
        const auto bit = static_cast<unsigned>(std::countr_zero(rest));
        unsigned key = cells.signature(bit);
        index[0] = w * kWordBits + bit;
        if constexpr (N == 4)
          if (is_estimated_tile(key)) {
            const ResolvedTile& tile = answers.tesseracts.emplace_back(resolved_tile(*estimator_, index, key));
            const ResolvedSize size = scratch.tesseract->size(tile.key, tile.lists);
            simplices += size.simplices;
            own_vertices += size.own_vertices;
            if (!has_listed_cubes(view, row, index[0], tile)) return false;
            continue;
          }
        key = tiles.count != 0 ? tiles.signatures[ordinal] : key_of(index, key);
        if constexpr (N < 4) answers.keys.push_back(static_cast<std::uint16_t>(key));
        const SimplexList<N> list(table_, key);
        simplices += list.size();
        own_vertices += list.own_vertices();
      }
    }
    // compare with the counts
    return simplices == view.slab->simplices(row) && own_vertices == view.slab->own_vertices(row);
  }

  /// Whether a tile's cubes have the keys that were counted.
  [[nodiscard]] bool has_listed_cubes(const SlabView<N>& view, std::size_t row, std::size_t at,
                                      const ResolvedTile& tile) const noexcept {
    for (unsigned cube = 0; cube < ResolvedCubes::kCubes; ++cube) {
      const unsigned axis = cube / 2, side = cube % 2;
      const CubePlane& plane = view.cubes(static_cast<int>(axis), axis == N - 1 ? side : 0);
      if (!plane.has_listed(view.shape->shifted(row, side << axis), at + (axis == 0 ? side : 0), tile.cubes[cube],
                            detail::cube_vertices(estimator_->triangulation(), CubeKey(tile.cubes[cube]))))
        return false;
    }
    return true;
  }

  [[nodiscard]] bool is_estimated_tile(unsigned signature) const noexcept {
    if constexpr (N == 4) return estimator_ != nullptr && is_put_together(*estimator_, signature);
    return false;
  }

  /// Resolves a 4D tile: from a caller's stored answers or by the estimator.
  [[nodiscard]] ResolvedTile tile_of(RowAnswers& answers, const typename RowShape<N>::Index& index,
                                     unsigned signature) const noexcept {
    return estimator_->is_callers() ? answers.tesseracts[answers.taken++]
                                    : resolved_tile(*estimator_, index, signature);
  }
  /// Resolves tile number `ordinal` of a row's active tiles.
  [[nodiscard]] ResolvedTile tile_of(TilesWithOwnVertices& own, std::uint32_t ordinal,
                                     unsigned signature) const noexcept {
    if (own.tesseracts != nullptr) return own.tesseracts->resolve(own.index, ordinal, signature);
    return tile_of(own.scratch.answers, own.index, signature);
  }

  /// Writes a resolved 4D tile. Its own vertices are numbered from `own` on; `own` is advanced. `edge_ids`: numbers of
  /// its edges' vertices. `cubes`: of its row.
  Simplex* write_resolved(CubesOfTiles& cubes, const typename RowShape<N>::Index& index, unsigned signature,
                          const ResolvedTile& tile, const ResolvedView& filling, const Index* edge_ids, Index& own,
                          OwnCells& cells, Simplex* out) const noexcept {
    // numbers of the cubes' vertices: of as many as a cube can have, without a branch on how many it has
    std::array<Index, ResolvedCubes::kCubes * ResolvedCubes::kMostOwn> cube_ids;
    for (unsigned rest = tile.with_vertices; rest != 0; rest &= rest - 1) {
      const auto cube = static_cast<unsigned>(std::countr_zero(rest));
      const Index first = cubes.first_vertex(cube, index[0]);
      for (unsigned j = 0; j < ResolvedCubes::kMostOwn; ++j) cube_ids[ResolvedCubes::kMostOwn * cube + j] = first + j;
    }
    if constexpr (N == 4) {
      write_numbers(LocalSimplices{filling.simplices, filling.simplex_count, edge_ids,
                                   tile.with_vertices != 0 ? cube_ids.data() : nullptr, own, flip_},
                    out);
      // after the simplices: `index` has just been written in parts, and reading it as a whole would wait
      cells.add(filling, tile.lists, estimator_->triangulation(), index, signature, own);
    }
    own += filling.own_vertices;
    return out + filling.simplex_count;
  }

  /// Writes the barycentres of the tile's cubes (see writes_cubes).
  void write_cubes(SharedPlaces<N>& places, const Ids& ids, const typename RowShape<N>::Index& index,
                   VertexRun<Vertex> vertices) const noexcept {
    const auto write = [&]<unsigned Omitted>(std::integral_constant<unsigned, Omitted>) {
      for (unsigned side = index[Omitted] == 0 ? 0 : 1; side < 2; ++side) {
        using Frame = CellFrame<N, kAll ^ 1u << Omitted>;
        constexpr unsigned kFirst = tables::edge_count(N);
        const unsigned cube = 2 * Omitted + side;
        auto base = index;
        base[Omitted] += side;
        for (unsigned slot = 0, count = places.cube_vertices(cube); slot < count; ++slot) {
          const Index id = ids[kFirst + tables::kFaceSlots * cube + slot];
          const auto point = places.in_cube(cube, slot);
          vertices[id] = placement_.template in_cell<Frame>(base, point);
          if (placement_.normals() != nullptr)
            vertices.normal(id) = placement_.normals()->template in_cell<Frame>(base, point);
        }
      }
    };
    write(std::integral_constant<unsigned, 0>{});
    write(std::integral_constant<unsigned, 1>{});
    write(std::integral_constant<unsigned, 2>{});
    write(std::integral_constant<unsigned, 3>{});
  }

  void write_own(const SimplexList<N>& list, SharedPlaces<N>& places, const typename RowShape<N>::Index& index,
                 Index own, VertexRun<Vertex> vertices) const noexcept {
    std::array<TilePoint<N>, 256 - tables::first_tile_vertex(N)> points;
    const auto place = [&](unsigned v) -> decltype(auto) { return places(list.mapped(v)); };
    if constexpr (N > 2)
      own_places<N>(list, compact_, place, points.data(), places.edges().rays());
    else
      own_places<N>(list, compact_, place, points.data());
    for (unsigned j = 0; j < list.own_vertices(); ++j) {
      vertices[own + j] = placement_.template in_cell<CellFrame<N, kAll>>(index, points[j]);
      if (placement_.normals() != nullptr)
        vertices.normal(own + j) = placement_.normals()->template in_cell<CellFrame<N, kAll>>(index, points[j]);
    }
  }

  const EdgeCrossings<N>& source_;
  const FaceEstimator<N>* estimator_;
  const tables::TileTable& table_;
  const tables::TileTable* cube_;
  bool compact_;
  const RowTable* rows_;
  const Placement<N, Real>& placement_;
  bool flip_;
  bool has_cubes_;
};

}  // namespace tegl::detail
