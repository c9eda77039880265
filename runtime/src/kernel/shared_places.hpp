// SPDX-License-Identifier: BSD-3-Clause
//
// Positions of vertices that a cell shares with others, recomputed from the samples on request. Few tiles have vertices
// of their own, and storing all positions for them would take more memory than an image.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <optional>

#include "ambiguity/tesseract_decision.hpp"
#include "image/sample_source.hpp"
#include "tegl/table_contract.hpp"
#include "tegl/tile/corners.hpp"
#include "tile/extract_tables.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

/// Levels of the contour on rays inside the cell along K `axes` based at `base` (CellHeights), which must outlive it;
/// with `raised`, at the next samples along these axes. Reads the samples at the first request.
template <int N, int K>
class CellRays {
 public:
  CellRays(const EdgeCrossings<N>& source, const SampleIndex<N>& base, unsigned axes, unsigned raised = 0) noexcept
      : source_(source), base_(base), axes_(axes), raised_(raised) {}
  /// `end`: corners of a cube (CubeHeights), or a point in the unit tile (TileHeights).
  template <class End>
  [[nodiscard]] double operator()(const End& end) noexcept {
    return heights().level(end);
  }
  /// Sets the levels of some rays.
  void find_levels(TesseractRays& rays) noexcept requires(K == 4) { heights().find_levels(rays); }

 private:
  const CellHeights<K>& heights() noexcept {
    if (heights_) return *heights_;
    auto base = base_;
    for (unsigned a = 0; a < N; ++a) base[a] += raised_ >> a & 1u;
    heights_ = source_.template heights<K>(base, axes_);
    return *heights_;
  }

  const EdgeCrossings<N>& source_;
  const SampleIndex<N>& base_;
  unsigned axes_, raised_;
  std::optional<CellHeights<K>> heights_;
};

/// Positions of the vertices on critical edges of the cell along `Axes` based at `base`, in the frame of the cell.
/// `base` must outlive it: a copy would wait until its parts, which have just been set, are in memory.
template <int N, unsigned Axes>
class EdgePlaces {
 public:
  static constexpr int kDim = std::popcount(Axes);

  EdgePlaces(const EdgeCrossings<N>& source, const std::array<std::size_t, N>& base, unsigned signature) noexcept
      : EdgePlaces(source, base) {
    source.cell_alphas(base, Axes, critical_edges<kDim>(signature), alphas_.data());
  }
  /// For rays only.
  EdgePlaces(const EdgeCrossings<N>& source, const std::array<std::size_t, N>& base) noexcept
      : source_(source), base_(base) {}
  [[nodiscard]] TilePoint<kDim> operator()(unsigned edge) const noexcept {
    return edge_point<kDim>(edge, alphas_[edge]);
  }
  [[nodiscard]] double alpha(unsigned edge) const noexcept { return alphas_[edge]; }
  /// Of the cell.
  [[nodiscard]] CellRays<N, kDim> rays() const noexcept { return {source_, base_, Axes}; }
  /// Of a cube of the cell, which is a tesseract.
  [[nodiscard]] CellRays<N, 3> rays_in(unsigned cube) const noexcept {
    static_assert(Axes == 15);
    return {source_, base_, Axes ^ 1u << cube / 2, cube % 2 << cube / 2};
  }

 private:
  const EdgeCrossings<N>& source_;
  const SampleIndex<N>& base_;
  std::array<double, tables::edge_count(kDim)> alphas_;  ///< undefined for non-critical edges
};

/// Positions of all vertices that a tile shares, by local vertex.
template <int N>
class SharedPlaces {
 public:
  SharedPlaces(const EdgeCrossings<N>& source, const std::array<std::size_t, N>& base, unsigned signature,
               const tables::TileTable* /*cube*/) noexcept
      : edges_(source, base, signature) {}
  [[nodiscard]] TilePoint<N> operator()(unsigned v) noexcept { return edges_(v); }
  [[nodiscard]] const EdgePlaces<N, (1u << N) - 1>& edges() const noexcept { return edges_; }

