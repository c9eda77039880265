// SPDX-License-Identifier: BSD-3-Clause
//
// Points on critical edges. A row has a few edges of each axis, or many; so edges are gathered from row after row, by
// axis, until there are enough for the loops that work on many at a time, and their points then go where they belong.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "kernel/extract_layers.hpp"
#include "kernel/placement.hpp"
#include "tile/extract_rows.hpp"

namespace tegl::detail {

/// Room for vertices by number. Numbers count modulo 2^32, so that a contour may have more, if no part of it has.
template <class Vertex>
struct VertexRun {
  Vertex* data;
  Index first;
  Vertex* normals = nullptr;  ///< null: none are wanted
  Vertex& operator[](Index id) const noexcept { return data[static_cast<Index>(id - first)]; }
  Vertex& normal(Index id) const noexcept { return normals[static_cast<Index>(id - first)]; }
};

/// Where the edges come from and their points go, for a chunk of rows: those of a layer, and those along the last axis
/// of the slab below it.
template <class Vertex>
struct EdgeTarget {
  struct Run {
    std::size_t layer = 0;  ///< that the edges start in
    Vertex* end = nullptr;  ///< of what may be written when others have yet to come
  };
  Run in_layer, in_slab;
  VertexRun<Vertex> vertices;
};

/// One per thread. O(samples of a row) memory: of long rows, where the edges are; all else by pieces of them.
template <int N, class Real>
class EdgeWriter {
 public:
  using Vertex = std::array<Real, N>;
  /// By axis.
  using Counts = std::array<std::uint32_t, N>;
  using Firsts = std::array<Index, N>;

  EdgeWriter(const SampleSource<N>& source, const Placement<N, Real>& placement, const RowShape<N>& shape)
      : source_(source), placement_(placement), shape_(shape), strides_(source.strides()), full_(full(shape.size(0))) {
    for (int a = 0; a < N; ++a) lists_[a].allocate(shape.size(0), a > 0 && a + 1 < N);
    segments_.reserve(most_segments(shape.size(0)));  // later on, nothing may be thrown
    if (placement.normals() == nullptr) return;
    normals_ = std::make_unique<NormalScratch>();
    for (List& list : lists_) list.normals.resize(room_together(shape.size(0)));
  }

  /// Of one for rows of so many samples.
  static constexpr std::size_t bytes(std::size_t samples, bool normals) noexcept {
    constexpr std::size_t kEach = sizeof(std::ptrdiff_t) + N * sizeof(double);
    const std::size_t vertices = room_together(samples) * (normals ? 2 : 1);
    return N * (sizeof(std::uint32_t) * room(samples) + kEach * room_at_once(samples) + sizeof(Vertex) * vertices) +
           most_segments(samples) * sizeof(Segment) + (normals ? sizeof(NormalScratch) : 0);
  }

  /// From here on, until finish(), edges are those of `target`.
  void start(const EdgeTarget<Vertex>& target) noexcept { target_ = target; }
  void finish() noexcept { flush(); }

  /// The edges of a row of a slab, and of the layer above: by its active tiles.
  void add_by_tiles(const SlabView<N>& view, std::size_t row, const RowTiles& tiles) noexcept {
    Counts counts;
    Firsts firsts;
    for (int a = 0; a < N; ++a) {
      const EdgePlane& plane = view.edges(a, 1);
      counts[a] = plane.count[row];
      firsts[a] = plane.first(row);
    }
    add(row, counts, firsts, [&](const std::array<std::uint32_t*, 4>& out) {
      list_tile_edges<N>({tiles.signatures, tiles.at, tiles.count, out});
      list_last(view, row, counts, out);
    });
  }

  /// The edges of a row of `layer` (axes 0 ... N-2) and of `slab` (axis N-1), by their bits; either may be null.
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
    add(row, counts, firsts, [&](const std::array<std::uint32_t*, 4>& out) {
      for (int a = 0; a < N; ++a)
        if (counts[a] != 0) list_bits(planes[a]->bits[0].data() + row * shape_.words(), shape_.words(), out[a]);
    });
  }

