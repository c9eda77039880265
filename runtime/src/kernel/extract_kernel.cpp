// SPDX-License-Identifier: BSD-3-Clause
//
// Driver of the extraction: processes one batch of slabs at a time along the last axis, with the batch's rows in
// parallel.
#include "kernel/extract_kernel.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "base/stopwatch.hpp"
#include "base/workers.hpp"
#include "kernel/border_caps.hpp"
#include "kernel/extract_generate.hpp"
#include "kernel/extract_progress.hpp"
#include "kernel/generate_cubes.hpp"
#include "kernel/memory_output.hpp"
#include "kernel/split_nonmanifold.hpp"
#include "kernel/tile_selection.hpp"

namespace tegl::detail {

namespace {

/// Number of slabs per batch: as many as stay in the caches of all threads from one pass to the next and need little
/// memory compared with the image. Also decides whether the counter keeps lists of active tiles.
template <int N>
std::size_t choose_batch(const RowShape<N>& shape, Counter<N>& counter, std::size_t sample_bytes, std::size_t threads,
                         std::size_t thread_bytes, bool ahead) {
  // Threads synchronise after every pass. This costs more than fetching from the next cache level, so several threads
  // get larger batches.
  const std::size_t samples_per_thread = std::size_t{1} << (threads > 1 ? 20 : 18);
  // Share of the image's bytes. The rest of 1/16 is for storage that does not grow with slabs. 4D has few slabs and
  // needs two per batch, so it keeps the larger share.
  // If 4D tiles are resolved from the data, few assembled ones fit too; those of noise come on top.
  const double share = counter.lists_cubes() ? 0.048 : ahead && N < 4 ? 0.05 : 0.057;
  // Bytes; allowed for any image size. 4D tiles resolved from the data are kept from counting to writing.
  const double little = counter.lists_cubes() ? 3u << 16 : 1u << 17;
  // Minimum slabs that must fit together with their tile lists in 4D. If fewer fit, lists are not kept but computed
  // twice.
  const std::size_t few = threads > 1 ? 2 : 1;
  const std::size_t layer = shape.rows() * shape.size(0);
  const auto image = static_cast<double>(layer * shape.layers() * sample_bytes);
  const std::size_t wanted =
      std::clamp<std::size_t>(threads * samples_per_thread / layer, 1, std::max<std::size_t>(1, shape.layers() - 1));
  // n slabs need n + 1 counted and n + 2 classified layers. With `ahead`, the next batch's layers are classified too.
  const std::size_t bits = (ahead ? 2 : 1) * counter.layer_bytes();
  constexpr std::size_t kBookkeeping = sizeof(Layer<N>) + sizeof(Slab<N>) + 512;
  constexpr std::size_t kObjects = 4096;  // the extraction itself, its source, estimator and lists by thread
  const auto fit = [&] {
    const auto fixed = static_cast<double>(2 * counter.layer_bytes() + counter.layer_planes_bytes() +
                                           threads * thread_bytes + kObjects);
    // 2D does not reuse planes (take_planes), so each of two batches needs its own.
    const std::size_t planes = (ahead && N == 2 ? 2 : 1) * (counter.layer_planes_bytes() + counter.slab_planes_bytes());
    const auto each = static_cast<double>(bits + planes + (ahead ? 2 : 1) * kBookkeeping);
    const double most = (std::max(little, share * image) - fixed) / each;
    return std::min(wanted, static_cast<std::size_t>(std::max(0.0, most)));
  };
  if (N == 4 && fit() < std::min(wanted, few)) counter.keep_tiles(false);
  return std::max<std::size_t>(1, fit());
}

template <int N, class Real>
class TableExtraction final : public SteppedExtraction<N, Real> {
 public:
  TableExtraction(SampleSource<N>& source, const Grid<N>& grid, const TableSet<N>& tables,
                  const ExtractOptions& options, const ExtractPlan& plan, ContourOutput<N, Real>& output)
      : SteppedExtraction<N, Real>(grid),
        source_(source),
        output_(output),
        reporter_(options.work.progress, grid.axes[N - 1].size() - 1),
        inverted_(options.ambiguity == Ambiguity::high),
        uncertainty_(plan.uncertainty),
        max_vertices_(plan.max_vertices),
        max_vertices_at_once_(plan.max_vertices_at_once),
        selection_(plan.selection),
        shape_(grid.sizes()),
        tables_(tables),
        placement_(grid, N == 4 || plan.keeps_off_layers),
        estimator_(make_estimator(source, grid, options, plan)),
        counter_(shape_, tables, tables.rows, options.close ? RankReaders::any : output.rank_readers(),
                 estimator_.get()),
        tiles_(source, tables, tables.rows, estimator_.get(), placement_, against_tables(grid, options) != inverted_,
               counter_.has_cubes() && !counter_.lists_cubes()),
        nonmanifold_(shape_, counter_),
        workers_(
            options.work.threads,
            [this] {
              return Scratch{counter_.make_scratch(), {source_, placement_, shape_, uncertainty_}, make_own_cells()};
            }),
        ahead_(workers_.count() > 1 && source.are_in_memory()),
        batch_(plan.batch == 0
                   ? choose_batch(shape_, counter_, source.sample_bytes(), workers_.count(),
                                  EdgeWriter<N, Real>::bytes(shape_.size(0), options.normals != Normals::none) +
                                      own_cells_bytes(),
                                  ahead_)
                   : std::min(plan.batch, shape_.layers() - 1)),
        layers_((ahead_ ? 2 : 1) * batch_ + 2),
        slabs_((ahead_ ? 2 : 1) * batch_ + 1) {
    if (options.normals != Normals::none) placement_.want_normals(source, grid, options);
    if (options.close)
      caps_.emplace(source, shape_, tables_, counter_, placement_, estimator_.get(), inverted_,
                    against_tables(grid, options), plan.closed_axes, plan.seam_axes);
    if (!plan.keeps_tiles) counter_.keep_tiles(false);
    counter_.keep_assembled(kMostAssembled / (batch_ * shape_.chunks()));
    for (Layer<N>& layer : layers_) counter_.allocate(layer);
    const std::size_t counted = kPassesPlanesOn ? batch_ + 1 : layers_.size();
    for (std::size_t k = 0; k < counted; ++k) counter_.allocate(static_cast<LayerPlanes<N>&>(layers_[k]));
    for (std::size_t k = 0; k + 1 < counted; ++k) counter_.allocate(static_cast<SlabPlanes<N>&>(slabs_[k]));
    if (options.ambiguity == Ambiguity::custom) reach_ = std::min(options.estimator.reach, shape_.layers());
    // Gradients read one layer before the current ones; custom estimators read as many as their reach.
    source.keep(layers_.size() + std::max<std::size_t>(options.normals != Normals::none ? 1 : 0, 2 * reach_));
  }

