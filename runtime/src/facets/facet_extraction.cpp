// SPDX-License-Identifier: BSD-3-Clause
//
// Extraction of facets from bits: find the critical faces, count their facets, number them, and look up the boundary of
// each by number. Every facet belongs to one face of the grid, and its boundary lies in that face's own faces, so
// neighbours need no other coordination.
#include "facets/facet_extraction.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "ambiguity/tesseract_decision.hpp"
#include "base/workers.hpp"
#include "builder4_facets.hpp"
#include "facets/facet_rows.hpp"
#include "facets/merge_seam.hpp"
#include "facets/split_facets.hpp"
#include "kernel/extract_cell.hpp"
#include "kernel/extract_kernel.hpp"
#include "kernel/extract_progress.hpp"
#include "kernel/placement.hpp"
#include "kernel/shared_places.hpp"
#include "tegl/generated/tables.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {
namespace {

using builders::FaceFacets;
using builders::FacetEntry;
using builders::FacetView;
using builders::TesseractFacets;

constexpr unsigned kMostAxes = 4;
constexpr unsigned kCubeEdges = tables::edge_count(3);

/// Working memory of a thread.
struct FacetScratch {
  TesseractFacets tesseract;
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

/// A kind of faces with precomputed offsets.
struct KnownKind : FaceKind {
  /// One of a face's own faces; for an outward face also the face itself.
  struct Sub {
    const FaceNumbers* numbers = nullptr;
    std::size_t rows = 0, ahead = 0;
  };
  FaceCorners corners;
  FaceNumbers* numbers = nullptr;
  std::array<Sub, std::size_t{2} * kMostAxes> subs;  ///< by FacetEntry::face
  /// Edges of cubes that are resolved from the data.
  std::array<Sub, kCubeEdges> edges;
  /// Whether facets depend on more than the signature, so that faces have types: those of FaceFacets, and for
  /// tesseracts the sign of the centre.
  bool has_types = false;

  [[nodiscard]] bool is_resolved_cube() const noexcept { return has_types && !outward && grid_dim() == 3; }
};

/// Facets of one dimension, as in FacetHierarchy.
struct NumberedFacets {
  Buffer<FacetPlace> places;
  Buffer<Index> down_first, down;
  Buffer<std::int8_t> down_signs;
};

/// Everything but the coordinates of points, which depends on no type of coordinates.
template <int N>
class FacetExtraction {
 public:
  FacetExtraction(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options, unsigned seam_axes)
      : source_(source),
        options_(options),
        flip_(against_tables(grid, options)),
        is_high_(options.ambiguity == Ambiguity::high),
        passes_(kPasses + (!is_estimated(options.ambiguity) ? 0
                           : N > 2                          ? 2
                                                            : 1)),
        reporter_(options.work.progress, passes_, "passes"),
        rows_(grid.sizes(), kAll & ~seam_axes),
        workers_(options.work.threads, [] { return FacetScratch(); }) {
    if (is_estimated(options.ambiguity)) estimator_.emplace(source, grid.sizes(), options, PartOfImage{});
    faces_.resize(2u << N);
    for (unsigned axes = 1; axes <= kAll; ++axes) add_kind({axes, false});
    if (options.close)
      for (unsigned axes = 0; axes < kAll; ++axes) add_kind({axes, true});
  }

 protected:
  /// Fills `levels_`.
  void find_facets() {
    classify();
    find_faces();
    if (estimator_) resolve_faces();
    count_facets();
    number_facets();
    for (unsigned dim = 1; dim <= N; ++dim) write_facets(dim);
  }

  static constexpr unsigned kAll = (1u << N) - 1;
  static constexpr std::size_t kGrain = 16;  ///< rows
  /// Classify, find, count, points, and one pass per dimension. Up to two more if ambiguities are resolved from the
  /// data.
  static constexpr std::size_t kPasses = N + 4u;
  using RowWork = std::function<void(std::size_t, FacetScratch&)>;

