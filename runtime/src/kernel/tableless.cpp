// SPDX-License-Identifier: BSD-3-Clause
//
// The extraction without tables, slab by slab along the last axis. Steps for a slab: find its cells (active tiles and
// caps), build tiles for new signatures, number the vertices face by face, write. A part of the contour is one slab
// with the layer above it. See extract_layers.hpp for the terms.
#include "kernel/tableless.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "ambiguity/tile_choices.hpp"
#include "base/progress.hpp"
#include "base/stopwatch.hpp"
#include "base/workers.hpp"
#include "kernel/extract_progress.hpp"
#include "kernel/face_ranks.hpp"
#include "kernel/placement.hpp"
#include "kernel/split_nonmanifold.hpp"
#include "kernel/tile_cells.hpp"
#include "tile/built_tiles.hpp"
#include "tile/grid_cells.hpp"
#include "tile/tile_places.hpp"

namespace tegl::detail {
namespace {

/// Bits of one layer's samples, and its faces that have vertices.
struct TileLayer {
  std::vector<Word> high;
  std::vector<Word> missing;  ///< empty: none
  FaceRanks faces;
};

/// Cells between two layers, and the faces with vertices that lie in neither layer.
struct TileSlab {
  std::vector<Cell> cells;
  std::vector<SeenTile> tiles;
  std::vector<std::uint64_t> simplices;  ///< by cell: number of its first simplex
  FaceRanks faces;
};

template <int N, class Real>
class TileExtraction final : public SteppedExtraction<N, Real> {
 public:
  TileExtraction(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options,
                 ContourOutput<N, Real>& output, std::size_t tile_bytes, const ExtractPlan& plan)
      : SteppedExtraction<N, Real>(grid),
        source_(source),
        options_(options),
        output_(output),
        max_vertices_(plan.max_vertices),
        reporter_(options.work.progress, grid.axes[N - 1].size() - 1),
        flip_(against_tables(grid, options)),
        shape_(grid.sizes()),
        placement_(grid),
        cube_(N),
        grid_cells_(cube_, options.close),
        finder_(shape_, options.close ? plan.closed_axes : 0),
        workers_(options.work.threads, [] { return Nothing{}; }),
        built_(cube_,
               {options.ambiguity == Ambiguity::high ? tile::Alternative::high : tile::Alternative::low,
                options.triangulation, is_estimated(options.ambiguity)},
               tile_bytes, workers_.count()),
        missing_{TilesWithoutValues<N>(shape_), TilesWithoutValues<N>(shape_), TilesWithoutValues<N>(shape_)} {
    if (options.normals != Normals::none) placement_.want_normals(source, grid, options);
    if (is_estimated(options.ambiguity)) {
      estimator_.emplace(source, grid.sizes(), options, plan.part);
      choices_.emplace(*estimator_);
    }
    // Two slabs are in memory. Gradients read one layer more, a custom estimator as many as its reach.
    if (options.ambiguity == Ambiguity::custom) reach_ = std::min(options.estimator.reach, shape_.layers());
    source.keep(2 + reach_ + std::max<std::size_t>(2, reach_));
  }

  bool prepare_batch() override {
    const std::size_t slabs = shape_.layers() - 1;
    if (next_ > slabs) {
      reporter_.tell(static_cast<double>(slabs));
      return false;
    }
    const std::size_t k = next_++;
    reporter_.begin_batch(k == 0 ? 0 : k - 1, k, passes());
    reporter_.tell(k == 0 ? 0.0 : static_cast<double>(k - 1));
    Stopwatch watch;
    for (; prepared_ < std::min(k + 2 + reach_, shape_.layers()); ++prepared_) source_.prepare(prepared_);
    watch.add_to(stats_.read_seconds);
    return true;
  }

  /// Whether any tile has a missing corner.
  [[nodiscard]] bool any_missing() const noexcept { return any_missing_; }
  /// The vertices at which the contour may touch itself beside missing values, ascending. Known after the extraction,
  /// unless the contour was only counted.
  [[nodiscard]] std::vector<Index> touching() {
    std::sort(touching_.begin(), touching_.end());
    return std::move(touching_);
  }

