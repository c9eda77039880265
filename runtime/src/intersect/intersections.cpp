// SPDX-License-Identifier: BSD-3-Clause
//
// The stages of find_intersections: planes, stars, boxes, pairs, tiles. See tegl/intersections.hpp.
#include "tegl/intersections.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "base/periods.hpp"
#include "base/workers.hpp"
#include "intersect/box_blocks.hpp"
#include "intersect/found_pairs.hpp"
#include "intersect/pair_depth.hpp"
#include "intersect/pair_test.hpp"
#include "intersect/star_test.hpp"
#include "mesh/validate.hpp"
#include "mesh/vertex_stars.hpp"

namespace tegl {

namespace detail {
namespace {

constexpr std::size_t kStarBlock = 4096;
constexpr std::size_t kPairBlock = 64;  ///< blocks of eight simplices

/// By vertex: 1 if no two simplices around it intersect.
template <int N>
std::vector<std::uint8_t> embedded_stars(const SimplexPlanes<N>& simplices, std::span<const Index> rows,
                                         unsigned threads, const Progress& progress) {
  std::vector<std::uint8_t> result(simplices.point_count());
  if constexpr (N > 2) {
    const Stars stars = make_stars<N>(rows, simplices.point_count(), threads, part_of(progress, 0.0, 0.4));
    for_each_block(
        result.size(), kStarBlock, threads, part_of(progress, 0.4, 1.0), [&] { return StarTest<N>(simplices); },
        [&](std::size_t, std::size_t from, std::size_t to, StarTest<N>& test) {
          for (std::size_t v = from; v < to; ++v)
            result[v] = test.is_embedded(static_cast<Index>(v), stars.of(v)) ? 1 : 0;
        });
  }
  return result;
}

/// Finds the pairs of simplices in some blocks. One object per thread.
template <int N>
class PairFinder {
 public:
  PairFinder(const SimplexPlanes<N>& simplices, std::span<const std::uint8_t> embedded, const BoxBlocks<N>& boxes,
             const FoundPairs<N>& none, SimplexSet& intersecting)
      : simplices_(simplices),
        embedded_(embedded),
        boxes_(boxes),
        test_(simplices),
        found_(none),
        intersecting_(intersecting) {}

  /// Adds the pairs of the simplices in a block with those in it and in later ones.
  void find(std::size_t block) {
    boxes_.find_near(block, near_);
    const std::span<const Index> here = boxes_.simplices(block);
    for (std::size_t k = 0; k < here.size(); ++k) {
      load_embedded_vertices(here[k]);
      test_.load(here[k]);
      boxes_.visit_meeting(block, k, near_, [&](Index t) { test(here[k], t); });
    }
  }
  /// The pairs since it was last cleared.
  [[nodiscard]] FoundPairs<N>& found() noexcept { return found_; }

 private:
  static constexpr Index kNone = std::numeric_limits<Index>::max();

  void load_embedded_vertices(Index s) noexcept {
    for (int i = 0; i < N; ++i) {
      const Index v = simplices_.simplex(s)[i];
      embedded_vertices_[i] = embedded_[v] != 0 ? v : kNone;
    }
  }
  [[nodiscard]] bool share_embedded_vertex(Index t) const noexcept {
    unsigned shared = 0;
    for (const Index v : embedded_vertices_)
      for (const Index w : simplices_.simplex(t)) shared |= v == w ? 1u : 0u;
    return shared != 0;
  }
  void test(Index s, Index t) {
    if (share_embedded_vertex(t)) return;
    IntersectingPair<N> pair;
    pair.first = std::min(s, t);
    pair.second = std::max(s, t);
    if (!test_.meets(t, pair.place)) return;
    pair.depth = depth_of<N>(simplices_.corners(pair.first), simplices_.corners(pair.second));
    found_.add(pair);
    intersecting_.add(s);
    intersecting_.add(t);
  }

