// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images on lattices: by rows of bits in 2D and 3D, otherwise as complexes; normals by gradients on the
// lattice.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
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
#include "image/edge_alphas.hpp"
#include "image/row_source.hpp"
#include "kernel/extract_points.hpp"
#include "kernel/memory_output.hpp"
#include "lattice/lattice_gradients.hpp"
#include "lattice/lattice_points.hpp"
#include "lattice/lattice_rows.hpp"
#include "lattice/lattice_simplices.hpp"
#include "lattice/stored_lattice.hpp"
#include "tegl/error.hpp"
#include "tegl/lattice.hpp"
#include "tegl/normals.hpp"

namespace tegl {
namespace detail {
namespace {

/// Whether all samples are within the range of Real, so that vertices are.
template <class Real, int N>
bool is_in_range(const Grid<N>& grid) {
  Vector<N> size{};
  for (int row = 0; row < N; ++row) {
    size[row] = std::abs(grid.offset[row]);
    for (int a = 0; a < N; ++a) {
      const Axis& axis = grid.axes[a];
      const double most = std::max(std::abs(axis[0]), std::abs(axis[axis.size() - 1]));
      size[row] += std::abs(grid.linear[row][a]) * (most + std::abs(axis.size() > 1 ? axis.step() : 0.0));
    }
  }
  return std::all_of(size.begin(), size.end(), [](double x) { return x <= double{std::numeric_limits<Real>::max()}; });
}

/// Writes a contour that LatticeRows has counted.
template <int N, class Real>
class LatticeWriter {
 public:
  using Vertex = std::array<Real, N>;
  using Sample = std::array<std::size_t, N>;

  /// Working memory of a thread.
  struct Scratch {
    std::vector<ActiveInRow> active;
    // by edge of a row
    std::vector<std::uint32_t> at;
    std::vector<double> from, to, alphas;
  };

  /// `read`: for the samples' type. `places`: of samples, in place of those on the grid; null: none.
  LatticeWriter(const SampleSource<N>& source, ReadSamples read, const Grid<N>& grid, const LatticeRows& rows,
                const LatticeGradients<N>* gradients, const std::vector<std::array<double, N>>* places,
                const ExtractOptions& options, Contour<N, Real>& contour)
      : source_(source),
        read_(read),
        grid_(grid),
        rows_(rows),
        gradients_(gradients),
        places_(places),
        rows_in_layer_(N == 3 ? grid.axes[1].size() : 1),
        epsilon_(options.epsilon),
        contour_(contour) {
    const Axis& along = grid.axes[0];
    if (along.is_uniform()) return;
    // with an entry more at both ends, for positions that are read but not used
    along_.resize(along.size() + 2);
    for (std::size_t i = 0; i < along.size(); ++i) along_[i + 1] = along[i];
  }

  void write_edge_points(std::size_t r, Scratch& scratch) const {
    const std::size_t j = r % rows_in_layer_, k = r / rows_in_layer_;
    const std::size_t count = rows_.row(r).first_own - rows_.row(r).first;
    if (count == 0) return;
    for (std::vector<double>* list : {&scratch.from, &scratch.to, &scratch.alphas})
      if (list->size() < count + kMargin) list->resize(count + kMargin);
    if (scratch.at.size() < count + kMargin) scratch.at.resize(count + kMargin);
    // the samples at both ends
    const std::vector<EdgeKind>& kinds = rows_.pattern(k).edges;
    std::array<std::size_t, kMostKinds + 1> first{};
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      const std::size_t at = first[kind];
      first[kind + 1] = at;
      if (!rows_.has_row(j, k, kinds[kind].to)) continue;
      std::uint32_t* const list = scratch.at.data() + at;
      const std::size_t more = list_bits(rows_.crossed(r, kind).bits, rows_.words(), list);
      first[kind + 1] += more;
      read_(row_of(j, k, {}), list, more, scratch.from.data() + at);
      read_(row_of(j, k, kinds[kind].to), list, more, scratch.to.data() + at);
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
      write_row(edges, sample(0, j, k, {}), sample(0, j, k, kinds[kind].to));
    }
  }

