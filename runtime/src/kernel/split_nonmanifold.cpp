// SPDX-License-Identifier: BSD-3-Clause
//
// Splits contours that touch themselves beside missing values (see split_nonmanifold.hpp).
// Based on: A. Guéziec, G. Taubin, F. Lazarus, W. Horn, "Converting sets of polygons to manifold surfaces by cutting
// and stitching", IEEE Visualization 1998 (cutting at singular vertices); here also for tetrahedra.
#include "kernel/split_nonmanifold.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "base/periods.hpp"
#include "base/progress.hpp"
#include "base/workers.hpp"
#include "kernel/contour_output.hpp"
#include "tile/link_balls.hpp"

namespace tegl::detail {

template <int N>
NonmanifoldCollector<N>::NonmanifoldCollector(const RowShape<N>& shape, const Counter<N>& counter)
    : shape_(shape), counter_(counter), buffer_(shape.pitch()) {
  for (Slab<N>& slab : invalid_) slab.all_valid = false;  // makes cells_of_valid_tiles read the bits of invalid tiles
}

template <int N>
void NonmanifoldCollector<N>::open_slab(std::size_t k, const Slab<N>& slab) {
  std::vector<Word>& invalid = invalid_[k % 2].valid;
  std::fill(invalid.begin(), invalid.end(), Word{0});
  slabs_ = k + 1;
  if (slab.all_valid) return;
  if (!any_missing_)
    for (Slab<N>& each : invalid_) counter_.allocate_valid(each);
  any_missing_ = true;
  constexpr unsigned kMiddle = ((1u << (N - 1)) - 1) & ~1u;
  for (std::size_t row = 0; row < shape_.rows(); ++row) {
    if (!shape_.has_cells(shape_.index_of(row), kMiddle)) continue;
    for (std::size_t w = 0, at = row * shape_.words(); w < shape_.words(); ++w, ++at)
      invalid[at] = ~slab.valid[at] & shape_.mask(w, true);
  }
}

template <int N>
void NonmanifoldCollector<N>::add_layer(std::size_t k, const Layer<N>& layer) {
  if (!any_missing_) return;
  const Slab<N>* const below = k > 0 ? &invalid_[(k - 1) % 2] : nullptr;
  const Slab<N>* const above = k < slabs_ ? &invalid_[k % 2] : nullptr;
  for (std::size_t row = 0; row < shape_.rows(); ++row)
    for (int axis = 0; axis < N - 1; ++axis) add_row(layer.edges[axis], axis, row, below, above);
}

template <int N>
void NonmanifoldCollector<N>::add_slab(std::size_t k, const Slab<N>& slab) {
  if (!any_missing_) return;
  for (std::size_t row = 0; row < shape_.rows(); ++row) add_row(slab.edges, N - 1, row, nullptr, &invalid_[k % 2]);
}

template <int N>
void NonmanifoldCollector<N>::add_row(const EdgePlane& plane, int axis, std::size_t row, const Slab<N>* below,
                                      const Slab<N>* above) {
  if (plane.count[row] == 0 || !counter_.cells_of_valid_tiles(1u << axis, row, below, above, buffer_.data())) return;
  const Word* const bits = plane.bits[0].data() + row * shape_.words();
  for (std::size_t w = 0; w < shape_.words(); ++w)
    for (Word rest = bits[w] & buffer_[w]; rest != 0; rest &= rest - 1) {
      const Index id = plane.id(row, shape_.words(), w * kWordBits + static_cast<std::size_t>(std::countr_zero(rest)));
      vertices_.push_back(least_ + static_cast<Index>(id - static_cast<Index>(least_)));
    }
}

template class NonmanifoldCollector<2>;
template class NonmanifoldCollector<3>;
template class NonmanifoldCollector<4>;

namespace {

template <int N, class Real>
class NonmanifoldSplitter {
 public:
  NonmanifoldSplitter(Contour<N, Real>& contour, std::vector<Index> candidates, std::uint64_t max_vertices,
                      const WorkOptions& work)
      : contour_(contour), candidates_(std::move(candidates)), max_vertices_(max_vertices), work_(work) {}