  void add_kind(const FaceKind& kind) {
    KnownKind& known = kinds_.emplace_back();
    static_cast<FaceKind&>(known) = kind;
    known.corners = rows_.corners_of(kind);
    known.numbers = &faces(kind);
    known.numbers->reset(rows_.rows(), rows_.words());
    known.has_types = estimator_.has_value() && kind.grid_dim() > 1;
    if (known.is_resolved_cube()) add_edges(known);
    for (unsigned j = 0; j < kind.grid_dim(); ++j)
      for (std::size_t side = 0; side < 2; ++side) {
        const unsigned axis = kind.axis(j);
        known.subs[2 * j + side] = {&faces({kind.axes & ~(1u << axis), kind.outward}),
                                    axis == 0 ? 0 : side * rows_.stride(axis), axis == 0 ? side : 0};
      }
    if (kind.outward) known.subs[2 * kind.grid_dim()] = {&faces({kind.axes, false}), 0, 0};
  }
  void add_edges(KnownKind& known) {
    for (unsigned e = 0; e < kCubeEdges; ++e) {
      const unsigned base = known.spread(edge_base(3, e));
      known.edges[e] = {&faces({1u << known.axis(e / 4), false}), rows_.shift(base), base & 1u};
    }
    for (auto* list : {&known.numbers->first_point, &known.numbers->first_segment, &known.numbers->first_end})
      list->assign(rows_.rows(), 0);
  }
  FaceNumbers& faces(const FaceKind& kind) noexcept { return faces_[kind.axes | (kind.outward ? kAll + 1 : 0)]; }
  /// Facets of the highest dimension bound no others, so their numbers are not stored.
  static bool is_top(const FaceKind& kind) noexcept { return kind.dim() == N; }

  /// A pass: calls work(row, scratch) for all rows.
  void for_rows(const RowWork& work) {
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
  /// A pass over the rows with facets.
  void for_busy_rows(const RowWork& work) {
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

  /// Finds the bits of critical faces.
  void find_faces() {
    busy_.assign(rows_.rows(), 0);
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
      }
      busy_[row] = any != 0 ? 1 : 0;
    });
    for (const KnownKind& kind : kinds_)
      if (kind.has_types || !is_top(kind)) kind.numbers->rank(kind.has_types);
  }

  /// Resolves ambiguities by the estimator: first squares, then cubes. Tesseracts are resolved when their facets are
  /// counted.
  void resolve_faces() {
    for_busy_rows([&](std::size_t row, FacetScratch&) {
      for (const KnownKind& kind : kinds_) {
        if (!kind.has_types || kind.grid_dim() != 2) continue;
        for_bits(kind.numbers->bits.data() + row * rows_.words(), rows_.words(), [&](std::size_t i) {
          kind.numbers->type(row, i) =
              static_cast<std::uint16_t>(kind.outward ? outward_square_type(kind, row, i) : square_type(kind, row, i));
        });
      }
    });
    estimator_->rethrow();
    if constexpr (N > 2) {
      for_busy_rows([&](std::size_t row, FacetScratch&) {
        for (const KnownKind& kind : kinds_)
          if (kind.is_resolved_cube())
            for_bits(kind.numbers->bits.data() + row * rows_.words(), rows_.words(),
                     [&](std::size_t i) { kind.numbers->type(row, i) = cube_type(kind, row, i); });
      });
      estimator_->rethrow();
    }
  }

  [[nodiscard]] typename GridRows<N>::Index place_of(std::size_t row, std::size_t i) const noexcept {
    auto index = rows_.index_of(row);
    index[0] = i;
    return index;
  }

  [[nodiscard]] unsigned square_type(const KnownKind& kind, std::size_t row, std::size_t i) const noexcept {
    const unsigned signature = rows_.signature(kind.corners, row, i);
    if (!ambiguous_signatures<2>()[signature]) return signature;
    const auto base = place_of(row, i);
    std::array<double, std::size_t{1} << N> values;
    source_.corner_values(base, kind.axes, values.data());
    return FaceFacets::square_type(signature,
                                   estimator_->is_square_high(base, kind.axes, std::span(values).template first<4>()));
  }

