// SPDX-License-Identifier: BSD-3-Clause
//
// The recursion over dimension: contour, high part and low part of every face from those of its own faces.
#include "tegl/facets/facets.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

namespace tegl::facets {

namespace {

struct SignedSimplex {
  Simplex simplex;
  int sign;
  friend auto operator<=>(const SignedSimplex&, const SignedSimplex&) = default;
};

/// What is built in a face. Vertices of simplices ascend.
struct Piece {
  std::vector<SignedSimplex> contour;
  Simplices high, low;
};

/// A component of the high or of the low part of a face's boundary.
struct Region {
  bool high = false;
  Simplices simplices;
  std::vector<std::size_t> around{};  ///< components of Sigma that bound it
};

void append(Simplices& to, const Simplices& more) { to.insert(to.end(), more.begin(), more.end()); }

std::vector<VertexId> vertices_of(const Simplices& simplices) {
  std::vector<VertexId> vertices;
  for (const Simplex& s : simplices) vertices.insert(vertices.end(), s.begin(), s.begin() + size(s));
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

bool contains(const std::vector<VertexId>& sorted, VertexId v) {
  return std::binary_search(sorted.begin(), sorted.end(), v);
}

/// The components, in the order of their first simplices.
std::vector<Simplices> components(const Simplices& simplices) {
  const std::vector<VertexId> vertices = vertices_of(simplices);
  std::vector<std::size_t> parent(vertices.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](VertexId vertex) {
    auto v = static_cast<std::size_t>(std::lower_bound(vertices.begin(), vertices.end(), vertex) - vertices.begin());
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Simplex& s : simplices)
    for (int i = 1; i < size(s); ++i) parent[root(s[i])] = root(s[0]);
  std::vector<Simplices> result;
  std::vector<std::size_t> number(vertices.size(), vertices.size());
  for (const Simplex& s : simplices) {
    std::size_t& n = number[root(s[0])];
    if (n == vertices.size()) n = result.size(), result.emplace_back();
    result[n].push_back(s);
  }
  return result;
}

/// By construction Sigma is a closed manifold; a connected curve is a circle, a surface is known by its Euler number.
bool shown_to_be_sphere(const Simplices& component) {
  const int vertices = size(component.front());
  if (vertices <= 2) return true;
  if (vertices == 3) return euler_characteristic(component) == 2;
  return shape_of(component) == Shape::sphere;
}

class TileBuilder {
 public:
  TileBuilder(const FaceLattice& lattice, Signature signature, const Resolution& resolution)
      : lattice_(lattice), signature_(signature), resolution_(resolution), pieces_(lattice.faces().size()) {}

  TileFacets run() {
    for (face_ = 0; face_ < pieces_.size(); ++face_) {
      next_number_ = next_centre_ = 0;
      const int dim = face().dim;
      dim == 0 ? build_corner() : dim == 1 ? build_edge() : build_face();
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] const Face& face() const { return lattice_.faces()[face_]; }
  [[nodiscard]] bool is_tile() const { return face_ == lattice_.tile(); }

  VertexId new_vertex(VertexKind kind, VertexId copied = kNoVertex, Simplices of = {}) {
    const std::size_t id = result_.vertices.size();
    if (id >= kNoVertex) throw std::length_error("more than 65535 vertices in a tile");
    // Centres are counted apart: the tile itself has none, and its contour has the same numbers as where it is a face.
    std::uint32_t& number = kind == VertexKind::centre ? next_centre_ : next_number_;
    result_.vertices.push_back({kind, face_, number++, copied, std::move(of)});
    return static_cast<VertexId>(id);
  }

  void build_corner() {
    Simplex corner = kNoSimplex;
    corner[0] = new_vertex(VertexKind::corner);
    ((signature_ & face().corners) != 0 ? pieces_[face_].high : pieces_[face_].low) = {corner};
  }

  void build_edge() {
    const Piece& first = pieces_[face().faces[0]];
    const Piece& second = pieces_[face().faces[1]];
    Simplex from = first.high.empty() ? first.low[0] : first.high[0];
    const Simplex to = second.high.empty() ? second.low[0] : second.high[0];
    Piece& piece = pieces_[face_];
    if (first.high.empty() == second.high.empty()) {
      from[1] = to[0];
      (first.high.empty() ? piece.low : piece.high) = {from};
      return;
    }
    Simplex point = kNoSimplex;
    point[0] = new_vertex(VertexKind::edge);
    piece.contour = {{point, second.high.empty() ? -1 : 1}};
    for (const Piece* end : {&first, &second})
      for (const bool high : {true, false})
        for (const Simplex& corner : high ? end->high : end->low) {
          Simplex half = with_apex(corner[0], point);  // corners come before points
          (high ? piece.high : piece.low).push_back(half);
        }
  }

  void build_face() {
    collect_boundary();
    const Choice choice = face_ < resolution_.choices.size() ? resolution_.choices[face_] : Choice::separate;
    centre_high_ = choice == Choice::separate ? resolution_.alternative == Alternative::high : choice == Choice::high;
    facets_.clear();
    caps_.assign(sigma_.size(), {});
    for (std::size_t c = 0; c < sigma_.size(); ++c)
      if (face().dim > 2 && choice == Choice::separate && shown_to_be_sphere(sigma_[c])) cap(c);
    fill_pieces();
    finish();
  }

  /// Sigma by components, the regions beside it, and who bounds whom.
  void collect_boundary() {
    Simplices all, high, low;
    signed_sigma_.clear(), regions_.clear();
    for (std::size_t j = 0; j < face().faces.size(); ++j) {
      const Piece& piece = pieces_[face().faces[j]];
      for (const SignedSimplex& s : piece.contour) signed_sigma_.push_back({s.simplex, s.sign * face().signs[j]});
      append(high, piece.high), append(low, piece.low);
    }
    std::sort(signed_sigma_.begin(), signed_sigma_.end());
    for (const SignedSimplex& s : signed_sigma_) all.push_back(s.simplex);
    sigma_ = components(all);
    for (const bool is_high : {true, false}) {
      Simplices& side = is_high ? high : low;
      std::sort(side.begin(), side.end());
      for (Simplices& part : components(side)) {
        const std::vector<VertexId> vertices = vertices_of(part);
        regions_.push_back({is_high, std::move(part)});
        for (std::size_t c = 0; c < sigma_.size(); ++c)
          if (contains(vertices, sigma_[c][0][0])) regions_.back().around.push_back(c);
      }
    }
  }

  /// Do all these vertices lie in one proper face?
  [[nodiscard]] bool in_one_face(const std::vector<VertexId>& vertices) const {
    Signature corners = 0;
    for (const VertexId v : vertices) corners |= lattice_.faces()[result_.vertices[v].face].corners;
    return std::any_of(face().faces.begin(), face().faces.end(),
                       [&](std::uint32_t g) { return (corners & ~lattice_.faces()[g].corners) == 0; });
  }

  /// The ball with this boundary: the simplex if it is one's, else a cone from a new vertex.
  Simplices ball(const Simplices& boundary, VertexKind kind) {
    const std::vector<VertexId> vertices = vertices_of(boundary);
    if (vertices.size() == boundary.size() && static_cast<int>(vertices.size()) == size(boundary[0]) + 1 &&
        !in_one_face(vertices)) {
      Simplex simplex = kNoSimplex;
      std::copy(vertices.begin(), vertices.end(), simplex.begin());
      return {simplex};
    }
    const VertexId apex = new_vertex(kind, kNoVertex, boundary);
    Simplices cone;
    for (const Simplex& s : boundary) {
      cone.push_back(with_apex(apex, s));
      sort_vertices(cone.back());
    }
    return cone;
  }

  void cap(std::size_t c) {
    caps_[c] = ball(sigma_[c], VertexKind::barycentre);
    const Filling filling = caps_[c].size() == 1 ? Filling::simplex : Filling::cone;
    facets_.push_back({filling, euler_characteristic(sigma_[c]), caps_[c]});
  }

  /// A region with the caps of the components of Sigma around it that have one.
  [[nodiscard]] Simplices capped(const Region& region) const {
    Simplices all = region.simplices;
    for (const std::size_t c : region.around) append(all, caps_[c]);
    return all;
  }

  /// Caps cut the face apart; each part is filled by itself.
  void fill_pieces() {
    std::vector<std::size_t> part(regions_.size());
    std::iota(part.begin(), part.end(), std::size_t{0});
    for (std::size_t c = 0; c < sigma_.size(); ++c) {
      if (!caps_[c].empty()) continue;
      std::vector<std::size_t> beside;
      for (std::size_t r = 0; r < regions_.size(); ++r)
        if (std::find(regions_[r].around.begin(), regions_[r].around.end(), c) != regions_[r].around.end())
          beside.push_back(part[r]);
      for (std::size_t& p : part)
        if (p == beside.back()) p = beside.front();
    }
    for (std::size_t p = 0; p < regions_.size(); ++p) {
      std::vector<std::size_t> members;
      for (std::size_t r = 0; r < regions_.size(); ++r)
        if (part[r] == p) members.push_back(r);
      if (members.size() == 1 && !is_tile()) {
        const Region& region = regions_[members[0]];
        append(region.high ? pieces_[face_].high : pieces_[face_].low, ball(capped(region), VertexKind::centre));
      } else if (members.size() > 1) {
        fill_around_centre(members);
      }
    }
  }

  /// The regions of one sign are copied inwards; between the copies and the others lies the part with the centre.
  void fill_around_centre(const std::vector<std::size_t>& members) {
    Simplices around_centre;
    for (const std::size_t r : members) {
      const Region& region = regions_[r];
      if (region.high == centre_high_)
        append(around_centre, capped(region));
      else
        append(around_centre, face().dim == 2 ? cut_corner(region) : copy_inwards(region));
    }
    if (!is_tile())
      append(centre_high_ ? pieces_[face_].high : pieces_[face_].low, ball(around_centre, VertexKind::centre));
  }

  /// Dimension 2: a run of corners of one sign is cut off by the segment between its ends.
  Simplices cut_corner(const Region& region) {
    Simplex segment = kNoSimplex;
    for (std::size_t i = 0; i < 2; ++i) segment[i] = sigma_[region.around[i]][0][0];
    sort_vertices(segment);
    facets_.push_back({Filling::simplex, 2, {segment}});
    if (!is_tile()) {
      Simplices around = region.simplices;
      around.push_back(segment);
      append(region.high ? pieces_[face_].high : pieces_[face_].low, ball(around, VertexKind::centre));
    }
    return {segment};
  }

  /// The copy keeps the vertices of Sigma that it bounds and has new ones else. Between region and copy lies a prism
  /// over each simplex, pinched where vertices are kept.
  Simplices copy_inwards(const Region& region) {
    const Simplices original = capped(region);
    Simplices bounds;
    for (const std::size_t c : region.around)
      if (caps_[c].empty()) append(bounds, sigma_[c]);
    const std::vector<VertexId> kept = vertices_of(bounds), vertices = vertices_of(original);
    std::vector<VertexId> image;
    for (const VertexId v : vertices) image.push_back(contains(kept, v) ? v : new_vertex(VertexKind::side, v));
    const auto copied = [&](VertexId v) {
      return image[static_cast<std::size_t>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin())];
    };
    Facet facet{Filling::side, euler_characteristic(bounds)};
    Simplices& part = region.high ? pieces_[face_].high : pieces_[face_].low;
    for (const Simplex& s : original) {
      Simplex copy = s;
      for (int i = 0; i < size(s); ++i) copy[i] = copied(s[i]);
      for (int i = 0; i < size(s) && !is_tile(); ++i) {
        if (copy[i] == s[i]) continue;
        Simplex prism = with_apex(s[0], copy);
        std::copy(s.begin(), s.begin() + i + 1, prism.begin());
        sort_vertices(prism);
        part.push_back(prism);
      }
      sort_vertices(copy);
      facet.simplices.push_back(copy);
    }
    facets_.push_back(facet);
    return facet.simplices;
  }

  /// Signs for a facet's simplices: those at Sigma agree with it, two that share a face induce opposite ones.
  [[nodiscard]] std::vector<int> orientation(const Simplices& simplices) const {
    struct Ridge {
      Simplex simplex;
      std::size_t of;
      int sign;
    };
    std::vector<Ridge> ridges;
    for (std::size_t j = 0; j < simplices.size(); ++j)
      for (int i = 0; i < size(simplices[j]); ++i) ridges.push_back({without(simplices[j], i), j, i % 2 == 0 ? 1 : -1});
    std::sort(ridges.begin(), ridges.end(), [](const Ridge& a, const Ridge& b) { return a.simplex < b.simplex; });
    struct Step {
      std::size_t to;
      int sign;
    };
    std::vector<std::vector<Step>> steps(simplices.size());
    std::vector<int> sign(simplices.size());
    std::vector<std::size_t> reached;
    for (std::size_t r = 0; r < ridges.size(); ++r) {
      const Ridge& a = ridges[r];
      if (r + 1 < ridges.size() && ridges[r + 1].simplex == a.simplex) {
        const Ridge& b = ridges[++r];
        steps[a.of].push_back({b.of, -a.sign * b.sign});
        steps[b.of].push_back({a.of, -a.sign * b.sign});
      } else if (reached.empty()) {
        const auto at = std::lower_bound(signed_sigma_.begin(), signed_sigma_.end(), SignedSimplex{a.simplex, -1});
        if (at == signed_sigma_.end() || at->simplex != a.simplex) continue;
        sign[a.of] = at->sign * a.sign;
        reached.push_back(a.of);
      }
    }
    for (std::size_t i = 0; i < reached.size(); ++i)
      for (const Step& step : steps[reached[i]])
        if (sign[step.to] == 0) {
          sign[step.to] = sign[reached[i]] * step.sign;
          reached.push_back(step.to);
        }
    if (reached.size() != simplices.size()) throw std::logic_error("a facet that does not hang together");
    return sign;
  }

  void finish() {
    for (const Facet& facet : facets_) {
      const std::vector<int> sign = orientation(facet.simplices);
      for (std::size_t j = 0; j < sign.size(); ++j) pieces_[face_].contour.push_back({facet.simplices[j], sign[j]});
      if (!is_tile()) continue;
      result_.facets.push_back(facet);
      for (std::size_t j = 0; j < sign.size(); ++j)
        if (sign[j] < 0) std::swap(result_.facets.back().simplices[j][0], result_.facets.back().simplices[j][1]);
    }
    if (!is_tile()) return;
    for (const SignedSimplex& s : signed_sigma_)
      result_.sigma.push_back(s.simplex), result_.sigma_sign.push_back(s.sign);
    for (const std::uint32_t g : face().faces) {
      result_.in_face.emplace_back();
      for (const SignedSimplex& s : pieces_[g].contour) result_.in_face.back().push_back(s.simplex);
    }
  }

  const FaceLattice& lattice_;
  Signature signature_;
  const Resolution& resolution_;
  std::vector<Piece> pieces_;
  TileFacets result_;

  // Of the face at hand.
  std::uint32_t face_ = 0;
  std::uint32_t next_number_ = 0;
  std::uint32_t next_centre_ = 0;
  bool centre_high_ = false;
  std::vector<SignedSimplex> signed_sigma_;
  std::vector<Simplices> sigma_;  ///< by components
  std::vector<Simplices> caps_;   ///< of a component of Sigma that is coned; else empty
  std::vector<Region> regions_;
  std::vector<Facet> facets_;
};

}  // namespace

TileFacets build_facets(const FaceLattice& lattice, Signature signature, const Resolution& resolution) {
  const Face& tile = lattice.faces()[lattice.tile()];
  if (tile.dim < 2)
    throw std::invalid_argument("tile of dimension " + std::to_string(tile.dim) + ", expected 2 or more");
  if ((signature & ~tile.corners) != 0)
    throw std::invalid_argument("signature " + std::to_string(signature) + " has corners beyond those of the tile, " +
                                std::to_string(tile.corners));
  if (!resolution.choices.empty() && resolution.choices.size() != lattice.faces().size())
    throw std::invalid_argument(std::to_string(resolution.choices.size()) + " choices, expected one for each of " +
                                std::to_string(lattice.faces().size()) + " faces");
  return TileBuilder(lattice, signature, resolution).run();
}

}  // namespace tegl::facets
