// SPDX-License-Identifier: BSD-3-Clause
#include "division/divided_contour.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/periods.hpp"
#include "base/progress.hpp"
#include "base/stopwatch.hpp"
#include "base/workers.hpp"
#include "complex/crossings.hpp"
#include "complex/edge_alpha.hpp"
#include "complex/point_gradients.hpp"
#include "division/cell_crossings.hpp"
#include "kernel/contour_output.hpp"
#include "kernel/placement.hpp"
#include "kernel/split_nonmanifold.hpp"

namespace tegl::detail {
namespace {

constexpr std::size_t kPointWords = 3;      ///< 163 points of a symmetric cell in 5D
constexpr std::size_t kCrossingWords = 28;  ///< its 1 602 edges and the points

/// Calls work(bit) for the set bits of words, ascending.
template <class Work>
void for_each_bit(std::span<const std::uint64_t> words, const Work& work) {
  for (std::size_t w = 0; w < words.size(); ++w)
    for (std::uint64_t rest = words[w]; rest != 0; rest &= rest - 1)
      work(64 * w + static_cast<std::size_t>(std::countr_zero(rest)));
}

inline bool has(std::span<const std::uint64_t> words, std::size_t bit) noexcept {
  return (words[bit / 64] >> (bit % 64) & 1u) != 0;
}

/// A cell that has vertices or simplices.
struct CellWithContour {
  std::uint64_t number;                         ///< among all cells, axis 0 fastest
  std::array<std::uint64_t, kPointWords> high;  ///< its high points
  std::uint32_t first_vertex;                   ///< relative to the block's
  bool is_near = false;                         ///< it or a cell beside it has missing corners
};

/// The active cells of some rows of cells.
struct Block {
  std::vector<CellWithContour> cells;
  std::vector<std::uint64_t> own;  ///< by cell: the crossings that are vertices of this cell, as bits
  std::uint64_t vertices = 0, simplices = 0, active = 0;
  std::uint64_t first_vertex = 0, first_simplex = 0;
  std::vector<Index> touching;  ///< its vertices at which the contour may touch itself
};

template <int N, class Real>
class DividedExtraction {
 public:
  using Sample = std::array<std::size_t, N>;

  DividedExtraction(const DividedSamples<N>& samples, ReadSamples<N> read, Division division, double isovalue,
                    const ExtractOptions& options)
      : samples_(samples),
        read_(read),
        isovalue_(isovalue),
        options_(options),
        crossings_(division),
        contours_(SimplexContour<N>::instance()),
        words_(block_count(crossings_.count(), 64)),
        flip_(against_tables(samples.grid, options)) {
    for (const CellPoint& point : crossings_.points()) corners_of_.push_back(corner_masks(point.face));
    for (int a = 0; a < N; ++a) cells_[a] = samples.grid.axes[a].size() - 1;
    for (int a = 1; a < N; ++a) rows_ *= cells_[a];
    rows_per_block_ = std::max<std::size_t>(1, 2048 / std::max<std::size_t>(1, cells_[0]));
    for (unsigned along = 0; along < 1u << N; ++along)
      for (int a = 0; a < N; ++a) steps_along_[along][a] = static_cast<std::int8_t>(along >> a & 1u);
    if (rows_ != 0 && cells_[0] != 0)
      missing_.emplace(cells_, samples.periodic, division == Division::symmetric, read,
                       WorkOptions{options.work.threads, part_of(options.work.progress, 0.0, 0.1)});
  }

  /// Whether only the contour itself shows its size.
  [[nodiscard]] bool any_missing() const noexcept { return missing_ && missing_->any(); }

  ExtractedSize run(Contour<N, Real>* contour) {
    ExtractedSize result;
    if (!missing_) return result;
    Stopwatch watch;
    classify();
    watch.add_to(result.stats.classify_seconds);
    for (Block& block : blocks_) {
      block.first_vertex = result.size.vertices;
      block.first_simplex = result.size.simplices;
      result.size.vertices += block.vertices;
      result.size.simplices += block.simplices;
      result.stats.active_tiles += block.active;
    }
    result.stats.tiles = rows_ * cells_[0] * crossings_.simplices().size();
    watch.add_to(result.stats.find_seconds);
    if (contour != nullptr) {
      write(result.size, *contour);
      result.size = {contour->vertices.size(), contour->simplices.size()};
    }
    watch.add_to(result.stats.generate_seconds);
    tell(options_.work.progress, 1.0);
    return result;
  }