 private:
  static constexpr std::size_t kMargin = 16;   ///< what is written behind lists
  static constexpr std::uint32_t kMany = 48;   ///< edges of a row that need no others beside them
  static constexpr std::size_t kAtOnce = 8;    ///< values
  static constexpr std::size_t kPiece = 4096;  ///< edges of one row that are worked on at a time

  /// How many edges make a list full, and what it has room for, where rows have so many samples.
  static constexpr std::size_t full(std::size_t samples) noexcept {
    return std::clamp<std::size_t>(samples / 2, 32, 512);
  }
  static constexpr std::size_t room(std::size_t samples) noexcept { return full(samples) + samples + kMargin; }
  /// For edges of several rows.
  static constexpr std::size_t room_together(std::size_t samples) noexcept { return full(samples) + kMany + kMargin; }
  static constexpr std::size_t room_at_once(std::size_t samples) noexcept {
    return std::max(room_together(samples), std::min(samples, kPiece) + kMargin);
  }
  /// Each has an edge at least.
  static constexpr std::size_t most_segments(std::size_t samples) noexcept { return N * (full(samples) + 1); }

  /// Edges along one axis. Where they are of one row, there is no more than a piece of what is below `at`: alike for
  /// all of them, or used up before the next piece.
  struct List {
    std::size_t size = 0;
    std::vector<std::uint32_t> at;
    std::vector<std::ptrdiff_t> rows;
    std::array<std::vector<double>, N> start;  ///< as in EdgePoints
    std::vector<double> end;
    std::vector<double> alphas;
    std::vector<Vertex> points;   ///< of several rows
    std::vector<Vertex> normals;  ///< likewise, if any are wanted

    void allocate(std::size_t samples, bool has_end) {
      at.resize(room(samples));
      points.resize(room_together(samples));
      const std::size_t most = room_at_once(samples);
      rows.resize(most);
      alphas.resize(most);
      for (int a = 1; a + 1 < N; ++a) start[a].resize(most);
      if (has_end) end.resize(most);
    }
  };
  /// Edges of one row in a list.
  struct Segment {
    std::size_t row;
    int axis;
    std::uint32_t first, count;
    Index vertex;
  };

  template <class Value>
  static void fill(std::vector<Value>& values, std::size_t first, std::size_t count, Value value) noexcept {
    Value* const to = values.data() + first;
    for (std::size_t i = 0; i < count; i += kAtOnce)
      for (std::size_t j = 0; j < kAtOnce; ++j) to[i + j] = value;
  }

  /// Lists the edges of a row, axis by axis.
  template <class ListEdges>
  void add(std::size_t row, const Counts& counts, const Firsts& firsts, const ListEdges& list_edges) noexcept {
    const std::uint32_t most = *std::max_element(counts.begin(), counts.end());
    if (most == 0) return;
    const auto& index = shape_.index_of(row);
    const bool alone = most >= kMany || (normals_ && !placement_.normals()->is_inside(index));
    if (alone) flush();
    std::array<std::uint32_t*, 4> out{};
    for (int a = 0; a < N; ++a) out[a] = lists_[a].at.data() + lists_[a].size;
    list_edges(out);
    std::ptrdiff_t offset = 0;
    for (int a = 1; a + 1 < N; ++a) offset += static_cast<std::ptrdiff_t>(index[a]) * strides_[a];
    std::size_t longest = 0;
    for (int axis = 0; axis < N; ++axis) {
      const std::uint32_t count = counts[axis];
      if (count == 0) continue;
      List& list = lists_[axis];
      const std::size_t filled = std::min<std::size_t>(count, kPiece);
      fill(list.rows, list.size, filled, offset);
      for (int a = 1; a + 1 < N; ++a) fill(list.start[a], list.size, filled, placement_.sample(a, index[a]));
      if (axis > 0 && axis + 1 < N) fill(list.end, list.size, filled, placement_.sample(axis, index[axis] + 1));
      segments_.push_back({row, axis, static_cast<std::uint32_t>(list.size), count, firsts[axis]});
      list.size += count;
      longest = std::max(longest, list.size);
    }
    if (alone || longest >= full_) flush();
  }

