// SPDX-License-Identifier: BSD-3-Clause
//
// Tests whether the link of a vertex of D-simplices is a sphere or a ball, and counts the faces at its smallest vertex.
//
// Based on: H. Seifert and W. Threlfall, Lehrbuch der Topologie, 1934, chapters 3, 6 and 7 (a complex is a manifold iff
// all links are spheres or balls; surfaces are classified by boundary, orientability and Euler characteristic).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "mesh/oriented_link.hpp"
#include "mesh/vertex_stars.hpp"
#include "tegl/check.hpp"
#include "tegl/contour.hpp"
#include "tegl/tile/complex.hpp"

namespace tegl::detail {

/// A complex of D-simplices, valid vertex numbers only.
template <int D>
struct SimplexComplex {
  std::span<const Index> rows;  // #S x (D + 1)
  std::size_t vertex_count = 0;

  [[nodiscard]] std::size_t size() const { return rows.size() / (D + 1); }
  [[nodiscard]] const Index* operator[](std::size_t s) const { return rows.data() + s * (D + 1); }
  /// Whether a simplex repeats a vertex.
  [[nodiscard]] bool is_collapsed(std::size_t s) const { return detail::is_collapsed<D + 1>((*this)[s]); }
};

/// The link of one vertex at a time: a complex of (D-1)-simplices ("pieces"), oriented so that the vertex followed by a
/// piece is the simplex that it comes from.
template <int D>
class LinkChecker {
 public:
  explicit LinkChecker(const SimplexComplex<D>& complex)
      : complex_(complex), usual_(complex.rows.data(), complex.vertex_count), seen_(complex.vertex_count, kNever) {
    if constexpr (D == 4) number_.resize(complex.vertex_count);
  }

  /// Adds the counts at the star of `v` to the report.
  void visit(Index v, std::span<const Index> star, MeshReport& report) {
    if constexpr (D == 2) {
      FacesAbove faces;
      if (usual_.settle(v, star, faces)) {
        edges_ += faces.edges;
        report.boundary_simplices += faces.boundary;
        return;
      }
    }
    load(v, star);
    const std::uint64_t link_vertices = count_link_vertices(v);
    if constexpr (D == 4) count_link_edges(v);
    sets_.reset(pieces_.size() * D);  // one set per corner of a piece, joined around the vertices of the link
    scan_ridges(v, report);
    if (!is_sphere_or_ball(link_vertices)) ++report.bad_links;
    if constexpr (D >= 2) edges_ += edges_above_;
  }
  /// Numbers of faces met since the last call.
  [[nodiscard]] std::uint64_t take_edges() { return std::exchange(edges_, 0); }            ///< D >= 2
  [[nodiscard]] std::uint64_t take_triangles() { return std::exchange(triangles_, 0); }    ///< D >= 3
  [[nodiscard]] std::uint64_t take_tetrahedra() { return std::exchange(tetrahedra_, 0); }  ///< D = 4

 private:
  static constexpr Index kNever = std::numeric_limits<Index>::max();
  using Piece = std::array<Index, D>;
  using Key = std::conditional_t<(D < 4), std::uint64_t, std::array<Index, 3>>;

  /// A (D-2)-face of the link in one of its pieces. Ridges with equal keys are the same face.
  struct Ridge {
    Key key;
    Index piece;
    std::uint8_t omitted;  // the piece's corner that is not in the ridge
    bool reversed;         // the orientation that the piece induces
    bool operator<(const Ridge& other) const { return key < other.key; }
  };

  void load(Index v, std::span<const Index> star) {
    pieces_.clear();
    ridges_.clear();
    for (const Index s : star) {
      const Index* row = complex_[s];
      Piece piece{};
      bool odd = false;  // parity of moving v to the front
      for (int i = 0, k = 0; i <= D; ++i) {
        if (row[i] == v)
          odd = (i & 1) != 0;
        else
          piece[k++] = row[i];
      }
      const auto number = static_cast<Index>(pieces_.size());
      pieces_.push_back(piece);
      for (int j = 0; j < D; ++j) ridges_.push_back(make_ridge(piece, number, j, odd));
    }
    std::sort(ridges_.begin(), ridges_.end());
  }

  /// Key: the vertices of the ridge, ascending: three if D = 4, two if D = 3, one if D = 2, none if D = 1.
  static Ridge make_ridge(const Piece& piece, Index number, int omitted, bool odd) {
    bool reversed = odd != ((omitted & 1) != 0);
    Key key{};
    if constexpr (D == 2) key = piece[1 - omitted];
    if constexpr (D == 3) {
      Index a = piece[omitted == 0 ? 1 : 0];
      Index b = piece[omitted == 2 ? 1 : 2];
      if (a > b) {
        std::swap(a, b);
        reversed = !reversed;
      }
      key = (std::uint64_t{a} << 32) | b;
    }
    if constexpr (D == 4) {
      std::copy_n(piece.begin(), omitted, key.begin());
      std::copy(piece.begin() + omitted + 1, piece.end(), key.begin() + omitted);
      for (const auto& [i, j] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{0, 1}})
        if (key[i] > key[j]) {
          std::swap(key[i], key[j]);
          reversed = !reversed;
        }
    }
    return {key, number, static_cast<std::uint8_t>(omitted), reversed};
  }

  std::uint64_t count_link_vertices(Index v) {
    std::uint64_t count = 0;
    edges_above_ = 0;
    for (const Piece& piece : pieces_)
      for (const Index a : piece) {
        if (seen_[a] == v) continue;
        seen_[a] = v;
        if constexpr (D == 4) number_[a] = static_cast<Index>(count);
        ++count;
        if (a > v) ++edges_above_;
      }
    return count;
  }

