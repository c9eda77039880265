// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images on lattices: by rows of bits, if these give the contour (has_rows), otherwise as complexes;
// normals by gradients on the lattice.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/progress.hpp"
#include "base/stopwatch.hpp"
#include "base/workers.hpp"
#include "complex/cell_groups.hpp"
#include "complex/contour_numbers.hpp"
#include "complex/edge_alpha.hpp"
#include "complex/image_points.hpp"
#include "complex/point_gradients.hpp"
#include "complex/vertex_mean.hpp"
#include "image/edge_alphas.hpp"
#include "image/row_source.hpp"
#include "kernel/extract_points.hpp"
#include "kernel/memory_output.hpp"
#include "lattice/lattice_gradients.hpp"
#include "lattice/lattice_points.hpp"
#include "lattice/lattice_rows.hpp"
#include "lattice/lattice_simplices.hpp"
#include "lattice/row_gradients.hpp"
#include "lattice/stored_lattice.hpp"
#include "tegl/error.hpp"
#include "tegl/lattice.hpp"
#include "tegl/normals.hpp"

namespace tegl {
namespace detail {
namespace {

/// Whether all samples are within the range of Real, so that vertices are. Exact: contours in other types, and numbers
/// interpolated to their vertices, take the same way.
template <class Real, int N>
bool is_in_range(const Grid<N>& grid, int layers) {
  constexpr double kMost{std::numeric_limits<Real>::max()};
  Vector<N> size{};  // an upper bound
  for (int row = 0; row < N; ++row) {
    size[row] = std::abs(grid.offset[row]);
    for (int a = 0; a < N; ++a) {
      const Axis& axis = grid.axes[a];
      const double most = std::max(std::abs(axis[0]), std::abs(axis[axis.size() - 1]));
      size[row] += std::abs(grid.linear[row][a]) * (most + std::abs(axis.size() > 1 ? axis.step() : 0.0));
    }
  }
  const auto is_in = [](const auto& x) {
    return std::all_of(x.begin(), x.end(), [](double y) { return std::abs(y) <= kMost; });
  };
  if (is_in(size)) return true;
  bool all = true;
  for_each_sample<N>(grid.sizes(),
                     [&](const auto& index) { all = all && is_in(lattice_place<N>(grid, index, layers)); });
  return all;
}

/// Whether there are prisms between all times: these are apart from space, and ascend or descend.
template <int N>
bool has_prisms(const Grid<N>& grid) {
  const Axis& axis = grid.axes[N - 1];
  if (!grid.is_separate(N - 1) || axis.size() < 2) return false;
  const auto time = [&](std::size_t k) { return grid.linear[N - 1][N - 1] * axis[k] + grid.offset[N - 1]; };
  const bool descends = time(0) > time(1);
  for (std::size_t k = 1; k < axis.size(); ++k)
    if (descends ? !(time(k - 1) > time(k)) : !(time(k - 1) < time(k))) return false;
  return true;
}

/// Writes a contour that LatticeRows has counted.
template <int N, class Real>
class LatticeWriter {
 public:
  using Vertex = std::array<Real, N>;
  using Sample = std::array<std::size_t, N>;
  using At = LatticeRows::At;

  /// Working memory of a thread.
  struct Scratch {
    std::vector<ActiveInRow> active;
    // by edge of a row
    std::vector<std::uint32_t> at;
    std::vector<double> from, to, alphas;
  };

  /// `read`: for the samples' type. `places`: of samples, in place of those on the grid; null: none.
  LatticeWriter(const SampleSource<N>& source, ReadSamples read, const Grid<N>& grid, Lattice lattice,
                const LatticeRows& rows, const LatticeGradients<N>* gradients, const RowGradients<N>* row_gradients,
                const std::vector<std::array<double, N>>* places, const ExtractOptions& options,
                Contour<N, Real>& contour)
      : source_(source),
        read_(read),
        grid_(grid),
        rows_(rows),
        gradients_(gradients),
        row_gradients_(row_gradients),
        places_(places),
        layers_(layer_axis(lattice)),
        is_layered_(lattice == Lattice::fcc_in_time && places == nullptr),
        epsilon_(options.epsilon),
        contour_(contour) {
    const Axis& along = grid.axes[0];
    if (along.is_uniform()) return;
    // with an entry more at both ends, for positions that are read but not used
    along_.resize(along.size() + 2);
    for (std::size_t i = 0; i < along.size(); ++i) along_[i + 1] = along[i];
  }

