// SPDX-License-Identifier: BSD-3-Clause
//
// The extraction without tables, slab by slab along the last axis. What a slab takes: find its cells (tiles that are
// active, and caps), build the tiles whose signatures are new, number the vertices face by face, write. See
// extract_layers.hpp for the words.
#include "extract_tiles.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "built_tile.hpp"
#include "extract_cell.hpp"
#include "extract_place.hpp"
#include "extract_progress.hpp"
#include "face_ranks.hpp"
#include "grid_cells.hpp"
#include "stopwatch.hpp"
#include "tile_choices.hpp"
#include "tile_places.hpp"
#include "workers.hpp"

namespace tegl::detail {
namespace {

/// A tile or cap with a contour.
struct Cell {
  std::uint64_t signature;
  std::uint32_t row, i;    ///< its first sample
  std::uint32_t tile = 0;  ///< number of the built tile
  std::uint8_t kind;
};

/// The samples against the isovalue, and the faces with vertices among those within the layer.
struct TileLayer {
  std::vector<Word> high;
  FaceRanks faces;
};

/// Between two layers.
struct TileSlab {
  std::vector<Cell> cells;
  std::vector<SeenTile> tiles;
  std::vector<std::uint64_t> simplices;  ///< by cell: the first one's number
  FaceRanks faces;
};

/// Finds the cells of a slab that have a contour.
template <int N>
class CellFinder {
 public:
  /// `closed`: the axes across which borders have caps.
  CellFinder(const RowShape<N>& shape, unsigned closed) : shape_(shape), closed_(closed) {}

  /// The cells that start in a row of slab k, between `layers`, kind by kind.
  void find(std::size_t k, const std::array<const Word*, 2>& layers, std::size_t row, std::vector<Cell>& out) const {
    const auto index = shape_.index_of(row);
    if (shape_.has_cells(index, kAll)) sweep(CellKind<N>(0), layers, row, kRowOfCells, out);
    for (int axis = 0; axis < N; ++axis)
      for (unsigned side = 0; side < 2; ++side) {
        if ((closed_ >> axis & 1u) == 0 || !shape_.has_cells(index, kAll ^ 1u << axis)) continue;
        const CellKind<N> kind(axis, side);
        if (axis == 0) {
          sweep(kind, layers, row, side == 0 ? 0 : shape_.size(0) - 1, out);
        } else if (axis == N - 1) {
          if (side == 0 ? k == 0 : k + 2 == shape_.layers())
            sweep(kind, {layers[side], nullptr}, row, kRowOfCells, out);
        } else if (index[axis] == (side == 0 ? 0 : shape_.size(axis) - 1)) {
          sweep(kind, layers, row, kRowOfCells, out);
        }
      }
  }

 private:
  static constexpr unsigned kAll = (1u << N) - 1;
  static constexpr std::size_t kRowOfCells = ~std::size_t{0};

  /// `only`: the one sample that a cell may start at; kRowOfCells: cells along the row.
  void sweep(CellKind<N> kind, const std::array<const Word*, 2>& layers, std::size_t row, std::size_t only,
             std::vector<Cell>& out) const {
    struct Corner {
      const Word* row;
      unsigned ahead;
    };
    std::array<Corner, kAll + 1> corners;
    for (unsigned c = 0; c < kind.corners(); ++c) {
      const unsigned shift = kind.spread(c);
      corners[c] = {layers[shift >> (N - 1)] + shape_.shifted(row, shift) * shape_.pitch(), shift & 1u};
    }
    for (std::size_t w = 0; w < shape_.words(); ++w) {
      Word any = 0, all = ~Word{0};
      for (unsigned c = 0; c < kind.corners(); ++c) {
        const Word* const at = corners[c].row + w;
        const Word word = corners[c].ahead == 0 ? at[0] : at[0] >> 1 | at[1] << (kWordBits - 1);
        any |= word;
        all &= word;
      }
      Word rest = (kind.is_cap() ? any : any & ~all) & shape_.mask(w, only == kRowOfCells);
      if (only != kRowOfCells) rest &= w == only / kWordBits ? Word{1} << (only % kWordBits) : 0;
      for (; rest != 0; rest &= rest - 1) {
        const std::size_t i = w * kWordBits + static_cast<std::size_t>(std::countr_zero(rest));
        std::uint64_t signature = 0;
        for (unsigned c = 0; c < kind.corners(); ++c) {
          const std::size_t sample = i + corners[c].ahead;
          signature |= (corners[c].row[sample / kWordBits] >> (sample % kWordBits) & 1u) << c;
        }
        out.push_back({signature, static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(i), 0,
                       static_cast<std::uint8_t>(kind.number())});
      }
    }
  }

