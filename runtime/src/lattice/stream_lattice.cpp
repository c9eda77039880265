// SPDX-License-Identifier: BSD-3-Clause
//
// Streamed contours of images on lattices. Some layers at a time are contoured together with the layers around them, on
// which their cells, vertices and gradients depend; the part of the contour that is theirs is passed on. In 4D, if fcc
// is resolved from the data, with caps, with periodic axes and from the first missing value on, their cells are stored
// (CellParts).
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/progress.hpp"
#include "base/stopwatch.hpp"
#include "image/row_source.hpp"
#include "lattice/cell_parts.hpp"
#include "lattice/lattice_grid.hpp"
#include "lattice/lattice_rows.hpp"
#include "periodic/periods.hpp"
#include "tegl/error.hpp"
#include "tegl/stream.hpp"

namespace tegl {
namespace detail {
namespace {

/// Layers before and behind the own layers of a part. Cells have their corners at most two layers away, and so have
/// edges and neighbours for gradients. Even, so that a part's odd layers are the image's.
constexpr std::ptrdiff_t kBefore = 4, kBehind = 6;
/// By rows of bits, the simplices of a part's last layers come with the next part, when all their vertices have
/// numbers.
constexpr std::ptrdiff_t kLag = 2;

void refuse(const std::string& message) { throw Error(ErrorCode::InvalidArgument, message); }

template <class Real, int N>
void check_stream(const Grid<N>& grid, Lattice lattice, const ExtractOptions& options, const AxisPeriods<N>& periods) {
  check_dimension(lattice, N);
  if (periodic_axes<N>(periods) != 0) {
    check_lattice_periods<N>(grid, lattice, periods);
    check_periods<N>(grid, periods, options);
  }
  check_grid(grid, lattice, layer_axis(lattice));
  if (const std::size_t times = grid.axes[N - 1].size(); lattice == Lattice::fcc_in_time && times < 2)
    refuse(fmt::format("{} times; expected at least 2", times));
  for (int row = 0; row < N; ++row) {
    double most = std::abs(grid.offset[row]);
    for (int a = 0; a < N; ++a) {
      const Axis& axis = grid.axes[a];
      most += std::abs(grid.linear[row][a]) *
              (std::max(std::abs(axis[0]), std::abs(axis[axis.size() - 1])) + std::abs(axis.step()));
    }
    if (most > double{std::numeric_limits<Real>::max()})
      refuse(fmt::format("coordinates up to {}; expected at most {}", most, std::numeric_limits<Real>::max()));
  }
}

/// Contours parts of an image, for one isovalue.
template <class Real, int N>
class LatticeStream {
 public:
  /// `grid`: of the whole image; must outlive this object. `by_rows`: whether rows of bits give the contour.
  LatticeStream(const StreamedContour<N, Real>& contour, const Grid<N>& grid, Lattice lattice,
                const AxisPeriods<N>& periods, const ExtractOptions& options, bool by_rows)
      : isovalue_(contour.isovalue),
        grid_(grid),
        lattice_(lattice),
        output_(*contour.sink, options.normals != Normals::none, world_periods<N>(grid, periods)) {
    if (!by_rows) parts_.emplace(grid, isovalue_, lattice, periods, world_periods<N>(grid, periods), output_);
  }

  /// `window`: the layers [part.begin, part.end) of the image. `by_rows`: false if a value is missing there or before.
  template <Value T>
  void add(const Image<T, N>& window, const PartLayers& part, const ExtractOptions& options, bool by_rows) {
    if constexpr (N < 4) {
      if (!parts_ && by_rows) return add_rows(window, part, options);
      if (!parts_) hand_over(window, part, options);
    }
    parts_->add(window, part, options, stats_);
  }
  [[nodiscard]] ExtractedSize finish(double read_seconds) {
    output_.separate_sheets();
    stats_.read_seconds = read_seconds;
    return {output_.size(), stats_};
  }

 private:
  using Ends = typename CellParts<Real, N>::Ends;

  template <Value T>
  LatticeRows rows_of(const Image<T, N>& window, const LatticePatterns& patterns, const ExtractOptions& options) const {
    LatticeRows rows(lattice_, four_sizes(window.grid()), patterns);
    const ImageSource<T, N> samples(window, isovalue_, options.epsilon);
    (void)rows.template classify<N>(samples, {options.work.threads});
    rows.count({options.work.threads});
    return rows;
  }
  [[nodiscard]] std::size_t rows_in_layer() const { return N == 3 ? grid_.axes[1].size() : 1; }
  /// The number of the first row of a layer.
  [[nodiscard]] std::size_t first_row(const PartLayers& part, std::ptrdiff_t layer) const {
    return static_cast<std::size_t>(layer - part.begin) * rows_in_layer();
  }
  static std::uint64_t first_vertex(const LatticeRows& rows, std::size_t r) {
    return r < rows.row_count() ? rows.row(r).first : rows.vertices();
  }
  static std::uint64_t first_simplex(const LatticeRows& rows, std::size_t r) {
    return r < rows.row_count() ? rows.row(r).first_simplex : rows.simplices();
  }

