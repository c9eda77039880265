// SPDX-License-Identifier: BSD-3-Clause
//
// Stars as parts of one array, the link condition, and edge contraction.
#include "simplify/collapsible_complex.hpp"

#include <algorithm>
#include <atomic>

#include <fmt/format.h>

#include "hwy/cache_control.h"

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "simplify/equal_keys.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {
namespace {

constexpr std::size_t kBorderBlock = 1024;

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
                                          unsigned threads, const Progress& progress)
    : simplices_(simplices.begin(), simplices.end()),
      border_faces_(simplices.size(), 0),
      border_vertex_(vertex_count, 0),
      star_of_(vertex_count, Star{}),
      alive_(simplices.size()) {
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
  std::size_t first = 0;
  for (Star& star : star_of_) {
    star.first = first;
    first += star.capacity;
  }
  stars_.reserve(2 * first);  // contractions append larger stars
  stars_.resize(first);
  for (Index s = 0; s < simplices_.size(); ++s)
    for (const Index v : simplices_[s]) stars_[star_of_[v].first + star_of_[v].size++] = s;
}

/// Finds border faces by their lowest vertex: all simplices with the face are in that vertex's star. Use one per
/// thread.
template <int N>
class CollapsibleComplex<N>::BorderSearch {
 public:
  explicit BorderSearch(CollapsibleComplex& complex) : complex_(complex) {}

  /// Marks the border faces with v as their lowest vertex. Returns a simplex with a face that is in more than two, and
  /// their number, if there is one.
  std::pair<Index, std::size_t> search(Index v) {
    gather(v);
    for (const auto& group : equal_.groups(faces_.size(), [&](auto i) { return faces_[i].others; })) {
      if (group.count > 2) return {faces_[group.first].simplex, group.count};
      if (group.count == 1) mark(faces_[group.first]);
    }
    return {kNone, 0};
  }

 private:
  struct FaceOfSimplex {
    std::uint64_t others;  ///< the other vertices of the face
    Index simplex;
    int omitted;
  };

  void gather(Index v) {
    faces_.clear();
    for (const Index s : complex_.clean_star(v))
      for (int omitted = 0; omitted < N; ++omitted) {
        const Simplex& simplex = complex_.simplices_[s];
        if (simplex[omitted] == v) continue;
        std::uint64_t low = 0, high = 0;
        bool is_lowest = true;
        for (int i = 0; i < N; ++i) {
          const Index a = simplex[i];
          if (i == omitted || a == v) continue;
          is_lowest = is_lowest && a > v;
          low = high == 0 ? a : std::min<std::uint64_t>(high, a);
          high = std::max<std::uint64_t>(high, a);
        }
        if (is_lowest) faces_.push_back({low << 32 | high, s, omitted});
      }
  }

  /// Several threads may mark faces of one simplex, or one vertex.
  void mark(const FaceOfSimplex& face) {
    const auto bit = static_cast<std::uint8_t>(1u << face.omitted);
    std::atomic_ref(complex_.border_faces_[face.simplex]).fetch_or(bit, std::memory_order_relaxed);
    for (int i = 0; i < N; ++i)
      if (i != face.omitted)
        std::atomic_ref(complex_.border_vertex_[complex_.simplices_[face.simplex][i]])
            .store(1, std::memory_order_relaxed);
  }

  CollapsibleComplex& complex_;
  std::vector<FaceOfSimplex> faces_;
  EqualKeys equal_;
};

template <int N>
void CollapsibleComplex<N>::find_border(unsigned threads, const Progress& progress) {
  std::atomic<Index> failed = kNone;  // the first vertex of a face in more than two simplices
  for_each_block(
      star_of_.size(), kBorderBlock, threads, progress, [&] { return BorderSearch(*this); },
      [&](std::size_t, std::size_t from, std::size_t to, BorderSearch& search) {
        for (auto v = static_cast<Index>(from); v < to; ++v) {
          if (search.search(v).second == 0) continue;
          Index first = failed.load(std::memory_order_relaxed);
          while (v < first && !failed.compare_exchange_weak(first, v, std::memory_order_relaxed)) {
          }
          return;
        }
      });
  if (failed == kNone) return;
  const auto [simplex, count] = BorderSearch(*this).search(failed);
  throw Error(
      ErrorCode::UnsupportedData,
      fmt::format("a face of simplex {} is in {} simplices; expected 1 or 2, as in a manifold", simplex, count));
}

template <int N>
std::span<const Index> CollapsibleComplex<N>::clean_star(Index v) {
  Star& star = star_of_[v];
  Index* const first = stars_.data() + star.first;
  star.size =
      static_cast<Index>(std::remove_if(first, first + star.size, [&](Index s) { return !is_alive(s); }) - first);
  return {first, star.size};
}

template <int N>
void CollapsibleComplex<N>::request(Index v, Ahead step) const {
  const Star& star = star_of_[v];
  constexpr std::size_t kPerLine = 64 / sizeof(Index);
  if (step == Ahead::place) {
    hwy::Prefetch(&star);
  } else if (step == Ahead::star) {
    for (std::size_t i = 0; i < star.size; i += kPerLine) hwy::Prefetch(stars_.data() + star.first + i);
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

/// The star of u after v was merged into it, in the part of either vertex if it is large enough.
template <int N>
void CollapsibleComplex<N>::set_star(Index u, Index v, const Edge& edge) {
  const auto size = static_cast<Index>(edge.only_u.size() + edge.only_v.size());
  Star& star = star_of_[u];
  if (star.capacity < size && star_of_[v].capacity > star.capacity) std::swap(star, star_of_[v]);
  if (star.capacity < size) {
    star.first = stars_.size();
    star.capacity = size;
    stars_.resize(stars_.size() + size);
  }
  star.size = size;
  const auto first = stars_.begin() + static_cast<std::ptrdiff_t>(star.first);
  std::copy(edge.only_v.begin(), edge.only_v.end(), std::copy(edge.only_u.begin(), edge.only_u.end(), first));
  star_of_[v].size = 0;
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
bool CollapsibleComplex<N>::is_contractible(const Edge& edge) {
  if (edge.only_u.empty() && edge.only_v.empty()) return false;
  const auto cone = static_cast<Index>(star_of_.size());
  links_.clear(N * (edge.only_u.size() + edge.only_v.size() + edge.both.size()) + 1);
  visit_edge_link(edge, [&](Face face, Index omitted) {
    if (omitted == edge.u || omitted == edge.v) return;
    std::replace(face.begin(), face.begin() + (N - 2), omitted, cone);
    links_.add_to_uv(face);
  });
  links_.complete_uv();
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
    links_.add_to_u(face);
    return true;
  };
  const auto add_to_v = [&](const Face& face) { return links_.add_to_v(face); };
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
void CollapsibleComplex<N>::contract(const Edge& edge) {
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
  alive_ -= edge.both.size();
  // attach the other simplices of v to u
  for (const Index s : edge.only_v) simplices_[s][static_cast<std::size_t>(position(simplices_[s], edge.v))] = edge.u;
  set_star(edge.u, edge.v, edge);
  if (border_vertex_[edge.v] != 0) border_vertex_[edge.u] = 1;
}

template class CollapsibleComplex<2>;
template class CollapsibleComplex<3>;
template class CollapsibleComplex<4>;

}  // namespace tegl::detail