  void write_edge_points(std::size_t r, Scratch& scratch) const {
    const std::size_t count = rows_.row(r).first_own - rows_.row(r).first;
    if (count == 0) return;
    const At row = rows_.at(r);
    for (std::vector<double>* list : {&scratch.from, &scratch.to, &scratch.alphas})
      if (list->size() < count + kMargin) list->resize(count + kMargin);
    if (scratch.at.size() < count + kMargin) scratch.at.resize(count + kMargin);
    // the samples at both ends
    const std::vector<EdgeKind>& kinds = rows_.pattern(row).edges;
    std::array<std::size_t, kMostKinds + 1> first{};
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      const std::size_t at = first[kind];
      first[kind + 1] = at;
      if (!rows_.has_row(row, kinds[kind].to)) continue;
      std::uint32_t* const list = scratch.at.data() + at;
      const std::size_t more = list_bits(rows_.crossed(r, kind).bits, rows_.words(), list);
      first[kind + 1] += more;
      read_(row_of(row, {}), list, more, scratch.from.data() + at);
      read_(row_of(row, kinds[kind].to), list, more, scratch.to.data() + at);
    }
    alphas_between(scratch.from.data(), scratch.to.data(), count, source_.isovalue(), epsilon_, scratch.alphas.data());
    // vertices
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      const std::size_t at = first[kind], more = first[kind + 1] - at;
      if (more == 0) continue;
      LatticePoints<N, Real> edges{};
      edges.at = scratch.at.data() + at;
      edges.alphas = scratch.alphas.data() + at;
      edges.count = more;
      edges.out = contour_.vertices.data() + rows_.row(r).first + at;
      edges.end = contour_.vertices.data() + rows_.row(r).first_own;
      write_row(edges, sample(row, {}), sample(row, kinds[kind].to));
      if (gradients_ != nullptr) write_normals(edges, r, kinds[kind].to);
      if (!is_layered_ || kinds[kind].to[N - 1] == 0) continue;
      const auto [low, high] = times_after(row);
      for (Vertex& vertex : std::span(edges.out, more)) vertex[N - 1] = std::clamp(vertex[N - 1], low, high);
    }
  }

  void write_cells(std::size_t r, Scratch& scratch) const {
    const LatticeRows::Row& row = rows_.row(r);
    if (row.active == 0) return;
    const At at = rows_.at(r);
    Index own = row.first_own;
    auto* simplices = contour_.simplices.data() + row.first_simplex;
    auto* const end = simplices + row.simplices;
    const std::vector<LatticeCell>& kinds = rows_.pattern(at).cells;
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      if ((row.kinds >> kind & 1u) == 0) continue;
      std::array<EdgeStream, kMostEdges> streams;
      rows_.streams_of_row(r, at, kind, streams.data());
      const LatticeCellRow cells = rows_.cells_of_row(r, at, kind);
      Index number = own;
      simplices = write_simplices(cells, streams.data(), own, simplices, end);
      if (number != own) write_own_points(at, cells, streams.data(), number, scratch);
    }
  }

 private:
  static constexpr std::size_t kMostEdges = LatticeCell::OwnVertex::kMostEdges;  ///< of a cell
  static constexpr std::size_t kMostKinds = 16;  ///< of edges of a sample
  static constexpr std::size_t kMargin = LatticePoints<N, Real>::kMargin;

  /// A sample at these differences from the first one of a row; on the grid modulo 2^64 along axis 0.
  static Sample sample(const At& row, const LatticePlace& to) {
    Sample index{};
    for (std::size_t a = 0; a < N; ++a) index[a] = row[a] + static_cast<std::size_t>(to[a]);
    return index;
  }

  /// The samples at these differences from those of a row.
  [[nodiscard]] RowOfSamples row_of(const At& row, const LatticePlace& to) const noexcept {
    const Sample at = sample(row, to);
    const LayerInMemory layer = source_.layer_in_memory(at[N - 1]);
    std::ptrdiff_t rows = 0;
    for (std::size_t a = 1; a + 1 < N; ++a) rows += static_cast<std::ptrdiff_t>(at[a]) * source_.strides()[a];
    return {layer.first + rows * layer.step_bytes + to[0] * layer.sample_bytes, layer.sample_bytes};
  }