 private:
  /// Values of the corners of a row of cells: by the corner's mask without axis 0, the samples along the row.
  struct Row {
    std::array<std::vector<double>, (1u << (N - 1))> values;
    std::vector<std::uint32_t> high;  ///< by sample along the row: bit by mask without axis 0
  };
  /// Steps to a cell that shares a corner.
  using Steps = std::array<std::int8_t, N>;
  static constexpr std::size_t kAround = [] {
    std::size_t count = 1;
    for (int a = 0; a < N; ++a) count *= 3;
    return count;
  }();
  /// The vertices that a cell owns.
  struct OwnVertices {
    const std::uint64_t* own = nullptr;
    std::array<std::uint32_t, kCrossingWords> ranks;  ///< by word of `own`: the number of its first vertex
  };
  struct Scratch {
    Row row;
    std::vector<Index> numbers;  ///< by crossing of a cell
    std::array<double, (1u << N)> corners;
    std::vector<double> values;  ///< by point of a cell
    std::array<OwnVertices, kAround> around;
    std::vector<std::size_t> known;  ///< those of `around` that are known
  };
  /// A crossing of a cell, in the cell that owns its vertex.
  struct Owner {
    Steps steps;
    std::size_t crossing;
  };

  /// Index of the first cell of a row.
  [[nodiscard]] Sample row_at(std::size_t row) const noexcept {
    Sample at{};
    for (int a = 1; a < N; ++a) {
      at[a] = row % cells_[a];
      row /= cells_[a];
    }
    return at;
  }
  [[nodiscard]] Sample cell_at(std::uint64_t number) const noexcept {
    Sample at = row_at(number / cells_[0]);
    at[0] = number % cells_[0];
    return at;
  }
  /// The sides of the image at which a cell is; as CellPoint::sides.
  [[nodiscard]] std::uint64_t sides_of(const Sample& at) const noexcept {
    std::uint64_t sides = 0;
    for (int a = 0; a < N; ++a) {
      if ((samples_.periodic >> a & 1u) != 0) continue;
      sides |= std::uint64_t{at[a] == 0} << a;
      sides |= std::uint64_t{at[a] + 1 == cells_[a]} << (8 + a);
    }
    return sides;
  }
  [[nodiscard]] static Sample corner_at(Sample at, unsigned mask) noexcept {
    for (int a = 0; a < N; ++a) at[a] += mask >> a & 1u;
    return at;
  }

  void classify() {
    blocks_.resize(block_count(rows_, rows_per_block_));
    for_each_block(
        rows_, rows_per_block_, options_.work.threads, part_of(options_.work.progress, 0.1, 0.5),
        [] { return Scratch(); },
        [&](std::size_t b, std::size_t from, std::size_t to, Scratch& scratch) {
          for (std::size_t row = from; row < to; ++row) classify_row(row, blocks_[b], scratch);
        });
  }

  void classify_row(std::size_t row, Block& block, Scratch& scratch) const {
    const Sample at = row_at(row);
    Row& samples = scratch.row;
    samples.high.assign(cells_[0] + 1, 0);
    for (unsigned rest = 0; rest < samples.values.size(); ++rest) {
      std::vector<double>& values = samples.values[rest];
      values.resize(cells_[0] + 1);
      read_(corner_at(at, rest << 1), values.size(), values.data());
      for (std::size_t i = 0; i < values.size(); ++i) samples.high[i] |= std::uint32_t{values[i] >= isovalue_} << rest;
    }
    find_active(row, at, block, scratch);
  }

