// SPDX-License-Identifier: BSD-3-Clause
//
// Computes the vertices that cells own together: those of cubes and of tesseracts that are resolved from the data.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "image/corners_of_row.hpp"
#include "image/placed_crossings.hpp"
#include "image/rays_of_tiles.hpp"
#include "image/sample_source.hpp"
#include "kernel/extract_cell.hpp"
#include "kernel/placement.hpp"
#include "kernel/shared_places.hpp"
#include "tile/edge_means.hpp"
#include "tile/extract_tables.hpp"

namespace tegl::detail {

/// Collects the own vertices of cubes, and of tesseracts those at means of vertices on edges and on rays, and writes
/// many at once: their arithmetic is done in the lanes of registers, and without branches on the kind of each, which
/// noise makes hard to predict. One per thread.
template <int N, class Real>
class CellVertices {
 public:
  using Base = SampleIndex<N>;
  using Run = VertexRun<std::array<Real, N>>;

  /// `epsilon`: as ExtractOptions::epsilon.
  CellVertices(const SampleSource<N>& source, double epsilon, const Placement<N, Real>& placement) noexcept
      : source_(source),
        is_linear_(dynamic_cast<const PlacedCrossings*>(&source) == nullptr),
        epsilon_(epsilon),
        placement_(placement) {}

  /// Vertices added between start() and finish() are written to `vertices`.
  void start(const Run& vertices) noexcept { vertices_ = vertices; }
  void finish() noexcept {
    write(in_cubes_);
    for (OnCubeRays& rays : in_cubes_on_rays_) write(rays);
    if constexpr (N == 4) {
      row_.finish();
      write(in_tesseracts_);
      write(in_tesseracts_on_rays_);
    }
  }

  /// Starts a row of tiles, of which `count` are active; `base`, `size`: as CornersOfRow. Cubes and tesseracts that are
  /// added until the next row or finish() are in this row.
  void start_row(const Base& base, std::size_t size, std::size_t count) noexcept requires(N == 4) {
    row_.finish();
    if (count * kLeastShare >= size) row_.start(source_, base, size);
  }

  /// Adds the own vertices of a list of the cube along `axes` based at `base`. Requires that none is a barycentre.
  /// `first`: number of the first.
  void add(const ResolvedCubes& cubes, unsigned list, const Base& base, unsigned axes, Index first) noexcept {
    std::array<double, 8> values, heights;
    read_cube(base, axes, values);
    for (std::size_t v = 0; v < 8; ++v) heights[v] = values[v] - source_.isovalue();
    for (unsigned j = 0; j < cubes.own_vertices(list); ++j) {
      const std::uint32_t mask = cubes.mask(list, j);
      if (!is_on_ray(mask)) {
        add_mean(
            in_cubes_, mask >> 8, [&](std::size_t v) { return values[v]; }, base, axes, first + j);
        continue;
      }
      OnCubeRays& to = in_cubes_on_rays_[kRayKinds[mask & 0xffu]];
      if (to.points.count == kAtOnce) write(to);
      to.kind = kRayKinds[mask & 0xffu];
      for (unsigned a = 0, j_in_cube = 0; a < N; ++a) {
        to.directions[a][to.points.count] = static_cast<double>(kDirections[mask & 0xffu][j_in_cube]);
        j_in_cube += axes >> a & 1u;
      }
      to.rays.add(heights, mask);
      add_point(to.points, base, axes, first + j);
    }
  }

  /// Adds the own vertices of a tesseract that is combined from its cubes, which have `lists`. If it has one that is
  /// neither a mean nor on a ray, or one on the ray of another, they are written at once. `first`: number of the first.
  void add(const ResolvedView& filling, const ResolvedCubes::Lists& lists, Triangulation triangulation,
           const Base& base, unsigned signature, Index first) noexcept requires(N == 4) {
    if (filling.own_vertices == 0) return;
    std::uint64_t masks = 0;
    for (unsigned j = 0; j < filling.own_vertices; ++j) masks |= filling.masks[j];
    if (!ResolvedPlaces::are_on_rays(masks) || placement_.normals() != nullptr)
      return write_at_once(filling, lists, triangulation, base, signature, first);
    const auto add_to = [&](const auto& sample) {
      if ((masks & 0xffffu) != 0) return add_rays(filling, masks, sample, base, first);
      for (unsigned j = 0; j < filling.own_vertices; ++j)
        add_mean(in_tesseracts_, ResolvedPlaces::edges_of(filling.masks[j]), sample, base, 15u, first + j);
    };
    if (row_.has_row()) {
      const double* const corners = row_.tile(base[0]);
      return add_to([corners](std::size_t v) { return corners[CornersOfRow::offset(v)]; });
    }
    std::array<double, 16> corners;
    source_.corner_values(base, 15u, corners.data());
    add_to([&corners](std::size_t v) { return corners[v]; });
  }