  /// The contour of a window with the normals of the whole image.
  template <Value T>
  Contour<N, Real> contour_of(const Image<T, N>& window, const ExtractOptions& options) {
    ExtractOptions without = options;
    const bool weighs_as_whole = options.normals != Normals::none && grid_.axes[N - 1].is_uniform();
    if (weighs_as_whole) without.normals = Normals::none;
    auto [contour, stats] = extract_lattice_with_stats<Real>(window, lattice_, isovalue_, without);
    stats_.classify_seconds += stats.classify_seconds;
    stats_.find_seconds += stats.find_seconds;
    stats_.generate_seconds += stats.generate_seconds;
    if (!weighs_as_whole) return std::move(contour);
    // the layers of a part are stored as coordinates: normals need the axis, but not its places
    Grid<N> at_start = window.grid();
    at_start.axes[N - 1] = Axis::uniform(window.size(N - 1), grid_.axes[N - 1].origin(), grid_.axes[N - 1].step());
    const Image<T, N> moved(window.data(), at_start, window.strides());
    contour.normals = std::move(extract_lattice<Real>(moved, lattice_, isovalue_, options).normals);
    return std::move(contour);
  }

  template <Value T>
  void add_rows(const Image<T, N>& window, const PartLayers& part, const ExtractOptions& options) {
    const auto patterns = make_patterns<N>(lattice_, window.grid(), options);
    const LatticeRows rows = rows_of(window, patterns, options);
    const Contour<N, Real> contour = contour_of(window, options);
    const std::size_t from = first_row(part, part.first), to = first_row(part, part.last);
    const std::uint64_t first = first_vertex(rows, from), count = first_vertex(rows, to) - first;
    // Vertices are numbered by layers, so the part's numbers differ from the image's by a constant.
    number_by_rows(contour.vertices.size(), first);
    output_.add(
        std::span(contour.vertices).subspan(first, count),
        std::span(contour.normals).subspan(contour.normals.empty() ? 0 : first, contour.normals.empty() ? 0 : count));
    const auto last = static_cast<std::ptrdiff_t>(grid_.axes[N - 1].size());
    const std::ptrdiff_t simplices_to = part.last == last ? last : part.last - kLag;
    add_simplices(contour, rows, first_row(part, part.first - (part.first == 0 ? 0 : kLag)),
                  first_row(part, simplices_to));
    for (std::size_t r = from; r < to; ++r) {
      stats_.tiles += rows.cells(r);
      stats_.active_tiles += rows.row(r).active;
    }
  }
  /// Numbers the vertices of a window; `first`: the first one that was not passed.
  void number_by_rows(std::size_t vertices, std::uint64_t first) {
    numbers_.resize(vertices);
    for (std::size_t v = 0; v < vertices; ++v) numbers_[v] = output_.size().vertices - first + v;
  }
  void add_simplices(const Contour<N, Real>& contour, const LatticeRows& rows, std::size_t from, std::size_t to) {
    const std::uint64_t first = first_simplex(rows, from), end = first_simplex(rows, to);
    output_.add(contour, std::span(contour.simplices).subspan(first, end - first), numbers_, {});
  }