  void run() {
    gather_stars();
    const std::size_t vertices = contour_.vertices.size();
    for (std::size_t c = 0; c < candidates_.size(); ++c) split_vertex(candidates_[c], star(c));
    if constexpr (N == 4) {
      for (std::size_t v = vertices; v < contour_.vertices.size(); ++v) candidates_.push_back(static_cast<Index>(v));
      gather_stars();
      while (split_edges()) gather_stars();
      while (separate_holes()) gather_stars();
    }
    if constexpr (N == 5) {
      std::size_t known = vertices;
      const auto take_new = [&] {
        for (; known < contour_.vertices.size(); ++known) candidates_.push_back(static_cast<Index>(known));
        gather_stars();
      };
      take_new();
      while (split_edges()) take_new();
      while (split_triangles()) take_new();
      while (separate_holes_at_edges()) take_new();
      while (separate_holes()) take_new();
      while (!candidates_.empty()) {
        candidates_ = separate_balls();
        gather_stars();
      }
    }
    tell(work_.progress, 1.0);
  }

 private:
  using Simplex = typename Contour<N, Real>::Simplex;
  static constexpr Index kNone = std::numeric_limits<Index>::max();

  /// A face of a simplex of a star that contains the star's vertex: its other vertices, and the simplex by its index in
  /// the star.
  struct Face {
    std::array<Index, N - 2> others;
    std::size_t place;
  };
  /// A simplex of a star at the edge to one of its other vertices.
  struct EdgeIncidence {
    Index to;
    std::size_t fan;
    Index simplex;
    auto operator<=>(const EdgeIncidence&) const = default;
  };
  /// A face of a simplex of a star that no other simplex shares (a boundary face), and its hole.
  struct Rim {
    std::size_t hole;
    std::array<Index, N - 2> others;
    Index simplex;
  };
  /// A fan of simplices around an edge.
  struct Fan {
    Index from;
    Index to;
    std::vector<Index> simplices;
  };
  /// A fan of simplices around a triangle, in 5D.
  struct TriangleFan {
    std::array<Index, 3> triangle;
    std::vector<Index> simplices;
  };
  /// A simplex of a star at the triangle with two of its other vertices, in 5D.
  struct TriangleIncidence {
    std::array<Index, 3> triangle;
    std::size_t fan;
    Index simplex;
    auto operator<=>(const TriangleIncidence&) const = default;
  };

  [[nodiscard]] std::span<const Index> star(std::size_t c) const {
    return {members_.data() + first_[c], first_[c + 1] - first_[c]};
  }

  /// Reports one round more.
  void next_round() {
    done_ = after_round();
    tell(work_.progress, done_);
  }
  [[nodiscard]] double after_round() const noexcept { return done_ + (1.0 - done_) / 8; }

  /// Begins a round: gathers the simplices around the candidates.
  void gather_stars() {
    next_round();
    std::vector<Index> place(contour_.vertices.size(), kNone);
    for (std::size_t c = 0; c < candidates_.size(); ++c) place[candidates_[c]] = static_cast<Index>(c);
    first_.assign(candidates_.size() + 2, 0);  // counted two entries ahead: filling then leaves the right offsets
    for (const Simplex& simplex : contour_.simplices)
      for (const Index v : simplex)
        if (place[v] != kNone) ++first_[place[v] + std::size_t{2}];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    members_.resize(first_.back());
    for (std::size_t s = 0; s < contour_.simplices.size(); ++s)
      for (const Index v : contour_.simplices[s])
        if (place[v] != kNone) members_[first_[place[v] + std::size_t{1}]++] = static_cast<Index>(s);
    first_.pop_back();
  }

  /// Gathers the faces around `v`; equal ones become adjacent.
  void gather_faces(Index v, std::span<const Index> star) {
    faces_.clear();
    for (std::size_t i = 0; i < star.size(); ++i)
      for (const Index left_out : contour_.simplices[star[i]]) {
        if (left_out == v) continue;
        Face face{{}, i};
        std::size_t n = 0;
        for (const Index w : contour_.simplices[star[i]])
          if (w != v && w != left_out) face.others[n++] = w;
        std::sort(face.others.begin(), face.others.end());
        faces_.push_back(face);
      }
    std::sort(faces_.begin(), faces_.end(), [](const Face& a, const Face& b) { return a.others < b.others; });
  }

  /// Calls join(a, b) for each face that two simplices share.
  template <class Join>
  void for_shared_faces(Join join) const {
    for (std::size_t i = 1; i < faces_.size(); ++i)
      if (faces_[i].others == faces_[i - 1].others) join(faces_[i - 1], faces_[i]);
  }

