// SPDX-License-Identifier: BSD-3-Clause
//
// Open faces by random sums.
//
// Give each vertex a random point of a space with the contour's dimension, over the prime field of 2^61 - 1 elements.
// The signed volumes of the simplices add up to the volume of the cone over the faces that do not cancel. The
// derivative of the sum by the last coordinate of a vertex is a polynomial in the other coordinates, with a term for
// each uncancelled face around the vertex. It does not depend on the last coordinates, so points have all but these.
// If there is none, it is 0. If there is one, it is 0 with a probability of at most its degree N - 2 over 2^61 - 1. So
// one number per vertex, to which each simplex adds, finds the vertices of open faces. Only faces between such vertices
// are listed and counted.
//
// Based on: J. T. Schwartz, "Fast probabilistic algorithms for verification of polynomial identities", 1980.
#include "mesh/open_ridges.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>
#include <mutex>
#include <tuple>
#include <utility>
#include <vector>

#include "base/radix_sort.hpp"
#include "base/workers.hpp"
#include "mesh/measure_pieces.hpp"
#include "mesh/vertex_stars.hpp"
#include "tegl/field.hpp"

namespace tegl::detail {

namespace {

constexpr std::uint64_t kPrime = (std::uint64_t{1} << 61) - 1;

__extension__ using Wide = __int128;
__extension__ using UnsignedWide = unsigned __int128;

/// An equal number modulo the prime, at most kPrime + 7.
constexpr std::uint64_t folded(std::uint64_t x) noexcept { return (x & kPrime) + (x >> 61); }
/// The same for |x| < 2^125.
constexpr std::uint64_t folded(Wide x) noexcept {
  const auto positive = static_cast<UnsignedWide>(x + (Wide{kPrime} << 65));
  const auto low = static_cast<std::uint64_t>(positive) & kPrime;
  const auto middle = static_cast<std::uint64_t>(positive >> 61) & kPrime;
  return folded(low + middle + static_cast<std::uint64_t>(positive >> 122));
}

/// Components of a vector, from -kPrime to kPrime.
template <std::size_t Size>
using FieldVector = std::array<std::int64_t, Size>;

/// The determinant of some rows of a matrix, as an equal number modulo the prime, at most 2 kPrime.
template <std::size_t Size, class... Row>
constexpr std::uint64_t determinant(const FieldVector<Size>& first, const Row&... rows) noexcept {
  if constexpr (sizeof...(rows) == 0) {
    return static_cast<std::uint64_t>(first[0] + static_cast<std::int64_t>(kPrime));
  } else if constexpr (sizeof...(rows) == 1) {
    const FieldVector<Size>& second = std::get<0>(std::tie(rows...));
    return folded(Wide{first[0]} * second[1] - Wide{first[1]} * second[0]);
  } else {
    // by the last column
    const auto& [second, third] = std::tie(rows...);
    const auto minor = [](const FieldVector<Size>& a, const FieldVector<Size>& b) {
      return static_cast<std::int64_t>(determinant(a, b));
    };
    return folded(Wide{first[2]} * minor(second, third) - Wide{second[2]} * minor(first, third) +
                  Wide{third[2]} * minor(first, second));
  }
}

/// Random points, `Size` coordinates per vertex.
template <std::size_t Size>
Buffer<FieldVector<Size>> random_points(std::size_t vertices, unsigned threads, const Progress& progress) {
  Buffer<FieldVector<Size>> points(vertices);
  for_each_item(vertices, threads, progress, [&](std::size_t v) {
    for (std::size_t a = 0; a < Size; ++a) points[v][a] = static_cast<std::int64_t>(mixed_bits(v * Size + a) & kPrime);
  });
  return points;
}

/// What a simplex adds at each of its vertices: the derivatives of its volume.
template <int N>
std::array<std::uint64_t, N> derivatives(const std::array<Index, N>& simplex,
                                         const FieldVector<N - 2>* points) noexcept {
  std::array<FieldVector<N - 2>, N - 1> edges;
  for (int j = 0; j < N - 1; ++j)
    for (int a = 0; a < N - 2; ++a) edges[j][a] = points[simplex[j + 1]][a] - points[simplex[0]][a];
  std::array<std::uint64_t, N> result{};
  const auto set = [&](int j, std::uint64_t minor) { result[j] = j % 2 == 0 ? minor : 2 * kPrime - minor; };
  if constexpr (N == 2) set(1, 1);
  if constexpr (N == 3) {
    set(1, determinant(edges[1]));
    set(2, determinant(edges[0]));
  }
  if constexpr (N == 4) {
    set(1, determinant(edges[1], edges[2]));
    set(2, determinant(edges[0], edges[2]));
    set(3, determinant(edges[0], edges[1]));
  }
  if constexpr (N == 5) {
    set(1, determinant(edges[1], edges[2], edges[3]));
    set(2, determinant(edges[0], edges[2], edges[3]));
    set(3, determinant(edges[0], edges[1], edges[3]));
    set(4, determinant(edges[0], edges[1], edges[2]));
  }
  // the volume does not change if all points are moved
  std::uint64_t opposite = 0;
  for (int j = 1; j < N; ++j) opposite += 2 * kPrime - result[j];  // at most 8 kPrime < 2^64
  result[0] = folded(opposite);
  return result;
}

/// Sums by vertex, an array for each thread.
class SumsByVertex {
 public:
  explicit SumsByVertex(std::size_t vertices) : vertices_(vertices) {}