  bool prepare_batch() override {
    const std::size_t slabs = shape_.layers() - 1;
    if (next_ == 0) expect_output();
    if (next_ == slabs) {
      reporter_.tell(static_cast<double>(slabs));
      return false;
    }
    first_ = next_;
    next_ = std::min(slabs, first_ + batch_);
    reporter_.begin_batch(first_, next_, kPasses - (is_classified() ? 1 : 0));
    reporter_.tell(static_cast<double>(first_));
    if (is_classified()) return true;
    Stopwatch watch;
    prepare(next_);
    watch.add_to(stats_.read_seconds);
    return true;
  }

  void extract_batch() override {
    const std::size_t slabs = shape_.layers() - 1;
    const std::size_t first = first_, end = next_;
    Stopwatch watch;
    // classify, count
    if (!is_classified()) {
      classify(first, end);
      watch.add_to(stats_.classify_seconds);
    }
    stats_.active_tiles += count(first, end);
    watch.add_to(stats_.find_seconds);
    // generate; if possible, classify the next batch in parallel
    part_.done = static_cast<double>(end) / static_cast<double>(slabs);
    const auto room = output_.open(part_);
    if (uncertainty_ != nullptr) uncertainty_->resize(part_.end_vertex);
    if (ahead_ && end < slabs) {
      const double share = generate_ahead(first, end, std::min(slabs, end + batch_), room);
      watch.share_between(stats_.classify_seconds, share, stats_.generate_seconds);
    } else {
      generate(first, end, room);
      watch.add_to(stats_.generate_seconds);
    }
    // close at the border
    gather_border(first, end);
    watch.add_to(stats_.close_seconds);
    if (estimator_) estimator_->rethrow();
    output_.close(part_, nonmanifold_);
    watch.add_to(stats_.generate_seconds);
    // after the last batch
    if (end < slabs) return;
    output_.finish({0, part_.end_vertex, 0, part_.end_simplex, 1.0}, caps_ ? &*caps_ : nullptr, nonmanifold_);
    watch.add_to(stats_.close_seconds);
  }