  /// The coordinates of the samples from `first` on, which is on the grid modulo 2^64 along axis 0.
  [[nodiscard]] PlacesInRow<N> places_in_row(const Sample& first) const noexcept {
    const bool is_odd = first[static_cast<std::size_t>(layers_)] % 2 == 1;
    const auto shift = [&](int a) { return is_odd && a < layers_ ? 0.5 * grid_.axes[a].step() : 0.0; };
    PlacesInRow<N> places{shift(0), static_cast<std::ptrdiff_t>(first[0])};
    for (int a = 1; a < N; ++a) places.others[a] = grid_.axes[a][first[a]] + shift(a);
    return places;
  }

  /// The times of vertices between a row's time and the next one.
  [[nodiscard]] std::pair<Real, Real> times_after(const At& row) const noexcept {
    const auto time = [&](const LatticePlace& to) { return lattice_place<N>(grid_, sample(row, to), layers_)[N - 1]; };
    return inside_of<Real>(time({}), time({0, 0, 0, 1}));
  }

  /// Writes the vertices on edges from samples of one row to those of another. `from`, `to`: the ends of
  /// the edge of the row's first sample.
  void write_row(LatticePoints<N, Real>& edges, const Sample& from, const Sample& to) const noexcept {
    if (places_ == nullptr) {
      edges.from = places_in_row(from);
      edges.to = places_in_row(to);
      edges.along = along_.empty() ? nullptr : along_.data() + 1;
      edges.origin = grid_.axes[0].origin();
      edges.step = grid_.axes[0].step();
      edges.mapped = grid_.has_world_map() ? &grid_ : nullptr;
      write_points(edges);
    }
    if (places_ == nullptr) return;
    for (std::size_t i = 0; i < edges.count; ++i) {
      Sample a = from, b = to;
      a[0] += edges.at[i];
      b[0] += edges.at[i];
      edges.out[i] =
          point_on_edge<Real>((*places_)[number_of<N>(grid_, a)], (*places_)[number_of<N>(grid_, b)], edges.alphas[i]);
    }
  }
  /// The normals of the vertices on edges of row r to the samples at these differences.
  void write_normals(const LatticePoints<N, Real>& edges, std::size_t r, const LatticePlace& to) const noexcept {
    const std::size_t other = r + rows_.steps(to);
    Vertex* const normals = contour_.normals.data() + (edges.out - contour_.vertices.data());
    for (std::size_t i = 0; i < edges.count; ++i) {
      const std::size_t at = edges.at[i];
      normals[i] = gradients_->template normal_between<Real>(
          row_gradients_->at(r, at), row_gradients_->at(other, at + static_cast<std::size_t>(to[0])), edges.alphas[i]);
    }
  }

  /// A cell with own vertices, and what these are means of.
  struct OwnCell {
    const LatticeCell* cell;
    std::array<Index, kMostEdges> vertices;                ///< by edge
    std::array<std::array<double, N>, kMostEdges> points;  ///< of these
    At at;                                                 ///< of the cell's sample
    std::pair<Real, Real> between;                         ///< times of vertices of prisms
    std::array<double, N> centre;                          ///< the mean of the corners, if it was added
  };

  /// Writes the own vertices of the active cells of a row from `number` on.
  void write_own_points(const At& row, const LatticeCellRow& cells, const EdgeStream* streams, Index number,
                        Scratch& scratch) const {
    scratch.active.resize(rows_.words() * kWordBits);
    const std::size_t count = list_cells(cells, scratch.active.data());
    OwnCell of;
    of.cell = cells.cell;
    of.at = row;
    if (is_layered_) of.between = times_after(row);
    for (const ActiveInRow& active : std::span(scratch.active).first(count)) {
      const std::size_t added = of.cell->contours[active.signature].own;
      if (added == 0) continue;
      of.at[0] = active.at;
      for (std::uint32_t rest = of.cell->crossed[active.signature]; rest != 0; rest &= rest - 1) {
        const auto e = static_cast<unsigned>(std::countr_zero(rest));
        const LatticeRows::Crossed crossed{streams[e].bits, streams[e].before};
        of.vertices[e] = streams[e].first + crossed[active.at + static_cast<std::size_t>(streams[e].at)];
        for (std::size_t a = 0; a < N; ++a) of.points[e][a] = double{contour_.vertices[of.vertices[e]][a]};
      }
      const auto vertices = std::span(of.cell->own).subspan(of.cell->first_own[active.signature], added);
      if (std::any_of(vertices.begin(), vertices.end(), [](const auto& own) { return own.part != 0.0; }))
        add_centre(of);
      for (const LatticeCell::OwnVertex& own : vertices) write_own_point(of, own, number++);
    }
  }
  void add_centre(OwnCell& of) const {
    VertexMean<N, Real> centre;
    for (const LatticePlace& to : of.cell->corners) centre.add(place_of(sample(of.at, to)));
    of.centre = centre.mean();
  }