 private:
  EdgePlaces<N, (1u << N) - 1> edges_;
};

/// In 4D also barycentres of cubes, computed on request with the arithmetic of the cube's own vertices.
template <>
class SharedPlaces<4> {
 public:
  SharedPlaces(const EdgeCrossings<4>& source, const std::array<std::size_t, 4>& base, unsigned signature,
               const tables::TileTable* cube) noexcept
      : edges_(source, base, signature), signature_(signature), cube_(cube) {}

  [[gnu::always_inline]] const TilePoint<4>& operator()(unsigned v) noexcept {
    if ((known_ >> v & 1u) == 0) find(v);
    return places_[v];
  }

  [[nodiscard]] const EdgePlaces<4, 15>& edges() const noexcept { return edges_; }
  /// Number of barycentres of a cube of the tile.
  [[nodiscard]] unsigned cube_vertices(unsigned cube) const noexcept {
    return SimplexList<3>(*cube_, cube_signature(cube)).own_vertices();
  }
  /// Barycentre `slot` of a cube, in the frame of the cube.
  [[nodiscard]] TilePoint<3> in_cube(unsigned cube, unsigned slot) noexcept {
    const TilePoint<4>& point = (*this)(kEdges + tables::kFaceSlots * cube + slot);
    TilePoint<3> inside;
    for (unsigned a = 0, j = 0; a < 4; ++a)
      if (a != cube / 2) inside[j++] = point[a];
    return inside;
  }

 private:
  static constexpr unsigned kEdges = tables::edge_count(4);
  static constexpr unsigned kShared = tables::first_tile_vertex(4);
  static_assert(kShared <= 64);

  /// By cube and edge of the cube: number of that edge in the tile.
  static constexpr auto kEdgesOfCubes = [] {
    std::array<std::array<std::uint8_t, tables::edge_count(3)>, 8> result{};
    for (unsigned cube = 0; cube < 8; ++cube)
      for (unsigned e = 0; e < tables::edge_count(3); ++e)
        result[cube][e] = static_cast<std::uint8_t>(lifted_edge(4, cube, e));
    return result;
  }();

  [[nodiscard]] unsigned cube_signature(unsigned cube) const noexcept { return face_signature(4, signature_, cube); }

  [[gnu::noinline]] void find(unsigned v) noexcept {
    if (v >= kEdges) return find_cube((v - kEdges) / tables::kFaceSlots);
    places_[v] = edges_(v);
    known_ |= std::uint64_t{1} << v;
  }

  void find_cube(unsigned cube) noexcept {
    const SimplexList<3> list(*cube_, cube_signature(cube));
    std::array<TilePoint<3>, tables::kFaceSlots> points{};
    own_places<3>(
        list, false,
        [&](unsigned v) {
          const unsigned edge = list.mapped(v);
          return edge_point<3>(edge, edges_.alpha(kEdgesOfCubes[cube][edge]));
        },
        points.data());
    for (unsigned slot = 0; slot < tables::kFaceSlots; ++slot) {
      const unsigned v = kEdges + tables::kFaceSlots * cube + slot;
      places_[v] = cube_point(cube, points[slot]);
      known_ |= std::uint64_t{1} << v;
    }
  }

  EdgePlaces<4, 15> edges_;
  unsigned signature_;
  const tables::TileTable* cube_;
  std::uint64_t known_ = 0;
  std::array<TilePoint<4>, kShared> places_;  ///< cache: many simplices request each position
};

/// Positions of the vertices that a 4D tile shares, for tiles combined from their cubes (ResolvedTesseract). Cubes use
/// the arithmetic of the cubes of 3D images.
class ResolvedPlaces {
 public:
  ResolvedPlaces(const EdgePlaces<4, 15>& edges, Triangulation triangulation,
                 const ResolvedCubes::Lists& lists) noexcept
      : edges_(edges),
        triangulation_(triangulation),
        cubes_(ResolvedCubes::instance(triangulation)),
        lists_(lists),
        rays_(edges.rays()) {}