  const SimplexPlanes<N>& simplices_;
  std::span<const std::uint8_t> embedded_;
  const BoxBlocks<N>& boxes_;
  PairTest<N> test_;
  std::array<Index, N> embedded_vertices_{};
  typename BoxBlocks<N>::NearBlocks near_;
  FoundPairs<N> found_;
  SimplexSet& intersecting_;
};

/// Adds all pairs to `found`, which is empty, and their simplices to `intersecting`.
template <int N>
void find_pairs(const SimplexPlanes<N>& simplices, std::span<const std::uint8_t> embedded, unsigned threads,
                const Progress& progress, FoundPairs<N>& found, SimplexSet& intersecting) {
  const BoxBlocks<N> boxes(simplices, threads, part_of(progress, 0.0, 0.15));
  const FoundPairs<N> none = found;
  std::mutex mutex;
  for_each_block(
      boxes.size(), kPairBlock, threads, part_of(progress, 0.15, 1.0),
      [&] { return PairFinder<N>(simplices, embedded, boxes, none, intersecting); },
      [&](std::size_t, std::size_t from, std::size_t to, PairFinder<N>& finder) {
        for (std::size_t block = from; block < to; ++block) finder.find(block);
        const std::lock_guard lock(mutex);
        found.take(finder.found());
      });
}

/// The tile that contains the centroid of a simplex, by the number of tiles along each axis from the origin.
template <int N>
std::array<double, N> tile_of(const SimplexPlanes<N>& simplices, Index s, const IntersectionTiles<N>& tiles) noexcept {
  PointN<N> tile{};
  for (const PointN<N>& corner : simplices.corners(s))
    for (int a = 0; a < N; ++a) tile[a] += corner[a] / N;
  for (int a = 0; a < N; ++a) tile[a] = std::floor((tile[a] - tiles.origin[a]) / tiles.size[a]);
  return tile;
}

template <class Item>
std::uint64_t count_different(std::vector<Item>& items) {
  std::sort(items.begin(), items.end());
  return static_cast<std::uint64_t>(std::unique(items.begin(), items.end()) - items.begin());
}

template <int N>
void count_tiles(const SimplexPlanes<N>& simplices, const SimplexSet& intersecting, const IntersectionTiles<N>& tiles,
                 Intersections<N>& result) {
  std::vector<std::array<double, N>> found(simplices.size());
  for (std::size_t s = 0; s < found.size(); ++s) found[s] = tile_of(simplices, static_cast<Index>(s), tiles);
  result.tiles = count_different(found);
  found.clear();
  for (std::size_t s = 0; s < simplices.size(); ++s)
    if (intersecting.contains(static_cast<Index>(s))) found.push_back(tile_of(simplices, static_cast<Index>(s), tiles));
  result.tiles_hit = count_different(found);
}

template <int N>
void require_tiles(const IntersectionTiles<N>& tiles) {
  for (int a = 0; a < N; ++a) {
    if (!(tiles.size[a] > 0.0 && std::isfinite(tiles.size[a])))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("the size of tiles along axis {} is {}; expected a positive number", a, tiles.size[a]));
    if (!std::isfinite(tiles.origin[a]))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("the origin of tiles on axis {} is {}; expected a finite number", a, tiles.origin[a]));
  }
}

template <int N>
Intersections<N> intersections_of(std::span<const PointN<N>> points, std::span<const std::array<Index, N>> rows,
                                  const IntersectionOptions<N>& options) {
  const unsigned threads = options.work.threads;
  const Progress& progress = options.work.progress;
  Intersections<N> result;
  result.simplices = rows.size();
  const SimplexPlanes<N> simplices(points, rows, threads, part_of(progress, 0.0, 0.1));
  for (std::size_t s = 0; s < simplices.size(); ++s) result.flat += simplices.is_flat(static_cast<Index>(s)) ? 1 : 0;
  const std::vector<std::uint8_t> embedded =
      embedded_stars<N>(simplices, flat_rows(rows), threads, part_of(progress, 0.1, 0.3));
  FoundPairs<N> found(options.most_listed, options.deepest_first);
  SimplexSet intersecting(rows.size());
  find_pairs<N>(simplices, embedded, threads, part_of(progress, 0.3, 1.0), found, intersecting);
  result.pair_count = found.count();
  result.depth = found.depth();
  result.intersecting = intersecting.size();
  if (options.tiles) count_tiles<N>(simplices, intersecting, *options.tiles, result);
  result.pairs = found.first_pairs();
  return result;
}

}  // namespace
}  // namespace detail

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4> Intersections<N> find_intersections(const Contour<N, Real>& contour,
                                                                       const IntersectionOptions<N>& options) {
  detail::require_unwrapped(contour, "find_intersections");
  detail::require_vertices(contour);
  detail::require_finite(contour);
  if (options.tiles) detail::require_tiles(*options.tiles);
  if constexpr (std::is_same_v<Real, double>) {
    return detail::intersections_of<N>(contour.vertices, contour.simplices, options);
  } else {
    std::vector<detail::PointN<N>> points(contour.vertices.size());
    for (std::size_t v = 0; v < points.size(); ++v)
      for (int a = 0; a < N; ++a) points[v][a] = static_cast<double>(contour.vertices[v][a]);
    return detail::intersections_of<N>(points, contour.simplices, options);
  }
}

#define TEGL_INSTANTIATE_CONTOURS(N, Real) \
  template Intersections<N> find_intersections<N, Real>(const Contour<N, Real>&, const IntersectionOptions<N>&);
#include "base/instantiate.hpp"

}  // namespace tegl