  void write_own_point(const OwnCell& of, const LatticeCell::OwnVertex& own, Index number) const {
    VertexMean<N, Real> mean;
    for (const std::uint8_t e : std::span(own.edges).first(own.edge_count)) {
      mean.add(of.points[e]);
      if (gradients_ != nullptr) mean.add_normal(contour_.normals[of.vertices[e]]);
    }
    for (std::uint32_t rest = own.corners; rest != 0; rest &= rest - 1) {
      const LatticePlace& to = of.cell->corners[static_cast<std::size_t>(std::countr_zero(rest))];
      const Sample corner = sample(of.at, to);
      mean.add(place_of(corner));
      if (gradients_ != nullptr) mean.add_normal(gradients_->template normal_at<Real>(corner));
    }
    Vertex& vertex = contour_.vertices[number];
    vertex = own.part == 0.0 ? mean.place(false) : part_of_way<Real>(mean.mean(), of.centre, own.part);
    if (is_layered_ && own.is_between) vertex[N - 1] = std::clamp(vertex[N - 1], of.between.first, of.between.second);
    if (gradients_ != nullptr) contour_.normals[number] = LatticeGradients<N>::template unit<Real>(mean.normal());
  }
  [[nodiscard]] std::array<double, N> place_of(const Sample& sample) const {
    return places_ != nullptr ? (*places_)[number_of<N>(grid_, sample)] : lattice_place<N>(grid_, sample, layers_);
  }

  const SampleSource<N>& source_;
  ReadSamples read_;
  const Grid<N>& grid_;
  const LatticeRows& rows_;
  const LatticeGradients<N>* gradients_;
  const RowGradients<N>* row_gradients_;
  const std::vector<std::array<double, N>>* places_;
  int layers_;       ///< the axis of the layers
  bool is_layered_;  ///< whether cells are between two layers of the last axis
  double epsilon_;
  std::vector<double> along_;  ///< coordinates along the row; empty: uniform
  Contour<N, Real>& contour_;
};

/// Extracts by rows of bits. Returns false, and nothing else, if samples are missing. `read`, `places`: as in
/// LatticeWriter.
template <int N, class Real>
bool extract_by_rows(SampleSource<N>& source, ReadSamples read, const Grid<N>& grid, Lattice lattice,
                     const ExtractOptions& options, const std::vector<std::array<double, N>>* places,
                     Extraction<N, Real>& result) {
  const Progress& progress = options.work.progress;
  const unsigned threads = options.work.threads;
  LatticePatterns patterns = make_patterns<N>(lattice, grid, options);
  LatticeRows rows(lattice, four_sizes(grid), patterns);
  Stopwatch watch;
  if (rows.template classify<N>(source, {threads, part_of(progress, 0.0, 0.2)})) return false;
  watch.add_to(result.stats.classify_seconds);
  if constexpr (N == 4) {
    OccurringSignatures signatures(patterns);
    rows.find_signatures(signatures, {threads, part_of(progress, 0.2, 0.3)});
    add_contours(patterns, signatures, options.ambiguity, {threads, part_of(progress, 0.3, 0.35)});
  }
  rows.count({threads, part_of(progress, N == 4 ? 0.35 : 0.2, 0.5)});
  result.stats.tiles = rows.cells();
  result.stats.active_tiles = rows.active_cells();
  watch.add_to(result.stats.find_seconds);
  result.contour.vertices.resize(rows.vertices());
  result.contour.simplices.resize(rows.simplices());
  std::optional<LatticeGradients<N>> gradients;
  std::optional<RowGradients<N>> row_gradients;
  const double start = options.normals == Normals::none ? 0.5 : 0.7;
  if (options.normals != Normals::none) {
    gradients.emplace(source, grid, lattice, options.direction);
    row_gradients.emplace(rows, patterns, *gradients, WorkOptions{threads, part_of(progress, 0.5, start)});
    result.contour.normals.resize(rows.vertices());
  }
  const LatticeWriter<N, Real> writer(source, read, grid, lattice, rows, gradients ? &*gradients : nullptr,
                                      row_gradients ? &*row_gradients : nullptr, places, options, result.contour);
  using Scratch = typename LatticeWriter<N, Real>::Scratch;
  const auto for_rows = [&](const Progress& of, const auto& write) {
    constexpr std::size_t kRows = 64;
    for_each_block(
        rows.row_count(), kRows, threads, of, [] { return Scratch(); },
        [&](std::size_t, std::size_t from, std::size_t to, Scratch& scratch) {
          for (std::size_t r = from; r < to; ++r) write(r, scratch);
        });
  };
  const double middle = 0.5 * (1.0 + start);
  for_rows(part_of(progress, start, middle),
           [&](std::size_t r, Scratch& scratch) { writer.write_edge_points(r, scratch); });
  for_rows(part_of(progress, middle, 1.0), [&](std::size_t r, Scratch& scratch) { writer.write_cells(r, scratch); });
  watch.add_to(result.stats.generate_seconds);
  return true;
}