  void find_active(std::size_t row, Sample at, Block& block, Scratch& scratch) const {
    constexpr std::uint32_t kAll = (std::uint64_t{1} << (1u << (N - 1))) - 1;
    const Row& samples = scratch.row;
    for (std::size_t i = 0; i < cells_[0]; ++i) {
      const std::uint32_t any = samples.high[i] | samples.high[i + 1];
      if (any == 0) continue;
      at[0] = i;
      const bool is_mixed = (samples.high[i] & samples.high[i + 1]) != kAll;
      const std::uint64_t sides = options_.close ? sides_of(at) : 0;
      if ((!is_mixed && sides == 0) || missing_->of_cell(at) == MissingCorners<N>::kAll) continue;
      for (unsigned v = 0; v < 1u << N; ++v) scratch.corners[v] = samples.values[v >> 1][i + (v & 1u)];
      find_values(scratch);
      CellWithContour cell{row * cells_[0] + i, {}, static_cast<std::uint32_t>(block.vertices), missing_->is_near(at)};
      for (std::size_t p = 0; p < scratch.values.size(); ++p)
        cell.high[p / 64] |= std::uint64_t{scratch.values[p] >= isovalue_} << (p % 64);
      add(cell, at, sides, block);
    }
  }

  /// The values at the points of a cell with these corners.
  void find_values(Scratch& scratch) const {
    scratch.values.clear();
    std::array<double, (1u << N)> of_face;
    for (const std::vector<unsigned>& masks : corners_of_) {
      for (std::size_t i = 0; i < masks.size(); ++i) of_face[i] = scratch.corners[masks[i]];
      scratch.values.push_back(masks.size() == 1 ? of_face[0]
                                                 : mean_of_corners(std::span(of_face).first(masks.size())));
    }
  }

  /// Calls work(crossing) for the crossings of a cell in simplices without missing points, ascending.
  template <class Work>
  void for_each_crossing(const CellWithContour& cell, const Sample& at, std::uint64_t sides, const Work& work) const {
    const auto visit = [&](std::size_t crossing) {
      if (!cell.is_near || is_in_simplex(at, crossing)) work(crossing);
    };
    for (std::size_t e = 0; e < crossings_.edges(); ++e) {
      const auto [p, q] = crossings_.ends(e);
      if (has(cell.high, p) != has(cell.high, q)) visit(e);
    }
    if (sides == 0) return;
    for_each_bit(cell.high, [&](std::size_t p) {
      if ((crossings_.points()[p].sides & sides) != 0) visit(crossings_.edges() + p);
    });
  }
  /// Whether a crossing of a cell is in one of the cell's simplices without missing points.
  [[nodiscard]] bool is_in_simplex(const Sample& at, std::size_t crossing) const {
    const std::uint32_t missing = missing_->of_cell(at);
    if (missing == 0) return true;
    if (crossing < crossings_.edges())
      return std::ranges::any_of(crossings_.simplices_at(crossing),
                                 [&](std::uint16_t s) { return !crossings_.simplices()[s].is_without(missing); });
    const std::uint64_t sides = sides_of(at);
    return std::ranges::any_of(crossings_.sides(), [&](const auto& side) {
      return (side.bit & sides) != 0 && std::ranges::any_of(side.cones, [&](const auto& cone) {
               return !cone.is_without(missing) && std::find(cone.points.begin() + 1, cone.points.end(),
                                                             crossing - crossings_.edges()) != cone.points.end();
             });
    });
  }
  /// Whether some simplices at a crossing are left out, in any of the cells around it.
  [[nodiscard]] bool is_beside_missing(const Sample& at, std::size_t crossing) const {
    bool result = false;
    for_each_cell_around(at, crossing, [&](const Owner& other, const Sample& cell) {
      const std::uint32_t missing = missing_->of_cell(cell);
      if (missing == 0) return true;
      result = other.crossing >= crossings_.edges() ||
               std::ranges::any_of(crossings_.simplices_at(other.crossing),
                                   [&](std::uint16_t s) { return crossings_.simplices()[s].is_without(missing); });
      return !result;
    });
    return result;
  }
  /// Calls visit(crossing in a cell, cell) for the cells around a crossing of a cell, the last one first, until it
  /// returns false.
  template <class Visit>
  void for_each_cell_around(const Sample& at, std::size_t crossing, const Visit& visit) const {
    const unsigned fixed = crossings_.fixed(crossing), own = crossings_.place(crossing);
    for (unsigned place = fixed;; place = (place - 1) & fixed) {
      Owner other{{}, crossings_.at_place(crossing, place)};
      for (int a = 0; a < N; ++a) other.steps[a] = static_cast<std::int8_t>((place >> a & 1u) - (own >> a & 1u));
      Sample cell = at;
      if (missing_->move(cell, other.steps) && !visit(other, cell)) return;
      if (place == 0) return;
    }
  }
  /// The cell that owns the vertex at a crossing: the last one around it that has it.
  [[nodiscard]] Owner owner_of(const CellWithContour& cell, const Sample& at, std::size_t crossing) const {
    if (!cell.is_near) {
      const unsigned along = crossings_.upper(crossing) & ~last_along(at);
      return {steps_along_[along], crossings_.in_next(crossing, along)};
    }
    Owner owner{{}, crossing};
    for_each_cell_around(at, crossing, [&](const Owner& other, const Sample& there) {
      if (!is_in_simplex(there, other.crossing)) return true;
      owner = other;
      return false;
    });
    return owner;
  }
  /// Calls work(simplex, signature) for the active simplices and cones of a cell without missing points.
  template <class Work>
  void for_each_simplex(const CellWithContour& cell, const Sample& at, std::uint64_t sides, const Work& work) const {
    const std::uint32_t missing = cell.is_near ? missing_->of_cell(at) : 0;
    const auto signature_of = [&](const auto& simplex, int first) {
      unsigned signature = 0;
      for (int j = first; j <= N; ++j) signature |= unsigned{has(cell.high, simplex.points[j])} << j;
      return signature;
    };
    constexpr unsigned kAll = (2u << N) - 1;
    for (const auto& simplex : crossings_.simplices())
      if (const unsigned signature = signature_of(simplex, 0);
          signature != 0 && signature != kAll && !simplex.is_without(missing))
        work(simplex, signature);
    for (const auto& side : crossings_.sides()) {
      if ((side.bit & sides) == 0) continue;
      for (const auto& cone : side.cones)
        if (const unsigned signature = signature_of(cone, 1); signature != 0 && !cone.is_without(missing))
          work(cone, signature);
    }
  }