  /// Classifies layer k + 1, finds the cells of slab k, numbers its vertices, and writes slab k - 1.
  void extract_batch() override {
    const std::size_t slabs = shape_.layers() - 1;
    const std::size_t k = next_ - 1;
    Stopwatch watch;
    if (k == 0) classify(0);
    if (k < slabs) classify(k + 1);
    watch.add_to(stats_.classify_seconds);
    if (k < slabs) find_cells(k, stats_);
    number_vertices(k);
    watch.add_to(stats_.find_seconds);
    if (k > 0) write(k - 1);
    if (k == slabs) output_.finish({0, vertices_, 0, simplices_, 1.0}, nullptr, no_candidates_);
    watch.add_to(stats_.generate_seconds);
  }

 private:
  using Vertex = typename Contour<N, Real>::Vertex;
  using SteppedExtraction<N, Real>::stats_;
  struct Nothing {};                             ///< threads need no working storage
  static constexpr std::size_t kMostWork = 256;  ///< maximum cells or tiles between checks for cancellation
  /// Progress passes per slab: building the next slab's tiles (up to two), building tiles whose own choice matters (up
  /// to two, only with choices), writing.
  [[nodiscard]] unsigned passes() const noexcept { return choices_ ? 5 : 3; }
  static constexpr unsigned kAll = (1u << N) - 1;
  static constexpr std::size_t kNoCell = ~std::size_t{0};
  static constexpr std::uint32_t kSlabAbove = std::uint32_t{1} << 31;  ///< for cells of the slab above a layer

  TileLayer& layer(std::size_t k) { return layers_[k % layers_.size()]; }
  TileSlab& slab(std::size_t k) { return slabs_[k % slabs_.size()]; }
  /// Calls work(from, to) in parallel for parts of 0 ... count - 1.
  template <class Work>
  void for_range(std::size_t count, std::size_t grain, const Work& work) {
    workers_.for_range(count, grain, [&](std::size_t from, std::size_t to, Nothing&) { work(from, to); });
  }

  /// Runs for_range as a pass whose progress is reported.
  template <class Work>
  void pass_over(std::size_t count, std::size_t grain, const Work& work) {
    reporter_.begin_pass(count);
    for_range(count, grain, [&](std::size_t from, std::size_t to) {
      for (std::size_t next; from < to && !reporter_.stopped(); from = next) {
        next = std::min(to, from + kMostWork);
        work(from, next);
        reporter_.add(next - from);
      }
    });
  }

  void classify(std::size_t k) {
    TileLayer& here = layer(k);
    here.high.assign(shape_.rows() * shape_.pitch(), 0);
    here.faces.reset(shape_.rows() * grid_cells_.slots(false) * shape_.words());
    std::vector<Word> missing(shape_.rows() * shape_.pitch());
    std::atomic<bool> any_missing = false;
    for_range(shape_.rows(), 64, [&](std::size_t from, std::size_t to) {
      for (std::size_t row = from; row < to; ++row) {
        auto start = shape_.index_of(row);
        start[N - 1] = k;
        const std::size_t first = row * shape_.pitch();
        if (source_.classify(start, 1, {here.high.data() + first, shape_.pitch()},
                             {missing.data() + first, shape_.pitch()}) != 0)
          any_missing = true;
      }
    });
    if (!any_missing) missing.clear();
    here.missing = std::move(missing);
    any_missing_ = any_missing_ || any_missing;
  }