  void write_cells(std::size_t r, Scratch& scratch) const {
    const std::size_t j = r % rows_in_layer_, k = r / rows_in_layer_;
    const LatticeRows::Row& row = rows_.row(r);
    if (row.active == 0) return;
    Index own = row.first_own;
    auto* simplices = contour_.simplices.data() + row.first_simplex;
    for (const LatticeCell& cell : rows_.pattern(k).cells) {
      if (!rows_.applies(j, k, cell)) continue;
      std::array<EdgeStream, kMostEdges> streams;
      for (std::size_t e = 0; e < cell.edges.size(); ++e) {
        const std::size_t of = rows_.row_at(j, k, cell.edges[e].at);
        const LatticeRows::Crossed crossed = rows_.crossed(of, cell.edges[e].kind);
        streams[e] = EdgeStream{crossed.bits, crossed.before, rows_.row(of).first, cell.edges[e].at[0]};
      }
      const LatticeCellRow cells = rows_.cells_of_row(j, k, cell);
      if (cell.has_lists) {
        auto* const end = contour_.simplices.data() + row.first_simplex + row.simplices;
        simplices = write_simplices(cells, streams.data(), simplices, end);
        continue;
      }
      scratch.active.resize(rows_.words() * kWordBits);
      const std::size_t count = list_cells(cells, scratch.active.data());
      for (std::size_t c = 0; c < count; ++c)
        simplices = write_cell(cell, streams.data(), scratch.active[c], own, simplices);
    }
  }

 private:
  static constexpr std::size_t kMostEdges = 12;  ///< of a cell
  static constexpr std::size_t kMostKinds = 16;  ///< of edges of a sample
  static constexpr std::size_t kMargin = LatticePoints<N, Real>::kMargin;

  static Sample sample(std::size_t i, std::size_t j, std::size_t k, const std::array<std::ptrdiff_t, 3>& to) {
    Sample index{};
    index[0] = i + static_cast<std::size_t>(to[0]);
    if constexpr (N == 3) index[1] = j + static_cast<std::size_t>(to[1]);
    index[N - 1] = k + static_cast<std::size_t>(to[2]);
    return index;
  }

  /// The samples at these differences from those of row j of layer k.
  [[nodiscard]] RowOfSamples row_of(std::size_t j, std::size_t k,
                                    const std::array<std::ptrdiff_t, 3>& to) const noexcept {
    const Sample at = sample(0, j, k, to);
    const LayerInMemory layer = source_.layer_in_memory(at[N - 1]);
    const std::ptrdiff_t rows = N == 3 ? static_cast<std::ptrdiff_t>(at[1]) * source_.strides()[1] : 0;
    return {layer.first + rows * layer.step_bytes + to[0] * layer.sample_bytes, layer.sample_bytes};
  }

  /// Sets the coordinates of the samples from `first` on, which is on the grid modulo 2^64 along axis 0.
  [[nodiscard]] PlacesInRow<N> places_in_row(const Sample& first) const noexcept {
    const auto shift = [&](int a) { return first[N - 1] % 2 == 1 ? 0.5 * grid_.axes[a].step() : 0.0; };
    PlacesInRow<N> places{shift(0), static_cast<std::ptrdiff_t>(first[0])};
    for (int a = 1; a < N; ++a) places.others[a] = grid_.axes[a][first[a]] + (a + 1 < N ? shift(a) : 0.0);
    return places;
  }

  /// Writes the vertices and normals on edges from samples of one row to those of another. `from`, `to`: the ends of
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
    if (places_ == nullptr && gradients_ == nullptr) return;
    for (std::size_t i = 0; i < edges.count; ++i) {
      Sample a = from, b = to;
      a[0] += edges.at[i];
      b[0] += edges.at[i];
      if (places_ != nullptr)
        edges.out[i] = point_on_edge<Real>((*places_)[number_of<N>(grid_, a)], (*places_)[number_of<N>(grid_, b)],
                                           edges.alphas[i]);
      if (gradients_ == nullptr) continue;
      const auto number = static_cast<std::size_t>(edges.out - contour_.vertices.data()) + i;
      contour_.normals[number] = gradients_->template normal<Real>(a, b, edges.alphas[i]);
    }
  }

