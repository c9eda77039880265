// SPDX-License-Identifier: BSD-3-Clause
//
// The driver of the extraction: layer by layer along the last axis, with three layers of bits and two
// layers of ranks in memory.
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
        placement_(grid),
        counter_(shape_, tables),
        tiles_(*tables.tile, placement_, against_tables(grid, options) != inverted_, counter_.has_cubes()),
        pinches_(shape_, counter_) {
    if (options.close)
      caps_.emplace(shape_, tables_, counter_, placement_, inverted_, against_tables(grid, options), closed_axes);
    for (Layer<N>& layer : layers_) counter_.allocate(layer);
    for (Slab<N>& slab : slabs_) counter_.allocate(slab);
  }

  void run(Contour<N, Real>& contour, ExtractStats& stats) {
    const std::size_t slabs = shape_.layers() - 1;
    Stopwatch watch;
    classify(0);
    classify(1);
    watch.add_to(stats.classify_seconds);
    open_first_layer(contour);
    watch.add_to(stats.find_seconds);
    generate_layer(0, contour);
    pinches_.open_slab(0, slab(0));
    pinches_.add_layer(0, layer(0));
    watch.add_to(stats.generate_seconds);
    if (caps_) caps_->add_layer(0, layer(0), nullptr, &slab(0));
    watch.add_to(stats.close_seconds);
    for (std::size_t k = 0; k < slabs; ++k) {
      report(k, slabs);
      if (k + 2 < shape_.layers()) classify(k + 2);
      watch.add_to(stats.classify_seconds);
      stats.active_tiles += count(k, contour);
      watch.add_to(stats.find_seconds);
      generate_layer(k + 1, contour);
      generate_slab(k, contour);
      pinches_.add_slab(k, slab(k));
      if (const Slab<N>* const above = slab_above(k + 1)) pinches_.open_slab(k + 1, *above);
      pinches_.add_layer(k + 1, layer(k + 1));
      watch.add_to(stats.generate_seconds);
      ++slabs_done_;
      if (caps_) {
        caps_->add_layer(k + 1, layer(k + 1), &slab(k), slab_above(k + 1));
        caps_->add_slab(k, view(k));
      }
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
  Layer<N>& layer(std::size_t k) noexcept { return layers_[k % 3]; }
  Slab<N>& slab(std::size_t k) noexcept { return slabs_[k % 2]; }
  Slab<N>* slab_above(std::size_t k) noexcept { return k + 1 < shape_.layers() ? &slab(k) : nullptr; }
  SlabView<N> view(std::size_t k) noexcept { return {&shape_, {&layer(k), &layer(k + 1)}, &slab(k)}; }

  void report(std::size_t done, std::size_t all) const {
    if (options_.progress && !options_.progress(static_cast<double>(done) / static_cast<double>(all)))
      throw Error(ErrorCode::Cancelled, fmt::format("extraction cancelled after {} of {} layers", done, all));
  }

  void classify(std::size_t k) { counter_.classify(source_, k, inverted_, layer(k)); }

  /// Layer 0 has a slab on one side only.
  void open_first_layer(Contour<N, Real>& contour) {
    counter_.find_valid(layer(0), layer(1), slab(0));
    counter_.count_layer(layer(0), nullptr, &slab(0));
    total_ = counter_.place_layer(layer(0), 0);
    resize(layer(0).local, total_, contour);
  }

  /// Counts and places slab k and layer k + 1, and makes room for them. Returns the active tiles.
  std::uint64_t count(std::size_t k, Contour<N, Real>& contour) {
    Slab<N>* const above = slab_above(k + 1);
    if (above != nullptr) counter_.find_valid(layer(k + 1), layer(k + 2), *above);
    const std::uint64_t tiles = counter_.count_slab(view(k), slab(k));
    counter_.count_layer(layer(k + 1), &slab(k), above);
    total_ = counter_.place_slab(slab(k), total_, simplices_);
    resize(slab(k).local, total_, contour);
    total_ = counter_.place_layer(layer(k + 1), total_);
    resize(layer(k + 1).local, total_, contour);
    grow(contour.simplices, simplices_);
    return tiles;
  }

  /// Room for the vertices from local.first to `end`.
  void resize(LocalRun<N>& local, std::uint64_t end, Contour<N, Real>& contour) {
    check_vertex_count(end, max_vertices_);
    local.points.resize(end - local.first);
    grow(contour.vertices, end);
  }

  /// Resizes an output. Where it has to move, it gets room for what the slabs so far let expect, within
  /// bounds: moving costs more than address space that is never touched.
  template <class Output>
  void grow(Output& output, std::size_t size) {
    if (size > output.capacity()) {
      const double expected =
          static_cast<double>(size) * static_cast<double>(shape_.layers() - 1) / static_cast<double>(slabs_done_ + 1);
      output.reserve(std::max(size + size / 2, std::min(4 * size, static_cast<std::size_t>(1.05 * expected))));
    }
    output.resize(size);
  }

  void generate_layer(std::size_t k, Contour<N, Real>& contour) {
    Layer<N>& here = layer(k);
    for (std::size_t row = 0; row < shape_.rows(); ++row) {
      for (int axis = 0; axis < N - 1; ++axis)
        generate_edges(source_, placement_, shape_, here.edges[axis], row, k, axis, here.local,
                       contour.vertices.data());
    }
    if constexpr (N == 4)
      if (counter_.has_cubes())
        for (std::size_t row = 0; row < shape_.rows(); ++row)
          generate_cubes<7u>(*tables_.cube, placement_, {&shape_, {&here, nullptr}, nullptr}, here.cubes, row, k,
                             here.local, contour.vertices.data());
  }

  void generate_slab(std::size_t k, Contour<N, Real>& contour) {
    Slab<N>& here = slab(k);
    const SlabView<N> around = view(k);
    auto* const vertices = contour.vertices.data();
    for (std::size_t row = 0; row < shape_.rows(); ++row)
      generate_edges(source_, placement_, shape_, here.edges, row, k, N - 1, here.local, vertices);
    if constexpr (N == 4)
      if (counter_.has_cubes())
        for (std::size_t row = 0; row < shape_.rows(); ++row) {
          generate_cubes<14u>(*tables_.cube, placement_, around, here.cubes[0], row, k, here.local, vertices);
          generate_cubes<13u>(*tables_.cube, placement_, around, here.cubes[1], row, k, here.local, vertices);
          generate_cubes<11u>(*tables_.cube, placement_, around, here.cubes[2], row, k, here.local, vertices);
        }
    for (std::size_t row = 0; row < shape_.rows(); ++row)
      tiles_.write(around, row, k, vertices, contour.simplices.data());
  }

  const SampleSource<N>& source_;
  const ExtractOptions& options_;
  bool inverted_;
  std::uint64_t max_vertices_;
  RowShape<N> shape_;
  TableSet<N> tables_;
  Placement<N, Real> placement_;
  Counter<N> counter_;
  TileWriter<N, Real> tiles_;
  std::optional<Caps<N, Real>> caps_;
  PinchCandidates<N> pinches_;
  std::array<Layer<N>, 3> layers_;
  std::array<Slab<N>, 2> slabs_;
  std::uint64_t total_ = 0;      ///< vertices so far
  std::uint64_t simplices_ = 0;  ///< simplices so far
  std::size_t slabs_done_ = 0;
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
