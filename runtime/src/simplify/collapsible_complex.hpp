// SPDX-License-Identifier: BSD-3-Clause
//
// A manifold of (N-1)-simplices with edge contractions that preserve its topology.
//
// Based on: T. Dey, H. Edelsbrunner, S. Guha and D. Nekhayev, Topology preserving edge contraction, 1999. Link
// condition: contracting the edge uv preserves the topology if the intersection of the links of u and v is the link of
// uv. A complex with a boundary is completed by a cone from one additional vertex over its boundary. The links here
// contain that vertex.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "simplify/facet_neighbours.hpp"
#include "simplify/few_vertices.hpp"
#include "simplify/link_condition.hpp"
#include "tegl/contour.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

template <int N>
class CollapsibleComplex {
 public:
  using Simplex = std::array<Index, N>;
  static constexpr Index kNone = std::numeric_limits<Index>::max();

  /// The ends of an edge, and the simplices that contain only u, only v, or both.
  struct Edge {
    Index u = 0;
    Index v = 0;
    std::vector<Index> only_u;
    std::vector<Index> only_v;
    std::vector<Index> both;
  };

  /// Errors: InvalidArgument for a vertex number beyond `vertex_count`; UnsupportedData for a simplex that repeats a
  /// vertex, and for a face of more than two simplices; Cancelled. `known`: the neighbours of these simplices, if
  /// they were found before.
  CollapsibleComplex(std::span<const Simplex> simplices, std::size_t vertex_count, unsigned threads = 1,
                     const Progress& progress = {}, std::shared_ptr<const FacetNeighbours<N>> known = nullptr);

  /// The neighbours of the simplices before the first contraction. Only the first call returns them: they take much
  /// memory, and contractions do not need them.
  [[nodiscard]] std::shared_ptr<const FacetNeighbours<N>> take_neighbours() { return std::move(neighbours_); }

  [[nodiscard]] std::size_t alive() const noexcept { return alive_; }
  [[nodiscard]] std::size_t simplex_count() const noexcept { return simplices_.size(); }
  [[nodiscard]] bool is_alive(Index s) const { return simplices_[s][0] != kNone; }
  [[nodiscard]] const Simplex& simplex(Index s) const { return simplices_[s]; }
  [[nodiscard]] bool on_border(Index v) const { return border_vertex_[v] != 0; }
  /// Bit i: the face opposite to corner i is in no other simplex.
  [[nodiscard]] unsigned border_faces(Index s) const { return border_faces_[s]; }

  /// The simplices at a vertex. Their order depends only on the contractions before.
  void star(Index v, std::vector<Index>& result);
  /// The vertices that share an edge with v, each once.
  void neighbours(Index v, std::vector<Index>& result);

  /// Calls visit(vertex) for them. Threads may call it at the same time, for different vertices, each with its own
  /// scratch.
  template <class Visit>
  void visit_neighbours(Index v, FewVertices& scratch, const Visit& visit) {
    const std::span<const Index> star = clean_star(v);
    scratch.clear(N * star.size() + 1);
    scratch[v] = 0;
    for (const Index s : star)
      for (const Index a : simplices_[s])
        if (std::uint32_t& number = scratch[a]; number == FewVertices::kNew) {
          number = 0;
          visit(a);
        }
  }

  /// Requests memory that `load` will read for an edge at v, before it is needed: first the place of the star, then the
  /// star, then its simplices. Each step reads what the one before requested.
  enum class Ahead { place, star, simplices };
  void request(Index v, Ahead step) const;
  /// Calls visit(simplex) for the simplices at a vertex, also for some that no longer exist.
  template <class Visit>
  void visit_star(Index v, const Visit& visit) const {
    const Star& star = star_of_[v];
    for (std::size_t i = 0; i < star.size; ++i) visit(star.first[i]);
  }

  // Threads may load, test and contract edges of different ContourParts at the same time, each with its own scratch.

  /// Fills `edge`. u and v have to differ.
  void load(Index u, Index v, Edge& edge);
  /// Working storage of a thread that contracts edges.
  class Scratch {
    friend class CollapsibleComplex;
    LinkCondition<N> links_;
    Index* stars_ = nullptr;  ///< memory for further stars
    std::size_t left_ = 0;    ///< entries of it
  };
  /// Whether contracting the edge preserves the topology of the manifold.
  bool is_contractible(const Edge& edge, Scratch& scratch) const;
  /// Moves v to u. The edge has to be contractible.
  void contract(const Edge& edge, Scratch& scratch);

 private:
  using Face = typename LinkCondition<N>::Face;

  void fill_stars(std::size_t vertex_count, const Progress& progress);
  void find_border(unsigned threads, const Progress& progress);
  [[nodiscard]] std::size_t count_at_face(Index s, int corner) const;
  void mark_border(Index s, int corner);
  template <class Visit>
  bool visit_link(std::span<const Index> star, Index v, const Visit& visit) const;
  template <class Visit>
  void visit_edge_link(const Edge& edge, const Visit& visit) const;
  /// Finds the simplex of `star` that shares with `s` the face opposite to `without`, and marks that face as border.
  void open_face(std::span<const Index> star, Index s, Index without);

  Buffer<Simplex> simplices_;
  std::vector<std::uint8_t> border_faces_;
  std::vector<std::uint8_t> border_vertex_;  ///< 1: on the border
  /// The first `size` of `capacity` entries are used.
  struct Star {
    Index* first = nullptr;
    Index size = 0;
    Index capacity = 0;
  };
  /// The simplices of the star, without those removed since.
  [[nodiscard]] std::span<const Index> clean_star(Index v);
  void set_star(Index u, Index v, const Edge& edge, Scratch& scratch);
  Index* take_star(std::size_t size, Scratch& scratch);

  Buffer<Star> star_of_;  ///< by vertex
  Buffer<Index> stars_;   ///< simplices, vertex by vertex, before the first contraction
  /// Stars that contractions made larger. Threads take memory of several at a time.
  struct LargerStars {
    std::mutex mutex;
    std::vector<std::unique_ptr<Index[]>> blocks;
  };
  std::unique_ptr<LargerStars> larger_stars_ = std::make_unique<LargerStars>();
  std::size_t alive_ = 0;
  std::shared_ptr<const FacetNeighbours<N>> neighbours_;  ///< until they are taken

  FewVertices few_;  ///< scratch of `neighbours`
};

extern template class CollapsibleComplex<2>;
extern template class CollapsibleComplex<3>;
extern template class CollapsibleComplex<4>;

}  // namespace tegl::detail