/// The contour of an image on a lattice. `places`: of samples, in place of those on the grid, without normals and
/// modulo no periods; null: none.
template <class Real, Value T, int N>
Extraction<N, Real> extract_on_lattice(const Image<T, N>& image, Lattice lattice, double isovalue,
                                       const ExtractOptions& options, const AxisPeriods<N>& periods,
                                       const std::vector<std::array<double, N>>* places) {
  check_lattice_arguments<N>(image.grid(), lattice, isovalue, options, periods);
  const Grid<N>& grid = image.grid();
  Extraction<N, Real> result;
  if (periodic_axes<N>(periods) == 0 && !options.close && has_rows(lattice, options) &&
      is_in_range<Real>(grid, layer_axis(lattice)) && (lattice != Lattice::fcc_in_time || has_prisms(grid))) {
    check_grid(grid, lattice, layer_axis(lattice));
    (void)count_samples(grid, "a lattice");
    ImageSource<T, N> samples(image, isovalue, options.epsilon);
    if (extract_by_rows<N, Real>(samples, &read_samples<T>, grid, lattice, options, places, result)) {
      describe(grid, options, result.contour);
      return result;
    }
  }
  const StoredLattice<T, N> stored(image, lattice, isovalue, options, periods);
  if (places != nullptr)
    return extract_with_stats<Real>(ComplexAccess::at_places<N>(stored.complex(), *places), isovalue, options);
  result = extract_in<Real>(stored.complex(), isovalue, options, stored.surroundings());
  describe(grid, options, result.contour);
  return result;
}

}  // namespace
}  // namespace detail

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4> Extraction<N, Real> extract_lattice_with_stats(const Image<T, N>& image,
                                                                                  Lattice lattice, double isovalue,
                                                                                  const ExtractOptions& options,
                                                                                  const AxisPeriods<N>& periods) {
  return detail::extract_on_lattice<Real, T, N>(image, lattice, isovalue, options, periods, nullptr);
}

template <Value T, int N>
requires DimensionBetween<N, 2, 4> Attribute interpolate_lattice(const Image<T, N>& image, Lattice lattice,
                                                                 double isovalue, std::span<const double> numbers,
                                                                 std::string name, std::string unit,
                                                                 const ExtractOptions& options,
                                                                 const AxisPeriods<N>& periods) {
  ExtractOptions of_numbers = options;
  of_numbers.normals = Normals::none;
  return detail::interpolate_as_places<N>(
      detail::count_samples(image.grid(), "a lattice"), numbers, {std::move(name), std::move(unit), 1, {}},
      [&](const std::vector<std::array<double, N>>& places) {
        return detail::extract_on_lattice<double, T, N>(image, lattice, isovalue, of_numbers, periods, &places).contour;
      });
}

#define TEGL_INSTANTIATE_REALS(T, N, Real)                                                                 \
  template Extraction<N, Real> extract_lattice_with_stats<Real, T, N>(const Image<T, N>&, Lattice, double, \
                                                                      const ExtractOptions&, const AxisPeriods<N>&);
#include "base/instantiate.hpp"
#define TEGL_INSTANTIATE_DIM(T, N)                                                                           \
  template Attribute interpolate_lattice<T, N>(const Image<T, N>&, Lattice, double, std::span<const double>, \
                                               std::string, std::string, const ExtractOptions&,              \
                                               const AxisPeriods<N>&);
#define TEGL_INSTANTIATE(T)  \
  TEGL_INSTANTIATE_DIM(T, 2) \
  TEGL_INSTANTIATE_DIM(T, 3) \
  TEGL_INSTANTIATE_DIM(T, 4)
#include "base/instantiate.hpp"
#undef TEGL_INSTANTIATE_DIM

}  // namespace tegl
