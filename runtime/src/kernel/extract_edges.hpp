// SPDX-License-Identifier: BSD-3-Clause
//
// Vertices on critical edges. Rows may have few edges of each axis, so edges of several rows are collected by axis
// until there are enough for vector loops. Their vertices are then copied to their places in the output.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "hwy/cache_control.h"
#include "image/edge_list.hpp"
#include "image/vertex_moves.hpp"
#include "image/vertex_run.hpp"
#include "kernel/contour_output.hpp"
#include "kernel/extract_layers.hpp"
#include "kernel/extract_rows.hpp"
#include "kernel/placement.hpp"
#include "kernel/row_normals.hpp"

namespace tegl::detail {

/// Writes vertices (and normals) on edges. One per thread. Memory is O(samples per row) for edge positions; other
/// arrays have bounded size.
template <int N, class Real>
class EdgeWriter {
 public:
  using Vertex = std::array<Real, N>;
  /// Arrays by axis.
  using Counts = std::array<std::uint32_t, N>;
  using Firsts = std::array<Index, N>;

  EdgeWriter(const EdgeCrossings<N>& source, const Placement<N, Real>& placement, const RowShape<N>& shape,
             VertexUncertainty* uncertainty)
      : source_(source),
        moves_(dynamic_cast<const VertexMoves<N>*>(&source)),
        placement_(placement),
        uncertainty_(uncertainty),
        shape_(shape),
        strides_(source.strides()),
        full_(full(shape.size(0))),
        fetches_(shape.rows() * shape.size(0) >= kLeastFetched) {
    const std::size_t samples = shape.size(0);
    for (int a = 0; a < N; ++a)
      lists_[a].allocate(room(samples), room_at_once(samples), room_together(samples), shape.words(),
                         a > 0 && a + 1 < N);
    segments_.reserve(most_segments(shape.size(0)));  // nothing may throw after construction
    if (placement.normals() == nullptr) return;
    normals_ = std::make_unique<NormalScratch>();
    for (List& list : lists_) list.normals.resize(room_together(shape.size(0)));
    if constexpr (kHasRowNormals)
      if (placement.normals()->reads_ends_in_float()) floats_ = dynamic_cast<const RowSource<float, N>*>(&source);
    if constexpr (kHasRowNormals)
      if (RowNormals<N>::suits(source, *placement.normals(), shape))
        row_normals_ = std::make_unique<RowNormals<N>>(source, *placement.normals(), shape);
  }

  /// Bytes of an EdgeWriter for rows of `samples` samples.
  static constexpr std::size_t bytes(std::size_t samples, bool normals) noexcept {
    constexpr std::size_t kEach = sizeof(std::ptrdiff_t) + N * sizeof(double);
    const std::size_t vertices = room_together(samples) * (normals ? 2 : 1);
    const std::size_t bits = (samples / kWordBits + 1) * sizeof(Word);
    return N * (sizeof(std::uint32_t) * room(samples) + kEach * room_at_once(samples) + sizeof(Vertex) * vertices +
                bits) +
           most_segments(samples) * sizeof(Segment) +
           (normals ? sizeof(NormalScratch) + (kHasRowNormals ? RowNormals<N>::bytes(samples) : 0) : 0);
  }

  /// Edges added between start() and finish() belong to `target`.
  void start(const EdgeTarget<Vertex>& target) noexcept {
    target_ = target;
    if (!fetches_) return;
    for (int axis = 0; axis < N; ++axis) {
      const LayerInMemory layer = source_.layer_in_memory(run(axis).layer);
      if (layer.first == nullptr) continue;  // nor has any other layer
      ends_[axis] = {layer, axis == N - 1 ? source_.layer_in_memory(run(axis).layer + 1).first
                                          : layer.first + strides_[axis] * layer.step_bytes};
    }
  }
  void finish() noexcept { flush(); }