  /// An outward cube has low corners outside, and no tunnel.
  [[nodiscard]] unsigned outward_square_type(const KnownKind& kind, std::size_t row, std::size_t i) const noexcept {
    const unsigned signature = rows_.signature(kind.corners, row, i);
    const KnownKind::Sub& inner = kind.subs[4];
    const bool high = ambiguous_signatures<2>()[signature] && inner.numbers->type(row, i) != signature;
    return ResolvedCubes::instance().list(signature, high ? 1u << 4 : 0, tile::Choice::separate);
  }

  [[nodiscard]] std::uint16_t cube_type(const KnownKind& kind, std::size_t row, std::size_t i) const noexcept {
    if constexpr (N > 2) {
      const auto base = place_of(row, i);
      const CubeKey key = cube_key<N>(*estimator_, base, kind.axes, rows_.signature(kind.corners, row, i));
      const unsigned list = list_of_key(key);
      const CubeList& cube = ResolvedCubes::instance().lists()[list];
      if (estimator_->is_callers())
        for (unsigned rest = tables::kTile3Resolved.ambiguous_squares[cube.signature]; rest != 0; rest &= rest - 1) {
          const auto q = static_cast<std::size_t>(std::countr_zero(rest));
          const KnownKind::Sub& square = kind.subs[q];
          const bool is_high = square.numbers->type(row + square.rows, i + square.ahead) > 15;
          if (is_high != ((cube.high_squares >> q & 1u) != 0)) estimator_->report_change(base);
        }
      return static_cast<std::uint16_t>(list);
    }
    return 0;
  }

  /// The facets of a face; valid until the next use of the scratch.
  FacetView facets_of(const KnownKind& kind, std::size_t row, std::size_t i, unsigned signature,
                      FacetScratch& scratch) const {
    if (kind.dim() == 1) return FaceFacets::of_edge();
    if (kind.dim() == 2)
      return FaceFacets::of_square(kind.has_types ? kind.numbers->type(row, i)
                                                  : FaceFacets::square_type(signature, is_high_));
    if (kind.dim() == 3) return FaceFacets::of_cube(list_of(kind, row, i, signature));
    if (kind.has_types) {
      begin_tesseract(kind, row, i, signature, scratch.tesseract);
      return scratch.tesseract.joined(static_cast<std::uint16_t>(signature),
                                      static_cast<tile::Choice>(kind.numbers->type(row, i)));
    }
    ResolvedKey key;
    key.squares = is_high_ ? ~std::uint32_t{0} : 0;
    key.signature = static_cast<std::uint16_t>(signature);
    scratch.tesseract.begin(ResolvedTesseract::lists_of(key));
    return scratch.tesseract.separate();
  }
  /// The list of a face of three dimensions.
  unsigned list_of(const KnownKind& kind, std::size_t row, std::size_t i, unsigned signature) const {
    return kind.has_types ? kind.numbers->type(row, i) : FaceFacets::cube_type(signature, is_high_);
  }

  /// For faces of four dimensions. Returns the number of components of Sigma.
  std::size_t begin_tesseract(const KnownKind& kind, std::size_t row, std::size_t i, unsigned signature,
                              TesseractFacets& tesseract) const {
    ResolvedCubes::Lists cubes;
    const std::uint64_t signatures = ResolvedCubes::instance().signatures(static_cast<std::uint16_t>(signature));
    for (unsigned f = 0; f < 8; ++f) {
      const auto of_cube = static_cast<unsigned>(signatures >> (8 * f) & 255u);
      const KnownKind::Sub& sub = kind.subs[f];
      cubes[f] =
          of_cube == 0 || of_cube == 255 ? ResolvedCubes::kNone : sub.numbers->type(row + sub.rows, i + sub.ahead);
    }
    return tesseract.begin(cubes);
  }

