// SPDX-License-Identifier: BSD-3-Clause
//
// Pass 4 of the extraction: writes the vertices that cubes own, those of 3D tiles that are resolved from the data and,
// in 4D, the barycentres of a row's cubes and the means that tiles own.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "image/rays_of_tiles.hpp"
#include "kernel/extract_cell.hpp"
#include "kernel/extract_count.hpp"
#include "kernel/extract_edges.hpp"
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

  CellVertices(const EdgeCrossings<N>& source, const Placement<N, Real>& placement) noexcept
      : source_(source), placement_(placement) {}

  /// Vertices added between start() and finish() are written to `vertices`.
  void start(const Run& vertices) noexcept { vertices_ = vertices; }
  void finish() noexcept {
    write_means(in_cubes_);
    if constexpr (N == 4) {
      write_means(in_tesseracts_);
      write_tesseract_rays();
    }
    for (unsigned kind = 0; kind < rays_.size(); ++kind) write_rays(kind);
  }

  /// Adds the own vertices of a list of the cube along `axes` based at `base`. Requires that none is a barycentre.
  /// `first`: number of the first.
  void add(const ResolvedCubes& cubes, unsigned list, const Base& base, unsigned axes, Index first) noexcept {
    std::optional<CubeHeights> heights;
    for (unsigned j = 0; j < cubes.own_vertices(list); ++j) {
      const std::uint32_t mask = cubes.mask(list, j);
      if (!is_on_ray(mask)) {
        add_mean(in_cubes_, mask >> 8, base, axes, first + j);
        continue;
      }
      const unsigned kind = kRayKinds[mask & 0xffu];
      if (rays_[kind].count == kAtOnce) write_rays(kind);
      if (!heights) heights = source_.template heights<3>(base, axes);
      epsilon_ = heights->epsilon;
      corners_[kind][rays_[kind].count] = static_cast<std::uint8_t>(mask);
      of_rays_[kind].set(rays_[kind].count, base, axes, first + j);
      rays_[kind].add(heights->at, mask);
    }
  }

  /// Adds the own vertices of a tesseract that is combined from its cubes, which have `lists`. If it has one that is
  /// neither a mean nor on a ray, or one on the ray of another, or vertices have normals, then all except the means are
  /// written at once. `first`: number of the first.
  void add(const ResolvedView& filling, const ResolvedCubes::Lists& lists, Triangulation triangulation,
           const Base& base, unsigned signature, Index first) noexcept requires(N == 4) {
    std::uint64_t others = 0;  // masks
    for (unsigned j = 0; j < filling.own_vertices; ++j) {
      const std::uint64_t mask = filling.masks[j];
      if (ResolvedPlaces::is_mean(mask))
        add_mean(in_tesseracts_, ResolvedPlaces::edges_of(mask), base, 15u, first + j);
      else
        others |= mask;
    }
    if (others == 0) return;
    if (placement_.normals() == nullptr && ResolvedPlaces::are_on_rays(others))
      add_rays(filling, others, base, signature, first);
    else
      write_others(filling, others, lists, triangulation, base, signature, first);
  }

 private:
  static constexpr std::size_t kAtOnce = CubeRays::kMost;
  /// Kind of a ray (write_rays) by its 1, 2 or 4 corners. A table: for std::popcount compilers call a function, unless
  /// they compile for processors that have an instruction for it.
  static constexpr auto kRayKinds = [] {
    std::array<std::uint8_t, 256> kinds{};
    for (unsigned corners = 0; corners < 256; ++corners)
      kinds[corners] = static_cast<std::uint8_t>(std::popcount(corners) / 2);
    return kinds;
  }();

  struct Targets {
    std::array<Base, kAtOnce> bases;
    std::array<std::uint8_t, kAtOnce> axes;
    std::array<Index, kAtOnce> ids;
    void set(std::size_t i, const Base& base, unsigned along, Index id) noexcept {
      bases[i] = base;
      axes[i] = static_cast<std::uint8_t>(along);
      ids[i] = id;
    }
  };

  template <int K>
  struct Means {
    static_assert(kAtOnce == EdgeMeans<K>::kMost && kAtOnce == CellsWithEdges<N, K>::kMost);
    EdgeMeans<K> means;
    Targets targets;
  };

  template <int K>
  void add_mean(Means<K>& to, std::uint32_t edges, const Base& base, unsigned axes, Index id) noexcept {
    if (to.means.count == kAtOnce) write_means(to);
    to.means.edges[to.means.count] = edges;
    to.targets.set(to.means.count++, base, axes, id);
  }
  template <int K>
  void write_means(Means<K>& of) noexcept {
    EdgeMeans<K>& means = of.means;
    if (means.count == 0) return;
    source_.cells_alphas({of.targets.axes.data(), of.targets.bases.data(), means.edges.data(), means.count},
                         means.alphas);
    typename EdgeMeans<K>::Coordinates found;
    find_means<K>(means, found);
    for (std::size_t i = 0; i < means.count; ++i) {
      TilePoint<K> point;
      for (std::size_t a = 0; a < K; ++a) point[a] = found[a][i];
      write<K>(of.targets, i, point);
    }
    means.count = 0;
  }

  /// `kind`: 0, 1, 2 for rays to corners, edges, squares.
  void write_rays(unsigned kind) noexcept {
    CubeRays& rays = rays_[kind];
    if (rays.count == 0) return;
    std::array<double, kAtOnce> levels;
    cube_levels(rays, 3 - kind, epsilon_, levels);
    for (std::size_t i = 0; i < rays.count; ++i) write<3>(of_rays_[kind], i, ray_place(corners_[kind][i], levels[i]));
    rays.count = 0;
  }

  /// Adds the own vertices of a tesseract that are no means, but on rays; `masks`: of all of them.
  [[gnu::noinline]] void add_rays(const ResolvedView& filling, std::uint64_t masks, const Base& base,
                                  unsigned signature, Index first) noexcept requires(N == 4) {
    if (!of_tesseracts_.rays.has_room(filling.own_vertices)) write_tesseract_rays();
    const CellHeights<4> heights = source_.template heights<4>(base, 15u);
    epsilon_ = heights.epsilon();
    const auto edges = ResolvedPlaces::needs_edges(masks) ? EdgePlaces<4, 15>(source_, base, signature)
                                                          : EdgePlaces<4, 15>(source_, base);
    RaysOfTiles& rays = of_tesseracts_.rays;
    of_tesseracts_.slabs[rays.tiles] = base[N - 1];
    const typename Placement<N, Real>::Cell in_cell(placement_, base);
    std::size_t place = rays.next_place();
    const std::size_t before = of_tesseracts_.count;
    for (unsigned j = 0; j < filling.own_vertices; ++j) {
      const std::uint64_t mask = filling.masks[j];
      if (ResolvedPlaces::is_mean(mask)) continue;
      const TilePoint<4> end = ResolvedPlaces::ray_end(mask, edges);
      for (std::size_t a = 0; a < 4; ++a) rays.ends[a][place] = end[a];
      of_tesseracts_.places[of_tesseracts_.count] = static_cast<std::uint16_t>(place++);
      of_tesseracts_.ids[of_tesseracts_.count++] = first + j;
    }
    rays.add(heights.products(), {in_cell.from(), in_cell.to()}, of_tesseracts_.count - before);
  }
  void write_tesseract_rays() noexcept requires(N == 4) {
    RaysOfTiles& rays = of_tesseracts_.rays;
    place_on_rays(epsilon_, rays);
    for (std::size_t i = 0; i < of_tesseracts_.count; ++i) {
      const std::size_t at = of_tesseracts_.places[i];
      const TilePoint<4> point = {rays.ends[0][at], rays.ends[1][at], rays.ends[2][at], rays.ends[3][at]};
      const std::size_t slab = of_tesseracts_.slabs[rays.tile_of[at / RaysOfTiles::kGroup]];
      vertices_[of_tesseracts_.ids[i]] = placement_.inside_slab(placement_.world(point), slab);
    }
    of_tesseracts_.count = 0;
    rays.clear();
  }

  /// Writes the own vertices of a tesseract that are no means; `masks`: of all of them. Not inlined, because its stack
  /// frame is large.
  [[gnu::noinline]] void write_others(const ResolvedView& filling, std::uint64_t masks,
                                      const ResolvedCubes::Lists& lists, Triangulation triangulation, const Base& base,
                                      unsigned signature, Index first) noexcept requires(N == 4) {
    const auto edges = ResolvedPlaces::needs_edges(masks) ? EdgePlaces<4, 15>(source_, base, signature)
                                                          : EdgePlaces<4, 15>(source_, base);
    ResolvedPlaces places(edges, triangulation, lists);
    const typename Placement<N, Real>::Cell in_cell(placement_, base);
    places.own_vertices(filling, [&](unsigned j, const TilePoint<N>& place) {
      vertices_[first + j] = in_cell(place);
      if (placement_.normals() != nullptr)
        vertices_.normal(first + j) = placement_.normals()->template in_cell<CellFrame<N, 15u>>(base, place);
    });
  }

  template <int K>
  void write(const Targets& of, std::size_t i, const TilePoint<K>& point) noexcept {
    if constexpr (N == K) {
      write_along<(1u << N) - 1>(of, i, point);
    } else {
      switch (of.axes[i]) {
        case 7u:
          return write_along<7u>(of, i, point);
        case 11u:
          return write_along<11u>(of, i, point);
        case 13u:
          return write_along<13u>(of, i, point);
        default:
          return write_along<14u>(of, i, point);
      }
    }
  }
  template <unsigned Axes>
  void write_along(const Targets& of, std::size_t i, const TilePoint<std::popcount(Axes)>& point) noexcept {
    using Frame = CellFrame<N, Axes>;
    vertices_[of.ids[i]] = placement_.template in_cell<Frame>(of.bases[i], point);
    if (placement_.normals() != nullptr)
      vertices_.normal(of.ids[i]) = placement_.normals()->template in_cell<Frame>(of.bases[i], point);
  }

  const EdgeCrossings<N>& source_;
  const Placement<N, Real>& placement_;
  Run vertices_{};
  double epsilon_ = 0.0;
  Means<3> in_cubes_;
  struct None {};
  std::conditional_t<N == 4, Means<4>, None> in_tesseracts_;
  /// Vertices of tesseracts on rays. By vertex: its place among the rays, and its number. By tile: the lower layer.
  struct OnRays {
    RaysOfTiles rays;
    std::size_t count = 0;
    std::array<std::uint16_t, RaysOfTiles::kMost> places;
    std::array<Index, RaysOfTiles::kMost> ids;
    std::array<std::size_t, RaysOfTiles::kMostGroups> slabs;
  };
  std::conditional_t<N == 4, OnRays, None> of_tesseracts_;
  std::array<CubeRays, 3> rays_;
  std::array<Targets, 3> of_rays_;
  std::array<std::array<std::uint8_t, kAtOnce>, 3> corners_;
};

