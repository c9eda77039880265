// SPDX-License-Identifier: BSD-3-Clause
//
// The driver of the extraction: a batch of slabs at a time along the last axis, the rows of a batch side by side.
#include "extract_kernel.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <Eigen/LU>

#include "close.hpp"
#include "extract_generate.hpp"
#include "pinches.hpp"
#include "workers.hpp"

namespace tegl::detail {

void check_vertex_count(std::uint64_t count, std::uint64_t limit) {
  if (count > limit)
    throw Error(ErrorCode::TooLarge,
                fmt::format("the contour has more than {} vertices; contour parts of the image instead", limit));
}

void check_arguments(double isovalue, const ExtractOptions& options) {
  if (!std::isfinite(isovalue))
    throw Error(ErrorCode::InvalidIsovalue, fmt::format("isovalue {}; expected a finite number", isovalue));
  if (!(options.epsilon >= 0.0 && options.epsilon < 0.5))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("epsilon {}; expected at least 0 and below 0.5", options.epsilon));
}

namespace {

/// Adds the time since the last call to one of several counters.
class Stopwatch {
 public:
  void add_to(double& seconds) noexcept {
    const auto now = Clock::now();
    seconds += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

/// Whether the tables' orientation "positive side faces the table's high corners" is to be reversed, so
/// that normals point as asked for in the world.
template <int N>
bool against_tables(const Grid<N>& grid, const ExtractOptions& options) {
  bool flip = options.direction == GradientDirection::descent;
  for (const Axis& axis : grid.axes) flip = flip != axis.is_descending();
  return flip != (grid.linear.determinant() < 0);
}

/// How many slabs are worked on at a time: enough for all threads, with little memory beside input and output.
template <int N>
std::size_t batch_size(const RowShape<N>& shape) {
  constexpr std::size_t kShare = 64;                           // of the image
  constexpr std::size_t kLeastSamples = std::size_t{1} << 16;  // less is not worth the start of a pass
  const std::size_t layer = shape.rows() * shape.size(0);
  const std::size_t slabs = shape.layers() - 1;
  return std::clamp<std::size_t>(std::max(shape.layers() / kShare, kLeastSamples / layer), 1, slabs);
}

template <int N, class Real>
class Extraction {
 public:
  Extraction(const SampleSource<N>& source, const Grid<N>& grid, const TableSet<N>& tables,
             const ExtractOptions& options, std::uint64_t max_vertices, unsigned closed_axes)
      : source_(source),
        options_(options),
        inverted_(options.ambiguity == Ambiguity::high),
        max_vertices_(max_vertices),
        shape_(grid.sizes()),
        tables_(tables),
        rows_(RowTable::can_use(*tables.tile) ? std::make_optional<RowTable>(*tables.tile) : std::nullopt),
        row_table_(rows_ ? &*rows_ : nullptr),
        placement_(grid),
        counter_(shape_, tables, row_table_),
        tiles_(tables, row_table_, placement_, against_tables(grid, options) != inverted_, counter_.has_cubes()),
        keeps_places_(tables.tile->max_tile_vertices > 0 || counter_.has_cubes() || options.close),
        pinches_(shape_, counter_),
        workers_(options.threads, shape_.size(0), shape_.pitch()),
        batch_(batch_size(shape_)),
        layers_(batch_ + 2),
        slabs_(batch_ + 1) {
    if (options.close)
      caps_.emplace(shape_, tables_, counter_, placement_, inverted_, against_tables(grid, options), closed_axes);
    for (Layer<N>& layer : layers_) counter_.allocate(layer);
    for (Slab<N>& slab : slabs_) counter_.allocate(slab);
  }

  void run(Contour<N, Real>& contour, ExtractStats& stats) {
    const std::size_t slabs = shape_.layers() - 1;
    reserve_output(contour);
    Stopwatch watch;
    for (std::size_t first = 0; first < slabs; first += batch_) {
      report(first, slabs);
      const std::size_t end = std::min(slabs, first + batch_);
      classify(first, end);
      watch.add_to(stats.classify_seconds);
      stats.active_tiles += count(first, end);
      grow(contour, static_cast<double>(end) / static_cast<double>(slabs));
      watch.add_to(stats.find_seconds);
      generate(first, end, contour);
      watch.add_to(stats.generate_seconds);
      gather_border(first, end);
      watch.add_to(stats.close_seconds);
    }
    if (caps_) caps_->finish(contour, max_vertices_);
    watch.add_to(stats.close_seconds);
    if (pinches_.any_missing()) {
      pinches_.add_caps(static_cast<Index>(total_), static_cast<Index>(contour.vertices.size()));
      separate_pinches(contour, pinches_.vertices(), max_vertices_);
    }
    watch.add_to(stats.generate_seconds);
    report(1, 1);
  }

 private:
  using Vertex = typename Contour<N, Real>::Vertex;

  Layer<N>& layer(std::size_t k) noexcept { return layers_[k % layers_.size()]; }
  Slab<N>& slab(std::size_t k) noexcept { return slabs_[k % slabs_.size()]; }
  Slab<N>* slab_above(std::size_t k) noexcept { return k + 1 < shape_.layers() ? &slab(k) : nullptr; }
  Slab<N>* slab_below(std::size_t k) noexcept { return k > 0 ? &slab(k - 1) : nullptr; }
  SlabView<N> view(std::size_t k) noexcept { return {&shape_, {&layer(k), &layer(k + 1)}, &slab(k)}; }

  void report(std::size_t done, std::size_t all) const {
    if (options_.progress && !options_.progress(static_cast<double>(done) / static_cast<double>(all)))
      throw Error(ErrorCode::Cancelled, fmt::format("extraction cancelled after {} of {} layers", done, all));
  }

  /// Calls work(k, row, scratch) for all rows of the layers (or slabs) first ... end - 1, side by side.
  template <class Work>
  void for_rows(std::size_t first, std::size_t end, const Work& work) {
    const std::size_t rows = shape_.rows();
    workers_.for_range((end - first) * rows, kLeastWork / shape_.size(0) + 1,
                       [&](std::size_t from, std::size_t to, RowScratch& scratch) {
                         std::size_t k = first + from / rows;
                         std::size_t row = from % rows;
                         for (std::size_t i = from; i < to; ++i) {
                           work(k, row, scratch);
                           if (++row == rows) row = 0, ++k;
                         }
                       });
  }

  /// Layers that the slabs first ... end - 1 need, and the one after, which says what of the last layer is valid.
  void classify(std::size_t first, std::size_t end) {
    const std::size_t from = classified_;
    classified_ = std::min(end + 2, shape_.layers());
    for (std::size_t k = from; k < classified_; ++k) source_.prepare(k);
    for_rows(from, classified_, [&](std::size_t k, std::size_t row, [[maybe_unused]] RowScratch& scratch) {
      counter_.classify(source_, k, inverted_, row, layer(k));
    });
    for (std::size_t k = from; k < classified_; ++k) Counter<N>::find_missing(layer(k));
    const std::size_t valid_end = std::min(end + 1, shape_.layers() - 1);
    const std::size_t valid_from = first == 0 ? 0 : first + 1;
    bool all = true;
    for (std::size_t k = valid_from; k < valid_end; ++k) {
      slab(k).all_valid = !layer(k).any_missing && !layer(k + 1).any_missing;
      all = all && slab(k).all_valid;
    }
    if (!all)
      for_rows(valid_from, valid_end, [&](std::size_t k, std::size_t row, [[maybe_unused]] RowScratch& scratch) {
        if (!slab(k).all_valid) counter_.find_valid(layer(k), layer(k + 1), row, slab(k));
      });
  }

  /// Counts and places the slabs first ... end - 1 and the layers above them (and layer 0). Returns the active tiles.
  std::uint64_t count(std::size_t first, std::size_t end) {
    const std::size_t first_layer = first == 0 ? 0 : first + 1;
    for_rows(first_layer, end + 1, [&](std::size_t k, std::size_t row, [[maybe_unused]] RowScratch& scratch) {
      counter_.count_layer(layer(k), slab_below(k), slab_above(k), row, scratch.words.data());
    });
    for_rows(first, end, [&](std::size_t k, std::size_t row, [[maybe_unused]] RowScratch& scratch) {
      counter_.count_slab(view(k), slab(k), row, scratch.words.data());
    });
    batch_first_ = total_;
    batch_first_simplex_ = simplices_;
    std::uint64_t active = 0;
    if (first == 0) place_layer(0);
    for (std::size_t k = first; k < end; ++k) {
      const std::uint64_t before = total_;
      total_ = counter_.place_slab(slab(k), total_, simplices_);
      keep_places(slab(k).local, total_ - before);
      for (const std::uint32_t tiles : slab(k).active_count) active += tiles;
      place_layer(k + 1);
    }
    check_vertex_count(total_, max_vertices_);
    return active;
  }

  void place_layer(std::size_t k) {
    const std::uint64_t before = total_;
    total_ = counter_.place_layer(layer(k), total_);
    keep_places(layer(k).local, total_ - before);
  }

  void keep_places(LocalRun& local, std::uint64_t vertices) {
    if (keeps_places_) local.alphas.resize(vertices);
    if (counter_.has_cubes()) local.points.resize(vertices);
  }

  /// Address space for the largest contour that can be: memory is taken where it is written to. Where the system
  /// gives none, outputs grow.
  void reserve_output(Contour<N, Real>& contour) const {
    constexpr double kMostBytes = 0x1p40;
    const double samples = static_cast<double>(shape_.rows() * shape_.size(0)) * static_cast<double>(shape_.layers());
    const auto reserve = [&](auto& output, double most, std::size_t size) {
      try {
        output.reserve(static_cast<std::size_t>(std::min(most, kMostBytes / static_cast<double>(size))));
      } catch (const std::bad_alloc&) {
      }
    };
    const double own = tables_.tile->max_tile_vertices + (counter_.has_cubes() ? 4.0 * tables::kFaceSlots : 0.0);
    reserve(contour.vertices, std::min(samples * (N + own), static_cast<double>(max_vertices_)), sizeof(Vertex));
    reserve(contour.simplices, samples * tables_.tile->max_simplices, N * sizeof(Index));
  }

  /// Room for what is counted. Where an output has to move, it gets room for what the slabs so far let expect, within
  /// bounds.
  void grow(Contour<N, Real>& contour, double done) const {
    const auto resize = [&](auto& output, std::uint64_t size) {
      if (size > output.capacity()) {
        const double expected = 1.05 * static_cast<double>(size) / done;
        output.reserve(std::max(size + size / 2, std::min(4 * size, static_cast<std::size_t>(expected))));
      }
      output.resize(size);
    };
    resize(contour.vertices, total_);
    resize(contour.simplices, simplices_);
  }

  void generate(std::size_t first, std::size_t end, Contour<N, Real>& contour) {
    const std::size_t first_layer = first == 0 ? 0 : first + 1;
    const VertexRun<Vertex> vertices{contour.vertices.data() + batch_first_, static_cast<Index>(batch_first_)};
    const auto local = [&](LocalRun& run) { return keeps_places_ ? &run : nullptr; };
    for_rows(first_layer, end + 1, [&](std::size_t k, std::size_t row, [[maybe_unused]] RowScratch& scratch) {
      for (int axis = 0; axis < N - 1; ++axis)
        generate_edges(source_, placement_, shape_, layer(k).edges[axis], row, k, axis, local(layer(k).local),
                       scratch.edges, vertices);
    });
    for_rows(first, end, [&](std::size_t k, std::size_t row, [[maybe_unused]] RowScratch& scratch) {
      generate_edges(source_, placement_, shape_, slab(k).edges, row, k, N - 1, local(slab(k).local), scratch.edges,
                     vertices);
    });
    if constexpr (N == 4)
      if (counter_.has_cubes()) generate_all_cubes(first, end, vertices);
    auto* const simplices = contour.simplices.data() + batch_first_simplex_;
    for_rows(first, end, [&](std::size_t k, std::size_t row, [[maybe_unused]] RowScratch& scratch) {
      tiles_.write(view(k), row, k, vertices, simplices, batch_first_simplex_);
    });
  }

  void generate_all_cubes(std::size_t first, std::size_t end, VertexRun<Vertex> vertices) requires(N == 4) {
    for_rows(first == 0 ? 0 : first + 1, end + 1,
             [&](std::size_t k, std::size_t row, [[maybe_unused]] RowScratch& scratch) {
               Layer<N>& here = layer(k);
               generate_cubes<7u>(*tables_.cube, placement_, {&shape_, {&here, nullptr}, nullptr}, here.cubes, row, k,
                                  here.local, vertices);
             });
    for_rows(first, end, [&](std::size_t k, std::size_t row, [[maybe_unused]] RowScratch& scratch) {
      Slab<N>& here = slab(k);
      const SlabView<N> around = view(k);
      generate_cubes<14u>(*tables_.cube, placement_, around, here.cubes[0], row, k, here.local, vertices);
      generate_cubes<13u>(*tables_.cube, placement_, around, here.cubes[1], row, k, here.local, vertices);
      generate_cubes<11u>(*tables_.cube, placement_, around, here.cubes[2], row, k, here.local, vertices);
    });
  }

  /// What closes the contour, and what may have to be taken apart, of the slabs first ... end - 1.
  void gather_border(std::size_t first, std::size_t end) {
    if (first == 0) {
      pinches_.open_slab(0, slab(0));
      pinches_.add_layer(0, layer(0));
      if (caps_) caps_->add_layer(0, layer(0), nullptr, &slab(0));
    }
    for (std::size_t k = first; k < end; ++k) {
      pinches_.add_slab(k, slab(k));
      if (const Slab<N>* const above = slab_above(k + 1)) pinches_.open_slab(k + 1, *above);
      pinches_.add_layer(k + 1, layer(k + 1));
      if (!caps_) continue;
      caps_->add_layer(k + 1, layer(k + 1), &slab(k), slab_above(k + 1));
      caps_->add_slab(k, view(k));
    }
  }

  static constexpr std::size_t kLeastWork = 4096;  ///< samples in a task

  const SampleSource<N>& source_;
  const ExtractOptions& options_;
  bool inverted_;
  std::uint64_t max_vertices_;
  RowShape<N> shape_;
  TableSet<N> tables_;
  std::optional<RowTable> rows_;
  const RowTable* row_table_;
  Placement<N, Real> placement_;
  Counter<N> counter_;
  TileWriter<N, Real> tiles_;
  bool keeps_places_;  ///< whether anything asks for the places of points on edges once they are written
  std::optional<Caps<N, Real>> caps_;
  PinchCandidates<N> pinches_;
  Workers workers_;
  std::size_t batch_;             ///< slabs at a time
  std::vector<Layer<N>> layers_;  ///< by k modulo their number
  std::vector<Slab<N>> slabs_;
  std::size_t classified_ = 0;   ///< layers
  std::uint64_t total_ = 0;      ///< vertices so far
  std::uint64_t simplices_ = 0;  ///< simplices so far
  std::uint64_t batch_first_ = 0, batch_first_simplex_ = 0;
};

}  // namespace

template <int N, class Real>
Contour<N, Real> extract_source(const SampleSource<N>& source, const Grid<N>& grid, const TableSet<N>& tables,
                                const ExtractOptions& options, ExtractStats* stats, std::uint64_t max_vertices,
                                unsigned closed_axes) {
  Contour<N, Real> contour;
  ExtractStats done;
  done.tiles = 1;
  for (int a = 0; a < N; ++a) {
    contour.axis_names[a] = grid.axes[a].name;
    contour.axis_units[a] = grid.axes[a].unit;
    done.tiles *= grid.axes[a].size() - 1;
  }
  contour.direction = options.direction;
  if (done.tiles != 0) Extraction<N, Real>(source, grid, tables, options, max_vertices, closed_axes).run(contour, done);
  if (stats != nullptr) *stats = done;
  return contour;
}

#define TEGL_INSTANTIATE(N, Real)                                                                               \
  template Contour<N, Real> extract_source<N, Real>(const SampleSource<N>&, const Grid<N>&, const TableSet<N>&, \
                                                    const ExtractOptions&, ExtractStats*, std::uint64_t, unsigned);
TEGL_INSTANTIATE(2, float)
TEGL_INSTANTIATE(2, double)
TEGL_INSTANTIATE(3, float)
TEGL_INSTANTIATE(3, double)
TEGL_INSTANTIATE(4, float)
TEGL_INSTANTIATE(4, double)
#undef TEGL_INSTANTIATE

}  // namespace tegl::detail