  /// A new array for the calling thread.
  std::uint64_t* make() {
    auto sums = std::make_unique<Buffer<std::uint64_t>>(vertices_);
    std::fill(sums->begin(), sums->end(), std::uint64_t{0});
    const std::scoped_lock lock(mutex_);
    return arrays_.emplace_back(std::move(sums))->data();
  }
  /// Whether the sum at the vertex is not 0.
  [[nodiscard]] bool is_open(std::size_t v) const noexcept {
    std::uint64_t sum = 0;
    for (const auto& array : arrays_) sum = folded(sum + (*array)[v]);
    return sum % kPrime != 0;
  }

 private:
  std::size_t vertices_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Buffer<std::uint64_t>>> arrays_;
};

constexpr std::size_t kSimplices = std::size_t{1} << 14;  ///< per block

/// Marks the vertices of open faces.
template <int N>
Buffer<std::uint8_t> mark_open(std::span<const std::array<Index, N>> simplices, std::size_t vertex_count,
                               unsigned threads, const Progress& progress) {
  const auto points = random_points<N - 2>(vertex_count, threads, part_of(progress, 0.0, 0.1));
  constexpr std::size_t kMostThreads = 8;  // of which each has an array
  const auto of_sums = static_cast<unsigned>(std::min(kMostThreads, Workers<int>(threads, [] { return 0; }).count()));
  SumsByVertex sums(vertex_count);
  for_each_block(
      simplices.size(), kSimplices, of_sums, part_of(progress, 0.1, 0.9), [&] { return sums.make(); },
      [&](std::size_t, std::size_t from, std::size_t to, std::uint64_t* own) {
        for (std::size_t s = from; s < to; ++s) {
          const std::array<std::uint64_t, N> added = derivatives<N>(simplices[s], points.data());
          for (int j = 0; j < N; ++j) own[simplices[s][j]] = folded(own[simplices[s][j]] + added[j]);
        }
      });
  Buffer<std::uint8_t> open(vertex_count);
  for_each_item(vertex_count, threads, part_of(progress, 0.9, 1.0),
                [&](std::size_t v) { open[v] = sums.is_open(v) ? 1 : 0; });
  return open;
}

/// The faces of simplices of which all vertices are marked, by block of simplices.
template <int N>
std::vector<RidgeSide<N - 1>> marked_sides(std::span<const std::array<Index, N>> simplices,
                                           const Buffer<std::uint8_t>& marked, unsigned threads,
                                           const Progress& progress) {
  std::vector<std::vector<RidgeSide<N - 1>>> parts(block_count(simplices.size(), kSimplices));
  for_each_block(simplices.size(), kSimplices, threads, progress,
                 [&](std::size_t block, std::size_t from, std::size_t to) {
                   for (std::size_t s = from; s < to; ++s) {
                     std::array<Index, N> sorted = simplices[s];
                     int count = 0;
                     for (const Index v : sorted) count += marked[v];
                     if (count < N - 1 || is_collapsed<N>(sorted.data())) continue;
                     const int orientation = sort_signed(sorted);
                     for (int omitted = 0; omitted < N; ++omitted)
                       if (count - marked[sorted[omitted]] == N - 1)
                         parts[block].push_back(side_without<N>(sorted, omitted, orientation));
                   }
                 });
  std::vector<RidgeSide<N - 1>> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// As find_open_ridges, without random numbers. Takes less time if nearly all faces are open.
template <int N>
FaceCounts find_by_stars(std::span<const Index> rows, std::size_t vertex_count, unsigned threads,
                         const Progress& progress, FunctionRef<void(const std::array<Index, N - 1>& ridge)> on_open) {
  const Stars stars = make_stars<N>(rows, vertex_count, threads, part_of(progress, 0.0, 0.2));
  std::vector<std::vector<std::array<Index, N - 1>>> found(block_count(vertex_count, kBlock));
  const FaceCounts counts = count_faces<N>(rows, stars, {}, 1, false, threads, part_of(progress, 0.2, 1.0),
                                           [&](std::size_t block, const auto& ridge) { found[block].push_back(ridge); })
                                .front();
  for (auto& block : found) {  // by the smallest vertex
    std::sort(block.begin(), block.end());
    for (const auto& ridge : block) on_open(ridge);
  }
  return counts;
}

/// As count_sides, with progress: sides are sorted by the smallest vertex, then some vertices' at a time.
template <std::size_t Size, class OnOpen>
FaceCounts count_by_vertex(std::vector<RidgeSide<Size>> sides, std::size_t vertex_count, unsigned threads,
                           const Progress& progress, const OnOpen& on_open) {
  constexpr std::size_t kSome = 4096;
  const auto vertex_of = [](const RidgeSide<Size>& side) { return side.vertices[0]; };
  sort_by_bits(sides, static_cast<unsigned>(std::bit_width(vertex_count)), vertex_of, threads);
  FaceCounts counts;
  std::vector<RidgeSide<Size>> some;
  for (std::size_t from = 0, end = 0; from < sides.size(); from = end) {
    tell(progress, static_cast<double>(from) / static_cast<double>(sides.size()));
    end = std::min(sides.size(), from + kSome);
    while (end < sides.size() && vertex_of(sides[end]) == vertex_of(sides[end - 1])) ++end;
    some.assign(sides.data() + from, sides.data() + end);
    count_sides(some, counts, on_open);
  }
  tell(progress, 1.0);
  return counts;
}

}  // namespace

template <int N>
FaceCounts find_open_ridges(std::span<const Index> rows, std::size_t vertex_count, unsigned threads,
                            const Progress& progress,
                            FunctionRef<void(const std::array<Index, N - 1>& ridge)> on_open) {
  const std::span simplices(reinterpret_cast<const std::array<Index, N>*>(rows.data()), rows.size() / N);
  const Buffer<std::uint8_t> open = mark_open<N>(simplices, vertex_count, threads, part_of(progress, 0.0, 0.6));
  const auto marked = static_cast<std::size_t>(std::count(open.begin(), open.end(), std::uint8_t{1}));
  if (marked == 0) {
    tell(progress, 1.0);
    return {};
  }
  if (marked > vertex_count / 2)
    return find_by_stars<N>(rows, vertex_count, threads, part_of(progress, 0.6, 1.0), on_open);
  auto sides = marked_sides<N>(simplices, open, threads, part_of(progress, 0.6, 0.8));
  return count_by_vertex(std::move(sides), vertex_count, threads, part_of(progress, 0.8, 1.0), on_open);
}

#define TEGL_OPEN_RIDGES(N)                                                                               \
  template FaceCounts find_open_ridges<N>(std::span<const Index>, std::size_t, unsigned, const Progress&, \
                                          FunctionRef<void(const std::array<Index, N - 1>&)>);
TEGL_OPEN_RIDGES(2)
TEGL_OPEN_RIDGES(3)
TEGL_OPEN_RIDGES(4)
TEGL_OPEN_RIDGES(5)
#undef TEGL_OPEN_RIDGES

}  // namespace tegl::detail