  void find_cells(std::size_t k, ExtractStats& stats) {
    TileSlab& here = slab(k);
    here.faces.reset(shape_.rows() * grid_cells_.slots(true) * shape_.words());
    // find cells, by row in parallel
    const std::array<const Word*, 2> layers = {layer(k).high.data(), layer(k + 1).high.data()};
    TilesWithoutValues<N>& missing = missing_[k % missing_.size()];
    missing.set({&layer(k).missing, &layer(k + 1).missing});
    by_row_.resize(shape_.rows());
    for_range(shape_.rows(), 16, [&](std::size_t from, std::size_t to) {
      for (std::size_t row = from; row < to; ++row) {
        by_row_[row].clear();
        finder_.find(k, layers, row, by_row_[row]);
        if (missing.any()) std::erase_if(by_row_[row], [&](const Cell& cell) { return missing.has(cell); });
      }
    });
    // gather them in order
    here.cells.clear();
    for (const std::vector<Cell>& cells : by_row_) here.cells.insert(here.cells.end(), cells.begin(), cells.end());
    if (here.cells.size() >= kSlabAbove)
      throw Error(ErrorCode::TooLarge, fmt::format("{} active tiles between two layers; expected less than {}",
                                                   here.cells.size(), kSlabAbove));
    build_tiles(k);
    // count active tiles and mark faces with vertices
    for (const Cell& cell : here.cells)
      if (!CellKind<N>(cell.kind).is_cap()) ++stats.active_tiles;
    for_faces(k, [&](FaceRanks& faces, std::size_t word, unsigned bit, const BuiltTile::FaceVertices&, std::size_t,
                     std::uint16_t) { faces.mark(word, bit); });
  }

  void build_tiles(std::size_t k) {
    TileSlab& here = slab(k);
    here.tiles.clear();
    if (choices_) {
      find_choices(k);
      assign_tiles(here, all_cells(here), [&](std::size_t c) { return keys_[c]; });
      choose_own(k);
    } else {
      assign_tiles(here, all_cells(here), [&](std::size_t c) { return TileKey{here.cells[c].signature, {}}; });
    }
    // number the simplices
    here.simplices.resize(here.cells.size() + 1);
    for_range(here.cells.size(), 256, [&](std::size_t from, std::size_t to) {
      for (std::size_t c = from; c < to; ++c)
        here.simplices[c + 1] = here.tiles[here.cells[c].tile].tile->simplices.size() / N;
    });
    here.simplices[0] = simplices_;
    std::partial_sum(here.simplices.begin(), here.simplices.end(), here.simplices.begin());
    simplices_ = here.simplices.back();
  }

  static auto all_cells(const TileSlab& slab) {
    return [&slab](std::size_t i) { return i < slab.cells.size() ? i : kNoCell; };
  }

  /// Assigns built tiles to some cells, by the cells' keys. `cell(i)`: number of the i-th cell; kNoCell after the last.
  template <class Cells, class KeyOf>
  void assign_tiles(TileSlab& here, const Cells& cell, const KeyOf& key_of) {
    // distinct keys, ascending
    std::vector<TileKey> keys;
    std::size_t count = 0;
    for (; cell(count) != kNoCell; ++count) {
      keys.push_back(key_of(cell(count)));
      if (keys.size() == keys.capacity()) make_unique(keys);
    }
    make_unique(keys);
    // build their tiles
    const std::size_t before = here.tiles.size();
    auto tiles = built_.get(keys, [this](std::size_t n, const auto& work) { this->pass_over(n, 16, work); });
    here.tiles.insert(here.tiles.end(), tiles.begin(), tiles.end());
    // look up the tile of each cell
    for_range(count, 256, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i)
        here.cells[cell(i)].tile = static_cast<std::uint32_t>(
            before +
            static_cast<std::size_t>(std::lower_bound(keys.begin(), keys.end(), key_of(cell(i))) - keys.begin()));
    });
  }
  static void make_unique(std::vector<TileKey>& keys) {
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    keys.reserve(2 * keys.size() + 1024);
  }

  /// Determines from the data the choices for the cells' faces, and for tiles with ambiguous faces.
  void find_choices(std::size_t k) {
    const TileSlab& here = slab(k);
    keys_.resize(here.cells.size());
    for_range(here.cells.size(), 64, [&](std::size_t from, std::size_t to) {
      for (std::size_t c = from; c < to; ++c) {
        const CellKind<N> kind(here.cells[c].kind);
        const auto base = base_of(here.cells[c], k);
        keys_[c] = choices_->of_faces(kind, base, here.cells[c].signature);
        if (keys_[c].has_choices() && !kind.is_cap()) choices_->choose_own(keys_[c], base);
      }
    });
    estimator_->rethrow();
  }