 private:
  using Vertex = typename Contour<N, Real>::Vertex;
  using OwnCells = typename TileWriter<N, Real>::OwnCells;
  using SteppedExtraction<N, Real>::stats_;

  /// Working storage of one thread.
  struct Scratch {
    CountScratch counting;
    EdgeWriter<N, Real> edges;
    std::unique_ptr<OwnCells> own_cells;  ///< N = 3 or 4, if ambiguities are resolved from the data
  };

  [[nodiscard]] std::size_t own_cells_bytes() const {
    if constexpr (N > 2) return estimator_ != nullptr ? sizeof(OwnCells) : 0;
    return 0;
  }
  [[nodiscard]] std::unique_ptr<OwnCells> make_own_cells() const {
    if constexpr (N > 2)
      if (estimator_ != nullptr) return std::make_unique<OwnCells>(source_, placement_);
    return nullptr;
  }

  /// Whether the current batch was classified together with the previous one.
  [[nodiscard]] bool is_classified() const noexcept { return ahead_ && first_ != 0; }

  Layer<N>& layer(std::size_t k) noexcept { return layers_[k % layers_.size()]; }
  Slab<N>& slab(std::size_t k) noexcept { return slabs_[k % slabs_.size()]; }
  Slab<N>* slab_above(std::size_t k) noexcept { return k + 1 < shape_.layers() ? &slab(k) : nullptr; }
  SlabView<N> view(std::size_t k) noexcept { return {&shape_, {&layer(k), &layer(k + 1)}, &slab(k), k}; }

  static std::unique_ptr<FaceEstimator<N>> make_estimator(const CornerValues<N>& source, const Grid<N>& grid,
                                                          const ExtractOptions& options, const ExtractPlan& plan) {
    if (!is_estimated(options.ambiguity)) return nullptr;
    return std::make_unique<FaceEstimator<N>>(source, grid.sizes(), options, plan.part);
  }

  /// Calls work(k, chunk, scratch) in parallel for all chunks of the layers (or slabs) first ... end - 1. Checks for
  /// cancellation after at most kMostWork samples.
  template <class Work>
  void for_chunks(std::size_t first, std::size_t end, const Work& work) {
    const std::size_t chunks = shape_.chunks();
    const std::size_t chunk_samples = shape_.size(0) * std::min(shape_.rows(), kChunkRows);
    const std::size_t most = kMostWork / chunk_samples + 1;
    workers_.for_range((end - first) * chunks, kLeastWork / chunk_samples + 1,
                       [&](std::size_t from, std::size_t to, Scratch& scratch) {
                         for (std::size_t next; from < to && !reporter_.stopped(); from = next) {
                           const std::size_t k = from / chunks;
                           next = std::min({to, (k + 1) * chunks, from + most});
                           for (std::size_t i = from; i < next; ++i) work(first + k, i - k * chunks, scratch);
                           reporter_.add(next - from);
                         }
                       });
  }

  /// Runs for_chunks as a pass whose progress is reported.
  template <class Work>
  void pass_over_chunks(std::size_t first, std::size_t end, const Work& work) {
    reporter_.begin_pass((end - first) * shape_.chunks());
    for_chunks(first, end, work);
  }