  /// Adds the edges of a row of a slab and of the layer above it, derived from its active tiles.
  void add_by_tiles(const SlabView<N>& view, std::size_t row, const RowTiles& tiles) noexcept {
    Counts counts;
    Firsts firsts;
    for (int a = 0; a < N; ++a) {
      const EdgePlane& plane = view.edges(a, 1);
      counts[a] = plane.count[row];
      firsts[a] = plane.first(row);
    }
    add(
        row, counts, firsts,
        [&](const std::array<std::uint32_t*, 4>& out) {
          list_tile_edges<N>({tiles.signatures, tiles.at, tiles.count, out});
          list_last(view, row, counts, out);
        },
        [&](int axis, Word* out) { view.write_edges(axis, row, out); });
  }

  /// Adds the edges of a row of `layer` (axes 0 ... N-2) and of `slab` (axis N-1), from their bits. Either may be null.
  void add_by_bits(const Layer<N>* layer, const Slab<N>* slab, std::size_t row) noexcept {
    std::array<const EdgePlane*, N> planes{};
    if (layer != nullptr)
      for (int a = 0; a + 1 < N; ++a) planes[a] = &layer->edges[a];
    if (slab != nullptr) planes[N - 1] = &slab->edges;
    Counts counts{};
    Firsts firsts{};
    for (int a = 0; a < N; ++a) {
      if (planes[a] == nullptr) continue;
      counts[a] = planes[a]->count[row];
      firsts[a] = planes[a]->first(row);
    }
    const auto bits = [&](int axis) { return planes[axis]->bits[0].data() + row * shape_.words(); };
    add(
        row, counts, firsts,
        [&](const std::array<std::uint32_t*, 4>& out) {
          for (int a = 0; a < N; ++a)
            if (counts[a] != 0) list_bits(bits(a), shape_.words(), out[a]);
        },
        [&](int axis, Word* out) { std::copy_n(bits(axis), shape_.words(), out); });
  }

 private:
  static constexpr bool kHasRowNormals = std::is_same_v<Real, float>;
  static constexpr std::size_t kMargin = 16;   ///< entries that vector code reads or writes past the end of lists
  static constexpr std::uint32_t kMany = 48;   ///< rows with so many edges are not combined with others
  /// In rows with fewer than one edge per so many samples, it is faster to read the samples around each edge.
  static constexpr std::size_t kSamplesPerEdge = 3;
  static constexpr std::size_t kPiece = 4096;  ///< maximum edges of one row processed at a time
  /// Samples of the smallest layer that is not still in a near cache when its vertices are computed.
  static constexpr std::size_t kLeastFetched = std::size_t{1} << 16;

  /// Number of edges that make a list full, for rows of `samples` samples; then capacities of its arrays.
  static constexpr std::size_t full(std::size_t samples) noexcept {
    return std::clamp<std::size_t>(samples / 2, 32, 512);
  }
  static constexpr std::size_t room(std::size_t samples) noexcept { return full(samples) + samples + kMargin; }
  /// Capacity for edges of several rows.
  static constexpr std::size_t room_together(std::size_t samples) noexcept { return full(samples) + kMany + kMargin; }
  static constexpr std::size_t room_at_once(std::size_t samples) noexcept {
    return std::max(room_together(samples), std::min(samples, kPiece) + kMargin);
  }
  /// Every segment has at least one edge.
  static constexpr std::size_t most_segments(std::size_t samples) noexcept { return N * (full(samples) + 1); }

  using List = EdgeList<N, Vertex>;
  static constexpr std::size_t kAtOnce = List::kAtOnce;
  /// Range of one row's edges in a list.
  struct Segment {
    std::size_t row;
    int axis;
    std::uint32_t first, count;
    Index vertex;
  };

