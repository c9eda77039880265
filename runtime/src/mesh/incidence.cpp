// SPDX-License-Identifier: BSD-3-Clause
//
// Incidence of simplices, found at the smallest vertex of each face, whose star contains all simplices around the face.
#include "tegl/incidence.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/workers.hpp"
#include "mesh/closed_stars.hpp"
#include "mesh/faces_of_stars.hpp"
#include "mesh/incidence_data.hpp"
#include "mesh/validate.hpp"
#include "tegl/error.hpp"

namespace tegl {
namespace detail {
namespace {

/// The faces of one star at a time, for any star. Use one per thread.
template <int N>
class AnyStar {
 public:
  AnyStar(std::span<const Index> rows, std::size_t vertex_count)
      : rows_(rows), counter_(rows.data(), vertex_count, true) {}

  /// Pairs the simplices with a common (N-2)-face whose smallest vertex is v. Returns counts of the others.
  IrregularFaces pair(Index v, std::span<const Index> star, IncidenceData<N>& data) {
    sides_.clear();
    for (const Index s : star) add_sides(v, s);
    std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) { return a.rest < b.rest; });
    IrregularFaces found;
    found.vertex = v;
    for (std::size_t i = 0, j = 0; i < sides_.size(); i = j) {
      int balance = 0;
      while (j < sides_.size() && sides_[j].rest == sides_[i].rest) balance += sides_[j++].orientation;
      if (balance != 0) ++found.open;
      if (j - i == 1) ++found.boundary;
      if (j - i == 2 && balance != 0) ++found.conflicts;
      if (j - i > 2) ++found.several;
      for (std::size_t k = i; k < j; ++k) {
        const Index other = j - i == 1 ? kNoSimplex : j - i > 2 ? kSeveralSimplices : sides_[i + j - 1 - k].simplex;
        data.across[sides_[k].simplex][sides_[k].omitted] = other;
      }
    }
    return found;
  }
  [[nodiscard]] std::int64_t euler_above(Index v, std::span<const Index> star) {
    return counter_.visit(v, star, [](const auto&) { /* counted */ }).euler;
  }
  /// The other ends of the edges with v as their smaller end.
  std::span<const Index> edges_above(Index v, std::span<const Index> star) {
    edges_.clear();
    for (const Index s : star)
      for (std::size_t i = 0; i < N; ++i)
        if (const Index u = rows_[std::size_t{s} * N + i]; u > v) edges_.push_back(u);
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    return edges_;
  }

 private:
  struct Side {
    std::array<Index, N - 2> rest;  ///< the vertices of the face except v, ascending
    Index simplex;
    int omitted;      ///< place of the simplex's vertex that is not in the face
    int orientation;  ///< 1 if the simplex induces the ascending order of the face's vertices, else -1
  };

  void add_sides(Index v, Index s) {
    const Index* const row = rows_.data() + std::size_t{s} * N;
    for (int omitted = 0; omitted < N; ++omitted) {
      std::array<Index, N - 1> face;
      for (int i = 0, k = 0; i < N; ++i)
        if (i != omitted) face[k++] = row[i];
      int orientation = omitted % 2 == 0 ? 1 : -1;
      for (int i = 1; i + 1 < N; ++i)  // insertion sort, to count the exchanges
        for (int j = i; j > 0 && face[j] < face[j - 1]; --j) {
          std::swap(face[j], face[j - 1]);
          orientation = -orientation;
        }
      if (face[0] != v) continue;
      Side& side = sides_.emplace_back(Side{{}, s, omitted, orientation});
      std::copy(face.begin() + 1, face.end(), side.rest.begin());
    }
  }