  void count_link_edges(Index v) {
    link_edges_.clear();
    for (const Piece& piece : pieces_)
      for (int i = 0; i < D; ++i)
        for (int j = 0; j < i; ++j)
          link_edges_.push_back(std::uint64_t{std::min(piece[i], piece[j])} << 32 | std::max(piece[i], piece[j]));
    std::sort(link_edges_.begin(), link_edges_.end());
    link_edges_.erase(std::unique(link_edges_.begin(), link_edges_.end()), link_edges_.end());
    const auto above = std::upper_bound(link_edges_.begin(), link_edges_.end(), std::uint64_t{v} << 32 | kNever);
    triangles_ += static_cast<std::uint64_t>(link_edges_.end() - above);
  }

  /// Whether v is the smallest vertex of the face spanned by v and this ridge. The face is then counted here.
  static bool is_counted_at(Index v, const Key& key) {
    if constexpr (D == 1) return true;
    if constexpr (D == 2) return key > v;
    if constexpr (D == 3) return (key >> 32) > v;
    if constexpr (D == 4) return key[0] > v;
  }

  void scan_ridges(Index v, MeshReport& report) {
    ridge_count_ = 0;
    fans_ = pieces_.size() * D;
    connections_ = 0;
    closed_ = true;
    branching_ = false;
    whole_.reset(pieces_.size());
    for (std::size_t i = 0, j = 0; i < ridges_.size(); i = j) {
      while (j < ridges_.size() && ridges_[j].key == ridges_[i].key) ++j;
      ++ridge_count_;
      const std::size_t cofaces = j - i;
      closed_ = closed_ && cofaces != 1;
      branching_ = branching_ || cofaces > 2;
      if (cofaces == 2) join_across(ridges_[i], ridges_[i + 1]);
      if (is_counted_at(v, ridges_[i].key)) count_face(std::span(ridges_).subspan(i, cofaces), report);
    }
  }

  void count_face(std::span<const Ridge> cofaces, MeshReport& report) {
    if constexpr (D == 3) ++triangles_;
    if constexpr (D == 4) ++tetrahedra_;
    if (cofaces.size() == 1) ++report.boundary_simplices;
    if (cofaces.size() > 2) ++report.nonmanifold_simplices;
    if (cofaces.size() == 2 && cofaces[0].reversed == cofaces[1].reversed) ++report.orientation_conflicts;
  }

  /// Joins two pieces that share a ridge: they are connected, and in the same fan around each vertex of the ridge.
  void join_across(const Ridge& a, const Ridge& b) {
    if (whole_.join(a.piece, b.piece)) ++connections_;
    for (int i = 0; i < D; ++i) {
      if (i == a.omitted) continue;
      for (int j = 0; j < D; ++j)
        if (j != b.omitted && pieces_[a.piece][i] == pieces_[b.piece][j] &&
            sets_.join(a.piece * D + static_cast<Index>(i), b.piece * D + static_cast<Index>(j)))
          --fans_;
    }
  }

  [[nodiscard]] bool is_sphere_or_ball(std::uint64_t link_vertices) {
    if (branching_) return false;                            // a ridge in three pieces
    if (connections_ + 1 != pieces_.size()) return false;    // several components
    if (D >= 2 && fans_ != link_vertices) return false;      // a vertex of the link with several fans: pinched
    auto euler = static_cast<std::int64_t>(pieces_.size());  // of the link
    if constexpr (D == 2) euler = static_cast<std::int64_t>(link_vertices) - euler;
    if constexpr (D == 3) euler += static_cast<std::int64_t>(link_vertices) - static_cast<std::int64_t>(ridge_count_);
    if constexpr (D == 4)
      euler = static_cast<std::int64_t>(link_vertices + ridge_count_) -
              static_cast<std::int64_t>(link_edges_.size() + pieces_.size());
    constexpr std::int64_t kSphere = D % 2 == 1 ? 2 : 0;  // S^0, S^1, S^2, S^3: 2, 0, 2, 0
    if (euler != (closed_ ? kSphere : 1)) return false;
    if constexpr (D == 4) return link_vertices < tile::kNoVertex && link_shape() != tile::Shape::other;
    return true;
  }

  [[nodiscard]] tile::Shape link_shape() {
    link_.assign(pieces_.size(), tile::kNoSimplex);
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      for (int i = 0; i < D; ++i) link_[p][i] = static_cast<tile::VertexId>(number_[pieces_[p][i]]);
      tile::sort_vertices(link_[p]);
    }
    return tile::shape_of(link_);
  }

  /// In place of OrientedLink in other dimensions.
  struct NoLink {
    NoLink(const Index*, std::size_t) {}
  };

  const SimplexComplex<D>& complex_;
  std::conditional_t<D == 2, OrientedLink, NoLink> usual_;
  std::vector<Index> seen_;  // by vertex: the last vertex in whose link it was met
  std::vector<Piece> pieces_;
  std::vector<Ridge> ridges_;
  DisjointSets sets_;
  DisjointSets whole_;
  std::uint64_t ridge_count_ = 0;
  std::uint64_t fans_ = 0;
  std::uint64_t connections_ = 0;
  std::uint64_t edges_above_ = 0;
  std::uint64_t edges_ = 0;
  std::uint64_t triangles_ = 0;
  std::uint64_t tetrahedra_ = 0;
  // D = 4
  std::vector<Index> number_;              // by vertex: its number in the current link
  std::vector<std::uint64_t> link_edges_;  // smaller end in the upper 32 bits, ascending
  tile::Simplices link_;
  bool closed_ = true;
  bool branching_ = false;
};

}  // namespace tegl::detail
