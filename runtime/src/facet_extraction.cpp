// SPDX-License-Identifier: BSD-3-Clause
//
// From bits to facets: find the faces that the contour passes, count their facets, give them numbers, and look up by
// number what bounds each. Every facet is found in the face of the grid that it lies in, once; that its boundary lies
// in that face's own faces is all there is to know about neighbours.
#include "facet_extraction.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "extract_cell.hpp"
#include "extract_kernel.hpp"
#include "extract_place.hpp"
#include "extract_progress.hpp"
#include "facet_pinches.hpp"
#include "facet_rows.hpp"
#include "facet_tables.hpp"
#include "workers.hpp"

namespace tegl::detail {
namespace {

/// What a thread keeps.
struct FacetScratch {
  std::vector<std::uint32_t> at;
  std::vector<std::ptrdiff_t> rows;
  std::vector<double> alphas, end;
  std::array<std::vector<double>, 4> start;
  NormalScratch normals;
};

/// Calls visit(i) for each bit set in a row.
template <class Visit>
void for_bits(const Word* bits, std::size_t words, const Visit& visit) {
  for (std::size_t w = 0; w < words; ++w)
    for (Word rest = bits[w]; rest != 0; rest &= rest - 1)
      visit(w * kWordBits + static_cast<std::size_t>(std::countr_zero(rest)));
}

/// A kind of faces, with what is known of it beforehand.
struct KnownKind : FaceKind {
  /// One of a face's own faces, or of an outward one the face itself.
  struct Sub {
    const FaceNumbers* numbers = nullptr;
    std::size_t rows = 0, ahead = 0;
  };
  FaceCorners corners;
  FaceNumbers* numbers = nullptr;
  std::array<Sub, 2 * FacetTables::kMaxDim> subs;  ///< by FacetEntry::face
};

template <int N, class Real>
class FacetExtraction {
 public:
  FacetExtraction(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options)
      : source_(source),
        options_(options),
        flip_(against_tables(grid, options)),
        reporter_(options.progress, kPasses, "passes"),
        rows_(grid.sizes()),
        tables_(options.ambiguity),
        placement_(grid),
        workers_(options.threads, [] { return FacetScratch(); }) {
    if (options.normals) placement_.want_normals(source, grid, options);
    faces_.resize(2u << N);
    for (unsigned axes = 1; axes <= kAll; ++axes) add_kind({axes, false});
    if (options.close)
      for (unsigned axes = 0; axes < kAll; ++axes) add_kind({axes, true});
    facets_.sizes = grid.sizes();
    facets_.direction = options.direction;
    for (int a = 0; a < N; ++a) {
      facets_.axis_names[a] = grid.axes[a].name;
      facets_.axis_units[a] = grid.axes[a].unit;
    }
  }

  FacetHierarchy<N, Real> run() {
    classify();
    find_faces();
    count_facets();
    number_facets();
    for (unsigned dim = 1; dim <= N; ++dim) write_facets(dim);
    write_points();
    if (rows_.any_missing())
      separate_facets(facets_, [this](const FacetPlace& place) {
        return !rows_.is_surrounded(place.axes, static_cast<std::size_t>(place.base / rows_.size(0)),
                                    static_cast<std::size_t>(place.base % rows_.size(0)));
      });
    reporter_.tell(kPasses);
    return std::move(facets_);
  }

 private:
  static constexpr unsigned kAll = (1u << N) - 1;
  static constexpr std::size_t kGrain = 16;       ///< rows
  static constexpr std::size_t kPasses = N + 4u;  ///< classify, find, count, points; one for each dimension
  using Level = typename FacetHierarchy<N, Real>::Level;
  using Vertex = std::array<Real, N>;

  void add_kind(const FaceKind& kind) {
    KnownKind& known = kinds_.emplace_back();
    static_cast<FaceKind&>(known) = kind;
    known.corners = rows_.corners_of(kind);
    known.numbers = &faces(kind);
    known.numbers->reset(rows_.rows(), rows_.words());
    for (unsigned j = 0; j < kind.grid_dim(); ++j)
      for (std::size_t side = 0; side < 2; ++side) {
        const unsigned axis = kind.axis(j);
        known.subs[2 * j + side] = {&faces({kind.axes & ~(1u << axis), kind.outward}),
                                    axis == 0 ? 0 : side * rows_.stride(axis), axis == 0 ? side : 0};
      }
    if (kind.outward) known.subs[2 * kind.grid_dim()] = {&faces({kind.axes, false}), 0, 0};
  }
  FaceNumbers& faces(const FaceKind& kind) noexcept { return faces_[kind.axes | (kind.outward ? kAll + 1 : 0)]; }
  /// Nobody asks for the numbers of facets that bound no others.
  static bool is_top(const FaceKind& kind) noexcept { return kind.dim() == N; }