  void add(const CellWithContour& cell, const Sample& at, std::uint64_t sides, Block& block) const {
    block.cells.push_back(cell);
    block.own.resize(block.own.size() + words_);
    std::uint64_t* const own = block.own.data() + block.own.size() - words_;
    for_each_crossing(cell, at, sides, [&](std::size_t crossing) {
      if (owner_of(cell, at, crossing).steps != Steps{}) return;
      own[crossing / 64] |= std::uint64_t{1} << (crossing % 64);
      ++block.vertices;
    });
    for_each_simplex(cell, at, sides, [&](const auto& /*simplex*/, unsigned signature) {
      block.simplices += contours_.count(signature);
      ++block.active;
    });
  }
  /// The axes along which there is no next cell.
  [[nodiscard]] unsigned last_along(const Sample& at) const noexcept {
    unsigned last = 0;
    for (int a = 0; a < N; ++a) last |= unsigned{at[a] + 1 == cells_[a]} << a;
    return last & ~samples_.periodic;
  }

  void write(const ContourSize& size, Contour<N, Real>& contour) {
    require_numbers(size.vertices);
    contour.vertices.resize(size.vertices);
    contour.simplices.resize(size.simplices);
    contour.periods = samples_.periods;
    Placement<N, Real> placement(samples_.grid);
    if (samples_.gradients != nullptr) {
      placement.want_normals(*samples_.gradients, *samples_.gradient_grid, options_);
      contour.normals.resize(size.vertices);
    }
    for_each_block(
        blocks_.size(), 1, options_.work.threads, part_of(options_.work.progress, 0.5, 0.9), [] { return Scratch(); },
        [&](std::size_t b, std::size_t, std::size_t, Scratch& scratch) {
          Block& block = blocks_[b];
          std::size_t vertex = block.first_vertex;
          auto* simplex = contour.simplices.data() + block.first_simplex;
          for (std::size_t c = 0; c < block.cells.size(); ++c) {
            const Sample at = cell_at(block.cells[c].number);
            vertex = write_vertices(block, c, at, placement, scratch, contour, vertex);
            simplex = write_simplices(block.cells[c], at, scratch, simplex);
          }
        });
    std::vector<Index> touching;
    for (const Block& block : blocks_) touching.insert(touching.end(), block.touching.begin(), block.touching.end());
    split_nonmanifold(contour, touching, kMaxVertices,
                      {options_.work.threads, part_of(options_.work.progress, 0.9, 1.0)});
  }