  /// Resolves a tesseract and returns its facets. Called once, when they are counted.
  FacetView resolved_facets(const KnownKind& kind, std::size_t row, std::size_t i, unsigned signature,
                            FacetScratch& scratch) const {
    auto choice = tile::Choice::separate;
    if (begin_tesseract(kind, row, i, signature, scratch.tesseract) > 1 && !kind.outward) {
      const auto base = place_of(row, i);
      std::array<double, std::size_t{1} << N> values;
      source_.corner_values(base, kind.axes, values.data());
      choice = estimator_->choice(base, kind.axes, values);
    }
    kind.numbers->type(row, i) = static_cast<std::uint16_t>(choice);
    return scratch.tesseract.joined(static_cast<std::uint16_t>(signature), choice);
  }

  /// Counts the facets by row.
  void count_facets() {
    for_busy_rows([&](std::size_t row, FacetScratch& scratch) {
      for (const KnownKind& kind : kinds_) count_row(kind, row, scratch);
    });
    if (estimator_) estimator_->rethrow();
  }

  void count_row(const KnownKind& kind, std::size_t row, FacetScratch& scratch) {
    FaceNumbers& here = *kind.numbers;
    for_bits(here.bits.data() + row * rows_.words(), rows_.words(), [&](std::size_t i) {
      const unsigned signature = kind.dim() == 1 ? 1 : rows_.signature(kind.corners, row, i);
      const FacetView facets = kind.has_types && kind.dim() == kMostAxes
                                   ? resolved_facets(kind, row, i, signature, scratch)
                                   : facets_of(kind, row, i, signature, scratch);
      here.first_facet[row] += facets.count();
      here.first_entry[row] += facets.entry_count();
      if (!kind.is_resolved_cube()) return;
      const FaceFacets::Inside inside = FaceFacets::inside(here.type(row, i));
      here.first_point[row] += inside.points.size();
      here.first_segment[row] += inside.segments.size();
      here.first_end[row] += 2 * inside.segments.size();
    });
  }