  /// Writes the simplices of a cell that may have own vertices, and these, from `own` on; returns the end.
  auto* write_cell(const LatticeCell& cell, const EdgeStream* streams, const ActiveInRow& active, Index& own,
                   std::array<Index, N>* simplices) const noexcept {
    const LatticeCell::Contour& contour = cell.contours[active.signature];
    std::array<Index, 32> vertices;
    for (std::uint32_t crossed = contour.crossed; crossed != 0; crossed &= crossed - 1) {
      const auto e = static_cast<unsigned>(std::countr_zero(crossed));
      const LatticeRows::Crossed of{streams[e].bits, streams[e].before};
      vertices[e] = streams[e].first + of[active.at + static_cast<std::size_t>(streams[e].at)];
    }
    for (std::size_t added = 0; added < contour.own; ++added, ++own) {
      vertices[cell.edges.size() + added] = own;
      write_own_point(contour.centres[added], vertices.data(), own);
    }
    const std::uint8_t* local = contour.vertices.data();
    for (std::uint32_t s = 0; s < contour.simplices; ++s, ++simplices, local += N)
      for (std::size_t v = 0; v < N; ++v) (*simplices)[v] = vertices[local[v]];
    return simplices;
  }

  /// The barycentre of points on edges.
  void write_own_point(std::uint32_t edges, const Index* vertices, Index number) const {
    std::array<double, N> sum{}, normal{};
    double count = 0;
    for (; edges != 0; edges &= edges - 1, ++count) {
      const Index v = vertices[std::countr_zero(edges)];
      for (int a = 0; a < N; ++a) {
        sum[a] += double{contour_.vertices[v][a]};
        if (gradients_ != nullptr) normal[a] += double{contour_.normals[v][a]};
      }
    }
    for (int a = 0; a < N; ++a) contour_.vertices[number][a] = static_cast<Real>(sum[a] / count);
    if (gradients_ != nullptr) contour_.normals[number] = LatticeGradients<N>::template unit<Real>(normal);
  }

  const SampleSource<N>& source_;
  ReadSamples read_;
  const Grid<N>& grid_;
  const LatticeRows& rows_;
  const LatticeGradients<N>* gradients_;
  const std::vector<std::array<double, N>>* places_;
  std::size_t rows_in_layer_;
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
  const std::array<LayerPattern, 2> patterns = make_patterns<N>(lattice, grid, options);
  const auto sizes = grid.sizes();
  LatticeRows rows({sizes[0], N == 3 ? sizes[1] : 1, sizes[N - 1]}, patterns);
  Stopwatch watch;
  if (rows.template classify<N>(source, {threads, part_of(progress, 0.0, 0.2)})) return false;
  watch.add_to(result.stats.classify_seconds);
  rows.count({threads, part_of(progress, 0.2, 0.5)});
  result.stats.tiles = rows.cells();
  result.stats.active_tiles = rows.active_cells();
  watch.add_to(result.stats.find_seconds);
  result.contour.vertices.resize(rows.vertices());
  result.contour.simplices.resize(rows.simplices());
  std::optional<LatticeGradients<N>> gradients;
  if (options.normals != Normals::none) {
    gradients.emplace(source, grid, lattice, options.direction);
    result.contour.normals.resize(rows.vertices());
  }
  const LatticeWriter<N, Real> writer(source, read, grid, rows, gradients ? &*gradients : nullptr, places, options,
                                      result.contour);
  for_each_part(rows.row_count(), threads, part_of(progress, 0.5, 0.75), [&](std::size_t from, std::size_t to) {
    typename LatticeWriter<N, Real>::Scratch scratch;
    for (std::size_t r = from; r < to; ++r) writer.write_edge_points(r, scratch);
  });
  for_each_part(rows.row_count(), threads, part_of(progress, 0.75, 1.0), [&](std::size_t from, std::size_t to) {
    typename LatticeWriter<N, Real>::Scratch scratch;
    for (std::size_t r = from; r < to; ++r) writer.write_cells(r, scratch);
  });
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
  if constexpr (N < 4)
    if (periodic_axes<N>(periods) == 0 && !options.close && has_rows(lattice, options.ambiguity) &&
        is_in_range<Real>(grid)) {
      check_grid(grid, lattice, N - 1);
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
