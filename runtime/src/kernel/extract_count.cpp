// SPDX-License-Identifier: BSD-3-Clause
//
// Pass 3 of the extraction and its storage: counts by popcount (see extract_count.hpp).
// Based on: W. Schroeder, R. Maynard, B. Geveci, Flying Edges, 2015 (count, prefix sum, generate by rows); here on bit
// planes and in any dimension.
#include "kernel/extract_count.hpp"

#include <algorithm>
#include <bit>
#include <span>

#include "ambiguity/tesseract_decision.hpp"
#include "hwy/cache_control.h"
#include "kernel/tile_selection.hpp"

namespace tegl::detail {

template <int N>
Counter<N>::Counter(const RowShape<N>& shape, const TableSet<N>& tables, const RowTable* rows, RankReaders ranks,
                    const FaceEstimator<N>* estimator)
    : shape_(shape), tile_(*tables.tile), rows_(rows), estimator_(estimator), ranks_(ranks) {
  lists_cubes_ = N == 4 && estimator_ != nullptr;
  if (N == 4 && !lists_cubes_)
    for (unsigned s = 0; s < 256; ++s) {
      cube_vertices_[s] = tables.cube->lists[tables.cube->list_of[s]].cone_vertices;
      has_cubes_ = has_cubes_ || cube_vertices_[s] != 0;
    }
  quick_ = rows_ != nullptr && !has_cubes_ && shape_.size(0) <= kMostListed;
  has_cubes_ = has_cubes_ || lists_cubes_;
  if constexpr (N < 4)
    if (estimator_ != nullptr) ambiguous_ = SignatureSet(ambiguous_signatures<N>());
  if (N < 4 && rows_ != nullptr) {
    owns_vertices_ = false;
    for (unsigned s = 0; s < 1u << (1u << std::min(N, 3)); ++s)
      owns_vertices_ = owns_vertices_ || rows_->own_vertices(s) != 0;
  }
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
  for (EdgePlane& plane : planes.edges) plane.allocate(shape_.rows(), shape_.words());
  planes.chunk_vertices.assign(shape_.chunks(), 0);
  if (lists_cubes_)
    planes.cubes.allocate_lists(shape_.rows());
  else if (has_cubes_)
    planes.cubes.allocate(shape_.rows(), shape_.words());
}

template <int N>
void Counter<N>::allocate(SlabPlanes<N>& planes) const {
  planes.active.assign(shape_.rows() * shape_.words(), 0);
  planes.active_count.assign(shape_.rows(), 0);
  if (keeps_tiles()) {
    planes.tiles.allocate(shape_.rows() * shape_.size(0));
    planes.first_tile.assign(shape_.rows(), 0);
  }
  if (keeps_assembled()) {
    planes.assembled.resize(shape_.chunks());
    planes.first_assembled.assign(shape_.rows(), 0);
  }
  planes.edges.allocate(shape_.rows(), shape_.words());
  if (has_cubes_)
    for (CubePlane& plane : planes.cubes) {
      if (lists_cubes_)
        plane.allocate_lists(shape_.rows());
      else
        plane.allocate(shape_.rows(), shape_.words());
    }
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
  slab.valid.assign(shape_.rows() * shape_.words(), 0);
}

template <int N>
std::size_t Counter<N>::layer_bytes() const noexcept {
  return shape_.rows() * (shape_.pitch() * sizeof(Word) + sizeof(RowState) + 1);
}

template <int N>
std::size_t Counter<N>::layer_planes_bytes() const noexcept {
  return shape_.rows() * ((N - 1) * EdgePlane::row_bytes(shape_.words()) + cube_row_bytes());
}

template <int N>
std::size_t Counter<N>::cube_row_bytes() const noexcept {
  if (lists_cubes_) return CubePlane::list_bytes();
  return has_cubes_ ? CubePlane::row_bytes(shape_.words()) : 0;
}

template <int N>
std::size_t Counter<N>::slab_planes_bytes() const noexcept {
  constexpr std::size_t kCounts = sizeof(std::uint32_t) + sizeof(Index) + sizeof(std::uint64_t);
  const std::size_t lists = keeps_tiles() ? TileLists::bytes(shape_.size(0)) + sizeof(std::size_t) : 0;
  const std::size_t tiles = lists + (lists_cubes_ ? sizeof(std::size_t) : 0);
  return shape_.rows() * (shape_.words() * sizeof(Word) + kCounts + tiles + EdgePlane::row_bytes(shape_.words()) +
                          (N - 1) * cube_row_bytes());
}

template <int N>
void Counter<N>::count_edges(EdgePlane& plane, std::size_t row, const Word* a, const Word* b, bool along_row,
                             const Word* valid) const {
  const std::size_t at = row * shape_.words();
  plane.count[row] = count_edge_row(a, along_row ? nullptr : b, shape_.size(0), valid, plane.bits[0].data() + at,
                                    plane.prefix.data() + at);
}

template <int N>
template <unsigned Axes>
void Counter<N>::count_cubes(CubePlane& plane, const SlabView<N>& view, std::size_t row, const Word* valid) const {
  const std::size_t words = shape_.words();
  plane.count[row] = 0;
  if (!shape_.has_cells(shape_.index_of(row), Axes)) return;  // the row's bits have been 0 since allocation
  CellBits<N, Axes> cells(view, row);
  std::uint32_t count = 0;
  for (std::size_t w = 0; w < shape_.words(); ++w) {
    cells.load(w);
    std::array<Word, tables::kFaceSlots> bits{};
    Word mixed = cells.mixed() & shape_.mask(w, (Axes & 1u) != 0);
    if (valid != nullptr) mixed &= valid[w];
    plane.prefix[row * words + w] = count;
    for (; mixed != 0; mixed &= mixed - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(mixed));
      const unsigned vertices = cube_vertices_[cells.signature(bit)];
      for (unsigned slot = 0; slot < vertices; ++slot) bits[slot] |= Word{1} << bit;
      count += vertices;
    }
    for (unsigned slot = 0; slot < tables::kFaceSlots; ++slot) plane.bits[slot][row * words + w] = bits[slot];
  }
  plane.count[row] = count;
}

