// SPDX-License-Identifier: BSD-3-Clause
//
// Streamed contours of images on lattices. Some layers at a time are contoured together with the layers around them, on
// which their cells, vertices and gradients depend; the part of the contour that is theirs is passed on. In 4D, and if
// fcc is resolved from the data, their cells are stored (CellParts).
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/progress.hpp"
#include "base/stopwatch.hpp"
#include "image/row_source.hpp"
#include "lattice/cell_parts.hpp"
#include "lattice/lattice_grid.hpp"
#include "lattice/lattice_rows.hpp"
#include "tegl/error.hpp"
#include "tegl/stream.hpp"

namespace tegl {
namespace detail {
namespace {

/// Layers before and behind the own layers of a part. Cells have their corners at most two layers away, and so have
/// edges and neighbours for gradients. Even, so that a part's odd layers are the image's.
constexpr std::size_t kBefore = 4, kBehind = 6;

/// What the own layers of a part have of the part's contour.
struct OwnNumbers {
  std::uint64_t first_vertex = 0, end_vertex = 0, first_simplex = 0, end_simplex = 0, cells = 0, active = 0;
};

void refuse(const std::string& message) { throw Error(ErrorCode::InvalidArgument, message); }

/// Throws InvalidArgument for what only lattices in memory have.
template <class Real, int N>
void check_stream(const Grid<N>& grid, Lattice lattice, const ExtractOptions& options) {
  check_dimension(lattice, N);
  if (options.close)
    refuse(fmt::format("close of a streamed contour on the lattice {}; expected an image in memory", name_of(lattice)));
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
  /// `by_rows`: whether rows of bits give the contour.
  LatticeStream(const StreamedContour<N, Real>& contour, Lattice lattice, bool by_rows)
      : contour_(contour), lattice_(lattice) {
    if (!by_rows) parts_.emplace(contour, lattice);
  }

  /// `image`: the layers [part.begin, part.end) of the image on `grid`.
  template <Value T>
  void add(const Image<T, N>& image, const Grid<N>& grid, const PartLayers& part, const ExtractOptions& options) {
    if (parts_) return parts_->add(image, grid, part, options, [&] { refuse_missing(part); });
    if constexpr (N < 4) add_rows(image, grid, part, options);
  }
  [[nodiscard]] ExtractedSize result(double read_seconds) const {
    ExtractedSize result = parts_ ? ExtractedSize{parts_->size(), parts_->stats()} : ExtractedSize{size_, stats_};
    result.stats.read_seconds = read_seconds;
    return result;
  }

 private:
  [[noreturn]] void refuse_missing(const PartLayers& part) const {
    throw Error(ErrorCode::UnsupportedData,
                fmt::format("missing values between layers {} and {} of a streamed image on the lattice {}; expected "
                            "none, or an image in memory",
                            part.begin, part.end - 1, name_of(lattice_)));
  }
  template <Value T>
  void add_rows(const Image<T, N>& image, const Grid<N>& grid, const PartLayers& part, const ExtractOptions& options) {
    const OwnNumbers own = own_numbers(image, part, options);
    ExtractOptions without = options;
    const bool weighs_as_whole = options.normals != Normals::none && grid.axes[N - 1].is_uniform();
    if (weighs_as_whole) without.normals = Normals::none;
    auto made = extract_lattice_with_stats<Real>(image, lattice_, contour_.isovalue, without);
    if (weighs_as_whole) made.contour.normals = normals_of(image, grid, options);
    pass(made.contour, own, options.normals != Normals::none);
    stats_.tiles += own.cells;
    stats_.active_tiles += own.active;
    stats_.classify_seconds += made.stats.classify_seconds;
    stats_.find_seconds += made.stats.find_seconds;
    stats_.generate_seconds += made.stats.generate_seconds;
  }
  template <Value T>
  OwnNumbers own_numbers(const Image<T, N>& image, const PartLayers& part, const ExtractOptions& options) const {
    const auto sizes = image.grid().sizes();
    const std::size_t rows_in_layer = N == 3 ? sizes[1] : 1;
    const auto patterns = make_patterns<N>(lattice_, image.grid(), options);
    LatticeRows rows({sizes[0], rows_in_layer, sizes[N - 1]}, patterns);
    const ImageSource<T, N> samples(image, contour_.isovalue, options.epsilon);
    if (rows.template classify<N>(samples, {options.work.threads})) refuse_missing(part);
    rows.count({options.work.threads});
    const std::size_t from = (part.first - part.begin) * rows_in_layer, to = (part.last - part.begin) * rows_in_layer;
    OwnNumbers own{rows.row(from).first, rows.vertices(), rows.row(from).first_simplex, rows.simplices()};
    if (to < rows.row_count()) {
      own.end_vertex = rows.row(to).first;
      own.end_simplex = rows.row(to).first_simplex;
    }
    for (std::size_t r = from; r < to; ++r) {
      own.cells += rows.row(r).cells;
      own.active += rows.row(r).active;
    }
    return own;
  }
  /// The normals by weights from the image's first layers, as for the whole image.
  template <Value T>
  Buffer<std::array<Real, N>> normals_of(const Image<T, N>& image, const Grid<N>& grid,
                                         const ExtractOptions& options) const {
    Grid<N> at_start = image.grid();
    at_start.axes[N - 1] = grid.axes[N - 1].part(0, image.size(N - 1));
    return std::move(extract_lattice<Real>(Image<T, N>(image.data(), at_start, image.strides()), lattice_,
                                           contour_.isovalue, options)
                         .normals);
  }
  void pass(const Contour<N, Real>& part, const OwnNumbers& own, bool normals) {
    const std::size_t count = own.end_vertex - own.first_vertex;
    contour_.sink->add_vertices(std::span(part.vertices).subspan(own.first_vertex, count));
    if (normals) contour_.sink->add_normals(std::span(part.normals).subspan(own.first_vertex, count));
    // Vertices are numbered by layers, so the part's numbers differ from the image's by a constant.
    const std::uint64_t more = size_.vertices - own.first_vertex;
    simplices_.clear();
    for (std::uint64_t s = own.first_simplex; s < own.end_simplex; ++s) {
      auto& wide = simplices_.emplace_back();
      for (int j = 0; j < N; ++j) wide[j] = part.simplices[s][j] + more;
    }
    contour_.sink->add_simplices(simplices_);
    size_.vertices += count;
    size_.simplices += simplices_.size();
  }

  StreamedContour<N, Real> contour_;
  Lattice lattice_;
  std::optional<CellParts<Real, N>> parts_;  ///< none: by rows
  ContourSize size_;
  ExtractStats stats_;
  std::vector<typename ContourSink<N, Real>::Simplex> simplices_;
};

/// The layers of a reader that a part needs.
template <Value T, int N>
class LayerWindow {
 public:
  /// `least`: own layers of a part; `samples`: if they have fewer samples than this, parts have more layers.
  LayerWindow(LayerReader<T, N>& reader, std::size_t least, std::size_t samples)
      : reader_(reader), least_(least), samples_(samples) {
    for (int a = 0; a + 1 < N; ++a) layer_ *= reader.grid().axes[a].size();
  }
  /// Number of layers of a part: large ones are few, so that the layers around them are not the most.
  [[nodiscard]] std::size_t own_layers() const noexcept { return std::max(least_, samples_ / layer_ / 2 * 2); }
  /// A view of the layers [begin, end). They ascend from call to call.
  [[nodiscard]] Image<T, N> layers(std::size_t begin, std::size_t end) {
    const auto passed = static_cast<std::ptrdiff_t>((begin - begin_) * layer_);
    std::move(values_.begin() + passed, values_.begin() + static_cast<std::ptrdiff_t>((read_ - begin_) * layer_),
              values_.begin());
    begin_ = begin;
    values_.resize((end - begin) * layer_);
    for (; read_ < end; ++read_) reader_.read(read_, values_.data() + (read_ - begin) * layer_);
    Grid<N> grid = reader_.grid();
    grid.axes[N - 1] = grid.axes[N - 1].part(begin, end - begin);
    return Image<T, N>(values_.data(), std::move(grid));
  }