  /// Determines the choice of tiles that have one although none of their faces has; known only after they are built.
  void choose_own(std::size_t k) {
    TileSlab& here = slab(k);
    std::vector<std::size_t> open;
    for (std::size_t c = 0; c < here.cells.size(); ++c)
      if (!keys_[c].has_choices() && !CellKind<N>(here.cells[c].kind).is_cap() &&
          !here.tiles[here.cells[c].tile].tile->is_settled)
        open.push_back(c);
    for_range(open.size(), 64, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) choices_->choose_own(keys_[open[i]], base_of(here.cells[open[i]], k));
    });
    estimator_->rethrow();
    if (open.empty()) return;
    assign_tiles(
        here, [&](std::size_t i) { return i < open.size() ? open[i] : kNoCell; },
        [&](std::size_t c) { return keys_[c]; });
  }

  /// Lowest sample of a cell of slab k.
  typename RowShape<N>::Index base_of(const Cell& cell, std::size_t k) const noexcept {
    const CellKind<N> kind(cell.kind);
    auto base = shape_.index_of(cell.row);
    base[0] = cell.i;
    base[N - 1] = k + (kind.across() == N - 1 ? kind.side() : 0);
    return base;
  }

  /// Calls visit(faces, word, bit, vertices, cell number, face) for each face of a cell that has vertices.
  template <class Visit>
  void for_faces_of(std::size_t k, std::size_t c, const Visit& visit) {
    const Cell& cell = slab(k).cells[c];
    const CellKind<N> kind(cell.kind);
    const SeenTile& seen = slab(k).tiles[cell.tile];
    for (const BuiltTile::FaceVertices& vertices : seen.tile->faces) {
      const std::uint16_t face = seen_face(seen, vertices.face);
      const FaceWhere& where = grid_cells_.where(kind, face);
      const bool is_upper = (where.shift >> (N - 1) & 1u) != 0;
      FaceRanks& faces = where.in_slab ? slab(k).faces : layer(k + (is_upper ? 1 : 0)).faces;
      const std::size_t row = shape_.shifted(cell.row, where.shift), i = cell.i + (where.shift & 1u);
      const std::size_t word = (row * grid_cells_.slots(where.in_slab) + where.slot) * shape_.words() + i / kWordBits;
      visit(faces, word, static_cast<unsigned>(i % kWordBits), vertices, c, face);
    }
  }
  /// Number in the cell of a built tile's face.
  [[nodiscard]] std::uint16_t seen_face(const SeenTile& seen, std::size_t face) const noexcept {
    const CubeFace& built = cube_.cells()[face];
    const unsigned axes = built_.symmetries().axes(seen.symmetry, built.axes);
    return cube_.number(built_.symmetries().base(seen.symmetry, built.base, axes), axes);
  }
  template <class Visit>
  void for_faces(std::size_t k, const Visit& visit) {
    for_range(slab(k).cells.size(), 64, [&](std::size_t from, std::size_t to) {
      for (std::size_t c = from; c < to; ++c) for_faces_of(k, c, visit);
    });
  }

  /// Owner number of cell c of the current slab, as stored in FaceRanks.
  static std::uint32_t owner_name(const FaceRanks& faces, const TileLayer& lower, std::size_t c) {
    return static_cast<std::uint32_t>(c) | (&faces == &lower.faces ? kSlabAbove : 0);
  }

  /// Numbers the vertices of layer k and slab k. Requires the cells of slabs k - 1 and k.
  void number_vertices(std::size_t k) {
    const bool has_slab = k + 1 < shape_.layers();
    layer(k).faces.rank();
    if (has_slab) slab(k).faces.rank();
    const auto tell = [&](std::size_t of) {
      for_faces(of, [&, of](FaceRanks& faces, std::size_t word, unsigned bit, const BuiltTile::FaceVertices& vertices,
                            std::size_t c, std::uint16_t) {
        if (&faces == &layer(k).faces || (of == k && &faces == &slab(k).faces))
          faces.tell(word, bit, vertices.count, owner_name(faces, layer(of), c));
      });
    };
    if (k > 0) tell(k - 1);
    if (has_slab) tell(k);
    // layer before slab: the part of slab k - 1 ends with layer k
    vertices_ = layer(k).faces.number(vertices_);
    part_end_ = vertices_;
    if (has_slab) vertices_ = slab(k).faces.number(vertices_);
  }

  /// Writes the part of slab k: the slab and the layer above it.
  void write(std::size_t k) {
    const double done = static_cast<double>(k + 1) / static_cast<double>(shape_.layers() - 1);
    const ContourPart part{part_first_, part_end_, slab(k).simplices.front(), slab(k).simplices.back(), done};
    room_ = output_.open(part);
    if (room_.vertices != nullptr || room_.simplices != nullptr) {
      check_vertex_count(part.end_vertex, max_vertices_);
      pass_over(slab(k).cells.size(), 16, [&](std::size_t from, std::size_t to) {
        TilePlaces<N> places(cube_, built_.symmetries());
        std::vector<Index> ids;
        for (std::size_t c = from; c < to; ++c) {
          write_vertices(k, c, places, ids);
          write_simplices(slab(k), c, ids);
        }
      });
      if (estimator_) estimator_->rethrow();
      output_.close(part, no_candidates_);
    }
    part_first_ = part_end_;
  }

  /// Looks up the numbers of all vertices of a cell. Writes the vertices of the faces that it owns. It owns faces in
  /// the lower layer only if they have no cell below: in slab 0 and beside missing values. Then their room is that of
  /// the part before, in front of this one's.
  void write_vertices(std::size_t k, std::size_t c, TilePlaces<N>& places, std::vector<Index>& ids) {
    const Cell& cell = slab(k).cells[c];
    const SeenTile& seen = slab(k).tiles[cell.tile];
    const CellKind<N> kind(cell.kind);
    const auto base = base_of(cell, k);
    const Rays rays(*this, kind, base);
    places.begin(seen, kind.is_cap() ? N - 1 : -1, rays);
    ids.resize(seen.tile->vertices.size());
    for_faces_of(k, c,
                 [&](FaceRanks& faces, std::size_t word, unsigned bit, const BuiltTile::FaceVertices& vertices,
                     std::size_t, std::uint16_t face) {
                   // All cells at a face give it the same number of vertices, unless a caller's estimator is
                   // inconsistent.
                   if (estimator_ && vertices.count != faces.count(word, bit)) return estimator_->report_change(base);
                   number_face(seen, vertices, faces.first(word, bit), ids);
                   if (cube_.cells()[face].dim == 1) places.set_edge(vertices.first, alpha(kind, base, face));
                   if (faces.owner(word, bit) != owner_name(faces, layer(k), c)) return;
                   if (any_missing_ && may_touch(cell, k, face)) add_touching(vertices, ids);
                   for (std::size_t v = vertices.first; v < std::size_t{vertices.first} + vertices.count; ++v) {
                     const auto place = in_grid(kind, places(v));
                     const auto at = std::ptrdiff_t{ids[v]} - static_cast<std::ptrdiff_t>(part_first_);
                     room_.vertices[at] = point(kind, base, face, place);
                     if (options_.normals != Normals::none)
                       room_.normals[at] =
                           placement_.normals()->template in_cell<CellFrame<N, (1u << N) - 1>>(base, place);
                   }
                 });
  }

  /// A set of tiles around a face, as masks of the axes along which they are before it.
  struct TilesAround {
    unsigned count = 0, common = ~0u, any = 0;
    void add(unsigned place) noexcept {
      ++count;
      common &= place;
      any |= place;
    }
    /// Whether they are all tiles around a face of more dimensions.
    [[nodiscard]] bool is_box() const noexcept { return count == 1u << std::popcount(common ^ any); }
  };
  /// Whether the contour may touch itself at a face of a cell: some of the tiles around it have missing corners, and
  /// neither these nor the others form a box. At the border: whether some have missing corners.
  [[nodiscard]] bool may_touch(const Cell& cell, std::size_t k, std::size_t face) const noexcept {
    const CellKind<N> kind(cell.kind);
    const unsigned shift = kind.spread(cube_.cells()[face].base), fixed = kAll & ~kind.spread(cube_.cells()[face].axes);
    auto at = base_of(cell, k);
    for (int a = 0; a < N; ++a) at[a] += shift >> a & 1u;
    const std::size_t row = shape_.shifted(cell.row, shift);
    TilesAround missing, others;
    bool is_at_border = false;
    for (unsigned place = 0; place <= kAll; ++place) {
      if ((place & ~fixed) != 0) continue;
      bool exists = true;
      for (int a = 0; a < N; ++a) exists = exists && ((place >> a & 1u) != 0 ? at[a] > 0 : at[a] + 1 < shape_.size(a));
      is_at_border = is_at_border || !exists;
      if (!exists) continue;
      const std::size_t slab = at[N - 1] - (place >> (N - 1) & 1u);
      if (missing_[slab % missing_.size()].has(shape_.unshifted(row, place), at[0] - (place & 1u)))
        missing.add(place);
      else
        others.add(place);
    }
    return missing.count != 0 && (is_at_border || (!missing.is_box() && !others.is_box()));
  }
  void add_touching(const BuiltTile::FaceVertices& vertices, const std::vector<Index>& ids) {
    const std::lock_guard lock(touching_mutex_);
    touching_.insert(touching_.end(), ids.begin() + vertices.first,
                     ids.begin() + vertices.first + std::ptrdiff_t{vertices.count});
  }

  /// Numbers a face's vertices in the same order for all cells that share the face.
  void number_face(const SeenTile& seen, const BuiltTile::FaceVertices& vertices, Index first,
                   std::vector<Index>& ids) const {
    const std::size_t end = std::size_t{vertices.first} + vertices.count;
    for (std::size_t v = vertices.first; v < end; ++v) ids[v] = first++;
    if (!vertices.by_edges) return;
    const auto least_edge = [&](std::size_t v) {
      std::uint16_t least = std::numeric_limits<std::uint16_t>::max();
      for (std::size_t e = seen.tile->vertices[v].first_edge; e < seen.tile->vertices[v].end_edge; ++e)
        least = std::min(least, seen_face(seen, seen.tile->vertices[seen.tile->edges[e]].face));
      return least;
    };
    first -= static_cast<Index>(vertices.count);
    for (std::size_t v = vertices.first; v < end; ++v) {
      const std::uint16_t own = least_edge(v);
      ids[v] = first;
      for (std::size_t w = vertices.first; w < end; ++w)
        if (w != v && least_edge(w) < own) ++ids[v];
    }
  }

  /// Interpolation parameter of the vertex on an edge of a cell. Edges of a cap across the border have 0: the vertex is
  /// at the sample itself.
  double alpha(CellKind<N> kind, const typename RowShape<N>::Index& base, std::size_t edge) {
    const CubeFace& face = cube_.cells()[edge];
    const int axis = std::countr_zero(face.axes);
    if (kind.is_cap() && axis == N - 1) return 0.0;
    const unsigned shift = kind.spread(face.base);
    auto start = base;
    for (int a = 1; a < N; ++a) start[a] += shift >> a & 1u;
    const auto strides = source_.strides();
    std::ptrdiff_t row = 0;
    for (int a = 1; a + 1 < N; ++a) row += static_cast<std::ptrdiff_t>(start[a]) * strides[a];
    const auto at = static_cast<std::uint32_t>(base[0] + (shift & 1u));
    double result = 0;
    source_.edge_alphas(start[N - 1], kind.axis(axis), {&row, &at, 1}, &result);
    return result;
  }

  /// Rays in the faces of a cell. Faces of a cap across the border are flat: the level does not matter.
  class Rays final : public TileRays {
   public:
    Rays(const TileExtraction& of, CellKind<N> kind, const typename RowShape<N>::Index& base) noexcept
        : of_(of), kind_(kind), base_(base) {}
    [[nodiscard]] double level(std::size_t face, std::uint32_t corners) const noexcept override {
      return level_in<3>(face, corners);
    }
    [[nodiscard]] double level(std::size_t face, const TilePoint<4>& end) const noexcept override {
      return level_in<4>(face, end);
    }
    [[nodiscard]] double level(std::size_t face, const TilePoint<5>& end) const noexcept override {
      return level_in<5>(face, end);
    }

   private:
    template <int K, class End>
    [[nodiscard]] double level_in(std::size_t face, const End& end) const noexcept {
      const CubeFace& cell = of_.cube_.cells()[face];
      if (kind_.is_cap() && (cell.axes >> (N - 1) & 1u) != 0) return 0.5;
      auto start = base_;
      for (int a = 0; a < N; ++a) start[a] += kind_.spread(cell.base) >> a & 1u;
      return of_.source_.template heights<K>(start, kind_.spread(cell.axes)).level(end);
    }

    const TileExtraction& of_;
    CellKind<N> kind_;
    const typename RowShape<N>::Index& base_;
  };

  /// Maps a position from the axes of a cell to those of the grid.
  static TilePoint<N> in_grid(CellKind<N> kind, const TilePoint<N>& place) noexcept {
    if (!kind.is_cap()) return place;
    TilePoint<N> result;
    result[kind.across()] = 0.0;
    for (int j = 0; j + 1 < N; ++j) result[kind.axis(j)] = place[j];
    return result;
  }
  /// Position of a point in a face of a cell. Faces between layers keep their points off both.
  Vertex point(CellKind<N> kind, const typename RowShape<N>::Index& base, std::size_t face,
               const TilePoint<N>& place) const noexcept {
    std::array<double, N> point;
    for (int a = 0; a < N; ++a)
      point[a] = a == kind.across() ? placement_.sample(a, base[a]) : placement_.between(a, base[a], place[a]);
    Vertex vertex = placement_.world(point);
    const unsigned axes = kind.spread(cube_.cells()[face].axes);
    for (int a = N - 2; a < N; ++a)
      if ((axes >> a & 1u) != 0) vertex = placement_.inside_slab(vertex, base[a], a);
    return vertex;
  }

  void write_simplices(const TileSlab& from, std::size_t c, const std::vector<Index>& ids) noexcept {
    const Cell& cell = from.cells[c];
    const SeenTile& seen = from.tiles[cell.tile];
    const bool is_mirrored = CellKind<N>(cell.kind).is_mirrored() != built_.symmetries().is_mirror(seen.symmetry);
    const bool flip = flip_ != is_mirrored;
    const std::vector<std::uint16_t>& stored = seen.tile->simplices;
    auto* out = room_.simplices + (from.simplices[c] - from.simplices.front());
    for (std::size_t s = 0; s < stored.size(); s += N, ++out) {
      for (std::size_t j = 0; j < N; ++j) (*out)[j] = ids[stored[s + j]];
      if (flip) std::swap((*out)[N - 2], (*out)[N - 1]);
    }
  }

  SampleSource<N>& source_;
  const ExtractOptions& options_;
  ContourOutput<N, Real>& output_;
  std::uint64_t max_vertices_;
  ProgressReporter reporter_;
  bool flip_;
  RowShape<N> shape_;
  Placement<N, Real> placement_;
  CubeFaces cube_;
  GridCells<N> grid_cells_;
  CellFinder<N> finder_;
  Workers<Nothing> workers_;
  BuiltTiles built_;
  std::array<TileLayer, 3> layers_;  ///< layer k at index k modulo size
  std::array<TileSlab, 2> slabs_;
  std::array<TilesWithoutValues<N>, 3> missing_;  ///< of slab k at index k modulo size
  bool any_missing_ = false;
  std::mutex touching_mutex_;
  std::vector<Index> touching_;  ///< see `touching`
  std::size_t next_ = 0;         ///< next layer to process
  std::size_t prepared_ = 0;     ///< number of layers prepared
  std::size_t reach_ = 0;        ///< additional layers that a custom estimator reads
  std::vector<std::vector<Cell>> by_row_;
  std::optional<FaceEstimator<N>> estimator_;  ///< if ambiguities are resolved from the data
  std::optional<TileChoices<N>> choices_;
  std::vector<TileKey> keys_;  ///< by cell of the current slab, if ambiguities are resolved from the data
  std::uint64_t vertices_ = 0;
  std::uint64_t simplices_ = 0;
  std::uint64_t part_first_ = 0, part_end_ = 0;  ///< vertices of the current part
  typename ContourOutput<N, Real>::Room room_{};
  NonmanifoldCandidates no_candidates_;
};