  /// Prepares the samples that classify(.., end) reads.
  void prepare(std::size_t end) {
    wanted_ = std::min(end + 2, shape_.layers());
    for (; prepared_ < std::min(end + 2 + reach_, shape_.layers()); ++prepared_) {
      source_.prepare(prepared_);
      reporter_.tell(0);
    }
  }

  /// Classifies the layers that slabs first ... end - 1 need and the layer after them, which determines the valid tiles
  /// of the slab between.
  void classify(std::size_t first, std::size_t end) {
    pass_over_chunks(classified_, wanted_,
                     [&](std::size_t k, std::size_t chunk, Scratch& scratch) { classify_chunk(k, chunk, scratch); });
    finish_classification(first, end);
  }
  void classify_chunk(std::size_t k, std::size_t chunk, Scratch& scratch) {
    counter_.classify(source_, k, inverted_, chunk, layer(k), scratch.counting.words.data(), selection_);
  }

  /// Finds missing samples and valid tiles for slabs first ... end - 1, after their layers have been classified.
  void finish_classification(std::size_t first, std::size_t end) {
    const std::size_t from = classified_;
    classified_ = wanted_;
    const std::size_t valid_end = std::min(end + 1, shape_.layers() - 1);
    const std::size_t valid_from = first == 0 ? 0 : first + 1;
    if (selection_ != nullptr && selection_->only_these()) return select_tiles(valid_from, valid_end);
    for (std::size_t k = from; k < classified_; ++k) Counter<N>::find_missing(layer(k));
    write_missing(from, classified_);
    bool all = true;
    for (std::size_t k = valid_from; k < valid_end; ++k) {
      slab(k).all_valid = !layer(k).any_missing && !layer(k + 1).any_missing;
      all = all && slab(k).all_valid;
    }
    if (all) return;
    for (std::size_t k = valid_from; k < valid_end; ++k)
      if (!slab(k).all_valid && slab(k).valid.empty()) counter_.allocate_valid(slab(k));
    for_chunks(valid_from, valid_end, [&](std::size_t k, std::size_t chunk, Scratch&) {
      if (!slab(k).all_valid) counter_.find_valid(layer(k), layer(k + 1), chunk, slab(k));
    });
  }

  /// Takes the valid tiles from `selection_` instead of from missing samples.
  void select_tiles(std::size_t first, std::size_t end) {
    for (std::size_t k = first; k < end; ++k) {
      slab(k).all_valid = false;
      if (slab(k).valid.empty()) counter_.allocate_valid(slab(k));
    }
    for_chunks(first, end, [&](std::size_t k, std::size_t chunk, Scratch&) {
      selection_->write_valid(k, chunk, shape_.chunk_end(chunk) - chunk * kChunkRows, shape_.words(), slab(k).valid);
    });
  }

  /// Classifies layers again if they have missing samples but had no storage for them yet.
  void write_missing(std::size_t first, std::size_t end) {
    for (std::size_t k = first; k < end; ++k) {
      Layer<N>& here = layer(k);
      if (!here.any_missing || !here.missing.empty()) continue;
      counter_.allocate_missing(here);
      for_chunks(k, k + 1, [&](std::size_t, std::size_t chunk, Scratch& scratch) {
        counter_.classify(source_, k, inverted_, chunk, here, scratch.counting.words.data(), selection_);
      });
    }
  }

  /// Moves the planes of finished layers and slabs to the layers up to `end` and to the slabs first ... end - 1.
  void take_planes(std::size_t first, std::size_t end) {
    if (!kPassesPlanesOn) return;
    for (std::size_t k = std::max(first + 1, batch_ + 1); k <= end; ++k)
      std::swap<LayerPlanes<N>>(layer(k), layer(k - batch_ - 1));
    for (std::size_t k = std::max(first, batch_); k < end; ++k) std::swap<SlabPlanes<N>>(slab(k), slab(k - batch_));
  }

