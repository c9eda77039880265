// SPDX-License-Identifier: BSD-3-Clause
//
// Stars as linked lists of corners, the link condition, and edge contraction.
#include "simplify/collapsible_complex.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/progress.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {
namespace {

constexpr std::size_t kSimplicesPerReport = std::size_t{1} << 14;  ///< simplices between two progress reports

constexpr std::uint64_t edge_key(Index a, Index b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

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
                                          const Progress& progress)
    : simplices_(simplices.begin(), simplices.end()),
      border_faces_(simplices.size(), 0),
      border_vertex_(vertex_count, false),
      first_(vertex_count, kNone),
      next_(simplices.size() * N, kNone),
      alive_(simplices.size()),
      in_u_(vertex_count + 1, 0),
      in_v_(vertex_count + 1, 0),
      in_edge_(vertex_count + 1, 0) {
  if (simplices.size() > kNone / N)
    throw Error(ErrorCode::TooLarge,
                fmt::format("{} simplices to simplify; expected at most {}", simplices.size(), kNone / N));
  for (std::size_t s = simplices_.size(); s-- > 0;) {
    if (s % kSimplicesPerReport == 0)
      tell(progress, 0.3 * (1.0 - static_cast<double>(s) / static_cast<double>(simplices_.size())));
    for (int i = 0; i < N; ++i) {
      const Index v = simplices_[s][i];
      if (v >= vertex_count)
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("simplex {} has the vertex {}; expected one of {}", s, v, vertex_count));
      if (std::count(simplices_[s].begin(), simplices_[s].end(), v) != 1)
        throw Error(ErrorCode::UnsupportedData,
                    fmt::format("simplex {} has the vertex {} twice; expected different vertices", s, v));
      next_[s * N + i] = first_[v];
      first_[v] = static_cast<Index>(s * N + i);
    }
  }
  find_border(part_of(progress, 0.3, 1.0));
}

template <int N>
void CollapsibleComplex<N>::find_border(const Progress& progress) {
  for (Index s = 0; s < simplices_.size(); ++s) {
    if (s % kSimplicesPerReport == 0) tell(progress, static_cast<double>(s) / static_cast<double>(simplices_.size()));
    for (int omitted = 0; omitted < N; ++omitted) {
      // Every simplex with this face is in the star of each of its vertices; any one of them will do.
      const Index at = simplices_[s][omitted == 0 ? 1 : 0];
      int others = 0;
      for (Index c = first_[at]; c != kNone; c = next_[c]) {
        const Simplex& other = simplices_[c / N];
        if (c / N == s) continue;
        bool shares = true;
        for (int i = 0; i < N && shares; ++i) shares = i == omitted || contains(other, simplices_[s][i]);
        others += shares;
      }
      if (others > 1)
        throw Error(
            ErrorCode::UnsupportedData,
            fmt::format("a face of simplex {} is in {} simplices; expected 1 or 2, as in a manifold", s, others + 1));
      if (others == 1) continue;
      border_faces_[s] |= static_cast<std::uint8_t>(1u << omitted);
      for (int i = 0; i < N; ++i)
        if (i != omitted) border_vertex_[simplices_[s][i]] = true;
    }
  }
}

template <int N>
void CollapsibleComplex<N>::star(Index v, std::vector<Index>& result) {
  result.clear();
  // Removed simplices are unlinked during the traversal.
  Index* link = &first_[v];
  while (*link != kNone) {
    const Index s = *link / N;
    if (is_alive(s)) {
      result.push_back(s);
      link = &next_[*link];
    } else {
      *link = next_[*link];
    }
  }
}

template <int N>
void CollapsibleComplex<N>::neighbours(Index v, std::vector<Index>& result) {
  result.clear();
  ++round_;
  in_u_[v] = round_;
  for (Index c = first_[v]; c != kNone; c = next_[c]) {
    if (!is_alive(c / N)) continue;
    for (const Index a : simplices_[c / N])
      if (in_u_[a] != round_) {
        in_u_[a] = round_;
        result.push_back(a);
      }
  }
}

template <int N>
void CollapsibleComplex<N>::load(Index u, Index v, Edge& edge) {
  edge.u = u;
  edge.v = v;
  star(u, edge.only_u);
  star(v, edge.only_v);
  edge.both.clear();
  std::erase_if(edge.only_v, [&](Index s) { return contains(simplices_[s], u); });
  std::erase_if(edge.only_u, [&](Index s) {
    const bool shared = contains(simplices_[s], v);
    if (shared) edge.both.push_back(s);
    return shared;
  });
}

template <int N>
void CollapsibleComplex<N>::gather_link(std::span<const Index> star, Index v, std::vector<Face>& faces) {
  const auto cone = static_cast<Index>(first_.size());
  for (const Index s : star) {
    const Simplex& simplex = simplices_[s];
    Face face{};
    for (int i = 0, k = 0; i < N; ++i)
      if (simplex[i] != v) face[k++] = simplex[i];
    std::sort(face.begin(), face.end());
    faces.push_back(face);
    if (border_faces_[s] == 0) continue;
    for (int omitted = 0; omitted < N; ++omitted) {
      if ((border_faces_[s] >> omitted & 1u) == 0 || simplex[omitted] == v) continue;
      Face border = face;
      std::replace(border.begin(), border.end(), simplex[omitted], cone);
      std::sort(border.begin(), border.end());
      faces.push_back(border);
    }
  }
}