template <int N>
template <unsigned Axes>
void Counter<N>::list_cubes(CubePlane& plane, const SlabView<N>& view, std::size_t row, const Word* valid) const {
  if constexpr (N == 4) {
    plane.begin_row(row);
    auto base = shape_.index_of(row);
    if (!shape_.has_cells(base, Axes)) return;
    base[N - 1] = view.k;
    CellBits<N, Axes> cells(view, row);
    for (std::size_t w = 0; w < shape_.words(); ++w) {
      cells.load(w);
      Word mixed = cells.mixed() & shape_.mask(w, (Axes & 1u) != 0);
      if (valid != nullptr) mixed &= valid[w];
      for (; mixed != 0; mixed &= mixed - 1) {
        const auto bit = static_cast<unsigned>(std::countr_zero(mixed));
        base[0] = w * kWordBits + bit;
        const CubeKey key = cube_key<N>(*estimator_, base, Axes, cells.signature(bit));
        if (const unsigned own = detail::cube_vertices(estimator_->triangulation(), key); own != 0)
          plane.add(row, base[0], key.bits(), own);
      }
    }
  }
}

template <int N>
void Counter<N>::count_layer_row(Layer<N>& layer, std::size_t k, const Slab<N>* below, const Slab<N>* above,
                                 std::size_t row, Word* buffer) const {
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
      const SlabView<N> view{&shape_, {&layer, nullptr}, nullptr, k};
      if (lists_cubes_)
        list_cubes<7u>(layer.cubes, view, row, masked ? buffer : nullptr);
      else
        count_cubes<7u>(layer.cubes, view, row, masked ? buffer : nullptr);
    }
}

/// Whether all corners of a row's tiles have the same state.
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
  TileRow tiles{{}, shape.size(0) - 1, slab.all_valid ? nullptr : slab.valid.data() + row * shape.words()};
  CellBits<N, kAll>::rows(view, row, tiles.corners.data());
  return tiles;
}

template <int N>
void keep_count(const TileCount& count, Slab<N>& slab, std::size_t row) {
  slab.own_offset[row] = count.own_vertices;
  slab.simplex_offset[row] = count.simplices;
  slab.active_count[row] = count.active;
}

}  // namespace