  /// Adds the midpoint of two vertices; a copy if v == w.
  Index add_vertex(Index v, Index w) {
    check_vertex_count(contour_.vertices.size() + 1, max_vertices_);
    const auto add_middle = [&](auto& points) {
      auto middle = points[v];
      for (int a = 0; a < N && v != w; ++a) middle[a] = (middle[a] + points[w][a]) / 2;
      points.push_back(middle);
    };
    add_middle(contour_.vertices);
    if (v != w && !contour_.periods.empty())
      contour_.vertices.back() =
          between_modulo<N>(contour_.vertices[v], contour_.vertices[w], 0.5, std::span(contour_.periods));
    if (!contour_.normals.empty()) {
      add_middle(contour_.normals);
      if (v != w) normalize(contour_.normals.back());
    }
    return static_cast<Index>(contour_.vertices.size() - 1);
  }

  static void normalize(typename Contour<N, Real>::Vertex& normal) {
    double square = 0;
    for (const Real x : normal) square += static_cast<double>(x) * static_cast<double>(x);
    for (Real& x : normal) x = square > 0 ? static_cast<Real>(static_cast<double>(x) / std::sqrt(square)) : Real{0};
  }

  /// Joins the triangles around `v` that share an edge at `v`. Stars are small, so comparing all pairs is faster than
  /// sorting the edges.
  void join_triangles(Index v, std::span<const Index> star) {
    ends_.clear();
    for (const Index s : star)
      for (const Index w : contour_.simplices[s])
        if (w != v) ends_.push_back(w);
    for (std::size_t i = 1; i < star.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (ends_[2 * i] == ends_[2 * j] || ends_[2 * i] == ends_[2 * j + 1] || ends_[2 * i + 1] == ends_[2 * j] ||
            ends_[2 * i + 1] == ends_[2 * j + 1])
          sets_.join(j, i);
  }

  /// Gives every component of the star except the first its own copy of `v`. Components are connected by faces.
  /// Simplices with a common face at `v` are in the same component, so that face remains shared.
  void split_vertex(Index v, std::span<const Index> star) {
    if (star.size() < 2) return;
    sets_.reset(star.size());
    if constexpr (N == 3) {
      join_triangles(v, star);
    } else {
      gather_faces(v, star);
      for_shared_faces([this](const Face& a, const Face& b) { sets_.join(a.place, b.place); });
    }
    own_.assign(star.size(), v);
    for (std::size_t i = 0; i < star.size(); ++i) {
      const std::size_t leader = sets_.find(i);
      if (leader == 0) continue;
      if (leader == i) own_[i] = add_vertex(v, v);  // a leader precedes its followers
      Simplex& simplex = contour_.simplices[star[i]];
      *std::find(simplex.begin(), simplex.end(), v) = own_[leader];
    }
  }

  /// Appends the fans around edges from `v` to larger vertices, except the first fan of each edge.
  void gather_fans(Index v, std::span<const Index> star, std::vector<Fan>& fans) {
    const auto corner = [&](std::size_t place, Index w) {
      const Simplex& simplex = contour_.simplices[star[place]];
      return N * place + static_cast<std::size_t>(std::find(simplex.begin(), simplex.end(), w) - simplex.begin());
    };
    gather_faces(v, star);
    sets_.reset(N * star.size());
    for_shared_faces([&](const Face& a, const Face& b) {
      for (const Index w : a.others) sets_.join(corner(a.place, w), corner(b.place, w));
    });
    // fan of each simplex at each edge
    incidences_.clear();
    for (std::size_t i = 0; i < star.size(); ++i)
      for (std::size_t j = 0; j < N; ++j)
        if (const Index w = contour_.simplices[star[i]][j]; w > v)
          incidences_.push_back({w, sets_.find(N * i + j), star[i]});
    std::sort(incidences_.begin(), incidences_.end());
    // all fans except the first of each edge
    for (std::size_t i = 1; i < incidences_.size(); ++i) {
      const EdgeIncidence& here = incidences_[i];
      if (here.to != incidences_[i - 1].to) continue;  // first fan of the next edge
      if (here.fan != incidences_[i - 1].fan) fans.push_back({v, here.to, {}});
      if (!fans.empty() && fans.back().from == v && fans.back().to == here.to)
        fans.back().simplices.push_back(here.simplex);
    }
  }

  /// Inserts a midpoint into all fans except the first of edges with several fans. Fans that share a simplex with a
  /// changed fan wait for the next round. Returns false if no fan was left.
  bool split_edges() {
    std::vector<Fan> fans;
    for (std::size_t c = 0; c < candidates_.size(); ++c) gather_fans(candidates_[c], star(c), fans);
    std::vector<Index> changed;
    for (const Fan& fan : fans) {
      const bool waits = std::any_of(fan.simplices.begin(), fan.simplices.end(), [&](Index s) {
        return std::find(changed.begin(), changed.end(), s) != changed.end();
      });
      if (waits) continue;
      split_fan(fan);
      changed.insert(changed.end(), fan.simplices.begin(), fan.simplices.end());
    }
    return !fans.empty();
  }

  /// As gather_fans, for triangles of `v` and two larger vertices.
  void gather_triangle_fans(Index v, std::span<const Index> star, std::vector<TriangleFan>& fans) {
    const auto corner = [&](std::size_t place, Index w) {
      const Simplex& simplex = contour_.simplices[star[place]];
      return static_cast<std::size_t>(std::find(simplex.begin(), simplex.end(), w) - simplex.begin());
    };
    const auto pair_of = [&](std::size_t place, Index w, Index x) {
      const auto [least, most] = std::minmax({corner(place, w), corner(place, x)});
      return N * N * place + N * least + most;
    };
    gather_faces(v, star);
    sets_.reset(N * N * star.size());
    for_shared_faces([&](const Face& a, const Face& b) {
      for (std::size_t i = 0; i < a.others.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
          sets_.join(pair_of(a.place, a.others[i], a.others[j]), pair_of(b.place, a.others[i], a.others[j]));
    });
    std::vector<TriangleIncidence> incidences;
    for (std::size_t i = 0; i < star.size(); ++i)
      for (const Index w : contour_.simplices[star[i]])
        for (const Index x : contour_.simplices[star[i]])
          if (w > v && x > w) incidences.push_back({{v, w, x}, sets_.find(pair_of(i, w, x)), star[i]});
    std::sort(incidences.begin(), incidences.end());
    for (std::size_t i = 1; i < incidences.size(); ++i) {
      const TriangleIncidence& here = incidences[i];
      if (here.triangle != incidences[i - 1].triangle) continue;  // first fan of the next triangle
      if (here.fan != incidences[i - 1].fan) fans.push_back({here.triangle, {}});
      if (!fans.empty() && fans.back().triangle == here.triangle) fans.back().simplices.push_back(here.simplex);
    }
  }

  /// As split_edges, for triangles with several fans: inserts their centroids.
  bool split_triangles() {
    std::vector<TriangleFan> fans;
    for (std::size_t c = 0; c < candidates_.size(); ++c) gather_triangle_fans(candidates_[c], star(c), fans);
    std::vector<bool> changed(contour_.simplices.size(), false);
    for (const TriangleFan& fan : fans) {
      if (std::ranges::any_of(fan.simplices, [&](Index s) { return changed[s]; })) continue;
      const Index m = add_centroid(fan.triangle);
      for (const Index s : fan.simplices) {
        changed[s] = true;
        const Simplex whole = contour_.simplices[s];
        for (const Index left_out : fan.triangle) {
          Simplex part = whole;
          *std::find(part.begin(), part.end(), left_out) = m;
          if (left_out == fan.triangle[0])
            contour_.simplices[s] = part;
          else
            contour_.simplices.push_back(part);
        }
      }
    }
    return !fans.empty();
  }

  Index add_centroid(const std::array<Index, 3>& triangle) {
    const Index a = triangle[0], b = triangle[1], c = triangle[2];
    const Index m = add_vertex(a, b);
    const auto mean = [&](auto& points) {
      for (int i = 0; i < N; ++i) points[m][i] = (points[a][i] + points[b][i] + points[c][i]) / 3;
    };
    if (contour_.periods.empty())
      mean(contour_.vertices);
    else
      contour_.vertices[m] =
          between_modulo<N>(contour_.vertices[m], contour_.vertices[c], 1.0 / 3, std::span(contour_.periods));
    if (!contour_.normals.empty()) {
      mean(contour_.normals);
      normalize(contour_.normals[m]);
    }
    return m;
  }

  void split_fan(const Fan& fan) {
    const Index m = add_vertex(fan.from, fan.to);
    for (const Index s : fan.simplices) {
      Simplex half = contour_.simplices[s];
      *std::find(half.begin(), half.end(), fan.from) = m;
      Simplex& rest = contour_.simplices[s];
      *std::find(rest.begin(), rest.end(), fan.to) = m;
      contour_.simplices.push_back(half);
    }
  }

  /// If two holes in the data meet in an edge of the grid, holes of the contour meet in a vertex whose link is a sphere
  /// with several holes. Each hole except the first gets its own copy of the vertex. Tetrahedra fill the zero-width gap
  /// between the two copies. Returns false if no such vertex was left.
  bool separate_holes() {
    std::vector<bool> changed(contour_.vertices.size(), false);
    bool any = false;
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      const Index v = candidates_[c];
      gather_rim(v, star(c));
      find_holes(kNone);
      if (rim_.empty() || rim_.front().hole == rim_.back().hole) continue;
      if (N == 5 && !holes_are_spheres()) continue;
      any = true;
      if (!waits_for(v, changed)) fill_holes(v, v, changed);
    }
    return any;
  }

  /// As separate_holes, in 5D, for edges whose link is a surface with several holes: each hole except the first gets a
  /// midpoint of the edge.
  bool separate_holes_at_edges() {
    std::vector<bool> changed(contour_.vertices.size(), false);
    bool any = false;
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      const Index v = candidates_[c];
      gather_rim(v, star(c));
      const std::vector<Rim> all = rim_;
      std::vector<Index> ends;
      for (const Rim& rim : all)
        for (const Index w : rim.others)
          if (w > v) ends.push_back(w);
      std::sort(ends.begin(), ends.end());
      ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
      for (const Index w : ends) {
        rim_.clear();
        for (const Rim& rim : all)
          if (std::ranges::find(rim.others, w) != rim.others.end()) rim_.push_back(rim);
        find_holes(w);
        if (rim_.front().hole == rim_.back().hole) continue;
        any = true;
        if (!waits_for(v, changed)) fill_holes(v, w, changed);
      }
    }
    return any;
  }