  /// Prefix sums of the counts: by layer, row and kind; caps last. Then allocates the levels.
  void number_facets() {
    // exclusive scan
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
              if (!kind.is_resolved_cube()) continue;
              facets[0] += std::exchange(here.first_point[row], facets[0]);
              facets[1] += std::exchange(here.first_segment[row], facets[1]);
              entries[1] += std::exchange(here.first_end[row], entries[1]);
            }
    // allocate
    for (std::size_t k = 0; k < N; ++k) {
      check_number(facets[k], "facets", k);
      check_number(entries[k], "incidences", k);
      NumberedFacets& level = levels_[k];
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

  /// Writes the facets of all kinds of faces of this dimension, after those of the dimension before.
  void write_facets(unsigned dim) {
    for_busy_rows([&](std::size_t row, FacetScratch& scratch) {
      for (const KnownKind& kind : kinds_)
        if (kind.dim() == dim) write_row(kind, row, scratch);
    });
  }

  void write_row(const KnownKind& kind, std::size_t row, FacetScratch& scratch) {
    FaceNumbers& here = *kind.numbers;
    const unsigned k = kind.dim() - 1;
    NumberedFacets& level = levels_[k];
    auto facet = static_cast<Index>(here.first_facet[row]);
    auto entry = static_cast<Index>(here.first_entry[row]);
    auto segment = kind.is_resolved_cube() ? static_cast<Index>(here.first_segment[row]) : 0;
    Index* first = is_top(kind) ? nullptr : here.first_of_row(row);
    for_bits(here.bits.data() + row * rows_.words(), rows_.words(), [&](std::size_t i) {
      const unsigned signature = rows_.signature(kind.corners, row, i);
      if (first != nullptr) *first++ = facet;
      const FacetView facets = facets_of(kind, row, i, signature, scratch);
      const unsigned count = facets.count();
      const bool turn = is_top(kind) && flip_ != is_mirrored(kind, row, i);
      // each facet and its boundary; turned facets have the reverse order and opposite signs
      for (unsigned number = 0; number < count; ++number, ++facet) {
        level.places[facet] = place(kind, row, i, signature, number);
        if (k == 0) continue;
        level.down_first[facet] = entry;
        const auto entries = facets.entries(number);
        for (std::size_t e = 0; e < entries.size(); ++e, ++entry) {
          const FacetEntry& bound = entries[turn ? entries.size() - 1 - e : e];
          const KnownKind::Sub& sub = kind.subs[bound.face];
          const bool is_inside = bound.face == FaceFacets::kInside && kind.is_resolved_cube();
          const Index first_bound = is_inside ? segment : sub.numbers->first(row + sub.rows, i + sub.ahead);
          level.down[entry] = first_bound + bound.number;
          level.down_signs[entry] = turn ? static_cast<std::int8_t>(-bound.sign) : bound.sign;
        }
      }
      if (kind.is_resolved_cube()) segment += static_cast<Index>(FaceFacets::inside(here.type(row, i)).segments.size());
    });
    if (kind.is_resolved_cube()) write_inside(kind, row);
  }
  FacetPlace place(const KnownKind& kind, std::size_t row, std::size_t i, unsigned signature,
                   std::size_t number) const noexcept {
    return {row * std::uint64_t{rows_.size(0)} + i, static_cast<std::uint16_t>(signature),
            static_cast<std::uint8_t>(kind.axes), static_cast<std::uint8_t>(number), kind.outward};
  }

  /// Writes the points and segments inside cubes.
  void write_inside(const KnownKind& kind, std::size_t row) {
    const FaceNumbers& here = *kind.numbers;
    auto point = static_cast<Index>(here.first_point[row]);
    auto segment = static_cast<Index>(here.first_segment[row]);
    auto end = static_cast<Index>(here.first_end[row]);
    for_bits(here.bits.data() + row * rows_.words(), rows_.words(), [&](std::size_t i) {
      const FaceFacets::Inside inside = FaceFacets::inside(here.type(row, i));
      const unsigned signature = rows_.signature(kind.corners, row, i);
      for (std::size_t s = 0; s < inside.segments.size(); ++s, ++segment) {
        levels_[1].places[segment] = place(kind, row, i, signature, s);
        levels_[1].down_first[segment] = end;
        for (const std::size_t side : {0u, 1u}) {
          const unsigned v = inside.segments[s][side];
          const bool on_edge = v < kCubeEdges;
          const KnownKind::Sub& edge = kind.edges[on_edge ? v : 0];
          levels_[1].down[end] = on_edge ? edge.numbers->first(row + edge.rows, i + edge.ahead)
                                         : point + static_cast<Index>(v - kCubeEdges);
          levels_[1].down_signs[end++] = side == 0 ? -1 : 1;
        }
      }
      for (std::size_t p = 0; p < inside.points.size(); ++p)
        levels_[0].places[point++] = place(kind, row, i, signature, p);
    });
  }

  /// For outward faces with N - 1 axes: whether these axes followed by the outward one are a mirror image of the axes
  /// of the grid.
  bool is_mirrored(const FaceKind& kind, std::size_t row, std::size_t i) const noexcept {
    if (!kind.outward) return false;
    const auto across = static_cast<unsigned>(std::countr_one(kind.axes));
    const bool is_lower = (across == 0 ? i : rows_.index_of(row)[across]) == 0;
    return ((N - 1 - across) % 2 != 0) != is_lower;
  }

  SampleSource<N>& source_;
  const ExtractOptions& options_;
  bool flip_;
  bool is_high_;  ///< all ambiguous faces are high
  std::size_t passes_;
  ProgressReporter reporter_;
  std::size_t pass_ = 0;
  GridRows<N> rows_;
  std::optional<FaceEstimator<N>> estimator_;  ///< set if ambiguities are resolved from the data
  Workers<FacetScratch> workers_;
  std::vector<KnownKind> kinds_;
  std::vector<FaceNumbers> faces_;  ///< by axes; outward kinds after the others
  std::vector<std::uint8_t> busy_;  ///< by row: whether any face in it has facets
  std::array<NumberedFacets, N> levels_;
};

/// The whole extraction.
template <int N, class Real>
class FacetWriter : FacetExtraction<N> {
  using Base = FacetExtraction<N>;