template <int N>
TileCount Counter<N>::find_tiles(const SlabView<N>& view, std::size_t row, const TileRoom& room) const {
  TileRow tiles = tile_row(shape_, view, *view.slab, row);
  tiles.sizes = !lists_cubes_;  // else resolve_tesseracts counts them
  tiles.own_vertices = owns_vertices_;
  TileCount count = count_tile_row<N>(tiles, *rows_, room);
  if (N < 4 && estimator_ != nullptr) resolve_tiles(view, row, room, count);
  return count;
}

namespace {

/// Replaces the signatures of a row's ambiguous tiles by the keys of their variants, and corrects the row's counts.
/// N < 4.
template <int N>
class TileResolver {
 public:
  /// `base`: of the row; index 0 is ignored.
  TileResolver(const FaceEstimator<N>& estimator, const RowTable& table, const typename RowShape<N>::Index& base,
               const TileRoom& room, TileCount& count)
      : estimator_(estimator), table_(table), base_(base), room_(room), count_(count) {}

  /// Resolves tile number `i` of the row, which is in this word, individually. It may have been resolved.
  void resolve(std::uint32_t i, std::size_t word) {
    const unsigned before = room_.signatures[i];
    base_[0] = word * kWordBits + room_.at[i] % kWordBits;
    const unsigned key = resolved_key<N>(estimator_, base_, signature_of<N>(before));
    count_.simplices += table_.entry(key) & RowTable::kCountMask;
    count_.simplices -= table_.entry(before) & RowTable::kCountMask;
    count_.own_vertices += table_.own_vertices(key) - table_.own_vertices(before);
    room_.signatures[i] = static_cast<std::uint16_t>(key);
  }

  /// Resolves the ambiguous ones of `active` tiles from number `first` on, which are all tiles of a word, together.
  /// N = 3. `ambiguous`: bit i for tile first + i.
  void resolve_together(RowFaces<N>& faces, std::size_t word, std::uint32_t first, Word ambiguous) {
    CubesOfWord cubes{room_.active[word], ambiguous, room_.at + first, room_.signatures + first};
    Word unsure = detail::resolve(estimator_, table_, faces.look_at(word), cubes);
    count_.simplices += static_cast<std::uint64_t>(std::int64_t{cubes.more_simplices});
    count_.own_vertices += static_cast<std::uint32_t>(cubes.more_own_vertices);
    for (; unsure != 0; unsure &= unsure - 1) resolve(first + static_cast<unsigned>(std::countr_zero(unsure)), word);
  }

 private:
  const FaceEstimator<N>& estimator_;
  const RowTable& table_;
  typename RowShape<N>::Index base_;
  const TileRoom& room_;
  TileCount& count_;
};

}  // namespace

// Not inlined, so that the caller has a small stack frame if nothing is resolved. So is resolve_tesseracts.
template <int N>
[[gnu::noinline]] void Counter<N>::resolve_tiles(const SlabView<N>& view, std::size_t row, const TileRoom& room,
                                                 TileCount& count) const {
  if constexpr (N < 4) {
    constexpr std::uint32_t kMany = 2 * RowFaces<3>::kMany;  // one cube costs less than one tesseract
    auto base = shape_.index_of(row);
    base[N - 1] = view.k;
    TileResolver<N> resolver(*estimator_, *rows_, base, room, count);
    const bool is_listed = shape_.size(0) <= kMostListed;
    BitWalk walk(room.active);
    // calls visit(word, number of its first tile, its ambiguous tiles by number from this on)
    const auto for_words = [&](const auto& visit) {
      for (std::uint32_t first = 0; first < count.active; first += kWordBits) {
        const auto members = [&] {
          return members_of(ambiguous_, room.signatures + first,
                            std::min<std::size_t>(count.active - first, kWordBits));
        };
        Word rest = members();
        while (rest != 0) {
          // the word of the next ambiguous tile, and its tiles
          const std::uint32_t next = first + static_cast<std::uint32_t>(std::countr_zero(rest));
          const std::size_t at = is_listed ? room.at[next] : walk.place_of(next), word = at / kWordBits;
          const Word before = room.active[word] & ((Word{1} << (at % kWordBits)) - 1);
          const std::uint32_t start = next - few_bits(before);
          const auto tiles = static_cast<std::uint32_t>(std::popcount(room.active[word]));
          if (start < first || start + tiles > first + kWordBits) {  // a tile of the word is outside of the window
            first = start;
            rest = members();
          }
          const Word of_word = (~Word{0} >> (kWordBits - tiles)) << (start - first);
          visit(word, start, (rest & of_word) >> (start - first));
          rest &= ~of_word;
        }
      }
    };
    const auto resolve_each = [&](std::size_t word, std::uint32_t first, Word ambiguous) {
      for (; ambiguous != 0; ambiguous &= ambiguous - 1)
        resolver.resolve(first + static_cast<std::uint32_t>(std::countr_zero(ambiguous)), word);
    };
    if constexpr (N == 2) {
      for_words(resolve_each);
    } else {
      RowFaces<N> faces(*estimator_, base, shape_.size(0));
      const bool at_once = RowFaces<N>::can_use(*estimator_);
      for_words([&](std::size_t word, std::uint32_t first, Word ambiguous) {
        if (at_once && static_cast<std::size_t>(std::popcount(ambiguous)) >= kMany)
          resolver.resolve_together(faces, word, first, ambiguous);
        else
          resolve_each(word, first, ambiguous);
      });
    }
  }
}