  /// work(row, scratch) for all rows: a pass.
  template <class Work>
  void for_rows(const Work& work) {
    reporter_.begin_batch(pass_, pass_ + 1, 1);
    ++pass_;
    reporter_.begin_pass(rows_.rows());
    workers_.for_range(rows_.rows(), kGrain, [&](std::size_t from, std::size_t to, FacetScratch& scratch) {
      for (std::size_t next; from < to && !reporter_.stopped(); from = next) {
        next = std::min(to, from + kGrain);
        for (std::size_t row = from; row < next; ++row) work(row, scratch);
        reporter_.add(next - from);
      }
    });
  }
  /// The same for rows with facets.
  template <class Work>
  void for_busy_rows(const Work& work) {
    for_rows([&](std::size_t row, FacetScratch& scratch) {
      if (busy_[row] != 0) work(row, scratch);
    });
  }

  void classify() {
    std::vector<Word> missing(rows_.rows() * rows_.pitch(), 0);
    std::atomic<bool> any_missing = false;
    source_.keep(rows_.size(N - 1));
    for (std::size_t k = 0; k < rows_.size(N - 1); ++k) source_.prepare(k);
    for_rows([&](std::size_t row, FacetScratch&) {
      if (source_.classify(rows_.index_of(row), 1, {rows_.high(row), rows_.pitch()},
                           {missing.data() + row * rows_.pitch(), rows_.pitch()}) != 0)
        any_missing = true;
    });
    if (any_missing) rows_.set_missing(std::move(missing));
  }

  /// Bits, and of tesseracts the signatures.
  void find_faces() {
    busy_.assign(rows_.rows(), 0);
    if (N == FacetTables::kMaxDim) met_.resize(1u << (1u << FacetTables::kMaxDim));
    for_rows([&](std::size_t row, FacetScratch&) {
      const auto index = rows_.index_of(row);
      Word any = 0;
      for (const KnownKind& kind : kinds_) {
        if (!rows_.has_faces(index, kind.axes)) continue;
        Word* const bits = kind.numbers->bits.data() + row * rows_.words();
        Word any_of_kind = 0;
        for (std::size_t w = 0; w < rows_.words(); ++w)
          any_of_kind |= bits[w] = rows_.critical(kind, kind.corners, row, index, w);
        any |= any_of_kind;
        if (kind.dim() != FacetTables::kMaxDim || any_of_kind == 0) continue;
        for_bits(bits, rows_.words(), [&](std::size_t i) {
          std::atomic_ref(met_[rows_.signature(kind.corners, row, i)]).store(1, std::memory_order_relaxed);
        });
      }
      busy_[row] = any != 0 ? 1 : 0;
    });
    for (const KnownKind& kind : kinds_)
      if (!is_top(kind)) kind.numbers->rank();
  }

  /// By row.
  void count_facets() {
    std::vector<std::uint16_t> signatures;
    for (std::size_t s = 0; s < met_.size(); ++s)
      if (met_[s] != 0) signatures.push_back(static_cast<std::uint16_t>(s));
    if (N == FacetTables::kMaxDim) tables_.add_tesseracts(signatures);
    for_busy_rows([&](std::size_t row, FacetScratch&) {
      for (const KnownKind& kind : kinds_) {
        FaceNumbers& here = *kind.numbers;
        std::uint64_t count = 0, entries = 0;
        for_bits(here.bits.data() + row * rows_.words(), rows_.words(), [&](std::size_t i) {
          const unsigned signature = kind.dim() == 1 ? 1 : rows_.signature(kind.corners, row, i);
          count += tables_.count(kind.dim(), signature);
          entries += tables_.entry_count(kind.dim(), signature);
        });
        here.first_facet[row] = count;
        here.first_entry[row] = entries;
      }
    });
  }