  /// Whether a vertex of the rim has been changed.
  [[nodiscard]] bool waits_for(Index v, const std::vector<bool>& changed) const {
    return changed[v] || std::ranges::any_of(rim_, [&](const Rim& rim) {
             return std::ranges::any_of(rim.others, [&](Index w) { return changed[w]; });
           });
  }

  /// Gathers the boundary faces of the link of `v`.
  void gather_rim(Index v, std::span<const Index> star) {
    gather_faces(v, star);
    rim_.clear();
    // faces with a single simplex
    for (std::size_t i = 0, end = 0; i < faces_.size(); i = end) {
      for (end = i + 1; end < faces_.size() && faces_[end].others == faces_[i].others;) ++end;
      if (end - i == 1) rim_.push_back({0, faces_[i].others, star[faces_[i].place]});
    }
  }

  /// Orders the rim by holes: parts that are connected by vertices other than `except`.
  void find_holes(Index except) {
    std::vector<std::pair<Index, std::size_t>> corners;  // vertex, index in rim_
    for (std::size_t i = 0; i < rim_.size(); ++i)
      for (const Index w : rim_[i].others)
        if (w != except) corners.emplace_back(w, i);
    std::sort(corners.begin(), corners.end());
    sets_.reset(rim_.size());
    for (std::size_t i = 1; i < corners.size(); ++i)
      if (corners[i].first == corners[i - 1].first) sets_.join(corners[i].second, corners[i - 1].second);
    for (std::size_t i = 0; i < rim_.size(); ++i) rim_[i].hole = sets_.find(i);
    std::sort(rim_.begin(), rim_.end(), [](const Rim& a, const Rim& b) { return a.hole < b.hole; });
  }