/// Writes the barycentres of a row's cubes along `Axes`, unless tiles write them (TileWriter::writes_cubes). `view`:
/// the layers that contain the cubes.
template <unsigned Axes, class Real>
void generate_cubes(const EdgeCrossings<4>& source, const tables::TileTable& table, const Placement<4, Real>& placement,
                    const SlabView<4>& view, const CubePlane& plane, std::size_t row, std::size_t layer,
                    VertexRun<typename Placement<4, Real>::Vertex> vertices) noexcept {
  const RowShape<4>& shape = *view.shape;
  if (plane.count[row] == 0) return;
  const Word* const first = plane.bits[0].data() + row * shape.words();
  auto index = shape.index_of(row);
  index[3] = layer;
  CellBits<4, Axes> cells(view, row);
  std::array<TilePoint<3>, tables::kFaceSlots> points;
  Index next = plane.first(row);
  // cubes with vertices, 64 positions at a time
  for (std::size_t w = 0; w < shape.words(); ++w) {
    Word rest = first[w];
    if (rest == 0) continue;
    cells.load(w);
    for (; rest != 0; rest &= rest - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(rest));
      const unsigned signature = cells.signature(bit);
      index[0] = w * kWordBits + bit;
      const SimplexList<3> list(table, signature);
      const EdgePlaces<4, Axes> places(source, index, signature);
      own_places<3>(
          list, false, [&](unsigned v) { return places(list.mapped(v)); }, points.data());
      for (unsigned j = 0; j < list.own_vertices(); ++j, ++next) {
        vertices[next] = placement.template in_cell<CellFrame<4, Axes>>(index, points[j]);
        if (placement.normals() != nullptr)
          vertices.normal(next) = placement.normals()->template in_cell<CellFrame<4, Axes>>(index, points[j]);
      }
    }
  }
}