  /// The edges at a row's last sample, which no tile starts from: each is the last of its list.
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

  /// Writes the points of all that is listed.
  void flush() noexcept {
    if (segments_.empty()) return;
    const bool in_place = segments_.back().row == segments_.front().row;  // one row: one segment in a list
    std::array<Vertex*, N> points, normals;
    for (int axis = 0; axis < N; ++axis) {
      points[axis] = lists_[axis].points.data();
      normals[axis] = lists_[axis].normals.data();
    }
    if (in_place)
      for (const Segment& segment : segments_) {
        points[segment.axis] = &target_.vertices[segment.vertex];
        if (normals_) normals[segment.axis] = &target_.vertices.normal(segment.vertex);
      }
    for (int axis = 0; axis < N; ++axis)
      for (std::size_t first = 0; first < lists_[axis].size; first += kPiece) {
        const EdgesInRows edges = make_points(axis, first, points[axis] + first);
        if (normals_) make_normals(axis, first, edges, normals[axis] + first);
      }
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

  /// Of a piece of one list, from edge `first` on, which it returns.
  EdgesInRows make_points(int axis, std::size_t first, Vertex* out) noexcept {
    List& list = lists_[axis];
    const std::size_t layer = run(axis).layer;
    const EdgesInRows edges{list.rows.data(), list.at.data() + first, std::min(kPiece, list.size - first)};
    source_.edge_alphas(layer, axis, edges, list.alphas.data());
    EdgePoints<N, Real> points{};
    points.at = edges.at;
    points.alphas = list.alphas.data();
    points.count = edges.count;
    points.axis = axis;
    for (int a = 1; a + 1 < N; ++a) points.start[a] = list.start[a].data();
    points.end = list.end.data();
    points.out = out;
    placement_.edges(layer, points);
    return edges;
  }

  /// The normals of that piece, whose places on edges are known.
  void make_normals(int axis, std::size_t first, const EdgesInRows& edges, Vertex* out) noexcept {
    const auto start_of = [&](std::size_t i) {
      const Segment& segment = *std::find_if(segments_.begin(), segments_.end(), [&](const Segment& s) {
        return s.axis == axis && first + i - s.first < s.count;
      });
      auto start = start_in(segment.row, axis);
      start[0] = edges.at[i];
      return start;
    };
    placement_.normals()->edges(start_in(segments_.front().row, axis), axis, edges, lists_[axis].alphas.data(),
                                *normals_, out, start_of);
  }

  /// The first sample of the row that edges start in.
  [[nodiscard]] typename RowShape<N>::Index start_in(std::size_t row, int axis) const noexcept {
    auto start = shape_.index_of(row);
    start[N - 1] = run(axis).layer;
    return start;
  }

  /// Copies a segment of its list to where it belongs, `all` being the room for all vertices.
  void put(const Segment& segment, const std::vector<Vertex>& list, Vertex* all) const noexcept {
    const VertexRun<Vertex>& vertices = target_.vertices;
    Vertex* const to = all + static_cast<Index>(segment.vertex - vertices.first);
    const Vertex* const end = all + (run(segment.axis).end - vertices.data);
    const Vertex* const from = list.data() + segment.first;
    // As many as there may be, for it is slow to find out how few: what is written too much, later ones take the place
    // of. (Segments of a run come in the order of their vertices.)
    if (segment.count <= kAtOnce && end - to >= static_cast<std::ptrdiff_t>(kAtOnce))
      std::memcpy(to, from, kAtOnce * sizeof(Vertex));
    else
      std::copy_n(from, segment.count, to);
  }

  const SampleSource<N>& source_;
  const Placement<N, Real>& placement_;
  const RowShape<N>& shape_;
  std::array<std::ptrdiff_t, N> strides_;
  std::size_t full_;
  std::unique_ptr<NormalScratch> normals_;  ///< null: none are wanted
  EdgeTarget<Vertex> target_{};
  std::array<List, N> lists_;
  std::vector<Segment> segments_;
};

}  // namespace tegl::detail