  /// From this part on, cells are stored. Passes the simplices that are still missing before them.
  template <Value T>
  void hand_over(const Image<T, N>& window, const PartLayers& part, const ExtractOptions& options) {
    parts_.emplace(grid_, isovalue_, lattice_, AxisPeriods<N>{}, std::vector<Period<N>>{}, output_);
    if (part.first == 0) return;
    // no value is missing in the layers that the part before had
    const std::ptrdiff_t end = std::min(part.end, part.first + kBehind);
    Grid<N> grid = window.grid();
    grid.axes[N - 1] = grid.axes[N - 1].part(0, static_cast<std::size_t>(end - part.begin));
    const Image<T, N> known(window.data(), grid, window.strides());
    const auto patterns = make_patterns<N>(lattice_, grid, options);
    const LatticeRows rows = rows_of(known, patterns, options);
    const Contour<N, Real> contour = contour_of(known, options);
    const std::uint64_t passed = first_vertex(rows, first_row(part, part.first));
    number_by_rows(contour.vertices.size(), passed);
    // vertices in front, on edges only, in the order of the simplices that have them
    constexpr std::uint64_t kNone = ~std::uint64_t{0};
    std::fill(numbers_.begin() + static_cast<std::ptrdiff_t>(passed), numbers_.end(), kNone);
    const std::size_t from = first_row(part, part.first - kLag), to = first_row(part, part.first);
    for (std::uint64_t s = first_simplex(rows, from); s < first_simplex(rows, to); ++s)
      for (const Index v : contour.simplices[s]) {
        if (numbers_[v] != kNone) continue;
        numbers_[v] = output_.size().vertices;
        const auto normals = std::span(contour.normals);
        output_.add(std::span(contour.vertices).subspan(v, 1),
                    normals.subspan(normals.empty() ? 0 : v, normals.empty() ? 0 : 1));
      }
    add_simplices(contour, rows, from, to);
    for (std::size_t r = first_row(part, part.first - 1); r < first_row(part, std::min(end, part.first + 2)); ++r)
      know_edges(rows, r, part);
    parts_->end_known();
  }
  /// Tells the parts to come the vertices on the edges of a row that have numbers.
  void know_edges(const LatticeRows& rows, std::size_t r, const PartLayers& part) {
    const std::size_t samples = grid_.axes[0].size();
    const auto& kinds = rows.pattern(rows.at(r)).edges;
    const auto start =
        static_cast<std::ptrdiff_t>((static_cast<std::size_t>(part.begin) * rows_in_layer() + r) * samples);
    Index v = rows.row(r).first;
    if (v == rows.row(r).first_own) return;
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      const auto& to = kinds[kind].to;
      const std::ptrdiff_t step =
          static_cast<std::ptrdiff_t>(rows.steps(to)) * static_cast<std::ptrdiff_t>(samples) + to[0];
      for (std::size_t w = 0; w < rows.words(); ++w)
        for (Word rest = rows.crossed(r, kind).bits[w]; rest != 0; rest &= rest - 1, ++v) {
          if (numbers_[v] == ~std::uint64_t{0}) continue;
          const std::ptrdiff_t from =
              start + static_cast<std::ptrdiff_t>(w * kWordBits + static_cast<std::size_t>(std::countr_zero(rest)));
          parts_->know({static_cast<std::uint64_t>(from), static_cast<std::uint64_t>(from + step)}, numbers_[v]);
        }
    }
  }

  double isovalue_;
  const Grid<N>& grid_;
  Lattice lattice_;
  PartOutput<N, Real> output_;
  std::optional<CellParts<Real, N>> parts_;  ///< none: by rows
  ExtractStats stats_;
  std::vector<std::uint64_t> numbers_;  ///< by vertex of the window
};

/// The layers of a reader that a part needs. If the last axis is periodic, those that come again are kept.
template <Value T, int N>
class LayerWindow {
 public:
  /// `period`: of the last axis, or 0.
  LayerWindow(LayerReader<T, N>& reader, double period) : reader_(reader), period_(period) {
    for (int a = 0; a + 1 < N; ++a) layer_ *= reader.grid().axes[a].size();
    if (period_ != 0.0) kept_.resize(count());
  }
  [[nodiscard]] std::size_t count() const { return reader_.grid().axes[N - 1].size(); }
  /// Number of layers of a part with so many samples, but `least` at least: large layers are few, so that the layers
  /// around them are not the most.
  [[nodiscard]] std::ptrdiff_t layers_with(std::size_t samples, std::size_t least) const noexcept {
    return static_cast<std::ptrdiff_t>(std::max(least, samples / layer_ / 2 * 2));
  }
  /// The own layers from `first` on.
  [[nodiscard]] PartLayers part(std::ptrdiff_t first, std::ptrdiff_t layers) const {
    const auto count = static_cast<std::ptrdiff_t>(this->count());
    PartLayers part{first - kBefore, first, std::min(count, first + layers), 0};
    part.end = part.last + kBehind;
    if (period_ == 0.0) {
      part.begin = std::max<std::ptrdiff_t>(part.begin, 0);
      part.end = std::min(part.end, count);
    }
    return part;
  }
  /// A view of the part's layers. They begin and end later from call to call, or end earlier.
  [[nodiscard]] Image<T, N> layers(const PartLayers& part) {
    if (!has_begun_) begin_ = read_ = part.begin;
    has_begun_ = true;
    const auto at = [&](std::ptrdiff_t k) {
      return values_.begin() + (k - begin_) * static_cast<std::ptrdiff_t>(layer_);
    };
    std::move(at(part.begin), at(read_), values_.begin());
    begin_ = part.begin;
    values_.resize(static_cast<std::size_t>(std::max(part.end, read_) - begin_) * layer_);
    for (; read_ < part.end; ++read_) read(values_.data() + (read_ - begin_) * static_cast<std::ptrdiff_t>(layer_));
    Grid<N> grid = reader_.grid();
    grid.axes[N - 1] = axis_of_layers(grid.axes[N - 1], period_, part.begin, part.end);
    return Image<T, N>(values_.data(), std::move(grid));
  }
  /// Whether a value of the layers read so far is missing.
  [[nodiscard]] bool any_missing() const noexcept { return any_missing_; }