  std::span<const Index> rows_;
  FacesOfStars<N> counter_;
  std::vector<Side> sides_;
  std::vector<Index> edges_;
};

/// Adds edges from v, which is in the block of vertices up to `end` - 1, to greater vertices.
template <int N>
void add_edges(IncidenceData<N>& data, Index v, std::size_t end, std::span<const Index> others) {
  data.near_edges[v] += static_cast<std::uint32_t>(others.size());
  for (const Index u : others) {
    if (u < end)
      ++data.near_edges[u];
    else
      std::atomic_ref(data.far_edges[u]).fetch_add(1, std::memory_order_relaxed);
  }
}

}  // namespace

std::uint64_t digest_of(std::span<const Index> numbers) noexcept {
  // four sums at a time, as each waits for its multiplication
  constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15u;
  std::array<std::uint64_t, 4> sums{1, 2, 3, 4};
  const auto mix = [](std::uint64_t sum, Index number) {
    sum = (sum ^ number) * kFactor;
    return sum ^ sum >> 29;
  };
  std::size_t i = 0;
  for (; i + 4 <= numbers.size(); i += 4)
    for (std::size_t k = 0; k < 4; ++k) sums[k] = mix(sums[k], numbers[i + k]);
  for (; i < numbers.size(); ++i) sums[0] = mix(sums[0], numbers[i]);
  std::uint64_t digest = numbers.size();
  for (const std::uint64_t sum : sums) digest = (digest ^ sum) * kFactor + (sum >> 32);
  return digest;
}

template <int N>
IncidenceData<N> make_incidence(std::span<const Index> rows, std::size_t vertex_count, bool with_counts,
                                unsigned threads, const Progress& progress) {
  const std::size_t count = rows.size() / N;
  if (count >= kSeveralSimplices)
    throw Error(ErrorCode::TooLarge,
                fmt::format("{} simplices; expected less than {}", count, std::size_t{kSeveralSimplices}));
  IncidenceData<N> data;
  data.stars = make_stars<N>(rows, vertex_count, threads, part_of(progress, 0.0, 0.2));
  data.across.resize(count);
  if (with_counts) data.euler_above.resize(vertex_count);
  const bool with_edges = N == 4 && with_counts;
  for (auto* const edges : {&data.near_edges, &data.far_edges}) {
    if (with_edges) edges->resize(vertex_count);
    std::fill(edges->begin(), edges->end(), 0u);
  }
  // simplices that repeat a vertex get no other entries
  std::array<Index, N> nothing;
  nothing.fill(kNoSimplex);
  for_each_item(count, threads, part_of(progress, 0.2, 0.3), [&](std::size_t s) {
    if (is_collapsed<N>(rows.data() + s * N)) data.across[s] = nothing;
  });
  std::vector<std::vector<IrregularFaces>> irregular(block_count(vertex_count, kBlock));
  struct Scratch {
    AnyStar<N> any;
    ClosedStars found;
    std::vector<ClosedStar> closed;
  };
  for_each_block(
      vertex_count, kBlock, threads, part_of(progress, 0.3, 1.0),
      [&] {
        return Scratch{AnyStar<N>(rows, vertex_count), {count == 0 ? nullptr : data.across.data()->data(), {}, 0}, {}};
      },
      [&](std::size_t block, std::size_t from, std::size_t to, Scratch& scratch) {
        auto& [any, found, closed] = scratch;
        closed.assign(to - from, {});
        found.edge_count = 0;
        if constexpr (N == 4) count_closed_stars(rows.data(), data.stars, from, with_edges, closed, &found);
        std::size_t edge = 0;  // in `found`
        for (std::size_t i = from; i < to; ++i) {
          const auto v = static_cast<Index>(i);
          const std::span<const Index> star = data.stars.of(v);
          const ClosedStar& here = closed[i - from];
          const bool is_settled = N == 4 && here.is_settled && !star.empty();
          if (with_counts)
            data.euler_above[v] = star.empty() ? 0
                                  : is_settled ? here.euler_above()
                                               : static_cast<std::int32_t>(any.euler_above(v, star));
          if (with_edges && !star.empty()) {
            add_edges(
                data, v, to,
                is_settled ? std::span<const Index>(found.edges).subspan(edge, here.edges) : any.edges_above(v, star));
            edge += here.edges;
          }
          IrregularFaces faces{v, here.boundary, 0, 0, here.boundary};
          if (!is_settled) faces = any.pair(v, star, data);
          if (with_counts && faces.boundary + faces.several + faces.conflicts + faces.open > 0)
            irregular[block].push_back(faces);
        }
      });
  for (const auto& part : irregular) data.irregular.insert(data.irregular.end(), part.begin(), part.end());
  return data;
}