  /// From counts to numbers: layer by layer, row by row, kind by kind; caps last.
  void number_facets() {
    std::array<std::uint64_t, N> facets{}, entries{};
    const std::size_t layer_rows = rows_.stride(N - 1);
    for (const bool outward : {false, true})
      for (std::size_t first = 0; first < rows_.rows(); first += layer_rows)
        for (const unsigned across : {0u, 1u})
          for (std::size_t row = first; row < first + layer_rows; ++row)
            for (const KnownKind& kind : kinds_) {
              if (busy_[row] == 0) break;
              if (kind.outward != outward || (kind.axes >> (N - 1) & 1u) != across) continue;
              FaceNumbers& here = *kind.numbers;
              const std::size_t k = kind.dim() - 1;
              facets[k] += std::exchange(here.first_facet[row], facets[k]);
              entries[k] += std::exchange(here.first_entry[row], entries[k]);
            }
    for (std::size_t k = 0; k < N; ++k) {
      check_number(facets[k], "facets", k);
      check_number(entries[k], "incidences", k);
      Level& level = facets_.levels[k];
      level.places.resize(facets[k]);
      if (k == 0) continue;
      level.down_first.resize(facets[k] + 1);
      level.down_first[facets[k]] = static_cast<Index>(entries[k]);
      level.down.resize(entries[k]);
      level.down_signs.resize(entries[k]);
    }
  }
  static void check_number(std::uint64_t number, const char* what, std::size_t k) {
    if (number > std::numeric_limits<Index>::max())
      throw Error(ErrorCode::TooLarge, fmt::format("{} {} of dimension {}; expected at most {}", number, what, k,
                                                   std::numeric_limits<Index>::max()));
  }

  /// Of all kinds that are faces of this dimension; after those of the dimension before.
  void write_facets(unsigned dim) {
    for_busy_rows([&](std::size_t row, FacetScratch&) {
      for (const KnownKind& kind : kinds_)
        if (kind.dim() == dim) write_row(kind, row);
    });
  }

  void write_row(const KnownKind& kind, std::size_t row) {
    FaceNumbers& here = *kind.numbers;
    const unsigned k = kind.dim() - 1;
    Level& level = facets_.levels[k];
    auto facet = static_cast<Index>(here.first_facet[row]);
    auto entry = static_cast<Index>(here.first_entry[row]);
    Index* first = is_top(kind) ? nullptr : here.first_of_row(row);
    for_bits(here.bits.data() + row * rows_.words(), rows_.words(), [&](std::size_t i) {
      const unsigned signature = rows_.signature(kind.corners, row, i);
      if (first != nullptr) *first++ = facet;
      const unsigned count = tables_.count(kind.dim(), signature);
      const bool turn = is_top(kind) && flip_ != is_mirrored(kind, row, i);
      for (unsigned number = 0; number < count; ++number, ++facet) {
        level.places[facet] = {row * std::uint64_t{rows_.size(0)} + i, static_cast<std::uint16_t>(signature),
                               static_cast<std::uint8_t>(kind.axes), static_cast<std::uint8_t>(number), kind.outward};
        if (k == 0) continue;
        level.down_first[facet] = entry;
        const auto entries = tables_.entries(kind.dim(), signature, number);
        for (std::size_t e = 0; e < entries.size(); ++e, ++entry) {
          const FacetEntry& bound = entries[turn ? entries.size() - 1 - e : e];
          const KnownKind::Sub& sub = kind.subs[bound.face];
          level.down[entry] = sub.numbers->first(row + sub.rows, i + sub.ahead) + bound.number;
          level.down_signs[entry] = turn ? static_cast<std::int8_t>(-bound.sign) : bound.sign;
        }
      }
    });
  }

  /// Of outward faces of N - 1 axes: whether these, and one that points outwards, are a mirror image of the grid's.
  bool is_mirrored(const FaceKind& kind, std::size_t row, std::size_t i) const noexcept {
    if (!kind.outward) return false;
    const auto across = static_cast<unsigned>(std::countr_one(kind.axes));
    const bool is_lower = (across == 0 ? i : rows_.index_of(row)[across]) == 0;
    return ((N - 1 - across) % 2 != 0) != is_lower;
  }

  void write_points() {
    facets_.vertices.resize(facets_.count(0));
    if (options_.normals) facets_.normals.resize(facets_.count(0));
    for_busy_rows([&](std::size_t row, FacetScratch& scratch) {
      for (const KnownKind& kind : kinds_) {
        if (kind.dim() != 1) continue;
        if (kind.outward)
          write_corners(kind, row);
        else
          write_edges(kind, row, scratch);
      }
    });
  }

