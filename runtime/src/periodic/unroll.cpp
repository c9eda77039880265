// SPDX-License-Identifier: BSD-3-Clause
//
// Unrolls wrapped contours: doubles the vertices that simplices across the seam have at the start of a period.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "base/periods.hpp"
#include "kernel/contour_output.hpp"
#include "mesh/validate.hpp"
#include "periodic/touching_parts.hpp"
#include "tegl/periodic.hpp"

namespace tegl {
namespace {

/// A vertex moved by a number of each period.
template <int N>
struct Moved {
  Index vertex = 0;
  std::array<int, N> times{};
  auto operator<=>(const Moved&) const = default;
};

/// By corner of a simplex, the periods by which it moves: neighbours of corner 0, then moved so that no share of the
/// simplex is below that of the corners that stay.
template <int N, class Real>
std::array<Moved<N>, N> moved_corners(const Contour<N, Real>& contour,
                                      const typename Contour<N, Real>::Simplex& simplex) {
  std::array<Moved<N>, N> moved;
  for (int j = 0; j < N; ++j) moved[j].vertex = simplex[j];
  for (std::size_t p = 0; p < contour.periods.size(); ++p) {
    const auto share = [&](int j) {
      return share_of(contour.periods[p], detail::widened_point<N>(contour.vertices[simplex[j]]));
    };
    int least = 0;
    for (int j = 0; j < N; ++j) {
      moved[j].times[p] = static_cast<int>(std::round(share(0) - share(j)));
      least = std::min(least, moved[j].times[p]);
    }
    for (Moved<N>& corner : moved) corner.times[p] -= least;
  }
  return moved;
}

void append_copies(std::vector<Attribute>& attributes, std::span<const Index> copied) {
  for (Attribute& attribute : attributes) {
    const auto width = static_cast<std::size_t>(attribute.width);
    for (const Index v : copied)
      for (std::size_t i = 0; i < width; ++i) attribute.values.push_back(attribute.values[v * width + i]);
  }
}

template <int N, class Real>
class Unroller {
 public:
  explicit Unroller(const Contour<N, Real>& contour) : contour_(contour), is_kept_(contour.vertices.size(), false) {}

  Unrolled<N, Real> run() {
    result_.contour = contour_;
    result_.contour.periods.clear();
    for (const std::size_t s : moved_simplices()) move(result_.contour.simplices[s], contour_.simplices[s]);
    separate();
    for (const Index v : copied_)
      if (!contour_.normals.empty()) result_.contour.normals.push_back(contour_.normals[v]);
    append_copies(result_.contour.vertex_attributes, copied_);
    result_.originals.resize(contour_.vertices.size());
    std::iota(result_.originals.begin(), result_.originals.end(), Index{0});
    result_.originals.insert(result_.originals.end(), copied_.begin(), copied_.end());
    return std::move(result_);
  }

 private:
  using Simplex = typename Contour<N, Real>::Simplex;

  /// The simplices of which a corner moves. Marks vertices that stay in any simplex.
  std::vector<std::size_t> moved_simplices() {
    std::vector<std::size_t> moved;
    for (std::size_t s = 0; s < contour_.simplices.size(); ++s) {
      bool any = false;
      for (const Moved<N>& corner : moved_corners<N, Real>(contour_, contour_.simplices[s])) {
        const bool stays = corner.times == std::array<int, N>{};
        if (stays) is_kept_[corner.vertex] = true;
        any = any || !stays;
      }
      if (any) moved.push_back(s);
    }
    return moved;
  }

  void move(Simplex& simplex, const Simplex& wrapped) {
    for (const Moved<N>& corner : moved_corners<N, Real>(contour_, wrapped)) {
      if (corner.times == std::array<int, N>{}) continue;
      const auto [at, is_new] = numbers_.try_emplace(corner, corner.vertex);
      if (is_new) at->second = number_of(corner);
      *std::find(simplex.begin(), simplex.end(), corner.vertex) = at->second;
    }
  }

  /// The number of a place that is met for the first time: the vertex's own number if it stays nowhere.
  Index number_of(const Moved<N>& corner) {
    std::array<double, N> x = detail::widened_point<N>(contour_.vertices[corner.vertex]);
    for (std::size_t p = 0; p < contour_.periods.size(); ++p)
      detail::add_times(contour_.periods[p], corner.times[p], x);
    typename Contour<N, Real>::Vertex place;
    for (int a = 0; a < N; ++a) place[a] = static_cast<Real>(x[a]);
    if (is_kept_[corner.vertex]) return add_copy(corner.vertex, place);
    is_kept_[corner.vertex] = true;
    result_.contour.vertices[corner.vertex] = place;
    return corner.vertex;
  }

  Index add_copy(Index v, const typename Contour<N, Real>::Vertex& place) {
    auto& vertices = result_.contour.vertices;
    detail::check_vertex_count(vertices.size() + 1, detail::kMaxVertices);
    vertices.push_back(place);
    copied_.push_back(v);
    return static_cast<Index>(vertices.size() - 1);
  }

  /// Simplices that stay and those that move may leave parts around a vertex that only touch.
  void separate() {
    if (copied_.empty()) return;
    const std::size_t wrapped = contour_.vertices.size(), vertices = result_.contour.vertices.size();
    std::vector<Index> candidates = copied_;
    for (std::size_t v = wrapped; v < vertices; ++v) candidates.push_back(static_cast<Index>(v));
    const auto copies = detail::separate_touching_parts<N>(std::span<Simplex>(result_.contour.simplices), vertices,
                                                           std::move(candidates));
    for (const Index v : copies)
      add_copy(v < wrapped ? v : copied_[v - wrapped], typename Contour<N, Real>::Vertex(result_.contour.vertices[v]));
  }

  const Contour<N, Real>& contour_;
  std::vector<bool> is_kept_;  ///< by vertex of the wrapped contour: whether its number is in use
  std::map<Moved<N>, Index> numbers_;
  std::vector<Index> copied_;  ///< by copy: its original
  Unrolled<N, Real> result_;
};

}  // namespace

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> Unrolled<N, Real> unroll(const Contour<N, Real>& contour) {
  detail::require_vertices(contour);
  detail::require_attributes(contour);
  return Unroller<N, Real>(contour).run();
}

#define TEGL_INSTANTIATE_CONTOURS_TO_5(N, Real) template Unrolled<N, Real> unroll<N, Real>(const Contour<N, Real>&);
#include "base/instantiate.hpp"

}  // namespace tegl
