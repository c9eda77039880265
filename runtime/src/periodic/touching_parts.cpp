// SPDX-License-Identifier: BSD-3-Clause
//
// Based on: A. Guéziec, G. Taubin, F. Lazarus, W. Horn, "Converting sets of polygons to manifold surfaces by cutting
// and stitching", IEEE Visualization 1998 (cutting at singular vertices); here also for tetrahedra.
#include "periodic/touching_parts.hpp"

#include <algorithm>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "kernel/contour_output.hpp"
#include "mesh/link_checker.hpp"
#include "mesh/validate.hpp"
#include "mesh/vertex_stars.hpp"

namespace tegl::detail {
namespace {

template <int N>
class PartSeparator {
 public:
  PartSeparator(std::span<std::array<Index, N>> simplices, std::size_t vertex_count)
      : simplices_(simplices), first_copy_(vertex_count) {}

  std::vector<Index> run(std::vector<Index> candidates) {
    while (!candidates.empty()) candidates = separate(std::move(candidates));
    return std::move(copies_);
  }

 private:
  /// A face of a simplex of a star that contains the star's vertex: its other vertices, and the simplex by its place in
  /// the star.
  struct Face {
    std::array<Index, N - 2> others;
    Index place;
  };

  [[nodiscard]] std::size_t vertex_count() const noexcept { return first_copy_ + copies_.size(); }

  /// One round. Returns the vertices whose links have to be tested in the next one.
  std::vector<Index> separate(std::vector<Index> candidates) {
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    gather_simplices(candidates);
    Stars stars = make_stars<N>(flat_rows(std::span<const std::array<Index, N>>(rows_)), vertex_count(), 1);
    const std::vector<Index> bad = with_bad_links(stars, candidates);
    for (Index& member : std::span(stars.members).first(stars.first.back())) member = numbers_[member];
    std::vector<Index> next;
    for (const Index v : bad) separate_fans(v, stars.of(v), next);
    if (!next.empty()) {
      next.insert(next.end(), bad.begin(), bad.end());
      return next;
    }
    std::vector<bool> changed(vertex_count(), false);
    for (const Index v : bad) separate_all(v, stars.of(v), changed, next);
    return next;
  }

  /// Lists the simplices around the candidates: most are elsewhere.
  void gather_simplices(const std::vector<Index>& candidates) {
    std::vector<bool> is_candidate(vertex_count(), false);
    for (const Index v : candidates) is_candidate[v] = true;
    rows_.clear();
    numbers_.clear();
    for (std::size_t s = 0; s < simplices_.size(); ++s) {
      if (std::ranges::none_of(simplices_[s], [&](Index v) { return is_candidate[v]; })) continue;
      rows_.push_back(simplices_[s]);
      numbers_.push_back(static_cast<Index>(s));
    }
  }

  [[nodiscard]] std::vector<Index> with_bad_links(const Stars& stars, const std::vector<Index>& candidates) const {
    const SimplexComplex<N - 1> complex{flat_rows(std::span<const std::array<Index, N>>(rows_)), vertex_count()};
    LinkChecker<N - 1> links(complex);
    std::vector<Index> bad;
    for (const Index v : candidates) {
      if (stars.of(v).size() < 2) continue;
      MeshReport report;
      links.visit(v, stars.of(v), report);
      if (report.bad_links != 0) bad.push_back(v);
    }
    return bad;
  }

  /// Returns the number of a new copy of `v`.
  Index add_copy(Index v) {
    check_vertex_count(vertex_count() + 1, kMaxVertices);
    copies_.push_back(v < first_copy_ ? v : copies_[v - first_copy_]);
    return static_cast<Index>(vertex_count() - 1);
  }

  void replace(Index simplex, Index v, Index copy) {
    *std::find(simplices_[simplex].begin(), simplices_[simplex].end(), v) = copy;
  }

  /// Gives every part of the star except the first a copy of `v`, and appends the copies to `next`. Parts are connected
  /// by faces, so each face stays common.
  void separate_fans(Index v, std::span<const Index> star, std::vector<Index>& next) {
    join_at_faces(v, star);
    std::vector<Index> own(star.size(), v);
    for (std::size_t i = 0; i < star.size(); ++i) {
      const Index leader = sets_.find(static_cast<Index>(i));
      if (leader == 0) continue;
      if (leader == i) next.push_back(own[i] = add_copy(v));  // a leader precedes its followers
      replace(star[i], v, own[leader]);
    }
  }

  void join_at_faces(Index v, std::span<const Index> star) {
    faces_.clear();
    for (std::size_t i = 0; i < star.size(); ++i)
      for (const Index left_out : simplices_[star[i]]) {
        if (left_out == v) continue;
        Face face{{}, static_cast<Index>(i)};
        std::size_t n = 0;
        for (const Index w : simplices_[star[i]])
          if (w != v && w != left_out) face.others[n++] = w;
        std::sort(face.others.begin(), face.others.end());
        faces_.push_back(face);
      }
    std::sort(faces_.begin(), faces_.end(), [](const Face& a, const Face& b) { return a.others < b.others; });
    sets_.reset(star.size());
    for (std::size_t i = 1; i < faces_.size(); ++i)
      if (faces_[i].others == faces_[i - 1].others) sets_.join(faces_[i - 1].place, faces_[i].place);
  }

  /// Gives every simplex of the star except the first its own copy of `v`: the last resort, if the parts touch along an
  /// edge, or the link has several holes. Stars that share a vertex with a changed one wait for the next round.
  void separate_all(Index v, std::span<const Index> star, std::vector<bool>& changed, std::vector<Index>& next) {
    next.push_back(v);
    bool waits = false;
    for (const Index s : star)
      for (const Index w : simplices_[s]) waits = waits || (w < changed.size() && changed[w]);
    if (waits) return;
    for (const Index s : star)
      for (const Index w : simplices_[s]) {
        changed[w] = true;
        next.push_back(w);
      }
    for (const Index s : star.subspan(1)) {
      const Index copy = add_copy(v);
      replace(s, v, copy);
      next.push_back(copy);
    }
  }

  std::span<std::array<Index, N>> simplices_;
  std::size_t first_copy_;
  std::vector<Index> copies_;               ///< by new vertex: the one that it copies
  std::vector<std::array<Index, N>> rows_;  ///< the simplices around the candidates of a round
  std::vector<Index> numbers_;              ///< and their numbers
  std::vector<Face> faces_;
  DisjointSets sets_;
};

}  // namespace

template <int N>
std::vector<Index> separate_touching_parts(std::span<std::array<Index, N>> simplices, std::size_t vertex_count,
                                           std::vector<Index> candidates) {
  return PartSeparator<N>(simplices, vertex_count).run(std::move(candidates));
}

template std::vector<Index> separate_touching_parts<2>(std::span<std::array<Index, 2>>, std::size_t,
                                                       std::vector<Index>);
template std::vector<Index> separate_touching_parts<3>(std::span<std::array<Index, 3>>, std::size_t,
                                                       std::vector<Index>);
template std::vector<Index> separate_touching_parts<4>(std::span<std::array<Index, 4>>, std::size_t,
                                                       std::vector<Index>);
template std::vector<Index> separate_touching_parts<5>(std::span<std::array<Index, 5>>, std::size_t,
                                                       std::vector<Index>);

}  // namespace tegl::detail