  /// Appends the edges of a row to the lists of all axes.
  template <class ListEdges, class WriteBits>
  void add(std::size_t row, const Counts& counts, const Firsts& firsts, const ListEdges& list_edges,
           const WriteBits& write_bits_of) noexcept {
    const std::uint32_t most = *std::max_element(counts.begin(), counts.end());
    if (most == 0) return;
    const auto& index = shape_.index_of(row);
    const bool alone = most >= kMany || (normals_ && !placement_.normals()->is_inside(index));
    // edge positions
    if (alone) flush();
    std::array<std::uint32_t*, 4> out{};
    for (int a = 0; a < N; ++a) out[a] = lists_[a].at.data() + lists_[a].size;
    list_edges(out);
    // coordinates of the row
    std::ptrdiff_t offset = 0;
    for (int a = 1; a + 1 < N; ++a) offset += static_cast<std::ptrdiff_t>(index[a]) * strides_[a];
    std::size_t longest = 0;
    for (int axis = 0; axis < N; ++axis) {
      const std::uint32_t count = counts[axis];
      if (count == 0) continue;
      List& list = lists_[axis];
      const std::size_t filled = std::min<std::size_t>(count, kPiece);
      List::fill(list.rows, list.size, filled, offset);
      const std::size_t entries = alone ? 1 : filled;
      for (int a = 1; a + 1 < N; ++a) List::fill(list.start[a], list.size, entries, placement_.sample(a, index[a]));
      if (axis > 0 && axis + 1 < N) List::fill(list.end, list.size, entries, placement_.sample(axis, index[axis] + 1));
      list.has_bits = alone && are_dense(count);
      if (list.has_bits) write_bits_of(axis, list.critical.data());
      if (!alone) fetch_samples(axis, list.at.data() + list.size, filled, offset);
      segments_.push_back({row, axis, static_cast<std::uint32_t>(list.size), count, firsts[axis]});
      list.size += count;
      longest = std::max(longest, list.size);
    }
    if (alone || longest >= full_) flush();
  }

  /// Requests the samples at the ends of a row's edges: most are no longer in the nearest cache, and other rows are
  /// processed before their vertices are computed.
  void fetch_samples(int axis, const std::uint32_t* at, std::size_t count, std::ptrdiff_t row) const noexcept {
    const Ends& ends = ends_[axis];
    if (ends.layer.first == nullptr) return;
    for (std::size_t i = 0; i < count; ++i) {
      const auto offset = row * ends.layer.step_bytes + static_cast<std::ptrdiff_t>(at[i]) * ends.layer.sample_bytes;
      hwy::Prefetch(ends.layer.first + offset);
      if (axis != 0) hwy::Prefetch(ends.next + offset);  // along the row, both are in the same cache line or adjacent
    }
  }

  /// Whether a row has so many edges that its samples are read by registers, in which the edges are chosen.
  [[nodiscard]] bool are_dense(std::size_t edges) const noexcept {
    return edges * kSamplesPerEdge >= shape_.size(0) && edges <= kPiece;
  }

  /// Adds the edges at a row's last sample, where no tile starts. Each is the last of its list.
  void list_last(const SlabView<N>& view, std::size_t row, const Counts& counts,
                 const std::array<std::uint32_t*, 4>& out) const noexcept {
    const std::size_t last = shape_.size(0) - 1;
    const auto high = [&](unsigned up, unsigned mask) {
      return view.layers[up]->high[shape_.shifted(row, mask) * shape_.pitch() + last / kWordBits] >> (last % kWordBits);
    };
    const Word here = high(1, 0);
    for (int a = 1; a < N; ++a)
      if (((here ^ (a == N - 1 ? high(0, 0) : high(1, 1u << a))) & 1u) != 0)
        out[a][counts[a] - 1] = static_cast<std::uint32_t>(last);
  }