  const RowShape<N>& shape_;
  unsigned closed_;
};

template <int N, class Real>
class TileExtraction {
 public:
  TileExtraction(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options, Contour<N, Real>* contour,
                 std::size_t tile_bytes, const ExtractPlan& plan)
      : source_(source),
        options_(options),
        contour_(contour),
        reporter_(options.progress, grid.axes[N - 1].size() - 1),
        flip_(against_tables(grid, options)),
        shape_(grid.sizes()),
        placement_(grid),
        cube_(N),
        grid_cells_(cube_, options.close),
        finder_(shape_, options.close ? plan.closed_axes : 0),
        workers_(options.threads, [] { return Nothing{}; }),
        built_(cube_, options.ambiguity == Ambiguity::high ? facets::Alternative::high : facets::Alternative::low,
               tile_bytes, workers_.count()) {
    if (options.normals) placement_.want_normals(source, grid, options);
    if (is_estimated(options.ambiguity)) {
      estimator_.emplace(source, grid.sizes(), options, plan.part);
      choices_.emplace(cube_, *estimator_);
    }
  }

  ContourSize run(ExtractStats& stats) {
    const std::size_t slabs = shape_.layers() - 1;
    source_.keep(3);
    Stopwatch watch;
    for (std::size_t k = 0; k <= slabs; ++k) {
      reporter_.begin_batch(k == 0 ? 0 : k - 1, k, passes());
      reporter_.tell(k == 0 ? 0.0 : static_cast<double>(k - 1));
      if (k == 0) classify(0);
      if (k < slabs) classify(k + 1);
      watch.add_to(stats.classify_seconds);
      if (k < slabs) find_cells(k, stats);
      number_vertices(k);
      watch.add_to(stats.find_seconds);
      if (k > 0 && contour_ != nullptr) write(k - 1);
      watch.add_to(stats.generate_seconds);
    }
    reporter_.tell(static_cast<double>(slabs));
    return {vertices_, simplices_};
  }

 private:
  using Vertex = typename Contour<N, Real>::Vertex;
  struct Nothing {};                             ///< that threads keep
  static constexpr std::size_t kMostWork = 256;  ///< cells or tiles between two questions whether to go on
  /// Over a slab: build the next one's tiles, perhaps twice, and twice those whose own choice turns out to matter;
  /// write.
  [[nodiscard]] unsigned passes() const noexcept { return choices_ ? 5 : 3; }
  static constexpr std::size_t kNoCell = ~std::size_t{0};
  static constexpr std::uint32_t kSlabAbove = std::uint32_t{1} << 31;  ///< for cells of the slab above a layer

  TileLayer& layer(std::size_t k) { return layers_[k % layers_.size()]; }
  TileSlab& slab(std::size_t k) { return slabs_[k % slabs_.size()]; }
  /// Calls work(from, to) for parts of 0 ... count - 1.
  template <class Work>
  void for_range(std::size_t count, std::size_t grain, const Work& work) {
    workers_.for_range(count, grain, [&](std::size_t from, std::size_t to, Nothing&) { work(from, to); });
  }

  /// The same as one of the passes whose progress is told.
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
    source_.prepare(k);
    TileLayer& here = layer(k);
    here.high.assign(shape_.rows() * shape_.pitch(), 0);
    here.faces.reset(shape_.rows() * grid_cells_.slots(false) * shape_.words());
    std::vector<std::uint8_t> missing(shape_.rows());
    for_range(shape_.rows(), 64, [&](std::size_t from, std::size_t to) {
      std::vector<Word> ignored(shape_.pitch());
      for (std::size_t row = from; row < to; ++row) {
        auto start = shape_.index_of(row);
        start[N - 1] = k;
        const BitRows high{here.high.data() + row * shape_.pitch(), shape_.pitch()};
        missing[row] = source_.classify(start, 1, high, {ignored.data(), 0}) != 0 ? 1 : 0;
      }
    });
    if (std::find(missing.begin(), missing.end(), 1) != missing.end())
      throw Error(ErrorCode::UnsupportedData,
                  fmt::format("a {}D image with missing values, the first in layer {} of its last axis; expected "
                              "numbers only: contours next to missing values are made up to 4D, barycentric ones in "
                              "4D with ambiguity low or high",
                              N, k));
  }