  /// Whether all holes, which are in surfaces of triangles, have spheres around them.
  [[nodiscard]] bool holes_are_spheres() const {
    for (std::size_t first = 0, end = 0; first < rim_.size(); first = end) {
      std::vector<Index> vertices;
      std::vector<std::pair<Index, Index>> edges;
      for (end = first; end < rim_.size() && rim_[end].hole == rim_[first].hole; ++end)
        for (const Index a : rim_[end].others) {
          vertices.push_back(a);
          for (const Index b : rim_[end].others)
            if (a < b) edges.emplace_back(a, b);
        }
      const auto count = [](auto& all) {
        std::sort(all.begin(), all.end());
        return std::unique(all.begin(), all.end()) - all.begin();
      };
      if (count(vertices) - count(edges) + static_cast<std::ptrdiff_t>(end - first) != 2) return false;
    }
    return true;
  }

  /// Gives each hole except the first the middle of `v` and `w`; a copy if they are one.
  void fill_holes(Index v, Index w, std::vector<bool>& changed) {
    Index own = kNone;
    for (std::size_t i = 1; i < rim_.size(); ++i) {
      const Rim& rim = rim_[i];
      if (rim.hole == rim_.front().hole) continue;
      if (rim.hole != rim_[i - 1].hole) own = add_vertex(v, w);
      // Mirror image of the adjacent simplex in their common face: replace the vertex opposite of it and exchange two
      // others.
      Simplex filling = contour_.simplices[rim.simplex];
      for (Index& each : filling)
        if (each != v && std::ranges::find(rim.others, each) == rim.others.end()) each = own;
      std::swap(*std::find(filling.begin(), filling.end(), rim.others[0]),
                *std::find(filling.begin(), filling.end(), rim.others[1]));
      contour_.simplices.push_back(filling);
      changed[v] = true;
      for (const Index each : rim.others) changed[each] = true;
    }
  }

