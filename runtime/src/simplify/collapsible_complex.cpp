// SPDX-License-Identifier: BSD-3-Clause
//
// Stars as parts of one array, the link condition, and edge contraction.
#include "simplify/collapsible_complex.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/progress.hpp"
#include "simplify/equal_keys.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {
namespace {

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
      star_of_(vertex_count, Star{}),
      alive_(simplices.size()),
      in_u_(vertex_count + 1, 0),
      in_v_(vertex_count + 1, 0),
      in_edge_(vertex_count + 1, 0) {
  if (simplices.size() > kNone / N)
    throw Error(ErrorCode::TooLarge,
                fmt::format("{} simplices to simplify; expected at most {}", simplices.size(), kNone / N));
  fill_stars(vertex_count, part_of(progress, 0.0, 0.3));
  find_border(part_of(progress, 0.3, 1.0));
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

/// Each face belongs to its lowest vertex, so all simplices with the face are in that vertex's star.
template <int N>
void CollapsibleComplex<N>::find_border(const Progress& progress) {
  struct FaceOfSimplex {
    std::uint64_t others;  ///< the other vertices of the face
    Index simplex;
    int omitted;
  };
  std::vector<FaceOfSimplex> faces;
  EqualKeys equal;
  const auto gather = [&](Index v) {
    faces.clear();
    for (const Index s : clean_star(v))
      for (int omitted = 0; omitted < N; ++omitted) {
        if (simplices_[s][omitted] == v) continue;
        std::uint64_t low = 0, high = 0;
        bool is_lowest = true;
        for (int i = 0; i < N; ++i) {
          const Index a = simplices_[s][i];
          if (i == omitted || a == v) continue;
          is_lowest = is_lowest && a > v;
          low = high == 0 ? a : std::min<std::uint64_t>(high, a);
          high = std::max<std::uint64_t>(high, a);
        }
        if (is_lowest) faces.push_back({low << 32 | high, s, omitted});
      }
  };
  const auto mark_border = [&](const FaceOfSimplex& face) {
    border_faces_[face.simplex] |= static_cast<std::uint8_t>(1u << face.omitted);
    for (int i = 0; i < N; ++i)
      if (i != face.omitted) border_vertex_[simplices_[face.simplex][i]] = true;
  };
  in_parts(star_of_.size(), progress, [&](std::size_t from, std::size_t to) {
    for (std::size_t v = from; v < to; ++v) {
      gather(static_cast<Index>(v));
      for (const auto& group : equal.groups(faces.size(), [&](auto i) { return faces[i].others; })) {
        if (group.count > 2)
          throw Error(ErrorCode::UnsupportedData,
                      fmt::format("a face of simplex {} is in {} simplices; expected 1 or 2, as in a manifold",
                                  faces[group.first].simplex, group.count));
        if (group.count == 1) mark_border(faces[group.first]);
      }
    }
  });
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
void CollapsibleComplex<N>::star(Index v, std::vector<Index>& result) {
  const std::span<const Index> simplices = clean_star(v);
  result.assign(simplices.begin(), simplices.end());
}

template <int N>
void CollapsibleComplex<N>::neighbours(Index v, std::vector<Index>& result) {
  result.clear();
  ++round_;
  in_u_[v] = round_;
  for (const Index s : clean_star(v))
    for (const Index a : simplices_[s])
      if (in_u_[a] != round_) {
        in_u_[a] = round_;
        result.push_back(a);
      }
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

template <int N>
void CollapsibleComplex<N>::gather_link(std::span<const Index> star, Index v, std::vector<Face>& faces) {
  const auto cone = static_cast<Index>(star_of_.size());
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
  const auto cone = static_cast<Index>(star_of_.size());
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
  for (const Index s : edge.only_v) simplices_[s][static_cast<std::size_t>(position(simplices_[s], edge.v))] = edge.u;
  set_star(edge.u, edge.v, edge);
  if (border_vertex_[edge.v]) border_vertex_[edge.u] = true;
}

template class CollapsibleComplex<2>;
template class CollapsibleComplex<3>;
template class CollapsibleComplex<4>;

}  // namespace tegl::detail