 private:
  static constexpr std::size_t kAtOnce = CubeRays::kMost;
  static_assert(kAtOnce == PointsInBoxes::kMost && kAtOnce == EdgeMeans<3>::kMost && kAtOnce == EdgeMeans<4>::kMost);
  /// In rows with fewer than one active tile per so many samples, the samples of each cell are read by themselves.
  static constexpr std::size_t kLeastShare = 4;
  static constexpr std::size_t kNoSlab = ~std::size_t{0};
  /// Kind of a ray by its 1, 2 or 4 corners: 0, 1, 2 for rays to corners, edges, squares. A table: for std::popcount
  /// compilers call a function, unless they compile for processors that have an instruction for it.
  static constexpr auto kRayKinds = [] {
    std::array<std::uint8_t, 256> kinds{};
    for (unsigned corners = 0; corners < 256; ++corners)
      kinds[corners] = static_cast<std::uint8_t>(std::popcount(corners) / 2);
    return kinds;
  }();
  /// By corners and axis of a cube: the direction of their ray (ray_place).
  static constexpr auto kDirections = [] {
    std::array<std::array<std::int8_t, 4>, 256> directions{};
    for (unsigned corners = 1; corners < 256; ++corners) {
      unsigned all = 7, some = 0;
      for (unsigned v = 0; v < 8; ++v)
        if ((corners >> v & 1u) != 0) all &= v, some |= v;
      for (unsigned a = 0; a < 3; ++a)
        directions[corners][a] =
            static_cast<std::int8_t>(static_cast<int>(all >> a & 1u) + static_cast<int>(some >> a & 1u) - 1);
    }
    return directions;
  }();

  /// Points in the boxes of cells, and the vertices that they are.
  struct Points {
    std::size_t count = 0;
    PointsInBoxes in_boxes;
    std::array<Index, kAtOnce> ids;
    std::array<std::size_t, kAtOnce> slabs;  ///< kNoSlab: the cell lies in a layer
    std::array<std::uint8_t, kAtOnce> axes;  ///< of cells
    std::array<Base, kAtOnce> bases;         ///< of cells; only if vertices have normals
  };
  void add_point(Points& to, const Base& base, unsigned axes, Index id) noexcept {
    const std::size_t i = to.count++;
    for (int a = 0; a < N; ++a) {
      to.in_boxes.from[a][i] = placement_.sample(a, base[a]);
      to.in_boxes.to[a][i] = placement_.sample(a, base[a] + (axes >> a & 1u));
    }
    to.ids[i] = id;
    to.slabs[i] = (axes >> (N - 1) & 1u) != 0 ? base[N - 1] : kNoSlab;
    to.axes[i] = static_cast<std::uint8_t>(axes);
    if (placement_.normals() != nullptr) to.bases[i] = base;
  }
  void write(Points& points) noexcept {
    place_in_boxes(points.count, points.in_boxes);
    for (std::size_t i = 0; i < points.count; ++i) {
      write_point(points.ids[i], points.slabs[i], points.in_boxes.points[i].data());
      if (placement_.normals() != nullptr) write_normal(points, i);
    }
    points.count = 0;
  }
  void write_point(Index id, std::size_t slab, const double* at) noexcept {
    std::array<double, N> point;
    std::copy_n(at, N, point.begin());
    const auto vertex = placement_.world(point);
    vertices_[id] = slab == kNoSlab ? vertex : placement_.inside_slab(vertex, slab);
  }
  void write_normal(const Points& points, std::size_t i) noexcept {
    const auto write_along = [&]<unsigned Axes>(std::integral_constant<unsigned, Axes>) {
      using Frame = CellFrame<N, Axes>;
      TilePoint<3> place;
      for (std::size_t j = 0; j < 3; ++j) place[j] = points.in_boxes.at[Frame::axes()[j]][i];
      vertices_.normal(points.ids[i]) = placement_.normals()->template in_cell<Frame>(points.bases[i], place);
    };
    if (points.axes[i] == 7u) return write_along(std::integral_constant<unsigned, 7u>());
    if constexpr (N == 4) {
      if (points.axes[i] == 11u) return write_along(std::integral_constant<unsigned, 11u>());
      if (points.axes[i] == 13u) return write_along(std::integral_constant<unsigned, 13u>());
      write_along(std::integral_constant<unsigned, 14u>());
    }
  }

