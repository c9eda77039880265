// SPDX-License-Identifier: BSD-3-Clause
//
// Stars in arrays of several, the link condition, and edge contraction.
#include "simplify/collapsible_complex.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

#include <fmt/format.h>

#include "hwy/cache_control.h"

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {
namespace {

constexpr std::size_t kBorderBlock = 4096;
constexpr std::size_t kStarBlock = std::size_t{1} << 16;  ///< entries of larger stars that a thread takes at a time

template <std::size_t N>
int position(const std::array<Index, N>& simplex, Index v) {
  return static_cast<int>(std::find(simplex.begin(), simplex.end(), v) - simplex.begin());
}

template <std::size_t N>
bool contains(const std::array<Index, N>& simplex, Index v) {
  return std::find(simplex.begin(), simplex.end(), v) != simplex.end();
}

}  // namespace

template <int N>
CollapsibleComplex<N>::CollapsibleComplex(std::span<const Simplex> simplices, std::size_t vertex_count,
                                          unsigned threads, const Progress& progress,
                                          std::shared_ptr<const FacetNeighbours<N>> known)
    : simplices_(simplices.begin(), simplices.end()),
      border_faces_(simplices.size(), 0),
      border_vertex_(vertex_count, 0),
      star_of_(vertex_count, Star{}),
      alive_(simplices.size()),
      neighbours_(std::move(known)) {
  if (simplices.size() > kNone / N)
    throw Error(ErrorCode::TooLarge,
                fmt::format("{} simplices to simplify; expected at most {}", simplices.size(), kNone / N));
  fill_stars(vertex_count, part_of(progress, 0.0, 0.3));
  find_border(threads, part_of(progress, 0.3, 1.0));
}

template <int N>
void CollapsibleComplex<N>::fill_stars(std::size_t vertex_count, const Progress& progress) {
  in_parts(simplices_.size(), progress, [&](std::size_t from, std::size_t to) {
    for (std::size_t s = from; s < to; ++s)
      for (int i = 0; i < N; ++i) {
        const Index v = simplices_[s][i];
        if (v >= vertex_count)
          throw Error(ErrorCode::InvalidArgument,
                      fmt::format("simplex {} has the vertex {}; expected one of {}", s, v, vertex_count));
        if (std::count(simplices_[s].begin(), simplices_[s].end(), v) != 1)
          throw Error(ErrorCode::UnsupportedData,
                      fmt::format("simplex {} has the vertex {} twice; expected different vertices", s, v));
        ++star_of_[v].capacity;
      }
  });
  stars_.resize(N * simplices_.size());
  Index* first = stars_.data();
  for (Star& star : star_of_) {
    star.first = first;
    first += star.capacity;
  }
  for (Index s = 0; s < simplices_.size(); ++s)
    for (const Index v : simplices_[s]) star_of_[v].first[star_of_[v].size++] = s;
}

/// The number of simplices with the face of s opposite to a corner.
template <int N>
std::size_t CollapsibleComplex<N>::count_at_face(Index s, int corner) const {
  const Simplex& simplex = simplices_[s];
  int smallest = corner == 0 ? 1 : 0;  // the corner with the smallest star: some vertices have very large ones
  for (int i = 0; i < N; ++i)
    if (i != corner && star_of_[simplex[i]].size < star_of_[simplex[smallest]].size) smallest = i;
  std::size_t count = 0;
  visit_star(simplex[smallest], [&](Index other) {
    int shared = 0;
    for (int i = 0; i < N; ++i) shared += i != corner && contains(simplices_[other], simplex[i]);
    count += shared == N - 1;
  });
  return count;
}

/// Several threads may mark faces with a vertex in common, but not faces of one simplex.
template <int N>
void CollapsibleComplex<N>::mark_border(Index s, int corner) {
  border_faces_[s] |= static_cast<std::uint8_t>(1u << corner);
  for (int i = 0; i < N; ++i)
    if (i != corner) std::atomic_ref(border_vertex_[simplices_[s][i]]).store(1, std::memory_order_relaxed);
}

/// Counts the simplices only at faces without a neighbour: those on the border, in more than two simplices, or between
/// simplices of opposite orientations.
template <int N>
void CollapsibleComplex<N>::find_border(unsigned threads, const Progress& progress) {
  if (!neighbours_)
    neighbours_ = std::make_shared<const FacetNeighbours<N>>(
        std::span<const Simplex>(simplices_), star_of_.size(),
        [&](std::size_t v) { return clean_star(static_cast<Index>(v)); }, threads, part_of(progress, 0.0, 0.9));
  const auto lowest_of = [&](Index s, int corner) {
    Index lowest = kNone;
    for (int i = 0; i < N; ++i)
      if (i != corner) lowest = std::min(lowest, simplices_[s][i]);
    return lowest;
  };
  constexpr std::uint64_t kNever = ~std::uint64_t{0};
  std::atomic<std::uint64_t> failed = kNever;  // the lowest vertex of a face in more than two simplices, and a simplex
  for_each_block(simplices_.size(), kBorderBlock, threads, part_of(progress, 0.9, 1.0),
                 [&](std::size_t, std::size_t from, std::size_t to) {
                   for (auto s = static_cast<Index>(from); s < to; ++s)
                     for (int corner = 0; corner < N; ++corner) {
                       if (neighbours_->across(s, corner) != FacetNeighbours<N>::kNone) continue;
                       const std::size_t count = count_at_face(s, corner);
                       if (count == 1) mark_border(s, corner);
                       if (count <= 2) continue;
                       const std::uint64_t found = std::uint64_t{lowest_of(s, corner)} << 32 | s;
                       std::uint64_t first = failed.load(std::memory_order_relaxed);
                       while (found < first && !failed.compare_exchange_weak(first, found, std::memory_order_relaxed)) {
                       }
                     }
                 });
  if (failed == kNever) return;
  const auto simplex = static_cast<Index>(failed.load());
  for (int corner = 0; corner < N; ++corner)
    if (const std::size_t count = count_at_face(simplex, corner);
        count > 2 && lowest_of(simplex, corner) == failed.load() >> 32)
      throw Error(
          ErrorCode::UnsupportedData,
          fmt::format("a face of simplex {} is in {} simplices; expected 1 or 2, as in a manifold", simplex, count));
}

template <int N>
std::span<const Index> CollapsibleComplex<N>::clean_star(Index v) {
  Star& star = star_of_[v];
  const auto end = std::remove_if(star.first, star.first + star.size, [&](Index s) { return !is_alive(s); });
  star.size = static_cast<Index>(end - star.first);
  return {star.first, star.size};
}

template <int N>
void CollapsibleComplex<N>::request(Index v, Ahead step) const {
  const Star& star = star_of_[v];
  constexpr std::size_t kPerLine = 64 / sizeof(Index);
  if (step == Ahead::place) {
    hwy::Prefetch(&star);
  } else if (step == Ahead::star) {
    for (std::size_t i = 0; i < star.size; i += kPerLine) hwy::Prefetch(star.first + i);
  } else {
    visit_star(v, [&](Index s) { hwy::Prefetch(&simplices_[s]); });
  }
}

template <int N>
void CollapsibleComplex<N>::star(Index v, std::vector<Index>& result) {
  const std::span<const Index> simplices = clean_star(v);
  result.assign(simplices.begin(), simplices.end());
}

template <int N>
void CollapsibleComplex<N>::neighbours(Index v, std::vector<Index>& result) {
  result.clear();
  visit_neighbours(v, few_, [&](Index a) { result.push_back(a); });
}

/// The star of u after v was merged into it, in the memory of either vertex's star if that is large enough.
template <int N>
void CollapsibleComplex<N>::set_star(Index u, Index v, const Edge& edge, Scratch& scratch) {
  const auto size = static_cast<Index>(edge.only_u.size() + edge.only_v.size());
  Star& star = star_of_[u];
  if (star.capacity < size && star_of_[v].capacity > star.capacity) std::swap(star, star_of_[v]);
  if (star.capacity < size) star = {take_star(size, scratch), 0, size};
  star.size = size;
  std::copy(edge.only_v.begin(), edge.only_v.end(), std::copy(edge.only_u.begin(), edge.only_u.end(), star.first));
  star_of_[v].size = 0;
}

/// Memory for a star.
template <int N>
Index* CollapsibleComplex<N>::take_star(std::size_t size, Scratch& scratch) {
  if (scratch.left_ < size) {
    scratch.left_ = std::max(size, kStarBlock);
    const std::lock_guard lock(larger_stars_->mutex);
    larger_stars_->blocks.push_back(std::make_unique_for_overwrite<Index[]>(scratch.left_));
    scratch.stars_ = larger_stars_->blocks.back().get();
  }
  scratch.left_ -= size;
  return std::exchange(scratch.stars_, scratch.stars_ + size);
}

template <int N>
void CollapsibleComplex<N>::load(Index u, Index v, Edge& edge) {
  edge.u = u;
  edge.v = v;
  edge.only_u.clear();
  edge.only_v.clear();
  edge.both.clear();
  for (const Index s : clean_star(u)) (contains(simplices_[s], v) ? edge.both : edge.only_u).push_back(s);
  for (const Index s : clean_star(v))
    if (!contains(simplices_[s], u)) edge.only_v.push_back(s);
}

/// Calls visit(face) for the faces of the link of an end of the edge, except those that contain the other end. `star`:
/// the simplices at that end only.
template <int N>
template <class Visit>
bool CollapsibleComplex<N>::visit_link(std::span<const Index> star, Index v, const Visit& visit) const {
  const auto cone = static_cast<Index>(star_of_.size());
  const bool has_border = border_vertex_[v] != 0;  // else no border face contains v
  for (const Index s : star) {
    const Simplex& simplex = simplices_[s];
    Face face{};
    for (int i = 0, k = 0; i < N; ++i)
      if (simplex[i] != v) face[k++] = simplex[i];
    if (!visit(face)) return false;
    if (!has_border || border_faces_[s] == 0) continue;
    for (int omitted = 0; omitted < N; ++omitted) {
      if ((border_faces_[s] >> omitted & 1u) == 0 || simplex[omitted] == v) continue;
      Face border = face;
      std::replace(border.begin(), border.end(), simplex[omitted], cone);
      if (!visit(border)) return false;
    }
  }
  return true;
}

/// Calls visit(face, omitted) for the simplices at the edge, without the edge: faces of its link, with omitted = kNone;
/// and for their border faces with the omitted vertex replaced by that of the cone, in the links of the edge or of one
/// end.
template <int N>
template <class Visit>
void CollapsibleComplex<N>::visit_edge_link(const Edge& edge, const Visit& visit) const {
  const bool has_border = on_border(edge.u) || on_border(edge.v);
  for (const Index s : edge.both) {
    const Simplex& simplex = simplices_[s];
    Face face{};
    for (int a = 0, k = 0; a < N; ++a)
      if (simplex[a] != edge.u && simplex[a] != edge.v) face[k++] = simplex[a];
    visit(face, kNone);
    if (!has_border || border_faces_[s] == 0) continue;
    for (int omitted = 0; omitted < N; ++omitted)
      if ((border_faces_[s] >> omitted & 1u) != 0) visit(face, simplex[omitted]);
  }
}

template <int N>
bool CollapsibleComplex<N>::is_contractible(const Edge& edge, Scratch& scratch) const {
  if (edge.only_u.empty() && edge.only_v.empty()) return false;
  const auto cone = static_cast<Index>(star_of_.size());
  LinkCondition<N>& links = scratch.links_;
  links.clear(N * (edge.only_u.size() + edge.only_v.size() + edge.both.size()) + 1);
  visit_edge_link(edge, [&](Face face, Index omitted) {
    if (omitted == edge.u || omitted == edge.v) return;
    std::replace(face.begin(), face.begin() + (N - 2), omitted, cone);
    links.add_to_uv(face);
  });
  links.complete_uv();
  // Border faces that contain one end only: their cones are in the link of that end and do not contain the other one.
  const auto visit_cones = [&](Index other_end, const auto& visit) {
    bool holds = true;
    visit_edge_link(edge, [&](Face face, Index omitted) {
      face[N - 2] = cone;
      if (omitted == other_end) holds = visit(face) && holds;
    });
    return holds;
  };
  const auto add_to_u = [&](const Face& face) {
    links.add_to_u(face);
    return true;
  };
  const auto add_to_v = [&](const Face& face) { return links.add_to_v(face); };
  const bool has_border = on_border(edge.u) || on_border(edge.v);
  visit_link(edge.only_u, edge.u, add_to_u);
  if (has_border) visit_cones(edge.v, add_to_u);
  return visit_link(edge.only_v, edge.v, add_to_v) && (!has_border || visit_cones(edge.u, add_to_v));
}

template <int N>
void CollapsibleComplex<N>::open_face(std::span<const Index> star, Index s, Index without) {
  const Simplex& gone = simplices_[s];
  for (const Index other : star) {
    const Simplex& simplex = simplices_[other];
    int odd = -1, differing = 0;
    for (int i = 0; i < N; ++i)
      if (!contains(gone, simplex[i]) || simplex[i] == without) {
        odd = i;
        ++differing;
      }
    if (differing != 1) continue;
    border_faces_[other] |= static_cast<std::uint8_t>(1u << odd);
    return;
  }
}

template <int N>
void CollapsibleComplex<N>::contract(const Edge& edge, Scratch& scratch) {
  const bool has_border = on_border(edge.u) || on_border(edge.v);
  for (const Index s : edge.both) {
    if (!has_border) break;
    const unsigned i = static_cast<unsigned>(position(simplices_[s], edge.u));
    const unsigned j = static_cast<unsigned>(position(simplices_[s], edge.v));
    // Two faces of s are identified. If one of them was on the border, the other one becomes a border face of its other
    // simplex.
    if ((border_faces_[s] >> i & 1u) != 0) open_face(edge.only_u, s, edge.v);
    if ((border_faces_[s] >> j & 1u) != 0) open_face(edge.only_v, s, edge.u);
  }
  // remove the simplices at the edge
  for (const Index s : edge.both) simplices_[s].fill(kNone);
  std::atomic_ref(alive_).fetch_sub(edge.both.size(), std::memory_order_relaxed);
  // attach the other simplices of v to u
  for (const Index s : edge.only_v) simplices_[s][static_cast<std::size_t>(position(simplices_[s], edge.v))] = edge.u;
  set_star(edge.u, edge.v, edge, scratch);
  if (border_vertex_[edge.v] != 0) border_vertex_[edge.u] = 1;
}

template class CollapsibleComplex<2>;
template class CollapsibleComplex<3>;
template class CollapsibleComplex<4>;

}  // namespace tegl::detail