 private:
  LayerReader<T, N>& reader_;
  std::size_t least_, samples_, layer_ = 1, begin_ = 0, read_ = 0;
  Buffer<T> values_;
};

}  // namespace
}  // namespace detail

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4> std::vector<ExtractedSize> extract_lattice_streamed_several(
    LayerReader<T, N>& layers, Lattice lattice,
    std::type_identity_t<std::span<const StreamedContour<N, Real>>> contours, const ExtractOptions& options) {
  for (const auto& contour : contours)
    if (contour.sink == nullptr) detail::refuse("a contour without a sink; expected one each");
  const Grid<N> grid = layers.grid();
  detail::check_stream<Real>(grid, lattice, options);
  std::vector<detail::LatticeStream<Real, N>> streams;
  const bool by_rows = detail::has_rows(lattice, options.ambiguity);
  for (const auto& contour : contours) streams.emplace_back(contour, lattice, by_rows);
  if (contours.empty()) return {};
  detail::LayerWindow<T, N> window(layers, by_rows ? 16 : 2, std::size_t{1} << (by_rows ? 18 : 16));
  const std::size_t count = grid.axes[N - 1].size(), own = window.own_layers();
  double read_seconds = 0.0;
  for (std::size_t first = 0; first < count; first += own) {
    const std::size_t last = std::min(count, first + own);
    const detail::PartLayers part{first - std::min(first, detail::kBefore), first, last,
                                  std::min(count, last + detail::kBehind)};
    detail::Stopwatch watch;
    const Image<T, N> image = window.layers(part.begin, part.end);
    watch.add_to(read_seconds);
    for (std::size_t i = 0; i < streams.size(); ++i) {
      const auto share = [&](std::size_t done) {
        const double of_part = static_cast<double>(done) / static_cast<double>(streams.size());
        return (static_cast<double>(first) + of_part * static_cast<double>(last - first)) / static_cast<double>(count);
      };
      ExtractOptions one = options;
      one.work.progress = detail::part_of(options.work.progress, share(i), share(i + 1));
      streams[i].add(image, grid, part, one);
    }
  }
  std::vector<ExtractedSize> results;
  for (const auto& stream : streams) results.push_back(stream.result(read_seconds));
  return results;
}

#define TEGL_INSTANTIATE_ONE(T, N, Real)                                            \
  template std::vector<ExtractedSize> extract_lattice_streamed_several<Real, T, N>( \
      LayerReader<T, N>&, Lattice, std::span<const StreamedContour<N, Real>>, const ExtractOptions&);
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