 private:
  void read(T* to) {
    const std::size_t k = layer_modulo(read_, count());
    const std::ptrdiff_t layer = static_cast<std::ptrdiff_t>(k), last = static_cast<std::ptrdiff_t>(count());
    if (period_ != 0.0 && !kept_[k].empty()) {
      std::copy(kept_[k].begin(), kept_[k].end(), to);
      return;
    }
    reader_.read(k, to);
    if constexpr (std::is_floating_point_v<T>)
      any_missing_ = any_missing_ || std::any_of(to, to + layer_, [](T value) { return std::isnan(value); });
    if (period_ != 0.0 && (layer < kBehind || layer + kBefore >= last)) kept_[k].assign(to, to + layer_);
  }

  LayerReader<T, N>& reader_;
  double period_;
  std::size_t layer_ = 1;
  bool has_begun_ = false, any_missing_ = false;
  std::ptrdiff_t begin_ = 0, read_ = 0;  ///< the first layer in `values_`, and the one after the last
  Buffer<T> values_;
  std::vector<std::vector<T>> kept_;
};

/// The contours of a reader's image, to their sinks.
template <class Real, Value T, int N>
std::vector<ExtractedSize> stream_layers(LayerReader<T, N>& layers, Lattice lattice,
                                         std::span<const StreamedContour<N, Real>> contours,
                                         const ExtractOptions& options, const AxisPeriods<N>& periods) {
  for (const auto& contour : contours)
    if (contour.sink == nullptr) refuse("a contour without a sink; expected one each");
  const Grid<N> grid = layers.grid();
  check_stream<Real>(grid, lattice, options, periods);
  bool by_rows = N < 4 && has_rows(lattice, options) && !options.close && periods == AxisPeriods<N>{};
  std::deque<LatticeStream<Real, N>> streams;  // not movable
  for (const auto& contour : contours) streams.emplace_back(contour, grid, lattice, periods, options, by_rows);
  if (contours.empty()) return {};
  LayerWindow<T, N> window(layers, periods[N - 1]);
  const auto count = static_cast<std::ptrdiff_t>(window.count());
  double read_seconds = 0.0;
  for (std::ptrdiff_t first = 0; first < count;) {
    const auto next_part = [&] {
      return window.part(
          first, by_rows ? window.layers_with(std::size_t{1} << 18, 16) : window.layers_with(std::size_t{1} << 16, 2));
    };
    PartLayers part = next_part();
    Stopwatch watch;
    Image<T, N> image = window.layers(part);
    if (by_rows && window.any_missing()) {
      by_rows = false;
      image = window.layers(part = next_part());
    }
    watch.add_to(read_seconds);
    for (std::size_t i = 0; i < streams.size(); ++i) {
      const auto share = [&](std::size_t done) {
        const double of_part = static_cast<double>(done) / static_cast<double>(streams.size());
        return (static_cast<double>(first) + of_part * static_cast<double>(part.last - first)) /
               static_cast<double>(count);
      };
      ExtractOptions one = options;
      one.work.progress = part_of(options.work.progress, share(i), share(i + 1));
      streams[i].add(image, part, one, by_rows);
    }
    first = part.last;
  }
  std::vector<ExtractedSize> results;
  for (auto& stream : streams) results.push_back(stream.finish(read_seconds));
  return results;
}

}  // namespace
}  // namespace detail

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4> std::vector<ExtractedSize> extract_lattice_streamed_several(
    LayerReader<T, N>& layers, Lattice lattice,
    std::type_identity_t<std::span<const StreamedContour<N, Real>>> contours, const ExtractOptions& options,
    const AxisPeriods<N>& periods) {
  return detail::stream_layers<Real>(layers, lattice, contours, options, periods);
}

#define TEGL_INSTANTIATE_ONE(T, N, Real)                                                             \
  template std::vector<ExtractedSize> extract_lattice_streamed_several<Real, T, N>(                  \
      LayerReader<T, N>&, Lattice, std::span<const StreamedContour<N, Real>>, const ExtractOptions&, \
      const AxisPeriods<N>&);
#define TEGL_INSTANTIATE(T)          \
  TEGL_INSTANTIATE_ONE(T, 2, float)  \
  TEGL_INSTANTIATE_ONE(T, 2, double) \
  TEGL_INSTANTIATE_ONE(T, 3, float)  \
  TEGL_INSTANTIATE_ONE(T, 3, double) \
  TEGL_INSTANTIATE_ONE(T, 4, float)  \
  TEGL_INSTANTIATE_ONE(T, 4, double)
#include "base/instantiate.hpp"
#undef TEGL_INSTANTIATE_ONE

}  // namespace tegl