  /// The link of `v`, with numbers of its own for the vertices.
  [[nodiscard]] tile::Simplices link_of(Index v, std::span<const Index> star) const {
    std::vector<Index> vertices;
    for (const Index s : star)
      for (const Index w : contour_.simplices[s]) vertices.push_back(w);
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    tile::Simplices link(star.size(), tile::kNoSimplex);
    for (std::size_t i = 0; i < star.size(); ++i) {
      std::size_t n = 0;
      for (const Index w : contour_.simplices[star[i]])
        if (w != v)
          link[i][n++] =
              static_cast<tile::VertexId>(std::lower_bound(vertices.begin(), vertices.end(), w) - vertices.begin());
      tile::sort_vertices(link[i], static_cast<int>(n));
    }
    return link;
  }

  /// Divides links of candidates into balls, and gives all balls except the first a copy of the vertex. A vertex of
  /// which a simplex has been changed waits for the next round. Returns the vertices whose links have to be tested in
  /// the next round, ascending.
  std::vector<Index> separate_balls() {
    std::vector<std::vector<std::uint32_t>> balls(candidates_.size());
    for_each_block(candidates_.size(), 16, work_.threads, part_of(work_.progress, done_, after_round()),
                   [&](std::size_t, std::size_t from, std::size_t to) {
                     for (std::size_t c = from; c < to; ++c) balls[c] = balls_of_link(link_of(candidates_[c], star(c)));
                   });
    std::vector<bool> changed(contour_.simplices.size(), false);
    std::vector<Index> next;
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      const Index v = candidates_[c];
      if (std::ranges::all_of(balls[c], [](std::uint32_t ball) { return ball == 0; })) continue;
      next.push_back(v);
      if (std::ranges::any_of(star(c), [&](Index s) { return changed[s]; })) continue;
      std::vector<Index> copies = {v};
      for (std::size_t i = 0; i < balls[c].size(); ++i) {
        const Index s = star(c)[i];
        Simplex& simplex = contour_.simplices[s];
        changed[s] = true;
        next.insert(next.end(), simplex.begin(), simplex.end());
        if (balls[c][i] == copies.size()) next.push_back(copies.emplace_back(add_vertex(v, v)));
        *std::find(simplex.begin(), simplex.end(), v) = copies[balls[c][i]];
      }
    }
    std::sort(next.begin(), next.end());
    next.erase(std::unique(next.begin(), next.end()), next.end());
    return next;
  }

  Contour<N, Real>& contour_;
  std::vector<Index> candidates_;
  std::uint64_t max_vertices_;
  const WorkOptions& work_;
  double done_ = 0;                 ///< reported progress
  std::vector<std::size_t> first_;  ///< star of candidate c: members_[first_[c]] ... members_[first_[c + 1] - 1]
  std::vector<Index> members_;
  std::vector<Face> faces_;
  std::vector<Index> ends_;  ///< two for each triangle of a star: its vertices except the star's
  std::vector<EdgeIncidence> incidences_;
  std::vector<Rim> rim_;
  std::vector<Index> own_;
  BasicDisjointSets<std::size_t> sets_;
};

}  // namespace

template <int N, class Real>
void split_nonmanifold(Contour<N, Real>& contour, const std::vector<Index>& candidates, std::uint64_t max_vertices,
                       const WorkOptions& work) {
  // In 2D an edge of the grid has only two tiles, so contours cannot touch themselves.
  if constexpr (N > 2)
    if (!candidates.empty()) NonmanifoldSplitter<N, Real>(contour, candidates, max_vertices, work).run();
}

#define TEGL_INSTANTIATE_CONTOURS_TO_5(N, Real)                                                         \
  template void split_nonmanifold<N, Real>(Contour<N, Real>&, const std::vector<Index>&, std::uint64_t, \
                                           const WorkOptions&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