  /// Counts slabs first ... end - 1 with the layers above them (and layer 0) and numbers their vertices and simplices.
  /// Returns the number of active tiles.
  std::uint64_t count(std::size_t first, std::size_t end) {
    take_planes(first, end);
    pass_over_chunks(first, end, [&](std::size_t k, std::size_t chunk, Scratch& scratch) {
      if (k == 0) counter_.count_first_layer(layer(0), slab(0), chunk, scratch.counting.words.data());
      counter_.count_slab(view(k), layer(k + 1), slab(k), slab_above(k + 1), chunk, scratch.counting);
    });
    if (estimator_) estimator_->rethrow();
    const std::uint64_t before = part_.first_vertex;
    part_.first_vertex = part_.end_vertex;
    part_.first_simplex = part_.end_simplex;
    std::uint64_t active = 0;
    if (first == 0) place_layer(0);
    for (std::size_t k = first; k < end; ++k) {
      part_.end_vertex = counter_.place_slab(slab(k), part_.end_vertex, part_.end_simplex);
      for (const SlabChunk& chunk : slab(k).chunks) active += chunk.active;
      place_layer(k + 1);
    }
    check_vertex_count(part_.end_vertex, max_vertices_);
    if (part_.end_vertex - before > max_vertices_at_once_)
      throw Error(ErrorCode::TooLarge, fmt::format("{} vertices between layers {} and {} and in unfinished layers "
                                                   "before; expected at most {}: contour parts of the image instead",
                                                   part_.end_vertex - before, first, end, max_vertices_at_once_));
    return active;
  }

  void place_layer(std::size_t k) { part_.end_vertex = counter_.place_layer(layer(k), part_.end_vertex); }

  void expect_output() const {
    const double samples = static_cast<double>(shape_.rows() * shape_.size(0)) * static_cast<double>(shape_.layers());
    const double own = tables_.max_tile_vertices + (counter_.has_cubes() ? 4.0 * tables::kFaceSlots : 0.0);
    output_.expect(std::min(samples * (N + own), static_cast<double>(max_vertices_)), samples * tables_.max_simplices);
  }

  void generate(std::size_t first, std::size_t end, typename ContourOutput<N, Real>::Room room) {
    if (!is_wanted(room)) return;
    pass_over_chunks(first, end, [&](std::size_t k, std::size_t chunk, Scratch& scratch) {
      generate_chunk(k, chunk, scratch, room);
    });
  }
  static bool is_wanted(const typename ContourOutput<N, Real>::Room& room) noexcept {
    return room.vertices != nullptr || room.simplices != nullptr;
  }
  void generate_chunk(std::size_t k, std::size_t chunk, Scratch& scratch,
                      const typename ContourOutput<N, Real>::Room& room) {
    const VertexRun<Vertex> vertices{room.vertices, static_cast<Index>(part_.first_vertex), room.normals};
    if (k == 0) generate_first_layer(chunk, scratch, vertices);
    generate_slab(k, chunk, scratch, vertices, room.simplices);
  }

  /// Generates slabs first ... end - 1 and, in parallel, classifies the layers needed up to `next_end`: one waits for
  /// memory while the other computes, and threads synchronise once. Chunks at regular intervals touch the memory of the
  /// next output part. Returns the share of time spent on classification.
  double generate_ahead(std::size_t first, std::size_t end, std::size_t next_end,
                        const typename ContourOutput<N, Real>::Room& room) {
    prepare(next_end);
    const bool wanted = is_wanted(room);
    const std::size_t slabs = std::max(end - first, wanted_ - classified_);
    const std::size_t pieces = output_.pieces_ahead();
    const std::size_t apart = pieces == 0 ? 0 : std::max<std::size_t>(1, slabs * shape_.chunks() / pieces);
    std::atomic<std::int64_t> classifying = 0, generating = 0;
    pass_over_chunks(0, slabs, [&](std::size_t k, std::size_t chunk, Scratch& scratch) {
      const std::size_t ordinal = k * shape_.chunks() + chunk;
      if (apart != 0 && ordinal % apart == 0 && ordinal / apart < pieces) output_.touch_ahead(ordinal / apart);
      const std::int64_t start = Stopwatch::nanoseconds();
      if (wanted && first + k < end) generate_chunk(first + k, chunk, scratch, room);
      const std::int64_t middle = Stopwatch::nanoseconds();
      if (classified_ + k < wanted_) classify_chunk(classified_ + k, chunk, scratch);
      generating.fetch_add(middle - start, std::memory_order_relaxed);
      classifying.fetch_add(Stopwatch::nanoseconds() - middle, std::memory_order_relaxed);
    });
    finish_classification(end, next_end);
    const double both = static_cast<double>(classifying + generating);
    return both > 0.0 ? static_cast<double>(classifying) / both : 0.0;
  }