  /// The samples of a row that are corners of caps.
  void write_corners(const KnownKind& kind, std::size_t row) {
    const FaceNumbers& here = *kind.numbers;
    auto index = rows_.index_of(row);
    auto vertex = static_cast<std::size_t>(here.first_facet[row]);
    for_bits(here.bits.data() + row * rows_.words(), rows_.words(), [&](std::size_t i) {
      index[0] = i;
      std::array<double, N> point;
      for (int a = 0; a < N; ++a) point[a] = placement_.sample(a, index[a]);
      facets_.vertices[vertex] = placement_.world(point);
      if (options_.normals)
        facets_.normals[vertex] = placement_.normals()->template in_cell<CellFrame<N, 0>>(index, {});
      ++vertex;
    });
  }

  /// The points on the edges of a row along one axis.
  void write_edges(const KnownKind& kind, std::size_t row, FacetScratch& scratch) {
    FaceNumbers& here = *kind.numbers;
    const Word* const bits = here.bits.data() + row * rows_.words();
    std::size_t count = 0;
    for (std::size_t w = 0; w < rows_.words(); ++w) count += static_cast<std::size_t>(std::popcount(bits[w]));
    if (count == 0) return;
    constexpr std::size_t kMargin = 16;  // what is read and written behind the lists
    const auto index = rows_.index_of(row);
    const auto axis = static_cast<int>(kind.axis(0));
    std::ptrdiff_t offset = 0;
    const auto strides = source_.strides();
    for (int a = 1; a + 1 < N; ++a) offset += static_cast<std::ptrdiff_t>(index[a]) * strides[a];
    scratch.at.resize(count + kMargin);
    list_bits(bits, rows_.words(), scratch.at.data());
    scratch.rows.assign(count + kMargin, offset);
    scratch.alphas.resize(count + kMargin);
    source_.edge_alphas(index[N - 1], axis, {scratch.rows.data(), scratch.at.data(), count}, scratch.alphas.data());
    EdgePoints<N, Real> points{};
    points.at = scratch.at.data();
    points.alphas = scratch.alphas.data();
    points.count = count;
    points.axis = axis;
    for (int a = 1; a + 1 < N; ++a) {
      scratch.start[a].assign(count + kMargin, placement_.sample(a, index[a]));
      points.start[a] = scratch.start[a].data();
      if (a == axis) scratch.end.assign(count + kMargin, placement_.sample(a, index[a] + 1));
    }
    points.end = scratch.end.data();
    points.out = facets_.vertices.data() + here.first_facet[row];
    placement_.edges(index[N - 1], points);
    if (!options_.normals) return;
    placement_.normals()->edges(index, axis, {scratch.rows.data(), scratch.at.data(), count}, scratch.alphas.data(),
                                scratch.normals, facets_.normals.data() + here.first_facet[row], [&](std::size_t edge) {
                                  auto start = index;
                                  start[0] = scratch.at[edge];
                                  return start;
                                });
  }

  SampleSource<N>& source_;
  const ExtractOptions& options_;
  bool flip_;
  ProgressReporter reporter_;
  std::size_t pass_ = 0;
  GridRows<N> rows_;
  FacetTables tables_;
  Placement<N, Real> placement_;
  Workers<FacetScratch> workers_;
  std::vector<KnownKind> kinds_;
  std::vector<FaceNumbers> faces_;  ///< by axes, those of outward ones after the others
  std::vector<std::uint8_t> busy_;  ///< by row: whether any face in it has facets
  std::vector<std::uint8_t> met_;   ///< by signature of a tesseract
  FacetHierarchy<N, Real> facets_;
};

}  // namespace

template <int N, class Real>
FacetHierarchy<N, Real> extract_facets(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options) {
  require_consistent_method(options, "facets");
  const auto sizes = grid.sizes();
  if (*std::min_element(sizes.begin(), sizes.end()) < 2) {
    FacetHierarchy<N, Real> none;
    none.sizes = sizes;
    none.direction = options.direction;
    for (int a = 0; a < N; ++a) {
      none.axis_names[a] = grid.axes[a].name;
      none.axis_units[a] = grid.axes[a].unit;
      if (a > 0) none.levels[a].down_first.assign(1, 0);
    }
    return none;
  }
  return FacetExtraction<N, Real>(source, grid, options).run();
}

#define TEGL_INSTANTIATE(N, Real) \
  template FacetHierarchy<N, Real> extract_facets<N, Real>(SampleSource<N>&, const Grid<N>&, const ExtractOptions&);
TEGL_INSTANTIATE(2, float)
TEGL_INSTANTIATE(2, double)
TEGL_INSTANTIATE(3, float)
TEGL_INSTANTIATE(3, double)
TEGL_INSTANTIATE(4, float)
TEGL_INSTANTIATE(4, double)

}  // namespace tegl::detail