/// Writes the vertices of a row's listed cubes, or adds those that are no barycentres to `together`, to be written
/// later.
template <unsigned Axes, class Real>
void generate_listed_cubes(const EdgeCrossings<4>& source, Triangulation triangulation,
                           const Placement<4, Real>& placement, const SlabView<4>& view, const CubePlane& plane,
                           std::size_t row, std::size_t layer, VertexRun<typename Placement<4, Real>::Vertex> vertices,
                           CellVertices<4, Real>& together) noexcept {
  if (plane.count[row] == 0) return;
  const ResolvedCubes& cubes = ResolvedCubes::instance(triangulation);
  auto index = view.shape->index_of(row);
  index[3] = layer;
  std::array<TilePoint<3>, ResolvedCubes::kMostOwn> points;
  Index next = plane.first(row);
  for (const ListedCube& cube : plane.lists.row(row)) {
    index[0] = cube.at;
    const unsigned number = list_of_key(CubeKey(cube.key));
    if (cubes.summary(number).barycentres == 0) {
      together.add(cubes, number, index, Axes, next);
      next += cubes.own_vertices(number);
      continue;
    }
    const SimplexList<3> list(variant_table<3>(triangulation).tile, cube.key);
    const EdgePlaces<4, Axes> places(source, index, signature_of<3>(cube.key));
    own_places<3>(list, false, places, points.data(), places.rays());
    for (unsigned j = 0; j < list.own_vertices(); ++j, ++next) {
      vertices[next] = placement.template in_cell<CellFrame<4, Axes>>(index, points[j]);
      if (placement.normals() != nullptr)
        vertices.normal(next) = placement.normals()->template in_cell<CellFrame<4, Axes>>(index, points[j]);
    }
  }
}

}  // namespace tegl::detail