  using Vertex = typename Contour<N, Real>::Vertex;
  /// Writes the vertices that a cell owns from number `next` on; returns the next number.
  std::size_t write_vertices(Block& block, std::size_t c, const Sample& at, const Placement<N, Real>& placement,
                             Scratch& scratch, Contour<N, Real>& contour, std::size_t next) const {
    const std::span<const std::uint64_t> own = std::span(block.own).subspan(c * words_, words_);
    if (std::all_of(own.begin(), own.end(), [](std::uint64_t word) { return word == 0; })) return next;
    for (unsigned v = 0; v < 1u << N; v += 2) read_(corner_at(at, v), 2, scratch.corners.data() + v);
    find_values(scratch);
    const typename Placement<N, Real>::Cell place(placement, at);
    Sample in_gradients = at;
    for (int a = 0; a < N; ++a) in_gradients[a] += samples_.before[a];
    for_each_bit(own, [&](std::size_t crossing) {
      const bool is_edge = crossing < crossings_.edges();
      const CellPoint& p = crossings_.points()[is_edge ? crossings_.ends(crossing)[0] : crossing - crossings_.edges()];
      const CellPoint& q = is_edge ? crossings_.points()[crossings_.ends(crossing)[1]] : p;
      double alpha = 0.0;
      if (is_edge) {
        const auto [first, second] = crossings_.ends(crossing);
        alpha = alpha_of(scratch.values[first], scratch.values[second], isovalue_, options_.epsilon);
      }
      std::array<double, N> x, y;
      for (int a = 0; a < N; ++a) {
        x[a] = 0.5 * p.doubled[a];
        y[a] = 0.5 * q.doubled[a];
      }
      const std::array<double, N> in_cell = point_on_edge<double, N>(x, y, alpha);
      contour.vertices[next] = vertex_between(p, q, in_cell, at, place, placement);
      if (placement.normals() != nullptr)
        contour.normals[next] = normal_between(p, q, alpha, in_gradients, *placement.normals());
      if (block.cells[c].is_near && is_beside_missing(at, crossing)) block.touching.push_back(static_cast<Index>(next));
      ++next;
    });
    return next;
  }
  /// The normal between two points of a cell, from the gradients at these: other corners may be missing. `at`: the
  /// cell's first sample among the gradients.
  static Vertex normal_between(const CellPoint& first, const CellPoint& second, double alpha, const Sample& at,
                               const NormalWriter<N, Real>& normals) {
    std::array<double, N> gradient{};
    const auto add = [&](const CellPoint& point, double share) {
      if (share == 0.0) return;
      const auto mean =
          mean_gradient<N>(point.face, [&](unsigned corner) { return normals.in_world_at(corner_at(at, corner)); });
      for (int a = 0; a < N; ++a) gradient[a] += share * mean[a];
    };
    add(first, 1.0 - alpha);
    add(second, alpha);
    return unit_of<Real>(gradient);
  }
  /// The vertex between two points of the cell at `at`, at a place in the cell.
  Vertex vertex_between(const CellPoint& first, const CellPoint& second, const std::array<double, N>& in_cell,
                        const Sample& at, const typename Placement<N, Real>::Cell& place,
                        const Placement<N, Real>& placement) const {
    Vertex vertex = placement.world(place.on_axes(in_cell));
    // Points in a layer stay there.
    for (int a = std::max(0, N - 2); a < N; ++a)
      if (first.doubled[a] != second.doubled[a] || first.doubled[a] == 1)
        vertex = placement.inside_slab(vertex, at[a], a);
    if (samples_.periods.empty()) return vertex;
    std::array<double, N> inside = widened_point<N>(vertex);
    move_inside<N, Real>(samples_.periods, inside);
    for (int a = 0; a < N; ++a) vertex[a] = static_cast<Real>(inside[a]);
    return vertex;
  }