template <int N>
void CollapsibleComplex<N>::gather_edge_link(const Edge& edge) {
  link_edge_.clear();
  const auto cone = static_cast<Index>(first_.size());
  for (const Index s : edge.both) {
    const Simplex& simplex = simplices_[s];
    const int i = position(simplex, edge.u), j = position(simplex, edge.v);
    Face face{};
    for (int a = 0, k = 0; a < N; ++a)
      if (a != i && a != j) face[k++] = simplex[a];
    link_edge_.push_back(face);
    for (int omitted = 0; omitted < N; ++omitted) {
      if ((border_faces_[s] >> omitted & 1u) == 0) continue;
      if (omitted == i || omitted == j) {
        // This border face contains one end only. Its cone is in the link of that end and does not contain the other
        // end.
        Face border{};
        for (int a = 0, k = 0; a < N; ++a)
          if (a != i && a != j) border[k++] = simplex[a];
        border[N - 2] = cone;
        std::sort(border.begin(), border.end());
        (omitted == j ? link_u_ : link_v_).push_back(border);
        continue;
      }
      Face border = face;
      std::replace(border.begin(), border.begin() + (N - 2), simplex[omitted], cone);
      link_edge_.push_back(border);
    }
  }
}

template <int N>
void CollapsibleComplex<N>::mark(std::span<const Face> faces, std::vector<std::uint32_t>& marks, int vertices) {
  for (const Face& face : faces)
    for (int i = 0; i < vertices; ++i) marks[face[i]] = round_;
}

template <int N>
bool CollapsibleComplex<N>::is_contractible(const Edge& edge) {
  if (edge.only_u.empty() && edge.only_v.empty()) return false;
  link_u_.clear();
  link_v_.clear();
  gather_link(edge.only_u, edge.u, link_u_);
  gather_link(edge.only_v, edge.v, link_v_);
  gather_edge_link(edge);
  ++round_;
  mark(link_u_, in_u_, N - 1);
  mark(link_v_, in_v_, N - 1);
  mark(link_edge_, in_edge_, N - 2);
  return share_only_the_edges_link();
}

template <int N>
bool CollapsibleComplex<N>::share_only_the_edges_link() {
  for (const Face& face : link_u_)
    for (const Index a : face)
      if (in_v_[a] == round_ && in_edge_[a] != round_) return false;
  if constexpr (N == 3) return !share_a_link_edge(false);
  if constexpr (N == 4) return !share_a_link_edge(true) && !share_a_link_triangle();
  return true;
}

/// Whether both links share an edge that is not in the link of uv. The link of uv has edges if N = 4.
template <int N>
bool CollapsibleComplex<N>::share_a_link_edge(bool beside_edges_link) {
  const auto gather = [&](std::span<const Face> faces, const std::vector<std::uint32_t>& in_other,
                          std::vector<std::uint64_t>& keys) {
    keys.clear();
    for (const Face& face : faces)
      for (int i = 0; i < N - 1; ++i)
        for (int j = 0; j < i; ++j)
          if (in_other[face[i]] == round_ && in_other[face[j]] == round_) keys.push_back(edge_key(face[i], face[j]));
    std::sort(keys.begin(), keys.end());
  };
  gather(link_u_, in_v_, edges_u_);
  gather(link_v_, in_u_, edges_v_);
  edges_both_.clear();
  std::set_intersection(edges_u_.begin(), edges_u_.end(), edges_v_.begin(), edges_v_.end(),
                        std::back_inserter(edges_both_));
  return std::any_of(edges_both_.begin(), edges_both_.end(), [&](std::uint64_t key) {
    return !beside_edges_link || std::none_of(link_edge_.begin(), link_edge_.end(),
                                              [&](const Face& face) { return edge_key(face[0], face[1]) == key; });
  });
}

/// Whether both links share a triangle. The link of uv has no triangles, so a shared one violates the link condition.
template <int N>
bool CollapsibleComplex<N>::share_a_link_triangle() const {
  for (const Face& face : link_u_) {
    if (!std::all_of(face.begin(), face.end(), [&](Index a) { return in_v_[a] == round_; })) continue;
    if (std::find(link_v_.begin(), link_v_.end(), face) != link_v_.end()) return true;
  }
  return false;
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
  for (const Index s : edge.both) {
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
  for (const Index s : edge.only_v) {
    const auto i = static_cast<std::size_t>(position(simplices_[s], edge.v));
    simplices_[s][i] = edge.u;
    const auto corner = static_cast<Index>(s * std::size_t{N} + i);
    next_[corner] = first_[edge.u];
    first_[edge.u] = corner;
  }
  first_[edge.v] = kNone;
  if (border_vertex_[edge.v]) border_vertex_[edge.u] = true;
}

template class CollapsibleComplex<2>;
template class CollapsibleComplex<3>;
template class CollapsibleComplex<4>;

}  // namespace tegl::detail