  /// Destination of the edge vertices of a chunk, in a layer or along the last axis. Its end is unknown if cubes or
  /// tiles have vertices of their own in between.
  typename EdgeTarget<Vertex>::Run run_in_layer(std::size_t k, std::size_t chunk, VertexRun<Vertex> vertices) {
    const Layer<N>& here = layer(k);
    Vertex* const first = &vertices[here.edges[0].chunk_first[chunk]];
    return {k, counter_.has_cubes() ? first : first + here.chunk_vertices[chunk]};
  }
  typename EdgeTarget<Vertex>::Run run_in_slab(std::size_t k, std::size_t chunk, VertexRun<Vertex> vertices) {
    const Slab<N>& here = slab(k);
    Vertex* const first = &vertices[here.edges.chunk_first[chunk]];
    const bool others = counter_.has_cubes() || tables_.max_tile_vertices != 0;
    return {k, others ? first : first + here.chunks[chunk].vertices};
  }

  /// Writes the vertices of a chunk of layer 0.
  void generate_first_layer(std::size_t chunk, Scratch& scratch, VertexRun<Vertex> vertices) {
    start_vertices(scratch, {run_in_layer(0, chunk, vertices), {}, vertices});
    for (std::size_t row = chunk * kChunkRows; row < shape_.chunk_end(chunk); ++row) {
      scratch.edges.add_by_bits(&layer(0), nullptr, row);
      generate_layer_cubes(0, row, vertices, scratch.own_cells.get());
    }
    finish_vertices(scratch);
  }

  void start_vertices(Scratch& scratch, const EdgeTarget<Vertex>& target) {
    scratch.edges.start(target);
    if constexpr (N > 2)
      if (scratch.own_cells != nullptr) scratch.own_cells->start(target.vertices);
  }
  void finish_vertices(Scratch& scratch) {
    scratch.edges.finish();
    if constexpr (N > 2)
      if (scratch.own_cells != nullptr) scratch.own_cells->finish();
  }

  /// Writes the vertices and simplices of a chunk of slab k, and the vertices of the layer above it.
  void generate_slab(std::size_t k, std::size_t chunk, Scratch& scratch, VertexRun<Vertex> vertices,
                     typename Contour<N, Real>::Simplex* simplices) {
    const SlabView<N> around = view(k);
    const Slab<N>& here = slab(k);
    std::uint32_t busy = here.chunks[chunk].busy;
    if (busy == 0) return;
    EdgeWriter<N, Real>& edges = scratch.edges;
    OwnCells* const own_cells = scratch.own_cells.get();
    start_vertices(scratch, {run_in_layer(k + 1, chunk, vertices), run_in_slab(k, chunk, vertices), vertices});
    for (; busy != 0; busy &= busy - 1) {
      const std::size_t row = chunk * kChunkRows + static_cast<std::size_t>(std::countr_zero(busy));
      const RowTiles tiles = counter_.tiles(around, row, scratch.counting);
      if (counter_.goes_by_tiles(here, row))
        edges.add_by_tiles(around, row, tiles);
      else
        edges.add_by_bits(&layer(k + 1), &here, row);
      generate_layer_cubes(k + 1, row, vertices, own_cells);
      generate_slab_cubes(around, k, row, vertices, own_cells);
      tiles_.write(around, row, k, tiles, vertices, simplices, part_.first_simplex, scratch.counting, own_cells);
    }
    finish_vertices(scratch);
  }