  using SimplexRow = typename Contour<N, Real>::Simplex;
  SimplexRow* write_simplices(const CellWithContour& cell, const Sample& at, Scratch& scratch, SimplexRow* out) const {
    const std::uint64_t sides = options_.close ? sides_of(at) : 0;
    find_numbers(cell, at, sides, scratch);
    for_each_simplex(cell, at, sides, [&](const auto& simplex, unsigned signature) {
      for (const auto& edges : contours_.of(signature)) {
        for (int j = 0; j < N; ++j) (*out)[j] = scratch.numbers[simplex.crossings[edges[j]]];
        if (simplex.is_positive == flip_) std::swap((*out)[N - 2], (*out)[N - 1]);
        ++out;
      }
    });
    return out;
  }
  /// The numbers of the vertices at the crossings of a cell.
  void find_numbers(const CellWithContour& cell, const Sample& at, std::uint64_t sides, Scratch& scratch) const {
    scratch.numbers.resize(crossings_.count());
    for (const std::size_t each : scratch.known) scratch.around[each].own = nullptr;
    scratch.known.clear();
    for_each_crossing(cell, at, sides, [&](std::size_t crossing) {
      const Owner owner = owner_of(cell, at, crossing);
      std::size_t around = 0;
      for (const std::int8_t step : owner.steps) around = 3 * around + static_cast<std::size_t>(step + 1);
      OwnVertices& vertices = scratch.around[around];
      if (vertices.own == nullptr) {
        find_own(at, owner.steps, vertices);
        scratch.known.push_back(around);
      }
      const std::size_t word = owner.crossing / 64, bit = owner.crossing % 64;
      const std::uint64_t below = vertices.own[word] & ((std::uint64_t{1} << bit) - 1);
      scratch.numbers[crossing] = vertices.ranks[word] + static_cast<Index>(std::popcount(below));
    });
  }
  /// Finds the vertices that a cell beside this one owns.
  void find_own(Sample at, const Steps& steps, OwnVertices& vertices) const {
    (void)missing_->move(at, steps);
    const std::uint64_t number = missing_->number_of(at);
    const Block& block = blocks_[number / cells_[0] / rows_per_block_];
    const auto found = std::lower_bound(block.cells.begin(), block.cells.end(), number,
                                        [](const CellWithContour& cell, std::uint64_t n) { return cell.number < n; });
    vertices.own = block.own.data() + static_cast<std::size_t>(found - block.cells.begin()) * words_;
    auto next = static_cast<Index>(block.first_vertex + found->first_vertex);
    for (std::size_t w = 0; w < words_; ++w) {
      vertices.ranks[w] = next;
      next += static_cast<Index>(std::popcount(vertices.own[w]));
    }
  }

  const DividedSamples<N>& samples_;
  ReadSamples<N> read_;
  double isovalue_;
  const ExtractOptions& options_;
  CellCrossings<N> crossings_;
  const SimplexContour<N>& contours_;
  std::size_t words_;  ///< for the crossings of a cell
  bool flip_;
  std::vector<std::vector<unsigned>> corners_of_;  ///< by point: its face's corners
  Sample cells_;                                   ///< by axis
  std::size_t rows_ = 1;
  std::size_t rows_per_block_;
  std::array<Steps, (1u << N)> steps_along_{};
  std::optional<MissingCorners<N>> missing_;  ///< none: there are no cells
  std::vector<Block> blocks_;
};

}  // namespace

template <int N, class Real>
ExtractedSize extract_divided_cells(const DividedSamples<N>& samples, ReadSamples<N> read, Division division,
                                    double isovalue, const ExtractOptions& options, Contour<N, Real>* contour) {
  DividedExtraction<N, Real> extraction(samples, read, division, isovalue, options);
  if (contour != nullptr || !extraction.any_missing()) return extraction.run(contour);
  Contour<N, Real> made;
  return extraction.run(&made);
}

#define TEGL_INSTANTIATE(N, Real)                                                                                   \
  template ExtractedSize extract_divided_cells<N, Real>(const DividedSamples<N>&, ReadSamples<N>, Division, double, \
                                                        const ExtractOptions&, Contour<N, Real>*);
TEGL_INSTANTIATE(2, double)
TEGL_INSTANTIATE(3, double)
TEGL_INSTANTIATE(4, double)
TEGL_INSTANTIATE(5, float)
TEGL_INSTANTIATE(5, double)
#undef TEGL_INSTANTIATE

}  // namespace tegl::detail