  void find_cells(std::size_t k, ExtractStats& stats) {
    TileSlab& here = slab(k);
    here.faces.reset(shape_.rows() * grid_cells_.slots(true) * shape_.words());
    const std::array<const Word*, 2> layers = {layer(k).high.data(), layer(k + 1).high.data()};
    by_row_.resize(shape_.rows());
    for_range(shape_.rows(), 16, [&](std::size_t from, std::size_t to) {
      for (std::size_t row = from; row < to; ++row) {
        by_row_[row].clear();
        finder_.find(k, layers, row, by_row_[row]);
      }
    });
    here.cells.clear();
    for (const std::vector<Cell>& cells : by_row_) here.cells.insert(here.cells.end(), cells.begin(), cells.end());
    if (here.cells.size() >= kSlabAbove)
      throw Error(ErrorCode::TooLarge, fmt::format("{} active tiles between two layers; expected less than {}",
                                                   here.cells.size(), kSlabAbove));
    build_tiles(k);
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

  /// The tiles of some cells, by the keys that these have. `cell(i)`: the i-th of them; kNoCell behind the last.
  template <class Cells, class KeyOf>
  void assign_tiles(TileSlab& here, const Cells& cell, const KeyOf& key_of) {
    std::vector<TileKey> keys;
    std::size_t count = 0;
    for (; cell(count) != kNoCell; ++count) {
      keys.push_back(key_of(cell(count)));
      if (keys.size() == keys.capacity()) make_unique(keys);
    }
    make_unique(keys);
    const std::size_t before = here.tiles.size();
    auto tiles = built_.get(keys, [this](std::size_t n, const auto& work) { this->pass_over(n, 16, work); });
    here.tiles.insert(here.tiles.end(), tiles.begin(), tiles.end());
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

  /// What the data say of the cells' faces, and of tiles with ambiguous faces.
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

  /// The same of tiles that turn out to have something to choose though none of their faces has.
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

  /// The sample that a cell of slab k starts from.
  typename RowShape<N>::Index base_of(const Cell& cell, std::size_t k) const noexcept {
    const CellKind<N> kind(cell.kind);
    auto base = shape_.index_of(cell.row);
    base[0] = cell.i;
    base[N - 1] = k + (kind.across() == N - 1 ? kind.side() : 0);
    return base;
  }

  /// Calls visit(faces, word, bit, vertices, cell number, face) for the faces of a cell with vertices.
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
  /// The number of a built tile's face in the cell.
  [[nodiscard]] std::uint16_t seen_face(const SeenTile& seen, std::size_t face) const noexcept {
    const CubeFaces::Cell& built = cube_.cells()[face];
    const unsigned axes = built_.symmetries().axes(seen.symmetry, built.axes);
    return cube_.number(built_.symmetries().base(seen.symmetry, built.base, axes), axes);
  }
  template <class Visit>
  void for_faces(std::size_t k, const Visit& visit) {
    for_range(slab(k).cells.size(), 64, [&](std::size_t from, std::size_t to) {
      for (std::size_t c = from; c < to; ++c) for_faces_of(k, c, visit);
    });
  }

  /// How a face knows cell c of the slab at hand.
  static std::uint32_t owner_name(const FaceRanks& faces, const TileLayer& lower, std::size_t c) {
    return static_cast<std::uint32_t>(c) | (&faces == &lower.faces ? kSlabAbove : 0);
  }

  /// Of layer k and slab k, whose faces are known once the cells of slabs k - 1 and k are.
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
    vertices_ = layer(k).faces.number(vertices_);
    if (has_slab) vertices_ = slab(k).faces.number(vertices_);
    if (contour_ != nullptr) check_vertex_count(vertices_, kMaxVertices);
  }

  void write(std::size_t k) {
    const double done = static_cast<double>(k + 1) / static_cast<double>(shape_.layers() - 1);
    resize_output(contour_->vertices, vertices_, done);
    if (options_.normals) resize_output(contour_->normals, vertices_, done);
    resize_output(contour_->simplices, slab(k).simplices.back(), done);
    pass_over(slab(k).cells.size(), 16, [&](std::size_t from, std::size_t to) {
      TilePlaces<N> places(cube_, built_.symmetries());
      std::vector<Index> ids;
      for (std::size_t c = from; c < to; ++c) {
        write_vertices(k, c, places, ids);
        write_simplices(slab(k), c, ids);
      }
    });
    if (estimator_) estimator_->rethrow();
  }

  /// Numbers all vertices of a cell, and writes those of the faces that it owns.
  void write_vertices(std::size_t k, std::size_t c, TilePlaces<N>& places, std::vector<Index>& ids) {
    const Cell& cell = slab(k).cells[c];
    const SeenTile& seen = slab(k).tiles[cell.tile];
    const CellKind<N> kind(cell.kind);
    const auto base = base_of(cell, k);
    places.begin(seen, kind.is_cap() ? N - 1 : -1);
    ids.resize(seen.tile->vertices.size());
    for_faces_of(k, c,
                 [&](FaceRanks& faces, std::size_t word, unsigned bit, const BuiltTile::FaceVertices& vertices,
                     std::size_t, std::uint16_t face) {
                   // Cells around a face agree on it, unless a caller's estimator does not.
                   if (estimator_ && vertices.count != faces.count(word, bit)) return estimator_->report_change(base);
                   number_face(seen, vertices, faces.first(word, bit), ids);
                   if (cube_.cells()[face].dim == 1) places.set_edge(vertices.first, alpha(kind, base, face));
                   if (faces.owner(word, bit) != owner_name(faces, layer(k), c)) return;
                   for (std::size_t v = vertices.first; v < std::size_t{vertices.first} + vertices.count; ++v) {
                     const auto place = in_grid(kind, places(v));
                     contour_->vertices[ids[v]] = point(kind, base, place);
                     if (options_.normals)
                       contour_->normals[ids[v]] =
                           placement_.normals()->template in_cell<CellFrame<N, (1u << N) - 1>>(base, place);
                   }
                 });
  }

  /// The numbers of a face's vertices, the same for all cells around it.
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

  /// The place of the point on an edge of a cell. That of a cap is at the sample that the edge starts from.
  double alpha(CellKind<N> kind, const typename RowShape<N>::Index& base, std::size_t edge) {
    const CubeFaces::Cell& face = cube_.cells()[edge];
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

  /// From the axes of a cell to those of the grid.
  static TilePoint<N> in_grid(CellKind<N> kind, const TilePoint<N>& place) noexcept {
    if (!kind.is_cap()) return place;
    TilePoint<N> result;
    result[kind.across()] = 0.0;
    for (int j = 0; j + 1 < N; ++j) result[kind.axis(j)] = place[j];
    return result;
  }
  Vertex point(CellKind<N> kind, const typename RowShape<N>::Index& base, const TilePoint<N>& place) const noexcept {
    std::array<double, N> point;
    for (int a = 0; a < N; ++a)
      point[a] = a == kind.across() ? placement_.sample(a, base[a]) : placement_.between(a, base[a], place[a]);
    return placement_.world(point);
  }

  void write_simplices(const TileSlab& from, std::size_t c, const std::vector<Index>& ids) noexcept {
    const Cell& cell = from.cells[c];
    const SeenTile& seen = from.tiles[cell.tile];
    const bool is_mirrored = CellKind<N>(cell.kind).is_mirrored() != built_.symmetries().is_mirror(seen.symmetry);
    const bool flip = flip_ != is_mirrored;
    const std::vector<std::uint16_t>& stored = seen.tile->simplices;
    auto* out = contour_->simplices.data() + from.simplices[c];
    for (std::size_t s = 0; s < stored.size(); s += N, ++out) {
      for (std::size_t j = 0; j < N; ++j) (*out)[j] = ids[stored[s + j]];
      if (flip) std::swap((*out)[N - 2], (*out)[N - 1]);
    }
  }

  SampleSource<N>& source_;
  const ExtractOptions& options_;
  Contour<N, Real>* contour_;
  ProgressReporter reporter_;
  bool flip_;
  RowShape<N> shape_;
  Placement<N, Real> placement_;
  CubeFaces cube_;
  GridCells<N> grid_cells_;
  CellFinder<N> finder_;
  Workers<Nothing> workers_;
  BuiltTiles built_;
  std::array<TileLayer, 3> layers_;  ///< by k modulo their number
  std::array<TileSlab, 2> slabs_;
  std::vector<std::vector<Cell>> by_row_;
  std::optional<FaceEstimator<N>> estimator_;  ///< where the data decide
  std::optional<TileChoices<N>> choices_;
  std::vector<TileKey> keys_;  ///< of the cells of the slab at hand, where the data decide
  std::uint64_t vertices_ = 0;
  std::uint64_t simplices_ = 0;
};

}  // namespace

template <int N, class Real>
ContourSize extract_tiles(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options,
                          Contour<N, Real>* contour, ExtractStats* stats, std::size_t tile_bytes,
                          const ExtractPlan& plan) {
  if (contour != nullptr) {
    for (int a = 0; a < N; ++a) {
      contour->axis_names[a] = grid.axes[a].name;
      contour->axis_units[a] = grid.axes[a].unit;
    }
    contour->direction = options.direction;
  }
  ExtractStats done;
  done.tiles = 1;
  for (const Axis& axis : grid.axes) done.tiles *= axis.size() - 1;
  ContourSize size;
  if (done.tiles != 0) size = TileExtraction<N, Real>(source, grid, options, contour, tile_bytes, plan).run(done);
  if (stats != nullptr) *stats = done;
  return size;
}

#define TEGL_INSTANTIATE(N, Real)                                                                      \
  template ContourSize extract_tiles<N, Real>(SampleSource<N>&, const Grid<N>&, const ExtractOptions&, \
                                              Contour<N, Real>*, ExtractStats*, std::size_t, const ExtractPlan&);
TEGL_INSTANTIATE(2, double)
TEGL_INSTANTIATE(3, double)
TEGL_INSTANTIATE(4, float)
TEGL_INSTANTIATE(4, double)
TEGL_INSTANTIATE(5, float)
TEGL_INSTANTIATE(5, double)
#undef TEGL_INSTANTIATE

}  // namespace tegl::detail