namespace {

/// Counts the sizes of 4D tiles that the data do not affect. Their entries are seldom in a cache. So they are requested
/// while other tiles of the row are assembled, and read at its end, or when 64 requests are waiting.
class TilesOfTable {
 public:
  TilesOfTable(const RowTable& table, TileCount& count) noexcept : table_(table), count_(count) {}
  void count(unsigned signature) noexcept {
    const std::uint32_t entry = table_.entries[signature];
    count_.simplices += entry & RowTable::kCountMask;
    if ((entry & RowTable::kOwnFlag) != 0) count_.own_vertices += table_.own_vertices(signature);
  }
  void request(unsigned signature) noexcept {
    if (requests_ == requested_.size()) count_requested();
    hwy::Prefetch(table_.entries + signature);
    requested_[requests_++] = static_cast<std::uint16_t>(signature);
  }
  void count_requested() noexcept {
    for (std::size_t i = 0; i < requests_; ++i) count(requested_[i]);
    requests_ = 0;
  }

 private:
  const RowTable& table_;
  TileCount& count_;
  std::array<std::uint16_t, kWordBits> requested_;
  std::size_t requests_ = 0;
};

}  // namespace

template <int N>
[[gnu::noinline]] void Counter<N>::resolve_tesseracts(const SlabView<N>& view, std::size_t row, const TileRoom& room,
                                                      TileCount& count, CountScratch& scratch,
                                                      AssembledTiles* assembled, const FoundCubes* found) const {
  if constexpr (N == 4) {
    TilesOfTable of_table(*rows_, count);
    std::uint32_t put_together = 0;
    for (std::uint32_t i = 0; i < count.active; ++i)
      put_together += is_put_together(*estimator_, room.signatures[i]) ? 1 : 0;
    if (put_together == 0) {  // as in most smooth rows
      for (std::uint32_t i = 0; i < count.active; ++i) of_table.count(room.signatures[i]);
      return;
    }
    const bool is_listed = shape_.size(0) <= kMostListed;
    BitWalk walk(room.active);
    auto base = shape_.index_of(row);
    base[N - 1] = view.k;
    const ResolvedCubes& cubes = ResolvedCubes::instance(estimator_->triangulation());
    const bool callers = estimator_->is_callers();  // their answers are compared by key
    RowOfTesseracts tiles(*estimator_, base, shape_.size(0), {room.signatures, room.at, count.active},
                          *scratch.of_word);
    for (std::uint32_t i = 0; i < count.active; ++i) {
      const unsigned signature = room.signatures[i];
      if (!is_put_together(*estimator_, signature)) {
        of_table.request(signature);
        continue;
      }
      base[0] = is_listed ? room.at[i] : walk.place_of(i);
      const ResolvedTile& tile = tiles.resolve(base, i, signature);
      // add the filling's size
      const ResolvedSize filling = assemble(tile, *scratch.tesseract, assembled);
      count.simplices += filling.simplices;
      count.own_vertices += filling.own_vertices;
      // record its cubes that own vertices, each by one tile only
      if (found == nullptr || tile.with_vertices == 0) continue;
      const bool is_last = base[0] + 2 == shape_.size(0);
      for (unsigned rest = tile.with_vertices & (is_last ? 0b10010111u : 0b10010101u); rest != 0; rest &= rest - 1) {
        const auto cube = static_cast<unsigned>(std::countr_zero(rest));
        CubePlane& plane = cube == 7 ? found->in_layer : found->in_slab[cube / 2];
        const unsigned list = tile.lists[cube];
        plane.add(row, base[0] + (cube == 1 ? 1 : 0), callers ? tile.cubes[cube] : cubes.key(list),
                  cubes.own_vertices(list));
      }
    }
    of_table.count_requested();
  }
}