 public:
  FacetWriter(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options, unsigned seam_axes)
      : Base(source, grid, options, seam_axes), seam_axes_(seam_axes), placement_(grid) {
    if (options.normals != Normals::none) placement_.want_normals(source, grid, options);
    facets_.sizes = grid.sizes();
    facets_.direction = options.direction;
    for (int a = 0; a < N; ++a) {
      facets_.axis_names[a] = grid.axes[a].name;
      facets_.axis_units[a] = grid.axes[a].unit;
    }
  }

  FacetHierarchy<N, Real> run() {
    this->find_facets();
    for (std::size_t k = 0; k < N; ++k) {
      auto& level = facets_.levels[k];
      level.places = std::move(levels_[k].places);
      level.down_first = std::move(levels_[k].down_first);
      level.down = std::move(levels_[k].down);
      level.down_signs = std::move(levels_[k].down_signs);
    }
    write_points();
    if (seam_axes_ != 0) SeamMerging<N, Real>(facets_, seam_axes_).run();
    if (rows_.any_missing())
      separate_facets(facets_, [this](const FacetPlace& place) {
        return seam_axes_ != 0 || !rows_.is_surrounded(place.axes, static_cast<std::size_t>(place.base / rows_.size(0)),
                                                       static_cast<std::size_t>(place.base % rows_.size(0)));
      });
    reporter_.tell(static_cast<double>(passes_));
    return std::move(facets_);
  }

 private:
  using Base::for_busy_rows;
  using Base::kinds_;
  using Base::levels_;
  using Base::options_;
  using Base::passes_;
  using Base::place_of;
  using Base::reporter_;
  using Base::rows_;
  using Base::source_;

  void write_points() {
    facets_.vertices.resize(facets_.count(0));
    if (options_.normals != Normals::none) facets_.normals.resize(facets_.count(0));
    for_busy_rows([&](std::size_t row, FacetScratch& scratch) {
      for (const KnownKind& kind : kinds_) {
        if (kind.is_resolved_cube()) write_inner_points(kind, row);
        if (kind.dim() != 1) continue;
        if (kind.outward)
          write_corners(kind, row);
        else
          write_edges(kind, row, scratch);
      }
    });
  }

  /// Writes the samples of a row that are corners of caps.
  void write_corners(const KnownKind& kind, std::size_t row) {
    const FaceNumbers& here = *kind.numbers;
    auto index = rows_.index_of(row);
    auto vertex = static_cast<std::size_t>(here.first_facet[row]);
    for_bits(here.bits.data() + row * rows_.words(), rows_.words(), [&](std::size_t i) {
      index[0] = i;
      std::array<double, N> point;
      for (int a = 0; a < N; ++a) point[a] = placement_.sample(a, index[a]);
      facets_.vertices[vertex] = placement_.world(point);
      if (options_.normals != Normals::none)
        facets_.normals[vertex] = placement_.normals()->template in_cell<CellFrame<N, 0>>(index, {});
      ++vertex;
    });
  }

