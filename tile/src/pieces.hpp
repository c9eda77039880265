// SPDX-License-Identifier: BSD-3-Clause
//
// The piece of one face of a tile: its contour, high part and low part, in the face's own vertex numbering. Equal faces
// have equal pieces, so a piece is built once and renumbered for each use.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "shelling.hpp"
#include "tegl/tile/disjoint_sets.hpp"
#include "tegl/tile/facets.hpp"
#include "tegl/tile/three_sphere.hpp"

namespace tegl::tile {

/// A vertex of a piece that lies in no proper face of the face. Vertices are ordered by the face that owns them, in the
/// lattice's order, the face itself last; within one face in order of creation.
struct OwnVertex {
  VertexKind kind = VertexKind::corner;
  std::uint32_t number = 0;
  VertexId copied = kNoVertex;
  std::uint32_t of_begin = 0, of_end = 0;  ///< range in Piece::of
};

struct PieceFacet {
  Filling filling = Filling::simplex;
  int boundary_euler = 0;
  std::uint32_t begin = 0, end = 0;  ///< range in Piece::contour
};

/// Contour, high part and low part of one face. The vertices of every simplex ascend.
struct Piece {
  std::vector<OwnVertex> own{};
  Simplices of{};
  std::vector<PieceFacet> facets{};
  Simplices contour{};
  std::vector<std::int8_t> sign{};
  Simplices high{}, low{};

  void clear();
  [[nodiscard]] std::size_t bytes() const;
};

/// Disjoint sets of vertices.
using VertexSets = detail::BasicDisjointSets<VertexId>;

/// Builds the piece of a face from the pieces of its own faces. Reuses its memory.
class PieceBuilder {
 public:
  /// Per face of the lattice: all its faces, of every dimension, ascending, itself last.
  using Closures = std::vector<std::vector<std::uint32_t>>;

  PieceBuilder(const FaceLattice& lattice, const Closures& closures) : lattice_(&lattice), closures_(&closures) {}

  /// `pieces`: the pieces of all lower faces. `with_parts`: also builds the high and the low part, not only the
  /// contour.
  void build(std::uint32_t face, std::span<const Piece* const> pieces, Choice choice, Alternative alternative,
             bool with_parts, Piece& piece);

  // Results for the last face built.
  /// Sigma, ordered by components, and its signs.
  [[nodiscard]] const Simplices& sigma() const { return sigma_; }
  [[nodiscard]] const std::vector<std::int8_t>& sigma_sign() const { return sigma_sign_; }
  /// Euler characteristics of Sigma's components.
  void euler_characteristics(std::vector<int>& result);
  /// Writes to `map` the numbers, in the last face built, of the vertices of `face`.
  void number(std::uint32_t face, std::vector<VertexId>& map) const;

 private:
  /// A component of Sigma.
  struct Component {
    std::uint32_t begin = 0, end = 0;          ///< range in sigma_
    std::uint32_t region[2] = {0, 0};          ///< the adjacent regions: low, high
    std::uint32_t cap_begin = 0, cap_end = 0;  ///< its cone or simplex in the piece's contour, if any
    [[nodiscard]] bool coned() const { return cap_end > cap_begin; }
  };
  /// A component of the high or the low part of the face's boundary.
  struct Region {
    bool high = false;
    std::uint32_t begin = 0, end = 0;  ///< range in sides_[high]
    std::vector<std::uint32_t> around{};
    std::uint32_t part = 0;
  };

  [[nodiscard]] const Face& face() const { return lattice_->faces()[face_]; }
  [[nodiscard]] std::span<const Simplex> sigma_of(const Component& c) const {
    return std::span(sigma_).subspan(c.begin, c.end - c.begin);
  }
  VertexId new_vertex(VertexKind kind, VertexId copied = kNoVertex, std::span<const Simplex> of = {});
  void build_edge();
  void number_vertices();
  void collect_sigma();
  void collect_regions();
  bool shown_to_be_sphere(const Component& component);
  [[nodiscard]] bool in_one_face() const;
  void find_vertices(std::span<const Simplex> simplices);
  void ball(std::span<const Simplex> boundary, VertexKind kind, Simplices& to);
  void cap(Component& component);
  void cap_what_stands_apart();
  void capped(const Region& region, Simplices& to) const;
  void fill_parts();
  void fill_around_centre(std::uint32_t part);
  void cut_corner(const Region& region);
  void copy_inwards(const Region& region);
  Simplex image(const Simplex& simplex, std::vector<VertexId>& images, VertexKind kind);
  static void add_prism(const Simplex& from, const Simplex& to, Simplices& part);
  void orient(std::uint32_t begin, int boundary_euler, Filling filling, std::span<const Simplex> bounds,
              std::span<const std::int8_t> bounds_sign);
  Simplices& side(bool high) { return high ? piece_->high : piece_->low; }

  const FaceLattice* lattice_;
  const Closures* closures_;
  std::span<const Piece* const> pieces_;

  // State of the current face.
  std::uint32_t face_ = 0;
  bool with_parts_ = false;
  bool centre_high_ = false;
  Piece* piece_ = nullptr;
  std::uint32_t next_number_ = 0, next_centre_ = 0;
  std::vector<VertexId> base_;        ///< by face of the lattice: number of its first own vertex
  std::vector<std::uint32_t> owner_;  ///< by vertex: the face that owns it
  Simplices sigma_;
  std::vector<std::int8_t> sigma_sign_;
  std::vector<Component> components_;
  Simplices sides_[2];  ///< low and high part of the boundary, ordered by regions
  std::vector<Region> regions_;

  // Scratch memory.
  VertexSets sets_;
  std::vector<VertexId> map_, found_, image_, between_;
  std::vector<std::uint32_t> group_, mark_, start_;
  std::uint32_t epoch_ = 0;
  Simplices unsorted_, around_, original_;
  std::vector<std::int8_t> unsorted_sign_;
  std::vector<std::uint32_t> all_;
  Adjacency adjacency_;
  Shelling shelling_;
  ThreeSphereTest three_sphere_test_;
  std::vector<ThreeSphereTest::Tetrahedron> tetrahedra_;
};

}  // namespace tegl::tile