/// A contour in memory, or only its size.
template <int N, class Real>
class BuiltContour final : public ContourOutput<N, Real> {
 public:
  using typename ContourOutput<N, Real>::Room;
  BuiltContour(Contour<N, Real>* contour, bool normals) : contour_(contour), normals_(normals) {}

  Room open(const ContourPart& part) override {
    if (contour_ == nullptr) return {nullptr, nullptr};
    resize_output(contour_->vertices, part.end_vertex, part.done);
    if (normals_) resize_output(contour_->normals, part.end_vertex, part.done);
    resize_output(contour_->simplices, part.end_simplex, part.done);
    return {contour_->vertices.data() + part.first_vertex, contour_->simplices.data() + part.first_simplex,
            normals_ ? contour_->normals.data() + part.first_vertex : nullptr};
  }
  void finish(const ContourPart& all, const Caps<N, Real>* /*caps*/,
              const NonmanifoldCandidates& /*nonmanifold*/) override {
    size = {all.end_vertex, all.end_simplex};
  }

  ContourSize size;

 private:
  Contour<N, Real>* contour_;
  bool normals_;
};

/// What an extraction without tables reports.
struct BuiltResult {
  ExtractStats stats = {};
  bool any_missing = false;
  std::vector<Index> touching = {};  ///< vertices at which the contour may touch itself
};