  /// Writes the points inside cubes, at the same places as `extract`.
  void write_inner_points(const KnownKind& kind, std::size_t row) {
    if constexpr (N == 3) write_inner_points_along<7>(kind, row);
    if constexpr (N == 4) {
      if (kind.axes == 7) write_inner_points_along<7>(kind, row);
      if (kind.axes == 11) write_inner_points_along<11>(kind, row);
      if (kind.axes == 13) write_inner_points_along<13>(kind, row);
      if (kind.axes == 14) write_inner_points_along<14>(kind, row);
    }
  }
  template <unsigned Axes>
  void write_inner_points_along(const KnownKind& kind, std::size_t row) {
    const FaceNumbers& here = *kind.numbers;
    auto vertex = static_cast<std::size_t>(here.first_point[row]);
    for_bits(here.bits.data() + row * rows_.words(), rows_.words(), [&](std::size_t i) {
      const std::uint16_t type = here.type(row, i);
      const FaceFacets::Inside inside = FaceFacets::inside(type);
      if (inside.points.empty()) return;
      const auto index = place_of(row, i);
      const EdgePlaces<N, Axes> edges(source_, index, rows_.signature(kind.corners, row, i));
      CellRays<N, 3> rays = edges.rays();
      for (const std::uint8_t own : inside.points) {
        const TilePoint<3> point = cube_own_place(ResolvedCubes::instance().mask(type, own), edges, rays);
        facets_.vertices[vertex] = placement_.template in_cell<CellFrame<N, Axes>>(index, point);
        if (options_.normals != Normals::none)
          facets_.normals[vertex] = placement_.normals()->template in_cell<CellFrame<N, Axes>>(index, point);
        ++vertex;
      }
    });
  }

  /// Writes the points on the edges of a row along one axis.
  void write_edges(const KnownKind& kind, std::size_t row, FacetScratch& scratch) {
    FaceNumbers& here = *kind.numbers;
    const Word* const bits = here.bits.data() + row * rows_.words();
    std::size_t count = 0;
    for (std::size_t w = 0; w < rows_.words(); ++w) count += static_cast<std::size_t>(std::popcount(bits[w]));
    if (count == 0) return;
    constexpr std::size_t kMargin = 16;  // margin that is read and written after the lists
    const auto index = rows_.index_of(row);
    const auto axis = static_cast<int>(kind.axis(0));
    std::ptrdiff_t offset = 0;
    const auto strides = source_.strides();
    for (int a = 1; a + 1 < N; ++a) offset += static_cast<std::ptrdiff_t>(index[a]) * strides[a];
    // fractions along the edges
    scratch.at.resize(count + kMargin);
    list_bits(bits, rows_.words(), scratch.at.data());
    scratch.rows.assign(count + kMargin, offset);
    scratch.alphas.resize(count + kMargin);
    source_.edge_alphas(index[N - 1], axis, {scratch.rows.data(), scratch.at.data(), count}, scratch.alphas.data());
    // places
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
    if (options_.normals == Normals::none) return;
    // normals
    placement_.normals()->edges(index, axis, {scratch.rows.data(), scratch.at.data(), count}, scratch.alphas.data(),
                                scratch.normals, facets_.normals.data() + here.first_facet[row], [&](std::size_t edge) {
                                  auto start = index;
                                  start[0] = scratch.at[edge];
                                  return start;
                                });
  }

  unsigned seam_axes_;
  Placement<N, Real> placement_;
  FacetHierarchy<N, Real> facets_;
};

}  // namespace

template <int N, class Real>
FacetHierarchy<N, Real> extract_facets(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options,
                                       unsigned seam_axes) {
  const auto sizes = grid.sizes();
  if (*std::min_element(sizes.begin(), sizes.end()) < 2) {
    FacetHierarchy<N, Real> none;
    none.sizes = sizes;
    for (int a = 0; a < N; ++a) none.sizes[a] -= seam_axes >> a & 1u;
    none.direction = options.direction;
    for (int a = 0; a < N; ++a) {
      none.axis_names[a] = grid.axes[a].name;
      none.axis_units[a] = grid.axes[a].unit;
      if (a > 0) none.levels[a].down_first.assign(1, 0);
    }
    return none;
  }
  return FacetWriter<N, Real>(source, grid, options, seam_axes).run();
}

#define TEGL_INSTANTIATE_CONTOURS(N, Real)                                                                          \
  template FacetHierarchy<N, Real> extract_facets<N, Real>(SampleSource<N>&, const Grid<N>&, const ExtractOptions&, \
                                                           unsigned);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