  /// Writes the vertices of all listed edges and clears the lists.
  void flush() noexcept {
    if (segments_.empty()) return;
    const bool in_place = segments_.back().row == segments_.front().row;  // one row: each list has one segment
    std::array<Vertex*, N> points, normals;
    for (int axis = 0; axis < N; ++axis) {
      points[axis] = lists_[axis].points.data();
      normals[axis] = lists_[axis].normals.data();
    }
    // a single row is written directly to the output
    if (in_place)
      for (const Segment& segment : segments_) {
        points[segment.axis] = &target_.vertices[segment.vertex];
        if (normals_) normals[segment.axis] = &target_.vertices.normal(segment.vertex);
      }
    // compute
    for (int axis = 0; axis < N; ++axis)
      for (std::size_t first = 0; first < lists_[axis].size; first += kPiece)
        make_piece(axis, first, in_place, points[axis] + first, normals_ ? normals[axis] + first : nullptr);
    // copy
    if (!in_place)
      for (const Segment& segment : segments_) {
        put(segment, lists_[segment.axis].points, target_.vertices.data);
        if (normals_) put(segment, lists_[segment.axis].normals, target_.vertices.normals);
      }
    segments_.clear();
    for (List& list : lists_) list.size = 0;
  }

  [[nodiscard]] const typename EdgeTarget<Vertex>::Run& run(int axis) const noexcept {
    return axis == N - 1 ? target_.in_slab : target_.in_layer;
  }

  /// Computes the vertices and normals of a piece of a list, from edge `first` on. `normals` is null if none are
  /// requested.
  void make_piece(int axis, std::size_t first, bool in_place, Vertex* points, Vertex* normals) noexcept {
    List& list = lists_[axis];
    const EdgesInRows edges = list.piece(first, std::min(kPiece, list.size - first));
    if (normals != nullptr && floats_ != nullptr && edges.critical == nullptr) {
      // Normals need the samples at the ends of edges too: each is read once.
      make_normals(axis, first, edges, normals,
                   [&](const auto* one, const auto* other, std::size_t i, std::size_t count) {
                     if constexpr (std::is_same_v<decltype(one), const float*>)
                       floats_->alphas_between(one, other, count, list.alphas.data() + i);
                   });
      return make_points(axis, edges, in_place, points);
    }
    source_.edge_alphas(run(axis).layer, axis, edges, list.alphas.data());
    make_points(axis, edges, in_place, points);
    if (normals == nullptr || (in_place && make_normals_of_row(axis, edges, normals))) return;
    make_normals(axis, first, edges, normals, typename NormalWriter<N, Real>::NoAlphas{});
  }

  /// Computes the vertices of a piece from their interpolation parameters. `in_one_row`: all edges are of one row.
  void make_points(int axis, const EdgesInRows& edges, bool in_one_row, Vertex* out) noexcept {
    List& list = lists_[axis];
    EdgePoints<N, Real> points{};
    points.in_one_row = in_one_row;
    points.at = edges.at;
    points.alphas = list.alphas.data();
    points.count = edges.count;
    points.axis = axis;
    for (int a = 1; a + 1 < N; ++a) points.start[a] = list.start[a].data();
    points.end = list.end.data();
    points.out = out;
    placement_.edges(run(axis).layer, points);
    if (moves_ != nullptr) move_points(axis, edges, list.alphas.data(), out);
  }

  void move_points(int axis, const EdgesInRows& edges, const double* alphas, Vertex* out) const noexcept {
    for (std::size_t first = 0; first < edges.count; first += kWordBits) {
      const std::size_t count = std::min(kWordBits, edges.count - first);
      moves_->move(run(axis).layer, axis, {edges.rows + first, edges.at + first, count}, alphas + first, out + first);
    }
  }

  /// Computes the normals of a row, if its edges are dense. Otherwise returns false.
  bool make_normals_of_row([[maybe_unused]] int axis, [[maybe_unused]] const EdgesInRows& edges,
                           [[maybe_unused]] Vertex* out) noexcept {
    if constexpr (kHasRowNormals) {
      if (row_normals_ == nullptr || edges.critical == nullptr) return false;
      const std::size_t row = segments_.front().row;
      row_normals_->write(row, start_in(row, axis), axis, edges, lists_[axis].alphas.data(), out);
      return true;
    }
    return false;
  }

