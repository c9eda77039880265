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
#include "image/row_source.hpp"
#include "kernel/memory_output.hpp"
#include "lattice/lattice_gradients.hpp"
#include "lattice/lattice_simplices.hpp"
#include "lattice/periodic_lattice.hpp"
#include "periodic/periods.hpp"
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

  /// `places`: of samples, in place of those on the grid; null: none.
  LatticeWriter(const SampleSource<N>& source, const Grid<N>& grid, const LatticeRows& rows,
                const LatticeGradients<N>* gradients, const std::vector<std::array<double, N>>* places,
                const ExtractOptions& options, Contour<N, Real>& contour)
      : source_(source),
        grid_(grid),
        rows_(rows),
        gradients_(gradients),
        places_(places),
        rows_in_layer_(N == 3 ? grid.axes[1].size() : 1),
        epsilon_(options.epsilon),
        is_mapped_(grid.has_world_map()),
        contour_(contour) {
    for (int a = 0; a < N; ++a)
      for (std::size_t i = 0; i < grid.axes[a].size(); ++i) coordinates_[a].push_back(grid.axes[a][i]);
    for (int a = 0; a + 1 < N; ++a) half_steps_[a] = 0.5 * grid.axes[a].step();
  }

  void write_edge_points(std::size_t r) const {
    const std::size_t j = r % rows_in_layer_, k = r / rows_in_layer_;
    const std::vector<EdgeKind>& kinds = rows_.pattern(k).edges;
    Index next = rows_.row(r).first;
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      if (!rows_.has_row(j, k, kinds[kind].to)) continue;
      const auto crossed = rows_.crossed(r, kind);
      const std::array<std::ptrdiff_t, 3>& to = kinds[kind].to;
      const RowPlaces from_row(*this, sample(0, j, k, {})), to_row(*this, sample(0, j, k, to));
      for (std::size_t w = 0; w < rows_.words(); ++w)
        for (Word rest = crossed.bits[w]; rest != 0; rest &= rest - 1) {
          const std::size_t i = w * kWordBits + static_cast<std::size_t>(std::countr_zero(rest));
          write_edge_point(sample(i, j, k, {}), sample(i, j, k, to), from_row, to_row, next++);
        }
    }
  }

  /// `active`: working memory.
  void write_cells(std::size_t r, std::vector<ActiveInRow>& active) const {
    const std::size_t j = r % rows_in_layer_, k = r / rows_in_layer_;
    const LatticeRows::Row& row = rows_.row(r);
    if (row.active == 0) return;
    Index own = row.first_own;
    auto* simplices = contour_.simplices.data() + row.first_simplex;
    for (const LatticeCell& cell : rows_.pattern(k).cells) {
      constexpr std::size_t kMostEdges = 12;
      std::array<EdgeStream, kMostEdges> streams;
      for (std::size_t e = 0; e < cell.edges.size(); ++e) {
        if (!rows_.has_row(j, k, cell.edges[e].at)) continue;  // then there are no cells
        const std::size_t of = rows_.row_at(j, k, cell.edges[e].at);
        streams[e] = {rows_.crossed(of, cell.edges[e].kind), rows_.row(of).first, cell.edges[e].at[0]};
      }
      if (row.own == 0) {
        active.clear();
        rows_.for_each_active(j, k, cell, [&](std::size_t i, unsigned signature) {
          active.push_back({static_cast<std::uint32_t>(i), signature});
        });
        simplices = write_simplices(cell, streams.data(), active, simplices);
        continue;
      }
      rows_.for_each_active(j, k, cell, [&](std::size_t i, unsigned signature) {
        const LatticeCell::Contour& contour = cell.contours[signature];
        std::array<Index, 32> vertices;
        for (std::uint32_t crossed = contour.crossed; crossed != 0; crossed &= crossed - 1) {
          const auto e = static_cast<unsigned>(std::countr_zero(crossed));
          vertices[e] = streams[e].first + streams[e].crossed[i + static_cast<std::size_t>(streams[e].at)];
        }
        for (std::size_t added = 0; added < contour.own; ++added, ++own) {
          vertices[cell.edges.size() + added] = own;
          write_own_point(contour.centres[added], vertices.data(), own);
        }
        const std::uint8_t* local = contour.vertices.data();
        for (std::uint32_t s = 0; s < contour.simplices; ++s, ++simplices, local += N)
          for (std::size_t v = 0; v < N; ++v) (*simplices)[v] = vertices[local[v]];
      });
    }
  }

 private:
  static Sample sample(std::size_t i, std::size_t j, std::size_t k, const std::array<std::ptrdiff_t, 3>& to) {
    Sample index{};
    index[0] = i + static_cast<std::size_t>(to[0]);
    if constexpr (N == 3) index[1] = j + static_cast<std::size_t>(to[1]);
    index[N - 1] = k + static_cast<std::size_t>(to[2]);
    return index;
  }
  /// The places of a row's samples.
  class RowPlaces {
   public:
    /// `in_row`: a sample of the row.
    RowPlaces(const LatticeWriter& writer, const Sample& in_row) : writer_(writer), in_row_(in_row) {
      if (writer.places_ != nullptr) return;
      const auto shift = [&](int a) { return in_row[N - 1] % 2 == 1 ? writer.half_steps_[a] : 0.0; };
      for (int a = 1; a < N; ++a) place_[a] = writer.coordinates_[a][in_row[a]] + shift(a);
      shift_ = shift(0);
    }
    [[nodiscard]] std::array<double, N> operator[](std::size_t i) const noexcept {
      if (writer_.places_ != nullptr) return given(i);
      std::array<double, N> x = place_;
      x[0] = writer_.coordinates_[0][i] + shift_;
      return writer_.is_mapped_ ? place_in_world<N>(writer_.grid_, x) : x;
    }

   private:
    [[nodiscard]] std::array<double, N> given(std::size_t i) const noexcept {
      Sample index = in_row_;
      index[0] = i;
      return (*writer_.places_)[number_of<N>(writer_.grid_, index)];
    }

    const LatticeWriter& writer_;
    Sample in_row_;
    std::array<double, N> place_{};
    double shift_ = 0.0;
  };

  void write_edge_point(const Sample& from, const Sample& to, const RowPlaces& from_row, const RowPlaces& to_row,
                        Index number) const {
    const double alpha = alpha_of(source_.value(from), source_.value(to), source_.isovalue(), epsilon_);
    contour_.vertices[number] = point_on_edge<Real>(from_row[from[0]], to_row[to[0]], alpha);
    if (gradients_ != nullptr) contour_.normals[number] = gradients_->template normal<Real>(from, to, alpha);
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
  const Grid<N>& grid_;
  const LatticeRows& rows_;
  const LatticeGradients<N>* gradients_;
  const std::vector<std::array<double, N>>* places_;
  std::size_t rows_in_layer_;
  double epsilon_;
  bool is_mapped_;
  std::array<std::vector<double>, N> coordinates_;
  std::array<double, N> half_steps_{};
  Contour<N, Real>& contour_;
};