  const TilePoint<4>& operator()(unsigned v) noexcept {
    if ((known_ >> v & 1u) == 0) find(v);
    return places_[v];
  }

  /// Whether an own vertex lies at the mean of vertices on edges (CellVertices::add_mean), and has no repetition.
  static bool is_mean(std::uint64_t mask) noexcept { return (mask & ~kEdgesOfMask) == 0; }
  static std::uint32_t edges_of(std::uint64_t mask) noexcept { return static_cast<std::uint32_t>(mask >> 16); }

  /// Whether own vertices with these masks, all combined and none a mean, are all on rays, each on a ray of its own.
  static bool are_on_rays(std::uint64_t masks) noexcept {
    constexpr std::uint64_t kOthers =
        ResolvedTesseract::kIsBarycentre | ResolvedTesseract::kIsDouble | ResolvedTesseract::kRepeats;
    return (masks & kOthers) == 0;
  }
  /// Positions of vertices on edges, by local edge.
  static auto on_edge(const EdgePlaces<4, 15>& edges) noexcept {
    return [&edges](unsigned edge) { return edge_point_at_once<4>(edge, edges.alpha(edge)); };
  }
  /// The end of the ray of an own vertex. `edges`: have the vertices on edges, if the mask has edges.
  static TilePoint<4> ray_end(std::uint64_t mask, const EdgePlaces<4, 15>& edges) noexcept {
    const std::uint64_t points = mask & ~ResolvedTesseract::kRepeats;
    if ((points & (points - 1)) == 0)  // one corner: the most frequent copies
      return kCornerPoints<4>[static_cast<unsigned>(std::countr_zero(points))];
    return mask_mean<4>(points, std::identity(), on_edge(edges), true);
  }

  /// Whether own vertices with these masks, all combined, depend on vertices on edges. Not if all are copies of
  /// corners.
  static bool needs_edges(std::uint64_t masks) noexcept { return masks >> 16 != 0; }
  /// Calls write(j, position) for all own vertices of a filling (ResolvedView::masks) except those that are means.
  template <class Write>
  void own_vertices(const ResolvedView& filling, const Write& write) noexcept {
    TesseractRays rays;
    find_rays(filling, rays);
    std::size_t ray = 0;
    for (unsigned j = 0; j < filling.own_vertices; ++j) {
      const std::uint64_t mask = filling.masks[j];
      if (is_mean(mask)) continue;
      TilePoint<4> place;
      if (is_on_ray(mask)) {
        for (unsigned a = 0; a < 4; ++a) place[a] = ray_coordinate(rays.ends[a][ray], rays.levels[ray]);
        ++ray;
        repeat(place, mask);
      } else {
        place = place_off_rays(filling, j);
      }
      write(j, place);
    }
  }

 private:
  static constexpr std::uint64_t kEdgesOfMask = std::uint64_t{0xffffffffu} << 16;

  static void repeat(TilePoint<4>& place, std::uint64_t mask) noexcept {
    for (std::uint64_t i = (mask & ResolvedTesseract::kRepeats) >> ResolvedTesseract::kRepeat; i != 0; --i)
      for (double& x : place) x = repeated_coordinate(x);
  }

  /// Whether an own vertex depends on corners.
  static bool is_on_ray(std::uint64_t mask) noexcept {
    return (mask & (ResolvedTesseract::kIsBarycentre | ResolvedTesseract::kIsDouble)) == 0 && (mask & 0xffffu) != 0;
  }
  /// The rays of a filling's own vertices, in their order, and their levels.
  void find_rays(const ResolvedView& filling, TesseractRays& rays) noexcept {
    for (unsigned j = 0; j < filling.own_vertices; ++j) {
      const std::uint64_t mask = filling.masks[j];
      if (is_on_ray(mask)) rays.add(ray_end(mask, edges_));
    }
    if (rays.count != 0) rays_.find_levels(rays);
  }