  /// Computes the normals of a piece. `write_alphas`: as for NormalWriter::edges.
  template <class WriteAlphas>
  void make_normals(int axis, std::size_t first, const EdgesInRows& edges, Vertex* out,
                    const WriteAlphas& write_alphas) noexcept {
    const auto segment_of = [&](std::size_t i) -> const Segment& {
      return *std::find_if(segments_.begin(), segments_.end(),
                           [&](const Segment& s) { return s.axis == axis && first + i - s.first < s.count; });
    };
    const auto start_of = [&](std::size_t i) {
      auto start = start_in(segment_of(i).row, axis);
      start[0] = edges.at[i];
      return start;
    };
    if (uncertainty_ != nullptr) {
      for (std::size_t i = 0; i < edges.count; ++i) {
        const Segment& segment = segment_of(i);
        const auto normal = placement_.normals()->on_edge_by_context(start_of(i), axis, lists_[axis].alphas[i]);
        out[i] = normal.vector;
        uncertainty_->set(static_cast<Index>(segment.vertex + (first + i - segment.first)), normal.uncertainty);
      }
      return;
    }
    placement_.normals()->edges(start_in(segments_.front().row, axis), axis, edges, lists_[axis].alphas.data(),
                                *normals_, out, start_of, write_alphas);
  }

  /// First sample of the row in which edges along `axis` start.
  [[nodiscard]] typename RowShape<N>::Index start_in(std::size_t row, int axis) const noexcept {
    auto start = shape_.index_of(row);
    start[N - 1] = run(axis).layer;
    return start;
  }

  /// Copies a segment from its list to the output array `all`.
  void put(const Segment& segment, const std::vector<Vertex>& list, Vertex* all) const noexcept {
    const VertexRun<Vertex>& vertices = target_.vertices;
    Vertex* const to = all + static_cast<Index>(segment.vertex - vertices.first);
    const Vertex* const end = all + (run(segment.axis).end - vertices.data);
    const Vertex* const from = list.data() + segment.first;
    // Copying fixed numbers is faster than copying the exact one. Later segments overwrite the surplus, as the segments
    // of a run come in vertex order. Lists have kMargin more entries.
    const std::size_t rounded = (segment.count + kAtOnce - 1) / kAtOnce * kAtOnce;
    if (end - to < static_cast<std::ptrdiff_t>(rounded)) {
      std::copy_n(from, segment.count, to);
      return;
    }
    for (std::size_t i = 0; i < rounded; i += kAtOnce) std::memcpy(to + i, from + i, kAtOnce * sizeof(Vertex));
  }

  const EdgeCrossings<N>& source_;
  const VertexMoves<N>* moves_;  ///< null: vertices stay on their edges
  const Placement<N, Real>& placement_;
  /// `source`, if it computes interpolation parameters from samples that normals read too; otherwise null.
  const RowSource<float, N>* floats_ = nullptr;
  VertexUncertainty* uncertainty_;  ///< null: not requested
  const RowShape<N>& shape_;
  std::array<std::ptrdiff_t, N> strides_;
  std::size_t full_;
  bool fetches_;                                ///< whether samples are requested before they are needed
  std::unique_ptr<NormalScratch> normals_;      ///< null: no normals requested
  std::unique_ptr<RowNormals<N>> row_normals_;  ///< null: none are computed by row
  EdgeTarget<Vertex> target_{};
  /// Where the ends of edges along an axis are in memory.
  struct Ends {
    LayerInMemory layer;              ///< in which the edges start
    const std::byte* next = nullptr;  ///< one step along the axis from its first sample
  };
  std::array<Ends, N> ends_{};  ///< by axis
  std::array<List, N> lists_;
  std::vector<Segment> segments_;
};

}  // namespace tegl::detail