/// Extracts into `output`. An image without tiles leaves it empty.
template <int N, class Real>
BuiltResult build_tiles(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options,
                        BuiltContour<N, Real>& output, std::size_t tile_bytes, const ExtractPlan& plan) {
  if (SteppedExtraction<N, Real>::tiles_of(grid) == 0) return {};
  TileExtraction<N, Real> extraction(source, grid, options, output, tile_bytes, plan);
  extraction.run();
  return {extraction.stats(), extraction.any_missing(), extraction.touching()};
}

}  // namespace

template <int N, class Real>
Extraction<N, Real> extract_tiles(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options,
                                  std::size_t tile_bytes, const ExtractPlan& plan) {
  Extraction<N, Real> result;
  for (int a = 0; a < N; ++a) {
    result.contour.axis_names[a] = grid.axes[a].name;
    result.contour.axis_units[a] = grid.axes[a].unit;
  }
  result.contour.direction = options.direction;
  BuiltContour<N, Real> output(&result.contour, options.normals != Normals::none);
  BuiltResult built = build_tiles(source, grid, options, output, tile_bytes, plan);
  result.stats = built.stats;
  if (!built.touching.empty()) {
    Stopwatch watch;
    // The extraction has reported 1: only cancelling is new.
    split_nonmanifold(result.contour, built.touching, plan.max_vertices,
                      {options.work.threads, part_of(options.work.progress, 1.0, 1.0)});
    watch.add_to(result.stats.generate_seconds);
  }
  return result;
}

template <int N>
ExtractedSize count_tiles(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options) {
  BuiltContour<N, float> output(nullptr, options.normals != Normals::none);
  const BuiltResult built = build_tiles(source, grid, options, output, kBuiltTileBytes, {});
  if (!built.any_missing) return {output.size, built.stats};
  ExtractOptions without_normals = options;
  without_normals.normals = Normals::none;
  const auto [contour, stats] = extract_tiles<N, float>(source, grid, without_normals);
  return {{contour.vertices.size(), contour.simplices.size()}, stats};
}

#define TEGL_INSTANTIATE(N, Real)                                                                              \
  template Extraction<N, Real> extract_tiles<N, Real>(SampleSource<N>&, const Grid<N>&, const ExtractOptions&, \
                                                      std::size_t, const ExtractPlan&);
TEGL_INSTANTIATE(2, double)
TEGL_INSTANTIATE(3, double)
TEGL_INSTANTIATE(4, float)
TEGL_INSTANTIATE(4, double)
TEGL_INSTANTIATE(5, float)
TEGL_INSTANTIATE(5, double)
template ExtractedSize count_tiles<5>(SampleSource<5>&, const Grid<5>&, const ExtractOptions&);
#undef TEGL_INSTANTIATE

}  // namespace tegl::detail