/// Extracts by rows of bits. Returns false, and nothing else, if samples are missing. `places`: as in LatticeWriter.
template <int N, class Real>
bool extract_by_rows(SampleSource<N>& source, const Grid<N>& grid, Lattice lattice, const ExtractOptions& options,
                     const std::vector<std::array<double, N>>* places, Extraction<N, Real>& result) {
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
  const LatticeWriter<N, Real> writer(source, grid, rows, gradients ? &*gradients : nullptr, places, options,
                                      result.contour);
  for_each_item(rows.row_count(), threads, part_of(progress, 0.5, 0.75),
                [&](std::size_t r) { writer.write_edge_points(r); });
  for_each_part(rows.row_count(), threads, part_of(progress, 0.75, 1.0), [&](std::size_t from, std::size_t to) {
    std::vector<ActiveInRow> active;
    for (std::size_t r = from; r < to; ++r) writer.write_cells(r, active);
  });
  watch.add_to(result.stats.generate_seconds);
  return true;
}

template <int N>
void check_lattice_options(double isovalue, ExtractOptions options) {
  if (options.normals != Normals::none && options.normals != Normals::differences)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("normals on a lattice are {}; expected gradient (differences)", name_of(options.normals)));
  if (options.ambiguity != Ambiguity::low && options.ambiguity != Ambiguity::high)
    throw Error(ErrorCode::InvalidArgument,
                "ambiguity resolved from the data; expected low or high for the contour of a lattice");
  options.normals = Normals::none;
  check_complex_options(N, isovalue, options);
}

/// The contour of an image on a lattice. `places`: of samples, in place of those on the grid, without normals and
/// modulo no periods; null: none.
template <class Real, Value T, int N>
Extraction<N, Real> extract_on_lattice(const Image<T, N>& image, Lattice lattice, double isovalue,
                                       const ExtractOptions& options, const AxisPeriods<N>& periods,
                                       const std::vector<std::array<double, N>>* places) {
  check_lattice_options<N>(isovalue, options);
  check_dimension(lattice, N);
  const Grid<N>& grid = image.grid();
  const unsigned periodic = periodic_axes<N>(periods);
  if (periodic != 0) {
    check_lattice_periods<N>(grid, lattice, periods);
    check_periods<N>(grid, periods, options);
  }
  Extraction<N, Real> result;
  if constexpr (N < 4)
    if (periodic == 0 && !options.close && is_in_range<Real>(grid)) {
      check_grid(grid, lattice, N - 1);
      (void)count_samples(grid, "a lattice");
      ImageSource<T, N> samples(image, isovalue, options.epsilon);
      if (extract_by_rows<N, Real>(samples, grid, lattice, options, places, result)) {
        describe(grid, options, result.contour);
        return result;
      }
    }
  if (periodic != 0) check_grid(grid, lattice, N - 1);
  const Complex<N> complex =
      periodic == 0 ? lattice_complex(image, lattice) : periodic_lattice_complex(image, lattice, periods);
  if (places != nullptr)
    return extract_with_stats<Real>(ComplexAccess::at_places<N>(complex, *places), isovalue, options);
  Surroundings<N> around;
  if (periodic != 0) around.periods = world_periods<N>(grid, periods);
  const ImageSource<T, N> source(image, isovalue, options.epsilon);
  std::optional<LatticeGradients<N>> gradients;
  if (options.normals != Normals::none) {
    gradients.emplace(source, grid, lattice, options.direction, periodic, around.periods);
    around.gradient = [&, sizes = grid.sizes()](Index p) {
      std::array<std::size_t, N> index;
      for (int a = 0; a < N; p = static_cast<Index>(p / sizes[a]), ++a) index[a] = p % sizes[a];
      return gradients->at(index);
    };
  }
  result = extract_in<Real>(complex, isovalue, options, around);
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