  void generate_layer_cubes([[maybe_unused]] std::size_t k, [[maybe_unused]] std::size_t row,
                            [[maybe_unused]] VertexRun<Vertex> vertices,
                            [[maybe_unused]] OwnCells* own_cells) noexcept {
    if constexpr (N == 4)
      if (counter_.has_cubes() && !tiles_.writes_cubes(slab(k == 0 ? 0 : k - 1))) {
        const Layer<N>& here = layer(k);
        if (counter_.lists_cubes())
          return generate_listed_cubes<7u>(source_, estimator_->triangulation(), placement_,
                                           {&shape_, {&here, nullptr}, nullptr}, here.cubes, row, k, vertices,
                                           *own_cells);
        generate_cubes<7u>(source_, *tables_.cube, placement_, {&shape_, {&here, nullptr}, nullptr}, here.cubes, row, k,
                           vertices);
      }
  }
  void generate_slab_cubes([[maybe_unused]] const SlabView<N>& around, [[maybe_unused]] std::size_t k,
                           [[maybe_unused]] std::size_t row, [[maybe_unused]] VertexRun<Vertex> vertices,
                           [[maybe_unused]] OwnCells* own_cells) const noexcept {
    if constexpr (N == 4)
      if (counter_.has_cubes() && !tiles_.writes_cubes(*around.slab)) {
        const auto& cubes = around.slab->cubes;
        if (counter_.lists_cubes()) {
          const auto list = [&]<unsigned Axes>(std::integral_constant<unsigned, Axes>, const CubePlane& plane) {
            generate_listed_cubes<Axes>(source_, estimator_->triangulation(), placement_, around, plane, row, k,
                                        vertices, *own_cells);
          };
          list(std::integral_constant<unsigned, 14u>(), cubes[0]);
          list(std::integral_constant<unsigned, 13u>(), cubes[1]);
          list(std::integral_constant<unsigned, 11u>(), cubes[2]);
          return;
        }
        generate_cubes<14u>(source_, *tables_.cube, placement_, around, cubes[0], row, k, vertices);
        generate_cubes<13u>(source_, *tables_.cube, placement_, around, cubes[1], row, k, vertices);
        generate_cubes<11u>(source_, *tables_.cube, placement_, around, cubes[2], row, k, vertices);
      }
  }

  /// Gathers caps and candidates for non-manifold vertices from slabs first ... end - 1.
  void gather_border(std::size_t first, std::size_t end) {
    // Vertex numbers count modulo 2^32. Numbers in this batch belong to this part or the previous one.
    nonmanifold_.set_least(before_part_);
    if (caps_) caps_->set_least(before_part_);
    before_part_ = part_.first_vertex;
    if (first == 0) {
      nonmanifold_.open_slab(0, slab(0));
      nonmanifold_.add_layer(0, layer(0));
      output_.see_layer(0, shape_, layer(0), {true, counter_.lists_cubes()});
      if (caps_) caps_->add_layer(0, layer(0), nullptr, &slab(0));
    }
    reporter_.begin_pass(end - first);
    for (std::size_t k = first; k < end; ++k) {
      nonmanifold_.add_slab(k, slab(k));
      if (const Slab<N>* const above = slab_above(k + 1)) nonmanifold_.open_slab(k + 1, *above);
      nonmanifold_.add_layer(k + 1, layer(k + 1));
      const NumberedBy by{counter_.has_ranks(slab(k), slab_above(k + 1)), counter_.lists_cubes()};
      output_.see_slab(view(k), by);
      output_.see_layer(k + 1, shape_, layer(k + 1), by);
      if (caps_) {
        caps_->add_layer(k + 1, layer(k + 1), &slab(k), slab_above(k + 1));
        caps_->add_slab(k, view(k));
      }
      reporter_.add(1);
    }
  }

  static constexpr std::size_t kLeastWork = 4096;                 ///< minimum samples per task
  static constexpr std::size_t kMostWork = std::size_t{1} << 20;  ///< maximum samples between checks for cancellation
  static constexpr std::size_t kMostAssembled = std::size_t{1} << 25;  ///< bytes of assembled tiles of a batch
  static constexpr unsigned kPasses = 4;  ///< passes over a batch: classify, count, generate, gather borders
  /// Whether finished planes are reused. The last layer is only classified, and the last slab only has its missing
  /// values found: neither needs planes. (In 2D a layer is one row, and reuse takes longer than it saves.)
  static constexpr bool kPassesPlanesOn = N > 2;