template <int N>
ResolvedSize Counter<N>::assemble(const ResolvedTile& tile, ResolvedTesseract& tesseract,
                                  AssembledTiles* assembled) const {
  if (assembled == nullptr || assembled->is_full()) return tesseract.size(tile.key, tile.lists);
  const ResolvedView& filling = tesseract.find(tile.key, tile.lists, tile.apart);
  assembled->add(tile, filling, most_assembled_);
  return {filling.simplex_count, filling.own_vertices};
}

template <int N>
CountScratch Counter<N>::make_scratch() const {
  CountScratch scratch{std::vector<Word>(shape_.pitch()), {}, nullptr, nullptr, 0, {}};
  if (lists_cubes_) {
    scratch.tesseract = std::make_unique<ResolvedTesseract>(make_resolved_tesseract(estimator_->triangulation()));
    scratch.of_word = std::make_unique<TesseractsOfWord>();
  }
  if (rows_ != nullptr && !keeps_tiles()) scratch.tiles.allocate(shape_.size(0));
  if (estimator_ != nullptr && estimator_->is_callers()) {
    if constexpr (N == 4)
      scratch.answers.tesseracts.reserve(shape_.size(0));
    else
      scratch.answers.keys.reserve(shape_.size(0));
  }
  return scratch;
}

template <int N>
TileRoom Counter<N>::tile_room(Slab<N>& slab, std::size_t row, CountScratch& scratch) const {
  const std::size_t first = keeps_tiles() ? slab.first_tile[row] : 0;
  TileLists& lists = keeps_tiles() ? slab.tiles : scratch.tiles;
  return {slab.active.data() + row * shape_.words(), lists.signatures.data() + first, lists.at.data() + first};
}

template <int N>
RowTiles Counter<N>::tiles(const SlabView<N>& view, std::size_t row, CountScratch& scratch) const {
  const Slab<N>& slab = *view.slab;
  // Signatures are usable in rows of any length, positions along the row only if it goes by tiles (they count modulo
  // 2^16).
  if (slab.active_count[row] == 0 || rows_ == nullptr || (has_cubes_ && !lists_cubes_) || !slab.all_valid) return {};
  if (keeps_tiles()) {
    const std::size_t first = slab.first_tile[row];
    return {slab.tiles.signatures.data() + first, slab.tiles.at.data() + first, slab.active_count[row]};
  }
  TileLists& lists = scratch.tiles;
  const TileRoom room{scratch.words.data(), lists.signatures.data(), lists.at.data()};
  return {room.signatures, room.at, find_tiles(view, row, room).active};
}