template <int N>
void require_incidence(const IncidenceData<N>& incidence, std::span<const Index> rows, std::size_t vertex_count) {
  const std::size_t simplices = rows.size() / N;
  if (incidence.vertex_count() != vertex_count || incidence.across.size() != simplices)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("an incidence of {} simplices and {} vertices; expected that of this contour, which has {} "
                            "and {}",
                            incidence.across.size(), incidence.vertex_count(), simplices, vertex_count));
  if (const std::uint64_t digest = digest_of(rows); incidence.digest != digest)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("an incidence of other simplices, with the digest {:016x}; expected that of this contour, "
                            "which has {:016x}",
                            incidence.digest, digest));
}

#define TEGL_INCIDENCE(N)                                                                                            \
  template IncidenceData<N> make_incidence<N>(std::span<const Index>, std::size_t, bool, unsigned, const Progress&); \
  template void require_incidence<N>(const IncidenceData<N>&, std::span<const Index>, std::size_t);
TEGL_INCIDENCE(2)
TEGL_INCIDENCE(3)
TEGL_INCIDENCE(4)
TEGL_INCIDENCE(5)
#undef TEGL_INCIDENCE

}  // namespace detail

template <int N>
requires DimensionBetween<N, 2, 5>
template <Coordinate Real>
Incidence<N>::Incidence(const Contour<N, Real>& contour, const WorkOptions& work) {
  detail::require_vertices(contour);
  const auto rows = detail::flat_rows(std::span<const std::array<Index, N>>(contour.simplices));
  auto data = std::make_shared<detail::IncidenceData<N>>(
      detail::make_incidence<N>(rows, contour.vertices.size(), true, work.threads, work.progress));
  data->digest = detail::digest_of(rows);
  data_ = std::move(data);
}

template <int N>
requires DimensionBetween<N, 2, 5> std::size_t Incidence<N>::vertex_count()
const noexcept { return data_->vertex_count(); }

template <int N>
requires DimensionBetween<N, 2, 5> std::size_t Incidence<N>::simplex_count()
const noexcept { return data_->across.size(); }

template <int N>
requires DimensionBetween<N, 2, 5> std::span<const Index> Incidence<N>::around(Index vertex)
const noexcept { return data_->stars.of(vertex); }

template <int N>
requires DimensionBetween<N, 2, 5>
const std::array<Index, N>& Incidence<N>::across(Index simplex) const noexcept { return data_->across[simplex]; }

template <int N>
requires DimensionBetween<N, 2, 5>
template <Coordinate Real>
bool Incidence<N>::fits(const Contour<N, Real>& contour) const noexcept {
  return contour.vertices.size() == vertex_count() && contour.simplices.size() == simplex_count() &&
         detail::digest_of(detail::flat_rows(std::span<const std::array<Index, N>>(contour.simplices))) ==
             data_->digest;
}

template class Incidence<2>;
template class Incidence<3>;
template class Incidence<4>;
template class Incidence<5>;

#define TEGL_INSTANTIATE_CONTOURS_TO_5(N, Real)                                  \
  template Incidence<N>::Incidence(const Contour<N, Real>&, const WorkOptions&); \
  template bool Incidence<N>::fits(const Contour<N, Real>&) const noexcept;
#include "base/instantiate.hpp"

}  // namespace tegl