  SampleSource<N>& source_;
  ContourOutput<N, Real>& output_;
  ProgressReporter reporter_;
  bool inverted_;
  VertexUncertainty* uncertainty_;  ///< null: not requested
  std::uint64_t max_vertices_;
  std::uint64_t max_vertices_at_once_;
  const TileSelection* selection_;
  RowShape<N> shape_;
  TableSet<N> tables_;
  Placement<N, Real> placement_;
  std::unique_ptr<FaceEstimator<N>> estimator_;  ///< null: the tables decide
  Counter<N> counter_;
  TileWriter<N, Real> tiles_;
  std::optional<Caps<N, Real>> caps_;
  NonmanifoldCollector<N> nonmanifold_;
  Workers<Scratch> workers_;
  bool ahead_;                    ///< whether the next batch is classified while one is generated
  std::size_t batch_;             ///< slabs per batch
  std::vector<Layer<N>> layers_;  ///< layer k at index k modulo size
  std::vector<Slab<N>> slabs_;
  std::size_t first_ = 0;          ///< first slab of the current batch
  std::size_t next_ = 0;           ///< one past the last slab of the current batch
  std::size_t classified_ = 0;     ///< number of layers classified
  std::size_t wanted_ = 0;         ///< number of layers after the next classification
  std::size_t prepared_ = 0;       ///< number of layers prepared
  std::size_t reach_ = 0;          ///< additional layers that a custom estimator reads
  ContourPart part_{};             ///< most recent batch
  std::uint64_t before_part_ = 0;  ///< first vertex of the batch before it
};

}  // namespace

template <int N, class Real>
ExtractStats extract_to(SampleSource<N>& source, const Grid<N>& grid, const TableSet<N>& tables,
                        const ExtractOptions& options, const ExtractPlan& plan, ContourOutput<N, Real>& output) {
  if (SteppedExtraction<N, Real>::tiles_of(grid) == 0) return {};
  TableExtraction<N, Real> extraction(source, grid, tables, options, plan, output);
  extraction.run();
  return extraction.stats();
}

template <int N, class Real>
std::unique_ptr<SteppedExtraction<N, Real>> make_extraction(SampleSource<N>& source, const Grid<N>& grid,
                                                            const TableSet<N>& tables, const ExtractOptions& options,
                                                            const ExtractPlan& plan, ContourOutput<N, Real>& output) {
  if (SteppedExtraction<N, Real>::tiles_of(grid) == 0) return nullptr;
  return std::make_unique<TableExtraction<N, Real>>(source, grid, tables, options, plan, output);
}

template <int N, class Real>
Extraction<N, Real> extract_source(SampleSource<N>& source, const Grid<N>& grid, const TableSet<N>& tables,
                                   const ExtractOptions& options, const ExtractPlan& plan) {
  Extraction<N, Real> result;
  Contour<N, Real>& contour = result.contour;
  describe(grid, options, contour);
  MemoryOutput<N, Real> output(contour, options.normals != Normals::none, plan.max_vertices);
  result.stats = extract_to(source, grid, tables, options, plan, output);
  return result;
}

#define TEGL_INSTANTIATE_CONTOURS(N, Real)                                                                       \
  template ExtractStats extract_to<N, Real>(SampleSource<N>&, const Grid<N>&, const TableSet<N>&,                \
                                            const ExtractOptions&, const ExtractPlan&, ContourOutput<N, Real>&); \
  template std::unique_ptr<SteppedExtraction<N, Real>> make_extraction<N, Real>(                                 \
      SampleSource<N>&, const Grid<N>&, const TableSet<N>&, const ExtractOptions&, const ExtractPlan&,           \
      ContourOutput<N, Real>&);                                                                                  \
  template Extraction<N, Real> extract_source<N, Real>(SampleSource<N>&, const Grid<N>&, const TableSet<N>&,     \
                                                       const ExtractOptions&, const ExtractPlan&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