  /// Vertices at means in cells of K axes.
  template <int K>
  struct Means {
    EdgeMeans<K> means;
    alignas(64) std::array<std::array<double, kAtOnce>, std::size_t{1} << K> samples{};  ///< by corner and mean
    Points points;
  };
  template <int K, class Sample>
  void add_mean(Means<K>& to, std::uint32_t edges, const Sample& sample, const Base& base, unsigned axes,
                Index id) noexcept {
    if (to.points.count == kAtOnce) write(to);
    const std::size_t i = to.points.count;
    for (std::size_t v = 0; v < to.samples.size(); ++v) to.samples[v][i] = sample(v);
    if (!is_linear_) read_alphas<K>(base, axes, edges, to.means.alphas, i);
    to.means.edges[i] = edges;
    add_point(to.points, base, axes, id);
  }
  template <int K>
  void write(Means<K>& of) noexcept {
    of.means.count = of.points.count;
    if (of.means.count == 0) return;
    if (is_linear_)
      alphas_of_cells(K, of.samples[0].data(), kAtOnce, kAtOnce, source_.isovalue(), epsilon_,
                      of.means.alphas[0].data());
    auto& at = of.points.in_boxes.at;
    if constexpr (K == 4) {
      find_means<4>(of.means, at);
    } else {
      EdgeMeans<3>::Coordinates found;
      find_means<3>(of.means, found);
      for (std::size_t i = 0; i < of.means.count; ++i)
        for (unsigned a = 0, j = 0; a < N; ++a) {
          const bool is_along = (of.points.axes[i] >> a & 1u) != 0;
          at[a][i] = is_along ? found[j][i] : 0.5;
          j += is_along ? 1 : 0;
        }
    }
    write(of.points);
  }
  /// Reads interpolation parameters of edges of a cell to alphas[edge][i].
  template <int K, class Alphas>
  [[gnu::noinline]] void read_alphas(const Base& base, unsigned axes, std::uint32_t edges, Alphas& alphas,
                                     std::size_t i) noexcept {
    std::array<double, tables::edge_count(K)> alone;
    source_.cell_alphas(base, axes, edges, alone.data());
    for (; edges != 0; edges &= edges - 1) {
      const auto e = static_cast<std::size_t>(std::countr_zero(edges));
      alphas[e][i] = alone[e];
    }
  }

  /// Vertices of cubes on rays of one kind.
  struct OnCubeRays {
    unsigned kind = 0;
    CubeRays rays;
    alignas(64) std::array<std::array<double, kAtOnce>, N> directions{};  ///< by axis and ray (kDirections)
    Points points;
  };
  void write(OnCubeRays& of) noexcept {
    if (of.points.count == 0) return;
    std::array<double, kAtOnce> levels;
    cube_levels(of.rays, 3 - of.kind, epsilon_, levels);
    for (std::size_t a = 0; a < N; ++a)
      for (std::size_t i = 0; i < of.points.count; ++i) {
        const double at = 0.5 + 0.5 * levels[i] * of.directions[a][i];
        of.points.in_boxes.at[a][i] = (of.points.axes[i] >> a & 1u) != 0 ? at : 0.5;
      }
    of.rays.count = 0;
    write(of.points);
  }
  /// Reads the samples at the corners of a cube.
  void read_cube(const Base& base, unsigned axes, std::array<double, 8>& out) noexcept {
    if constexpr (N == 4)
      if (row_.has_row()) {
        static constexpr auto kAt = [] {
          std::array<std::array<std::uint16_t, 8>, 16> at{};
          for (unsigned along = 0; along < 16; ++along)
            for (unsigned v = 0; v < 8; ++v) {
              unsigned corner = 0;
              for (unsigned a = 0, j = 0; a < 4; ++a)
                if ((along >> a & 1u) != 0) corner |= (v >> j++ & 1u) << a;
              at[along][v] = static_cast<std::uint16_t>(CornersOfRow::offset(corner));
            }
          return at;
        }();
        const double* const from =
            row_.tile(base[0]) + (base[3] != row_.base()[3] ? CornersOfRow::offset(8) : std::size_t{0});
        for (std::size_t v = 0; v < 8; ++v) out[v] = from[kAt[axes][v]];
        return;
      }
    source_.corner_values(base, axes, out.data());
  }