template <int N>
void Counter<N>::count_tiles(const SlabView<N>& view, Slab<N>& slab, std::size_t row, CountScratch& scratch) const {
  constexpr unsigned kAll = (1u << N) - 1;
  Word* const active = slab.active.data() + row * shape_.words();
  slab.own_offset[row] = 0;
  slab.simplex_offset[row] = 0;
  slab.active_count[row] = 0;
  if (!shape_.has_cells(shape_.index_of(row), kAll)) return;
  if (is_uniform(view, row)) return;
  // by the flat table
  if (rows_ != nullptr) {
    const TileRoom room = tile_room(slab, row, scratch);
    TileCount count = find_tiles(view, row, room);
    if (lists_cubes_) resolve_tesseracts(view, row, room, count, scratch, assembled(slab, row), nullptr);
    keep_count(count, slab, row);
    return;
  }
  // word by word
  CellBits<N, kAll> cells(view, row);
  for (std::size_t w = 0; w < shape_.words(); ++w) {
    cells.load(w);
    Word mixed = cells.mixed() & shape_.mask(w, true);
    if (!slab.all_valid) mixed &= slab.valid[row * shape_.words() + w];
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
void Counter<N>::count_slab_row(const SlabView<N>& view, Slab<N>& slab, std::size_t row, CountScratch& scratch) const {
  Word* const buffer = scratch.words.data();
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
      if (lists_cubes_) {
        list_cubes<14u>(slab.cubes[0], view, row, valid(14u));
        list_cubes<13u>(slab.cubes[1], view, row, valid(13u));
        list_cubes<11u>(slab.cubes[2], view, row, valid(11u));
      } else {
        count_cubes<14u>(slab.cubes[0], view, row, valid(14u));
        count_cubes<13u>(slab.cubes[1], view, row, valid(13u));
        count_cubes<11u>(slab.cubes[2], view, row, valid(11u));
      }
    }
  count_tiles(view, slab, row, scratch);
}

template <int N>
void Counter<N>::count_quickly(const SlabView<N>& view, Layer<N>& upper, Slab<N>& slab, std::size_t row,
                               CountScratch& scratch) const {
  TileCount count;
  if (lists_cubes_) {
    upper.cubes.begin_row(row);
    for (CubePlane& plane : slab.cubes) plane.begin_row(row);
  }
  if (!is_uniform(view, row)) {
    const TileRoom room = tile_room(slab, row, scratch);
    count = find_tiles(view, row, room);
    const FoundCubes found{upper.cubes, slab.cubes};
    if (lists_cubes_) resolve_tesseracts(view, row, room, count, scratch, assembled(slab, row), &found);
  }
  keep_count(count, slab, row);
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

/// Prefix sum over the rows of a chunk. place_layer and place_slab (first_vertices.cpp) add the first number of the
/// chunk.
template <class Plane>
void offset(Plane& plane, std::size_t row, std::uint64_t& next) {
  plane.offset.data()[row] = static_cast<Index>(next);  // data(): checked builds do not inline operator[]
  next += plane.count.data()[row];
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
    count_layer_row(layer, 0, nullptr, &above, row, buffer);
    vertices += offset_layer_row(layer, row, vertices);
  }
  layer.chunk_vertices[chunk] = vertices;
}

template <int N>
void Counter<N>::count_slab(const SlabView<N>& view, Layer<N>& upper, Slab<N>& slab, const Slab<N>* above,
                            std::size_t chunk, CountScratch& scratch) const {
  if (is_uniform_chunk(view, chunk)) return clear_chunk(upper, slab, chunk);
  const bool ranks = has_ranks(slab, above);
  SlabChunk sums;
  std::uint64_t in_layer = 0;
  if (!slab.assembled.empty()) slab.assembled[chunk].clear(scratch.assembled_words);
  for (std::size_t row = chunk * kChunkRows; row < shape_.chunk_end(chunk); ++row) {
    if (!slab.assembled.empty()) slab.first_assembled[row] = slab.assembled[chunk].size();
    if (keeps_tiles()) slab.first_tile[row] = chunk * kChunkRows * shape_.size(0) + sums.active;
    if (!ranks && goes_by_tiles(slab, row)) {
      count_quickly(view, upper, slab, row, scratch);
    } else {
      count_layer_row(upper, view.k + 1, &slab, above, row, scratch.words.data());
      count_slab_row(view, slab, row, scratch);
    }
    const std::uint64_t vertices = offset_layer_row(upper, row, in_layer);
    in_layer += vertices;
    const bool busy = (offset_slab_row(slab, row, sums) | vertices | slab.active_count[row]) != 0;
    sums.busy |= static_cast<std::uint32_t>(busy) << (row % kChunkRows);
  }
  upper.chunk_vertices[chunk] = in_layer;
  slab.chunks[chunk] = sums;
  // the next chunk probably needs as much room: in noise, a chunk has a few per cent more or less than another
  if (!slab.assembled.empty()) scratch.assembled_words = slab.assembled[chunk].size() / 32 * 33;
}

template class Counter<2>;
template class Counter<3>;
template class Counter<4>;

}  // namespace tegl::detail