  [[nodiscard]] TilePoint<4> place_off_rays(const ResolvedView& filling, unsigned j) noexcept {
    const std::uint64_t mask = filling.masks[j];
    if ((mask & ResolvedTesseract::kIsBarycentre) != 0) return barycentre(filling, ResolvedTesseract::kFirstOwn + j);
    TilePoint<4> place;
    if ((mask & ResolvedTesseract::kIsDouble) != 0) {
      place = (*this)(static_cast<unsigned>(mask & 0xffu));
      for (double& x : place) x = 0.25 + 0.5 * x;
    } else {
      place = mask_place<4>(mask & ~ResolvedTesseract::kRepeats, std::identity(), on_edge(edges_), true, rays_);
    }
    repeat(place, mask);
    return place;
  }

  /// Position of own vertex `apex` of a filling: area-weighted mean of the triangles that it is joined with.
  [[nodiscard]] TilePoint<4> barycentre(const ResolvedView& filling, unsigned apex) noexcept {
    Weighted<4> sum, plain;  // `plain`: for a sphere shrunk to a point
    for (std::uint32_t q = 0; q < filling.simplex_count; ++q) {
      const std::uint8_t* const simplex = filling.simplices + 4 * std::size_t{q};
      if (simplex[0] != apex) continue;
      const std::array<TilePoint<4>, 3> face = {(*this)(simplex[1]), (*this)(simplex[2]), (*this)(simplex[3])};
      const Weighted<4> part = opposite_face<4>(face, is_barycentre(simplex[1]));
      sum.add(part.point, part.weight);
      plain.add(part.point, 1.0);
    }
    Weighted<4>& mean = sum.weight > 0 ? sum : plain;
    for (double& x : mean.point) x /= mean.weight;
    return mean.point;
  }

  [[nodiscard]] bool is_barycentre(unsigned v) const noexcept {
    if (v < ResolvedCubes::kEdges) return false;
    const unsigned cube = (v - ResolvedCubes::kEdges) / ResolvedCubes::kMostOwn;
    return (v - ResolvedCubes::kEdges) % ResolvedCubes::kMostOwn < cubes_.summary(lists_[cube]).barycentres;
  }

  [[gnu::noinline]] void find(unsigned v) noexcept {
    if (v >= ResolvedCubes::kEdges) return find_cube((v - ResolvedCubes::kEdges) / ResolvedCubes::kMostOwn);
    places_[v] = edges_(v);
    known_ |= std::uint64_t{1} << v;
  }

  void find_cube(unsigned cube) noexcept {
    const SimplexList<3> list(variant_table<3>(triangulation_).tile, cubes_.key(lists_[cube]));
    std::array<TilePoint<3>, ResolvedCubes::kMostOwn> points{};
    own_places<3>(
        list, false, [&](unsigned e) { return edge_point<3>(e, edges_.alpha(cubes_.lifted(cube, e))); }, points.data(),
        edges_.rays_in(cube));
    for (unsigned j = 0; j < ResolvedCubes::kMostOwn; ++j) {
      const unsigned v = ResolvedCubes::kEdges + ResolvedCubes::kMostOwn * cube + j;
      places_[v] = cube_point(cube, points[j]);
      known_ |= std::uint64_t{1} << v;
    }
  }

  const EdgePlaces<4, 15>& edges_;
  Triangulation triangulation_;
  const ResolvedCubes& cubes_;
  const ResolvedCubes::Lists& lists_;
  CellRays<4, 4> rays_;
  std::uint64_t known_ = 0;
  std::array<TilePoint<4>, ResolvedCubes::kVertices> places_;  ///< valid if known_ has the bit
};

}  // namespace tegl::detail