  /// Vertices of tesseracts on rays.
  struct OnRays {
    RaysOfTiles rays;
    std::array<std::size_t, RaysOfTiles::kMostTiles> slabs;  ///< by tile: the lower layer
    // By vertex: its place among the rays, and its number.
    std::size_t count = 0, others = 0;
    std::array<std::uint16_t, RaysOfTiles::kMost> places;
    std::array<Index, RaysOfTiles::kMost> ids;
    // Rays to other points than corners: places and masks.
    std::array<std::uint16_t, RaysOfTiles::kMost> other_places;
    std::array<std::uint64_t, RaysOfTiles::kMost> other_masks;
    /// By edge and tile.
    alignas(64) std::array<std::array<double, RaysOfTiles::kMostTiles>, 32> alphas;
  };
  template <class Sample>
  void add_rays(const ResolvedView& filling, std::uint64_t masks, const Sample& sample, const Base& base,
                Index first) noexcept requires(N == 4) {
    OnRays& to = in_tesseracts_on_rays_;
    if (!to.rays.has_room(filling.own_vertices)) write(to);
    RaysOfTiles& rays = to.rays;
    for (std::size_t v = 0; v < 16; ++v) rays.samples[v][rays.tiles] = sample(v);
    if (!is_linear_) read_alphas<4>(base, 15u, ResolvedPlaces::edges_of(masks), to.alphas, rays.tiles);
    const typename Placement<N, Real>::Cell cell(placement_, base);
    rays.boxes[rays.tiles] = {cell.from(), cell.to()};
    to.slabs[rays.tiles] = base[N - 1];
    std::size_t place = rays.next_place(), count = to.count, others = to.others;
    for (unsigned j = 0; j < filling.own_vertices; ++j) {
      const std::uint64_t mask = filling.masks[j];
      if (ResolvedPlaces::is_mean(mask)) {
        add_mean(in_tesseracts_, ResolvedPlaces::edges_of(mask), sample, base, 15u, first + j);
        continue;
      }
      const bool is_corner = (mask & (mask - 1)) == 0;
      rays.corners[place] = is_corner ? mask : 0;
      to.other_places[others] = static_cast<std::uint16_t>(place);
      to.other_masks[others] = mask;
      others += is_corner ? 0 : 1;
      to.places[count] = static_cast<std::uint16_t>(place++);
      to.ids[count++] = first + j;
    }
    rays.add(count - to.count);
    to.count = count;
    to.others = others;
  }
  void write(OnRays& of) noexcept requires(N == 4) {
    if (of.count == 0) return;
    find_ends(of);
    place_on_rays(source_.isovalue(), epsilon_, of.rays);
    for (std::size_t i = 0; i < of.count; ++i) {
      const std::size_t at = of.places[i];
      const std::array<double, 4> point = {of.rays.ends[0][at], of.rays.ends[1][at], of.rays.ends[2][at],
                                           of.rays.ends[3][at]};
      write_point(of.ids[i], of.slabs[of.rays.tile_of[at / RaysOfTiles::kGroup]], point.data());
    }
    of.count = of.others = 0;
    of.rays.clear();
  }
  /// Sets the ends of rays to other points than corners.
  void find_ends(OnRays& of) noexcept requires(N == 4) {
    if (of.others == 0) return;
    if (is_linear_)
      alphas_of_cells(4, of.rays.samples[0].data(), RaysOfTiles::kMostTiles, RaysOfTiles::kMostTiles,
                      source_.isovalue(), epsilon_, of.alphas[0].data());
    for (std::size_t i = 0; i < of.others; ++i) {
      const std::size_t at = of.other_places[i], tile = of.rays.tile_of[at / RaysOfTiles::kGroup];
      const auto on_edge = [&](unsigned e) { return edge_point_at_once<4>(e, of.alphas[e][tile]); };
      const TilePoint<4> end = mask_mean<4>(of.other_masks[i], std::identity(), on_edge, true);
      for (std::size_t a = 0; a < 4; ++a) of.rays.ends[a][at] = end[a];
    }
  }

  /// Writes the own vertices of a tesseract. Not inlined, because its stack frame is large.
  [[gnu::noinline]] void write_at_once(const ResolvedView& filling, const ResolvedCubes::Lists& lists,
                                       Triangulation triangulation, const Base& base, unsigned signature,
                                       Index first) noexcept requires(N == 4) {
    const EdgePlaces<4, 15> edges(source_, base, signature);
    ResolvedPlaces places(edges, triangulation, lists);
    const typename Placement<N, Real>::Cell in_cell(placement_, base);
    places.own_vertices(filling, [&](unsigned j, const TilePoint<N>& place) {
      vertices_[first + j] = in_cell(place);
      if (placement_.normals() != nullptr)
        vertices_.normal(first + j) = placement_.normals()->template in_cell<CellFrame<N, 15u>>(base, place);
    });
  }

  const SampleSource<N>& source_;
  bool is_linear_;  ///< whether interpolation parameters follow from the samples
  double epsilon_;
  const Placement<N, Real>& placement_;
  Run vertices_{};
  Means<3> in_cubes_;
  std::array<OnCubeRays, 3> in_cubes_on_rays_;
  struct None {};
  std::conditional_t<N == 4, CornersOfRow, None> row_;
  std::conditional_t<N == 4, Means<4>, None> in_tesseracts_;
  std::conditional_t<N == 4, OnRays, None> in_tesseracts_on_rays_;
};

}  // namespace tegl::detail
